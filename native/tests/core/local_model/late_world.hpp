#pragma once
/// A wall that moves in closed form, a tool that a hand presses on it, and a line over which the snapshots of
/// the wall come late, bunched, jittered, or not at all.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace haptics::late {

constexpr double k_pi = 3.14159265358979323846;
constexpr double k_step = 0.001;

/// How the wall moves. The tool starts on top of it, at the origin.
enum class Motion {
    constant, ///< 30 mm/s along its normal
    sine,     ///< 5 mm at 1 Hz along its normal
    swing,    ///< about a hinge 0.1 m beside the tool, 0.2 rad at 0.7 Hz; the reference point goes round
    cam,      ///< a disc that turns evenly about an axis 5 mm off its center, half a turn a second
    slide,    ///< 5 mm at 1 Hz along its face, for what sticks to it
};
constexpr Motion k_motions[] = {Motion::constant, Motion::sine, Motion::swing, Motion::cam};

inline const char* name_of(Motion m) {
    constexpr const char* k_names[] = {"constant", "sine", "swing", "cam", "slide"};
    return k_names[static_cast<int>(m)];
}

struct Place {
    Pose pose;
    Twist twist;
};

/// Where the wall truly is.
inline Place wall_at(Motion motion, double t) {
    switch (motion) {
    case Motion::constant:
        return {{0.0, -0.02 + 0.03 * t, 0.0}, {0.0, 0.03, 0.0}};
    case Motion::sine: {
        const double w = 2.0 * k_pi;
        return {{0.0, -0.02 + 0.005 * std::sin(w * t), 0.0}, {0.0, 0.005 * w * std::cos(w * t), 0.0}};
    }
    case Motion::swing: {
        const double w = 2.0 * k_pi * 0.7;
        const double angle = 0.2 * std::sin(w * t);
        const double spin = 0.2 * w * std::cos(w * t);
        const Vec2 arm = rotate(angle, Vec2(0.1, -0.02));
        const Vec2 v = spin * perpendicular(arm);
        return {{arm.x() - 0.1, arm.y(), angle}, {v.x(), v.y(), spin}};
    }
    case Motion::slide: {
        const double w = 2.0 * k_pi;
        return {{0.005 * std::sin(w * t), -0.02, 0.0}, {0.005 * w * std::cos(w * t), 0.0, 0.0}};
    }
    case Motion::cam:
        break;
    }
    const double w = k_pi;
    const Vec2 arm = rotate(w * t, Vec2(0.005, 0.0));
    const Vec2 v = w * perpendicular(arm);
    return {{arm.x(), arm.y() - 0.04, w * t}, {v.x(), v.y(), w}};
}

/// The line between the environment and the loop.
struct Line {
    std::string name{"even"};
    double rate{60.0};
    double delay{0.0};
    /// A snapshot comes up to this much later, evenly spread, s.
    double jitter{0.0};
    /// Two ticks in one frame, none in the next.
    bool bunched{false};
    /// Share of the snapshots that never come.
    double lost{0.0};
    /// The environment knows no velocities and takes differences of poses, as Godot's does.
    bool differences{false};
    /// What coordinates are rounded to, m (0: they are not).
    double grain{0.0};
};

/// How the local model uses what comes.
enum class Use {
    ours,
    every_step, ///< truth: a fresh snapshot at every haptic step
    no_blend,   ///< extrapolates, and jumps to each new snapshot
    hold_last,  ///< leaves the wall where the last snapshot had it
};

struct Press {
    Surface surface{shared::paper_surface()};
    double tool_mass{0.3};
    double force{2.0};
    Vec3 stiffness{100.0, 0.0, 2.0};
    Vec3 damping{2.0, 2.0, 0.01};
    /// How many times as fast the wall moves, and how many times as far.
    double pace{1.0};
    double size{1.0};
};

