// Continuous contact solved exactly over a (sub-)step.
//
// The contact law is that of integrate.cpp, in continuous time. Rows J, masses and external forces keep their
// values over the run. A point presses with f = -K g - B g' as long as that is positive, and has
// no force otherwise; it begins to press when g <= 0 and -K g - B g' > 0. A patch that sticks has the
// friction f_t = -K s - B s', s' = T v - w, as long as |f_t| <= mu_s N + b, N = sum f. One that slides has
// f_t = sigma (mu_d N + b). Its spring follows, s = -f_t / K, so that its anchor moves with
//     a' = (T v - w) - s' = (T v - w) + sigma mu_d N' / K,
// against the friction as long as sigma a' < 0. When that ends, or with the damper when -sigma B (T v - w)
// falls within the margin (mu_s - mu_d) N, whichever is later, the patch sticks again. With N at rest this is
// the moment when the sliding speed reaches zero. Both step integrators approach this law as the step goes to
// zero.
//
// So the motion is linear (flow.cpp) until the first of these conditions ends (series.cpp):
//     pressing    f > 0
//     apart       g > 0  or  K g + B g' >= 0
//     sticking    mu_s N + b - f_t > 0  and  mu_s N + b + f_t > 0
//     sliding     -sigma (T v - w) - mu_d N' / K > 0  or  -sigma B (T v - w) - (mu_s - mu_d) N > 0
// There the mode changes and the next stretch begins. Impulses, and with them the mean forces, are integrals
// of the same series, so momentum, forces and motion agree to rounding.
//
// Work is bounded. A stretch that would take more intervals than the budget allows is given k_patience
// intervals to end by an event, which is several periods of its fastest mode: a bounce needs half a period,
// however stiff. What lasts longer, too many events, freedoms or contacts, or a value that is not finite, end
// the run early; the caller goes on with the linearly implicit step.

#include "exact.hpp"

#include <algorithm>
#include <cmath>

#include "exact_run.hpp"

namespace haptics::local {
namespace {

constexpr int k_max_changes = 256;
constexpr int k_patience = 16;
// share of its scale within which a condition that has just changed counts as zero
constexpr double k_boundary = 1e-6;

} // namespace

bool ExactRun::affordable(double left, double budget, int since_change) const {
    const double spans = left / longest_span(flow_);
    if (!(spans < 1e15)) // also when it is not a number
        return false;
    const double interval = 2.0 * k_max_terms * flow_.rows * flow_.freedoms;
    return spent_ < budget && (since_change < k_patience || spent_ + spans * interval < budget);
}

void ExactRun::look(Condition& condition, ChangeKind kind, int index, double sign, Change& first) const {
    if (first.at == 0.0)
        return;
    // what has just changed starts at its boundary; the rounding there must not decide
    const bool of_point = kind == ChangeKind::open || kind == ChangeKind::close;
    if (fresh_[static_cast<std::size_t>(of_point ? index : row_of_patch(index))])
        for (std::size_t k = 0; k < static_cast<std::size_t>(condition.count); ++k)
            if (std::abs(condition.series[k][0]) < k_boundary * condition.scale[k])
                condition.series[k][0] = 0.0;
    const FirstEnd end = first_end(condition, first.at);
    // a search that ran out of its bound without an end only shortens the interval
    if (end.ends || end.at < first.at)
        first = {end.ends ? kind : ChangeKind::none, index, sign, end.at};
}

void ExactRun::look_at_point(int i, Change& first) {
    const PointRow& p = point(i);
    Condition c;
    if (p.stiffness == 0.0 && p.damping == 0.0) {
        if (met_[static_cast<std::size_t>(i)] || !p.was_apart ||
            model_.settings.contact_mode == ContactMode::penalty)
            return;
        // only its hit is awaited
        c.terms = flow_.terms - 1;
        for (std::size_t j = 0; j < static_cast<std::size_t>(c.terms); ++j) {
            c.series[0][j] = flow_.shift[static_cast<std::size_t>(i)][j];
            c.scale[0] += std::abs(c.series[0][j]);
        }
        look(c, ChangeKind::close, i, 0.0, first);
        return;
    }
    c.terms = flow_.terms - 1;
    c.scale[0] = force_series(flow_, i, c.series[0]);
    if (p.active) {
        look(c, ChangeKind::open, i, 0.0, first);
        return;
    }
    c.count = 2;
    c.series[1] = c.series[0];
    c.scale[1] = c.scale[0];
    c.scale[0] = 0.0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(c.terms); ++j) {
        c.series[1][j] = -c.series[1][j];
        c.series[0][j] = flow_.shift[static_cast<std::size_t>(i)][j];
        c.scale[0] += std::abs(c.series[0][j]);
    }
    look(c, ChangeKind::close, i, 0.0, first);
}

void ExactRun::look_at_patch(int i, Change& first) {
    const PatchRow& t = patch(i);
    if (t.mode == FrictionMode::off)
        return;
    Series normal;
    double normal_scale = 0.0;
    normal_series(i, normal, normal_scale);
    Condition c;
    const auto terms = static_cast<std::size_t>(flow_.terms - 1);
    c.terms = flow_.terms - 1;
    if (t.mode == FrictionMode::stick) {
        Series trial;
        const double trial_scale = force_series(flow_, row_of_patch(i), trial);
        for (const double sign : {1.0, -1.0}) {
            for (std::size_t j = 0; j < terms; ++j)
                c.series[0][j] = t.static_friction * normal[j] - sign * trial[j];
            c.series[0][0] += t.bound;
            c.scale[0] = t.static_friction * normal_scale + trial_scale + t.bound;
            look(c, ChangeKind::slip, i, sign, first);
        }
        return;
    }
    const double sign = slip_sign(t.mode);
    const double compliance = t.stiffness > 0.0 ? t.dynamic_friction / t.stiffness : 0.0;
    const Series& shift = flow_.shift[static_cast<std::size_t>(row_of_patch(i))];
    c.count = 2;
    c.terms = flow_.terms - 2;
    for (std::size_t j = 0; j + 1 < terms; ++j) {
        const double power = static_cast<double>(j + 1) / flow_.span;
        const double speed = power * shift[j + 1];
        const double change = compliance * power * normal[j + 1];
        const double margin = (t.static_friction - t.dynamic_friction) * normal[j];
        c.series[0][j] = -sign * speed - change;
        c.series[1][j] = -sign * t.damping * speed - margin;
        c.scale[0] += std::abs(speed) + std::abs(change);
        c.scale[1] += std::abs(t.damping * speed) + std::abs(margin);
    }
    look(c, ChangeKind::stick, i, 0.0, first);
}

