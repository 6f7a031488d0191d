#include <haptics/classes/body_registry.hpp>
#include <haptics/core/geometry/seams.hpp>

#include <algorithm>
#include <cmath>

namespace haptics {

Pose node_to_center(const Pose& node, const Vec2& center) {
    const Vec2 p = node.head<2>() + rotate(node.z(), center);
    return {p.x(), p.y(), node.z()};
}

Pose center_to_node(const Pose& at_center, const Vec2& center) {
    const Vec2 p = at_center.head<2>() - rotate(at_center.z(), center);
    return {p.x(), p.y(), at_center.z()};
}

void BodyRegistry::set(std::int64_t id, BodySpec spec) {
    spec.body.id = static_cast<std::uint64_t>(id);
    spec.bounds.clear();
    for (const Piece& p : spec.pieces)
        spec.bounds.push_back(bounds_of(p.convex));
    bodies_[id] = std::move(spec);
    stale_ = true;
}

void BodyRegistry::remove(std::int64_t id) {
    bodies_.erase(id);
}

bool BodyRegistry::tie(std::int64_t id, std::uint64_t linkage, std::int32_t link) {
    const auto found = bodies_.find(id);
    if (found == bodies_.end() || found->second.body.kind != BodyKind::movable)
        return false;
    Body& b = found->second.body;
    b.jointed = true;
    b.linkage = linkage;
    b.link = link;
    // until the linkage is followed
    b.mobility = Vec3(1.0 / b.mass, 1.0 / b.mass, 1.0 / b.inertia).asDiagonal();
    return true;
}

const BodySpec* BodyRegistry::find(std::int64_t id) const {
    const auto found = bodies_.find(id);
    return found == bodies_.end() ? nullptr : &found->second;
}

std::vector<std::size_t> BodyRegistry::build(std::span<const std::int64_t> ids,
                                             std::span<const double> states, std::span<const ReachDisc> discs,
                                             Neighborhood& out) {
    std::vector<std::size_t> unusable;
    std::vector<Candidate> candidates;
    candidates.reserve(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const BodySpec* spec = find(ids[i]);
        const double* s = states.data() + i * k_state;
        if (spec == nullptr || !std::all_of(s, s + k_state, [](double v) { return std::isfinite(v); })) {
            unusable.push_back(i);
            continue;
        }
        Candidate c{spec->body, spec->pieces, spec->bounds};
        c.body.pose = node_to_center(Pose(s[0], s[1], s[2]), spec->center);
        c.body.velocity = c.body.kind == BodyKind::fixed ? Twist(Twist::Zero()) : Twist(s[3], s[4], s[5]);
        if (c.body.kind == BodyKind::movable && !c.body.jointed)
            c.body.acceleration << Vec2(s[6], s[7]) - out.gravity, 0.0;
        candidates.push_back(c);
    }
    left_out_ = select_near(candidates, discs, out.bodies);
    out.overflow = left_out_.pieces;
    join_fixed(out.bodies);
    return unusable;
}

// Walls that abut are one solid: what lies inside it must not be felt.
void BodyRegistry::join_fixed(BodySet& set) {
    std::vector<Placed> now;
    std::vector<SeamPiece> solid;
    std::vector<const Surface*> surfaces;
    for (std::int32_t i = 0; i < set.body_count; ++i) {
        const Body& b = set.body[static_cast<std::size_t>(i)];
        if (b.kind != BodyKind::fixed)
            continue;
        const auto same = [&b](const Surface* s) {
            return s->stiffness == b.surface.stiffness && s->damping == b.surface.damping &&
                   s->static_friction == b.surface.static_friction &&
                   s->dynamic_friction == b.surface.dynamic_friction &&
                   s->restitution == b.surface.restitution;
        };
        auto group = std::find_if(surfaces.begin(), surfaces.end(), same);
        if (group == surfaces.end())
            group = surfaces.insert(surfaces.end(), &b.surface);
        for (std::int32_t k = 0; k < b.piece_count; ++k) {
            Piece& p = set.piece[static_cast<std::size_t>(b.first_piece + k)];
            now.push_back({b.id, p.id, b.pose});
            if (!p.one_way)
                solid.push_back({&p.convex, b.pose, static_cast<int>(group - surfaces.begin())});
        }
    }
    if (!stale_ && now == joined_) {
        for (std::size_t i = 0; i < solid.size(); ++i)
            *solid[i].convex = joined_pieces_[i];
        return;
    }
    mark_seams(solid);
    joined_ = std::move(now);
    joined_pieces_.clear();
    for (const SeamPiece& p : solid)
        joined_pieces_.push_back(*p.convex);
    stale_ = false;
}

} // namespace haptics
