#pragma once
// The grip of a rigid tool: J_h = [1 0 -r_y; 0 1 r_x; 0 0 t] with the lever r from the center of mass in
// scene axes, and t = 1 where the angle is held, else 0. And the coupling to a hand there, over a step that
// ends with the velocity v+ (integrate.cpp):
//     (D + h J_h'(h K + B) J_h) v+ = D v + h (m g + J_h'(K (x_t - x_g) + B v_t + f)).
// With D = diag(m, m, I) the matrix is an arrow, [a 0 p; 0 b q; p q c]: x and y meet only in the turn.

#include <haptics/core/local_model/local_model.hpp>

#include "hold_back.hpp"

namespace haptics::local {

// Three plain numbers: unlike small matrices, the compiler keeps them in registers.
struct Plain3 {
    double x;
    double y;
    double z;

    [[nodiscard]] double dot(const Plain3& v) const { return (x * v.x + y * v.y) + z * v.z; }
    [[nodiscard]] Vec3 vector() const { return {x, y, z}; }
};

inline Plain3 plain(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}
inline Plain3 operator+(const Plain3& a, const Plain3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Plain3 operator-(const Plain3& a, const Plain3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
// of each with each
inline Plain3 operator*(const Plain3& a, const Plain3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Plain3 operator*(double a, const Plain3& b) {
    return {a * b.x, a * b.y, a * b.z};
}

// energy of a rigid tool's motion
inline double rigid_energy(const ToolModel& tool, const Plain3& v) {
    return 0.5 * tool.mass * (v.x * v.x + v.y * v.y) + 0.5 * tool.inertia * v.z * v.z;
}

struct RigidGrip {
    // the lever
    double x;
    double y;
    bool pose;

    // J_h v
    [[nodiscard]] Plain3 velocity(const Plain3& v) const {
        return {v.x - y * v.z, v.y + x * v.z, pose ? v.z : 0.0};
    }
    // J_h' f
    [[nodiscard]] Plain3 wrench(const Plain3& f) const {
        return {f.x, f.y, x * f.y - y * f.x + (pose ? f.z : 0.0)};
    }
    // J_h D^-1 J_h'
    [[nodiscard]] Mat3 mobility(double mass, double inertia) const {
        const double turn = 1.0 / inertia;
        const double by_x = -y * turn;
        const double by_y = x * turn;
        const double held = pose ? 1.0 : 0.0;
        Mat3 m;
        m(0, 0) = 1.0 / mass - y * by_x;
        m(1, 1) = 1.0 / mass + x * by_y;
        m(2, 2) = held * turn;
        m(1, 0) = m(0, 1) = x * by_x;
        m(2, 0) = m(0, 2) = held * by_x;
        m(2, 1) = m(1, 2) = held * by_y;
        return m;
    }
};

// how the hand holds the tool
inline RigidGrip rigid_grip(const Data& data) {
    // a tool that is held at its center needs no angle
    const Vec2 lever = data.grip.point.isZero(0.0) ? data.grip.point : rotate(data.pose.z(), data.grip.point);
    return {lever.x(), lever.y(), data.grip.pose};
}

// The equation's matrix.
struct Arrow {
    double a;
    double b;
    double c;
    double p{0.0};
    double q{0.0};

    // The same operations as solve_definite for the full matrix, less those with its zeros.
    [[nodiscard]] Plain3 solve(const Plain3& right) const {
        if (p == 0.0 && q == 0.0)
            return {right.x / a, right.y / b, right.z / c};
        const double of_x = p / a;
        const double of_y = q / b;
        const double turn = (right.z - of_x * right.x - of_y * right.y) / (c - of_x * p - of_y * q);
        return {(right.x - p * turn) / a, (right.y - q * turn) / b, turn};
    }
};

// What takes effect of a coupling: a share of its springs and dampers, and a force.
struct UsedCoupling {
    double share;
    Plain3 force;
};

// A hand at a grip of a rigid tool.
class RigidCoupling {
  public:
    // `at`: the pose of the grip; `target`: of the hand at the end of the step
    RigidCoupling(const RigidGrip& grip, const Plain3& at, const Pose& target, const HandInput& hand,
                  double dt)
        : hand_(hand)
        , grip_(grip)
        , distance_(plain(target) - at)
        , stiffness_(plain(hand.stiffness))
        , damping_(plain(hand.damping))
        , target_velocity_(plain(hand.target_velocity))
        , dt_(dt) {}

    // adds what is used to the equation
    void add(const UsedCoupling& used, Arrow& matrix, Plain3& right) const {
        const Plain3 stiffness = used.share * stiffness_;
        const Plain3 damping = used.share * damping_;
        const Plain3 k = dt_ * (dt_ * stiffness + damping);
        const Plain3 push = dt_ * ((stiffness * distance_ + damping * target_velocity_) + used.force);
        const double across_x = -grip_.y * k.x;
        const double across_y = grip_.x * k.y;
        matrix.a += k.x;
        matrix.b += k.y;
        matrix.p += across_x;
        matrix.q += across_y;
        matrix.c += grip_.x * across_y - grip_.y * across_x + (grip_.pose ? k.z : 0.0);
        right = right + grip_.wrench(push);
    }

    // mean force over a step that ends with the velocity v, with a share of the springs and dampers
    [[nodiscard]] Plain3 force(double share, const Plain3& v) const {
        const Plain3 distance = distance_ - grip_.velocity(dt_ * v);
        const Plain3 rate = target_velocity_ - grip_.velocity(v);
        const Plain3 f = (share * stiffness_) * distance + (share * damping_) * rate;
        return {f.x, f.y, grip_.pose ? f.z : 0.0};
    }

    // What the coupling does over a step.
    struct Forces {
        // with all of the springs and dampers, and with what is used of them
        Plain3 full{0.0, 0.0, 0.0};
        Plain3 used{0.0, 0.0, 0.0};

        void tell(StepOutput& output) const {
            output.full_coupling = full.vector();
            output.coupling = used.vector();
        }
    };

    // Solves the step: `end(used, v)` finds the velocity v at its end with what is used of the coupling, and
    // says whether it could. Where the device cannot answer with the force of the springs, a constant force
    // of the size it can answer with takes their place.
    template <class End>
    bool solve(const End& end, Plain3& v, Forces& forces) const {
        const Plain3 hand = plain(hand_.force);
        UsedCoupling used{hand_.share, hand};
        if (!end(used, v))
            return false;
        forces.full = force(1.0, v);
        const double effective = effective_share(hand_, forces.full.vector());
        if (effective < hand_.share) {
            used = {0.0, hand + effective * forces.full};
            if (!end(used, v))
                return false;
            forces.full = force(1.0, v);
        }
        forces.used = (force(used.share, v) + used.force) - hand;
        return true;
    }

  private:
    const HandInput& hand_;
    RigidGrip grip_;
    Plain3 distance_;
    Plain3 stiffness_;
    Plain3 damping_;
    Plain3 target_velocity_;
    double dt_;
};

} // namespace haptics::local
