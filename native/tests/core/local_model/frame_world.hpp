#pragma once
/// A tool pressed on a body that an engine moves, whose frames come late: the engine's ticks, the clock that
/// stamps them, and the haptic steps that go on meanwhile.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/realtime/tick_clock.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace haptics::frames {

constexpr double k_frame_step = 0.001;
constexpr double k_tick = 1.0 / 60.0;
/// Godot runs no more ticks than that in a frame; what is due beyond them is lost.
constexpr int k_most_ticks = 8;
/// When the first block begins, s.
constexpr double k_begin = 1.5;

/// A body below the tool in steady or swinging motion (scene time).
struct Drift {
    const char* name;
    double along;  ///< m/s
    double normal; ///< m/s
    double swing;  ///< m, along the normal, at 1 Hz
    double friction;
};
constexpr Drift k_drifts[] = {
    {"at rest", 0.0, 0.0, 0.0, 0.0},
    {"at rest, rough", 0.0, 0.0, 0.0, 0.4},
    {"slides", 0.05, 0.0, 0.0, 0.0},
    {"slides, rough", 0.05, 0.0, 0.0, 0.4},
    {"slides fast, rough", 0.2, 0.0, 0.0, 0.4},
    {"slides and rises", 0.05, 0.001, 0.0, 0.4},
    {"slides and sinks", 0.05, -0.0005, 0.0, 0.4},
    {"swings a little", 0.05, 0.0, 0.0005, 0.4},
    {"swings", 0.05, 0.0, 0.001, 0.4},
};

/// How the main thread runs.
struct Frames {
    const char* name;
    double rate;  ///< frames a second
    double block; ///< s, at k_begin; 0 for none
};
constexpr Frames k_frames[] = {{"20 a second", 20.0, 0.0}, {"50 ms", 60.0, 0.05},
                               {"500 ms", 60.0, 0.5},      {"50 ms of 144 a second", 144.0, 0.05},
                               {"100 ms", 60.0, 0.1},      {"3 s", 60.0, 3.0}};

/// Which snapshots of several in a frame the loop gets to see.
enum class Reading { last, each };

struct LateFrameCase {
    Drift drift;
    Frames frames;
    Reading reading{Reading::last};
    /// The block begins so much later, s.
    double phase{0.0};
    double force{2.0};
    double damping{20.0};
    /// Dynamic friction as a part of the static one.
    double dynamic{1.0};
};

class FrameWorld {
  public:
    FrameWorld(const LateFrameCase& c, bool disturbed)
        : case_(c)
        , disturbed_(disturbed)
        , model_(shared::box_tool())
        , data_(std::make_unique<Data>())
        , next_(std::make_unique<Neighborhood>()) {
        Surface surface = shared::paper_surface();
        surface.static_friction = c.drift.friction;
        surface.dynamic_friction = c.dynamic * c.drift.friction;
        surface.damping = c.damping;
        reset(model_, *data_, Pose(0.0, 0.01 - c.force / surface.stiffness, 0.0));
        hand_.held = true;
        // a hand that leans: its spring is much softer than the wall
        hand_.stiffness = Vec3(1000.0, 1000.0, 2.0);
        hand_.damping = Vec3(10.0, 10.0, 0.01);
        hand_.target = Pose(0.0, 0.01 - c.force / surface.stiffness - c.force / hand_.stiffness.y(), 0.0);
        shared::add_body(next_->bodies, 50, BodyKind::kinematic, surface, Pose::Zero());
        shared::add_piece(next_->bodies, make_box(Vec2(0.0, -0.01), Vec2(4.0, 0.02)));
        frame_ = -k_tick;
    }

    /// One haptic step; the contact force.
    Vec2 step() {
        run_frames();
        if (waiting_ < made_.size()) {
            waiting_ = case_.reading == Reading::last ? made_.size() - 1 : waiting_;
            take(made_[waiting_++]);
        }
        haptics::step(model_, *data_, hand_, k_frame_step, out_);
        return out_.contact.head<2>();
    }

