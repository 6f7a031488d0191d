#pragma once
/// Scenes whose feel is kept: the handle's motion and the force on the hand, every 4 ms. What these traces
/// were is in tests/golden/feel_<name>.csv; a test and the report compare.

#include <haptics/shared/experiment1.hpp>
#include <haptics/shared/linkage_tools.hpp>

#include <numbers>
#include <string>
#include <vector>

namespace haptics::shared {

struct FeelSample {
    double time{0.0};
    Pose handle{0.0, 0.0, 0.0};
    Wrench force{0.0, 0.0, 0.0};
};

struct FeelTrace {
    std::string name;
    std::vector<FeelSample> sample;
};

namespace feel {

inline constexpr double k_sample_time = 0.004;

inline FeelTrace record(std::string name, Session& session, const SimulatedPantograph& device,
                        double seconds) {
    FeelTrace trace{std::move(name), {}};
    const auto steps = static_cast<int>(k_sample_time / session.settings().step + 0.5);
    for (auto left = static_cast<int>(seconds / k_sample_time + 0.5); left > 0; --left) {
        for (int k = 0; k < steps; ++k)
            session.step();
        trace.sample.push_back({session.report().time, device.true_pose(), session.report().force});
    }
    return trace;
}

// a circle of `radius` (m) from `start` on, once in `period` (s), begun gently
inline std::vector<HandTarget> circle(const Pose& start, double radius, double period, double turn) {
    std::vector<HandTarget> path;
    for (int i = 0; i <= 60; ++i) {
        const double t = 0.05 * i;
        const double grown = radius * (t < 0.5 ? 0.0 : t < 1.0 ? 2.0 * (t - 0.5) : 1.0);
        const double angle = 2.0 * std::numbers::pi * t / period;
        HandTarget h;
        h.time_s = t;
        h.pose = start + Pose(grown * std::sin(angle), grown * (std::cos(angle) - 1.0),
                              turn * std::sin(angle) * grown / radius);
        path.push_back(h);
    }
    return path;
}

} // namespace feel

/// Records all of them: half a second of computing.
inline std::vector<FeelTrace> feel_traces() {
    std::vector<FeelTrace> all;
    for (const ContactMode mode : {ContactMode::penalty, ContactMode::penalty_impulse})
        for (const bool exact : {false, true}) {
            Experiment1Options o;
            o.contact = mode;
            o.integrator = exact ? Integrator::exact : Integrator::semi_implicit;
            // penalty alone with the full coupling never settles, and such a motion has no trace to keep
            o.gain = mode == ContactMode::penalty ? 1.0 / 3.0 : 1.0;
            Experiment1 e(o);
            all.push_back(feel::record(std::string("experiment1_") +
                                           (mode == ContactMode::penalty ? "penalty" : "impulse") +
                                           (exact ? "_exact" : ""),
                                       *e.session, *e.device, 3.0));
        }
    const auto held = [&all](const char* name, const Model& model, const LinkageVector& start,
                             const Neighborhood& scene, const std::vector<HandTarget>& path) {
        HeldTool tool(model, start, path_hand(path), {}, 0.3, 10e-6);
        tool.session->take(scene);
        all.push_back(feel::record(name, *tool.session, *tool.device, 3.0));
    };
    Surface rough = paper_surface();
    rough.static_friction = 0.5;
    rough.dynamic_friction = 0.3;
    held("rubbed_wall", box_tool(), Pose(0.0, 0.011, 0.0), *floor_of(3, rough),
         feel::circle(Pose::Zero(), 0.015, 0.8, 0.0));
    held("edge_of_wall", box_tool(), Pose(0.095, 0.012, 0.0), *floor_of(1, rough),
         feel::circle(Pose::Zero(), 0.02, 1.1, 0.2));
    Model arm = linkage_tool(shared::arm());
    arm.tool.grip = Grip{2, Vec2(0.05, 0.0), false};
    held("arm", arm, Vec3(0.3, -0.7, 0.5), *empty_world(), feel::circle(Pose::Zero(), 0.02, 0.6, 0.0));
    return all;
}

} // namespace haptics::shared
