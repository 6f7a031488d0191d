#pragma once
// What appears around the tool.

#include <haptics/core/local_model/data.hpp>

namespace haptics::local {

// Lets neighbor `i`, which the last snapshot told of for the first time and which the tool stands in, appear.
void appear(Data& data, std::int32_t i);

// Whether a neighbor that appeared around the tool is still on its way to its place.
bool is_arriving(const Track& track, double time);

} // namespace haptics::local
