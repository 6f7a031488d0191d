// Precision: three rods that turn freely for a second, without gravity, gently or swiftly. The truth is the
// eighth-order method of native/core/dynamics with steps of 0.1 and 0.05 ms, whose difference is told; every
// engine that takes part has shown that it computes that motion. Of each method the fewest steps are sought
// (a quarter more at a time) whose tip stays within the error asked for at ten moments, and those are timed.
//
// Contact: a hand of 1000 N/m leads a box of 20 by 40 mm and 0.3 kg, computed here and given to every engine
// as a force, in steps of 2 ms. How deep it lies in the walls is computed here from its pose.

#include "peers_report.hpp"

#include <haptics/core/dynamics/forward_dynamics.hpp>
#include <haptics/core/dynamics/integrators/adams_bashforth4.hpp>
#include <haptics/core/dynamics/integrators/dormand_prince8.hpp>
#include <haptics/core/dynamics/integrators/linkage_motion.hpp>
#include <haptics/core/dynamics/integrators/runge_kutta4.hpp>
#include <haptics/core/types.hpp>
#include <haptics/peers/box_peer.hpp>
#include <haptics/peers/peers.hpp>
#include <haptics/shared/linkages.hpp>
#include <haptics/sweep/timing.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>

namespace haptics::bench {
namespace {

constexpr int k_rods = 3;
constexpr int k_moments = 10;
constexpr double k_rod = 0.1;
constexpr std::array<double, k_rods> k_start{0.0, 0.3, -0.3};
using Rates = std::array<double, k_rods>;
struct ChainMotion {
    const char* name;
    Rates start_rate;
};
constexpr ChainMotion k_motions[] = {{"gentle", {3.0, -4.0, 5.0}}, {"swift", {9.0, -12.0, 15.0}}};
constexpr long k_most_steps = 400'000;
constexpr long k_most_steps_quick = 20'000;
constexpr int k_repeats = 9;

using Tips = std::array<Vec2, k_moments>;

Vec2 tip_of(const double* angles) {
    Vec2 tip = Vec2::Zero();
    double angle = 0.0;
    for (int i = 0; i < k_rods; ++i) {
        angle += angles[i];
        tip += k_rod * Vec2(std::cos(angle), std::sin(angle));
    }
    return tip;
}

double farthest(const Tips& a, const Tips& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double distance = (a[i] - b[i]).norm();
        most = std::isfinite(distance) ? std::max(most, distance) : std::numeric_limits<double>::infinity();
    }
    return most;
}

/// A chain in one method, to be stepped.
struct Mover {
    virtual ~Mover() = default;
    virtual void step(double h) = 0;
    virtual void angles(double* out) = 0;
};

struct PeerMover final : Mover {
    PeerMover(std::unique_ptr<peers::ChainPeer> made, const Rates& rates)
        : chain(std::move(made)) {
        chain->set_state(k_start.data(), rates.data());
    }
    void step(double h) override { chain->step(h); }
    void angles(double* out) override {
        std::array<double, k_rods> rate{};
        chain->get_state(out, rate.data());
    }
    std::unique_ptr<peers::ChainPeer> chain;
};

LinkageModel chain_model() {
    LinkageModel model;
    if (!build_model(shared::chain(k_rods), model).empty())
        throw std::logic_error("the chain of the comparison does not compile");
    return model;
}

template <class Method>
struct OwnMover final : Mover {
    explicit OwnMover(const Rates& rates) {
        state.setZero(2 * k_rods);
        for (int i = 0; i < k_rods; ++i) {
            state[i] = k_start[static_cast<std::size_t>(i)];
            state[k_rods + i] = rates[static_cast<std::size_t>(i)];
        }
    }
    void step(double h) override { method.step(motion, 0.0, h, state); }
    void angles(double* out) override {
        for (int i = 0; i < k_rods; ++i)
            out[i] = state[i];
    }
    LinkageModel model{chain_model()};
    LinkageData data{[this] {
        LinkageData d;
        reset(model, d);
        return d;
    }()};
    LinkageMotion motion{model, data};
    Method method;
    StateVector state;
};

using Make = std::function<std::unique_ptr<Mover>(const Rates&)>;

Tips run_chain(const Make& make, const Rates& rates, long steps) {
    const auto mover = make(rates);
    const double h = 1.0 / static_cast<double>(steps);
    Tips tips;
    std::array<double, k_rods> angles{};
    for (int moment = 0; moment < k_moments; ++moment) {
        for (long i = 0; i < steps / k_moments; ++i)
            mover->step(h);
        mover->angles(angles.data());
        tips[static_cast<std::size_t>(moment)] = tip_of(angles.data());
    }
    return tips;
}

template <class Method>
std::unique_ptr<Mover> make_own(const Rates& rates) {
    return std::make_unique<OwnMover<Method>>(rates);
}

struct ChainWay {
    std::string engine;
    std::string method;
    Make make;
};

std::vector<ChainWay> chain_ways() {
    std::vector<ChainWay> ways;
    ways.push_back({"ours", "semi-implicit Euler", [](const Rates& rates) {
                        return std::make_unique<PeerMover>(peers::make_own_chain(shared::chain(k_rods)),
                                                           rates);
                    }});
    ways.push_back({"ours", "Adams-Bashforth 4", make_own<AdamsBashforth4>});
    ways.push_back({"ours", "Runge-Kutta 4", make_own<RungeKutta4>});
    ways.push_back({"ours", "Dormand-Prince 8", make_own<DormandPrince8>});
    const peers::ChainPlan plan = peers::plan_of(shared::chain(k_rods));
    for (const peers::Peer& peer : peers::all_peers()) {
        if (!peer.missing.empty()) {
            ways.push_back({peer.name, "missing: " + peer.missing, nullptr});
            continue;
        }
        const std::string name = peer.name + " " + peer.version;
        const bool box2d = peer.name == "box2d";
        ways.push_back(
            {name, box2d ? "8 and 3 iterations" : "Euler", [plan, make = peer.make](const Rates& rates) {
                 return std::make_unique<PeerMover>(make(plan), rates);
             }});
        if (peer.make_rk4 != nullptr)
            ways.push_back({name, "Runge-Kutta 4", [plan, make = peer.make_rk4](const Rates& rates) {
                                return std::make_unique<PeerMover>(make(plan), rates);
                            }});
    }
    return ways;
}

std::string quote(const std::string& text) {
    std::string safe = "\"";
    for (const char c : text)
        safe += c == '"' ? '\'' : c;
    return safe + '"';
}

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

void write_motion(std::ofstream& csv, const ChainMotion& motion, bool quick) {
    const long most = quick ? k_most_steps_quick : k_most_steps;
    const Tips rough = run_chain(make_own<DormandPrince8>, motion.start_rate, 10'000);
    const Tips truth = run_chain(make_own<DormandPrince8>, motion.start_rate, 20'000);
    const double doubt = farthest(rough, truth);
    const std::vector<ChainWay> ways = chain_ways();
    for (const double asked : {1e-3, 1e-6, 1e-9})
        for (const ChainWay& way : ways) {
            csv << motion.name << ',' << number(asked) << ',' << quote(way.engine) << ',' << quote(way.method)
                << ',';
            if (!way.make) {
                csv << ",,,,,\n";
                continue;
            }
            double error = std::numeric_limits<double>::infinity();
            long steps = k_moments;
            while (steps <= most) {
                error = farthest(run_chain(way.make, motion.start_rate, steps), truth);
                if (error <= asked)
                    break;
                steps = (steps * 5 / 4 / k_moments + 1) * k_moments;
            }
            csv << (error <= asked ? std::to_string(steps) : "") << ',' << number(error) << ','
                << number(doubt) << ',';
            if (error <= asked) {
                const double h = 1.0 / static_cast<double>(steps);
                std::unique_ptr<Mover> mover;
                const sweep::Spread ns = sweep::time_calls([&] { mover = way.make(motion.start_rate); },
                                                           [&] { mover->step(h); }, steps, k_repeats);
                const double scale = 1e-3 * static_cast<double>(steps);
                csv << number(scale * ns.median) << ',' << number(scale * ns.low) << ','
                    << number(scale * ns.high);
            } else {
                csv << ",,";
            }
            csv << '\n';
            std::fprintf(stderr, "precision %.0e: %s, %s\n", asked, way.engine.c_str(), way.method.c_str());
        }
}

void write_precision(std::ofstream& csv, bool quick) {
    csv << "motion,error_asked_m,engine,method,steps_per_s,error_m,truth_difference_m,us_per_simulated_s,us_"
           "low,"
           "us_high\n";
    for (const ChainMotion& motion : k_motions)
        write_motion(csv, motion, quick);
}

constexpr double k_contact_step = 2e-3;
constexpr double k_half_x = 0.01;
constexpr double k_half_y = 0.02;
constexpr double k_side = 5e-5; // play on each side

constexpr long k_contact_steps = 2000;

struct ContactScene {
    ContactScene(const char* title, const peers::BoxPlan& box, Pose (*target)(double t))
        : name(title)
        , plan(box) {
        for (long i = 0; i < k_contact_steps; ++i)
            goal.push_back(target(k_contact_step * static_cast<double>(i)));
    }
    const char* name;
    peers::BoxPlan plan;
    /// Where the hand wants the box, step by step: known before, so that nobody's time has its sines in it.
    std::vector<Pose> goal;
};

peers::BoxPlan box_plan() {
    peers::BoxPlan plan;
    plan.half_x = k_half_x;
    plan.half_y = k_half_y;
    plan.mass = 0.3;
    plan.inertia = plan.mass * (k_half_x * k_half_x + k_half_y * k_half_y) / 3.0;
    plan.time_step = k_contact_step;
    return plan;
}

ContactScene peg() {
    ContactScene s("peg in a hole, 100 um clearance, 500 Hz", box_plan(), [](double t) {
        return Pose(1e-3 * std::sin(20.0 * t), -0.05 + 0.03 * std::cos(3.0 * t), 0.01 * std::sin(13.0 * t));
    });
    s.plan.start[1] = -0.02;
    constexpr double k_half_wall = 0.05;
    for (const double side : {1.0, -1.0})
        s.plan.fixed.push_back(
            {side * (k_half_x + k_side + k_half_wall), -k_half_wall, k_half_wall, k_half_wall});
    return s;
}

ContactScene wall() {
    ContactScene s("struck and pressed wall, 500 Hz", box_plan(), [](double t) {
        return Pose(0.01 * std::sin(3.0 * t), k_half_y - 0.004 + 0.014 * std::cos(6.0 * t), 0.0);
    });
    s.plan.start[1] = k_half_y + 0.01;
    s.plan.fixed.push_back({0.0, -0.05, 0.2, 0.05});
    return s;
}

// deepest overlap of two boxes, one upright: least over the four side directions of the overlap there, 0
// when any of them separates
double overlap(const Pose& at, const peers::FixedBox& box) {
    const double c = std::cos(at.z());
    const double s = std::sin(at.z());
    const Vec2 gap(at.x() - box.x, at.y() - box.y);
    const double reach_x = std::abs(c) * k_half_x + std::abs(s) * k_half_y;
    const double reach_y = std::abs(s) * k_half_x + std::abs(c) * k_half_y;
    const double back_x = std::abs(c) * box.half_x + std::abs(s) * box.half_y;
    const double back_y = std::abs(s) * box.half_x + std::abs(c) * box.half_y;
    const double least =
        std::min({box.half_x + reach_x - std::abs(gap.x()), box.half_y + reach_y - std::abs(gap.y()),
                  k_half_x + back_x - std::abs(c * gap.x() + s * gap.y()),
                  k_half_y + back_y - std::abs(c * gap.y() - s * gap.x())});
    return std::max(0.0, least);
}

struct Led {
    Led(const ContactScene& of, const peers::BoxWay& way)
        : scene(of)
        , box(way.make(of.plan)) {}
    void go() {
        double velocity[3];
        box->state(pose.data(), velocity);
        const Pose& goal = scene.goal[count++];
        const Vec3 stiffness(1000.0, 1000.0, 1.0);
        const Vec3 damping(20.0, 20.0, 0.01);
        const Vec3 force = stiffness.cwiseProduct(goal - pose) -
                           damping.cwiseProduct(Vec3(velocity[0], velocity[1], velocity[2]));
        box->step(force.data());
    }
    const ContactScene& scene;
    std::unique_ptr<peers::BoxPeer> box;
    Pose pose{0.0, 0.0, 0.0};
    std::size_t count{0};
};

void write_contact(std::ofstream& csv, bool quick) {
    csv << "scene,way,setup,deepest_m,behind_hand_m,ns_per_step,ns_low,ns_high\n";
    const int repeats = quick ? 3 : k_repeats;
    const ContactScene scenes[] = {peg(), wall()};
    for (const ContactScene& scene : scenes)
        for (const peers::BoxWay& way : peers::all_box_ways()) {
            csv << quote(scene.name) << ',' << quote(way.name) << ',';
            if (!way.missing.empty()) {
                csv << quote("missing: " + way.missing) << ",,,,,\n";
                continue;
            }
            Led led(scene, way);
            double deepest = 0.0;
            double behind = 0.0;
            for (long i = 0; i < k_contact_steps; ++i) {
                led.go();
                const Pose& goal = scene.goal[static_cast<std::size_t>(i)];
                for (const peers::FixedBox& box : scene.plan.fixed)
                    deepest = std::max(deepest, overlap(led.pose, box));
                // nothing holds it back along the hole, or along the wall
                const bool hole = scene.plan.fixed.size() > 1;
                behind = std::max(behind, std::abs(hole ? led.pose.y() - goal.y() : led.pose.x() - goal.x()));
            }
            std::unique_ptr<Led> timed;
            const sweep::Spread ns = sweep::time_calls([&] { timed = std::make_unique<Led>(scene, way); },
                                                       [&] { timed->go(); }, k_contact_steps, repeats);
            csv << quote(way.setup) << ',' << number(deepest) << ',' << number(behind) << ','
                << number(ns.median) << ',' << number(ns.low) << ',' << number(ns.high) << '\n';
            std::fprintf(stderr, "contact: %s, %s\n", scene.name, way.name.c_str());
        }
}

} // namespace

void write_peer_tables(const std::string& folder, bool quick) {
    const auto make = [&](const char* name, void (*write)(std::ofstream&, bool)) {
        std::ofstream csv(folder + "/" + name);
        write(csv, quick);
        csv.close();
        if (!csv)
            throw std::runtime_error("cannot write " + folder + "/" + name);
    };
    make("peers_precision.csv", write_precision);
    make("peers_contact.csv", write_contact);
}

} // namespace haptics::bench
