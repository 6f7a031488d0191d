#pragma once
/// Which device to open, and what to expect of it.

#include <haptics/core/figure_error.hpp>
#include <haptics/core/pantograph/presets.hpp>
#include <haptics/devices/hid/hid_stream.hpp>

#include <string>
#include <vector>

namespace haptics {

/// Vendor and product that the reference firmware shows: the open test id of pid.codes, for use at home.
inline constexpr int k_hid_test_vendor = 0x1209;
inline constexpr int k_hid_test_product = 0x0001;

struct HidPantographOptions {
    /// USB ids, 1 to 65535.
    int vendor{k_hid_test_vendor};
    int product{k_hid_test_product};
    /// Serial number; empty takes the first device found, and stays with it.
    std::string serial;
    /// Lengths, masses and modes of the linkage. Offsets, directions, gears, torque limits and home come from
    /// the device's own calibration.
    PantographGeometry geometry{ubc_twin_pantograph()};
    HidStreamLimits stream;
    /// Most that the encoders of a twin may disagree by, rad, 1e-4 to 1, before the output faults.
    double residual_limit{0.005};
    /// Silence after which the connection is given up and made anew, s, 0.05 to 10.
    double silence{0.5};
    /// SCHED_FIFO priority of the thread that writes, 1 to 80, where permitted; 0 asks for none.
    int priority{80};
    /// File names of hidapi to try; empty takes the usual ones.
    std::vector<std::string> library;
    /// The host's clock, ns; null takes the loop's. Tests that step a device by hand bring their own.
    std::int64_t (*clock)() noexcept {nullptr};
};

/// Every figure out of range, the geometry's included. Empty when usable. Allocates; not for the haptic loop.
std::vector<FigureError> validate(const HidPantographOptions& options);

/// Content of the udev rule that lets the user at the machine open devices of this vendor and product.
std::string hid_udev_rule(int vendor, int product);
/// "1209:0001".
std::string hid_id_text(int vendor, int product);

} // namespace haptics
