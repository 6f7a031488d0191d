// A rigid tool that touches nothing, over a whole step.
//
// Without rows both stepping integrators solve the same equation (integrate.cpp),
//     (D + h J_h' (h K_c + B_c) J_h) v+ = D v + h (m g + J_h'(K_c (x_t - x_g) + B_c v_t + f)),
// with D = diag(m, m, I): no mass matrix, rows, inverse or set of contacts is needed, and without a hand each
// freedom stands alone. The operations are those of the general path and in the same order, so the motion is
// the same to the last bit: what the plan leaves out here can be left out in one step and used in the next.

#include "internal.hpp"
#include "outcome.hpp"
#include "rigid_grip.hpp"

namespace haptics::local {

void step_freely(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    const ToolModel& tool = model.tool;
    ContactSystem& s = data.system;
    s.points = 0;
    s.patches = 0;
    for (int i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].row = -1;

    const double x = data.pose.x();
    const double y = data.pose.y();
    const RigidGrip grip = rigid_grip(data);
    const Plain3 at{x + grip.x, y + grip.y, data.pose.z()};
    const Plain3 weight{tool.mass * data.gravity.x(), tool.mass * data.gravity.y(), 0.0};
    const Plain3 mass{tool.mass, tool.mass, tool.inertia};
    const Plain3 start = plain(data.velocity);
    output.grip_mobility = grip.mobility(tool.mass, tool.inertia);
    output.grip_acceleration = {1.0 / tool.mass * weight.x, 1.0 / tool.mass * weight.y, 0.0};
    output.grip_bias = {-start.z * start.z * grip.x, -start.z * start.z * grip.y, 0.0};
    output.environment = {weight.x, weight.y, (x - at.x) * weight.y - (y - at.y) * weight.x};

    const Plain3 momentum = mass * start + dt * weight;
    Plain3 v{momentum.x / mass.x, momentum.y / mass.y, momentum.z / mass.z};
    if (hand.held) {
        const RigidCoupling coupling(grip, at, hand.target, hand, dt);
        const auto end = [&](const UsedCoupling& used, Plain3& end_velocity) {
            Arrow matrix{mass.x, mass.y, mass.z};
            Plain3 right = momentum;
            coupling.add(used, matrix, right);
            end_velocity = matrix.solve(right);
            return true;
        };
        RigidCoupling::Forces forces;
        coupling.solve(end, v, forces);
        forces.tell(output);
    }
    output.source_work = dt * weight.dot(v);

    data.velocity = v.vector();
    data.pose = {x + dt * v.x, y + dt * v.y, data.pose.z() + dt * v.z};
    place_tool(model, data);
    move_neighbors(data, dt);
    Outcomes(data, output).end();
    output.stored_energy = rigid_energy(tool, v);
}

} // namespace haptics::local
