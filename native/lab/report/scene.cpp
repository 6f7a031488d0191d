// A scene of the user's, which Godot has run in lock-step again and again. Its motion depends on what Godot
// does with the impulses that the tool gives to movable bodies, so that it cannot be stepped here; the tracks
// are compared as those of the other experiments are.
//
// The loop as the scene has it is judged by what it does: unstable when the output gate faulted or the grip
// shakes by more than 0.5 mm, chattering from 50 um or a millijoule on that the controller made. Shaking is
// the RMS distance of a sample from the middle of its neighbors, 4 ms before and after: a motion of 1 m/s^2
// has 8 um.

#include <haptics/sweep/stability.hpp>
#include <haptics/sweep/work_precision.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "csv.hpp"
#include "tables.hpp"

namespace haptics::report {

using sweep::Method;
using sweep::Scheme;

namespace {

constexpr double k_shakes = 5e-5;
constexpr double k_shakes_off = 5e-4;
constexpr double k_energy_made = 1e-3;
// RMS error of the position that nobody feels, m; the encoder step of experiment 1
constexpr double k_unfelt = 1e-5;

Scheme scheme_of(const std::string& name) {
    for (const Scheme scheme : {Scheme::semi_implicit, Scheme::linearly_implicit})
        if (sweep::name_of(scheme) == name)
            return scheme;
    return Scheme::exact;
}

Method method_of(const std::string& name) {
    for (const Method method : {Method::penalty, Method::impulse})
        if (sweep::name_of(method) == name)
            return method;
    return Method::paper;
}

Integrator integrator_named(const std::string& name) {
    for (const Integrator i : {Integrator::semi_implicit, Integrator::linearly_implicit})
        if (name_of(i) == name)
            return i;
    return Integrator::exact;
}

sweep::Track read_track(const std::filesystem::path& file) {
    const CsvRows rows(file);
    sweep::Track track;
    Vec2 impulse = Vec2::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        impulse += sweep::k_sample_time * Vec2(rows.number(i, "force_x_n"), rows.number(i, "force_y_n"));
        track.push_back(
            {Vec2(rows.number(i, "x_m"), rows.number(i, "y_m")), rows.number(i, "energy_j"), impulse});
    }
    return track;
}

double shaking(const sweep::Track& track) {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < track.size(); ++i)
        sum += (track[i].position - 0.5 * (track[i - 1].position + track[i + 1].position)).squaredNorm();
    return track.size() < 3 ? 0.0 : std::sqrt(sum / static_cast<double>(track.size() - 2));
}

class SceneRuns {
  public:
    explicit SceneRuns(const Options& options)
        : folder_(options.folder)
        , runs_(options.folder / "scene_runs.csv") {
        if (runs_.size() == 0)
            throw std::runtime_error("no runs of a scene in " + folder_.string());
    }
    [[nodiscard]] const CsvRows& rows() const { return runs_; }
    /// Indices of the runs of that role.
    [[nodiscard]] std::vector<std::size_t> of(const char* role) const {
        std::vector<std::size_t> found;
        for (std::size_t i = 0; i < runs_.size(); ++i)
            if (runs_.text(i, "role") == role)
                found.push_back(i);
        return found;
    }
    /// Empty for a run that did not come to its end.
    [[nodiscard]] sweep::Track track(std::size_t run) const {
        const std::string& file = runs_.text(run, "file");
        return file.empty() ? sweep::Track{} : read_track(folder_ / file);
    }
    [[nodiscard]] bool touched() const {
        for (std::size_t i = 0; i < runs_.size(); ++i)
            if (runs_.number(i, "touching_ticks") > 0.0)
                return true;
        return false;
    }

  private:
    std::filesystem::path folder_;
    CsvRows runs_;
};

// how far equal runs are apart: a scene that looks at the clock or draws lots does not repeat
sweep::TrackError unrest_of(const SceneRuns& scene) {
    const std::vector<std::size_t> same = scene.of("as_it_is");
    return same.size() < 2 ? sweep::TrackError{} : compare(scene.track(same[1]), scene.track(same[0]));
}

void write_scene_error(const Options& options, const SceneRuns& scene) {
    using Key = std::tuple<Method, Scheme, double>;
    std::map<Key, std::vector<double>> times;
    std::map<Key, std::size_t> first;
    const CsvRows& rows = scene.rows();
    for (const std::size_t i : scene.of("setting")) {
        const Key key{method_of(rows.text(i, "method")), scheme_of(rows.text(i, "integrator")),
                      rows.number(i, "rate_hz")};
        first.emplace(key, i);
        if (!rows.text(i, "file").empty())
            times[key].push_back(rows.number(i, "step_ns"));
    }
    std::map<Method, std::map<double, std::size_t>> truth;
    for (const std::size_t i : scene.of("reference"))
        truth[method_of(rows.text(i, "method"))][rows.number(i, "rate_hz")] = i;
    std::vector<sweep::ReferenceRuns> references;
    for (const auto& [method, by_rate] : truth) {
        sweep::ReferenceRuns runs{method, {}};
        std::size_t place = 0;
        for (const auto& [rate, i] : by_rate)
            if (place < runs.refinement.size())
                runs.refinement[place++] = scene.track(i);
        references.push_back(std::move(runs));
    }
    std::vector<sweep::MeasuredRun> runs;
    for (const auto& [key, i] : first) {
        const auto& [method, scheme, rate] = key;
        const std::vector<double>& all = times[key];
        runs.push_back(
            {{scheme, method, rate}, scene.track(i), all.empty() ? sweep::Spread{} : sweep::spread_of(all)});
    }
    const sweep::TrackError unrest = unrest_of(scene);
    const sweep::WorkPrecision result = sweep::assess(references, runs, unrest, k_unfelt);
    const char* motion = scene.touched() ? "contact" : "smooth";
    CsvFile csv(options.folder / "scene_error.csv",
                {"experiment", "motion", "method", "integrator", "rate_hz", "position_rms_m",
                 "position_max_m", "force_rms_n", "energy_max_j", "reference_difference_m", "error_is",
                 "ns_per_step", "ns_per_step_low", "ns_per_step_high", "us_per_simulated_s", "front",
                 "recommended"});
    for (const sweep::WorkPrecisionRow& r : result.rows)
        csv.row({"scene", motion, name_of(r.setting.method), name_of(r.setting.scheme), r.setting.rate,
                 r.error.position_rms, r.error.position_max, r.error.force_rms, r.error.energy_max,
                 r.reference_difference, name_of(r.trust), r.step_ns.median, r.step_ns.low, r.step_ns.high,
                 r.second_us, r.front, r.recommended});
    csv.finish();
    CsvFile recommended(options.folder / "scene_recommended.csv",
                        {"experiment", "motion", "method", "reason", "repeats_within_m"});
    for (const sweep::WorkPrecision::Reason& r : result.reasons)
        recommended.row({"scene", motion, name_of(r.method), r.text, unrest.position_max});
    recommended.finish();
}

