#pragma once
/// The paper's wall (K = 15000 N/m, B = 20 N s/m) and a rectangular tool, for tests and benchmarks.

#include <haptics/core/geometry/shapes.hpp>
#include <haptics/core/local_model/local_model.hpp>

#include <memory>

namespace haptics::shared {

inline Surface paper_surface() {
    Surface s;
    s.stiffness = 15000.0;
    s.damping = 20.0;
    return s;
}

inline std::int32_t add_body(BodySet& set, std::uint64_t id, BodyKind kind, const Surface& surface,
                             const Pose& pose) {
    Body& b = set.body[static_cast<std::size_t>(set.body_count)];
    b = Body{};
    b.id = id;
    b.kind = kind;
    b.surface = surface;
    b.pose = pose;
    b.first_piece = set.piece_count;
    return set.body_count++;
}

inline void add_piece(BodySet& set, const Convex& convex) {
    Piece& p = set.piece[static_cast<std::size_t>(set.piece_count)];
    p = Piece{};
    p.id = static_cast<std::uint32_t>(set.piece_count + 1);
    p.convex = convex;
    ++set.piece_count;
    ++set.body[static_cast<std::size_t>(set.body_count - 1)].piece_count;
}

/// A 40 x 20 mm box of 0.3 kg held at its center, as the tool.
inline Model box_tool(double mass = 0.3) {
    Model m;
    m.tool.mass = mass;
    m.tool.inertia = mass * (0.04 * 0.04 + 0.02 * 0.02) / 12.0;
    add_body(m.tool.shape, 0, BodyKind::tool, neutral_surface(), Pose::Zero());
    add_piece(m.tool.shape, make_box(Vec2::Zero(), Vec2(0.04, 0.02)));
    return m;
}

/// A floor with its surface at y = 0, `pieces` boxes side by side from x = -0.1 to 0.1 m.
inline std::unique_ptr<Neighborhood> floor_of(int pieces, const Surface& surface = paper_surface()) {
    auto n = std::make_unique<Neighborhood>();
    n->sequence = 1;
    const double width = 0.2 / pieces;
    for (int i = 0; i < pieces; ++i) {
        add_body(n->bodies, static_cast<std::uint64_t>(100 + i), BodyKind::fixed, surface, Pose::Zero());
        add_piece(n->bodies, make_box(Vec2(-0.1 + (i + 0.5) * width, -0.01), Vec2(width, 0.02)));
    }
    return n;
}

} // namespace haptics::shared
