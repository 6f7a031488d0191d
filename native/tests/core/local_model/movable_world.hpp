#pragma once
/// A double-precision environment of movable bodies in lock-step with the local model: it integrates them
/// freely at its own tick, gives them the impulses that reports bring, and publishes snapshots.

#include <haptics/core/local_model/local_model.hpp>
#include <haptics/shared/paper_wall.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace haptics::late {

/// When a snapshot is made within a tick.
enum class TickOrder {
    push_move_publish, ///< takes the impulses, moves, publishes where that led
    publish_push_move, ///< publishes, takes the impulses, and its engine moves after that (as Godot does)
};

struct MovableOptions {
    double rate{60.0};
    TickOrder order{TickOrder::publish_push_move};
    /// Share of reports that never reach the environment.
    double lost{0.0};
    double step{0.001};
    unsigned seed{1};
};

class MovableWorld {
  public:
    MovableWorld(const Model& model, const MovableOptions& options)
        : model_(model)
        , options_(options)
        , random_(options.seed)
        , data_(std::make_unique<Data>())
        , next_(std::make_unique<Neighborhood>()) {
        reset(model_, *data_, Pose::Zero());
    }

    /// Adds a body to the environment; returns it for more settings and its pieces to be added to bodies().
    Body& add(std::uint64_t id, double mass, double inertia, const Pose& pose, const Surface& surface,
              const Convex& shape) {
        Body& b = next_->bodies.body[static_cast<std::size_t>(
            shared::add_body(next_->bodies, id, BodyKind::movable, surface, pose))];
        b.mass = mass;
        b.inertia = inertia;
        shared::add_piece(next_->bodies, shape);
        taken_.push_back({0, Wrench::Zero()});
        return b;
    }
    void add_fixed(std::uint64_t id, const Surface& surface, const Convex& shape) {
        shared::add_body(next_->bodies, id, BodyKind::fixed, surface, Pose::Zero());
        shared::add_piece(next_->bodies, shape);
        taken_.push_back({0, Wrench::Zero()});
    }

    /// One tick of the environment and the haptic steps of that time.
    void tick() {
        const double length = 1.0 / options_.rate;
        if (options_.order == TickOrder::push_move_publish) {
            if (next_->sequence > 0) {
                push();
                move(length);
                echo(report_);
            }
            publish();
        } else {
            echo(given_);
            publish();
            push();
            given_ = report_;
            move(length);
        }
        run(length);
    }
    /// The haptic steps of a tick of which nothing is heard, but for the very first snapshot.
    void coast() {
        if (next_->sequence == 0)
            publish();
        run(1.0 / options_.rate);
    }

    /// Linear momentum of the tool and, of every movable, what the environment has and has yet to be given.
    [[nodiscard]] Vec2 momentum() const {
        Vec2 p = model_.tool.mass * data_->velocity.head<2>();
        for (std::int32_t i = 0; i < next_->bodies.body_count; ++i) {
            const Body& b = next_->bodies.body[static_cast<std::size_t>(i)];
            if (b.kind != BodyKind::movable)
                continue;
            p += b.mass * b.velocity.head<2>();
            if (const MovableState* m = state(b.id))
                p += (m->belief.given - taken_[static_cast<std::size_t>(i)].given).head<2>();
        }
        return p;
    }
    /// The same with what the local model believes.
    [[nodiscard]] Vec2 believed_momentum() const {
        Vec2 p = model_.tool.mass * data_->velocity.head<2>();
        for (std::int32_t i = 0; i < next_->bodies.body_count; ++i) {
            const Body& b = next_->bodies.body[static_cast<std::size_t>(i)];
            const MovableState* m = state(b.id);
            if (b.kind == BodyKind::movable)
                p +=
                    b.mass * (m != nullptr ? Vec2(m->belief.velocity.head<2>()) : Vec2(b.velocity.head<2>()));
        }
        return p;
    }

    [[nodiscard]] const MovableState* state(std::uint64_t id) const {
        for (std::int32_t i = 0; i < data_->movable_count; ++i)
            if (data_->movable[static_cast<std::size_t>(i)].belief.id == id)
                return &data_->movable[static_cast<std::size_t>(i)];
        return nullptr;
    }
    [[nodiscard]] Data& data() { return *data_; }
    [[nodiscard]] Body& body(std::size_t i) { return next_->bodies.body[i]; }
    void set_gravity(const Vec2& gravity) { next_->gravity = gravity; }
    [[nodiscard]] BodySet& bodies() { return next_->bodies; }

    /// Moves the bodies by `length` s; freely unless set otherwise.
    std::function<void(MovableWorld&, double)> mover;
    std::function<void(MovableWorld&)> before_step;
    std::function<void(MovableWorld&)> after_step;
    HandInput hand;
    StepOutput output;

  private:
    struct Taken {
        std::uint64_t epoch;
        Wrench given;
    };
    struct Report {
        std::uint64_t step{0};
        std::vector<MovableBelief> belief;
    };

    void run(double length) {
        time_ += length;
        while (data_->time + 0.5 * options_.step < time_) {
            if (before_step)
                before_step(*this);
            step(model_, *data_, hand, options_.step, output);
            if (after_step)
                after_step(*this);
        }
    }

    // reads the newest report, unless it is lost, and gives its impulses to the bodies
    void push() {
        std::uniform_real_distribution<double> unit(0.0, 1.0);
        if (unit(random_) < options_.lost)
            return;
        report_.step = data_->step;
        report_.belief.clear();
        for (std::int32_t i = 0; i < data_->movable_count; ++i)
            report_.belief.push_back(data_->movable[static_cast<std::size_t>(i)].belief);
        for (const MovableBelief& m : report_.belief)
            for (std::int32_t i = 0; i < next_->bodies.body_count; ++i) {
                Body& b = next_->bodies.body[static_cast<std::size_t>(i)];
                if (b.id != m.id)
                    continue;
                Taken& t = taken_[static_cast<std::size_t>(i)];
                if (t.epoch != m.epoch)
                    t = {m.epoch, Wrench::Zero()};
                const Wrench push = m.given - t.given;
                t.given = m.given;
                b.velocity += push.cwiseQuotient(Vec3(b.mass, b.mass, b.inertia));
            }
    }

    void move(double length) {
        if (mover) {
            mover(*this, length);
            return;
        }
        for (std::int32_t i = 0; i < next_->bodies.body_count; ++i) {
            Body& b = next_->bodies.body[static_cast<std::size_t>(i)];
            if (b.kind == BodyKind::movable)
                b.pose += length * b.velocity;
        }
    }

    void echo(const Report& report) {
        next_->echo_step = report.step;
        next_->echo_count = static_cast<std::int32_t>(report.belief.size());
        std::copy(report.belief.begin(), report.belief.end(), next_->echo.begin());
    }

    void publish() {
        ++next_->sequence;
        next_->time = time_;
        next_->tick = 1.0 / options_.rate;
        take_neighborhood(*next_, *data_);
    }

    Model model_;
    MovableOptions options_;
    std::mt19937 random_;
    std::unique_ptr<Data> data_;
    std::unique_ptr<Neighborhood> next_;
    std::vector<Taken> taken_;
    Report report_;
    Report given_;
    double time_{0.0};
};

} // namespace haptics::late
