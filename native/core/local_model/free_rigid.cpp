// A rigid tool that touches nothing, over a whole step.
//
// Without rows both stepping integrators solve the same equation (integrate.cpp),
//     (D + h J_h' (h K_c + B_c) J_h) v+ = D v + h (m g + J_h'(K_c (x_t - x_g) + B_c v_t + f)),
// with D = diag(m, m, I): no mass matrix, rows, inverse or set of contacts is needed, and without a hand each
// freedom stands alone. The operations are those of the general path and in the same order, so the motion is
// the same to the last bit: what the plan leaves out here can be left out in one step and used in the next.

#include "internal.hpp"
#include "rigid_grip.hpp"
#include "small_solve.hpp"

namespace haptics::local {
namespace {

struct FreeTool {
    const ToolModel& tool;
    RigidGrip grip;
    // of the grip
    Pose at;
    Vec3 weight;
    double dt;
};

Vec3 end_velocity(const FreeTool& free, const Vec3& start, const HandInput& hand) {
    const Vec3 mass(free.tool.mass, free.tool.mass, free.tool.inertia);
    Vec3 right = mass.cwiseProduct(start) + free.dt * free.weight;
    if (!hand.held)
        return right.cwiseQuotient(mass);
    Mat3 base = mass.asDiagonal();
    couple_rigid(free.grip, free.at, hand, free.dt, 0.0, base, right);
    solve_definite(base, right);
    return right;
}

// the coupling's part of the output; the velocity at the end of the step
Vec3 step_held(const FreeTool& free, const Vec3& start, const HandInput& hand, StepOutput& output) {
    HandInput used = at_share(hand);
    Vec3 v = end_velocity(free, start, used);
    Wrench full = coupling_of_rigid(free.grip, free.at, hand, free.dt, v);
    if (hold_back(hand, full, used)) {
        v = end_velocity(free, start, used);
        full = coupling_of_rigid(free.grip, free.at, hand, free.dt, v);
    }
    output.full_coupling = full;
    output.coupling = coupling_of_rigid(free.grip, free.at, used, free.dt, v) + used.force - hand.force;
    return v;
}

} // namespace

void step_freely(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    const ToolModel& tool = model.tool;
    ContactSystem& s = data.system;
    s.points = 0;
    s.patches = 0;
    for (int i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].row = -1;

    // a tool that is held at its center needs no angle
    const Vec2 lever = data.grip.point.isZero(0.0) ? data.grip.point : rotate(data.pose.z(), data.grip.point);
    const Vec2 weight(tool.mass * data.gravity.x(), tool.mass * data.gravity.y());
    const FreeTool free{tool,
                        {lever, data.grip.pose},
                        {data.pose.x() + lever.x(), data.pose.y() + lever.y(), data.pose.z()},
                        {weight.x(), weight.y(), 0.0},
                        dt};
    output.grip_mobility = free.grip.mobility(tool.mass, tool.inertia);
    const double spin = data.velocity.z();
    const Vec3 v =
        hand.held ? step_held(free, data.velocity, hand, output) : end_velocity(free, data.velocity, hand);

    const Vec3 grip = free.grip.velocity(v);
    const Vec3 force = hand.held ? hand.force : Vec3(Vec3::Zero());
    output.source_work = dt * (free.weight.dot(v) + force.dot(grip));
    output.environment = {weight.x(), weight.y(), cross(data.pose.head<2>() - free.at.head<2>(), weight)};
    output.grip_acceleration = {1.0 / tool.mass * weight.x(), 1.0 / tool.mass * weight.y(), 0.0};
    output.grip_bias = {-spin * spin * lever.x(), -spin * spin * lever.y(), 0.0};

    data.velocity = v;
    data.pose += dt * v;
    place_tool(model, data);
    move_neighbors(data, dt);
}

} // namespace haptics::local
