#include <haptics/core/pantograph/presets.hpp>
#include <haptics/core/safety/encoder_check.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/pantograph/random_geometry.hpp"
#include "support/allocation_guard.hpp"

using namespace haptics;
using haptics::testing::Random;
using haptics::testing::random_geometry;

namespace {

constexpr double k_step = 1.0e-3;

// a handle path through the middle of the workspace, smooth, up to about 0.5 m/s
struct Path {
    Pose center;
    double size;
    std::array<double, 9> phase{};
    std::array<double, 9> frequency{};

    Path(const PantographKinematics& kinematics, Random& random, double size_in, double quickest)
        : center(kinematics.geometry().home)
        , size(size_in) {
        for (double& p : phase)
            p = random.uniform(0.0, 6.28);
        for (double& f : frequency)
            f = random.uniform(0.1, quickest);
    }
    [[nodiscard]] Pose at(double t) const {
        Pose pose = center;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t k = 0; k < 3; ++k)
                pose[static_cast<Eigen::Index>(axis)] +=
                    (axis == 2 ? 12.0 : 1.0) * size / 3.0 *
                    std::sin(6.28 * frequency[3 * axis + k] * t + phase[3 * axis + k]);
        return pose;
    }
};

// the device as it is: links, axes, attachments and zeros off by up to the tolerances
struct TrueDevice {
    PantographKinematics kinematics;
    JointVector zero{JointVector::Zero()};

    TrueDevice(const PantographGeometry& figures, Random& random, const EncoderCheckSettings& s, double share)
        : kinematics(disturbed(figures, random, share * s.length_tolerance)) {
        for (int i = 0; i < 4; ++i)
            zero[i] = share * s.offset_tolerance * (random.below(2) == 0 ? 1.0 : -1.0);
    }
    static PantographGeometry disturbed(PantographGeometry g, Random& random, double tolerance) {
        const auto off = [&] { return tolerance * (random.below(2) == 0 ? 1.0 : -1.0); };
        for (std::size_t b = 0; b < 2; ++b) {
            for (std::size_t k = 0; k < 2; ++k) {
                g.bar[b].proximal_length[k] += off();
                g.bar[b].distal_length[k] += off();
            }
            // shifts of both axes together, within the tolerance of each
            g.bar[b].base_center += Vec2(off(), off());
            g.attachment[b] += Vec2(off(), off());
        }
        return g;
    }
    // what the encoders say, in counts of the geometry
    [[nodiscard]] JointVector read(const PantographKinematics& figures, const Pose& pose,
                                   const JointVector& slip_counts) const {
        JointVector angles;
        kinematics.inverse(pose, angles);
        for (int i = 0; i < 4; ++i)
            angles[i] = figures.angle_of_count(i, std::round(figures.count_of_angle(i, angles[i] + zero[i])) +
                                                      slip_counts[i]);
        return angles;
    }
};

// the largest path that stays clear of every edge
double roomy_size(const PantographKinematics& kinematics, Random random) {
    for (double size = 0.08; size > 0.004; size *= 0.8) {
        bool clear = true;
        for (int k = 0; k < 300 && clear; ++k) {
            Pose pose = kinematics.geometry().home;
            for (int axis = 0; axis < 3; ++axis)
                pose[axis] += (axis == 2 ? 12.0 : 1.0) * size * random.uniform(-1.0, 1.0);
            const WorkspaceReport report = kinematics.workspace(pose);
            clear = report.inside && report.reach_margin > 0.004 && report.singularity > 0.1;
        }
        if (clear)
            return size;
    }
    return 0.004;
}

struct Run {
    bool slipped{false};
    double strain{0.0};
    int steps_to_alarm{-1};
};

Run run(const PantographKinematics& figures, const TrueDevice& device, const Path& path, EncoderCheck& check,
        double seconds, int slip_axis, double slip_counts, double slip_at) {
    Run result;
    const int steps = static_cast<int>(seconds / k_step);
    for (int k = 0; k < steps; ++k) {
        JointVector slip = JointVector::Zero();
        const bool after = slip_axis >= 0 && k * k_step >= slip_at;
        if (after)
            slip[slip_axis] = slip_counts;
        const JointVector angles = device.read(figures, path.at(k * k_step), slip);
        check.update(angles, figures.forward(angles), k_step);
        result.strain = std::max(result.strain, check.strain());
        if (check.slipped()) {
            result.slipped = true;
            result.steps_to_alarm = k - static_cast<int>(slip_at / k_step);
            return result;
        }
    }
    return result;
}

} // namespace

