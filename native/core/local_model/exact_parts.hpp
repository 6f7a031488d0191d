#pragma once
// Steps of a linkage with the exact integrator that are made of parts.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

// Length of the next part of a step with the present patches, of which `left` s are left.
double part_of_step(const Model& model, const Data& data, double left);

// The hand's input for a part that ends `left` s before the step does.
HandInput hand_of_part(const HandInput& hand, double left);

// Adds the figures of a part, which is the `share` of the step, to those of the parts before it.
void add_part(const StepFigures& part, double share, StepFigures& sum);

} // namespace haptics::local
