// A haptic step with the exact integrator.
//
// The step is made of stretches. A stretch of a rigid tool ends where a point closes or opens, or where its
// rows would no longer do, and contacts are found again there (exact_rows.cpp). At most k_max_stretches are
// made; the last one goes to the end of the step with the rows that it has. Linkages keep the rows and the
// mass matrix of a place foreseen halfway (proxy.cpp); they stop for collisions alone.
//
// Collisions. A stretch stops where a point that may collide closes, at its true time, and the impulses
// follow.
//
// An overlap that the last step did not end with (geometry that came late, a tool put into a wall) holds
// energy that nobody gave; a lossless contact would throw the tool with it. Such a step, and what the exact
// integrator does not take on, is left to the linearly implicit one, and reported.

#include <algorithm>
#include <cmath>

#include "exact_rows.hpp"

namespace haptics::local {
namespace {

constexpr int k_max_stretches = 16;
constexpr int k_max_halvings = 5;
// what one step may take: products in the series, and searches for contacts
constexpr double k_products = 150'000.0;
constexpr int k_looks = 24;
// motion that turns no row, m or rad
constexpr double k_still = 1e-7;
// share of a step in which rows do not grow stale
constexpr double k_fresh = 1e-4;
// rim motion in which nothing new is met, m
constexpr double k_nothing_new = 1e-6;
// error of the contacts' energy that is accepted: share of all energy, and J
constexpr double k_unseen_share = 1e-5;
constexpr double k_share_change = 0.02;
constexpr double k_unseen = 1e-12;
// share of the energy of motion and contacts, which at the turn of a bounce is all in the contacts
constexpr double k_unearned_share = 1e-3;
constexpr double k_unearned = 1e-7;

// What is left of them.
struct Effort {
    double products{k_products};
    int looks{k_looks};
    // stretches longer than this have just failed, s
    double span{1e300};
};

bool turns(const ExactMotion& motion) {
    return (motion.pressed || motion.stopped) && motion.done > 0.0 &&
           motion.moved.cwiseAbs().maxCoeff() > k_still;
}

// something could have come into reach that no row watches
bool may_meet(const Data& data, const ExactMotion& motion) {
    double arm = 0.0;
    for (int i = 0; i < data.patches.count; ++i)
        arm = std::max(
            arm,
            (data.patches.patch[static_cast<std::size_t>(i)].point[0].position - data.pose.head<2>()).norm());
    double turn = 0.0;
    for (Eigen::Index k = 2; k < motion.moved.size(); k += 3)
        turn = std::max(turn, std::abs(motion.moved(k)));
    return 2.0 * arm * turn > k_nothing_new;
}

Motion mean_motion(const ExactMotion& motion, double left) {
    return {motion.done, left - 0.5 * motion.done, motion.moved / motion.done,
            motion.moved_time / motion.done, true};
}

// a run with the coupling that the hand can give; `used` is what it gave
void run(const Model& model, Data& data, const HandInput& hand, ExactTask task, Effort& effort,
         HandInput& used, ExactMotion& motion) {
    ContactSystem& s = data.system;
    used = at_share(hand);
    const ExactStart start(s);
    task.budget = effort.products;
    solve_exactly(model, data, used, task, motion);
    effort.products -= motion.spent;
    if (!hand.held || motion.done == 0.0 ||
        !hold_back(hand, coupling_force(data, hand, mean_motion(motion, task.left)), used))
        return;
    start.restore(s);
    task.budget = effort.products;
    solve_exactly(model, data, used, task, motion);
    effort.products -= motion.spent;
}

// of the first n freedoms
double kinetic_energy(const ContactSystem& s, int n) {
    return 0.5 * s.velocity.head(n).dot(s.mass.topLeftCorner(n, n) * s.velocity.head(n));
}

// in the contact springs
double elastic_energy(const StretchRows& rows) {
    double energy = 0.0;
    for (int i = 0; i < rows.points; ++i) {
        const PointRow& p = rows.point[static_cast<std::size_t>(i)];
        energy += p.gap < 0.0 ? 0.5 * p.stiffness * p.gap * p.gap : 0.0;
    }
    return energy;
}

// a stretch of a rigid tool: rows taken halfway, and as long as they do
void run_with_turning_rows(const Model& model, Data& data, const HandInput& hand, ExactTask task,
                           Effort& effort, HandInput& used, ExactMotion& motion) {
    ContactSystem& s = data.system;
    const StretchRows rows(s);
    const FreedomVector velocity = s.velocity;
    const double energy = kinetic_energy(s, s.freedoms) + elastic_energy(rows);
    const double whole = task.dt;
    task.dt = std::min(whole, effort.span);
    data.stretch = data.patches;
    for (int halving = 0;; ++halving) {
        run(model, data, hand, task, effort, used, motion);
        motion.stopped = motion.stopped || (task.dt < whole && motion.done == task.dt);
        if (motion.done == 0.0 || effort.looks <= 0)
            return;
        const bool last = task.stop == ExactStop::never || halving == k_max_halvings || effort.looks < 3;
        bool accepted = true;
        if (turns(motion)) {
            --effort.looks;
            s.velocity = velocity;
            accepted = turn_rows_halfway(model, data, rows, motion) <= k_share_change * energy + k_unseen;
            if (accepted || last) {
                ExactTask again = task;
                if (motion.stopped) // the same change, at nearly the same time
                    again.dt = std::min(task.dt, 1.25 * motion.done);
                run(model, data, hand, again, effort, used, motion);
                motion.stopped = motion.stopped || (again.dt < whole && motion.done == again.dt);
            }
        }
        if (last || motion.done == 0.0)
            return;
        if (accepted && may_meet(data, motion)) {
            --effort.looks;
            accepted = unseen_energy(model, data, motion) <= k_unseen_share * energy + k_unseen;
        }
        if (accepted) {
            effort.span = 2.0 * task.dt;
            return;
        }
        data.patches = data.stretch;
        rows.restore(s);
        s.velocity = velocity;
        task.dt = 0.5 * motion.done;
    }
}

void add_impulses(ContactSystem& s, double dt) {
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].impulse += dt * s.point[static_cast<std::size_t>(i)].force;
    for (int i = 0; i < s.patches; ++i)
        s.row[static_cast<std::size_t>(i)].tangent_impulse += dt * s.row[static_cast<std::size_t>(i)].force;
}

// One stretch: motion and books. How far it came is in `motion`.
void go_on(const Model& model, Data& data, const HandInput& hand, const ExactTask& task, double step,
           Effort& effort, ExactMotion& motion, StepOutput& output) {
    ContactSystem& s = data.system;
    load_velocities(model, data);
    HandInput used;
    if (model.tool.articulated)
        run(model, data, hand, task, effort, used, motion);
    else
        run_with_turning_rows(model, data, hand, task, effort, used, motion);
    if (motion.done == 0.0)
        return;
    const double share = motion.done / step;
    const Motion mean = mean_motion(motion, task.left);
    if (hand.held)
        book_coupling(data, hand, used, mean, share, output);
    book(model, data, mean, share, output);
    add_impulses(s, motion.done);
    if (model.tool.articulated) {
        // all work but that of Coriolis terms, for the energy budget
        need_mass(model, data);
        const int n = s.tool_freedoms;
        const FreedomVector end = s.velocity;
        s.force_work += kinetic_energy(s, n) - (s.external.head(n) - s.tool_weight).dot(motion.moved.head(n));
        load_velocities(model, data);
        s.force_work -= kinetic_energy(s, n);
        s.velocity = end;
    }
    move_bodies(model, data, motion.moved, motion.done);
}

// Nothing of the step is done: the leapfrog takes it with the place of its start (proxy.cpp).
void go_back(const Model& model, Data& data, double dt) {
    ContactSystem& s = data.system;
    if (s.ahead == 0.0)
        return;
    s.ahead = 0.0;
    data.linkage.position = s.start_position;
    place_tool(model, data);
    assemble(model, data, dt);
}

void give_way(const Model& model, Data& data, const HandInput& hand, double left, double step,
              StepOutput& output) {
    output.fell_back = true;
    output.exact_gave_way = true;
    integrate(model, data, hand, left, 0.0, left / step, output);
    add_impulses(data.system, left);
}

} // namespace

