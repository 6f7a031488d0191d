#pragma once
/// Finds the contact patches of a step and carries the memory of the last step's patches over to them.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/body_cache.hpp>
#include <haptics/core/contact/contact.hpp>

namespace haptics {

/// Settings of the detection.
struct DetectionSettings {
    /// Pairs closer than this plus the reach of their relative motion become patches, m.
    double margin{0.001};
    /// Length of the coming step, s: a pair is listed when it could touch within it.
    double step{0.001};
    /// The higher end of a tilted zone of contact loses its share of the patch's stiffness over this height,
    /// m, > 0: level ends have a half each, a corner that is tilted by more has all of it.
    double tilt{0.00025};
};

/// Finds all patches between bodies that can push each other (tool-anything, movable-anything; never
/// fixed-fixed, never two links of the tool) at the bodies' present poses, merges what lies on one plane,
/// orders them by ids (so the order of the bodies in the sets does not matter), and carries PatchMemory over
/// from `previous`. `patches` may be `previous`. Allocation-free; deterministic; bounded.
void detect_patches(const BodySet& tool, const BodySet& neighbors, const DetectionSettings& settings,
                    const PatchList& previous, PatchList& patches);

/// The same with what the caller keeps from step to step, one for each set. `known` is false wherever a shape
/// or a body of the set was changed, added or removed since; poses and velocities may change.
void detect_patches(const BodySet& tool, BodyCache& tool_cache, const BodySet& neighbors,
                    BodyCache& neighbor_cache, const DetectionSettings& settings, const PatchList& previous,
                    PatchList& patches);

} // namespace haptics
