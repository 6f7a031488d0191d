#include <haptics/core/pantograph/compensation.hpp>
#include <haptics/core/pantograph/presets.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pantograph/true_device.hpp"
#include "support/allocation_guard.hpp"

using namespace haptics;
using haptics::testing::ClosedPath;
using haptics::testing::HandEnergy;
using haptics::testing::Held;
using haptics::testing::move_along;
using haptics::testing::pose_near_home;
using haptics::testing::Random;
using haptics::testing::random_geometry;
using haptics::testing::random_path;
using haptics::testing::with_model_error;

namespace {

// how a set of settings fares over random devices, paths, rates and delays
struct Battery {
    int runs{0};
    int negative{0};
    double worst{1.0e9};
    double least{0.0};
    double allowed{0.0};
    double heat{0.0};
};

struct BatteryOptions {
    double model_error{k_model_error};
    double friction{1.0};
    Held held{Held::torque};
    int runs{30};
    int most_delay{2};
};

// numbers of this size are what the sums round to (J)
constexpr double k_rounding = 1.0e-9;

Battery run(const CompensationSettings& settings, std::uint64_t seed, const BatteryOptions& options = {}) {
    Random random(seed);
    Battery battery;
    for (int n = 0; n < options.runs; ++n) {
        PantographGeometry g = random_geometry(random, 1 + n % 2);
        g.motor.viscous_friction *= options.friction;
        g.motor.coulomb_friction *= options.friction;
        const PantographKinematics figures(g);
        const PantographKinematics device(with_model_error(g, random, options.model_error));
        const ClosedPath path = random_path(figures, random, 5);
        const double rate = n % 3 == 0 ? 500.0 : n % 3 == 1 ? 700.0 : 1000.0;
        const int delay = n % (options.most_delay + 1);
        CompensationSettings s = settings;
        s.delay = delay / rate;
        const HandEnergy energy = move_along(figures, device, s, path, rate, options.held, delay, n % 5 != 0);
        ++battery.runs;
        battery.negative += energy.given < -k_rounding ? 1 : 0;
        battery.worst = std::min(battery.worst, energy.given);
        battery.least = std::min(battery.least, energy.least);
        battery.allowed += energy.allowed / options.runs;
        battery.heat += energy.heat / options.runs;
    }
    MESSAGE("hand gave at worst " << 1.0e3 * battery.worst << " mJ, mean heat " << 1.0e3 * battery.heat
                                  << " mJ, negative " << battery.negative << " of " << battery.runs
                                  << ", inertia compensation allowed " << battery.allowed);
    return battery;
}

CompensationSettings shares(double friction, double inertia, const Vec2& gravity = Vec2::Zero()) {
    CompensationSettings s;
    s.friction_share = friction;
    s.inertia_share = inertia;
    s.gravity = gravity;
    return s;
}

} // namespace

