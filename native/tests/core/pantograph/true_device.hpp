#pragma once
/// A pantograph as it is, not as its figures say, moved along a given path by a hand that holds it as firmly
/// as need be: the energy that the hand has to give comes from the parts' kinetic and potential energy, the
/// heat of friction and the work of the held wrench, none of it from the code under test.

#include <haptics/core/pantograph/compensation.hpp>
#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <vector>

#include "core/pantograph/random_geometry.hpp"

namespace haptics::testing {

/// The figures with every mass, inertia and friction off by up to `error`, at its ends more often than not.
inline PantographGeometry with_model_error(PantographGeometry g, Random& random, double error) {
    const auto off = [&](double& value) {
        const int end = random.below(3);
        value *= end == 0 ? 1.0 - error : end == 1 ? 1.0 + error : random.uniform(1.0 - error, 1.0 + error);
    };
    for (FiveBarGeometry& bar : g.bar) {
        off(bar.proximal_mass);
        off(bar.distal_mass);
        off(bar.proximal_inertia);
        off(bar.distal_inertia);
    }
    off(g.handle_mass);
    off(g.handle_inertia);
    off(g.motor.rotor_inertia);
    off(g.motor.viscous_friction);
    off(g.motor.coulomb_friction);
    return g;
}

/// A closed path through the middle of the workspace, at rest at both ends.
struct ClosedPath {
    /// Points it rests at, and how long each move takes (s); minimum-jerk moves between.
    std::vector<Pose> point;
    std::vector<double> time;
    /// On top: a shaking that begins and ends at rest, amplitude (m, m, rad) and frequency (Hz).
    Pose shake{0.0, 0.0, 0.0};
    double frequency{0.0};