struct Sample {
    double time{0.0};
    Vec2 force{0.0, 0.0};
    Pose wall{0.0, 0.0, 0.0};
    Twist wall_velocity{0.0, 0.0, 0.0};
    /// A snapshot was taken just before this step.
    bool update{false};
    /// How long the wall's path takes to join that of the last snapshot, in ticks.
    double blend{0.0};
    int colliding{0};
};

/// Runs the loop against the line.
class LateWorld {
  public:
    LateWorld(Motion motion, const Line& line, Use use, const Press& press, unsigned seed = 1)
        : motion_(motion)
        , pace_(press.pace)
        , size_(press.size)
        , line_(line)
        , use_(use)
        , random_(seed)
        , model_(shared::box_tool(press.tool_mass))
        , data_(std::make_unique<Data>())
        , next_(std::make_unique<Neighborhood>()) {
        const Place start = place_at(0.0);
        const double on_top =
            motion == Motion::cam ? start.pose.y() + std::sqrt(0.04 * 0.04 - 0.005 * 0.005) : 0.0;
        reset(model_, *data_, Pose(0.0, on_top + 0.01 - press.force / press.surface.stiffness, 0.0));
        data_->velocity.y() = start.twist.y();
        hand_.held = true;
        hand_.force = Wrench(0.0, -press.force, 0.0);
        hand_.stiffness = press.stiffness;
        hand_.damping = press.damping;
        shared::add_body(next_->bodies, 50, BodyKind::kinematic, press.surface, start.pose);
        shared::add_piece(next_->bodies, motion == Motion::cam ? make_disc(Vec2::Zero(), 0.04)
                                                               : make_box(Vec2::Zero(), Vec2(0.3, 0.04)));
        publish(0.0);
    }

    Sample step() {
        Sample s;
        if (use_ == Use::every_step) {
            ++tick_;
            publish(data_->time);
            s.update = true;
        } else {
            s.update = receive();
        }
        haptics::step(model_, *data_, hand_, k_step, out_);
        s.time = data_->time;
        s.force = out_.contact.head<2>();
        s.wall = data_->neighbors.body[0].pose;
        s.wall_velocity = data_->neighbors.body[0].velocity;
        s.blend = data_->track[0].blend / data_->track[0].tick;
        s.colliding = out_.colliding;
        return s;
    }

    /// The environment stops; nothing more comes.
    void freeze() { frozen_ = true; }
    /// And goes on: its motion went on all the while.
    void thaw() {
        frozen_ = false;
        tick_ = static_cast<int>(data_->time * line_.rate);
    }
    [[nodiscard]] Data& data() { return *data_; }
    [[nodiscard]] const Model& model() const { return model_; }

  private:
    struct Letter {
        double made;
        double comes;
        std::uint64_t number;
    };

    // lets the environment tick up to now, and takes the newest of what has come
    bool receive() {
        const double tick = 1.0 / line_.rate;
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        while (!frozen_ && static_cast<double>(tick_ + 1) * tick <= data_->time + 1e-9) {
            ++tick_;
            const double made = static_cast<double>(tick_) * tick;
            const bool second = line_.bunched && tick_ % 2 == 1;
            const double comes = made + (second ? tick : 0.0) + line_.delay + line_.jitter * unit(random_);
            if (unit(random_) >= line_.lost)
                letters_.push_back({made, comes, static_cast<std::uint64_t>(tick_)});
        }
        bool came = false;
        for (std::size_t i = 0; i < letters_.size();) {
            if (letters_[i].comes > data_->time + 1e-9) {
                ++i;
                continue;
            }
            if (letters_[i].number + 1 > data_->sequence) {
                take(letters_[i].made, letters_[i].number + 1, tick);
                came = true;
            }
            letters_.erase(letters_.begin() + static_cast<std::ptrdiff_t>(i));
        }
        return came;
    }

    void publish(double made) {
        take(made, static_cast<std::uint64_t>(tick_) + 1,
             use_ == Use::every_step ? k_step : 1.0 / line_.rate);
    }

