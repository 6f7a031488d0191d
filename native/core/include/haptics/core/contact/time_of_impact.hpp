#pragma once
/// When two bodies first touch within a step.

#include <haptics/core/contact/body.hpp>
#include <haptics/core/contact/contact.hpp>

namespace haptics {

/// Time (s) from now at which body a of the patch first touches body b (or any fixed matter, when b is fixed)
/// in about the direction of the patch, while both move with constant twists for `step` seconds; infinity
/// when they do not. At that time the gap is between 0 and 1e-9 m. Bounded: when the iterations run out it is
/// earlier, never later. Pieces that overlap already are left out: their patch has a gap below 0 and needs no
/// impact time. Allocation-free.
[[nodiscard]] double time_of_impact(const BodySet& tool, const BodySet& neighbors, const Patch& patch,
                                    const Twist& twist_a, const Twist& twist_b, double step);

} // namespace haptics
