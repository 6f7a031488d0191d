// Continuous contact over one (sub-)step h.
//
// Normal force of a point (eq. 8 with the patch's K, B times the point's share), gap g, gap rate g' = J v -
// w:
//     f = max(0, -K g - B g')                                   semi-implicit: g, g' at the start of the step
//     f = max(0, -K (g + h g'+) - B g'+)                        linearly implicit: at its end
// A point that is apart at the start (g > 0) has no damper in this step: it would pull the brake before the
// touch. Friction of a patch: a spring of the same K, B between the anchor and the surface, f_t = -K (s + h
// v_t+) - B v_t+, returned to the Coulomb bound when it exceeds it: mu_s while sticking, mu_d while sliding,
// f_t = sigma mu_d sum f. The anchor moves only while sliding (then s = -f_t / K), so a sticking contact does
// not creep. Coupling to the hand, always linearly implicit: F_c = K_c (x_t - x_g - h J_h v+) + B_c (v_t -
// J_h v+), x_t at the end of the step.
//
// With the set of pressing points and the stick or slip of each patch known, everything is linear in the end
// velocity v+:
//     (D + h J_h' (h K_c + B_c) J_h + h sum k J'J) v+ = D v + h (tau + J_h'(K_c (x_t - x_g) + B_c v_t) + sum
//     J'(k w - K g)),  k = h K + B.
// The set is found by Newton's method on this piecewise linear equation (without friction the residual is the
// gradient of a convex function, so the true set is its only fixed point). If the set still changes after
// k_max_iterations, projected Gauss-Seidel with a fixed number of sweeps over the same equations gives the
// answer and the step reports that it fell back.

#include <algorithm>
#include <cmath>

#include "internal.hpp"

