#pragma once
/// Whether two bodies stand in each other.

#include <haptics/core/contact/body.hpp>

namespace haptics {

/// True when a piece of body `i` of one set overlaps a piece of body `k` of another, at the bodies' present
/// poses. Allocation-free; takes time with the product of their numbers of pieces.
[[nodiscard]] bool overlap(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k);

/// How deep body `i` of one set stands in body `k` of another where it does most, m, and the way out of that,
/// a direction for `i`; not positive when they are apart. What acts from one side only does not count.
[[nodiscard]] double deepest_overlap(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k,
                                     Vec2& way_out);

} // namespace haptics
