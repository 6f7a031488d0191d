// Continuous contact over one (sub-)step h.
//
// Normal force of a point (eq. 8 with the patch's K, B times the point's share), gap g, gap rate g' = J v -
// w:
//     f = max(0, -K g - B g')                                   semi-implicit: g, g' at the start of the step
//     f = max(0, -K (g + h g'+) - B g'+)                        linearly implicit: at its end
// A point that is apart at the start (g > 0) has no damper in this step: it would pull the brake before the
// touch. Friction of a patch: a spring of the same K, B between the anchor and the surface, f_t = -K (s + h
// v_t+) - B v_t+, returned to the Coulomb bound when it exceeds it: mu_s while sticking, mu_d while sliding,
// f_t = sigma (mu_d sum f + b), b the constant bound of a joint's friction. The anchor moves only while
// sliding (then s = -f_t / K), so a sticking contact does not creep. Coupling to the hand and springs and
// dampers of joints, always linearly implicit: F_c = K_c (x_t - x_g - h J_h v+) + B_c (v_t - J_h v+), x_t at
// the end of the step; tau_j = -k (q - q_0 + h q'+) - b q'+.
//
// With the set of pressing points and the stick or slip of each patch known, everything is linear in the end
// velocity v+:
//     (D + h (h k_j + b_j) + h J_h' (h K_c + B_c) J_h + h sum k J'J) v+
//         = D v + h (tau - k_j (q - q_0) + J_h'(K_c (x_t - x_g) + B_c v_t) + sum J'(k w - K g)),  k = h K +
//         B.
// The set is found by Newton's method on this piecewise linear equation (without friction the residual is the
// gradient of a convex function, so the true set is its only fixed point). If the set still changes after
// k_max_iterations, projected Gauss-Seidel with a fixed number of sweeps over the same equations gives the
// answer and the step reports that it fell back. primal_solver.hpp forms the matrix above (few freedoms, or
// many rows); row_solver.cpp works with as many unknowns as there are rows, in O(n) for each (long linkages).

#include <algorithm>
#include <cmath>

#include "dense_solver.hpp"
#include "internal.hpp"
#include "primal_solver.hpp"
#include "row_solver.hpp"