namespace haptics::local {
namespace {

constexpr int k_max_iterations = 16;
constexpr int k_sweeps = 60;

struct LinearSystem {
    FreedomMatrix matrix;
    FreedomVector right;
};

double row_rate(const ContactSystem& s, int point) {
    return s.normal_rows.row(point).dot(s.velocity) - s.point[static_cast<std::size_t>(point)].drive;
}

double tangent_rate(const ContactSystem& s, int patch) {
    return s.tangent_rows.row(patch).dot(s.velocity) - s.row[static_cast<std::size_t>(patch)].drive;
}

double damping_of(const PointRow& p) {
    return p.gap > 0.0 ? 0.0 : p.damping;
}

double normal_sum(const ContactSystem& s, const PatchRow& t) {
    double sum = 0.0;
    for (int k = 0; k < t.point_count; ++k)
        sum += s.point[static_cast<std::size_t>(t.first_point + k)].force;
    return sum;
}

bool has_friction(const PatchRow& t) {
    return t.static_friction > 0.0;
}

// one end-of-step solve with fixed matrix
void solve(const LinearSystem& l, FreedomVector& v) {
    if (l.matrix.rows() == 3) {
        const Mat3 m = l.matrix.topLeftCorner<3, 3>();
        v = m.partialPivLu().solve(Vec3(l.right.head<3>()));
        return;
    }
    v = l.matrix.partialPivLu().solve(l.right);
}

// Coulomb bound that holds for the patch now: static while sticking, dynamic while sliding
double friction_bound(const PatchRow& t) {
    return t.was_sliding ? t.dynamic_friction : t.static_friction;
}

// stick force that the spring would give, and the mode that follows from it
FrictionMode next_mode(const PatchRow& t, double trial, double normal) {
    if (normal <= 0.0)
        return FrictionMode::off;
    const bool sliding = t.mode == FrictionMode::slip_forward || t.mode == FrictionMode::slip_backward;
    const double bound = (sliding ? t.dynamic_friction : friction_bound(t)) * normal;
    if (std::abs(trial) <= bound)
        return FrictionMode::stick;
    return trial > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
}

double slip_sign(FrictionMode mode) {
    return mode == FrictionMode::slip_forward ? 1.0 : -1.0;
}

// adds the coupling to matrix and right side, and the state's momentum and external force
LinearSystem base_system(const Model& model, const Data& data, const HandInput& hand, double dt,
                         double left) {
    const ContactSystem& s = data.system;
    LinearSystem l;
    l.matrix = s.mass;
    l.right.resize(s.freedoms);
    l.right.noalias() = s.mass * s.velocity;
    l.right += dt * s.external;
    if (!hand.held)
        return l;
    const Mat3 j = grip_jacobian(model.tool.grip, data.pose);
    const Pose target = hand.target - left * hand.target_velocity;
    const Vec3 distance = target - grip_pose(model.tool.grip, data.pose);
    const Vec3 k = dt * hand.stiffness + hand.damping;
    const Vec3 pull = hand.stiffness.cwiseProduct(distance) + hand.damping.cwiseProduct(hand.target_velocity);
    l.matrix.topLeftCorner<3, 3>() += dt * j.transpose() * k.asDiagonal() * j;
    l.right.head<3>() += dt * j.transpose() * (pull + hand.force);
    return l;
}

// coupling force for the end velocity in the system
Wrench coupling_force(const Model& model, const Data& data, const HandInput& hand, double dt, double left) {
    const Mat3 j = grip_jacobian(model.tool.grip, data.pose);
    const Pose target = hand.target - left * hand.target_velocity;
    const Vec3 velocity = j * data.system.velocity.head<3>();
    const Vec3 distance = target - grip_pose(model.tool.grip, data.pose) - dt * velocity;
    Wrench force =
        hand.stiffness.cwiseProduct(distance) + hand.damping.cwiseProduct(hand.target_velocity - velocity);
    if (!model.tool.grip.pose)
        force.z() = 0.0;
    return force;
}

void semi_implicit(Data& data, LinearSystem& l, double dt) {
    ContactSystem& s = data.system;
    for (int i = 0; i < s.points; ++i) {
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        p.force = p.gap < 0.0 ? std::max(0.0, -p.stiffness * p.gap - p.damping * row_rate(s, i)) : 0.0;
        p.active = p.force > 0.0;
        if (p.active)
            l.right += dt * p.force * s.normal_rows.row(i).transpose();
    }
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[static_cast<std::size_t>(i)];
        const double normal = normal_sum(s, t);
        t.force = 0.0;
        t.mode = FrictionMode::off;
        if (!has_friction(t) || normal <= 0.0)
            continue;
        const double trial = -t.stiffness * t.spring - t.damping * tangent_rate(s, i);
        t.mode = next_mode(t, trial, normal);
        t.force = t.mode == FrictionMode::stick ? trial : slip_sign(t.mode) * t.dynamic_friction * normal;
        l.right += dt * t.force * s.tangent_rows.row(i).transpose();
    }
    solve(l, s.velocity);
}

// forces of all rows for the end velocity, with the modes as they are
void implicit_forces(ContactSystem& s, double dt) {
    for (int i = 0; i < s.points; ++i) {
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        const double k = dt * p.stiffness + damping_of(p);
        p.force = std::max(0.0, -p.stiffness * p.gap - k * row_rate(s, i));
    }
}

double friction_trial(const ContactSystem& s, int patch, double dt) {
    const PatchRow& t = s.row[static_cast<std::size_t>(patch)];
    return -t.stiffness * t.spring - (dt * t.stiffness + t.damping) * tangent_rate(s, patch);
}

LinearSystem with_contacts(const ContactSystem& s, const LinearSystem& base, double dt) {
    LinearSystem l = base;
    for (int i = 0; i < s.points; ++i) {
        const PointRow& p = s.point[static_cast<std::size_t>(i)];
        if (!p.active)
            continue;
        const double k = dt * p.stiffness + damping_of(p);
        const double right = k * p.drive - p.stiffness * p.gap;
        const auto row = s.normal_rows.row(i);
        l.matrix.noalias() += dt * k * row.transpose() * row;
        l.right += dt * right * row.transpose();
        const PatchRow& t = s.row[static_cast<std::size_t>(p.patch)];
        if (t.mode == FrictionMode::slip_forward || t.mode == FrictionMode::slip_backward) {
            const double mu = slip_sign(t.mode) * t.dynamic_friction;
            const auto tangent = s.tangent_rows.row(p.patch);
            l.matrix.noalias() += dt * mu * k * tangent.transpose() * row;
            l.right += dt * mu * right * tangent.transpose();
        }
    }
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (t.mode != FrictionMode::stick)
            continue;
        const double k = dt * t.stiffness + t.damping;
        const auto tangent = s.tangent_rows.row(i);
        l.matrix.noalias() += dt * k * tangent.transpose() * tangent;
        l.right += dt * (k * t.drive - t.stiffness * t.spring) * tangent.transpose();
    }
    return l;
}

