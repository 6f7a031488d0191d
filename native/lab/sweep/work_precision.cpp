// Each method has a reference of its own: three refinements of it, of which the last is the truth. What the
// last two refinements changed is how far the truth can be trusted. An error is told from it only when it is
// ten times larger. A smaller one is only known to be below that, and is reported as that (the exact
// integrator is often closer to the truth than any reference); where even that could be felt, the row is not
// converged and takes no part in the choice.

#include <haptics/sweep/work_precision.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace haptics::sweep {

std::string_view name_of(Trust trust) {
    switch (trust) {
    case Trust::seen:
        return "seen";
    case Trust::upper_bound:
        return "upper_bound";
    case Trust::not_converged:
        return "not_converged";
    }
    return "";
}

std::vector<bool> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
    const std::size_t count = cost.size();
    std::vector<bool> front(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        if (!std::isfinite(cost[i]) || !std::isfinite(error[i]))
            continue;
        front[i] = true;
        for (std::size_t j = 0; j < count && front[i]; ++j) {
            const bool no_worse = cost[j] <= cost[i] && error[j] <= error[i];
            const bool better = cost[j] < cost[i] || error[j] < error[i] || j < i;
            if (j != i && no_worse && better)
                front[i] = false;
        }
    }
    return front;
}

int recommend(const std::vector<double>& cost, const std::vector<double>& error,
              const std::vector<bool>& front, double good_enough) {
    int cheapest = -1;
    int best = -1;
    for (std::size_t i = 0; i < cost.size(); ++i) {
        if (!front[i])
            continue;
        const int at = static_cast<int>(i);
        if (error[i] <= good_enough && (cheapest < 0 || cost[i] < cost[static_cast<std::size_t>(cheapest)]))
            cheapest = at;
        if (best < 0 || error[i] < error[static_cast<std::size_t>(best)])
            best = at;
    }
    return cheapest >= 0 ? cheapest : best;
}

