// The tool in configuration space.
//
// A rigid tool's coordinates are the pose of its center of mass: D = diag(m, m, I), J of a point at r from
// the center is [1 0 -r_y; 0 1 r_x; 0 0 1], no Coriolis terms. A linkage's coordinates are those of its
// joints (and of a floating base); D, C, J come from core/dynamics. All else in the local model sees rows,
// a mass matrix and a generalized force, and does not ask which of the two it is.
//
// Time. Semi-implicit Euler with forces of position alone is the leapfrog: its velocities belong to the
// middle of the steps and its positions are of second order. Coriolis terms depend on the velocity too, so
// they are taken at v + h/2 a with the acceleration of the last step, which is where the leapfrog has the
// velocity when it has the position; taken at v they would make the motion of first order.
//
// Energy. Explicit Coriolis terms create energy once a link turns by some tenths of a radian in a step, and a
// whip then explodes. So the kinetic energy has a budget: what it was, plus the work of all other forces
// (which at the end velocity is never less than what the motion gains for a constant D) and of impulses. What
// is beyond the budget is taken off the velocity; the budget follows the energy down to within k_slack above
// it. The paper's preset, without Coriolis terms, has no such bound: there energy wanders by design.
//
// D and J of a step are those of one place. So a linkage's coordinates wait in `displacement` until the step
// ends, and all that follows from them stays as it was when D was factorized. The leapfrog's place is that of
// the start. The exact integrator moves by h v + h^2 a / 2 and has v at the ends of the step; forces of its
// start would drive an oscillation by the factor 1 + (w h)^2 / 4 a step (a pendulum of 1 rad would pass 1.4
// rad in 20 s at 1 kHz). It takes D, J, C and gravity at q + h v / 2: half a drift, a kick, half a drift,
// which is of second order and, for D constant, keeps areas: the map of a spring has the determinant 1. The
// coordinates are there until the step ends, with `displacement` = -h v / 2 at its start. A push from outside
// (free_linkage.hpp) may be that of a hit, after which the link moves on with its new velocity: as with the
// leapfrog the push moves it by h^2 a. With h^2 a / 2 it would stay behind what hit it by half a step and be
// thrown by the contact spring. Coriolis terms are those of the motion after the push, in this step already.

#include <haptics/core/dynamics/energy.hpp>
#include <haptics/core/dynamics/jacobian.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/mass_inverse.hpp>
#include <haptics/core/dynamics/mass_matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "internal.hpp"
#include "rigid_grip.hpp"
#include "row_solver.hpp"

