// The observer against the motion it claims to know: a mass under known and unknown forces, seen late.

#include <haptics/core/control/handle_observer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace haptics;

namespace {

// A mass matrix that couples the axes, its motion under forces held for a step each and acting `delay` late,
// in closed form, and the observer beside it.
struct Truth {
    Mat3 mass = (Mat3() << 0.3, 0.04, 0.0, 0.04, 0.25, 0.002, 0.0, 0.002, 4e-4).finished();
    double step{1e-3};
    double delay{0.0};
    Pose pose{0.01, -0.02, 0.1};
    Twist twist{0.0, 0.0, 0.0};
    std::vector<Wrench> sent;

    void push(const Wrench& force, double dt) {
        const Vec3 acceleration = mass.inverse() * force;
        pose += dt * twist + 0.5 * dt * dt * acceleration;
        twist += dt * acceleration;
    }
    [[nodiscard]] Wrench past(int age) const {
        const int index = static_cast<int>(sent.size()) - 1 - age;
        return index >= 0 ? sent[static_cast<std::size_t>(index)] : Wrench(Wrench::Zero());
    }
    // one step after `force` was sent, with the hand's force on top
    void advance(const Wrench& force, const Wrench& hand) {
        sent.push_back(force);
        const double steps = delay / step;
        const int whole = static_cast<int>(std::floor(steps));
        const double late = steps - whole;
        push(past(whole + 1) + hand, late * step);
        push(past(whole) + hand, (1.0 - late) * step);
    }
};

Wrench wave(int i) {
    return {std::sin(0.05 * i), 0.7 * std::cos(0.03 * i), 0.002 * std::sin(0.02 * i)};
}

} // namespace

TEST_SUITE("handle observer") {
    TEST_CASE(
        "with the true mass and a hand of constant force it knows motion and force, whatever the delay") {
        for (const double delay : {0.0, 0.4e-3, 1e-3, 2.7e-3}) {
            Truth truth;
            truth.delay = delay;
            HandleObserver observer(truth.step, delay, Vec3(300.0, 300.0, 500.0));
            const Wrench hand(0.5, -0.3, 0.001);
            for (int i = 0; i < 400; ++i) {
                observer.correct(truth.pose);
                const Wrench force = wave(i);
                truth.advance(force, hand);
                observer.sent(force, truth.mass);
            }
            CAPTURE(delay);
            CHECK((observer.hand_force() - hand).norm() < 1e-6);
            // where the handle will be when what is sent now begins to act
            observer.correct(truth.pose);
            Truth later = truth;
            const int whole = static_cast<int>(std::floor(delay / truth.step));
            const double late = delay / truth.step - whole;
            // the forces on their way, the oldest first
            if (late > 0.0)
                later.push(truth.past(whole) + hand, late * truth.step);
            for (int age = whole - 1; age >= 0; --age)
                later.push(truth.past(age) + hand, truth.step);
            CHECK((observer.pose() - later.pose).norm() < 1e-9);
            CHECK((observer.twist() - later.twist).norm() < 1e-6);
            later.push(hand, truth.step);
            CHECK((observer.pose_ahead() - later.pose).norm() < 1e-9);
            CHECK((observer.twist_ahead() - later.twist).norm() < 1e-6);
        }
    }

    TEST_CASE("a new force of the hand is known as fast as the bandwidth says, and overshoots by less than a "
              "fifth") {
        Truth truth;
        HandleObserver observer(truth.step, 0.0, Vec3::Constant(200.0));
        double most = 0.0;
        double after_30_ms = 0.0;
        for (int i = 0; i < 300; ++i) {
            observer.correct(truth.pose);
            const Wrench hand = i < 100 ? Wrench(Wrench::Zero()) : Wrench(1.0, 0.0, 0.0);
            truth.advance(Wrench::Zero(), hand);
            observer.sent(Wrench::Zero(), truth.mass);
            most = std::max(most, observer.hand_force().x());
            if (i == 130)
                after_30_ms = observer.hand_force().x();
        }
        CHECK(most < 1.2);
        CHECK(after_30_ms > 0.9);
        CHECK(std::abs(observer.hand_force().x() - 1.0) < 1e-6);
    }

    TEST_CASE("coarse readings: velocity and force stay within what the filter lets through") {
        Truth truth;
        const double quantum = 1e-5;
        HandleObserver observer(truth.step, 0.0, Vec3::Constant(150.0));
        truth.twist = Twist(0.05, 0.0, 0.0);
        double velocity = 0.0;
        double force = 0.0;
        for (int i = 0; i < 2000; ++i) {
            Pose seen = truth.pose;
            for (int k = 0; k < 3; ++k)
                seen(k) = quantum * std::round(seen(k) / quantum);
            observer.correct(seen);
            truth.advance(Wrench::Zero(), Wrench::Zero());
            observer.sent(Wrench::Zero(), truth.mass);
            if (i < 500)
                continue;
            velocity = std::max(velocity, std::abs(observer.twist().x() - 0.05));
            force = std::max(force, std::abs(observer.hand_force().x()));
        }
        // a difference over one sample would be off by 10 mm/s, and its derivative by 6 N
        CHECK(velocity < 1e-3);
        CHECK(force < 0.05);
    }

    TEST_CASE("readings that are not finite or missing leave it on its model") {
        Truth truth;
        HandleObserver observer(truth.step, 0.0, Vec3::Constant(300.0));
        for (int i = 0; i < 400; ++i) {
            if (i < 380)
                observer.correct(i % 3 == 1 ? Pose(Pose::Constant(std::numeric_limits<double>::quiet_NaN()))
                                            : truth.pose);
            truth.advance(wave(i), Wrench::Zero());
            observer.sent(wave(i), truth.mass);
        }
        CHECK(observer.pose().allFinite());
        CHECK((observer.pose() - truth.pose).norm() < 1e-6);
        observer.reset();
        CHECK_FALSE(observer.started());
        observer.correct(truth.pose);
        CHECK(observer.hand_force().isZero(0.0));
        CHECK(observer.twist().isZero(0.0));
    }
}
