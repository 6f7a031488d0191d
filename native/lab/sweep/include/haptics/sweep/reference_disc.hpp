#pragma once
/// An independent reference for linear contact: a disc among straight walls, held by a spring-damper, in tiny
/// steps of the classical Runge-Kutta method between events that are found by halving. Its normals do not
/// turn, and its inertia is taken so large that it does not turn itself (the lever of friction changes with
/// the gap), so that the only error is the time step's. Nothing here is shared with the code under test but
/// the contact law, which is written down again.

#include <haptics/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace haptics::sweep {

/// A wall, its contact law and its present state.
struct ReferenceWall {
    Vec2 point;
    Vec2 normal;
    double stiffness;
    double damping;
    double static_friction;
    double dynamic_friction;
    // state
    bool pressing{false};
    // 0 off, 1 stick, 2 slip with force +, 3 slip with force -
    int mode{0};
    double anchor{0.0};
    // integrals of the forces since the last clear()
    Vec2 impulse{0.0, 0.0};
    // share of the normal speed that a collision gives back, when there are collision impulses
    double restitution{0.0};
};

/// The disc; `pose`, `velocity` and `walls` are set by the user.
class ReferenceDisc {
  public:
    /// kg, m.
    double mass;
    double radius;
    Vec3 pose{0.0, 0.0, 0.0};
    Vec3 velocity{0.0, 0.0, 0.0};
    Vec2 gravity{0.0, 0.0};
    std::vector<ReferenceWall> walls;
    Vec3 spring{0.0, 0.0, 0.0};
    Vec3 damper{0.0, 0.0, 0.0};
    Vec3 target{0.0, 0.0, 0.0};
    Vec3 target_velocity{0.0, 0.0, 0.0};
    Vec3 coupling_impulse{0.0, 0.0, 0.0};
    /// Where the hand is at a time, instead of a target of constant velocity.
    std::function<void(double time, Vec3& target, Vec3& velocity)> path;
    double time{0.0};
    /// Touches that close faster than this give a collision impulse (without friction), m/s; negative: none.
    double collision_speed{-1.0};
    int events{0};
    // the law was at a tie, which rounding decides
    bool tie{false};

    void clear() {
        coupling_impulse.setZero();
        for (ReferenceWall& w : walls)
            w.impulse.setZero();
    }

    /// Goes on by `duration` (s) in steps of at most `h` (s).
    void advance(double duration, double h) {
        settle();
        while (duration > 0.0) {
            const double step = std::min(h, duration);
            const State start = state();
            runge_kutta(step);
            if (which_ended() < 0) {
                duration -= step;
                continue;
            }
            double low = 0.0;
            double high = step;
            for (int i = 0; i < 60; ++i) {
                const double middle = 0.5 * (low + high);
                put(start);
                runge_kutta(middle);
                (which_ended() < 0 ? low : high) = middle;
            }
            put(start);
            runge_kutta(high);
            duration -= high;
            change(which_ended());
            ++events;
            settle();
        }
    }

  private:
    // x, v, impulse of coupling, impulses of walls
    static constexpr int k_most = 13 + 2 * 6;
    using State = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, k_most, 1>;

