#pragma once
/// A convex piece moved to where its body stands.

#include <haptics/core/geometry/shapes.hpp>

namespace haptics::contact {

/// Core vertices and normals in scene axes. Only the first `count` are set.
struct PlacedConvex {
    int count{0};
    bool half_plane{false};
    double radius{0.0};
    const Convex* shape{nullptr};
    std::array<Vec2, k_max_vertices> vertex;
    std::array<Vec2, k_max_vertices> normal;

    [[nodiscard]] const Vec2& v(int i) const { return vertex[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const Vec2& n(int i) const { return normal[static_cast<std::size_t>(i)]; }
    [[nodiscard]] int next(int i) const { return i + 1 == count ? 0 : i + 1; }
    [[nodiscard]] int before(int i) const { return i == 0 ? count - 1 : i - 1; }
    /// Number of faces: a disc has none.
    [[nodiscard]] int faces() const { return half_plane ? 1 : (count > 1 ? count : 0); }
};

inline void place(const Convex& convex, const Transform& at, PlacedConvex& placed) {
    placed.count = convex.half_plane ? 1 : convex.count;
    placed.half_plane = convex.half_plane;
    placed.radius = convex.radius;
    placed.shape = &convex;
    for (int i = 0; i < placed.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        placed.vertex[k] = at.apply(convex.vertex[k]);
        placed.normal[k] = at.turn(convex.normal[k]);
    }
}

} // namespace haptics::contact
