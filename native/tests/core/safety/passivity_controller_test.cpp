// The passivity controller on a spring that is rendered late, and so creates energy at every bounce.

#include <haptics/core/safety/energy_ledger.hpp>
#include <haptics/core/safety/passivity_controller.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace haptics;

namespace {

struct Outcome {
    double injected{0.0};
    double swing{0.0};
    double taken{0.0};
};

// 0.3 kg against a spring of 4000 N/m that answers one sample late, at 500 Hz, readings in steps of 10 um
Outcome swing(bool controlled) {
    const Mat3 mass = Vec3(0.3, 0.3, 3e-4).asDiagonal();
    const double h = 2e-3;
    const double quantum = 1e-5;
    const double stiffness = 4000.0;
    EnergyLedger ledger;
    PassivityController controller(Vec3(0.5 * quantum, 0.5 * quantum, 0.0));
    double x = 0.002;
    double v = 0.0;
    double last = x;
    double late = -stiffness * x;
    double force = late;
    ledger.reset(Pose(x, 0.0, 0.0), 0.5 * stiffness * x * x);
    ledger.set_force(Wrench(force, 0.0, 0.0));
    Outcome outcome;
    for (int i = 0; i < 1500; ++i) {
        v += h * force / 0.3;
        x += h * v;
        const double seen = quantum * std::round(x / quantum);
        ledger.book(Pose(seen, 0.0, 0.0), 0.5 * stiffness * seen * seen);
        force = late;
        late = -stiffness * seen;
        if (controlled)
            force += controller
                         .damp(ledger.created(), Wrench(force, 0.0, 0.0), Twist((seen - last) / h, 0.0, 0.0),
                               mass, h)
                         .x();
        last = seen;
        ledger.set_force(Wrench(force, 0.0, 0.0));
        outcome.swing = std::max(outcome.swing, std::abs(x));
    }
    outcome.injected = ledger.injected();
    outcome.taken = controller.taken();
    return outcome;
}

} // namespace

TEST_SUITE("passivity controller") {
    TEST_CASE("a late spring swings up by itself, and does not when controlled") {
        const Outcome free = swing(false);
        const Outcome controlled = swing(true);
        CHECK(free.swing > 0.1);
        CHECK(controlled.swing < 0.003);
        CHECK(controlled.taken > 0.0);
        CHECK(free.injected > 1000.0 * controlled.injected);
    }

    TEST_CASE("what the encoder hides is left alone, and so is a handle that rests") {
        PassivityController controller(Vec3(5e-6, 5e-6, 5e-5));
        const Mat3 mass = Vec3(0.3, 0.3, 3e-4).asDiagonal();
        const Twist moving(0.1, 0.0, 0.0);
        // 10 N times 10 um, and the slack
        CHECK(controller.damp(1.4e-4, Wrench(10.0, 0.0, 0.0), moving, mass, 1e-3).isZero(0.0));
        CHECK(controller.damp(1.0, Wrench::Zero(), Twist(1e-3, 0.0, 0.0), mass, 1e-3).isZero(0.0));
        const Wrench damping = controller.damp(1.0, Wrench::Zero(), moving, mass, 1e-3);
        // a fifth of the momentum in one step, and no more
        CHECK(damping.x() == doctest::Approx(-0.2 * 0.3 * 0.1 / 1e-3));
        controller.reset();
        const Wrench even = controller.damp(5e-5 + 1e-4, Wrench::Zero(), moving, mass, 1e-3);
        CHECK(even.dot(moving) * 1e-3 == doctest::Approx(-1e-4));
    }
}
