#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/random.hpp"

using namespace haptics;

namespace {

constexpr double k_hand_step = 1.0e-3;

enum class Frames { even, jittered, bunched };

struct Clicks {
    // largest change of the force on the handle from one haptic step to the next, N
    double force;
    // the same for the torque, N m
    double torque;
    // largest distance to the target's motion when that is taken `lag` later, m
    double error;
    double lag;
};

// A mouse moved at 2 Hz and up to 0.5 m/s with whole pixels of 0.25 mm, seen at frame rate; free motion, 4 s,
// the first left out.
Clicks follow(double frame_rate, Frames frames) {
    SimulatedPantographOptions options;
    options.hand = mouse_hand();
    SimulatedPantograph device(options);
    testing::Random random(51);
    const auto pixel = [](double x) { return std::round(x / 0.25e-3) * 0.25e-3; };
    const auto motion = [](double t) {
        const double u = std::min(1.0, t / 0.5);
        const double grow = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        return Pose(0.04 * grow * std::sin(12.566 * t), 0.02 * grow * std::sin(8.8 * t),
                    0.3 * grow * std::sin(6.0 * t));
    };
    const double frame = 1.0 / frame_rate;
    double next = 0.0;
    int count = 0;
    Wrench last = Wrench::Zero();
    std::vector<Pose> path;
    Clicks clicks{0.0, 0.0, 1.0, 0.0};
    for (int k = 0; k < 4000; ++k) {
        const double now = device.time();
        while (now >= next) {
            const Pose at = motion(now);
            device.set_target({now, Pose(pixel(at.x()), pixel(at.y()), at.z())});
            ++count;
            // two frames within a millisecond, then none for two frames
            next = frames == Frames::bunched
                       ? static_cast<double>(count / 2) * 2.0 * frame + (count % 2) * 1.0e-3
                       : count * frame;
            if (frames == Frames::jittered)
                next += frame * random.uniform(-0.3, 0.3);
        }
        device.advance(k_hand_step);
        const Wrench force = device.hand_force();
        if (k > 1000) {
            clicks.force = std::max(clicks.force, (force - last).head<2>().norm());
            clicks.torque = std::max(clicks.torque, std::abs(force.z() - last.z()));
        }
        last = force;
        path.push_back(device.true_pose());
    }
    // the lag that explains the path best
    for (int lag = 0; lag < 200; ++lag) {
        double worst = 0.0;
        for (int k = 1500; k < 4000; ++k) {
            const double t = k_hand_step * (k + 1 - lag);
            worst = std::max(worst, (path[static_cast<std::size_t>(k)] - motion(t)).head<2>().norm());
        }
        if (worst < clicks.error) {
            clicks.error = worst;
            clicks.lag = lag * k_hand_step;
        }
    }
    return clicks;
}

} // namespace

