#pragma once
// One (sub-)step solved for the end velocity, with N freedoms known at compile time or Eigen::Dynamic
// (derivation in integrate.cpp).

#include <haptics/core/local_model/local_model.hpp>

#include <type_traits>

#include "contact_rules.hpp"
#include "internal.hpp"
#include "rigid_grip.hpp"
#include "small_solve.hpp"

namespace haptics::local {

// Iterations of Newton's method on the sets, and sweeps of the fallback.
inline constexpr int k_max_iterations = 16;
inline constexpr int k_sweeps = 60;

template <int N>
class PrimalSolver {
    static constexpr bool k_fixed = N != Eigen::Dynamic;
    static constexpr int k_most = k_fixed ? N : k_max_island_freedoms;
    using Vector = Eigen::Matrix<double, N, 1, Eigen::ColMajor, k_most, 1>;
    using Square = std::conditional_t<k_fixed, Eigen::Matrix<double, N, N>, FreedomMatrix>;
    using Row = Eigen::Map<const Vector>;
    // large matrices stay in Data, small ones on the stack
    using Storage = std::conditional_t<k_fixed, Square, Square&>;

  public:
    PrimalSolver(const Model& model, Data& data, const HandInput& hand, double dt, double left)
        : model_(model)
        , data_(data)
        , s_(data.system)
        , dt_(dt)
        , n_(data.system.freedoms)
        , base_(storage<0>(data.system))
        , work_(storage<1>(data.system)) {
        make_base(hand, left);
    }

    // true when it settled
    bool run(Integrator integrator) {
        if (integrator != Integrator::semi_implicit)
            return linearly_implicit();
        semi_implicit();
        return true;
    }

    void semi_implicit() {
        for (int i = 0; i < s_.points; ++i) {
            PointRow& p = point(i);
            p.force = p.gap < 0.0 ? std::max(0.0, -p.stiffness * p.gap - p.damping * rate(i)) : 0.0;
            p.active = p.force > 0.0;
            if (p.active)
                right_ += dt_ * p.force * normal(i);
        }
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            t.force = 0.0;
            t.mode = FrictionMode::off;
            const double pressing = normal_sum(s_, t);
            if (!has_friction(t) || (pressing <= 0.0 && t.bound <= 0.0))
                continue;
            const double trial = -t.stiffness * t.spring - t.damping * slip_rate(i);
            t.mode = next_mode(t, trial, pressing);
            t.force = friction_force(t, t.mode, trial, pressing);
            right_ += dt_ * t.force * tangent(i);
        }
        work_ = base_;
        Vector v = right_;
        solve_symmetric(v);
        velocity() = v;
    }

    // true when the sets settled
    bool linearly_implicit() {
        guess_sets();
        for (int iteration = 0; iteration < k_max_iterations; ++iteration) {
            solve_sets();
            if (update_sets())
                return true;
        }
        gauss_seidel();
        return false;
    }

  private:
    template <int Which>
    static decltype(auto) storage(ContactSystem& system) {
        if constexpr (k_fixed)
            return Square(Square::Zero());
        else
            return (Which == 0 ? system.base : system.work);
    }

    PointRow& point(int i) { return s_.point[static_cast<std::size_t>(i)]; }
    PatchRow& patch(int i) { return s_.row[static_cast<std::size_t>(i)]; }
    // rows lie one after the other
    Row normal(int i) const { return Row(s_.normal_rows.data() + static_cast<std::ptrdiff_t>(i) * n_, n_); }
    Row tangent(int i) const { return Row(s_.tangent_rows.data() + static_cast<std::ptrdiff_t>(i) * n_, n_); }
    Eigen::Map<Vector> velocity() { return Eigen::Map<Vector>(s_.velocity.data(), n_); }
    double rate(int i) { return normal(i).dot(velocity()) - point(i).drive; }
    double slip_rate(int i) { return tangent(i).dot(velocity()) - patch(i).drive; }

