// Late geometry. Snapshots come at 20-120 Hz, late and unevenly; the haptic step needs poses every
// millisecond.
//
// Kinematic bodies are extrapolated from the snapshot with its velocity for at most two ticks, then brought
// to rest in k_rest seconds with a velocity that falls linearly: for u = age - 2 ticks in [0, k_rest],
// distance = u - u^2 / (2 k_rest), velocity factor = 1 - u / k_rest. When a new snapshot disagrees with the
// extrapolation, the difference becomes an offset that falls linearly to zero within one tick, so that no
// surface jumps under the hand.
//
// Movable bodies belong to the local model between ticks. A snapshot says where the environment has them
// after it was told what the model believed at the step `echo`. With B(t) the belief, C(t) the sum of
// corrections taken so far and X the environment's state at snapshot time s,
//     innovation = X - (B(echo) moved on to s with B's velocity) - (C(now) + pending - C(echo)),
// the last bracket being what has been corrected since and must not be corrected twice. It is blended in
// within one tick.

#include <algorithm>
#include <cmath>

#include "internal.hpp"

namespace haptics {
namespace {

constexpr double k_rest = 0.05;

// larger than anything in a scene, m, m/s, kg, …
constexpr double k_beyond_scene = 1e9;

template <class Vector>
bool is_in_scene(const Vector& v) {
    return (v.cwiseAbs().array() < k_beyond_scene).all(); // false for what is not a number
}

// A surface may be without bound, but not be no number.
bool is_true_surface(const Surface& s) {
    return s.stiffness >= 0.0 && s.damping >= 0.0 && s.static_friction >= 0.0 && s.dynamic_friction >= 0.0 &&
           s.restitution >= 0.0 && s.restitution <= 1.0;
}

// One number that is none would stay in the proxy for ever.
bool is_true_snapshot(const Neighborhood& n) {
    const auto body = [](const Body& b) {
        const bool massive =
            b.mass > 0.0 && b.mass < k_beyond_scene && b.inertia > 0.0 && b.inertia < k_beyond_scene;
        return is_in_scene(b.pose) && is_in_scene(b.velocity) && is_true_surface(b.surface) &&
               (b.kind != BodyKind::movable || massive);
    };
    return std::isfinite(n.time) && n.tick > 0.0 && n.tick < k_beyond_scene && is_in_scene(n.gravity) &&
           std::all_of(n.bodies.body.begin(), n.bodies.body.begin() + n.bodies.body_count, body);
}

struct Reach {
    double time;
    double rate;
};

// how far (s) and how fast (1) a body goes on from its snapshot
Reach extrapolate(double age, double tick) {
    const double full = 2.0 * tick;
    if (age <= full)
        return {std::max(age, -full), 1.0}; // a tick's own time may lie a little ahead of the loop's
    const double u = std::min(age - full, k_rest);
    return {full + u - u * u / (2.0 * k_rest), 1.0 - u / k_rest};
}

void place(Data& data, std::size_t i) {
    const Track& t = data.track[i];
    Body& b = data.neighbors.body[i];
    const double age = data.time - data.snapshot_time;
    const Reach reach = extrapolate(age, data.tick);
    const double blend = std::clamp(1.0 - age / data.tick, 0.0, 1.0);
    b.pose = t.pose + reach.time * t.velocity + blend * t.offset;
    b.velocity = reach.rate * t.velocity;
    if (blend > 0.0 && age >= 0.0)
        b.velocity -= t.offset / data.tick;
}

void copy_bodies(const BodySet& from, BodySet& to) {
    to.body_count = from.body_count;
    to.piece_count = from.piece_count;
    std::copy_n(from.body.begin(), from.body_count, to.body.begin());
    std::copy_n(from.piece.begin(), from.piece_count, to.piece.begin());
}

std::int32_t find_body(const BodySet& set, std::uint64_t id, std::int32_t hint) {
    if (hint < set.body_count && set.body[static_cast<std::size_t>(hint)].id == id)
        return hint;
    for (std::int32_t i = 0; i < set.body_count; ++i)
        if (set.body[static_cast<std::size_t>(i)].id == id)
            return i;
    return -1;
}

// patches name bodies by index: let them name the same bodies in the new list, and drop those whose body is
// gone
void rename_patches(Data& data, const BodySet& next) {
    const std::int32_t links = data.tool.body_count;
    const auto renamed = [&](std::int32_t body) {
        if (body < links)
            return body;
        const std::int32_t old = body - links;
        const std::int32_t found =
            find_body(next, data.neighbors.body[static_cast<std::size_t>(old)].id, old);
        return found < 0 ? -1 : found + links;
    };
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        Patch p = data.patches.patch[static_cast<std::size_t>(i)];
        p.body_a = renamed(p.body_a);
        p.body_b = renamed(p.body_b);
        if (p.body_a >= 0 && p.body_b >= 0)
            data.patches.patch[static_cast<std::size_t>(kept++)] = p;
    }
    data.patches.count = kept;
}

const MovableBelief* find_echo(const Neighborhood& n, const MovableBelief& belief) {
    for (std::int32_t i = 0; i < n.echo_count; ++i) {
        const MovableBelief& e = n.echo[static_cast<std::size_t>(i)];
        if (e.id == belief.id && e.epoch == belief.epoch)
            return &e;
    }
    return nullptr;
}

void correct(MovableState& m, const Body& seen, const Neighborhood& n) {
    const MovableBelief* echo = find_echo(n, m.belief);
    if (echo == nullptr)
        return; // the environment has not seen this belief yet
    const Pose expected = echo->pose + (n.time - echo->time) * echo->velocity;
    const Pose since_pose = m.belief.corrected_pose - echo->corrected_pose;
    const Twist since_velocity = m.belief.corrected_velocity - echo->corrected_velocity;
    m.pending_pose = seen.pose - expected - since_pose;
    m.pending_velocity = seen.velocity - echo->velocity - since_velocity;
    m.blend_left = n.tick;
}

void meet(MovableState& m, const Body& seen, const Data& data) {
    m = MovableState{};
    m.belief.id = seen.id;
    m.belief.epoch = data.step;
    m.belief.time = data.time;
    m.belief.pose = seen.pose + extrapolate(data.time - data.snapshot_time, data.tick).time * seen.velocity;
    m.belief.velocity = seen.velocity;
}

// forgets movables that left and whose last impulses the environment has taken
void forget_movables(Data& data, std::uint64_t echo_step) {
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        const MovableState m = data.movable[static_cast<std::size_t>(i)];
        if (m.body >= 0 || m.given_step > echo_step)
            data.movable[static_cast<std::size_t>(kept++)] = m;
    }
    data.movable_count = kept;
}

