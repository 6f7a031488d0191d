#pragma once
/// Checks of what an author can set wrong. Allocates; not for the haptic loop.

#include <haptics/core/figure_error.hpp>
#include <haptics/core/local_model/model.hpp>

#include <vector>

namespace haptics {

/// Figures of a surface out of range: stiffness 0 to 1e12 N/m (infinite: as hard as the partner lets it),
/// damping 0 to 1e12 N s/m, friction 0 to 100 with static >= dynamic, restitution 0 to 1.
std::vector<FigureError> validate(const Surface& surface);

/// Tool and settings: mass 1e-6 to 1e4 kg, inertia 1e-12 to 1e4 kg m^2, grip within 10 m of the center, a
/// shape, and the settings' ranges.
std::vector<FigureError> validate(const Model& model);

} // namespace haptics
