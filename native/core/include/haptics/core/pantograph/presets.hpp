#pragma once
/// Pantographs that exist. Lengths come from their public descriptions; what is assumed says so in
/// presets.cpp.

#include <haptics/core/pantograph/geometry.hpp>

namespace haptics {

/// Pantograph Mk-II: single five-bar, links 63/75 mm, motor axes 25 mm apart.
PantographGeometry pantograph_mk2();
/// Haply 2DIY, second version: 70/90 mm, coaxial motors, 10752 counts per turn.
PantographGeometry haply_2diy_v2();
/// Haply 2DIY, third version: 70/90 mm, motor axes 38 mm apart, 4880 counts per turn.
PantographGeometry haply_2diy_v3();
/// UBC planar twin pantograph: two facing five-bars, four motors, (x, y, theta). No figures are published:
/// all are assumptions.
PantographGeometry ubc_twin_pantograph();

} // namespace haptics