namespace haptics {

void grab(const Model& model, Data& data, const Grip& grip) {
    data.grip = grip;
    local::place_tool(model, data);
}

namespace local {
namespace {

// of the energy budget above the energy
constexpr double k_slack = 1.05;

// kinetic energy of a step that overflowed, J
constexpr double k_absurd = 1e12;
constexpr double k_unbounded = std::numeric_limits<double>::infinity();

std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

// the push from outside of the model as a force on the joints, in `bias`
void write_push(const Model& model, Data& data) {
    const LinkageModel& linkage = model.tool.linkage;
    data.system.bias.setZero(linkage.freedoms);
    for (int i = 0; i < linkage.link_count; ++i) {
        const Vec2 center = link_center_pose(linkage, data.linkage, i).head<2>();
        add_wrench(linkage, data.linkage, i, center, data.push[index(i)], data.system.bias);
    }
}

} // namespace

void place_tool(const Model& model, Data& data) {
    const ToolModel& tool = model.tool;
    if (!tool.articulated) {
        data.tool.body[0].pose = data.pose;
        data.tool.body[0].velocity = data.velocity;
        return;
    }
    update_kinematics(tool.linkage, data.linkage);
    const auto center_velocity = [&](int link, const Pose& center) {
        return point_velocity(tool.linkage, data.linkage, link, center.head<2>());
    };
    for (int i = 0; i < data.tool.body_count; ++i) {
        Body& b = data.tool.body[index(i)];
        b.pose = link_center_pose(tool.linkage, data.linkage, i);
        b.velocity = center_velocity(i, b.pose);
    }
    data.pose = link_center_pose(tool.linkage, data.linkage, data.grip.link);
    data.velocity = center_velocity(data.grip.link, data.pose);
}

void load_tool(const Model& model, Data& data) {
    ContactSystem& s = data.system;
    if (model.tool.articulated)
        s.velocity.head(s.tool_freedoms) = data.linkage.velocity;
    else
        s.velocity.head<3>() = data.velocity;
}

void store_tool(const Model& model, Data& data) {
    const ContactSystem& s = data.system;
    if (model.tool.articulated)
        data.linkage.velocity = s.velocity.head(s.tool_freedoms);
    else
        data.velocity = s.velocity.head<3>();
}

void move_tool(const Model& model, Data& data, const FreedomVector& moved) {
    if (!model.tool.articulated) {
        data.pose += moved.head<3>();
        place_tool(model, data);
        return;
    }
    data.system.bias = moved.head(data.system.tool_freedoms);
    data.system.displacement += data.system.bias;
    const LinkageModel& linkage = model.tool.linkage;
    const Vec2 center = link_center_pose(linkage, data.linkage, data.grip.link).head<2>();
    data.pose += apply_jacobian(linkage, data.linkage, data.grip.link, center, data.system.bias);
}

void begin_tool_step(const Model& model, Data& data) {
    place_tool(model, data); // who runs the model may have set a state
    if (!model.tool.articulated)
        return;
    data.system.force_work = 0.0;
    const double energy = kinetic_energy(model.tool.linkage, data.linkage);
    if (energy > data.energy_budget * (1.0 + 1e-9))
        data.energy_budget = k_slack * energy;
}

void end_tool_step(const Model& model, Data& data) {
    if (!model.tool.articulated)
        return;
    ContactSystem& s = data.system;
    s.start_velocity += s.jump;
    data.half_step = 0.5 * (data.linkage.velocity - s.start_velocity);
    data.linkage.position += s.displacement;
    s.displacement.setZero();
    place_tool(model, data);
    if (!model.tool.linkage.coriolis)
        return;
    const double energy = kinetic_energy(model.tool.linkage, data.linkage);
    if (std::isfinite(s.force_work))
        data.energy_budget = std::max(0.0, data.energy_budget + s.force_work);
    if (energy <= data.energy_budget) {
        data.energy_budget = std::min(data.energy_budget, k_slack * energy);
        return;
    }
    // too fast for the step: no extrapolation either, and what overflowed is left out
    if (energy < k_absurd) {
        data.linkage.velocity *= std::sqrt(data.energy_budget / energy);
    } else {
        data.linkage.position = s.start_position;
        data.linkage.velocity = s.start_velocity;
        place_tool(model, data);
        if (!(kinetic_energy(model.tool.linkage, data.linkage) < k_absurd))
            data.energy_budget = k_unbounded; // it was absurd before: divergence.cpp
    }
    data.half_step.setZero();
    place_tool(model, data);
}

void write_tool_mass(const Model& model, Data& data, double dt) {
    ContactSystem& s = data.system;
    const ToolModel& tool = model.tool;
    s.has_joint_springs = false;
    if (!tool.articulated) {
        const Vec3 mass(tool.mass, tool.mass, tool.inertia);
        s.mass.topLeftCorner<3, 3>().diagonal() = mass;
        s.inverse_mass.topLeftCorner<3, 3>().diagonal() = mass.cwiseInverse();
        s.tool_weight = Vec3(tool.mass * data.gravity.x(), tool.mass * data.gravity.y(), 0.0);
        s.external.head<3>() = s.tool_weight;
        s.has_mass = true;
        s.has_inverse = true;
        return;
    }
    const int n = s.tool_freedoms;
    s.start_position = data.linkage.position;
    s.jump.setZero(n);
    if (data.pushed && s.ahead > 0.0) {
        factorize(tool.linkage, data.linkage, nullptr, data.factor);
        write_push(model, data);
        solve(tool.linkage, data.linkage, data.factor, s.bias, s.jump);
        s.jump *= dt;
        data.half_step += s.jump;
    }
    s.displacement = s.ahead * (s.jump - data.linkage.velocity);
    if (s.ahead > 0.0) {
        data.linkage.position += s.ahead * data.linkage.velocity;
        update_kinematics(tool.linkage, data.linkage);
    }
    s.start_velocity = data.linkage.velocity;
    s.has_mass = false;
    s.has_inverse = false;
    factorize(tool.linkage, data.linkage, nullptr, data.factor);
    if (!is_long(model)) {
        need_mass(model, data);
        need_inverse(model, data);
    }
    write_tool_force(model, data);
    const bool springs = tool.linkage.has_passive && data.plan.runs(Stage::joint_springs);
    for (int i = tool.linkage.floating ? 3 : 0; springs && i < n; ++i) {
        const JointSpec& joint = tool.linkage.passive[i];
        s.has_joint_springs = s.has_joint_springs || joint.spring_stiffness > 0.0 || joint.damping > 0.0;
    }
}

void write_tool_force(const Model& model, Data& data) {
    if (!model.tool.articulated)
        return;
    ContactSystem& s = data.system;
    s.bias = data.linkage.velocity;
    data.linkage.velocity += data.half_step;
    update_kinematics(model.tool.linkage, data.linkage);
    data.linkage.velocity = s.bias;
    if (data.plan.runs(Stage::coriolis))
        bias_forces(model.tool.linkage, data.linkage, Vec2::Zero(), s.bias);
    else
        s.bias.setZero();
    s.external.head(s.tool_freedoms) = -s.bias;
    s.tool_weight.setZero(s.tool_freedoms);
    if (data.plan.runs(Stage::gravity) && !data.gravity.isZero(0.0)) {
        s.tool_weight = s.bias;
        bias_forces(model.tool.linkage, data.linkage, data.gravity, s.bias);
        s.tool_weight -= s.bias;
        s.external.head(s.tool_freedoms) = -s.bias;
    }
    if (!data.pushed)
        return;
    write_push(model, data);
    s.tool_weight += s.bias;
    s.external.head(s.tool_freedoms) += s.bias;
}

Vec3 joint_spring(const Model& model, const Data& data, int freedom) {
    const JointSpec& joint = model.tool.linkage.passive[freedom];
    const double moved = data.system.displacement[freedom];
    return {data.linkage.position[freedom] + moved - joint.spring_rest, joint.spring_stiffness,
            joint.damping};
}

void need_mass(const Model& model, Data& data) {
    ContactSystem& s = data.system;
    if (s.has_mass)
        return;
    s.has_mass = true;
    mass_matrix(model.tool.linkage, data.linkage, s.tool_mass);
    s.mass.topLeftCorner(s.tool_freedoms, s.tool_freedoms) = s.tool_mass;
}

void need_inverse(const Model& model, Data& data) {
    ContactSystem& s = data.system;
    if (s.has_inverse)
        return;
    s.has_inverse = true;
    inverse_mass_matrix(model.tool.linkage, data.linkage, data.factor, s.tool_inverse);
    s.inverse_mass.topLeftCorner(s.tool_freedoms, s.tool_freedoms) = s.tool_inverse;
}

Mat3 mobility(const Model& model, Data& data) {
    ContactSystem& s = data.system;
    if (!model.tool.articulated) {
        const RigidGrip grip{s.grip(1, 2), -s.grip(0, 2), data.grip.pose};
        return grip.mobility(model.tool.mass, model.tool.inertia);
    }
    Mat3 result;
    for (int i = 0; i < 3; ++i) {
        s.tool_force = s.grip.row(i).transpose();
        result.col(i) = tool_response(model, data, s.tool_force);
    }
    return 0.5 * (result + result.transpose());
}

Vec3 tool_response(const Model& model, Data& data, const LinkageVector& force) {
    ContactSystem& s = data.system;
    if (!model.tool.articulated) {
        const Vec3 inverse(1.0 / model.tool.mass, 1.0 / model.tool.mass, 1.0 / model.tool.inertia);
        return s.grip.lazyProduct(inverse.cwiseProduct(force));
    }
    solve(model.tool.linkage, data.linkage, data.factor, force, s.bias);
    return s.grip * s.bias;
}

double tool_energy(const Model& model, const Data& data) {
    const ToolModel& tool = model.tool;
    if (!tool.articulated)
        return rigid_energy(tool, plain(data.velocity));
    double energy = kinetic_energy(tool.linkage, data.linkage);
    for (int i = 0; data.system.has_joint_springs && i < tool.linkage.freedoms; ++i) {
        const Vec3 spring = joint_spring(model, data, i);
        energy += 0.5 * spring.y() * spring.x() * spring.x();
    }
    return energy;
}

void add_tool_row(const Model& model, const Data& data, int link, const Vec2& point, const Vec2& direction,
                  double sign, double* row) {
    if (!model.tool.articulated) {
        const Vec2 arm = point - data.pose.head<2>();
        row[0] += sign * direction.x();
        row[1] += sign * direction.y();
        row[2] += sign * cross(arm, direction);
        return;
    }
    const Wrench along(sign * direction.x(), sign * direction.y(), 0.0);
    visit_jacobian(model.tool.linkage, data.linkage, link, point,
                   [&](int freedom, const Vec3& column) { row[freedom] += column.dot(along); });
}

void grip_rows(const Model& model, const Data& data, GripRows& rows) {
    if (model.tool.articulated) {
        const Pose center = link_center_pose(model.tool.linkage, data.linkage, data.grip.link);
        const Vec2 point = grip_pose(data.grip, center).head<2>();
        point_jacobian(model.tool.linkage, data.linkage, data.grip.link, point, rows);
    } else {
        const Vec2 r = rotate(data.pose.z(), data.grip.point);
        rows.setIdentity(3, 3);
        rows(0, 2) = -r.y();
        rows(1, 2) = r.x();
    }
    if (!data.grip.pose)
        rows.row(2).setZero();
}

Vec3 grip_bias(const Model& model, const Data& data) {
    if (!model.tool.articulated) {
        const Vec2 r = rotate(data.pose.z(), data.grip.point);
        const double square = data.velocity.z() * data.velocity.z();
        return {-square * r.x(), -square * r.y(), 0.0};
    }
    if (!model.tool.linkage.coriolis)
        return Vec3::Zero();
    const Vec2 point = grip_pose(data.grip, data.pose).head<2>();
    return point_bias(model.tool.linkage, data.linkage, data.grip.link, point);
}

} // namespace local
} // namespace haptics
