#pragma once
// Steps of the local model that are not for users.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

// Writes the contacts of `data.patches` as rows of `data.system`.
void assemble(const Model& model, Data& data);

// Forces of contacts, friction, coupling and gravity over `dt`, then new velocities and poses. `left` is the
// time from the end of this sub-step to the end of the haptic step. Means are added to `output` with the
// weight `share` = dt / haptic step.
void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output);

// Contact forces at the present state, without motion; friction anchors follow.
void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output);

// Earliest time within `limit` at which a point that was apart closes faster than the collision speed;
// negative when there is none.
double next_collision(const Model& model, const Data& data, double limit);

// Resolves all points that are closed and approaching. False when there was nothing to resolve.
bool collide(const Model& model, Data& data, StepOutput& output);

// Writes the states that follow from the step into the patches, counts them and lists events.
void finish(const Model& model, Data& data, StepOutput& output);

// Moves kinematic bodies and free movables to where they are `dt` later, and blends in corrections.
void move_neighbors(Data& data, double dt);

// Copies the tool's velocity and pose and those of the island's movables between Data and the system.
void store_velocities(Data& data);
void load_velocities(Data& data);

// Row (with respect to the grip) of a wrench about the tool's center of mass.
Wrench about_grip(const Grip& grip, const Pose& pose, const Wrench& about_center);
// J_h of the rigid tool: grip velocity from the velocity of the center of mass; the third row is zero for a
// point grip.
Mat3 grip_jacobian(const Grip& grip, const Pose& pose);

} // namespace haptics::local
