// From the contact system to springs: rows, first modes, and which springs act in a mode.
//
// In a mode every acting row is a spring-damper with a row and a push (flow.hpp). Where a patch slides, the
// normal force f of each of its points pushes along J + sigma mu_d T, so that the friction sigma mu_d f goes
// with it; a constant bound sigma b is a constant force.

#include <algorithm>
#include <cmath>

#include "exact_run.hpp"

namespace haptics::local {

void ExactRun::add_row(const FlowVector& direction, double stiffness, double damping, double drive,
                       double displacement) {
    FlowRow& r = flow_.row[static_cast<std::size_t>(flow_.rows++)];
    const auto n = static_cast<std::size_t>(flow_.freedoms);
    r.row = direction;
    for (std::size_t k = 0; k < n; ++k) {
        r.push[k] = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            r.push[k] +=
                s_.inverse_mass(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) * direction[i];
    }
    r.stiffness = stiffness;
    r.damping = damping;
    r.drive = drive;
    r.displacement = displacement;
    r.mobility = flow_dot(r.row, r.push, flow_.freedoms);
    r.acts = false;
}

void ExactRun::setup(const HandInput& hand, double left) {
    const int n = s_.freedoms;
    need_inverse(model_, data_);
    flow_.freedoms = n;
    add_contacts();
    FreedomVector force = s_.external;
    add_joint_springs();
    if (hand.held) {
        force.head(s_.tool_freedoms) += s_.grip.transpose() * hand.force;
        add_coupling(hand, left);
    }
    for (int k = 0; k < n; ++k) {
        flow_.velocity[static_cast<std::size_t>(k)] = s_.velocity(k);
        free_[static_cast<std::size_t>(k)] = s_.inverse_mass.row(k).dot(force);
    }
    guess_modes();
    fresh_.fill(false);
}

void ExactRun::add_contacts() {
    FlowVector direction;
    const auto take = [&](const auto& from) {
        for (int k = 0; k < s_.freedoms; ++k)
            direction[static_cast<std::size_t>(k)] = from(k);
    };
    for (int i = 0; i < s_.points; ++i) {
        const PointRow& p = point(i);
        take(s_.normal_rows.row(i));
        add_row(direction, p.stiffness, p.damping, p.drive, p.gap);
        normal_impulse_[static_cast<std::size_t>(i)] = 0.0;
    }
    for (int i = 0; i < s_.patches; ++i) {
        PatchRow& t = patch(i);
        take(s_.tangent_rows.row(i));
        add_row(direction, t.stiffness, t.damping, t.drive, t.spring);
        tangent_impulse_[static_cast<std::size_t>(i)] = 0.0;
        t.movable_work = 0.0;
    }
}

void ExactRun::add_joint_springs() {
    if (!s_.has_joint_springs)
        return;
    FlowVector direction;
    for (int i = 0; i < s_.tool_freedoms; ++i) {
        const Vec3 spring = joint_spring(model_, data_, i);
        if (spring.y() == 0.0 && spring.z() == 0.0)
            continue;
        direction.fill(0.0);
        direction[static_cast<std::size_t>(i)] = 1.0;
        add_row(direction, spring.y(), spring.z(), 0.0, spring.x());
        row(flow_.rows - 1).acts = true;
    }
}

// d = grip - target: the target comes to hand.target in `left` seconds
void ExactRun::add_coupling(const HandInput& hand, double left) {
    const Vec3 distance = grip_pose(data_.grip, data_.pose) - (hand.target - left * hand.target_velocity);
    FlowVector direction;
    for (int axis = 0; axis < (data_.grip.pose ? 3 : 2); ++axis) {
        if (hand.stiffness(axis) == 0.0 && hand.damping(axis) == 0.0)
            continue;
        direction.fill(0.0);
        for (int k = 0; k < s_.tool_freedoms; ++k)
            direction[static_cast<std::size_t>(k)] = s_.grip(axis, k);
        add_row(direction, hand.stiffness(axis), hand.damping(axis), hand.target_velocity(axis),
                distance(axis));
        row(flow_.rows - 1).acts = true;
    }
}

// A first guess from the state; what is wrong in it ends at once.
void ExactRun::guess_modes() {
    for (int i = 0; i < s_.points; ++i) {
        PointRow& p = point(i);
        const double rate = flow_dot(row(i).row, flow_.velocity, flow_.freedoms) - p.drive;
        p.active = p.gap <= 0.0 && -p.stiffness * p.gap - p.damping * rate >= 0.0;
    }
    for (int i = 0; i < s_.patches; ++i) {
        PatchRow& t = patch(i);
        if (!has_friction(t) || (t.bound <= 0.0 && !pressed(i)))
            t.mode = FrictionMode::off;
        else if (t.was_sliding && t.spring != 0.0)
            t.mode = t.spring < 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
        else
            t.mode = FrictionMode::stick;
    }
}

bool ExactRun::pressed(int i) const {
    const PatchRow& t = patch(i);
    for (int k = 0; k < t.point_count; ++k)
        if (point(t.first_point + k).active)
            return true;
    return false;
}

// which springs act, and how a sliding patch's normal force pushes along the tangent too
void ExactRun::choose_springs() {
    const auto n = static_cast<std::size_t>(flow_.freedoms);
    flow_.free_acceleration = free_;
    for (int i = 0; i < s_.patches; ++i) {
        const PatchRow& t = patch(i);
        FlowRow& tangent = row(row_of_patch(i));
        tangent.acts = t.mode == FrictionMode::stick;
        const double share = slips(t.mode) ? slip_sign(t.mode) * t.dynamic_friction : 0.0;
        if (slips(t.mode) && t.bound > 0.0)
            for (std::size_t k = 0; k < n; ++k)
                flow_.free_acceleration[k] += slip_sign(t.mode) * t.bound * tangent.push[k];
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
            FlowRow& normal = row(q);
            normal.acts = point(q).active;
            for (std::size_t k = 0; k < n; ++k) {
                normal.push[k] = 0.0;
                for (std::size_t m = 0; m < n; ++m)
                    normal.push[k] +=
                        s_.inverse_mass(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(m)) *
                        (normal.row[m] + share * tangent.row[m]);
            }
            // |row| (|row| + share |tangent|) in the metric of the mass matrix
            const double own = flow_dot(normal.row, normal.push, flow_.freedoms) -
                               share * flow_dot(normal.row, tangent.push, flow_.freedoms);
            normal.mobility = own + std::abs(share) * std::sqrt(std::max(own * tangent.mobility, 0.0));
        }
    }
    measure(flow_);
}

} // namespace haptics::local