    [[nodiscard]] double duration() const {
        double sum = 0.0;
        for (const double t : time)
            sum += t;
        return sum;
    }
    [[nodiscard]] Pose at(double t) const {
        const double whole = duration();
        const double inside = std::clamp(t, 0.0, whole);
        const double window = std::sin(3.14159265358979 * inside / whole);
        const Pose shaken = shake * (window * window * std::sin(6.283185307 * frequency * inside));
        double left = inside;
        for (std::size_t i = 0; i < time.size(); ++i) {
            if (left <= time[i] || i + 1 == time.size()) {
                const double s = std::clamp(left / time[i], 0.0, 1.0);
                const double blend = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
                return point[i] + blend * (point[i + 1] - point[i]) + shaken;
            }
            left -= time[i];
        }
        return point.back() + shaken;
    }
};

/// A path of `moves` moves: leisurely ones, quick ones, sudden stops and shaking, all mixed.
inline ClosedPath random_path(const PantographKinematics& kinematics, Random& random, int moves) {
    const Pose home = kinematics.geometry().home;
    const bool turns = kinematics.freedoms() == 3;
    for (double size = 0.04;; size *= 0.85) {
        ClosedPath path;
        path.point.push_back(home);
        for (int i = 0; i < moves; ++i) {
            Pose next = home;
            if (i + 1 < moves)
                next += Pose(size * random.uniform(-1.0, 1.0), size * random.uniform(-1.0, 1.0),
                             turns ? 8.0 * size * random.uniform(-1.0, 1.0) : 0.0);
            path.point.push_back(next);
            path.time.push_back(random.below(3) == 0 ? random.uniform(0.02, 0.06) : random.uniform(0.1, 0.5));
        }
        if (random.below(2) == 0) {
            path.frequency = random.uniform(1.0, 25.0);
            const double most = std::min(0.2 * size, 0.5 / (6.28 * path.frequency));
            path.shake = Pose(most * random.uniform(-1.0, 1.0), most * random.uniform(-1.0, 1.0), 0.0);
        }
        bool clear = true;
        for (double t = 0.0; t < path.duration() && clear; t += 0.003) {
            const WorkspaceReport report = kinematics.workspace(path.at(t));
            clear = report.inside && report.reach_margin > 0.003 && report.singularity > 0.1;
        }
        if (clear)
            return path;
    }
}

/// How a device between two samples holds what it was told.
enum class Held {
    wrench, ///< the wrench at the handle
    torque, ///< the joint torques of least size for it
};

struct HandEnergy {
    /// What the hand gave in all, J: negative when the device gave it something for nothing.
    double given{0.0};
    /// The least it had given at any moment, J (weight left out).
    double least{0.0};
    /// Heat of friction, J.
    double heat{0.0};
    /// Mean and largest share of inertia compensation that was allowed.
    double allowed{0.0};
    /// Largest compensation, N.
    double most_force{0.0};
};

/// The hand moves `device` along `path` while `figures` and `settings` compensate, `rate` Hz, the force
/// `delay_steps` late.
inline HandEnergy move_along(const PantographKinematics& figures, const PantographKinematics& device,
                             const CompensationSettings& settings, const ClosedPath& path, double rate,
                             Held held, int delay_steps = 0, bool joints = true) {
    const double step = 1.0 / rate;
    const MotorFigures& motor = device.geometry().motor;
    Vec3 reading_error = Vec3::Zero();
    if (!joints)
        reading_error = Vec3(5.0e-6, 5.0e-6, 5.0e-5);
    Compensation compensation(figures, settings, reading_error);
    HandEnergy energy;
    const auto potential = [&](const Pose& pose) {
        return gravity_potential(device, pose, device.locate(pose), settings.gravity);
    };
    const double potential_at_start = potential(path.at(0.0));
    std::deque<JointVector> late(static_cast<std::size_t>(delay_steps), JointVector::Zero());
    std::deque<Wrench> late_wrench(static_cast<std::size_t>(delay_steps), Wrench::Zero());
    double work = 0.0;
    int steps = 0;
    constexpr int k_parts = 8;
    // a moment of rest at the end, for what is still on its way
    const double end = path.duration() + 0.02 + delay_steps * step;
    for (double t = 0.0; t < end; t += step, ++steps) {
        const Pose pose = path.at(t);
        JointVector angles;
        device.inverse(pose, angles);
        Wrench wrench;
        Pose measured = pose;
        if (joints) {
            for (int i = 0; i < device.motors(); ++i)
                angles[i] = figures.angle_of_count(i, std::round(figures.count_of_angle(i, angles[i])));
            measured = figures.forward(angles).pose;
            wrench = compensation.update(measured, &angles, step);
        } else {
            for (int axis = 0; axis < device.freedoms(); ++axis)
                measured[axis] =
                    std::round(pose[axis] / (2.0 * reading_error[axis])) * 2.0 * reading_error[axis];
            wrench = compensation.update(measured, nullptr, step);
        }
        energy.most_force = std::max(energy.most_force, wrench.head<2>().norm());
        energy.allowed += compensation.inertia_allowed();
        const TorqueSolution solution = joint_torques(figures, figures.locate(measured), wrench);
        late.push_back(solution.scale > 0.0 ? JointVector(solution.torque / solution.scale)
                                            : JointVector::Zero());
        late_wrench.push_back(wrench);
        const JointVector torque = late.front();
        const Wrench acting = late_wrench.front();
        late.pop_front();
        late_wrench.pop_front();
        // until the next sample
        Pose last = pose;
        JointVector last_angles;
        device.inverse(last, last_angles);
        for (int part = 1; part <= k_parts; ++part) {
            const double h = step / k_parts;
            const Pose next = path.at(t + part * h);
            JointVector next_angles;
            device.inverse(next, next_angles);
            for (int i = 0; i < device.motors(); ++i) {
                const double turned = std::remainder(next_angles[i] - last_angles[i], 6.283185307179586);
                energy.heat +=
                    motor.viscous_friction * turned * turned / h + motor.coulomb_friction * std::abs(turned);
                if (held == Held::torque)
                    work += torque[i] * turned;
            }
            if (held == Held::wrench)
                work += acting.dot(next - last);
            last = next;
            last_angles = next_angles;
        }
        const Twist twist = (path.at(t + step + 1.0e-6) - path.at(t + step - 1.0e-6)) / 2.0e-6;
        const double kinetic = 0.5 * twist.dot(handle_mass_matrix(device, device.locate(last)) * twist);
        energy.given = kinetic + potential(last) - potential_at_start + energy.heat - work;
        energy.least = std::min(energy.least, energy.given);
    }
    energy.allowed /= steps;
    return energy;
}

} // namespace haptics::testing
