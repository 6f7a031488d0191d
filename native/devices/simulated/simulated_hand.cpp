// Muscles: F = k (x_w - x) + b (v_w - v), cut to max_force as a vector, the torque on its own; b = 2 zeta
// sqrt(k m) with m the mass that hand and handle move together, so that zeta = 1 is critical for what really
// moves.

#include <haptics/devices/simulated/simulated_hand.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace haptics {

SimulatedHandOptions mouse_hand() {
    SimulatedHandOptions options;
    options.kind = HandKind::target;
    options.mass = 0.15;
    options.inertia = 1.0e-4;
    return options;
}

SimulatedHandOptions pushing_hand(const Wrench& force, double start_time) {
    SimulatedHandOptions options;
    options.kind = HandKind::constant_force;
    options.force = force;
    options.start_time = start_time;
    return options;
}

SimulatedHandOptions path_hand(std::vector<HandTarget> path, PathInterpolation interpolation, bool repeat) {
    SimulatedHandOptions options;
    options.kind = HandKind::recorded_path;
    options.mass = 0.15;
    options.inertia = 1.0e-4;
    options.stiffness = 1000.0;
    options.path = std::move(path);
    options.interpolation = interpolation;
    options.repeat = repeat;
    return options;
}

std::vector<FigureError> validate(const SimulatedHandOptions& options) {
    FigureCheck check("hand.");
    check.range("mass", options.mass, 0.0, 10.0, "kg",
                "Give the mass of the hand in kilograms; 0.15 is usual.");
    check.range("inertia", options.inertia, 0.0, 0.1, "kg m^2", "Give the inertia in kg m^2; 1e-4 is usual.");
    check.range("stiffness", options.stiffness, 0.0, 1.0e5, "N/m", "Use 50 to 2000 for a hand.");
    check.range("rotation_stiffness", options.rotation_stiffness, 0.0, 1.0e3, "N m/rad",
                "Use about 0.5 for a hand.");
    check.range("damping_ratio", options.damping_ratio, 0.0, 10.0, "", "Use 1 for critical damping.");
    check.range("max_force", options.max_force, 0.0, 1.0e3, "N", "Use about 8 N for a hand.");
    check.range("max_torque", options.max_torque, 0.0, 100.0, "N m", "Use about 0.2 N m for a hand.");
    for (int axis = 0; axis < 3; ++axis)
        check.range(axis == 0   ? "force.x"
                    : axis == 1 ? "force.y"
                                : "force.torque",
                    options.force[axis], -1.0e3, 1.0e3, axis == 2 ? "N m" : "N",
                    "A hand pushes with a few newtons.");
    check.range("start_time", options.start_time, 0.0, 1.0e6, "s",
                "Give the time in seconds from the start.");
    if (options.kind != HandKind::recorded_path)
        return check.take();
    if (options.path.empty())
        check.inconsistent("path", 0.0, 1.0, 1.0e9, "points", "Give the path at least one point.");
    for (std::size_t i = 0; i < options.path.size() && check.good(); ++i) {
        const HandTarget& point = options.path[i];
        const std::string name = "path[" + std::to_string(i) + "]";
        const double after = i == 0 ? -1.0e6 : options.path[i - 1].time_s + 1.0e-9;
        check.range((name + ".time_s").c_str(), point.time_s, after, 1.0e9, "s",
                    "Let times grow from point to point.");
        for (int axis = 0; axis < 3; ++axis)
            check.range((name + ".pose").c_str(), point.pose[axis], axis == 2 ? -1.0e3 : -10.0,
                        axis == 2 ? 1.0e3 : 10.0, axis == 2 ? "rad" : "m",
                        "Give poses in meters and radians.");
    }
    return check.take();
}

SimulatedHand::SimulatedHand(const SimulatedHandOptions& options, double moved_mass, double moved_inertia,
                             const Pose& start)
    : options_(options)
    , path_(options.path, options.interpolation, options.repeat)
    , stiffness_(options.stiffness)
    , damping_(2.0 * options.damping_ratio * std::sqrt(options.stiffness * moved_mass))
    , rotation_stiffness_(options.rotation_stiffness)
    , rotation_damping_(2.0 * options.damping_ratio * std::sqrt(options.rotation_stiffness * moved_inertia)) {
    wish_.pose = start;
    follower_.reset(0.0, start);
}

void SimulatedHand::restart(double time, const Pose& pose) {
    follower_.reset(time, pose);
    if (options_.kind != HandKind::recorded_path)
        wish_ = {pose, Twist::Zero()};
}

void SimulatedHand::set_force(const Wrench& force) {
    if (force.allFinite())
        options_.force = force;
}

void SimulatedHand::set_grip(double stiffness, double damping) {
    if (std::isfinite(stiffness) && std::isfinite(damping) && stiffness >= 0.0 && damping >= 0.0) {
        stiffness_ = stiffness;
        damping_ = damping;
    }
}

void SimulatedHand::set_rotation_grip(double stiffness, double damping) {
    if (std::isfinite(stiffness) && std::isfinite(damping) && stiffness >= 0.0 && damping >= 0.0) {
        rotation_stiffness_ = stiffness;
        rotation_damping_ = damping;
    }
}

void SimulatedHand::advance(double time) {
    switch (options_.kind) {
    case HandKind::none:
        break;
    case HandKind::constant_force:
        pushing_ = time >= options_.start_time;
        break;
    case HandKind::recorded_path:
        wish_ = path_.sample(time);
        break;
    case HandKind::target:
        follower_.advance(time);
        wish_ = {follower_.pose(), follower_.velocity()};
        break;
    }
}

Wrench SimulatedHand::force(const Pose& pose, const Twist& twist) const {
    if (options_.kind == HandKind::none)
        return Wrench::Zero();
    if (options_.kind == HandKind::constant_force)
        return pushing_ ? options_.force : Wrench(Wrench::Zero());
    const Pose off = wish_.pose - pose;
    const Twist slip = wish_.velocity - twist;
    Vec2 force = stiffness_ * off.head<2>() + damping_ * slip.head<2>();
    const double size = force.norm();
    if (size > options_.max_force)
        force *= options_.max_force / size;
    const double torque = rotation_stiffness_ * off.z() + rotation_damping_ * slip.z();
    return {force.x(), force.y(), std::clamp(torque, -options_.max_torque, options_.max_torque)};
}

} // namespace haptics
