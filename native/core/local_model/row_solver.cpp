// A long linkage in O(n) for each row.
//
// The equation of integrate.cpp is A0 v+ = D v + h f0 + h R' f, with A0 = D + h (h k_j + b_j) for the joints,
// f0 all constant forces, R the rows (grip, points, patches) and f the forces along them. The
// articulated-body method solves with A0 in O(n), so with v0 = v + A0^-1 (h f0 - h (h k_j + b_j) v), Y =
// A0^-1 R', W = R Y
//     v+ = v0 + h Y f,   u = R v+ = R v0 + h W f,
// and every row has a law that is linear once its mode is known: f = c - k u for a spring and damper (grip,
// pressing point, sticking patch), f = sigma (mu sum f_p + b) for a slipping patch, f = 0 else. That is a
// system of as many unknowns as rows. Each law is divided by 1 + h k W_ii, so that infinite stiffness is as
// good as any.

#include "row_solver.hpp"

#include <haptics/core/dynamics/articulated.hpp>

#include <algorithm>
#include <cmath>

#include "contact_rules.hpp"
#include "internal.hpp"
#include "primal_solver.hpp"

namespace haptics::local {
namespace {

class RowSolver {
  public:
    RowSolver(const Model& model, Data& data, const HandInput& hand, double dt, double left)
        : model_(model)
        , data_(data)
        , s_(data.system)
        , r_(data.system.rows)
        , dt_(dt)
        , held_(hand.held)
        , points_(3)
        , patches_(3 + s_.points)
        , count_(3 + s_.points + s_.patches) {
        free_velocity();
        responses();
        grip_laws(hand, left);
    }

    void semi_implicit() {
        r_.force.setZero(count_);
        for (int i = 0; i < s_.points; ++i) {
            PointRow& p = point(i);
            p.force = p.gap < 0.0 ? std::max(0.0, -p.stiffness * p.gap - p.damping * rate(i)) : 0.0;
            p.active = p.force > 0.0;
            r_.force[points_ + i] = p.force;
        }
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            const double pressing = normal_sum(s_, t);
            const double trial = -t.stiffness * t.spring - t.damping * slip_rate(i);
            t.mode = has_friction(t) ? next_mode(t, trial, pressing) : FrictionMode::off;
            t.force = friction_force(t, t.mode, trial, pressing);
            r_.force[patches_ + i] = t.force;
        }
        // the grip answers the velocity that follows from all these
        Mat3 matrix = Mat3::Identity();
        Vec3 right = Vec3::Zero();
        for (int i = 0; held_ && i < 3; ++i) {
            const double k = r_.stiffness[i];
            const double scale = 1.0 / (1.0 + dt_ * k * r_.mobility(i, i));
            matrix.row(i) = scale * (matrix.row(i) + dt_ * k * r_.mobility.row(i).head<3>());
            const double others = r_.mobility.row(i).tail(count_ - 3).dot(r_.force.tail(count_ - 3));
            right[i] = scale * (r_.push[i] - k * (r_.rate[i] + dt_ * others));
        }
        solve_pivoted(matrix, right);
        r_.force.head<3>() = right;
        apply();
    }

    bool linearly_implicit() {
        for (int i = 0; i < s_.points; ++i)
            point(i).active = point(i).gap < 0.0;
        for (int i = 0; i < s_.patches; ++i) {
            patch(i).force = 0.0;
            patch(i).mode = has_friction(patch(i)) ? FrictionMode::stick : FrictionMode::off;
        }
        for (int iteration = 0; iteration < k_max_iterations; ++iteration) {
            solve_sets();
            if (update_sets()) {
                apply();
                return true;
            }
        }
        gauss_seidel();
        apply();
        return false;
    }

  private:
    PointRow& point(int i) { return s_.point[static_cast<std::size_t>(i)]; }
    PatchRow& patch(int i) { return s_.row[static_cast<std::size_t>(i)]; }
    // at the start of the sub-step
    double rate(int i) { return s_.normal_rows.row(i).dot(s_.velocity) - point(i).drive; }
    double slip_rate(int i) { return s_.tangent_rows.row(i).dot(s_.velocity) - patch(i).drive; }