    [[nodiscard]] Place place_at(double time) const {
        Place at = wall_at(motion_, pace_ * time);
        at.twist *= pace_;
        if (motion_ == Motion::sine) { // about where it starts
            at.pose.y() += (size_ - 1.0) * (at.pose.y() + 0.02);
            at.twist.y() *= size_;
        }
        return at;
    }

    [[nodiscard]] Place seen_at(double made) const {
        Place at = place_at(made);
        if (line_.grain > 0.0 && use_ != Use::every_step)
            for (int i = 0; i < 2; ++i)
                at.pose(i) = line_.grain * std::round(at.pose(i) / line_.grain);
        return at;
    }

    void take(double made, std::uint64_t number, double tick) {
        const Place at = seen_at(made);
        Body& b = next_->bodies.body[0];
        next_->sequence = number;
        next_->time = made;
        next_->tick = tick;
        b.pose = at.pose;
        b.velocity = at.twist;
        if (line_.differences && use_ != Use::every_step)
            b.velocity = (at.pose - seen_at(made - tick).pose) / tick;
        if (use_ == Use::hold_last)
            b.velocity.setZero();
        take_neighborhood(*next_, *data_);
        if (use_ == Use::no_blend || use_ == Use::hold_last) {
            Track& t = data_->track[0];
            t.offset = {};
            pass_time(*data_, 0.0);
        }
    }

    Motion motion_;
    double pace_;
    double size_;
    Line line_;
    Use use_;
    std::mt19937 random_;
    Model model_;
    std::unique_ptr<Data> data_;
    std::unique_ptr<Neighborhood> next_;
    std::vector<Letter> letters_;
    HandInput hand_;
    StepOutput out_;
    int tick_{0};
    bool frozen_{false};
};

/// What a run shows beside the truth.
struct Figures {
    /// RMS of the difference of contact forces, N.
    double rms{0.0};
    /// Largest change of force in the step of an update less the same of the truth, N, and the largest ratio
    /// of that to max(7 % of the force, 0.05 N). Steps up to k_hit_steps from a hit of the truth do not
    /// count: met a step earlier or later, the same hit is no jump of an update.
    double jump{0.0};
    double jump_ratio{0.0};
    /// The same over all steps.
    double any_ratio{0.0};
    /// Longest blend, in ticks.
    double blend{0.0};
    /// Contacts that were run into, and the same of the truth.
    int colliding{0};
    int colliding_true{0};
};

constexpr int k_hit_steps = 5;

inline Figures compare(Motion motion, const Line& line, Use use, const Press& press, double seconds = 4.0) {
    LateWorld late(motion, line, use, press);
    LateWorld truth(motion, line, Use::every_step, press);
    Figures f;
    const int steps = static_cast<int>(seconds / k_step);
    std::vector<Sample> a;
    std::vector<Sample> b;
    for (int i = 0; i < steps; ++i) {
        a.push_back(late.step());
        b.push_back(truth.step());
    }
    const auto begin = b.begin();
    double sum = 0.0;
    for (int i = 500; i < steps; ++i) {
        const auto k = static_cast<std::size_t>(i);
        sum += (a[k].force - b[k].force).squaredNorm();
        f.blend = std::max(f.blend, a[k].blend);
        f.colliding += a[k].colliding;
        f.colliding_true += b[k].colliding;
        if (std::any_of(begin + i - k_hit_steps, begin + std::min(i + k_hit_steps + 1, steps),
                        [](const Sample& s) { return s.colliding > 0; }))
            continue;
        const double excess = (a[k].force - a[k - 1].force).norm() - (b[k].force - b[k - 1].force).norm();
        const double ratio = excess / std::max(0.07 * a[k - 1].force.norm(), 0.05);
        f.any_ratio = std::max(f.any_ratio, ratio);
        if (a[k].update) {
            f.jump = std::max(f.jump, excess);
            f.jump_ratio = std::max(f.jump_ratio, ratio);
        }
    }
    f.rms = std::sqrt(sum / (steps - 500));
    return f;
}

} // namespace haptics::late