// takes over the pressing set and the friction modes that follow from the last solve; true when nothing
// changed
bool update_sets(ContactSystem& s, double dt) {
    bool same = true;
    implicit_forces(s, dt);
    for (int i = 0; i < s.points; ++i) {
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        same = same && p.active == (p.force > 0.0);
        p.active = p.force > 0.0;
    }
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (!has_friction(t))
            continue;
        const double trial = friction_trial(s, i, dt);
        const FrictionMode mode = next_mode(t, trial, normal_sum(s, t));
        same = same && mode == t.mode;
        t.mode = mode;
        t.force = mode == FrictionMode::off     ? 0.0
                  : mode == FrictionMode::stick ? trial
                                                : slip_sign(mode) * t.dynamic_friction * normal_sum(s, t);
    }
    return same;
}

// fixed number of sweeps over all rows: bounded, deterministic, forces within their bounds after every sweep
void gauss_seidel(ContactSystem& s, const LinearSystem& base, double dt) {
    const FreedomMatrix inverse = base.matrix.inverse();
    FreedomVector response(s.freedoms);
    s.velocity.noalias() = inverse * base.right;
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].force = 0.0;
    for (int i = 0; i < s.patches; ++i)
        s.row[static_cast<std::size_t>(i)].force = 0.0;
    const auto relax = [&](const auto& row, double k, double wanted_free, double force, double low,
                           double high) {
        response.noalias() = inverse * row.transpose();
        const double compliance = 1.0 / std::max(k, 1e-300) + dt * row.dot(response);
        const double residual = wanted_free / std::max(k, 1e-300) - force / std::max(k, 1e-300);
        const double next = std::clamp(force + residual / compliance, low, high);
        s.velocity += dt * (next - force) * response;
        return next;
    };
    for (int sweep = 0; sweep < k_sweeps; ++sweep) {
        for (int i = 0; i < s.points; ++i) {
            PointRow& p = s.point[static_cast<std::size_t>(i)];
            const double k = dt * p.stiffness + damping_of(p);
            p.force = relax(s.normal_rows.row(i), k, -p.stiffness * p.gap - k * row_rate(s, i), p.force, 0.0,
                            1e300);
        }
        for (int i = 0; i < s.patches; ++i) {
            PatchRow& t = s.row[static_cast<std::size_t>(i)];
            if (!has_friction(t))
                continue;
            const double k = dt * t.stiffness + t.damping;
            const double bound = friction_bound(t) * normal_sum(s, t);
            t.force = relax(s.tangent_rows.row(i), k, friction_trial(s, i, dt), t.force, -bound, bound);
        }
    }
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].active = s.point[static_cast<std::size_t>(i)].force > 0.0;
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[static_cast<std::size_t>(i)];
        const double normal = normal_sum(s, t);
        const bool bound_reached = std::abs(t.force) >= friction_bound(t) * normal;
        t.mode = !has_friction(t) || normal <= 0.0 ? FrictionMode::off
                 : !bound_reached                  ? FrictionMode::stick
                 : t.force > 0.0                   ? FrictionMode::slip_forward
                                                   : FrictionMode::slip_backward;
    }
}

// true when the sets settled
bool linearly_implicit(Data& data, const LinearSystem& base, double dt) {
    ContactSystem& s = data.system;
    // first guess: what presses now keeps pressing, what stuck keeps sticking
    for (int i = 0; i < s.points; ++i) {
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        p.active = p.gap < 0.0;
    }
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[static_cast<std::size_t>(i)];
        t.force = 0.0;
        t.mode = has_friction(t) ? FrictionMode::stick : FrictionMode::off;
    }
    for (int iteration = 0; iteration < k_max_iterations; ++iteration) {
        solve(with_contacts(s, base, dt), s.velocity);
        if (update_sets(s, dt))
            return true;
    }
    gauss_seidel(s, base, dt);
    return false;
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
        t.was_sliding = t.mode == FrictionMode::slip_forward || t.mode == FrictionMode::slip_backward;
    }
}

