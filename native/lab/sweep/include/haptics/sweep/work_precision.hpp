#pragma once
/// Error against run time of one experiment: every scheme, method and rate, with the front of what nothing
/// else beats and one recommended setting.

#include <haptics/sweep/experiment.hpp>
#include <haptics/sweep/timing.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace haptics::sweep {

/// What an error is worth beside the doubt about its reference (ten times what the last refinements of it
/// still changed).
enum class Trust {
    seen,          ///< larger than the doubt: as it was seen
    upper_bound,   ///< smaller, and reported as the doubt, which is small enough not to matter
    not_converged, ///< smaller, and the doubt matters: neither on the front nor recommended
};
[[nodiscard]] std::string_view name_of(Trust trust);

struct WorkPrecisionRow {
    Setting setting;
    TrackError error;
    /// Largest difference in position between one refinement of the reference and the next, over the last two
    /// refinements, m (largest over time).
    double reference_difference{0.0};
    Trust trust{Trust::seen};
    /// ns a step.
    Spread step_ns;
    /// Run time of a simulated second, us.
    double second_us{0.0};
    /// Nothing else of the same method is both cheaper and more accurate.
    bool front{false};
    bool recommended{false};
};

struct WorkPrecision {
    std::vector<WorkPrecisionRow> rows;
    /// For each method: which row is recommended and why, in words.
    struct Reason {
        Method method{Method::penalty};
        std::string text;
    };
    std::vector<Reason> reasons;
};

/// One motion that was measured somewhere else: its track and its run time (ns a step).
struct MeasuredRun {
    Setting setting;
    Track track;
    Spread step_ns;
};

/// Of a method: the motion at three refinements, each with half the step of the one before.
struct ReferenceRuns {
    Method method{Method::penalty};
    std::array<Track, 3> refinement;
};

struct SweepOptions {
    std::vector<double> rates{250.0, 500.0, 1000.0, 2000.0, 4000.0, 10000.0};
    int repeats{15};
    /// Error of the position that nobody feels, m (RMS): the cheapest setting below it is recommended.
    double good_enough{1e-5};
    /// Called after each row with the share done, 0..1.
    std::function<void(double)> progress;
};

[[nodiscard]] WorkPrecision sweep(const Experiment& experiment, const SweepOptions& options);

/// The same for runs that were made elsewhere. A run of a method without reference, or whose track has
/// another length, is infinitely far off. `unrest`: how far two equal runs are apart, which counts as doubt.
[[nodiscard]] WorkPrecision assess(const std::vector<ReferenceRuns>& references,
                                   const std::vector<MeasuredRun>& runs, const TrackError& unrest,
                                   double good_enough);

/// Marks the points (cost, error) that no other point beats in both; of equal points the first. Points that
/// are not finite are never on the front.
[[nodiscard]] std::vector<bool> pareto_front(const std::vector<double>& cost,
                                             const std::vector<double>& error);

/// Index of the cheapest front point with an error of at most `good_enough`; of the most accurate one when
/// there is none; -1 without a front.
[[nodiscard]] int recommend(const std::vector<double>& cost, const std::vector<double>& error,
                            const std::vector<bool>& front, double good_enough);

} // namespace haptics::sweep
