#include <haptics/sweep/experiment.hpp>

#include <cmath>

namespace haptics::sweep {

std::string_view name_of(Scheme scheme) {
    switch (scheme) {
    case Scheme::semi_implicit:
        return "semi_implicit";
    case Scheme::linearly_implicit:
        return "linearly_implicit";
    case Scheme::exact:
        return "exact";
    case Scheme::adams_bashforth4:
        return "adams_bashforth4";
    case Scheme::runge_kutta4:
        return "runge_kutta4";
    case Scheme::dormand_prince8:
        return "dormand_prince8";
    }
    return "";
}

std::string_view name_of(Method method) {
    switch (method) {
    case Method::penalty:
        return "penalty";
    case Method::impulse:
        return "penalty_impulse";
    case Method::paper:
        return "paper";
    }
    return "";
}

Track follow(const Experiment& experiment, const Setting& setting) {
    const auto run = experiment.start(setting);
    const auto samples = std::lround(experiment.seconds / k_sample_time);
    const auto steps = std::lround(setting.rate * k_sample_time);
    Track track;
    track.reserve(static_cast<std::size_t>(samples));
    for (long i = 0; i < samples; ++i) {
        for (long k = 0; k < steps; ++k)
            run->step();
        track.push_back(run->sample());
    }
    return track;
}

} // namespace haptics::sweep