TEST_SUITE("simulated hand") {
    TEST_CASE("a fast mouse makes no click above 0.05 N in free motion, however unevenly frames come") {
        for (const double rate : {30.0, 60.0, 144.0})
            for (const Frames frames : {Frames::even, Frames::jittered, Frames::bunched}) {
                const Clicks clicks = follow(rate, frames);
                MESSAGE(rate << " Hz, " << static_cast<int>(frames) << ": " << clicks.force << " N, "
                             << clicks.torque << " N m a step, lag " << clicks.lag << " s, off the motion by "
                             << clicks.error << " m");
                CHECK(clicks.force <= 0.05);
                CHECK(clicks.torque <= 0.001);
                CHECK(clicks.lag < 0.2);
            }
    }

    TEST_CASE("a mouse that starts after a rest makes no click, and a stall of 80 ms in full motion less "
              "than 0.1 N") {
        SimulatedPantographOptions options;
        options.hand = mouse_hand();
        SimulatedPantograph device(options);
        Wrench last = Wrench::Zero();
        double before_stall = 0.0;
        double worst = 0.0;
        for (int k = 0; k < 3000; ++k) {
            const double now = device.time();
            // rest for 1 s, then 50 mm in 0.5 s; frames stall for 80 ms in the middle
            const double u = std::min(1.0, std::max(0.0, (now - 1.0) / 0.5));
            const bool stalled = now > 1.2 && now < 1.28;
            if (k % 16 == 0 && !stalled)
                device.set_target({now, Pose(0.05 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u), 0.0, 0.0)});
            device.advance(k_hand_step);
            worst = std::max(worst, (device.hand_force() - last).head<2>().norm());
            last = device.hand_force();
            if (now < 1.2)
                before_stall = worst;
        }
        MESSAGE("largest change " << before_stall << " N a step, " << worst << " in the stall");
        CHECK(before_stall <= 0.05);
        CHECK(worst <= 0.05);
        CHECK(device.true_pose().x() == doctest::Approx(0.05).epsilon(1.0e-3));
    }

    TEST_CASE("the hand never pushes harder than its limit") {
        SimulatedPantographOptions options;
        options.hand = mouse_hand();
        SimulatedPantograph device(options);
        for (int k = 0; k < 500; ++k) {
            device.set_target({device.time(), Pose(5.0, -5.0, 3.0)});
            device.advance(k_hand_step);
            const Wrench muscles = device.hand().force(device.true_pose(), device.true_twist());
            REQUIRE(muscles.head<2>().norm() <= 8.0 * (1.0 + 1.0e-12));
            REQUIRE(std::abs(muscles.z()) <= 0.2);
        }
    }

    TEST_CASE("a steady push is steady, and starts when it is told to") {
        SimulatedPantographOptions options;
        options.hand = pushing_hand(Wrench(0.0, -2.0, 0.0), 0.1);
        SimulatedPantograph device(options);
        // held by an equal force of the device
        for (int k = 0; k < 200; ++k) {
            device.write(k < 100 ? Wrench(Wrench::Zero()) : Wrench(0.0, 2.0, 0.0));
            device.advance(k_hand_step);
            if (k < 99)
                CHECK(device.hand_force().norm() == 0.0);
        }
        CHECK(device.hand_force().y() == doctest::Approx(-2.0));
        CHECK(device.true_pose().norm() < 1.0e-12);
    }

    TEST_CASE("a recorded path is met at its points, linear and smooth, and starts over when told to") {
        const std::vector<HandTarget> points{{0.0, Pose(0, 0, 0)},
                                             {1.0, Pose(0.03, 0.01, 0.2)},
                                             {1.5, Pose(0.01, 0.02, -0.1)},
                                             {3.0, Pose(0, 0, 0)}};
        for (const PathInterpolation kind : {PathInterpolation::linear, PathInterpolation::smooth}) {
            RecordedPath path(points, kind, false);
            for (const HandTarget& point : points)
                CHECK((path.sample(point.time_s).pose - point.pose).norm() < 1.0e-12);
            CHECK((path.sample(9.0).pose - points.back().pose).norm() == 0.0);
            CHECK(path.sample(9.0).velocity.norm() == 0.0);
            for (double t = 0.05; t < 3.0; t += 0.1) {
                const Twist slope = (path.sample(t + 1.0e-6).pose - path.sample(t - 1.0e-6).pose) / 2.0e-6;
                CHECK((path.sample(t).velocity - slope).norm() < 1.0e-7);
            }
            RecordedPath again(points, kind, true);
            CHECK((again.sample(7.25).pose - again.sample(1.25).pose).norm() < 1.0e-12);
        }
        CHECK(RecordedPath(points, PathInterpolation::linear, false).sample(0.5).pose.x() ==
              doctest::Approx(0.015));
        // smooth: no jump of velocity at a point
        RecordedPath smooth(points, PathInterpolation::smooth, false);
        CHECK((smooth.sample(1.0 - 1.0e-9).velocity - smooth.sample(1.0 + 1.0e-9).velocity).norm() < 1.0e-6);
    }

    TEST_CASE("a path whose times do not grow is refused by name") {
        SimulatedHandOptions options =
            path_hand({{0.0, Pose::Zero()}, {1.0, Pose::Zero()}, {1.0, Pose::Zero()}});
        REQUIRE(validate(options).size() == 1);
        CHECK(validate(options)[0].field == "hand.path[2].time_s");
        options.path.clear();
        REQUIRE(validate(options).size() == 1);
        CHECK(validate(options)[0].field == "hand.path");
    }

    TEST_CASE("a hand follows its path to within what its spring needs to move the handle") {
        std::vector<HandTarget> points;
        for (int k = 0; k <= 200; ++k)
            points.push_back({0.01 * k, Pose(0.02 * (1.0 - std::cos(3.14159265 * 0.01 * k)), 0.0, 0.0)});
        SimulatedPantographOptions options;
        options.hand = path_hand(points);
        SimulatedPantograph device(options);
        double worst = 0.0;
        for (int k = 0; k < 2000; ++k) {
            device.advance(k_hand_step);
            worst = std::max(worst, std::abs(device.true_pose().x() - device.hand().wish().x()));
        }
        // 0.45 kg at 0.2 m/s^2 and 1 N s/m at 0.063 m/s on 1000 N/m: 0.09 + 0.06 mm
        CHECK(worst < 0.17e-3);
        CHECK(worst > 0.05e-3);
    }
}