void write_loops(const Options& options, const SceneRuns& scene) {
    CsvFile csv(options.folder / "scene_loop.csv",
                {"integrator", "rate_hz", "walls_stiffer", "verdict", "shaking_m", "energy_created_j",
                 "largest_force_n", "deepest_m", "fault"});
    const CsvRows& rows = scene.rows();
    for (const std::size_t i : scene.of("loop")) {
        const double shake = shaking(scene.track(i));
        const double energy = rows.number(i, "energy_created_j");
        std::string fault = rows.text(i, "faults");
        if (fault.empty())
            fault = rows.text(i, "why_not");
        sweep::Verdict verdict = sweep::Verdict::stable;
        if (!fault.empty() || !(shake < k_shakes_off))
            verdict = sweep::Verdict::unstable;
        else if (!(shake < k_shakes && energy < k_energy_made))
            verdict = sweep::Verdict::chattering;
        csv.row({rows.text(i, "integrator"), rows.number(i, "rate_hz"), rows.number(i, "stiffer"),
                 sweep::name_of(verdict), shake, energy, rows.number(i, "largest_force_n"),
                 rows.number(i, "deepest_m"), fault});
    }
    csv.finish();
}

void write_walls(const Options& options) {
    const CsvRows walls(options.folder / "scene_walls.csv");
    CsvFile csv(options.folder / "scene_stability.csv",
                {"wall", "stiffness_n_per_m", "damping_n_s_per_m", "mass_kg", "integrator", "rate_hz",
                 "growth", "residual", "bounce", "verdict", "semi_implicit_floor_kg"});
    for (std::size_t i = 0; i < walls.size(); ++i)
        for (const char* integrator : {"semi_implicit", "linearly_implicit", "exact"})
            for (const double rate : {250.0, 500.0, 1000.0, 2000.0, 4000.0, 10000.0}) {
                const sweep::StabilityPoint point{
                    integrator_named(integrator), walls.number(i, "stiffness_n_per_m"),
                    walls.number(i, "damping_n_s_per_m"), rate, walls.number(i, "tool_mass_kg")};
                const bool is_spring = point.stiffness > 0.0;
                const sweep::StabilityFigures f = is_spring ? sweep::judge(point) : sweep::StabilityFigures{};
                csv.row({walls.text(i, "wall"), point.stiffness, point.damping, point.mass, integrator, rate,
                         f.growth, f.residual, f.bounce,
                         is_spring ? sweep::name_of(f.verdict) : std::string_view("no spring"),
                         sweep::semi_implicit_floor(point.stiffness, point.damping, 1.0 / rate)});
            }
    csv.finish();
}

void write_scene_plan(const Options& options, const SceneRuns& scene) {
    const CsvRows& rows = scene.rows();
    struct Side {
        std::vector<double> times;
        double bodies{0.0};
        double left_out{0.0};
        sweep::Track track;
    };
    const auto side = [&](const char* role) {
        Side s;
        for (const std::size_t i : scene.of(role)) {
            if (rows.text(i, "file").empty())
                continue;
            s.times.push_back(rows.number(i, "step_ns"));
            s.bodies = std::max(s.bodies, rows.number(i, "bodies"));
            s.left_out = std::max(s.left_out, rows.number(i, "left_out_bodies"));
            if (s.track.empty())
                s.track = scene.track(i);
        }
        return s;
    };
    const Side planned = side("planned");
    const Side everything = side("everything");
    CsvFile csv(options.folder / "scene_plan.csv",
                {"bodies", "bodies_sent", "bodies_without_place", "ns_per_step_planned", "ns_planned_low",
                 "ns_planned_high", "ns_per_step_everything", "ns_everything_low", "ns_everything_high",
                 "times_cheaper", "largest_difference_m"});
    if (!planned.times.empty() && !everything.times.empty()) {
        const sweep::Spread with = sweep::spread_of(planned.times);
        const sweep::Spread without = sweep::spread_of(everything.times);
        csv.row({everything.bodies, planned.bodies, everything.left_out, with.median, with.low, with.high,
                 without.median, without.low, without.high, without.median / with.median,
                 compare(planned.track, everything.track).position_max});
    }
    csv.finish();
}

} // namespace

void write_scene(const Options& options) {
    const SceneRuns scene(options);
    write_scene_error(options, scene);
    write_loops(options, scene);
    write_walls(options);
    write_scene_plan(options, scene);
}

} // namespace haptics::report
