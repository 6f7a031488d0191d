#pragma once
/// Finds the contact patches of a step and carries the memory of the last step's patches over to them.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/bounds.hpp>
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

/// The same with bounds that the caller keeps (see compute_bounds): they hold until a shape changes, whatever
/// the poses.
void detect_patches(const BodySet& tool, const BodyBounds& tool_bounds, const BodySet& neighbors,
                    const BodyBounds& neighbor_bounds, const DetectionSettings& settings,
                    const PatchList& previous, PatchList& patches);

} // namespace haptics
