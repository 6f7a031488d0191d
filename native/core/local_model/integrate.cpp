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
//
// Hits that the velocities at the start do not foresee. A sub-step t of a longer one h ends with the velocity
// v + a t and moves by t (v + a t), a = (v+ - v) / h, so a gap g with the rate r at the start and r+ at the
// end of h closes where g + r t + a t^2 = 0, a = (r+ - r) / h: t = 2 g / (sqrt(r^2 - 4 a g) - r).

#include <algorithm>
#include <cmath>

#include "contact_rules.hpp"
#include "dense_solver.hpp"
#include "explicit_step.hpp"
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

template <int N>
bool solve_primal(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                  Integrator integrator) {
    PrimalSolver<N> solver(model, data, hand, dt, left);
    return solver.run(integrator);
}

// A step with the forces of its start is (explicit_step.hpp).
bool is_stable(const Model& model, Data& data, double dt) {
    ContactSystem& s = data.system;
    const int n = s.freedoms;
    bool any = false;
    const auto add = [&](double weight, const auto& row) {
        if (!any)
            s.work.setZero(n, n);
        any = true;
        s.work.noalias() += (weight * row.transpose()).lazyProduct(row);
    };
    for (int i = 0; i < s.points; ++i) {
        const PointRow& p = s.point[static_cast<std::size_t>(i)];
        if (p.gap < 0.0)
            add(explicit_weight(p.stiffness, p.damping, dt), s.normal_rows.row(i));
    }
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (t.patch >= 0 && has_friction(t))
            add(explicit_weight(t.stiffness, t.damping, dt), s.tangent_rows.row(i));
    }
    if (!any)
        return true;
    if (model.tool.articulated)
        need_inverse(model, data);
    s.base.resize(n, n);
    s.base.noalias() = s.inverse_mass.topLeftCorner(n, n).lazyProduct(s.work);
    // false for what is not a number
    return s.base.trace() <= k_explicit_limit ||
           s.base.cwiseProduct(s.base.transpose()).sum() <= k_explicit_limit * k_explicit_limit;
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

// the motion of a sub-step with the end velocity in the system
Motion end_motion(const ContactSystem& s, double dt, double left) {
    return {dt, left, s.velocity, dt * s.velocity};
}

// Points that are apart and may collide, without their springs: those would slow a hit down within the
// sub-step that ends with it.
class AwaitedHits {
  public:
    explicit AwaitedHits(ContactSystem& s)
        : s_(s) {
        for (int i = 0; i < s.points; ++i) {
            PointRow& p = s.point[static_cast<std::size_t>(i)];
            if (p.gap <= 0.0 || !may_collide(s, p))
                continue;
            index_[static_cast<std::size_t>(count_)] = i;
            stiffness_[static_cast<std::size_t>(count_++)] = p.stiffness;
            p.stiffness = 0.0;
        }
    }
    void restore() {
        for (int k = 0; k < count_; ++k)
            point(k).stiffness = stiffness_[static_cast<std::size_t>(k)];
        count_ = 0;
    }
    // when the first of them closes fast within the solved sub-step, s; dt when none does
    [[nodiscard]] double first(const Model& model, const FreedomVector& start, double dt) {
        double earliest = dt;
        for (int k = 0; k < count_; ++k) {
            const int i = index_[static_cast<std::size_t>(k)];
            const PointRow& p = point(k);
            const double rate = row_rate(s_, i);
            if (p.gap + dt * rate > 0.0)
                continue;
            const double before = s_.normal_rows.row(i).dot(start) - p.drive;
            const double gain = (rate - before) / dt;
            const double root = std::sqrt(std::max(0.0, before * before - 4.0 * gain * p.gap));
            const double time = 2.0 * p.gap / (root - before);
            if (-(before + gain * time) > model.settings.collision_speed)
                earliest = std::min(earliest, time);
        }
        return earliest;
    }
    // one of them, too slow to hit, is met by its spring
    [[nodiscard]] bool any_meets(double dt) {
        for (int k = 0; k < count_; ++k)
            if (point(k).gap + dt * row_rate(s_, index_[static_cast<std::size_t>(k)]) <= 0.0)
                return true;
        return false;
    }

  private:
    PointRow& point(int k) { return s_.point[static_cast<std::size_t>(index_[static_cast<std::size_t>(k)])]; }

    ContactSystem& s_;
    int count_{0};
    std::array<int, k_max_points> index_;
    std::array<double, k_max_points> stiffness_;
};

// The motion of a sub-step as far as it is known before it is booked.
struct Solved {
    HandInput used;
    Motion motion;
    bool settled;
};

Solved solve(const Model& model, Data& data, const HandInput& hand, double dt, double left) {
    ContactSystem& s = data.system;
    Integrator integrator = model.settings.integrator;
    bool gives_way = false;
    if (integrator == Integrator::semi_implicit && !model.settings.strictly_semi_implicit) {
        gives_way = !is_stable(model, data, dt);
        if (gives_way)
            integrator = Integrator::linearly_implicit;
    }
    const FreedomVector start = s.velocity;
    HandInput used = at_share(hand);
    bool settled = solve_step(model, data, used, dt, left, integrator) && !gives_way;
    Motion motion = end_motion(s, dt, left);
    if (hand.held && hold_back(hand, coupling_force(data, hand, motion), used)) {
        s.velocity = start;
        settled = solve_step(model, data, used, dt, left, integrator) && settled;
        motion = end_motion(s, dt, left);
    }
    return {used, motion, settled};
}

void move_on(const Model& model, Data& data, const HandInput& hand, const Solved& solved, double dt,
             double share, StepOutput& output) {
    ContactSystem& s = data.system;
    const Motion& motion = solved.motion;
    if (hand.held) {
        const Wrench applied =
            book_coupling(data, hand, solved.used, motion, share, output) + solved.used.force;
        s.force_work += dt * applied.dot(s.grip * s.velocity.head(s.tool_freedoms));
    }
    output.fell_back = output.fell_back || !solved.settled;
    book(model, data, motion, share, output);
    const int n = s.tool_freedoms;
    s.force_work += dt * (s.tool_force - s.external.head(n) + s.tool_weight).dot(s.velocity.head(n));
    move_anchors(s, dt);
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].gap += dt * row_rate(s, i);
    move_bodies(model, data, motion.stretch, dt);
}

} // namespace

void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output) {
    load_velocities(model, data);
    move_on(model, data, hand, solve(model, data, hand, dt, left), dt, share, output);
}

double integrate_to_hit(const Model& model, Data& data, const HandInput& hand, double dt, double left,
                        double step, StepOutput& output) {
    ContactSystem& s = data.system;
    load_velocities(model, data);
    const FreedomVector start = s.velocity;
    AwaitedHits awaited(s);
    Solved solved = solve(model, data, hand, dt, left);
    const double time = awaited.first(model, start, dt);
    const bool meets = time >= dt && awaited.any_meets(dt);
    if (time < dt || meets) {
        s.velocity = start;
        if (meets)
            awaited.restore();
        solved = solve(model, data, hand, time, left + dt - time);
    }
    awaited.restore();
    move_on(model, data, hand, solved, time, time / step, output);
    return time;
}

void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output) {
    const FreedomVector start = data.system.velocity;
    solve_step(model, data, HandInput{}, dt, 0.0, Integrator::semi_implicit);
    data.system.velocity = start;
    book(model, data, end_motion(data.system, dt, 0.0), 1.0, output);
    move_anchors(data.system, dt);
}

} // namespace haptics::local
