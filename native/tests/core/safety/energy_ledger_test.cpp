#include <haptics/core/safety/energy_ledger.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace haptics;

namespace {

// a handle moved as 10 mm sin(w t), against a spring of `stiffness` N/m computed from the pose `late` samples
// ago, for 2 s
EnergyLedger drive(double stiffness, double dt, int late) {
    EnergyLedger ledger;
    const auto x = [dt](int k) { return 0.01 * std::sin(10.0 * dt * k); };
    ledger.reset(Pose(x(0), 0.0, 0.0));
    const int steps = static_cast<int>(2.0 / dt);
    for (int k = 0; k < steps; ++k) {
        ledger.set_force(Wrench(-stiffness * x(k - late), 0.0, 0.0));
        ledger.book(Pose(x(k + 1), 0.0, 0.0), 0.5 * stiffness * x(k + 1) * x(k + 1));
    }
    return ledger;
}

} // namespace

TEST_SUITE("energy ledger") {
    TEST_CASE("a spring at a high rate creates next to nothing") {
        // exact: the held force makes K/2 (dx)^2 a step, here K/2 (A w dt)^2 / 2 on average
        const double dt = 1.0e-4;
        const double expected = 0.5 * 1000.0 * 0.5 * 0.1 * 0.1 * dt * 2.0;
        const EnergyLedger ledger = drive(1000.0, dt, 0);
        CHECK(ledger.created() == doctest::Approx(expected).epsilon(0.05));
        CHECK(ledger.injected() < 0.001);
    }

    TEST_CASE("the energy that a sampled and delayed spring creates is found as theory has it") {
        // delay T_d acts as the damper -K T_d: power K (T_d + T/2) v^2
        const double dt = 1.0e-3;
        for (const int late : {0, 1, 3}) {
            const double mean_square_speed = 0.5 * 0.1 * 0.1;
            const double expected = 1000.0 * (late + 0.5) * dt * mean_square_speed * 2.0;
            CHECK(drive(1000.0, dt, late).injected() == doctest::Approx(expected).epsilon(0.05));
        }
    }

    TEST_CASE("a damper takes energy, an active controller is found out even after a dissipating start") {
        EnergyLedger ledger;
        ledger.reset(Pose::Zero());
        double x = 0.0;
        for (int k = 0; k < 1000; ++k) {
            ledger.set_force(Wrench(-5.0, 0.0, 0.0));
            x += 1.0e-4;
            ledger.book(Pose(x, 0.0, 0.0));
        }
        CHECK(ledger.created() == doctest::Approx(-0.5));
        CHECK(ledger.injected() == 0.0);
        for (int k = 0; k < 200; ++k) {
            ledger.set_force(Wrench(5.0, 0.0, 0.0));
            x += 1.0e-4;
            ledger.book(Pose(x, 0.0, 0.0));
        }
        CHECK(ledger.injected() == 0.0);
        CHECK(ledger.largest_gain() == doctest::Approx(0.1));
    }

    TEST_CASE("energy stored at the start and the work of moving walls are not held against the controller") {
        EnergyLedger ledger;
        ledger.reset(Pose::Zero(), 0.05);
        ledger.set_force(Wrench(0.0, 2.0, 0.0));
        // 0.05 J come out of a spring, 0.03 J from a wall that moves
        ledger.book(Pose(0.0, 0.04, 0.0), 0.0, 0.03);
        CHECK(ledger.delivered() == doctest::Approx(0.08));
        CHECK(std::abs(ledger.created()) < 1.0e-12);
    }

    TEST_CASE("broken input is ignored and counted") {
        EnergyLedger ledger;
        ledger.reset(Pose::Zero());
        const double nan = std::numeric_limits<double>::quiet_NaN();
        ledger.set_force(Wrench(nan, 0.0, 0.0));
        ledger.book(Pose(nan, 0.0, 0.0));
        ledger.book(Pose::Zero(), nan);
        CHECK(ledger.ignored() == 3);
        CHECK(std::isfinite(ledger.created()));
    }
}
