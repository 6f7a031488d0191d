#pragma once
/// Gathers the contacts of all pairs of pieces into patches: one for all points of one body on one plane of
/// the other's matter.

#include <haptics/core/contact/contact.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

#include "pair_contact.hpp"

namespace haptics::contact {

/// A patch while it is gathered.
struct Draft {
    Patch patch;
    Rank rank{Rank::felt};
    Vec2 plane_normal{0.0, 1.0};
    double plane_offset{0.0};
    /// How far the pair can move in the coming step, m.
    double reach{0.0};
    /// Surface of b alone: only equal surfaces merge.
    Surface surface_b;
    /// All of its matter is one-way.
    bool one_way{false};
    /// Index of the last step's patch that this one goes on from, -1 when it is new.
    int previous{-1};
};

/// Smallest gap of a patch, m.
[[nodiscard]] inline double smallest_gap(const Patch& patch) {
    return patch.point_count > 1 ? std::min(patch.point[0].gap, patch.point[1].gap) : patch.point[0].gap;
}

/// Fixed-capacity list of drafts. Room that is not used is not written.
struct DraftList {
    DraftList() {}
    ~DraftList() = default;
    DraftList(const DraftList&) = delete;
    DraftList& operator=(const DraftList&) = delete;

    int count{0};
    int dropped{0};

    /// A new draft in the place where `add` would put it.
    [[nodiscard]] Draft& next() { return *std::construct_at(&(*this)[count]); }
    /// Adds the draft that `next` gave, merging it into the patch on the same plane if there is one. When the
    /// list is full the shallowest goes.
    void add(const Draft& added);
    /// Removes by moving the last one into its place.
    void remove(int index) {
        --count;
        if (index != count)
            (*this)[index] = (*this)[count];
    }
    [[nodiscard]] Draft& operator[](int index) {
        return *std::launder(
            reinterpret_cast<Draft*>(&room_[static_cast<std::size_t>(index) * sizeof(Draft)]));
    }
    [[nodiscard]] const Draft& operator[](int index) const {
        return *std::launder(
            reinterpret_cast<const Draft*>(&room_[static_cast<std::size_t>(index) * sizeof(Draft)]));
    }

  private:
    alignas(Draft) std::array<std::byte, sizeof(Draft) * (k_max_patches + 1)> room_;
};
static_assert(std::is_trivially_destructible_v<Draft>);

/// Sets the shares of the points of a patch: 1, or a half each when level; the upper one's share fades out
/// over `tilt` (m). Without a share it stays when it may close within the coming step, having at most `reach`
/// (m) to go.
void share_out(Patch& patch, double tilt, double reach);

} // namespace haptics::contact