void step_exactly(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    ContactSystem& s = data.system;
    const bool rigid = !model.tool.articulated;
    const int most_hits = data.plan.runs(Stage::collisions) ? model.settings.max_events : 0;
    bool applies = StretchRows::fits(s);
    double earned = 0.0;
    const double unearned = applies ? unearned_energy(data, dt, earned) : 0.0;
    if (unearned > k_unearned) {
        need_mass(model, data);
        applies = unearned <= k_unearned + k_unearned_share * (kinetic_energy(s, s.freedoms) + earned);
    }
    Effort effort;
    double left = dt;
    int hits = 0;
    for (int stretch = 1; left > 0.0; ++stretch) {
        if (hits < most_hits && hits_now(model, data) && collide(model, data, output))
            ++hits;
        ExactTask task{left, left, ExactStop::never, k_fresh * dt, 0.0};
        if (stretch < k_max_stretches && effort.looks > 0) {
            if (rigid)
                task.stop = ExactStop::changes;
            else if (hits < most_hits)
                task.stop = ExactStop::hits;
        }
        ExactMotion motion;
        if (applies && StretchRows::fits(s))
            go_on(model, data, hand, task, dt, effort, motion, output);
        left = motion.done < left ? left - motion.done : 0.0;
        if (left > 0.0 && !motion.stopped) {
            if (left == dt && hits == 0)
                go_back(model, data, dt);
            give_way(model, data, hand, left, dt, output);
            break;
        }
        if (left > 0.0 && rigid) {
            --effort.looks;
            refresh_rows(model, data, left);
        }
    }
    // what is felt of a contact is the mean of the step
    for (int i = 0; i < s.points; ++i)
        s.point[static_cast<std::size_t>(i)].force = s.point[static_cast<std::size_t>(i)].impulse / dt;
    for (int i = 0; i < s.patches; ++i)
        s.row[static_cast<std::size_t>(i)].force = s.row[static_cast<std::size_t>(i)].tangent_impulse / dt;
}

} // namespace haptics::local
