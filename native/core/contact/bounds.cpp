/// A rounded polygon lies inside its core's box grown by its radius, and inside the disc about that box's
/// center through the farthest core vertex, grown likewise.

#include <haptics/core/contact/bounds.hpp>

#include <algorithm>
#include <limits>

namespace haptics {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

} // namespace

PieceBounds bounds_of(const Convex& convex) {
    PieceBounds bounds;
    if (convex.half_plane || convex.count < 1) {
        const double reach = convex.half_plane ? k_infinity : -k_infinity;
        bounds.low = Vec2::Constant(-reach);
        bounds.high = Vec2::Constant(reach);
        bounds.center = Vec2::Zero();
        bounds.radius = reach;
        return bounds;
    }
    bounds.low = bounds.high = convex.vertex[0];
    for (int i = 1; i < convex.count; ++i) {
        bounds.low = bounds.low.cwiseMin(convex.vertex[static_cast<std::size_t>(i)]);
        bounds.high = bounds.high.cwiseMax(convex.vertex[static_cast<std::size_t>(i)]);
    }
    bounds.center = 0.5 * (bounds.low + bounds.high);
    double squared = 0.0;
    for (int i = 0; i < convex.count; ++i)
        squared =
            std::max(squared, (convex.vertex[static_cast<std::size_t>(i)] - bounds.center).squaredNorm());
    bounds.radius = std::sqrt(squared) + convex.radius;
    bounds.low.array() -= convex.radius;
    bounds.high.array() += convex.radius;
    return bounds;
}

void compute_bounds(const BodySet& set, BodyBounds& bounds) {
    for (std::int32_t i = 0; i < set.body_count; ++i) {
        const Body& body = set.body[static_cast<std::size_t>(i)];
        const auto first = static_cast<std::size_t>(body.first_piece);
        const auto end = first + static_cast<std::size_t>(body.piece_count);
        double radius = 0.0;
        Vec2 low = Vec2::Constant(k_infinity);
        Vec2 high = Vec2::Constant(-k_infinity);
        for (std::size_t k = first; k < end; ++k) {
            PieceBounds& piece = bounds.piece[k];
            piece = bounds_of(set.piece[k].convex);
            radius = std::max(radius, piece.center.norm() + piece.radius);
            low = low.cwiseMin(piece.low);
            high = high.cwiseMax(piece.high);
        }
        const Vec2 middle = 0.5 * (low + high);
        const Vec2 center = middle.allFinite() ? middle : Vec2(Vec2::Zero());
        double extent = 0.0;
        for (std::size_t k = first; k < end; ++k)
            extent = std::max(extent, (bounds.piece[k].center - center).norm() + bounds.piece[k].radius);
        bounds.radius[static_cast<std::size_t>(i)] = radius;
        bounds.center[static_cast<std::size_t>(i)] = center;
        bounds.extent[static_cast<std::size_t>(i)] = extent;
    }
}

} // namespace haptics
