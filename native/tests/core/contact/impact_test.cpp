#include <haptics/core/contact/detection.hpp>
#include <haptics/core/contact/seams.hpp>
#include <haptics/core/contact/time_of_impact.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>

#include "contact_scenes.hpp"

using namespace haptics;
using namespace haptics::testing;

namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

double point_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-300), 0.0, 1.0);
    return (p - a - t * ab).norm();
}

/// Distance of two polygons by trying every vertex against every edge; 0 when one holds a vertex of the
/// other.
double brute_distance(const Convex& a, const Pose& pose_a, const Convex& b, const Pose& pose_b) {
    const Transform ta(pose_a);
    const Transform tb(pose_b);
    double least = std::numeric_limits<double>::infinity();
    const auto one_way = [&least](const Convex& p, const Transform& tp, const Convex& q,
                                  const Transform& tq) {
        for (int i = 0; i < p.count; ++i) {
            const Vec2 v = tp.apply(p.vertex[static_cast<std::size_t>(i)]);
            bool inside = q.count > 2;
            for (int k = 0; k < q.count; ++k) {
                const Vec2 e0 = tq.apply(q.vertex[static_cast<std::size_t>(k)]);
                const Vec2 e1 = tq.apply(q.vertex[static_cast<std::size_t>((k + 1) % q.count)]);
                least = std::min(least, point_segment(v, e0, e1));
                inside = inside && cross(e1 - e0, v - e0) > 0.0;
            }
            if (inside)
                least = 0.0;
        }
    };
    one_way(a, ta, b, tb);
    one_way(b, tb, a, ta);
    for (int i = 0; i < a.count; ++i) {
        for (int k = 0; k < b.count; ++k) { // crossing edges
            const Vec2 p0 = ta.apply(a.vertex[static_cast<std::size_t>(i)]);
            const Vec2 p1 = ta.apply(a.vertex[static_cast<std::size_t>((i + 1) % a.count)]);
            const Vec2 q0 = tb.apply(b.vertex[static_cast<std::size_t>(k)]);
            const Vec2 q1 = tb.apply(b.vertex[static_cast<std::size_t>((k + 1) % b.count)]);
            if (cross(p1 - p0, q0 - p0) * cross(p1 - p0, q1 - p0) < 0.0 &&
                cross(q1 - q0, p0 - q0) * cross(q1 - q0, p1 - q0) < 0.0)
                least = 0.0;
        }
    }
    return least - a.radius - b.radius;
}

Convex random_convex(Random& random) {
    if (random() % 5 == 0)
        return make_disc(Vec2{between(random, -0.005, 0.005), 0}, between(random, 0.001, 0.01));
    if (random() % 5 == 0)
        return make_capsule(Vec2{-0.01, 0}, Vec2{between(random, 0.0, 0.01), 0.002},
                            between(random, 0.0, 0.005));
    const int count = 3 + static_cast<int>(random() % 10);
    std::vector<Vec2> outline;
    for (int i = 0; i < count; ++i) {
        const double angle = (6.2831853 * i + between(random, 0, 3.0)) / count;
        outline.push_back(Vec2{0.02 * std::cos(angle), 0.015 * std::sin(angle)});
    }
    return make_convex(outline, random() % 2 == 0 ? 0.0 : 0.002);
}

} // namespace

TEST_CASE("the gap of two separate pieces is their brute-force distance, and the normal its direction") {
    Random random(5);
    int seen = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        CAPTURE(trial);
        auto tool = make_set();
        auto set = make_set();
        const Convex a = random_convex(random);
        const Convex b = random_convex(random);
        const Pose at_a{between(random, -0.05, 0.05), between(random, -0.05, 0.05), between(random, -3, 3)};
        const Pose at_b{0, 0, between(random, -3, 3)};
        if (a.count == 0 || b.count == 0)
            continue;
        const double truth = brute_distance(a, at_a, b, at_b);
        if (truth <= 1e-6 - a.radius - b.radius) // the cores overlap
            continue;
        add_body(*tool, 0, BodyKind::tool, at_a, {a});
        add_body(*set, 1, BodyKind::fixed, at_b, {b});
        DetectionSettings settings;
        settings.margin = 1.0;
        PatchList patches;
        detect_patches(*tool, *set, settings, patches, patches);
        REQUIRE(patches.count == 1);
        const Patch& patch = patches.patch[0];
        double gap = patch.point[0].gap;
        if (patch.point_count > 1)
            gap = std::min(gap, patch.point[1].gap);
        REQUIRE(gap == doctest::Approx(truth).epsilon(1e-9).scale(1e-3));
        // backing off along the normal by h adds h
        const Pose moved = at_a + Pose{1e-6 * patch.normal.x(), 1e-6 * patch.normal.y(), 0};
        REQUIRE(brute_distance(a, moved, b, at_b) - truth == doctest::Approx(1e-6).epsilon(1e-3));
        ++seen;
    }
    CHECK(seen > 5000);
}

