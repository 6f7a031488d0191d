#pragma once
// Movable neighbors: meeting them, believing about them, and taking over what the environment knows better.

#include <haptics/core/local_model/data.hpp>

namespace haptics::local {

// Takes over what the snapshot says of the movables among its first `listed` neighbors. The tracks tell where
// those that were no movables until now were shown.
void take_movables(const Neighborhood& n, Data& data);

// Moves movables that nothing joins to the tool, and blends corrections in.
void move_movables(Data& data, double dt);

} // namespace haptics::local