// what the sub-step did to the tool and to the movables beside it
void book(const Model& model, Data& data, const Wrench& hand_force, double share, double dt,
          StepOutput& output) {
    ContactSystem& s = data.system;
    const Vec3 velocity = s.velocity.head<3>();
    Wrench contact = Wrench::Zero();
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        Vec3 on_tool = t.force * s.tangent_rows.row(i).head<3>().transpose();
        for (int k = 0; k < t.point_count; ++k) {
            const int point = t.first_point + k;
            on_tool += s.point[static_cast<std::size_t>(point)].force *
                       s.normal_rows.row(point).head<3>().transpose();
        }
        contact += on_tool;
        if (on_tool.isZero(0.0) && t.force == 0.0)
            continue;
        // what the other side does: force times its velocity, v_other = v_tool - gap rate
        output.source_work += dt * (on_tool.dot(velocity) - t.force * tangent_rate(s, i));
        for (int k = 0; k < t.point_count; ++k)
            output.source_work -= dt * s.point[static_cast<std::size_t>(t.first_point + k)].force *
                                  row_rate(s, t.first_point + k);
        if (t.movable < 0)
            continue;
        MovableState& m = data.movable[static_cast<std::size_t>(t.movable)];
        if (m.row < 0)
            continue;
        m.given_step = data.step;
        m.belief.given += dt * t.force * s.tangent_rows.row(i).segment<3>(m.row).transpose();
        for (int k = 0; k < t.point_count; ++k) {
            const int point = t.first_point + k;
            m.belief.given += dt * s.point[static_cast<std::size_t>(point)].force *
                              s.normal_rows.row(point).segment<3>(m.row).transpose();
        }
    }
    const Wrench environment = contact + Wrench(s.external.head<3>());
    const Mat3 j = grip_jacobian(model.tool.grip, data.pose);
    output.source_work += dt * (Wrench(s.external.head<3>()).dot(velocity) + hand_force.dot(j * velocity));
    output.contact += share * about_grip(model.tool.grip, data.pose, contact);
    output.environment += share * about_grip(model.tool.grip, data.pose, environment);
    output.grip_acceleration += share * (j * s.inverse_mass.topLeftCorner<3, 3>() * environment);
}

// part of the coupling that takes effect: the gate's share, less what the device cannot answer
double effective_share(const HandInput& hand, const Wrench& full) {
    return std::min({hand.share, hand.max_force / std::max(full.head<2>().norm(), 1e-300),
                     hand.max_torque / std::max(std::abs(full.z()), 1e-300)});
}

void add_coupling(const Model& model, const Data& data, const HandInput& hand, const HandInput& used,
                  double dt, double left, double share, StepOutput& output) {
    const Wrench full = coupling_force(model, data, hand, dt, left);
    output.full_coupling += share * full;
    output.coupling += share * (used.stiffness.isZero(0.0) ? Wrench(used.force - hand.force)
                                                           : coupling_force(model, data, used, dt, left));
}

void solve_step(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                StepOutput& output) {
    LinearSystem base = base_system(model, data, hand, dt, left);
    if (model.settings.integrator == Integrator::semi_implicit)
        semi_implicit(data, base, dt);
    else
        output.fell_back = !linearly_implicit(data, base, dt) || output.fell_back;
}

} // namespace

void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output) {
    ContactSystem& s = data.system;
    load_velocities(data);
    HandInput used = hand;
    used.stiffness *= hand.share;
    used.damping *= hand.share;
    const FreedomVector start = s.velocity;
    solve_step(model, data, used, dt, left, output);
    if (hand.held) {
        // a coupling beyond what the device can answer becomes a constant force of the size it can
        const Wrench full = coupling_force(model, data, hand, dt, left);
        const double effective = effective_share(hand, full);
        if (effective < hand.share) {
            used.stiffness.setZero();
            used.damping.setZero();
            used.force = hand.force + effective * full;
            s.velocity = start;
            solve_step(model, data, used, dt, left, output);
        }
        add_coupling(model, data, hand, used, dt, left, share, output);
    }
    book(model, data, hand.held ? hand.force : Wrench(Wrench::Zero()), share, dt, output);
    move_anchors(s, dt);
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].gap += dt * row_rate(s, i);
    store_velocities(data);
    data.pose += dt * data.velocity;
    for (int i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row >= 0)
            m.belief.pose += dt * m.belief.velocity;
    }
    move_neighbors(data, dt);
}

void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output) {
    LinearSystem base = base_system(model, data, HandInput{}, dt, 0.0);
    const FreedomVector start = data.system.velocity;
    semi_implicit(data, base, dt);
    data.system.velocity = start;
    book(model, data, Wrench::Zero(), 1.0, dt, output);
    move_anchors(data.system, dt);
}

} // namespace haptics::local
