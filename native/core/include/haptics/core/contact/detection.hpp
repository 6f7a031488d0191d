#pragma once
/// Finds the contact patches of a step and carries the memory of the last step's patches over to them.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/contact.hpp>

namespace haptics {

/// Settings of the detection.
struct DetectionSettings {
    /// Pairs closer than this plus the reach of their relative motion become patches, m.
    double margin{0.001};
    /// Length of the coming step, s: a pair is listed when it could touch within it.
    double step{0.001};
};

/// Finds all patches between bodies that can push each other (tool-anything, movable-anything; never fixed-fixed) at the bodies'
/// present poses, merges what lies on one plane, orders them the same way every time, and carries PatchMemory over from
/// `previous`. Allocation-free; deterministic.
void detect_patches(const BodySet& tool, const BodySet& neighbors, const DetectionSettings& settings, const PatchList& previous,
                    PatchList& patches);

} // namespace haptics