  private:
    struct Snapshot {
        double time;
        double scene;
    };

    [[nodiscard]] Pose place(double t) const {
        const Drift& d = case_.drift;
        constexpr double w = 6.28318530717958647692;
        return {d.along * t, d.normal * t + d.swing * std::sin(w * t), 0.0};
    }

    [[nodiscard]] bool blocked(double t) const {
        const double begin = k_begin + case_.phase;
        return disturbed_ && case_.frames.block > 0.0 && t > begin && t < begin + case_.frames.block;
    }

    void run_frames() {
        const double now = data_->time;
        const double rate = disturbed_ ? case_.frames.rate : 60.0;
        if (now < next_frame_ || blocked(now))
            return;
        next_frame_ = std::max(next_frame_ + 1.0 / rate, now);
        due_ += now - frame_;
        frame_ = now;
        ++count_;
        const int ticks = static_cast<int>(due_ / k_tick + 1e-9);
        due_ -= ticks * k_tick;
        for (int i = 0; i < std::min(ticks, k_most_ticks); ++i) {
            scene_ += k_tick;
            made_.push_back({clock_.tick(now, k_tick, count_), scene_});
        }
    }

    void take(const Snapshot& s) {
        Body& b = next_->bodies.body[0];
        ++next_->sequence;
        next_->time = s.time;
        next_->tick = k_tick;
        b.pose = place(s.scene);
        b.velocity = (b.pose - place(s.scene - k_tick)) / k_tick;
        take_neighborhood(*next_, *data_);
    }

    LateFrameCase case_;
    bool disturbed_;
    Model model_;
    std::unique_ptr<Data> data_;
    std::unique_ptr<Neighborhood> next_;
    HandInput hand_;
    StepOutput out_;
    TickClock clock_;
    std::vector<Snapshot> made_;
    std::size_t waiting_{0};
    double next_frame_{0.0};
    double frame_{0.0};
    double due_{0.0};
    std::int64_t count_{0};
    double scene_{0.0};
};

struct Seen {
    /// Largest change of force in a step beyond the largest of the undisturbed motion, over max(7 %, 0.05 N),
    /// and when.
    double ratio{0.0};
    double when{0.0};
    double excess{0.0};
    /// Largest and smallest force, N, and those of the undisturbed motion.
    double largest{0.0};
    double largest_true{0.0};
    double smallest{1e9};
    double smallest_true{1e9};
};

inline Seen compare(const LateFrameCase& c) {
    FrameWorld late(c, true);
    FrameWorld truth(c, false);
    Seen seen;
    Vec2 last = Vec2::Zero();
    Vec2 last_true = Vec2::Zero();
    constexpr int k_settled = 1000;
    const int steps = static_cast<int>((k_begin + c.frames.block + 0.8) / k_frame_step);
    std::vector<Vec2> forces;
    double most = 0.0;
    for (int i = 0; i < steps; ++i) {
        const Vec2 b = truth.step();
        const Vec2 a = late.step();
        if (i > k_settled) {
            most = std::max(most, (b - last_true).norm());
            seen.largest_true = std::max(seen.largest_true, b.norm());
            seen.smallest_true = std::min(seen.smallest_true, b.norm());
            seen.largest = std::max(seen.largest, a.norm());
            seen.smallest = std::min(seen.smallest, a.norm());
        }
        forces.push_back(a);
        last_true = b;
    }
    for (int i = k_settled; i < steps; ++i) {
        const Vec2 a = forces[static_cast<std::size_t>(i)];
        last = forces[static_cast<std::size_t>(i - 1)];
        const double excess = (a - last).norm() - most;
        const double ratio = excess / std::max(0.07 * last.norm(), 0.05);
        if (ratio > seen.ratio) {
            seen.ratio = ratio;
            seen.when = i * k_frame_step;
        }
        seen.excess = std::max(seen.excess, excess);
    }
    return seen;
}

} // namespace haptics::frames
