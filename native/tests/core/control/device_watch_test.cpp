// The watch on the device, and a loop that is faster than the device.
#include <haptics/core/control/session.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

using namespace haptics;

namespace {

// gives what it is told, a new sample each time unless it is told to be silent
class ScriptedDevice final : public DevicePort {
  public:
    bool read(DeviceReading& reading) override {
        if (unplugged)
            return false;
        if (!silent)
            ++next.sequence;
        const Fault faults = reading.faults;
        reading = next;
        if (never_faults)
            reading.faults = faults;
        return true;
    }
    void write(const Wrench& force) override { written = force; }
    [[nodiscard]] Mat3 handle_mass(const Pose& /*pose*/) const override {
        return Vec3(0.3, 0.3, 3e-4).asDiagonal();
    }
    [[nodiscard]] int freedoms() const override { return 3; }

    DeviceReading next;
    Wrench written{0.0, 0.0, 0.0};
    /// Leaves that field of a reading alone.
    bool never_faults{false};
    bool silent{false};
    bool unplugged{false};
};

struct Rig {
    explicit Rig(double rate = 1000.0, bool arm_at_start = true) {
        SessionSettings s;
        s.step = 1.0 / rate;
        s.arm_at_start = arm_at_start;
        s.velocity_window = 2;
        OutputGate gate{SafetyLimits{}};
        session = std::make_unique<Session>(s, shared::box_tool(), gate, device, Pose(0.0, 0.05, 0.0));
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i)
            session->step();
    }
    [[nodiscard]] bool armed() const { return session->report().armed; }
    [[nodiscard]] Fault faults() const { return session->report().faults; }

    ScriptedDevice device;
    std::unique_ptr<Session> session;
};

} // namespace

TEST_CASE("a device that gives no new sample for 20 ms faults, and comes back only by an explicit arm") {
    for (const bool unplugged : {false, true}) {
        CAPTURE(unplugged);
        Rig rig;
        rig.run(200);
        REQUIRE(rig.armed());
        (unplugged ? rig.device.unplugged : rig.device.silent) = true;
        rig.run(20);
        CHECK(rig.armed());
        rig.run(2);
        CHECK_FALSE(rig.armed());
        CHECK(rig.faults() == Fault::reconnect_the_device);
        CHECK(rig.device.written.isZero(0.0));
        // asked for while the cause lasts: refused, and not remembered
        rig.session->arm();
        rig.run(100);
        CHECK(rig.session->arm_result() == ArmResult::remove_the_cause_first);
        rig.device.unplugged = false;
        rig.device.silent = false;
        rig.run(500);
        CHECK_FALSE(rig.armed());
        CHECK(rig.faults() == Fault::reconnect_the_device);
        rig.session->arm();
        rig.run(200);
        CHECK(rig.armed());
        CHECK(rig.faults() == Fault::none);
    }
}

TEST_CASE("what a device finds wrong with itself latches") {
    Rig rig;
    rig.run(200);
    REQUIRE(rig.armed());
    rig.device.next.faults = Fault::give_the_loop_more_time;
    rig.run(1);
    rig.device.next.faults = Fault::none;
    rig.run(200);
    CHECK_FALSE(rig.armed());
    CHECK(rig.faults() == Fault::give_the_loop_more_time);
    rig.session->arm();
    rig.run(200);
    CHECK(rig.armed());
}

TEST_CASE("no force before the device knows its zero, and none after it lost it") {
    Rig rig;
    rig.device.next.homed = false;
    rig.run(500);
    CHECK_FALSE(rig.armed());
    CHECK(rig.session->arm_result() == ArmResult::home_the_device_first);
    rig.device.next.homed = true;
    rig.run(200);
    CHECK(rig.armed());
    rig.device.next.homed = false;
    rig.run(1);
    CHECK_FALSE(rig.armed());
}

TEST_CASE("a loop faster than its device moves the handle on between samples") {
    // 5 Hz, 2 mm; a sample a millisecond, at times that slide past the steps of a 4 kHz loop, its age known
    const auto truth = [](double t) { return 0.002 * std::sin(2.0 * std::numbers::pi * 5.0 * t); };
    const auto largest_error = [&](bool tells_age) {
        Rig rig(4000.0, false);
        double largest = 0.0;
        double due = 0.0;
        std::uint64_t samples = 0;
        for (int i = 1; i <= 8000; ++i) {
            const double now = i * 0.25e-3;
            rig.device.silent = due > now;
            if (!rig.device.silent) {
                rig.device.next.pose = Pose(truth(due), 0.0, 0.0);
                rig.device.next.interval = samples++ == 0 ? 0.0 : 1.0003e-3;
                rig.device.next.age = tells_age ? now - due : 0.0;
                due += 1.0003e-3;
            }
            rig.session->step();
            const double offset = rig.session->grab_offset().x();
            if (i > 100)
                largest = std::max(largest, std::abs(rig.session->report().device.x() - offset - truth(now)));
        }
        return largest;
    };
    // held between samples it would be off by up to 2 mm * 31.4 rad/s * 1 ms = 63 um. Moved on, what is left
    // is the lag of the velocity (a difference over two samples: 1 ms old, 2 um at 1 ms) and the curve itself
    // (1 um).
    CHECK(largest_error(true) < 4e-6);
    // without its age a sample is off by up to a step of the loop, 16 um
    const double ageless = largest_error(false);
    CHECK(ageless > 10e-6);
    CHECK(ageless < 25e-6);
}

