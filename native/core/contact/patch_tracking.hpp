#pragma once
/// Carries what the last step's patches knew over to this step's.

#include <haptics/core/contact/body.hpp>

#include <array>

#include "pair_contact.hpp"
#include "patch_merge.hpp"

namespace haptics::contact {

/// One patch of the last step, moved to where its bodies stand now. Written by recall; nothing is set before.
struct Remembered {
    const Patch* patch;
    /// Normal (out of b into a) and offset of its plane in scene axes.
    Vec2 normal;
    double offset;
    double gap;
};

/// The last step's patches.
struct Memory {
    int count{0};
    std::array<Remembered, k_max_patches> patch;
};

/// Moves the last step's patches to where the bodies stand now.
void recall(const BodySet& tool, const BodySet& neighbors, const PatchList& previous, Memory& memory);

/// The side from which a pair of pieces was felt.
[[nodiscard]] SideHint side_of(const Memory& memory, const PatchSide& pair, const PlacedConvex& a,
                               const PlacedConvex& b);

/// How deep the body was pressed into other matter in the last step, m, >= 0.
[[nodiscard]] double last_depth(const Memory& memory, std::uint64_t id_a, bool tool_a);

/// Finds for each draft the patch that it goes on from, copies the memory, and drops what cannot have come
/// about: deep contacts out of nowhere on matter that is being touched already, and contacts from behind a
/// one-way piece.
void carry_over(const Memory& memory, DraftList& drafts);

} // namespace haptics::contact
