// What a sub-step did: forces, impulses and work for the report, poses for the next one.
//
// All forces but friction at its bound are linear in displacements and velocities, so their mean over a
// stretch of time is the force for the mean displacement and the mean velocity. The step integrators know one
// velocity and one place, those of the end; the exact one gives the means. The other products here, force
// times velocity, are exact for constant velocities; where a movable is on the other side the exact
// integrator has integrated the product itself.

#include <algorithm>
#include <array>
#include <cmath>

#include "hold_back.hpp"
#include "internal.hpp"

namespace haptics::local {
namespace {

// the work that the other side of a patch did
void book_other_side(Data& data, int i, const Motion& motion, StepOutput& output) {
    ContactSystem& s = data.system;
    const PatchRow& t = s.row[static_cast<std::size_t>(i)];
    const int n = s.tool_freedoms;
    const double dt = motion.dt;
    // force times the velocity of the other side, v_other = v_tool - gap rate
    const auto work = [&](const auto& row, double force, double drive) {
        const double moving =
            motion.integrated ? 0.0 : row.head(n).dot(motion.rate.head(n)) - row.dot(motion.rate);
        output.source_work += dt * force * (moving + drive);
    };
    output.source_work += motion.integrated ? t.movable_work : 0.0;
    work(s.tangent_rows.row(i), t.force, t.drive);
    for (int k = 0; k < t.point_count; ++k) {
        const int point = t.first_point + k;
        const PointRow& p = s.point[static_cast<std::size_t>(point)];
        work(s.normal_rows.row(point), p.force, p.drive);
    }
}

// what the movables are given
void book_push(Data& data, double dt) {
    ContactSystem& s = data.system;
    if (s.freedoms == s.tool_freedoms)
        return;
    std::array<double, k_max_points> normal;
    std::array<double, k_max_rows> tangent;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.points); ++i)
        normal[i] = dt * s.point[i].force;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.patches); ++i)
        tangent[i] = dt * s.row[i].force;
    tell_push(data, normal.data(), tangent.data());
}

} // namespace

Wrench coupling_force(const Data& data, const HandInput& hand, const Motion& motion) {
    const ContactSystem& s = data.system;
    const Pose target = hand.target - motion.left * hand.target_velocity;
    const Vec3 distance =
        target - grip_pose(data.grip, data.pose) - s.grip * motion.stretch.head(s.tool_freedoms);
    const Vec3 rate = hand.target_velocity - s.grip * motion.rate.head(s.tool_freedoms);
    Wrench force = hand.stiffness.cwiseProduct(distance) + hand.damping.cwiseProduct(rate);
    if (!data.grip.pose)
        force.z() = 0.0;
    return force;
}

void book(const Model& model, Data& data, const Motion& motion, double share, StepOutput& output) {
    ContactSystem& s = data.system;
    const double dt = motion.dt;
    const int n = s.tool_freedoms;
    const Vec2 grip = grip_pose(data.grip, data.pose).head<2>();
    Wrench contact = Wrench::Zero();
    s.tool_force = s.external.head(n);
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        double pressing = 0.0;
        Vec2 moment{0.0, 0.0};
        const Patch* patch = t.patch < 0 ? nullptr : &data.patches.patch[static_cast<std::size_t>(t.patch)];
        if (patch != nullptr && patch->body_a >= data.tool.body_count)
            continue;
        for (int k = 0; k < t.point_count; ++k) {
            const int point = t.first_point + k;
            const PointRow& p = s.point[static_cast<std::size_t>(point)];
            if (p.force == 0.0)
                continue;
            pressing += p.force;
            s.tool_force += p.force * s.normal_rows.row(point).head(n).transpose();
            if (patch != nullptr)
                moment += p.force * patch->point[static_cast<std::size_t>(p.slot)].position;
        }
        if (t.force != 0.0)
            s.tool_force += t.force * s.tangent_rows.row(i).head(n).transpose();
        if (patch == nullptr || (pressing == 0.0 && t.force == 0.0))
            continue;
        const Vec2 force = pressing * patch->normal + t.force * perpendicular(patch->normal);
        double torque = cross(moment - pressing * grip, patch->normal);
        if (t.force != 0.0) {
            Vec2 middle{0.0, 0.0};
            for (int k = 0; k < patch->point_count; ++k)
                middle += patch->point[static_cast<std::size_t>(k)].weight *
                          patch->point[static_cast<std::size_t>(k)].position;
            torque += t.force * cross(middle - grip, perpendicular(patch->normal));
        }
        contact += Wrench(force.x(), force.y(), torque);
        const bool moves =
            t.movable >= 0 || t.drive != 0.0 ||
            (t.point_count > 0 && s.point[static_cast<std::size_t>(t.first_point)].drive != 0.0);
        if (moves)
            book_other_side(data, i, motion, output);
    }
    book_push(data, dt);
    if (s.has_joint_springs)
        for (int i = 0; i < n; ++i) {
            const Vec3 spring = joint_spring(model, data, i);
            s.tool_force(i) -= spring.y() * (spring.x() + motion.stretch(i)) + spring.z() * motion.rate(i);
        }
    output.source_work += dt * s.tool_weight.dot(motion.rate.head(n));
    output.contact += share * contact;
    output.environment += share * contact;
    if (!model.tool.articulated) {
        const Vec2 weight = s.external.head<2>();
        const Vec2 arm = data.pose.head<2>() - grip;
        output.environment += share * Wrench(weight.x(), weight.y(), cross(arm, weight));
    }
    output.grip_acceleration += share * tool_response(model, data, s.tool_force);
    output.grip_bias += share * grip_bias(model, data);
}

HandInput at_share(const HandInput& hand) {
    HandInput used = hand;
    used.stiffness *= hand.share;
    used.damping *= hand.share;
    return used;
}

bool hold_back(const HandInput& hand, const Wrench& full, HandInput& used) {
    const double effective = effective_share(hand, full);
    if (effective >= hand.share)
        return false;
    used.stiffness.setZero();
    used.damping.setZero();
    used.force = hand.force + effective * full;
    return true;
}

Wrench book_coupling(const Data& data, const HandInput& hand, const HandInput& used, const Motion& motion,
                     double share, StepOutput& output) {
    const Wrench spring = coupling_force(data, used, motion);
    output.full_coupling += share * coupling_force(data, hand, motion);
    output.coupling += share * (spring + used.force - hand.force);
    return spring;
}

void move_bodies(const Model& model, Data& data, const FreedomVector& moved, double dt) {
    store_velocities(model, data);
    move_tool(model, data, moved);
    for (int i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row >= 0)
            m.belief.pose += moved.segment<3>(m.row);
    }
    move_neighbors(data, dt);
}

} // namespace haptics::local
