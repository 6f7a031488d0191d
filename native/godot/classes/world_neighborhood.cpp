// What a world tells about the snapshots it publishes.

#include <haptics/classes/haptic_world.hpp>
#include <haptics/core/geometry/shapes.hpp>

namespace haptics {

using namespace godot;

void HapticWorld::note_overflow(Problems& problems) {
    if (shown_.overflow > 0)
        ++overflowed_ticks_;
    if (shown_.overflow > 0 && !said_full_) {
        said_full_ = true;
        problems.add(
            "The neighborhood is full: more than " + std::to_string(k_max_bodies) + " bodies or " +
            std::to_string(k_max_pieces) +
            " convex pieces lie within reach of the tool, so only the nearest can be felt. Use fewer or "
            "simpler shapes there, or a higher pixels_per_meter.");
    }
    if (report_.movable_overflow > 0 && !said_movables_) {
        said_movables_ = true;
        problems.add(
            "More than " + std::to_string(k_max_movables) +
            " bodies that can be pushed lie within reach of the tool; the others do not yield there. "
            "Use fewer of them, or a higher pixels_per_meter.");
    }
}

Dictionary HapticWorld::neighborhood_figures() const {
    Dictionary d;
    d["bodies"] = shown_.bodies.body_count;
    d["pieces"] = shown_.bodies.piece_count;
    d["left_out_bodies"] = bodies_.left_out().bodies;
    d["left_out_pieces"] = bodies_.left_out().pieces;
    d["overflowed_ticks"] = static_cast<int64_t>(overflowed_ticks_);
    return d;
}

Array HapticWorld::neighborhood() const {
    static constexpr std::array<const char*, 4> k_kinds{"tool", "fixed", "kinematic", "movable"};
    Array out;
    const BodySet& set = shown_.bodies;
    for (std::int32_t b = 0; b < set.body_count; ++b) {
        const Body& body = set.body[static_cast<std::size_t>(b)];
        const Transform at(body.pose);
        for (std::int32_t k = 0; k < body.piece_count; ++k) {
            const Piece& piece = set.piece[static_cast<std::size_t>(body.first_piece + k)];
            const Convex& c = piece.convex;
            Dictionary d;
            d["body"] = static_cast<int64_t>(body.id);
            d["kind"] = k_kinds[static_cast<std::size_t>(body.kind)];
            d["one_way"] = piece.one_way;
            d["half_plane"] = c.half_plane;
            d["radius"] = c.radius;
            PackedFloat64Array points;
            const auto add = [&points](const Vec2& p) {
                points.push_back(p.x());
                points.push_back(p.y());
            };
            for (int i = 0; i < (c.half_plane ? 1 : c.count); ++i)
                add(at.apply(c.vertex[static_cast<std::size_t>(i)]));
            if (c.half_plane)
                add(at.turn(c.normal[0]));
            d["points"] = points;
            out.push_back(d);
        }
    }
    return out;
}

} // namespace haptics