    // A0^-1 x for one vector over all freedoms
    template <typename Column>
    void solve_base(Column&& x) {
        const int n = s_.tool_freedoms;
        s_.bias = x.head(n);
        solve(model_.tool.linkage, data_.linkage, s_.has_joint_springs ? r_.factor : data_.factor, s_.bias,
              s_.bias);
        x.head(n) = s_.bias;
        const int others = s_.freedoms - n;
        x.tail(others) = s_.inverse_mass.bottomRightCorner(others, others).lazyProduct(x.tail(others)).eval();
    }

    void free_velocity() {
        const int n = s_.tool_freedoms;
        r_.free = dt_ * s_.external;
        if (s_.has_joint_springs) {
            r_.added.resize(n);
            for (int i = 0; i < n; ++i) {
                const Vec3 spring = joint_spring(model_, data_, i);
                r_.added[i] = dt_ * (dt_ * spring.y() + spring.z());
                r_.free[i] -= dt_ * spring.y() * spring.x() + r_.added[i] * s_.velocity[i];
            }
            factorize(model_.tool.linkage, data_.linkage, &r_.added, r_.factor);
        }
        solve_base(r_.free);
        r_.free += s_.velocity;
    }

    void responses() {
        const int n = s_.tool_freedoms;
        r_.row.setZero(s_.freedoms, count_);
        r_.row.topLeftCorner(n, 3) = s_.grip.transpose();
        for (int i = 0; i < s_.points; ++i)
            r_.row.col(points_ + i) = s_.normal_rows.row(i).transpose();
        for (int i = 0; i < s_.patches; ++i)
            r_.row.col(patches_ + i) = s_.tangent_rows.row(i).transpose();
        r_.response = r_.row;
        for (int i = held_ ? 0 : 3; i < count_; ++i)
            solve_base(r_.response.col(i));
        r_.mobility.resize(count_, count_);
        for (int i = 0; i < count_; ++i)
            for (int j = 0; j <= i; ++j)
                r_.mobility(i, j) = r_.mobility(j, i) = r_.row.col(i).dot(r_.response.col(j));
        r_.rate.resize(count_);
        for (int i = 0; i < count_; ++i)
            r_.rate[i] = r_.row.col(i).dot(r_.free);
        r_.stiffness.setZero(count_);
        r_.push.setZero(count_);
        r_.force.setZero(count_);
    }

    void grip_laws(const HandInput& hand, double left) {
        if (!held_)
            return;
        const Pose target = hand.target - left * hand.target_velocity;
        const Vec3 distance = target - grip_pose(data_.grip, data_.pose);
        r_.stiffness.head<3>() = dt_ * hand.stiffness + hand.damping;
        r_.push.head<3>() = hand.stiffness.cwiseProduct(distance) +
                            hand.damping.cwiseProduct(hand.target_velocity) + hand.force;
    }

    // force = push - stiffness * rate
    void set_spring(int i, double k, double push) {
        r_.stiffness[i] = k;
        r_.push[i] = push;
    }
    void set_point(int i) {
        const PointRow& p = point(i);
        const double k = dt_ * p.stiffness + damping_of(p);
        set_spring(points_ + i, k, k * p.drive - p.stiffness * p.gap);
    }
    void set_patch(int i) {
        const PatchRow& t = patch(i);
        const double k = dt_ * t.stiffness + t.damping;
        set_spring(patches_ + i, k, k * t.drive - t.stiffness * t.spring);
    }
    double spring_force(int i) const {
        return r_.push[i] - r_.stiffness[i] * (r_.rate[i] + dt_ * r_.mobility.row(i).dot(r_.force));
    }

    void spring_law(int i) {
        const double k = r_.stiffness[i];
        const double scale = 1.0 / (1.0 + dt_ * k * r_.mobility(i, i));
        r_.work.row(i) = (scale * dt_ * k) * r_.mobility.row(i);
        r_.work(i, i) += scale;
        r_.force[i] = scale * (r_.push[i] - k * r_.rate[i]);
    }

