#pragma once
/// Whether two bodies stand in each other.

#include <haptics/core/contact/body.hpp>

namespace haptics {

/// True when a piece of body `i` of one set overlaps a piece of body `k` of another, at the bodies' present
/// poses. Allocation-free; takes time with the product of their numbers of pieces.
[[nodiscard]] bool overlap(const BodySet& one, std::int32_t i, const BodySet& other, std::int32_t k);

} // namespace haptics
