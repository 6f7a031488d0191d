// Late geometry: snapshots come at 20-120 Hz, late and unevenly; the haptic step needs poses every
// millisecond. Bodies that the scene moves follow the path of path.cpp, movable ones the beliefs of
// movables.cpp, what appears or leaves while it is touched fades (fading.cpp).
//
// Latency. The age of a snapshot on arrival is known. So is how old the one before had become by then, beyond
// its tick: that tells of jitter and of lost snapshots. The larger of the two counts, and is forgotten in
// k_latency_memory seconds; a snapshot that was waited for longer than k_longest_latency means that the
// environment stood still, not that it is that late.

#include <algorithm>
#include <cmath>

#include "appear.hpp"
#include "fading.hpp"
#include "gentle.hpp"
#include "internal.hpp"
#include "movables.hpp"
#include "path.hpp"

namespace haptics {
namespace {

using namespace local;

constexpr double k_longest_latency = 0.15;
constexpr double k_latency_memory = 4.0;
constexpr double k_turn = 6.28318530717958647692;
// a body that would have to be faster than this to get where the snapshot has it has been put there, m/s
constexpr double k_teleport = 5.0;

// where the force has to go on gently, s
constexpr double k_longest_blend = 0.1;

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
               is_in_scene(b.acceleration) && (b.kind != BodyKind::movable || massive);
    };
    return std::isfinite(n.time) && n.tick > 0.0 && n.tick < k_beyond_scene && is_in_scene(n.gravity) &&
           std::all_of(n.bodies.body.begin(), n.bodies.body.begin() + n.bodies.body_count, body);
}

void place(Data& data, std::size_t i) {
    const PathPoint p = shown(data.track[i], data.time);
    data.neighbors.body[i].pose = p.pose;
    data.neighbors.body[i].velocity = p.velocity;
}

// moves what the scene moves to where it is shown now, and lets fade what fades
void place_neighbors(Data& data, double dt) {
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Track& t = data.track[k];
        if (t.driven && !(t.still && t.offset.is_zero()))
            place(data, k);
    }
    fade(dt, data);
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
void rename_patches(const std::array<std::uint64_t, k_max_bodies>& old_id, Data& data) {
    const std::int32_t links = data.tool.body_count;
    const auto rename = [&](std::int32_t& body) {
        if (body < links)
            return true;
        const std::int32_t old = body - links;
        const std::int32_t found = find_body(data.neighbors, old_id[static_cast<std::size_t>(old)], old);
        body = found + links;
        return found >= 0;
    };
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        Patch p = data.patches.patch[static_cast<std::size_t>(i)];
        if (!rename(p.body_a) || !rename(p.body_b))
            continue;
        if (p.body_b >= links) // a wall may begin to move, or come to rest for good
            p.side.fixed_b =
                data.neighbors.body[static_cast<std::size_t>(p.body_b - links)].kind == BodyKind::fixed;
        data.patches.patch[static_cast<std::size_t>(kept++)] = p;
    }
    data.patches.count = kept;
}

void learn_latency(const Neighborhood& n, Data& data) {
    double seen = std::clamp(data.time - n.time, 0.0, k_longest_latency);
    const double waited = data.time - data.snapshot_time - data.tick;
    if (data.sequence > 0 && waited <= k_longest_latency)
        seen = std::max(seen, waited);
    const double part =
        data.sequence == 0 ? 1.0 : std::clamp((n.time - data.snapshot_time) / k_latency_memory, 0.0, 1.0);
    data.latency = std::max(seen, data.latency + part * (seen - data.latency));
}

// where and how neighbor `i` is shown now
PathPoint shown_now(const Data& data, std::size_t i) {
    if (data.track[i].driven)
        return shown(data.track[i], data.time);
    return moving_point(data.neighbors.body[i].pose, data.neighbors.body[i].velocity, Vec3::Zero());
}

