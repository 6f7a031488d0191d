#pragma once
/// Small scenes for the contact tests.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/contact.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <algorithm>
#include <initializer_list>
#include <memory>

namespace haptics::testing {

/// Adds a body with the given pieces; piece ids count from 1.
inline Body& add_body(BodySet& set, std::uint64_t id, BodyKind kind, const Pose& pose,
                      std::initializer_list<Convex> pieces) {
    Body& body = set.body[static_cast<std::size_t>(set.body_count++)];
    body = Body{};
    body.id = id;
    body.kind = kind;
    body.pose = pose;
    body.mass = 0.1;
    body.inertia = 1e-5;
    body.first_piece = set.piece_count;
    for (const Convex& convex : pieces) {
        Piece& piece = set.piece[static_cast<std::size_t>(set.piece_count++)];
        piece = Piece{};
        piece.id = static_cast<std::uint32_t>(++body.piece_count);
        piece.convex = convex;
    }
    return body;
}

/// Smallest gap of a patch, m.
inline double lowest_gap(const Patch& patch) {
    return patch.point_count > 1 ? std::min(patch.point[0].gap, patch.point[1].gap) : patch.point[0].gap;
}

/// An empty set on the heap (sets are large).
inline std::unique_ptr<BodySet> make_set() {
    return std::make_unique<BodySet>();
}

} // namespace haptics::testing
