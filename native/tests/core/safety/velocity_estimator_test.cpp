#include <haptics/core/safety/velocity_estimator.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/allocation_guard.hpp"

using namespace haptics;

namespace {

constexpr double k_sample = 1.0e-3;
constexpr double k_quantum = 25.0e-6;

double quantized(double x) {
    return std::round(x / k_quantum) * k_quantum;
}

struct Errors {
    double estimate;
    double difference;
};

// RMS errors of the estimator and of a plain difference on a quantized motion
template <typename Motion, typename Speed>
Errors compare(Motion motion, Speed speed) {
    VelocityEstimator estimator(Vec3::Constant(0.5 * k_quantum));
    double sum = 0.0;
    double plain = 0.0;
    double last = quantized(motion(0.0));
    int count = 0;
    for (int k = 1; k < 4000; ++k) {
        const double x = quantized(motion(k * k_sample));
        const double v = estimator.update(Pose(x, 0.0, 0.0), k_sample).x();
        if (k > 100) {
            sum += std::pow(v - speed(k * k_sample), 2.0);
            plain += std::pow((x - last) / k_sample - speed(k * k_sample), 2.0);
            ++count;
        }
        last = x;
    }
    return {std::sqrt(sum / count), std::sqrt(plain / count)};
}

} // namespace

TEST_SUITE("velocity estimator") {
    TEST_CASE("constant speed comes out within twice the reading error over the window") {
        for (const double speed : {0.0005, 0.003, 0.02, 0.3}) {
            VelocityEstimator estimator(Vec3::Constant(0.5 * k_quantum), 20);
            double worst = 0.0;
            for (int k = 0; k < 3000; ++k) {
                const double v =
                    estimator.update(Pose(quantized(speed * k * k_sample), 0.0, 0.0), k_sample).x();
                if (k > 50)
                    worst = std::max(worst, std::abs(v - speed));
            }
            CHECK(estimator.window()[0] == 20);
            CHECK(worst <= k_quantum / (20 * k_sample) * 1.0001);
        }
    }

    TEST_CASE("a 25 um encoder: much less noise than differences in slow motion, little lag in fast") {
        const Errors slow = compare([](double t) { return 0.002 * std::sin(3.0 * t); },
                                    [](double t) { return 0.006 * std::cos(3.0 * t); });
        MESSAGE("slow: " << slow.estimate << " m/s RMS, differences " << slow.difference);
        CHECK(slow.estimate < 0.2 * slow.difference);
        const Errors fast = compare([](double t) { return 0.04 * std::sin(12.0 * t); },
                                    [](double t) { return 0.48 * std::cos(12.0 * t); });
        MESSAGE("fast: " << fast.estimate << " m/s RMS, differences " << fast.difference);
        CHECK(fast.estimate < 0.03 * 0.48); // lags half a window
    }

    TEST_CASE("a sudden stop is seen within the error, with no long tail") {
        VelocityEstimator estimator(Vec3::Constant(0.5 * k_quantum));
        for (int k = 0; k <= 100; ++k)
            estimator.update(Pose(0.3 * k * k_sample, 0.0, 0.0), k_sample);
        Twist v = Twist::Zero();
        for (int k = 0; k < 2; ++k)
            v = estimator.update(Pose(0.03, 0.0, 0.0), k_sample);
        CHECK(std::abs(v.x()) < 1.0e-9);
    }

    TEST_CASE("uneven steps do not matter") {
        VelocityEstimator estimator(Vec3::Constant(1.0e-9));
        double t = 0.0;
        Twist v = Twist::Zero();
        for (int k = 0; k < 100; ++k) {
            const double dt = k % 3 == 0 ? 0.5e-3 : 1.7e-3;
            t += dt;
            v = estimator.update(Pose(0.2 * t, -0.1 * t, 3.0 * t), dt);
        }
        CHECK((v - Twist(0.2, -0.1, 3.0)).norm() < 1.0e-5);
    }

    TEST_CASE("broken samples are ignored, and nothing allocates") {
        VelocityEstimator estimator(Vec3::Constant(1.0e-6));
        const haptics::testing::AllocationGuard guard;
        for (int k = 0; k < 50; ++k)
            estimator.update(Pose(0.1 * k * k_sample, 0.0, 0.0), k_sample);
        const double before = estimator.velocity().x();
        const double nan = std::numeric_limits<double>::quiet_NaN();
        estimator.update(Pose(nan, 0.0, 0.0), k_sample);
        estimator.update(Pose::Zero(), 0.0);
        estimator.update(Pose::Zero(), nan);
        const auto allocations = guard.allocations();
        CHECK(allocations == 0);
        CHECK(estimator.velocity().x() == before);
        CHECK(before == doctest::Approx(0.1));
    }
}