Track track_of(const Body& body, const Neighborhood& n, const Data& data) {
    Track t;
    t.pose = body.pose;
    t.velocity = t.told = body.velocity;
    t.time = n.time;
    t.tick = std::max(n.tick, 1e-6);
    t.reach = 2.0 * n.tick + data.latency;
    t.taken = data.time;
    t.blend = t.tick;
    t.still = body.kind == BodyKind::fixed;
    return t;
}

// lets the path of a body go on from its last one; false when the body has been put somewhere else
bool follow(const Data& data, std::size_t old, Track& t) {
    const PathPoint from = shown_now(data, old);
    const Track& before = data.track[old];
    t.pose.z() += k_turn * std::round((before.pose.z() - t.pose.z()) / k_turn);
    const double gap = std::max(t.time - before.time, t.tick);
    const Pose jump = t.pose - extrapolated(before, t.time).pose;
    if (jump.head<2>().norm() > k_teleport * gap)
        return false;
    t.presence = before.presence;
    if (before.driven && !before.still && !t.still)
        estimate(before, t);
    const PathPoint to = extrapolated(t, t.taken);
    const double least = blend_time(before, t);
    t.felt = 0.0;
    join(from, to, t);
    const Blending blending = gentle_blending(data, static_cast<std::int32_t>(old), t.offset, least,
                                              std::max(k_longest_blend, least));
    t.blend = blending.time;
    t.felt = blending.felt;
    join(from, to, t);
    return true;
}

// whether the model moves that body itself, so that it is shown where the model has it
bool is_own(const Body& body, const Track& before) {
    return body.kind == BodyKind::movable && !body.jointed && !before.driven;
}

// Of what the model moves, what the scene has put elsewhere is there at once, and new. How far the scene is
// from the model counts, not from where it was: it may have been told a lot since.
void follow_moved_away(double gap, std::array<bool, k_max_bodies>& fresh, Data& data) {
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.body < 0 || m.pending_pose.head<2>().norm() <= k_teleport * gap)
            continue;
        add_pose(m, m.pending_pose);
        m.pending_pose.setZero();
        fresh[static_cast<std::size_t>(m.body)] = true;
    }
}

// lets a body that is in nobody's way be where it should be one tick from now
void hurry(Data& data, std::int32_t i) {
    Track& t = data.track[static_cast<std::size_t>(i)];
    if (!t.driven || is_touched(data, i))
        return;
    Body& body = data.neighbors.body[static_cast<std::size_t>(i)];
    const Pose here = body.pose;
    body.pose = extrapolated(t, t.taken + t.tick).pose;
    if (!is_stood_in(data, i))
        t.blend = t.tick;
    body.pose = here;
}

// whether there is what the plan of the scene does not know of: what fades, a fixed body on its way, a
// movable one that found no place
bool is_beyond_plan(const Neighborhood& n, const Data& data) {
    if (data.neighbors.body_count > n.bodies.body_count || data.movable_overflow > 0)
        return true;
    const auto end = data.track.begin() + n.bodies.body_count;
    return std::any_of(data.track.begin(), end,
                       [](const Track& t) { return t.presence < 1.0 || (t.still && !t.offset.is_zero()); });
}

} // namespace