namespace haptics::local {
namespace {

double row_rate(const ContactSystem& s, int point) {
    return s.normal_rows.row(point).dot(s.velocity) - s.point[static_cast<std::size_t>(point)].drive;
}

double tangent_rate(const ContactSystem& s, int patch) {
    return s.tangent_rows.row(patch).dot(s.velocity) - s.row[static_cast<std::size_t>(patch)].drive;
}

// coupling force for the end velocity in the system
Wrench coupling_force(const Data& data, const HandInput& hand, double dt, double left) {
    const ContactSystem& s = data.system;
    const Pose target = hand.target - left * hand.target_velocity;
    const Vec3 velocity = s.grip * s.velocity.head(s.tool_freedoms);
    const Vec3 distance = target - grip_pose(data.grip, data.pose) - dt * velocity;
    Wrench force =
        hand.stiffness.cwiseProduct(distance) + hand.damping.cwiseProduct(hand.target_velocity - velocity);
    if (!data.grip.pose)
        force.z() = 0.0;
    return force;
}

template <int N>
bool solve_primal(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                  Integrator integrator) {
    PrimalSolver<N> solver(model, data, hand, dt, left);
    return solver.run(integrator);
}

// velocities and forces at the end of the sub-step; false when the solver used its fallback
bool solve_step(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                Integrator integrator) {
    if (is_long(model) && fits_row_solver(data.system))
        return solve_by_rows(model, data, hand, dt, left, integrator);
    switch (data.system.freedoms) {
    case 1:
        return solve_primal<1>(model, data, hand, dt, left, integrator);
    case 2:
        return solve_primal<2>(model, data, hand, dt, left, integrator);
    case 3:
        return solve_primal<3>(model, data, hand, dt, left, integrator);
    case 4:
        return solve_primal<4>(model, data, hand, dt, left, integrator);
    default:
        return solve_dense(model, data, hand, dt, left, integrator);
    }
}

// the friction anchor moves only while sliding
void move_anchors(ContactSystem& s, double dt) {
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (t.mode == FrictionMode::stick)
            t.spring += dt * tangent_rate(s, i);
        else if (t.mode == FrictionMode::off || t.stiffness <= 0.0)
            t.spring = 0.0;
        else
            t.spring = -t.force / t.stiffness;
        t.was_sliding = slips(t.mode);
    }
}

// counters of what the tool gave to a movable, and the work that the other side of a patch did
void book_other_side(Data& data, int i, double dt, StepOutput& output) {
    ContactSystem& s = data.system;
    const PatchRow& t = s.row[static_cast<std::size_t>(i)];
    const int n = s.tool_freedoms;
    // force times the velocity of the other side, v_other = v_tool - gap rate
    const auto work = [&](const auto& row, double force, double drive) {
        output.source_work +=
            dt * force * (row.head(n).dot(s.velocity.head(n)) - row.dot(s.velocity) + drive);
    };
    MovableState* m = t.movable < 0 ? nullptr : &data.movable[static_cast<std::size_t>(t.movable)];
    const auto give = [&](const auto& row, double force) {
        if (m != nullptr && m->row >= 0)
            m->belief.given += dt * force * row.template segment<3>(m->row).transpose();
    };
    work(s.tangent_rows.row(i), t.force, t.drive);
    give(s.tangent_rows.row(i), t.force);
    for (int k = 0; k < t.point_count; ++k) {
        const int point = t.first_point + k;
        const PointRow& p = s.point[static_cast<std::size_t>(point)];
        work(s.normal_rows.row(point), p.force, p.drive);
        give(s.normal_rows.row(point), p.force);
    }
    if (m != nullptr && m->row >= 0)
        m->given_step = data.step;
}

// what the sub-step did to the tool and to the movables beside it
void book(const Model& model, Data& data, const Wrench& hand_force, double share, double dt,
          StepOutput& output) {
    ContactSystem& s = data.system;
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
            book_other_side(data, i, dt, output);
    }
    if (s.has_joint_springs)
        for (int i = 0; i < n; ++i) {
            const Vec3 spring = joint_spring(model, data, i);
            const double rate = s.velocity(i);
            s.tool_force(i) -= spring.y() * (spring.x() + dt * rate) + spring.z() * rate;
        }
    s.force_work += dt * (s.tool_force - s.external.head(n) + s.tool_weight).dot(s.velocity.head(n));
    output.source_work +=
        dt * (s.tool_weight.dot(s.velocity.head(n)) + hand_force.dot(s.grip * s.velocity.head(n)));
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

// part of the coupling that takes effect: the gate's share, less what the device cannot answer
double effective_share(const HandInput& hand, const Wrench& full) {
    return std::min({hand.share, hand.max_force / std::max(full.head<2>().norm(), 1e-300),
                     hand.max_torque / std::max(std::abs(full.z()), 1e-300)});
}

void add_coupling(const Data& data, const HandInput& hand, const HandInput& used, double dt, double left,
                  double share, StepOutput& output) {
    const Wrench full = coupling_force(data, hand, dt, left);
    output.full_coupling += share * full;
    output.coupling += share * (used.stiffness.isZero(0.0) ? Wrench(used.force - hand.force)
                                                           : coupling_force(data, used, dt, left));
}

} // namespace

void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output) {
    ContactSystem& s = data.system;
    load_velocities(model, data);
    HandInput used = hand;
    used.stiffness *= hand.share;
    used.damping *= hand.share;
    const FreedomVector start = s.velocity;
    bool settled = solve_step(model, data, used, dt, left, model.settings.integrator);
    if (hand.held) {
        // a coupling beyond what the device can answer becomes a constant force of the size it can
        const Wrench full = coupling_force(data, hand, dt, left);
        const double effective = effective_share(hand, full);
        if (effective < hand.share) {
            used.stiffness.setZero();
            used.damping.setZero();
            used.force = hand.force + effective * full;
            s.velocity = start;
            settled = solve_step(model, data, used, dt, left, model.settings.integrator) && settled;
        }
        add_coupling(data, hand, used, dt, left, share, output);
        const Wrench applied = coupling_force(data, used, dt, left) + used.force;
        s.force_work += dt * applied.dot(s.grip * s.velocity.head(s.tool_freedoms));
    }
    output.fell_back = output.fell_back || !settled;
    book(model, data, hand.held ? hand.force : Wrench(Wrench::Zero()), share, dt, output);
    move_anchors(s, dt);
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].gap += dt * row_rate(s, i);
    store_velocities(model, data);
    move_tool(model, data, dt);
    for (int i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row >= 0)
            m.belief.pose += dt * m.belief.velocity;
    }
    move_neighbors(data, dt);
}

void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output) {
    const FreedomVector start = data.system.velocity;
    solve_step(model, data, HandInput{}, dt, 0.0, Integrator::semi_implicit);
    data.system.velocity = start;
    book(model, data, Wrench::Zero(), 1.0, dt, output);
    move_anchors(data.system, dt);
}

} // namespace haptics::local
