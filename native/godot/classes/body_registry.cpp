#include <haptics/classes/body_registry.hpp>

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
    bodies_[id] = std::move(spec);
}

void BodyRegistry::remove(std::int64_t id) {
    bodies_.erase(id);
}

const BodySpec* BodyRegistry::find(std::int64_t id) const {
    const auto found = bodies_.find(id);
    return found == bodies_.end() ? nullptr : &found->second;
}

std::vector<std::int64_t> BodyRegistry::build(std::span<const std::int64_t> ids, std::span<const double> states,
                                              Neighborhood& out) const {
    std::vector<std::int64_t> unknown;
    BodySet& set = out.bodies;
    set.body_count = 0;
    set.piece_count = 0;
    out.overflow = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const BodySpec* spec = find(ids[i]);
        if (spec == nullptr) {
            unknown.push_back(ids[i]);
            continue;
        }
        const auto pieces = static_cast<std::int32_t>(spec->pieces.size());
        if (set.body_count == k_max_bodies || set.piece_count + pieces > k_max_pieces) {
            ++out.overflow;
            continue;
        }
        const double* s = states.data() + i * k_state;
        if (!std::all_of(s, s + k_state, [](double v) { return std::isfinite(v); })) {
            unknown.push_back(ids[i]);
            continue;
        }
        Body& b = set.body[static_cast<std::size_t>(set.body_count++)];
        b = spec->body;
        b.pose = node_to_center(Pose(s[0], s[1], s[2]), spec->center);
        b.velocity = b.kind == BodyKind::fixed ? Twist(Twist::Zero()) : Twist(s[3], s[4], s[5]);
        b.first_piece = set.piece_count;
        b.piece_count = pieces;
        for (const Piece& p : spec->pieces)
            set.piece[static_cast<std::size_t>(set.piece_count++)] = p;
    }
    return unknown;
}

} // namespace haptics
