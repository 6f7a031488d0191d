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

// the motion of a sub-step with the end velocity in the system
Motion end_motion(const ContactSystem& s, double dt, double left) {
    return {dt, left, s.velocity, dt * s.velocity};
}

} // namespace

void integrate(const Model& model, Data& data, const HandInput& hand, double dt, double left, double share,
               StepOutput& output) {
    ContactSystem& s = data.system;
    load_velocities(model, data);
    HandInput used = at_share(hand);
    const Integrator integrator = model.settings.integrator;
    const FreedomVector start = s.velocity;
    bool settled = solve_step(model, data, used, dt, left, integrator);
    Motion motion = end_motion(s, dt, left);
    if (hand.held) {
        if (hold_back(hand, coupling_force(data, hand, motion), used)) {
            s.velocity = start;
            settled = solve_step(model, data, used, dt, left, integrator) && settled;
            motion = end_motion(s, dt, left);
        }
        const Wrench applied = book_coupling(data, hand, used, motion, share, output) + used.force;
        s.force_work += dt * applied.dot(s.grip * s.velocity.head(s.tool_freedoms));
    }
    output.fell_back = output.fell_back || !settled;
    book(model, data, hand.held ? hand.force : Wrench(Wrench::Zero()), motion, share, output);
    const int n = s.tool_freedoms;
    s.force_work += dt * (s.tool_force - s.external.head(n) + s.tool_weight).dot(s.velocity.head(n));
    move_anchors(s, dt);
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].gap += dt * row_rate(s, i);
    move_bodies(model, data, motion.stretch, dt);
}

void explicit_forces(const Model& model, Data& data, double dt, StepOutput& output) {
    const FreedomVector start = data.system.velocity;
    solve_step(model, data, HandInput{}, dt, 0.0, Integrator::semi_implicit);
    data.system.velocity = start;
    book(model, data, Wrench::Zero(), end_motion(data.system, dt, 0.0), 1.0, output);
    move_anchors(data.system, dt);
}

} // namespace haptics::local
