#include <haptics/classes/world_device.hpp>
#include <haptics/realtime/loop_clock.hpp>

#include <numbers>

namespace haptics {

using namespace godot;

namespace {

// gives a simulated hand its targets on the loop thread
class HandHook final : public StepHook {
  public:
    explicit HandHook(SimulatedPantograph& device)
        : device_(device) {}
    void aim(const Pose& grip) noexcept { targets_.try_write({next_++, grip}); }
    void before_step(const Session& session) noexcept override {
        const auto newest = targets_.try_read();
        if (newest.is_new)
            device_.set_target({device_.time(), session.handle_for(newest.value.grip)});
    }

  private:
    struct Target {
        std::uint64_t number{0};
        Pose grip{0.0, 0.0, 0.0};
    };
    SimulatedPantograph& device_;
    LatestValue<Target> targets_;
    std::uint64_t next_{1};
};

// in lock-step: how much of a step goes into simulating device and hand, which a real loop does not do
class TimedPort final : public DevicePort {
  public:
    explicit TimedPort(SimulatedPantograph& device)
        : device_(device) {}
    bool read(DeviceReading& reading) override {
        const std::int64_t begin = loop_clock_ns();
        const bool got = device_.read(reading);
        spent_ns_ += loop_clock_ns() - begin;
        ++reads_;
        return got;
    }
    void write(const Wrench& force) override { device_.write(force); }
    void advance(double dt) override {
        const std::int64_t begin = loop_clock_ns();
        device_.advance(dt);
        spent_ns_ += loop_clock_ns() - begin;
    }
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override { return device_.handle_mass(pose); }
    [[nodiscard]] int freedoms() const override { return device_.freedoms(); }
    [[nodiscard]] double mean_ns() const {
        return reads_ > 0 ? static_cast<double>(spent_ns_) / static_cast<double>(reads_) : 0.0;
    }

  private:
    SimulatedPantograph& device_;
    std::int64_t spent_ns_{0};
    std::int64_t reads_{0};
};

class SimulatedDevice final : public WorldDevice {
  public:
    SimulatedDevice(const SimulatedPantographOptions& options, bool realtime)
        : options_(options)
        , device_(options)
        , timed_(device_)
        , realtime_(realtime)
        , hook_(device_) {}

    DevicePort& port() override {
        if (realtime_)
            return device_;
        return timed_;
    }
    [[nodiscard]] double simulation_ns() const override { return timed_.mean_ns(); }
    [[nodiscard]] const PantographKinematics& kinematics() const override { return device_.kinematics(); }
    [[nodiscard]] double delay() const override { return options_.command_delay; }
    [[nodiscard]] double sample_period() const override { return 0.0; }
    [[nodiscard]] double latency(double step) const override {
        return options_.command_delay + step * (options_.command_delay_steps + options_.reading_delay_steps);
    }
    [[nodiscard]] Vec3 reading_error() const override {
        switch (options_.encoder_model) {
        case EncoderModel::exact:
            return {1e-9, 1e-9, 1e-8};
        case EncoderModel::handle:
            return 0.5 * options_.encoder_resolution;
        case EncoderModel::joint:
            break;
        }
        // half a count at the motor axis, seen at the end of a stretched arm
        const FiveBarGeometry& bar = options_.geometry.bar[0];
        const double half = std::numbers::pi / options_.geometry.motor.counts_per_revolution;
        const double reach = bar.proximal_length[0] + bar.distal_length[0];
        const double lever = (options_.geometry.attachment[0] - options_.geometry.attachment[1]).norm();
        return {half * reach, half * reach, lever > 0.0 ? 2.0 * half * reach / lever : half};
    }
    StepHook* hook() override { return &hook_; }
    [[nodiscard]] Wrench last_force() const override { return device_.written(); }
    void aim(const Pose& grip) override { hook_.aim(grip); }

  private:
    SimulatedPantographOptions options_;
    SimulatedPantograph device_;
    TimedPort timed_;
    bool realtime_;
    HandHook hook_;
};

class HidDevice final : public WorldDevice {
  public:
    explicit HidDevice(std::unique_ptr<HidPantograph> device)
        : device_(std::move(device)) {}

    DevicePort& port() override { return *device_; }
    [[nodiscard]] const PantographKinematics& kinematics() const override { return device_->kinematics(); }
    [[nodiscard]] Vec3 reading_error() const override { return device_->reading_error(); }
    [[nodiscard]] double delay() const override { return device_->interval(); }
    [[nodiscard]] double sample_period() const override { return device_->interval(); }
    [[nodiscard]] double latency(double /*step*/) const override { return device_->interval(); }
    void home(Problems& problems) override {
        const std::string problem = device_->home_here();
        if (!problem.empty())
            problems.add(problem);
    }
    std::vector<std::string> take_messages() override { return device_->take_messages(); }
    [[nodiscard]] Dictionary statistics() const override {
        const HidCounts c = device_->published_counts();
        const HidIdentity& id = device_->identity();
        Dictionary d;
        const auto count = [&d](const char* name, std::uint64_t value) {
            d[name] = static_cast<int64_t>(value);
        };
        d["name"] = String(device_->name());
        d["serial"] = String(id.serial.data());
        d["firmware"] = String(std::to_string(id.major) + "." + std::to_string(id.minor));
        d["connected"] = device_->is_connected();
        count("connections", device_->connections());
        count("reports_used", c.accepted);
        count("reports_superseded", c.superseded);
        count("reports_wrong_size", c.wrong_size);
        count("reports_corrupt", c.corrupt);
        count("reports_wrong_version", c.wrong_version);
        count("reports_repeated", c.repeated);
        count("reports_out_of_order", c.out_of_order);
        count("reports_late", c.late);
        count("reports_jumped", c.jumped);
        count("reports_without_pose", c.no_pose);
        count("reports_lost", c.lost);
        count("commands_sent", device_->commands_sent());
        count("commands_overtaken", device_->commands_overtaken());
        return d;
    }

  private:
    std::unique_ptr<HidPantograph> device_;
};

} // namespace

std::unique_ptr<WorldDevice> WorldDevice::make(const DeviceOptions& options, bool realtime,
                                               Problems& problems) {
    if (const auto* simulated = std::get_if<SimulatedPantographOptions>(&options.device))
        return std::make_unique<SimulatedDevice>(*simulated, realtime);
    if (!realtime) {
        problems.add(
            "A HapticHidPantograph needs the mode REALTIME: it goes on in its own time while a lock-step "
            "loop waits. Set the world's mode, or use a HapticSimulatedPantograph.");
        return nullptr;
    }
    std::string error;
    std::unique_ptr<HidPantograph> device =
        HidPantograph::open(std::get<HidPantographOptions>(options.device), error);
    if (device == nullptr) {
        problems.add(error);
        return nullptr;
    }
    return std::make_unique<HidDevice>(std::move(device));
}

} // namespace haptics
