#pragma once
/// Marks the seams of all bodies of a snapshot, so that none is felt. Off the haptic loop; allocates.

#include <haptics/core/contact/body.hpp>

namespace haptics {

/// All fixed bodies together are one solid, every other body is one of its own; one-way pieces are left out.
/// Flat faces go on over pieces of equal surface. Call it on freshly made pieces whenever the set of fixed
/// bodies or a shape changes.
void mark_seams(BodySet& set);

} // namespace haptics
