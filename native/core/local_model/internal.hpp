#pragma once
// Steps of the local model that are not for users.

#include <haptics/core/local_model/local_model.hpp>

namespace haptics::local {

// The body that a patch names, of the tool or a neighbor.
inline const Body& body_of(const Data& data, std::int32_t body) {
    return body < data.tool.body_count
               ? data.tool.body[static_cast<std::size_t>(body)]
               : data.neighbors.body[static_cast<std::size_t>(body - data.tool.body_count)];
}

// Index of the movable that a patch names; -1 when the body is none.
inline std::int32_t movable_of(const Data& data, std::int32_t body) {
    for (int i = 0; i < data.movable_count; ++i)
        if (data.movable[static_cast<std::size_t>(i)].body == body - data.tool.body_count)
            return i;
    return -1;
}

// Writes the contacts of `data.patches` and the joints of the tool as rows of `data.system`; `dt` is the
// length of the coming step.
void assemble(const Model& model, Data& data, double dt);

// Forces of contacts, friction, coupling and gravity over `dt`, then new velocities and poses. `left` is the
// time from the end of this sub-step to the end of the haptic step. Means are added to `output` with the
// weight `share` = dt / haptic step.
void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output);
// The same up to where a point that may collide closes fast, and at most `dt`, which is part of a step of
// `step` seconds; says how far it came, s.
double integrate_to_hit(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                        double step, StepOutput& output);

// How the system moved in a sub-step, as its springs and dampers saw it (book.cpp).
struct Motion {
    double dt;
    // from where springs are taken to the end of the haptic step, s
    double left;
    // velocity, and displacement since the start, at which springs and dampers give the (mean) force
    FreedomVector rate;
    FreedomVector stretch;
    // the work of movables has been integrated (PatchRow::movable_work)
    bool integrated{false};
};

// The hand's input with the coupling at its share.
HandInput at_share(const HandInput& hand);
// A coupling whose force at full share is beyond what the device can answer becomes a constant force of the
// size it can: true when it does.
bool hold_back(const HandInput& hand, const Wrench& full, HandInput& used);
// Coupling force on the tool.
Wrench coupling_force(const Data& data, const HandInput& hand, const Motion& motion);
// Adds the coupling to the output; returns what the springs of `used` gave.
Wrench book_coupling(const Data& data, const HandInput& hand, const HandInput& used, const Motion& motion,
                     double share, StepOutput& output);
// Adds contact forces, impulses on movables and work of the sub-step to the books, and forms `tool_force`.
void book(const Model& model, Data& data, const Motion& motion, double share, StepOutput& output);
// Counts what the tool's push, an impulse for each point and each patch, leaves in the movables (push.cpp).
void tell_push(Data& data, const double* normal, const double* tangent);
// Velocities into Data, poses on by `moved`, everything else by `dt`.
void move_bodies(const Model& model, Data& data, const FreedomVector& moved, double dt);

// A step of a rigid tool that touches nothing (free_rigid.cpp).
void step_freely(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output);

// A step of a rigid tool that touches only what it cannot move, and hits nothing; false, with nothing
// changed, where it is not that (rigid_contact.cpp).
bool step_in_contact(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output);

// A step or the rest of one with the exact integrator (exact_step.cpp), collisions included.
void step_exactly(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output);

// Contact forces at the present state, without motion; friction anchors follow.
void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output);

// Earliest time within `limit` at which a point that was apart closes faster than the collision speed;
// negative when there is none.
double next_collision(const Model& model, const Data& data, double limit);

// A point is closed and closing faster than the collision speed.
bool hits_now(const Model& model, const Data& data);

// Resolves all points that are closed and approaching. False when there was nothing to resolve.
bool collide(const Model& model, Data& data, StepOutput& output);

// Writes the states that follow from the step into the patches, counts them and lists events.
void finish(const Model& model, Data& data, StepOutput& output);

// Something is in a state that no scene can be in (divergence.cpp).
bool ran_away(const Model& model, const Data& data);
// Puts the tool back at `start`, the pose of a rigid tool or the coordinates of a linkage, and with it what
// ran away.
void put_back(const Model& model, Data& data, const LinkageVector& start, StepOutput& output);

// Moves kinematic bodies and free movables to where they are `dt` later, and blends in corrections.
void move_neighbors(Data& data, double dt);
// Takes the anchors of friction along with what neighbors were corrected by, before contacts are looked for.
void move_anchors(Data& data);

// Copies the velocities of the tool and of the island's movables between Data and the system.
void store_velocities(const Model& model, Data& data);
void load_velocities(const Model& model, Data& data);

// The tool in configuration space (proxy.cpp). Velocities between Data and the first entries of the system:
void load_tool(const Model& model, Data& data);
void store_tool(const Model& model, Data& data);
// motion by `moved` (the first entries); a linkage's coordinates and links wait for the end of the step
void move_tool(const Model& model, Data& data, const FreedomVector& moved);
void begin_tool_step(const Model& model, Data& data);
void end_tool_step(const Model& model, Data& data);
// poses and velocities of links, held link and kinematics that follow from the state
void place_tool(const Model& model, Data& data);
// D, D^-1, joint springs and all forces but those of contacts and coupling, for a step of `dt`
void write_tool_mass(const Model& model, Data& data, double dt);
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