    // the force of a row is given by `value`
    void no_law(int i, double value) {
        r_.work.row(i).setZero();
        r_.work(i, i) = 1.0;
        r_.force[i] = value;
    }

    void solve_sets() {
        r_.work.resize(count_, count_);
        for (int i = 0; i < 3; ++i)
            held_ ? spring_law(i) : no_law(i, 0.0);
        for (int i = 0; i < s_.points; ++i) {
            set_point(i);
            point(i).active ? spring_law(points_ + i) : no_law(points_ + i, 0.0);
        }
        for (int i = 0; i < s_.patches; ++i) {
            const PatchRow& t = patch(i);
            set_patch(i);
            if (t.mode == FrictionMode::stick) {
                spring_law(patches_ + i);
                continue;
            }
            const double sign = t.mode == FrictionMode::off ? 0.0 : slip_sign(t.mode);
            no_law(patches_ + i, sign * t.bound);
            for (int k = 0; k < t.point_count; ++k)
                r_.work(patches_ + i, points_ + t.first_point + k) = -sign * t.dynamic_friction;
        }
        Eigen::PartialPivLU<Eigen::Ref<SolverRows>> factor(r_.work);
        const SolverVector right = r_.force;
        r_.force = factor.solve(right);
    }

    bool update_sets() {
        bool same = true;
        for (int i = 0; i < s_.points; ++i) {
            PointRow& p = point(i);
            p.force =
                p.active ? std::max(0.0, r_.force[points_ + i]) : std::max(0.0, spring_force(points_ + i));
            same = same && p.active == (p.force > 0.0);
            p.active = p.force > 0.0;
        }
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            if (!has_friction(t))
                continue;
            const double trial =
                t.mode == FrictionMode::stick ? r_.force[patches_ + i] : spring_force(patches_ + i);
            const double pressing = normal_sum(s_, t);
            const FrictionMode mode = next_mode(t, trial, pressing);
            same = same && mode == t.mode;
            t.mode = mode;
            t.force = friction_force(t, mode, trial, pressing);
        }
        return same;
    }

    void relax(int i, double low, double high) {
        const double scale = 1.0 / (1.0 + dt_ * r_.stiffness[i] * r_.mobility(i, i));
        r_.force[i] = std::clamp(r_.force[i] + scale * (spring_force(i) - r_.force[i]), low, high);
    }

    void gauss_seidel() {
        r_.force.setZero();
        for (int sweep = 0; sweep < k_sweeps; ++sweep) {
            for (int i = 0; held_ && i < 3; ++i)
                relax(i, -1e300, 1e300);
            for (int i = 0; i < s_.points; ++i) {
                relax(points_ + i, 0.0, 1e300);
                point(i).force = r_.force[points_ + i];
            }
            for (int i = 0; i < s_.patches; ++i) {
                if (!has_friction(patch(i)))
                    continue;
                const double bound = friction_bound(patch(i), normal_sum(s_, patch(i)));
                relax(patches_ + i, -bound, bound);
            }
        }
        for (int i = 0; i < s_.points; ++i)
            point(i).active = point(i).force > 0.0;
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            t.force = r_.force[patches_ + i];
            t.mode = settled_mode(t, normal_sum(s_, t));
        }
    }

    void apply() {
        s_.velocity = r_.free;
        for (int i = 0; i < count_; ++i)
            if (r_.force[i] != 0.0)
                s_.velocity += (dt_ * r_.force[i]) * r_.response.col(i);
    }

    const Model& model_;
    Data& data_;
    ContactSystem& s_;
    RowSystem& r_;
    double dt_;
    bool held_;
    int points_;
    int patches_;
    int count_;
};

} // namespace

bool solve_by_rows(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                   Integrator integrator) {
    RowSolver solver(model, data, hand, dt, left);
    if (integrator != Integrator::semi_implicit)
        return solver.linearly_implicit();
    solver.semi_implicit();
    return true;
}

} // namespace haptics::local