TEST_CASE("the time of impact is where sampling and bisection find the first touch") {
    Random random(6);
    int hits = 0;
    for (int trial = 0; trial < 1500; ++trial) {
        CAPTURE(trial);
        auto tool = make_set();
        auto set = make_set();
        const Convex a = random_convex(random);
        const Convex b = random_convex(random);
        if (a.count == 0 || b.count == 0)
            continue;
        const Vec2 away = rotate(between(random, -3.14, 3.14), Vec2{between(random, 0.03, 0.06), 0});
        const Pose at_a{away.x(), away.y(), between(random, -3, 3)};
        const Twist twist_a{-away.x() * between(random, 5, 80), -away.y() * between(random, 5, 80),
                            between(random, -200, 200)};
        const Twist twist_b{between(random, -2, 2), 0, random() % 2 == 0 ? 0.0 : between(random, -50, 50)};
        const double step = 0.02;
        if (brute_distance(a, at_a, b, Pose{0, 0, 0}) <= 0.0)
            continue;
        add_body(*tool, 0, BodyKind::tool, at_a, {a}).velocity = twist_a;
        add_body(*set, 1, BodyKind::kinematic, Pose{0, 0, 0}, {b}).velocity = twist_b;
        DetectionSettings settings;
        settings.step = step;
        PatchList patches;
        detect_patches(*tool, *set, settings, patches, patches);
        const auto gap_at = [&](double t) { return brute_distance(a, at_a + t * twist_a, b, t * twist_b); };
        // truth
        double truth = std::numeric_limits<double>::infinity();
        const int samples = 4000;
        double lowest = 1.0;
        // no gap closes faster: samples it cannot reach are left out
        const auto fastest = [](const Convex& shape, const Twist& twist) {
            double reach = 0.0;
            for (int k = 0; k < shape.count; ++k)
                reach = std::max(reach, shape.vertex[static_cast<std::size_t>(k)].norm());
            return twist.head<2>().norm() + std::abs(twist.z()) * (reach + shape.radius);
        };
        const double closing = fastest(a, twist_a) + fastest(b, twist_b);
        for (int i = 1; i <= samples; ++i) {
            const double t = step * i / samples;
            const double gap = gap_at(t);
            lowest = std::min(lowest, gap);
            if (gap > 0.0) {
                i += static_cast<int>(gap / (closing * step / samples));
                continue;
            }
            double low = step * (i - 1) / samples;
            double high = t;
            for (int k = 0; k < 60; ++k) {
                const double middle = 0.5 * (low + high);
                (gap_at(middle) > 0.0 ? low : high) = middle;
            }
            truth = low;
            break;
        }
        if (patches.count == 0) {
            CHECK(std::isinf(truth));
            continue;
        }
        Patch patch = patches.patch[0];
        double found = time_of_impact(*tool, *set, patch, twist_a, twist_b, step);
        if (std::isinf(truth)) {
            if (lowest > 1e-6)
                CHECK(std::isinf(found));
            continue;
        }
        if (std::isinf(found)) { // turned by more than the patch allows: ask with the normal at the impact
            const Vec2 then = (at_a + truth * twist_a).head<2>() - (truth * twist_b).head<2>();
            patch.normal = then.normalized();
            found = time_of_impact(*tool, *set, patch, twist_a, twist_b, step);
        }
        REQUIRE(std::isfinite(found));
        CHECK(found <= truth + 1e-12);
        CHECK(gap_at(found) >= -1e-12);
        CHECK(gap_at(found) <= 1.1e-9);
        ++hits;
    }
    CHECK(hits > 300);
}

TEST_CASE("a wall of 1 mm is not passed at 10 or 50 m/s with steps of 2 ms, cut or whole") {
    for (const double speed : {10.0, 50.0}) {
        for (const int pieces : {1, 7}) {
            for (int phase = 0; phase < 40; ++phase) {
                CAPTURE(speed);
                CAPTURE(pieces);
                CAPTURE(phase);
                auto tool = make_set();
                auto set = make_set();
                for (int i = 0; i < pieces; ++i)
                    add_body(*set, static_cast<std::uint64_t>(10 + i), BodyKind::fixed, Pose{0, 0, 0},
                             {make_box(Vec2{-0.1 + (i + 0.5) * 0.2 / pieces, -0.0005},
                                       Vec2{0.2 / pieces, 0.001})});
                mark_seams(*set);
                Body& body = add_body(*tool, 0, BodyKind::tool, Pose{-0.02, 0.06 + 0.001 * phase, 0.3},
                                      {make_box(Vec2{0, 0}, Vec2{0.01, 0.01})});
                const Twist twist{0.3 * speed, -speed, 20.0};
                body.velocity = twist;
                DetectionSettings settings;
                settings.step = 0.002;
                PatchList patches;
                bool hit = false;
                for (int step = 0; step < 20 && !hit; ++step) {
                    detect_patches(*tool, *set, settings, patches, patches);
                    for (int i = 0; i < patches.count; ++i) {
                        const double t =
                            time_of_impact(*tool, *set, patches.patch[static_cast<std::size_t>(i)], twist,
                                           Twist{0, 0, 0}, settings.step);
                        if (std::isinf(t))
                            continue;
                        const Pose there = body.pose + t * twist;
                        double low = 1.0;
                        for (const Vec2& v : {Vec2{-0.005, -0.005}, Vec2{0.005, -0.005}, Vec2{0.005, 0.005},
                                              Vec2{-0.005, 0.005}})
                            low = std::min(low, Transform(there).apply(v).y());
                        CHECK(low >= 0.0);
                        CHECK(low <= 1.1e-9);
                        CHECK(patches.patch[static_cast<std::size_t>(i)].normal.y() > 0.9);
                        hit = true;
                    }
                    body.pose += settings.step * twist;
                }
                CHECK(hit);
            }
        }
    }
}
