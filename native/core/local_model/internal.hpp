#pragma once
// Steps of the local model that are not for users.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

// Writes the contacts of `data.patches` and the joints of the tool as rows of `data.system`; `dt` is the
// length of the coming step.
void assemble(const Model& model, Data& data, double dt);

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

// Copies the velocities of the tool and of the island's movables between Data and the system.
void store_velocities(const Model& model, Data& data);
void load_velocities(const Model& model, Data& data);

// The tool in configuration space (proxy.cpp). Velocities between Data and the first entries of the system:
void load_tool(const Model& model, Data& data);
void store_tool(const Model& model, Data& data);
// motion of `dt` at the present velocity; a linkage's coordinates and links wait for the end of the step
void move_tool(const Model& model, Data& data, double dt);
void begin_tool_step(const Model& model, Data& data);
void end_tool_step(const Model& model, Data& data);
// poses and velocities of links, held link and kinematics that follow from the state
void place_tool(const Model& model, Data& data);
// D, D^-1, joint springs and all forces but those of contacts and coupling
void write_tool_mass(const Model& model, Data& data);
// those forces alone, after the velocity changed
void write_tool_force(const Model& model, Data& data);
// stretch, stiffness and damping of the joint with that freedom
Vec3 joint_spring(const Model& model, const Data& data, int freedom);
// dense D and D^-1 of a long linkage, which are made only where they are needed
void need_mass(const Model& model, Data& data);
void need_inverse(const Model& model, Data& data);
// J_h D^-1 J_h' for the rows and the factor at hand
Mat3 mobility(const Model& model, Data& data);
// J_h D^-1 force
Vec3 tool_response(const Model& model, Data& data, const LinkageVector& force);
// energy of the tool's motion and joint springs
double tool_energy(const Model& model, const Data& data);
// row += sign direction^T J of the point of `link` at the scene position `point`
void add_tool_row(const Model& model, const Data& data, int link, const Vec2& point, const Vec2& direction,
                  double sign, double* row);
// J_h, and J_h' q'
void grip_rows(const Model& model, const Data& data, GripRows& rows);
Vec3 grip_bias(const Model& model, const Data& data);

} // namespace haptics::local
