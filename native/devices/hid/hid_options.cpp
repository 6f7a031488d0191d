#include <haptics/devices/hid/hid_options.hpp>

#include <array>
#include <cstdio>

namespace haptics {

namespace {

std::string hex4(int value) {
    std::array<char, 12> text{};
    std::snprintf(text.data(), text.size(), "%04x", static_cast<unsigned>(value) & 0xFFFFU);
    return text.data();
}

} // namespace

std::vector<FigureError> validate(const HidPantographOptions& o) {
    constexpr const char* k_id = "Give the id that lsusb shows for the device.";
    FigureCheck check;
    check.range("vendor_id", o.vendor, 1.0, 65535.0, "", k_id);
    check.range("product_id", o.product, 1.0, 65535.0, "", k_id);
    check.append(validate(o.geometry));
    check.range("late", o.stream.late, 1.0e-3, 1.0, "s", "0.005 is the default.");
    check.range("max_joint_speed", o.stream.max_joint_speed, 1.0, 1.0e4, "rad/s", "100 is the default.");
    check.range("encoder_tolerance", o.residual_limit, 1.0e-4, 1.0, "rad", "0.005 is the default.");
    check.range("silence", o.silence, 0.05, 10.0, "s", "0.5 is the default.");
    check.range("priority", o.priority, 0.0, 80.0, "", "80 is the default; 0 asks for none.");
    return check.take();
}

std::string hid_id_text(int vendor, int product) {
    return hex4(vendor) + ":" + hex4(product);
}

std::string hid_udev_rule(int vendor, int product) {
    return "KERNEL==\"hidraw*\", SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"" + hex4(vendor) +
           "\", ATTRS{idProduct}==\"" + hex4(product) + "\", TAG+=\"uaccess\"";
}

} // namespace haptics
