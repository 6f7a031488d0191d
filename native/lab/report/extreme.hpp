#pragma once
/// Extreme cases: each a named row that passes on a stated figure.

#include <haptics/core/local_model/local_model.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace haptics::report {

inline constexpr double k_lost = std::numeric_limits<double>::infinity();

struct ExtremeResult {
    /// Passes when it is at most the bound.
    double value{k_lost};
    /// Steps after which something was not finite.
    long not_finite{0};
    /// Largest force that left the output gate over its limit; 0 where no device is in the loop.
    double force_over_limit{0.0};
    /// For a person: what happened, or why it cannot be better.
    std::string note;
};

struct ExtremeCase {
    std::string name;
    /// What the figure is, with its unit.
    std::string figure;
    double bound{0.0};
    std::function<ExtremeResult()> run;
};

/// A tool without a device, in one piece. `step` in s.
struct Alone {
    explicit Alone(const Model& m, double time_step = 1e-3)
        : model(m)
        , step(time_step) {
        scene->sequence = 1;
        out.stored_energy = 0.0;
    }
    void begin(const LinkageVector& at) {
        reset(model, *data, at);
        scene->plan = choose_plan(model, *scene);
        take_neighborhood(*scene, *data);
    }
    void go(double seconds) {
        for (auto left = static_cast<long>(seconds / step + 0.5); left > 0; --left) {
            haptics::step(model, *data, hand, step, out);
            const bool finite = data->pose.allFinite() && data->velocity.allFinite() &&
                                out.contact.allFinite() && out.coupling.allFinite();
            not_finite += finite ? 0 : 1;
        }
    }
    [[nodiscard]] ExtremeResult result(double value, std::string note = {}) const {
        return {value, not_finite, 0.0, std::move(note)};
    }
    Model model;
    double step;
    std::unique_ptr<Neighborhood> scene{std::make_unique<Neighborhood>()};
    std::unique_ptr<Data> data{std::make_unique<Data>()};
    HandInput hand;
    StepOutput out;
    long not_finite{0};
};

/// Those of the proxy alone, and those with a device in the loop.
void add_proxy_cases(std::vector<ExtremeCase>& cases);
void add_device_cases(std::vector<ExtremeCase>& cases);

} // namespace haptics::report