void take_neighborhood(const Neighborhood& n, Data& data) {
    if (n.sequence <= data.sequence || !is_true_snapshot(n))
        return;
    move_anchors(data);
    learn_latency(n, data);
    const bool first = data.sequence == 0; // what the loop starts in has been there before
    std::array<bool, k_max_bodies> fresh;
    std::array<std::uint64_t, k_max_bodies> old_id;
    for (std::int32_t i = 0; i < n.bodies.body_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        Track& t = data.next_track[k] = track_of(n.bodies.body[k], n, data);
        const std::int32_t old = find_body(data.neighbors, n.bodies.body[k].id, i);
        const auto was = static_cast<std::size_t>(old);
        fresh[k] = old < 0 || !follow(data, was, t);
        if (fresh[k] && old >= 0 && is_own(n.bodies.body[k], data.track[was])) {
            fresh[k] = false;
            t.presence = data.track[was].presence;
        }
    }
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i)
        old_id[static_cast<std::size_t>(i)] = data.neighbors.body[static_cast<std::size_t>(i)].id;
    save_leavers(n.bodies, data);

    // the new picture
    copy_bodies(n.bodies, data.neighbors);
    std::copy_n(data.next_track.begin(), n.bodies.body_count, data.track.begin());
    append_leavers(data);
    data.neighbor_cache.known = false;
    data.sequence = n.sequence;
    const double gap = std::max(n.time - data.snapshot_time, n.tick);
    data.snapshot_time = n.time;
    data.tick = n.tick;
    data.gravity = n.gravity;
    for (std::int32_t i = 0; i < data.tool.body_count; ++i)
        data.tool.body[static_cast<std::size_t>(i)].mask = ~n.tool_ignores[static_cast<std::size_t>(i)];
    data.plan = n.plan;
    take_movables(n, data);
    follow_moved_away(gap, fresh, data);
    rename_patches(old_id, data);
    place_neighbors(data, 0.0);
    move_movables(data, 0.0);

    // what nothing touches or will stand in where it goes has a tick for that, however far it had come to
    // rest
    for (std::int32_t i = 0; i < n.bodies.body_count; ++i)
        if (data.track[static_cast<std::size_t>(i)].blend > data.track[static_cast<std::size_t>(i)].tick)
            hurry(data, i);

    // what appears around the tool
    for (std::int32_t i = 0; i < n.bodies.body_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!first && fresh[k] && is_stood_in(data, i))
            appear(data, i);
    }
    if (is_beyond_plan(n, data))
        data.plan = Plan{};
}

void pass_time(Data& data, double seconds) {
    move_neighbors(data, seconds);
}

namespace local {

void move_neighbors(Data& data, double dt) {
    data.time += dt;
    // what is on its way or fades is beyond the scene's plan, see take_neighborhood
    if (data.plan.runs(Stage::moving_walls))
        place_neighbors(data, dt);
    move_movables(data, dt);
}

void move_anchors(Data& data) {
    const auto correction = [&data](std::int32_t body) -> Pose {
        const std::int32_t i = body - data.tool.body_count;
        if (i < 0)
            return Pose::Zero();
        const Track& t = data.track[static_cast<std::size_t>(i)];
        return t.driven && !t.settled ? Pose(corrected(t, data.time) - t.anchored) : Pose(Pose::Zero());
    };
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
        if (p.memory.state == ContactState::none)
            continue;
        const Pose by_a = correction(p.body_a);
        const Pose by_b = correction(p.body_b);
        if (by_a.isZero(0.0) && by_b.isZero(0.0))
            continue;
        Vec2 middle{0.0, 0.0};
        for (std::int32_t k = 0; k < p.point_count; ++k)
            middle +=
                p.point[static_cast<std::size_t>(k)].weight * p.point[static_cast<std::size_t>(k)].position;
        const auto moved = [&](std::int32_t body, const Pose& by) {
            return velocity_at(by, middle - body_of(data, body).pose.head<2>());
        };
        const Vec2 apart = moved(p.body_a, by_a) - moved(p.body_b, by_b);
        const Vec2 tangent = perpendicular(p.normal);
        if (p.memory.state == ContactState::sticking)
            p.memory.slip_spring += tangent.dot(apart);
        if (p.body_a < data.tool.body_count)
            data.correction_work -=
                p.memory.normal_force * p.normal.dot(apart) + p.memory.tangent_force * tangent.dot(apart);
    }
    for (std::int32_t i = 0; i < data.neighbors.body_count; ++i) {
        Track& t = data.track[static_cast<std::size_t>(i)];
        if (t.settled)
            continue;
        t.anchored = corrected(t, data.time);
        t.settled = data.time >= t.taken + t.blend;
    }
}

} // namespace local
} // namespace haptics