    // momentum, external forces, joint springs and the coupling
    void make_base(const HandInput& hand, double left) {
        if constexpr (!k_fixed) {
            base_.resize(n_, n_);
            right_.resize(n_);
        }
        base_ = s_.mass;
        right_.noalias() = base_ * velocity();
        right_ += dt_ * Row(s_.external.data(), n_);
        if (s_.has_joint_springs)
            for (int i = 0; i < s_.tool_freedoms; ++i) {
                const Vec3 spring = joint_spring(model_, data_, i);
                base_(i, i) += dt_ * (dt_ * spring.y() + spring.z());
                right_(i) -= dt_ * spring.y() * spring.x();
            }
        if (!hand.held)
            return;
        if constexpr (N == 3) {
            if (!model_.tool.articulated) {
                const Vec2 r(s_.grip(1, 2), -s_.grip(0, 2));
                const Pose target = hand.target - left * hand.target_velocity;
                const RigidCoupling coupling({r.x(), r.y(), data_.grip.pose},
                                             plain(grip_pose(data_.grip, data_.pose)), target, hand, dt_);
                Arrow arrow{base_(0, 0), base_(1, 1), base_(2, 2)};
                Plain3 right = plain(right_);
                coupling.add({1.0, plain(hand.force)}, arrow, right);
                right_ = right.vector();
                base_.diagonal() = Vec3(arrow.a, arrow.b, arrow.c);
                base_(2, 0) = base_(0, 2) = arrow.p;
                base_(2, 1) = base_(1, 2) = arrow.q;
                return;
            }
        }
        const Pose target = hand.target - left * hand.target_velocity;
        const Vec3 distance = target - grip_pose(data_.grip, data_.pose);
        const Vec3 k = dt_ * (dt_ * hand.stiffness + hand.damping);
        const Vec3 push = dt_ * (hand.stiffness.cwiseProduct(distance) +
                                 hand.damping.cwiseProduct(hand.target_velocity) + hand.force);
        if constexpr (k_fixed && N <= 3) {
            // a system this small is the tool alone
            const Eigen::Map<const Eigen::Matrix<double, 3, N>> j(s_.grip.data());
            base_.noalias() += j.transpose() * k.asDiagonal() * j;
            right_.noalias() += j.transpose() * push;
        } else {
            const int n = s_.tool_freedoms;
            s_.weighted_grip = k.asDiagonal() * s_.grip;
            base_.topLeftCorner(n, n).noalias() += s_.grip.transpose().lazyProduct(s_.weighted_grip);
            right_.head(n).noalias() += s_.grip.transpose().lazyProduct(push);
        }
    }

    // x = work^-1 x for a positive definite matrix, which is overwritten
    void solve_symmetric(Vector& x) {
        if constexpr (k_fixed) {
            solve_definite(work_, x);
        } else {
            Eigen::LLT<Eigen::Ref<Square>> factor(work_);
            factor.solveInPlace(x);
        }
    }

    void solve_general(Vector& x) {
        if constexpr (k_fixed) {
            solve_pivoted(work_, x);
        } else {
            Eigen::PartialPivLU<Eigen::Ref<Square>> factor(work_);
            const Vector right = x;
            x = factor.solve(right);
        }
    }

    // the base is not needed any more once sweeps begin
    void invert_base() {
        if constexpr (k_fixed) {
            Square inverse;
            for (int i = 0; i < N; ++i) {
                work_ = base_;
                Vector column = Vector::Unit(i);
                solve_definite(work_, column);
                inverse.col(i) = column;
            }
            base_ = inverse;
        } else {
            work_ = base_;
            base_.setIdentity(n_, n_);
            Eigen::LLT<Eigen::Ref<Square>> factor(work_);
            factor.solveInPlace(base_);
        }
    }

