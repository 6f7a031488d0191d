#pragma once
/// Carries what the last step's patches knew over to this step's.

#include <haptics/core/contact/body_cache.hpp>

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
    /// Their indices from the deepest to the shallowest, equal ones in their order.
    std::array<std::int8_t, k_max_patches> by_depth;
};

/// Moves the last step's patches to where the bodies stand now.
void recall(const BodySet& tool, BodyCache& tool_cache, const BodySet& neighbors, BodyCache& neighbor_cache,
            const PatchList& previous, Memory& memory);

/// The side from which a pair of pieces was felt. A disc about `center_b` holds
/// b.
[[nodiscard]] SideHint side_of(const Memory& memory, const PatchSide& pair, const PlacedConvex& a,
                               const PlacedConvex& b, const Vec2& center_b, double radius_b);

/// How deep the body was pressed into other matter in the last step, m, >= 0.
[[nodiscard]] double last_depth(const Memory& memory, std::uint64_t id_a, bool tool_a);

/// Finds for each draft the patch that it goes on from, copies the memory, and drops what cannot have come
/// about: deep contacts out of nowhere on matter that is being touched already, and contacts from behind a
/// one-way piece. Whether it dropped any.
bool carry_over(const Memory& memory, DraftList& drafts);

} // namespace haptics::contact
