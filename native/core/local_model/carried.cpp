// What the tool carries: movables that nothing holds but the tool, alone or in heaps.
//
// Such a body moves by the tool's push and its weight alone, in the environment as here. The environment
// hears of the push late, and of some of it later still: until then the body falls there, and its velocity
// lacks u(t), what it has yet to hear, -g times the lag that varies. Nothing of that is a difference between
// the two: with u added, environment and belief agree whatever was lost (movables.cpp). But u keeps the body
// sinking in the environment by its mean, so it is to be ahead by c, the lift: the belief is
// corrected by -dc, which the tool that holds it there answers with an impulse more, of which the environment
// hears. With e how far the body lies below the belief there,
//     e' = u - c.
// The tool feels m c'. With c' = w^2 e + 2 w (mean of u - c) it feels no jump, whatever e and u do, and where
// u keeps its mean e'' + 2 w e' + w^2 e = 0. A heap has one lift, or its bodies would press on each other.
//
// Free. Here no patch may join the heap to anything but the tool. That the environment does not hold it
// either (a plank whose far end lies on what is not near the tool) shows in how it changes the velocity from
// one snapshot to the next: by what it was told and the fall, if nothing else is there.

#include <algorithm>
#include <array>
#include <cmath>

#include "internal.hpp"
#include "movables.hpp"

namespace haptics::local {
namespace {

// w, 1/s, on a good line, and w t on a bad one; over how many 1/w the mean of u is taken; most of c' by g
constexpr double k_lift = 1.5;
constexpr double k_quiet = 0.13;
constexpr double k_memory = 1.5;
constexpr double k_most = 0.25;
// weight of the last change of velocity in the sums that tell whether a body is free, and the share of it
// that may be odd
constexpr double k_answer = 0.2;
constexpr double k_odd = 0.3;

// w; the mean of what is to be heard is g times the mean time until the next report is
double lift_rate(double untold, double fall) {
    return untold > 0.0 ? std::min(k_lift, k_quiet * fall / untold) : k_lift;
}

using Heaps = std::array<std::int32_t, k_max_movables>;

// Finds the heaps of movables that touch each other, each named by the first in it, and marks as free those
// that nothing holds but the tool, here and in the environment.
void find_free(Data& data, Heaps& heap) {
    const auto count = static_cast<std::size_t>(data.movable_count);
    std::array<bool, k_max_movables> held{};
    for (std::size_t i = 0; i < count; ++i) {
        const MovableState& m = data.movable[i];
        heap[i] = static_cast<std::int32_t>(i);
        held[i] = m.row < 0 || m.body < 0 || !(m.odd_change < k_odd * m.known_change) ||
                  data.neighbors.body[static_cast<std::size_t>(m.body)].jointed;
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::int32_t i = 0; i < data.patches.count; ++i) {
            const Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
            if (p.body_a < data.tool.body_count || p.body_b < data.tool.body_count)
                continue;
            const std::int32_t a = movable_of(data, p.body_a);
            const std::int32_t b = movable_of(data, p.body_b);
            const bool holds =
                a < 0 || b < 0 || held[static_cast<std::size_t>(a)] || held[static_cast<std::size_t>(b)];
            const std::int32_t first =
                a < 0   ? heap[static_cast<std::size_t>(b)]
                : b < 0 ? heap[static_cast<std::size_t>(a)]
                        : std::min(heap[static_cast<std::size_t>(a)], heap[static_cast<std::size_t>(b)]);
            for (const std::int32_t k : {a, b}) {
                if (k < 0 || (held[static_cast<std::size_t>(k)] == holds &&
                              heap[static_cast<std::size_t>(k)] == first))
                    continue;
                held[static_cast<std::size_t>(k)] = holds;
                heap[static_cast<std::size_t>(k)] = first;
                changed = true;
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i)
        data.movable[i].free = !held[i];
}

// Brings the environment up to what the tool bears: the heap weighs so much more or less for a while, by too
// little to be felt.
void lift(const Heaps& heap, double dt, Data& data) {
    if (dt <= 0.0)
        return;
    const auto count = static_cast<std::size_t>(data.movable_count);
    for (std::size_t first = 0; first < count; ++first) {
        if (heap[first] != static_cast<std::int32_t>(first) || !data.movable[first].free)
            continue;
        double mass = 0.0;
        Vec2 weight = Vec2::Zero();
        Vec2 lead = Vec2::Zero();
        Vec2 speed = Vec2::Zero(); // lift, and what is to be heard
        for (std::size_t i = first; i < count; ++i) {
            const MovableState& m = data.movable[i];
            if (heap[i] != heap[first])
                continue;
            const Body& b = data.neighbors.body[static_cast<std::size_t>(m.body)];
            mass += b.mass;
            weight += b.mass * fall_of(data.gravity, b);
            lead += b.mass * m.lead.head<2>();
            speed += b.mass * Vec2(m.lift, m.mean_untold);
        }
        const double fall = weight.norm() / mass;
        if (fall == 0.0)
            continue;
        const Vec2 down = weight.normalized();
        const Vec3 mean = Vec3(-lead.dot(down), speed.x(), speed.y()) / mass;
        const double w = lift_rate(mean[2], fall);
        const double most = k_most * fall;
        const double rate = std::clamp(w * (w * mean[0] + 2.0 * (mean[2] - mean[1])), -most, most);
        for (std::size_t i = first; i < count; ++i) {
            MovableState& m = data.movable[i];
            if (heap[i] != heap[first])
                continue;
            const double change = dt * (rate + 2.0 * w * (mean[1] - m.lift));
            m.lift += change;
            add_velocity(m, Twist(change * down.x(), change * down.y(), 0.0));
        }
    }
}

} // namespace

void watch_answer(const Body& seen, const MovableBelief& echo, const Neighborhood& n, MovableState& m) {
    const Vec3 radius(1.0, 1.0, std::sqrt(seen.inertia / seen.mass));
    const Twist told = (echo.given - m.seen_given).cwiseQuotient(Vec3(seen.mass, seen.mass, seen.inertia));
    const Vec2 gravity = fall_of(n.gravity, seen);
    const Twist fall = (n.time - m.seen_time) * Twist(gravity.x(), gravity.y(), 0.0);
    const Twist odd = seen.velocity - m.seen_velocity - told - fall;
    const double known = radius.cwiseProduct(told).norm() + radius.cwiseProduct(fall).norm();
    m.odd_change += k_answer * (radius.cwiseProduct(odd).norm() - m.odd_change);
    m.known_change += k_answer * (known - m.known_change);
    m.seen_velocity = seen.velocity;
    m.seen_time = n.time;
    m.seen_given = echo.given;
}

void hear(double untold, double tick, double fall, MovableState& m) {
    const double part = std::min(1.0, tick * lift_rate(m.mean_untold, fall) / k_memory);
    m.mean_untold += part * (untold - m.mean_untold);
}

void lift_carried(Data& data, double dt) {
    if (data.movable_count == 0)
        return;
    Heaps heap;
    find_free(data, heap);
    lift(heap, dt, data);
}

} // namespace haptics::local