    [[nodiscard]] State state() const {
        State s(13 + 2 * static_cast<Eigen::Index>(walls.size()));
        s.head<13>() << pose, velocity, coupling_impulse, target, time;
        for (std::size_t i = 0; i < walls.size(); ++i)
            s.segment<2>(13 + 2 * static_cast<Eigen::Index>(i)) = walls[i].impulse;
        return s;
    }
    void put(const State& s) {
        pose = s.segment<3>(0);
        velocity = s.segment<3>(3);
        coupling_impulse = s.segment<3>(6);
        target = s.segment<3>(9);
        time = s[12];
        if (path)
            path(time, target, target_velocity);
        for (std::size_t i = 0; i < walls.size(); ++i)
            walls[i].impulse = s.segment<2>(13 + 2 * static_cast<Eigen::Index>(i));
    }
    void runge_kutta(double h) {
        const State s = state();
        const State k1 = derivative();
        put(s + 0.5 * h * k1);
        const State k2 = derivative();
        put(s + 0.5 * h * k2);
        const State k3 = derivative();
        put(s + h * k3);
        const State k4 = derivative();
        put(s + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
    }

    [[nodiscard]] double gap(const ReferenceWall& w) const {
        return w.normal.dot(pose.head<2>() - w.point) - radius;
    }
    [[nodiscard]] double gap_rate(const ReferenceWall& w) const { return w.normal.dot(velocity.head<2>()); }
    // displacement and speed of the disc's surface along the wall
    [[nodiscard]] double along(const ReferenceWall& w) const {
        return perpendicular(w.normal).dot(pose.head<2>());
    }
    [[nodiscard]] double slip_speed(const ReferenceWall& w) const {
        return perpendicular(w.normal).dot(velocity.head<2>());
    }
    [[nodiscard]] double raw_normal(const ReferenceWall& w) const {
        return -w.stiffness * gap(w) - w.damping * gap_rate(w);
    }
    [[nodiscard]] double normal(const ReferenceWall& w) const { return w.pressing ? raw_normal(w) : 0.0; }
    [[nodiscard]] double trial(const ReferenceWall& w) const {
        return -w.stiffness * (along(w) - w.anchor) - w.damping * slip_speed(w);
    }
    [[nodiscard]] double tangent(const ReferenceWall& w) const {
        switch (w.mode) {
        case 1:
            return trial(w);
        case 2:
            return w.dynamic_friction * normal(w);
        case 3:
            return -w.dynamic_friction * normal(w);
        default:
            return 0.0;
        }
    }
    [[nodiscard]] Vec3 coupling() const {
        return spring.cwiseProduct(target - pose) + damper.cwiseProduct(target_velocity - velocity);
    }
    [[nodiscard]] Vec3 acceleration() const {
        Vec3 force = coupling();
        force.head<2>() += mass * gravity;
        for (const ReferenceWall& w : walls) {
            const Vec2 f = normal(w) * w.normal + tangent(w) * perpendicular(w.normal);
            force.head<2>() += f;
        }
        return {force.x() / mass, force.y() / mass, 0.0};
    }
    [[nodiscard]] State derivative() const {
        State d = State::Zero(13 + 2 * static_cast<Eigen::Index>(walls.size()));
        d.segment<3>(0) = velocity;
        d.segment<3>(3) = acceleration();
        d.segment<3>(6) = coupling();
        d.segment<3>(9) = target_velocity;
        d[12] = 1.0;
        for (std::size_t i = 0; i < walls.size(); ++i)
            d.segment<2>(13 + 2 * static_cast<Eigen::Index>(i)) = Vec2(normal(walls[i]), tangent(walls[i]));
        return d;
    }

    // rate of the normal force
    [[nodiscard]] double normal_rate(const ReferenceWall& w) const {
        const Vec3 a = acceleration();
        return w.pressing ? -w.stiffness * gap_rate(w) - w.damping * w.normal.dot(a.head<2>()) : 0.0;
    }

    // how well the mode of a wall holds: negative when it has ended. Two numbers per wall: pressing,
    // friction.
    [[nodiscard]] double pressing_holds(const ReferenceWall& w) const {
        return w.pressing ? raw_normal(w) : std::max(gap(w) * w.stiffness, -raw_normal(w));
    }
    [[nodiscard]] double friction_holds(const ReferenceWall& w) const {
        if (w.mode == 0)
            return 0.0;
        if (w.mode == 1)
            return w.static_friction * normal(w) - std::abs(trial(w));
        const double sign = w.mode == 2 ? 1.0 : -1.0;
        const double anchor = -sign * slip_speed(w) * w.stiffness - w.dynamic_friction * normal_rate(w);
        const double beyond =
            -sign * w.damping * slip_speed(w) - (w.static_friction - w.dynamic_friction) * normal(w);
        return beyond > 0.0 ? std::max(anchor, beyond) : anchor;
    }
    // first wall (times two, plus one for friction) whose mode has ended; -1 when all hold
    [[nodiscard]] int which_ended() const {
        for (std::size_t i = 0; i < walls.size(); ++i) {
            if (pressing_holds(walls[i]) < 0.0)
                return 2 * static_cast<int>(i);
            if (friction_holds(walls[i]) < 0.0)
                return 2 * static_cast<int>(i) + 1;
        }
        return -1;
    }
    void change(int which) {
        if (which < 0)
            return;
        ReferenceWall& w = walls[static_cast<std::size_t>(which / 2)];
        if (which % 2 == 0) {
            const double speed = -gap_rate(w);
            if (!w.pressing && collision_speed >= 0.0 && speed > collision_speed) {
                const double change = (1.0 + w.restitution) * speed;
                velocity.head<2>() += change * w.normal;
                w.impulse.x() += mass * change;
                if (w.restitution > 0.0)
                    return;
            }
            w.pressing = !w.pressing;
            w.mode = w.pressing && w.static_friction > 0.0 ? 1 : 0;
            w.anchor = along(w);
            return;
        }
        if (w.mode == 1) {
            w.mode = trial(w) > 0.0 ? 2 : 3;
            return;
        }
        w.anchor = along(w) + tangent(w) / w.stiffness;
        w.mode = 1;
    }
    // what has just changed may end at once (a touch that slips from its first moment): the modes must hold a
    // moment later
    void settle() {
        constexpr double k_moment = 1e-10;
        for (int i = 0; i < 20; ++i) {
            const State start = state();
            runge_kutta(k_moment);
            const int ended = which_ended();
            put(start);
            if (ended < 0)
                return;
            change(ended);
        }
        tie = true;
    }
};

} // namespace haptics::sweep