namespace {

// a simulated pantograph behind USB: a sample and a command every `every` steps
class SlowDevice final : public DevicePort {
  public:
    SlowDevice(const SimulatedPantographOptions& options, int every)
        : inner(options)
        , every_(every) {}
    bool read(DeviceReading& reading) override {
        if (step_ % every_ == 0)
            inner.read(reading);
        return true;
    }
    void write(const Wrench& force) override {
        if (step_ % every_ == every_ - 1)
            inner.write(force);
        ++step_;
    }
    void advance(double dt) override { inner.advance(dt); }
    [[nodiscard]] Mat3 handle_mass(const Pose& pose) const override { return inner.handle_mass(pose); }
    [[nodiscard]] int freedoms() const override { return 3; }

    SimulatedPantograph inner;

  private:
    int every_;
    int step_{0};
};

} // namespace

TEST_CASE("the model steps at 4 kHz on a device of 1 kHz: a push of 2 N comes back, steadily") {
    SimulatedPantographOptions options;
    options.encoder_model = EncoderModel::handle;
    options.encoder_resolution = Vec3(1e-6, 1e-6, 1e-5);
    options.limit_motors = false;
    options.hand = pushing_hand(Wrench(0.0, -2.0, 0.0), 0.5);
    SlowDevice device(options, 4);
    SessionSettings s;
    s.step = 0.25e-3;
    s.coupling = Coupling::virtual_coupling;
    s.reading_error = Vec3(0.5e-6, 0.5e-6, 0.5e-5);
    s.sample_period = 1e-3;
    OutputGate gate(SafetyLimits{}, device.inner.kinematics());
    Session session(s, shared::box_tool(), gate, device, Pose(0.0, 0.03, 0.0));
    session.take(*shared::floor_of(1));
    double low = 1e9;
    double high = -1e9;
    double sum = 0.0;
    constexpr int k_tail = 4000;
    for (int i = 0; i < 20000; ++i) {
        session.step();
        const double force = session.report().contact.y();
        if (i < 20000 - k_tail)
            continue;
        low = std::min(low, force);
        high = std::max(high, force);
        sum += force;
    }
    CHECK(session.report().faults == Fault::none);
    CHECK(sum / k_tail == doctest::Approx(2.0).epsilon(0.01));
    CHECK(high - low < 0.1);
}

TEST_CASE("a reading or a snapshot with what is no number is refused: a fault, and afterwards all is well") {
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                          1e308};
    for (const double value : bad)
        for (int where = 0; where < 10; ++where) {
            CAPTURE(value);
            CAPTURE(where);
            ScriptedDevice device;
            device.never_faults = true;
            OutputGate gate{SafetyLimits{}};
            gate.set_homed(true);
            Session session(SessionSettings{}, shared::box_tool(), gate, device, Pose(0.0, 0.03, 0.0));
            auto scene = shared::floor_of(1);
            session.take(*scene);
            const auto run = [&](int steps) {
                for (int i = 0; i < steps; ++i) {
                    session.step();
                    CHECK(device.written.allFinite());
                    REQUIRE(session.report().proxy.allFinite());
                    REQUIRE(session.report().contact.allFinite());
                }
            };
            run(200);
            REQUIRE(session.report().armed);
            const DeviceReading good = device.next;
            auto broken = std::make_unique<Neighborhood>(*scene);
            Body& body = broken->bodies.body[0];
            broken->sequence = 2;
            double* const fields[] = {&body.pose.y(), &body.velocity.x(), &broken->gravity.y(), &broken->tick,
                                      &body.mass};
            if (where < 2)
                device.next.pose[where] = value;
            device.next.has_velocity = where == 2;
            if (where == 2)
                device.next.velocity.y() = value;
            device.next.has_hand_force = where == 3;
            if (where == 3)
                device.next.hand_force.y() = value;
            if (where >= 5)
                *fields[where - 5] = value;
            if (where == 9)
                body.kind = BodyKind::movable;
            if (where >= 5)
                session.take(*broken);
            run(3);
            CHECK(has(session.report().faults, Fault::check_the_encoders) == (where < 3));
            const std::uint64_t sequence = device.next.sequence;
            device.next = good;
            device.next.sequence = sequence;
            scene->sequence = 3;
            session.take(*scene);
            run(200);
            session.arm();
            run(200);
            CHECK(session.report().armed);
            CHECK(session.report().faults == Fault::none);
        }
}
