#pragma once
/// The device of one world while it runs: a simulated pantograph with its hand, or a real one on USB.

#include <haptics/classes/world_settings.hpp>
#include <haptics/realtime/haptic_runner.hpp>

#include <memory>
#include <string>
#include <vector>

namespace haptics {

/// What a world needs of its device beside the port. Main thread, but for the port and the hook.
class WorldDevice {
  public:
    /// Makes or opens it; null after a problem that says why and what to do.
    static std::unique_ptr<WorldDevice> make(const DeviceOptions& options, bool realtime, Problems& problems);

    WorldDevice() = default;
    WorldDevice(const WorldDevice&) = delete;
    WorldDevice& operator=(const WorldDevice&) = delete;
    virtual ~WorldDevice() = default;

    virtual DevicePort& port() = 0;
    [[nodiscard]] virtual const PantographKinematics& kinematics() const = 0;
    /// Largest error of a reading per coordinate.
    [[nodiscard]] virtual Vec3 reading_error() const = 0;
    /// Delay that it adds to the loop, and period of its samples, 0 for one as fast as the loop (s).
    [[nodiscard]] virtual double delay() const = 0;
    [[nodiscard]] virtual double sample_period() const = 0;
    /// How late a force acts and how old a reading is, together, in a loop of `step` s; for the compensation
    /// (s).
    [[nodiscard]] virtual double latency(double step) const = 0;
    /// What has to happen on the loop thread before each step; null for nothing.
    virtual StepHook* hook() { return nullptr; }
    /// Where a pointing hand wants the grip (scene frame).
    virtual void aim(const Pose& /*grip*/) {}
    /// Tells the device that its handle is in the home pose.
    virtual void home(Problems& /*problems*/) {}
    /// What happened to it since the last call.
    virtual std::vector<std::string> take_messages() { return {}; }
    /// Force that a simulated device was sent last (N, N, N m); a real one's own figures tell. Not while the
    /// loop's thread runs.
    [[nodiscard]] virtual Wrench last_force() const { return Wrench::Zero(); }
    /// Lock-step: the part of a step in which device and hand are simulated, mean, ns.
    [[nodiscard]] virtual double simulation_ns() const { return 0.0; }
    /// Figures for the run's statistics.
    [[nodiscard]] virtual godot::Dictionary statistics() const { return {}; }
};

} // namespace haptics