void take_movables(const Neighborhood& n, Data& data) {
    for (std::int32_t i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].body = -1;
    data.movable_overflow = 0;
    for (std::int32_t b = 0; b < data.neighbors.body_count; ++b) {
        const Body& seen = data.neighbors.body[static_cast<std::size_t>(b)];
        if (seen.kind != BodyKind::movable)
            continue;
        std::int32_t slot = 0;
        while (slot < data.movable_count && data.movable[static_cast<std::size_t>(slot)].belief.id != seen.id)
            ++slot;
        if (slot == k_max_movables) {
            ++data.movable_overflow;
            continue;
        }
        MovableState& m = data.movable[static_cast<std::size_t>(slot)];
        if (slot == data.movable_count) {
            meet(m, seen, data);
            ++data.movable_count;
        } else {
            correct(m, seen, n);
        }
        m.body = b;
    }
    forget_movables(data, n.echo_step);
}

} // namespace

void take_neighborhood(const Neighborhood& n, Data& data) {
    if (n.sequence <= data.sequence || !is_true_snapshot(n))
        return;
    rename_patches(data, n.bodies);
    // the offset of a body that stays: where it is now less where the new snapshot puts it now
    std::array<Track, k_max_bodies> next;
    const Reach reach = extrapolate(data.time - n.time, n.tick);
    for (std::int32_t i = 0; i < n.bodies.body_count; ++i) {
        const Body& b = n.bodies.body[static_cast<std::size_t>(i)];
        Track& t = next[static_cast<std::size_t>(i)];
        t.pose = b.pose;
        t.velocity = b.velocity;
        const std::int32_t old = data.sequence == 0 ? -1 : find_body(data.neighbors, b.id, i);
        if (old >= 0 && b.kind == BodyKind::kinematic) {
            const double age = std::max(data.time - n.time, 0.0);
            const double blend = std::max(1.0 - age / n.tick, 1e-3);
            t.offset = (data.neighbors.body[static_cast<std::size_t>(old)].pose -
                        (t.pose + reach.time * t.velocity)) /
                       blend;
        }
    }
    copy_bodies(n.bodies, data.neighbors);
    std::copy_n(next.begin(), n.bodies.body_count, data.track.begin());
    data.sequence = n.sequence;
    data.snapshot_time = n.time;
    data.tick = n.tick;
    data.gravity = n.gravity;
    data.plan = n.plan;
    take_movables(n, data);
    local::move_neighbors(data, 0.0);
}

void pass_time(Data& data, double seconds) {
    local::move_neighbors(data, seconds);
}

namespace local {

void move_neighbors(Data& data, double dt) {
    data.time += dt;
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i)
        if (data.neighbors.body[static_cast<std::size_t>(i)].kind == BodyKind::kinematic)
            place(data, static_cast<std::size_t>(i));
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        MovableBelief& s = m.belief;
        s.time = data.time;
        if (m.row < 0)
            s.pose += dt * s.velocity;
        if (m.blend_left > 0.0 && dt > 0.0) {
            const double part = std::min(1.0, dt / m.blend_left);
            const Pose pose = part * m.pending_pose;
            const Twist velocity = part * m.pending_velocity;
            s.pose += pose;
            s.velocity += velocity;
            s.corrected_pose += pose;
            s.corrected_velocity += velocity;
            m.pending_pose -= pose;
            m.pending_velocity -= velocity;
            m.blend_left -= dt;
        }
        if (m.body >= 0) {
            data.neighbors.body[static_cast<std::size_t>(m.body)].pose = s.pose;
            data.neighbors.body[static_cast<std::size_t>(m.body)].velocity = s.velocity;
        }
    }
}

} // namespace local
} // namespace haptics
