#pragma once
/// What detection keeps of a set of bodies from step to step: bounds, which hold while the shapes stay, sines
/// and cosines, which hold while a body does not turn, and its pieces in scene axes, which hold while it does
/// not move. Most of what is near a tool does neither.

#include <haptics/core/contact/bounds.hpp>
#include <haptics/core/contact/placed_convex.hpp>

#include <array>

namespace haptics {

/// Large. Nothing but `known` is set before the first use.
struct BodyCache {
    /// False: a shape or a body was changed, added or removed, and all is computed anew.
    bool known{false};
    BodyBounds bounds;

    /// Computes the bounds when they are not known. Allocation-free.
    void update(const BodySet& set);
    /// Where body `i` of the set stands.
    [[nodiscard]] Transform place(const BodySet& set, std::int32_t i);
    /// Piece `index` of the set, of a body whose place was asked for in this step, in scene axes.
    [[nodiscard]] const contact::PlacedConvex& piece(const BodySet& set, std::size_t index,
                                                     const Transform& at) {
        contact::PlacedConvex& placed = placed_[index];
        if (is_placed_[index]) {
            placed.shape = &set.piece[index].convex; // the set may have been copied
        } else {
            contact::place(set.piece[index].convex, at, placed);
            is_placed_[index] = true;
        }
        return placed;
    }

  private:
    struct Place {
        double x, y, angle;
        double cosine, sine;
    };
    std::array<Place, k_max_bodies> place_;
    std::array<bool, k_max_pieces> is_placed_;
    std::array<contact::PlacedConvex, k_max_pieces> placed_;
};

} // namespace haptics