Change ExactRun::first_change() {
    Change first;
    for (int i = 0; i < s_.points; ++i)
        look_at_point(i, first);
    for (int i = 0; i < s_.patches; ++i)
        look_at_patch(i, first);
    return first;
}

void ExactRun::apply(const Change& change) {
    if (change.kind == ChangeKind::slip || change.kind == ChangeKind::stick)
        fresh_[static_cast<std::size_t>(row_of_patch(change.index))] = true;
    switch (change.kind) {
    case ChangeKind::none:
        return;
    case ChangeKind::open:
    case ChangeKind::close: {
        PointRow& p = point(change.index);
        if (p.stiffness == 0.0 && p.damping == 0.0) {
            met_[static_cast<std::size_t>(change.index)] = true;
            return;
        }
        p.active = change.kind == ChangeKind::close;
        PatchRow& t = patch(p.patch);
        fresh_[static_cast<std::size_t>(change.index)] = true;
        if (t.static_friction <= 0.0)
            return;
        if (!pressed(p.patch) && t.bound <= 0.0) {
            t.mode = FrictionMode::off;
            row(row_of_patch(p.patch)).displacement = 0.0;
        } else if (t.mode == FrictionMode::off) {
            t.mode = FrictionMode::stick;
            row(row_of_patch(p.patch)).displacement = 0.0;
        }
        return;
    }
    case ChangeKind::slip:
        patch(change.index).mode =
            change.sign > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
        return;
    case ChangeKind::stick: {
        PatchRow& t = patch(change.index);
        const double force = slip_sign(t.mode) * (t.dynamic_friction * normal_now(change.index) + t.bound);
        row(row_of_patch(change.index)).displacement = t.stiffness > 0.0 ? -force / t.stiffness : 0.0;
        t.mode = FrictionMode::stick;
        return;
    }
    }
}

// whether the caller wants to look again after this change
bool ExactRun::stops(const Change& change, const ExactTask& task, double done) const {
    if (change.kind != ChangeKind::close && change.kind != ChangeKind::open)
        return false;
    if (task.stop == ExactStop::never)
        return false;
    if (task.stop == ExactStop::changes && done > task.too_early)
        return true;
    // a hit, however soon
    if (change.kind == ChangeKind::open || model_.settings.contact_mode == ContactMode::penalty)
        return false;
    const FlowRow& r = row(change.index);
    return may_collide(s_, point(change.index)) &&
           r.drive - flow_dot(r.row, flow_.velocity, flow_.freedoms) > model_.settings.collision_speed;
}

void ExactRun::run(const HandInput& hand, const ExactTask& task, ExactMotion& motion) {
    motion.done = 0.0;
    motion.stopped = false;
    motion.pressed = false;
    motion.spent = 0.0;
    if (s_.freedoms > k_flow_freedoms || s_.points > k_max_exact_points || s_.patches > k_max_exact_patches)
        return;
    setup(hand, task.left);
    FlowVector moved;
    FlowVector moved_time;
    moved.fill(0.0);
    moved_time.fill(0.0);
    const int at_once = 2 * (s_.points + s_.patches) + 8;
    int changes = 0;
    int without_time = 0;
    int since_change = 0;
    double left = task.dt;
    choose_springs();
    while (left > 0.0 && !motion.stopped && affordable(left, task.budget, since_change)) {
        expand(flow_, std::min(left, longest_span(flow_)));
        spent_ += 2.0 * flow_.terms * flow_.rows * flow_.freedoms;
        const Change change = first_change();
        if (change.at > 0.0) {
            if (change.at < 1.0)
                shorten(flow_, change.at);
            if (!advance(flow_, moved, moved_time))
                break;
            book_interval();
            left = flow_.span < left ? left - flow_.span : 0.0;
            without_time = 0;
            fresh_.fill(false);
            ++since_change;
        }
        if (change.kind == ChangeKind::none)
            continue;
        motion.stopped = left > 0.0 && stops(change, task, task.dt - left);
        apply(change);
        choose_springs();
        since_change = 0;
        if (++changes > k_max_changes || ++without_time > at_once)
            break;
    }
    motion.done = left > 0.0 ? task.dt - left : task.dt;
    motion.pressed = pressed_;
    motion.spent = spent_;
    motion.moved.resize(s_.freedoms);
    motion.moved_time.resize(s_.freedoms);
    for (int k = 0; k < s_.freedoms; ++k) {
        motion.moved(k) = moved[static_cast<std::size_t>(k)];
        motion.moved_time(k) = moved_time[static_cast<std::size_t>(k)];
    }
    if (motion.done > 0.0)
        write_back(motion.done);
}

void solve_exactly(const Model& model, Data& data, const HandInput& hand, const ExactTask& task,
                   ExactMotion& motion) {
    ExactRun run(model, data);
    run.run(hand, task, motion);
}

} // namespace haptics::local