TEST_SUITE("encoder check") {
    TEST_CASE("an honest device within the tolerances never raises an alarm, at the edge of them either") {
        Random random(201);
        double worst = 0.0;
        for (int n = 0; n < 32; ++n) {
            const PantographGeometry g = n % 4 == 0 ? ubc_twin_pantograph() : random_geometry(random, 2);
            const PantographKinematics figures(g);
            const EncoderCheckSettings settings;
            const TrueDevice device(g, random, settings, 1.0);
            const Path path(figures, random, roomy_size(figures, random), n % 2 == 0 ? 3.0 : 0.4);
            EncoderCheck check(figures, settings);
            const Run r = run(figures, device, path, check, 5.0, -1, 0.0, 0.0);
            CAPTURE(n);
            CHECK_FALSE(r.slipped);
            worst = std::max(worst, r.strain);
        }
        MESSAGE("largest share of a bound used: " << worst);
        CHECK(worst < 1.0);
        // the bounds are no walls nobody comes near
        CHECK(worst > 0.3);
    }

    TEST_CASE("a device worse than its tolerances does raise one") {
        Random random(202);
        int alarms = 0;
        for (int n = 0; n < 20; ++n) {
            const PantographKinematics figures(ubc_twin_pantograph());
            const EncoderCheckSettings settings;
            const TrueDevice device(figures.geometry(), random, settings, 20.0);
            const Path path(figures, random, 0.05, 1.0);
            EncoderCheck check(figures, settings);
            alarms += run(figures, device, path, check, 4.0, -1, 0.0, 0.0).slipped ? 1 : 0;
        }
        CHECK(alarms > 10);
    }

    TEST_CASE("at rest every slip above the stated size is seen within four readings, at every pose") {
        Random random(203);
        double typical = 0.0;
        int seen_poses = 0;
        for (int n = 0; n < 120; ++n) {
            const PantographGeometry g = n % 2 == 0 ? ubc_twin_pantograph() : random_geometry(random, 2);
            const PantographKinematics figures(g);
            const EncoderCheckSettings settings;
            const TrueDevice device(g, random, settings, 0.9);
            const Pose pose = haptics::testing::pose_near_home(figures, random);
            const int axis = random.below(4);
            const double count = 2.0 * std::numbers::pi / g.motor.counts_per_revolution;
            const JointVector angles = device.read(figures, pose, JointVector::Zero());
            const PoseEstimate estimate = figures.forward(angles);
            EncoderCheck check(figures, settings);
            const double least = check.smallest_slip(angles, axis) / count;
            // the encoder is all but blind there
            if (!std::isfinite(least))
                continue;
            typical += least;
            ++seen_poses;
            JointVector slip = JointVector::Zero();
            slip[axis] = std::ceil(least * 1.05) * (random.below(2) == 0 ? 1.0 : -1.0);
            for (int k = 0; k < 10; ++k) {
                check.update(angles, estimate, k_step);
                REQUIRE_FALSE(check.slipped());
            }
            const JointVector after = device.read(figures, pose, slip);
            const PoseEstimate wrong = figures.forward(after);
            CHECK_FALSE(check.update(after, wrong, k_step));
            CHECK_FALSE(check.update(after, wrong, k_step));
            // a large slip first looks like a quick motion, for which the skew is allowed
            check.update(after, wrong, k_step);
            CHECK(check.update(after, wrong, k_step));
            // latched, until homed
            check.update(angles, estimate, k_step);
            CHECK(check.slipped());
            check.reset();
            CHECK_FALSE(check.slipped());
        }
        MESSAGE("mean least slip: " << typical / seen_poses << " counts, at " << seen_poses
                                    << " of 120 poses");
        CHECK(seen_poses > 80);
    }

    TEST_CASE("the assumed twin: slips of a few counts in motion, honest tolerances, no false alarm before") {
        Random random(204);
        const PantographKinematics figures(ubc_twin_pantograph());
        const EncoderCheckSettings settings;
        const std::array<double, 5> sizes{4.0, 8.0, 16.0, 32.0, 64.0};
        std::array<int, 5> seen{};
        std::array<double, 5> time{};
        constexpr int k_runs = 40;
        for (std::size_t s = 0; s < sizes.size(); ++s)
            for (int n = 0; n < k_runs; ++n) {
                const TrueDevice device(figures.geometry(), random, settings, 0.7);
                const Path path(figures, random, 0.05, 1.5);
                EncoderCheck check(figures, settings);
                const Run r = run(figures, device, path, check, 2.1, random.below(4), sizes[s], 0.6);
                CHECK((!r.slipped || r.steps_to_alarm >= 2));
                seen[s] += r.slipped ? 1 : 0;
                time[s] += r.slipped ? r.steps_to_alarm * k_step : 0.0;
            }
        for (std::size_t s = 0; s < sizes.size(); ++s)
            MESSAGE(sizes[s] << " counts: seen " << seen[s] << " of " << k_runs << " within 1.5 s, after "
                             << time[s] / std::max(1, seen[s]) << " s");
        CHECK(seen[1] > k_runs / 4);
        CHECK(seen[2] >= k_runs * 9 / 10);
        CHECK(seen[3] == k_runs);
        CHECK(seen[4] == k_runs);
    }

    TEST_CASE("a slip that creeps, and one where it hardly shows, come to light later") {
        Random random(205);
        const PantographKinematics figures(ubc_twin_pantograph());
        const EncoderCheckSettings settings;
        int seen = 0;
        for (int n = 0; n < 20; ++n) {
            const TrueDevice device(figures.geometry(), random, settings, 0.7);
            const Path path(figures, random, 0.05, 1.0);
            EncoderCheck check(figures, settings);
            for (int k = 0; k < 8000 && !check.slipped(); ++k) {
                JointVector slip = JointVector::Zero();
                // a count every tenth of a second: no two readings a moment apart tell
                slip[n % 4] = std::floor(std::max(0.0, (k - 2000) * 0.01));
                const JointVector angles = device.read(figures, path.at(k * k_step), slip);
                check.update(angles, figures.forward(angles), k_step);
            }
            seen += check.slipped() ? 1 : 0;
        }
        CHECK(seen == 20);
    }

    TEST_CASE("one torn reading is no slip") {
        const PantographKinematics figures(ubc_twin_pantograph());
        EncoderCheck check(figures);
        JointVector angles;
        figures.inverse(Pose(0.01, 0.02, 0.1), angles);
        for (int k = 0; k < 200; ++k) {
            JointVector read = angles;
            if (k % 20 < 2)
                read[k % 4] += 0.01;
            check.update(read, figures.forward(read), k_step);
        }
        CHECK_FALSE(check.slipped());
    }

    TEST_CASE("a single five-bar cannot tell, and says so") {
        const PantographKinematics figures(haply_2diy_v3());
        EncoderCheck check(figures);
        CHECK_FALSE(check.possible());
        JointVector angles;
        figures.inverse(Pose::Zero(), angles);
        CHECK(std::isinf(check.smallest_slip(angles, 0)));
        for (int k = 0; k < 100; ++k) {
            angles[0] += k == 50 ? 0.2 : 0.0;
            CHECK_FALSE(check.update(angles, figures.forward(angles), k_step));
        }
    }

    TEST_CASE("broken readings do no harm, and nothing takes from the heap") {
        const PantographKinematics figures(ubc_twin_pantograph());
        EncoderCheck check(figures);
        Random random(206);
        const double nan = std::numeric_limits<double>::quiet_NaN();
        const haptics::testing::AllocationGuard guard;
        for (int k = 0; k < 2000; ++k) {
            JointVector angles(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9),
                               random.below(9) == 0 ? nan : 1.0);
            check.update(angles, figures.forward(angles), random.below(9) == 0 ? nan : k_step);
            if (k % 50 == 0)
                check.reset();
        }
        CHECK(std::isfinite(check.residual()));
        CHECK(guard.allocations() == 0);
    }

    TEST_CASE("settings out of range are named") {
        CHECK(validate(EncoderCheckSettings{}).empty());
        EncoderCheckSettings bad;
        bad.reading_error = 0.0;
        bad.length_tolerance = std::numeric_limits<double>::quiet_NaN();
        REQUIRE(validate(bad).size() == 2);
        CHECK(validate(bad)[0].field == "reading_error");
        CHECK(validate(bad)[1].problem == FigureProblem::not_finite);
    }
}
