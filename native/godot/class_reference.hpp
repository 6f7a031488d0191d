#pragma once

#include <span>
#include <string_view>

namespace haptics {

/// The pages of doc/, one class each, embedded at build time.
std::span<const std::string_view> class_reference_pages();

} // namespace haptics
