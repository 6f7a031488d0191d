#include <haptics/core/contact/overlap.hpp>

#include <utility>

#include "pair_contact.hpp"

namespace haptics {

namespace {

// calls `visit(distance, way out for the first, piece of the second)` for all pairs of pieces until it is
// true
template <class Visit>
bool any_pair(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k, const Visit& visit) {
    const Body& a = one.body[static_cast<std::size_t>(i)];
    const Body& b = other.body[static_cast<std::size_t>(k)];
    const Transform at_a(a.pose);
    const Transform at_b(b.pose);
    contact::PlacedConvex placed_a;
    contact::PlacedConvex placed_b;
    Vec2 normal;
    for (std::int32_t m = 0; m < a.piece_count; ++m) {
        contact::place(one.piece[static_cast<std::size_t>(a.first_piece + m)].convex, at_a, placed_a);
        for (std::int32_t n = 0; n < b.piece_count; ++n) {
            const Piece& piece = other.piece[static_cast<std::size_t>(b.first_piece + n)];
            contact::place(piece.convex, at_b, placed_b);
            if (placed_a.count == 0 || placed_b.count == 0 || (placed_a.half_plane && placed_b.half_plane))
                continue;
            const bool swap = placed_a.half_plane; // the ground is always the second
            const double distance =
                contact::separate(swap ? placed_b : placed_a, swap ? placed_a : placed_b, normal);
            if (visit(distance, swap ? Vec2(-normal) : normal, piece))
                return true;
        }
    }
    return false;
}

} // namespace

bool overlap(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k) {
    return any_pair(one, i, other, k,
                    [](double distance, const Vec2&, const Piece&) { return distance < 0.0; });
}

double deepest_overlap(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k,
                       Vec2& way_out) {
    double depth = 0.0;
    any_pair(one, i, other, k, [&](double distance, const Vec2& normal, const Piece& piece) {
        if (-distance > depth && !piece.one_way) {
            depth = -distance;
            way_out = normal;
        }
        return false;
    });
    return depth;
}

} // namespace haptics
