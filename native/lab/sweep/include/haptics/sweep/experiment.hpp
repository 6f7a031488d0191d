#pragma once
/// A named motion that every integrator, rate and method is measured on, with its own reference.

#include <haptics/sweep/track.hpp>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptics::sweep {

/// How time is stepped: the three of the local model, and the smooth-motion ones of native/core/dynamics,
/// which know no contact.
enum class Scheme {
    semi_implicit,
    linearly_implicit,
    exact,
    adams_bashforth4,
    runge_kutta4,
    dormand_prince8,
};

/// What is modeled: contact by springs alone or with collision impulses, and the paper's own choices.
enum class Method { penalty, impulse, paper };

[[nodiscard]] std::string_view name_of(Scheme scheme);
[[nodiscard]] std::string_view name_of(Method method);

struct Setting {
    Scheme scheme{Scheme::linearly_implicit};
    Method method{Method::penalty};
    /// Hz; k_sample_time is a whole number of its steps.
    double rate{1000.0};
};

/// One motion in progress.
class Run {
  public:
    Run() = default;
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    virtual ~Run() = default;
    /// One step; what is timed.
    virtual void step() = 0;
    [[nodiscard]] virtual Sample sample() = 0;
};

struct Experiment {
    std::string name;
    /// One sentence for a person.
    std::string title;
    /// No contact opens, closes, sticks or slips.
    bool smooth{false};
    /// s.
    double seconds{1.0};
    std::vector<Scheme> schemes;
    std::vector<Method> methods;
    std::function<std::unique_ptr<Run>(const Setting&)> start;
    /// The true motion for a method; each `refinement` (0, 1, 2, …) halves the step.
    std::function<Track(Method, int refinement)> reference;
};

/// The whole motion at one setting.
[[nodiscard]] Track follow(const Experiment& experiment, const Setting& setting);

/// A free rigid tool that a moving hand pulls about.
[[nodiscard]] Experiment pulled_tool();
/// A lossless fall on the paper's wall (15000 N/m, no damper), or with restitution 0.7 by impulses.
[[nodiscard]] Experiment bouncing_tool();
/// A steady push of 2 N drives a tool into the paper's wall.
[[nodiscard]] Experiment pressing_tool();
/// A tool pressed with 2 N and dragged to and fro with friction.
[[nodiscard]] Experiment sliding_tool();
/// Three rods of 0.1 m and 0.1 kg swing under gravity.
[[nodiscard]] Experiment swinging_chain();

} // namespace haptics::sweep