namespace {

struct Reference {
    Track track;
    TrackError uncertainty;
};

TrackError larger(const TrackError& a, const TrackError& b) {
    return {std::max(a.position_rms, b.position_rms), std::max(a.position_max, b.position_max),
            std::max(a.force_rms, b.force_rms), std::max(a.energy_max, b.energy_max)};
}

Reference make_reference(ReferenceRuns runs, const TrackError& unrest) {
    Reference r;
    const TrackError first = compare(runs.refinement[0], runs.refinement[1]);
    const TrackError second = compare(runs.refinement[1], runs.refinement[2]);
    r.uncertainty = larger(larger(first, second), unrest);
    r.track = std::move(runs.refinement[2]);
    return r;
}

Trust trust(const TrackError& seen, const TrackError& doubt, double good_enough) {
    if (doubt.position_rms <= seen.position_rms && doubt.position_max <= seen.position_max)
        return Trust::seen;
    return doubt.position_rms <= good_enough ? Trust::upper_bound : Trust::not_converged;
}

WorkPrecisionRow judge_run(const Setting& setting, const Track& track, const Reference& reference,
                           double good_enough) {
    WorkPrecisionRow row;
    row.setting = setting;
    const TrackError& u = reference.uncertainty;
    const TrackError doubt{10.0 * u.position_rms, 10.0 * u.position_max, 10.0 * u.force_rms,
                           10.0 * u.energy_max};
    const TrackError seen = compare(track, reference.track);
    row.trust = trust(seen, doubt, good_enough);
    row.error = larger(seen, doubt);
    row.reference_difference = u.position_max;
    return row;
}

WorkPrecisionRow measure(const Experiment& experiment, const Setting& setting, const Reference& reference,
                         const SweepOptions& options) {
    WorkPrecisionRow row = judge_run(setting, follow(experiment, setting), reference, options.good_enough);
    std::unique_ptr<Run> run;
    const long steps = std::lround(experiment.seconds * setting.rate);
    row.step_ns =
        time_calls([&] { run = experiment.start(setting); }, [&] { run->step(); }, steps, options.repeats);
    row.second_us = row.step_ns.median * setting.rate * 1e-3;
    return row;
}

std::string describe(const WorkPrecisionRow& row) {
    char text[200];
    std::snprintf(text, sizeof text, "%s, %s at %.0f Hz", std::string(name_of(row.setting.scheme)).c_str(),
                  std::string(name_of(row.setting.method)).c_str(), row.setting.rate);
    return text;
}

std::string reason_for(const WorkPrecision& all, std::size_t chosen, double good_enough) {
    const WorkPrecisionRow& row = all.rows[chosen];
    char text[400];
    if (row.error.position_rms > good_enough) {
        std::snprintf(text, sizeof text,
                      "No setting stays within %.3g m (RMS); this one is the closest with %.3g m, for %.3g "
                      "us a second.",
                      good_enough, row.error.position_rms, row.second_us);
        return describe(row) + ". " + text;
    }
    std::snprintf(text, sizeof text, "The cheapest within %.3g m (RMS): %s%.3g m for %.3g us a second.",
                  good_enough, row.trust == Trust::upper_bound ? "at most " : "", row.error.position_rms,
                  row.second_us);
    std::string reason = describe(row) + ". " + text;
    // what the next better one on the front would cost
    const WorkPrecisionRow* next = nullptr;
    for (const WorkPrecisionRow& other : all.rows)
        if (other.front && other.setting.method == row.setting.method &&
            other.error.position_rms < row.error.position_rms &&
            (next == nullptr || other.second_us < next->second_us))
            next = &other;
    if (next == nullptr)
        return reason + " Nothing measured is more accurate.";
    std::snprintf(text, sizeof text, ") is %.3g times more accurate and costs %.3g times as much.",
                  row.error.position_rms / next->error.position_rms, next->second_us / row.second_us);
    return reason + " The next on the front (" + describe(*next) + text;
}

// each method has its own truth, so that only settings of one method can be compared
void mark_front(WorkPrecision& all, Method method, double good_enough) {
    std::vector<std::size_t> member;
    std::vector<double> cost;
    std::vector<double> error;
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
        const WorkPrecisionRow& row = all.rows[i];
        if (row.setting.method != method || row.trust == Trust::not_converged)
            continue;
        member.push_back(i);
        cost.push_back(row.second_us);
        error.push_back(row.error.position_rms);
    }
    if (member.empty()) {
        all.reasons.push_back({method, "None recommended: not converged. The refinements of the reference "
                                       "still differ by what could be felt."});
        return;
    }
    const std::vector<bool> front = pareto_front(cost, error);
    for (std::size_t i = 0; i < member.size(); ++i)
        all.rows[member[i]].front = front[i];
    const int chosen = recommend(cost, error, front, good_enough);
    if (chosen < 0) {
        all.reasons.push_back({method, "None recommended: no setting gave a finite motion."});
        return;
    }
    const std::size_t row = member[static_cast<std::size_t>(chosen)];
    all.rows[row].recommended = true;
    all.reasons.push_back({method, reason_for(all, row, good_enough)});
}

} // namespace

WorkPrecision sweep(const Experiment& experiment, const SweepOptions& options) {
    WorkPrecision all;
    const std::size_t total = experiment.methods.size() * experiment.schemes.size() * options.rates.size();
    std::size_t done = 0;
    for (const Method method : experiment.methods) {
        const Reference reference =
            make_reference({method,
                            {experiment.reference(method, 0), experiment.reference(method, 1),
                             experiment.reference(method, 2)}},
                           {});
        for (const Scheme scheme : experiment.schemes)
            for (const double rate : options.rates) {
                ++done;
                // the integrators of smooth motion know one method only
                if (scheme >= Scheme::adams_bashforth4 && method != experiment.methods.front())
                    continue;
                all.rows.push_back(measure(experiment, {scheme, method, rate}, reference, options));
                if (options.progress)
                    options.progress(static_cast<double>(done) / static_cast<double>(total));
            }
    }
    for (const Method method : experiment.methods)
        mark_front(all, method, options.good_enough);
    return all;
}

WorkPrecision assess(const std::vector<ReferenceRuns>& references, const std::vector<MeasuredRun>& runs,
                     const TrackError& unrest, double good_enough) {
    WorkPrecision all;
    for (const ReferenceRuns& known : references) {
        const Reference reference = make_reference(known, unrest);
        for (const MeasuredRun& run : runs) {
            if (run.setting.method != known.method)
                continue;
            WorkPrecisionRow row = judge_run(run.setting, run.track, reference, good_enough);
            row.step_ns = run.step_ns;
            row.second_us = row.step_ns.median * run.setting.rate * 1e-3;
            all.rows.push_back(row);
        }
        mark_front(all, known.method, good_enough);
    }
    return all;
}

} // namespace haptics::sweep