    // first guess: what presses now keeps pressing, what stuck keeps sticking
    void guess_sets() {
        for (int i = 0; i < s_.points; ++i)
            point(i).active = point(i).gap < 0.0;
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            t.force = 0.0;
            t.mode = has_friction(t) ? FrictionMode::stick : FrictionMode::off;
        }
    }

    void solve_sets() {
        work_ = base_;
        Vector v = right_;
        bool symmetric = true;
        for (int i = 0; i < s_.points; ++i) {
            const PointRow& p = point(i);
            if (!p.active)
                continue;
            const double k = dt_ * (dt_ * p.stiffness + damping_of(p));
            const double push = k * p.drive - dt_ * p.stiffness * p.gap;
            const Row row = normal(i);
            const PatchRow& t = patch(p.patch);
            if (slips(t.mode) && t.dynamic_friction > 0.0) {
                const Vector along = row + slip_sign(t.mode) * t.dynamic_friction * tangent(p.patch);
                work_.noalias() += (k * along).lazyProduct(row.transpose());
                v += push * along;
                symmetric = false;
            } else {
                work_.noalias() += (k * row).lazyProduct(row.transpose());
                v += push * row;
            }
        }
        for (int i = 0; i < s_.patches; ++i) {
            const PatchRow& t = patch(i);
            if (t.mode == FrictionMode::stick) {
                const double k = dt_ * (dt_ * t.stiffness + t.damping);
                const Row row = tangent(i);
                work_.noalias() += (k * row).lazyProduct(row.transpose());
                v += (k * t.drive - dt_ * t.stiffness * t.spring) * row;
            } else if (slips(t.mode) && t.bound > 0.0) {
                v += dt_ * slip_sign(t.mode) * t.bound * tangent(i);
            }
        }
        if (symmetric)
            solve_symmetric(v);
        else
            solve_general(v);
        velocity() = v;
    }

    // takes over the pressing set and the friction modes that follow from the last solve; true when nothing
    // changed
    bool update_sets() {
        bool same = true;
        for (int i = 0; i < s_.points; ++i) {
            PointRow& p = point(i);
            p.force = std::max(0.0, -p.stiffness * p.gap - (dt_ * p.stiffness + damping_of(p)) * rate(i));
            same = same && p.active == (p.force > 0.0);
            p.active = p.force > 0.0;
        }
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            if (!has_friction(t))
                continue;
            const double trial = -t.stiffness * t.spring - (dt_ * t.stiffness + t.damping) * slip_rate(i);
            const double pressing = normal_sum(s_, t);
            const FrictionMode mode = next_mode(t, trial, pressing);
            same = same && mode == t.mode;
            t.mode = mode;
            t.force = friction_force(t, mode, trial, pressing);
        }
        return same;
    }

    // fixed number of sweeps over all rows: bounded, deterministic, forces within their bounds after every
    // sweep
    void gauss_seidel() {
        invert_base();
        velocity().noalias() = base_ * right_;
        for (int i = 0; i < s_.points; ++i)
            point(i).force = 0.0;
        for (int i = 0; i < s_.patches; ++i)
            patch(i).force = 0.0;
        for (int sweep = 0; sweep < k_sweeps; ++sweep) {
            for (int i = 0; i < s_.points; ++i) {
                PointRow& p = point(i);
                const double k = dt_ * p.stiffness + damping_of(p);
                p.force = relax(normal(i), k, -p.stiffness * p.gap - k * rate(i), p.force, 0.0, 1e300);
            }
            for (int i = 0; i < s_.patches; ++i) {
                PatchRow& t = patch(i);
                if (!has_friction(t))
                    continue;
                const double k = dt_ * t.stiffness + t.damping;
                const double bound = friction_bound(t, normal_sum(s_, t));
                t.force =
                    relax(tangent(i), k, -t.stiffness * t.spring - k * slip_rate(i), t.force, -bound, bound);
            }
        }
        for (int i = 0; i < s_.points; ++i)
            point(i).active = point(i).force > 0.0;
        for (int i = 0; i < s_.patches; ++i) {
            PatchRow& t = patch(i);
            t.mode = settled_mode(t, normal_sum(s_, t));
        }
    }

    // one row moved to where its own equation holds, within its bounds
    double relax(const Row& row, double k, double wanted, double force, double low, double high) {
        const Vector response = base_ * row;
        const double softness = 1.0 / std::max(k, 1e-300);
        const double compliance = softness + dt_ * row.dot(response);
        const double next = std::clamp(force + (wanted - force) * softness / compliance, low, high);
        velocity() += dt_ * (next - force) * response;
        return next;
    }

    const Model& model_;
    Data& data_;
    ContactSystem& s_;
    double dt_;
    int n_;
    Storage base_;
    Storage work_;
    Vector right_;
};

} // namespace haptics::local