TEST_SUITE("pantograph compensation") {
    TEST_CASE("nobody gets energy out of a closed path: friction at its limit, figures 30 % off") {
        const Battery b = run(shares(0.7, 0.0), 401);
        CHECK(b.negative == 0);
        CHECK(b.least >= -k_rounding);
    }

    TEST_CASE("nobody gets energy out of a closed path: inertia at its limit, figures 30 % off") {
        const Battery b = run(shares(0.0, 0.5), 402);
        CHECK(b.negative == 0);
        CHECK(b.least >= -k_rounding);
        CHECK(b.allowed > 0.5);
    }

    TEST_CASE("nobody gets energy out of a closed path: all at once, standing upright, figures 30 % off") {
        CHECK(run(shares(0.65, 0.5, Vec2(2.0, -9.6)), 403).negative == 0);
        const Battery b = run(shares(0.4, 0.5, Vec2(-9.0, -4.0)), 404);
        CHECK(b.negative == 0);
        CHECK(b.allowed > 0.3);
    }

    TEST_CASE("holding the weight alone leaks nothing that even a hundredth of usual friction does not pay") {
        CompensationSettings weight = shares(0.0, 0.0, Vec2(0.0, -9.81));
        BatteryOptions slippery;
        slippery.friction = 0.01;
        slippery.most_delay = 0;
        CHECK(run(weight, 405, slippery).negative == 0);
        // without any: a debt of less than what lifts a gram by a tenth of a millimeter, or 1 mJ with two
        // steps of delay
        slippery.friction = 0.0;
        CHECK(run(weight, 406, slippery).worst > -1.0e-6);
        slippery.most_delay = 2;
        CHECK(run(weight, 407, slippery).worst > -1.0e-3);
    }

    TEST_CASE("the same check catches too much friction compensation") {
        BatteryOptions exact;
        exact.model_error = 0.0;
        CHECK(run(shares(1.3, 0.0), 401, exact).negative > 24);
        CHECK(run(shares(1.3, 0.0), 401).negative > 10);
        // and figures further off than promised
        Random random(408);
        int negative = 0;
        for (int n = 0; n < 20; ++n) {
            const PantographGeometry g = random_geometry(random, 1 + n % 2);
            PantographGeometry half = g;
            half.motor.viscous_friction *= 0.5;
            half.motor.coulomb_friction *= 0.5;
            const PantographKinematics figures(g);
            const HandEnergy energy = move_along(figures, PantographKinematics(half), shares(0.7, 0.0),
                                                 random_path(figures, random, 5), 1000.0, Held::torque);
            negative += energy.given < -k_rounding ? 1 : 0;
        }
        CHECK(negative > 10);
    }

    TEST_CASE("the same check catches too much inertia compensation, and even half of it without a ledger") {
        CompensationSettings bare = shares(0.0, 1.3);
        bare.budgeted = false;
        CHECK(run(bare, 402).negative > 20);
        bare.inertia_share = 0.5;
        CHECK(run(bare, 402).negative > 20);
        // the ledger holds whatever the share
        CHECK(run(shares(0.0, 1.3), 402).negative == 0);
    }

    TEST_CASE("rates are never more than the true mean of the window") {
        Random random(409);
        for (int n = 0; n < 10; ++n) {
            const PantographKinematics figures(random_geometry(random, 1 + n % 2));
            const ClosedPath path = random_path(figures, random, 4);
            CompensationSettings settings = shares(0.5, 0.0);
            const double step = 1.0e-3;
            Compensation compensation(figures, settings);
            std::vector<JointVector> truth;
            for (double t = 0.0; t < path.duration(); t += step) {
                JointVector angles;
                figures.inverse(path.at(t), angles);
                truth.push_back(angles);
                JointVector read = angles;
                for (int i = 0; i < figures.motors(); ++i)
                    read[i] = figures.angle_of_count(i, std::round(figures.count_of_angle(i, angles[i])));
                compensation.update(figures.forward(read).pose, &read, step);
                if (truth.size() < 9) {
                    REQUIRE(compensation.joint_rates().isZero(0.0));
                    continue;
                }
                for (int i = 0; i < figures.motors(); ++i) {
                    const double mean =
                        std::remainder(angles[i] - truth[truth.size() - 9][i], 6.283185307179586) / 0.008;
                    REQUIRE(std::abs(compensation.joint_rates()[i]) <= std::abs(mean) + 1.0e-12);
                    REQUIRE(compensation.joint_rates()[i] * mean >= 0.0);
                }
            }
        }
    }

    TEST_CASE("weight is held, friction halves, inertia shrinks: by the shares asked for") {
        Random random(410);
        for (int n = 0; n < 8; ++n) {
            PantographGeometry g = random_geometry(random, 1 + n % 2);
            g.motor.counts_per_revolution = 1.0e6;
            g.motor.viscous_friction = 0.01;
            g.motor.coulomb_friction = 0.02;
            const PantographKinematics figures(g);
            const CompensationSettings settings = shares(0.5, 0.3, Vec2(1.0, -9.0));
            const double step = 1.0e-3;
            Compensation compensation(figures, settings);
            const Pose center = figures.geometry().home;
            // a slow swing; compare energies and forces per cycle
            const double size = 0.008;
            const double omega = 6.283185307 * 1.5;
            double given = 0.0;
            double heat = 0.0;
            double with_acceleration = 0.0;
            double full = 0.0;
            for (int k = 0; k < 4000; ++k) {
                const double t = k * step;
                const Pose pose =
                    center + Pose(size * std::sin(omega * t), 0.5 * size * std::sin(omega * t), 0.0);
                const Twist twist =
                    omega * Pose(size * std::cos(omega * t), 0.5 * size * std::cos(omega * t), 0.0);
                const Twist acceleration = -omega * omega * (pose - center);
                JointVector angles;
                figures.inverse(pose, angles);
                compensation.update(figures.forward(angles).pose, &angles, step);
                const PantographState state = figures.locate(pose);
                if (k == 0) {
                    Wrench held = compensation.gravity() + gravity_wrench(figures, state, settings.gravity);
                    REQUIRE(held.norm() < 1.0e-6);
                }
                if (k < 2000)
                    continue;
                const JointVector rate = state.rates * twist;
                given += compensation.friction().dot(twist) * step;
                heat += (g.motor.viscous_friction * rate.squaredNorm() +
                         g.motor.coulomb_friction * rate.cwiseAbs().sum()) *
                        step;
                with_acceleration += compensation.inertia().dot(acceleration) * step;
                full += acceleration.dot(handle_mass_matrix(figures, state) * acceleration +
                                         velocity_wrench(figures, state, twist)) *
                        step;
            }
            CHECK(given / heat > 0.44);
            CHECK(given / heat < 0.5);
            CHECK(with_acceleration / full > 0.24);
            CHECK(with_acceleration / full < 0.3);
        }
    }

    TEST_CASE("without friction figures there is nothing to pay for inertia compensation, so there is none") {
        PantographGeometry g = ubc_twin_pantograph();
        const PantographKinematics figures(g);
        CompensationSettings settings = shares(0.0, 0.5);
        settings.delay = 0.0;
        Random random(411);
        const HandEnergy energy =
            move_along(figures, figures, settings, random_path(figures, random, 4), 1000.0, Held::torque);
        CHECK(energy.given > -1.0e-6);
        CHECK(energy.most_force > 0.0);
    }

    TEST_CASE("what cannot be compensated is named") {
        PantographGeometry g = ubc_twin_pantograph();
        CHECK(validate(CompensationSettings{}, g).empty());
        CHECK(validate(shares(0.0, 0.0, Vec2(0.0, -9.81)), g).empty());
        const auto first = [&](const CompensationSettings& s) {
            const std::vector<FigureError> errors = validate(s, g);
            REQUIRE(errors.size() == 1);
            return errors[0].message();
        };
        CHECK(first(shares(0.5, 0.0)).find("compensation.friction_share is 0.5") == 0);
        CHECK(first(shares(0.0, 0.3)).find("Friction pays for it") != std::string::npos);
        g.motor.coulomb_friction = 0.005;
        CHECK(validate(shares(0.7, 0.0), g).empty());
        CHECK(validate(shares(0.6, 0.5), g).empty());
        CHECK(first(shares(0.75, 0.0)).find("must lie between 0 and 0.7") != std::string::npos);
        CHECK(first(shares(0.2, 0.55)).find("must lie between 0 and 0.5") != std::string::npos);
        CHECK(first(shares(0.7, 0.5)).find("Leave some friction") != std::string::npos);
        CompensationSettings wrong;
        wrong.velocity_window = std::numeric_limits<double>::quiet_NaN();
        CHECK(first(wrong).find("not a number") != std::string::npos);
    }

    TEST_CASE("broken readings give no force, and nothing takes from the heap") {
        PantographGeometry g = ubc_twin_pantograph();
        g.motor.coulomb_friction = 0.01;
        const PantographKinematics figures(g);
        Compensation compensation(figures, shares(0.5, 0.3, Vec2(0.0, -9.81)), Vec3(1e-5, 1e-5, 1e-4));
        Random random(412);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const haptics::testing::AllocationGuard guard;
        for (int k = 0; k < 3000; ++k) {
            const bool broken = random.below(20) == 0;
            Pose pose(0.02 * std::sin(0.01 * k), 0.02 * std::cos(0.013 * k), 0.2 * std::sin(0.02 * k));
            if (broken)
                pose[random.below(3)] = random.below(2) == 0 ? nan : random.uniform(-9.0, 9.0);
            const Wrench wrench = compensation.update(pose, nullptr, 1.0e-3);
            REQUIRE(wrench.allFinite());
            if (broken && pose.hasNaN())
                REQUIRE(wrench.isZero(0.0));
            compensation.passed(random.below(9) == 0 ? nan : random.uniform(-1.0, 2.0));
        }
        CHECK(guard.allocations() == 0);
    }
}
