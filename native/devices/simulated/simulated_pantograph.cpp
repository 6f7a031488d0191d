// Motion of the handle, M(q) v' + c(q, v) = F with F = motors + hand + gravity - viscous, then Coulomb
// friction. One sub-step h:
//   q_m = q + h/2 v;   v_p = v + h/2 a(q_m, v);   v' = v + h a(q_m, v_p);   q' = q_m + h/2 v'.
// For forces that depend on q only that is the Verlet scheme (symplectic, second order); velocity-dependent
// forces are second order too. Coulomb friction takes at most its impulse out of v', and stops the handle
// when less is left: the handle truly sticks. Sub-steps are equal parts of dt no longer than
// options.sub_step; sample times add up in whole steps, so runs repeat bit for bit.
//
// Bounds: when a sub-step ends outside, the velocity loses its part along the outward normal (in the M-norm:
// an inelastic stop) and the handle is moved back along that normal. If it still is outside, the sub-step is
// undone and the handle stands.
//
// Coulomb friction at the joints (linkage model): each joint i takes an impulse |p_i| <= h f out of its rate
// g_i v, one after the other until nothing changes: v += M^-1 g_i^T dp_i, dp_i = -g_i v / (g_i M^-1 g_i^T)
// cut to what is left of the bound. The fixed point is the greatest loss of energy, so joints truly stick.
//
// The force between hand and handle is the muscles' force less what accelerates the hand's own mass.

#include <haptics/core/pantograph/inertia.hpp>
#include <haptics/core/pantograph/torque_map.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptics {

namespace {

// least distance that the stop keeps from the edge of reach (m) and least singularity measure
constexpr double k_edge = 0.5e-3;
constexpr double k_least_singularity = 0.05;

const SimulatedPantographOptions& checked(const SimulatedPantographOptions& options) {
    const std::vector<FigureError> errors = validate(options);
    if (!errors.empty())
        throw std::invalid_argument(errors.front().message());
    return options;
}

// takes at most `impulse` per `mass` out of a velocity, and no more than all of it
double slowed(double speed, double impulse, double mass) {
    return speed > 0.0 ? std::max(0.0, 1.0 - impulse / (mass * speed)) : 0.0;
}

// to the nearest multiple of `step`
double rounded(double value, double step) {
    return step > 0.0 ? std::round(value / step) * step : value;
}

} // namespace

std::vector<FigureError> validate(const SimulatedPantographOptions& options) {
    FigureCheck check;
    check.append(validate(options.geometry));
    check.range("mass", options.mass, 0.001, 100.0, "kg",
                "Give the handle's mass in kilograms; 0.3 is usual.");
    check.range("inertia", options.inertia, 1.0e-7, 10.0, "kg m^2",
                "Give the handle's inertia in kg m^2; 3e-4 is usual.");
    check.range("viscous_friction", options.viscous_friction, 0.0, 1.0e3, "N s/m", "Use 0 for none.");
    check.range("rotation_viscous_friction", options.rotation_viscous_friction, 0.0, 10.0, "N m s/rad",
                "Use 0 for none.");
    check.range("coulomb_friction", options.coulomb_friction, 0.0, 100.0, "N", "Use 0 for none.");
    check.range("rotation_coulomb_friction", options.rotation_coulomb_friction, 0.0, 10.0, "N m",
                "Use 0 for none.");
    for (int axis = 0; axis < 2; ++axis)
        check.range(axis == 0 ? "gravity.x" : "gravity.y", options.gravity[axis], -50.0, 50.0, "m/s^2",
                    "Use 0 for a device that lies flat.");
    for (int axis = 0; axis < 3; ++axis) {
        const char* unit = axis == 2 ? "rad" : "m";
        check.range(axis == 2 ? "encoder_angle_step" : "encoder_step", options.encoder_resolution[axis], 0.0,
                    0.1, unit, "Use 1e-6 to 1e-4, or 0 for none.");
        check.range("noise", options.noise[axis], 0.0, 0.1, unit, "Use 0 for none.");
    }
    check.range("command_delay_steps", options.command_delay_steps, 0.0, 1000.0, "steps", "Use 0 for none.");
    check.range("command_delay", options.command_delay, 0.0, 1.0, "s", "Use 0 for none.");
    check.range("reading_delay_steps", options.reading_delay_steps, 0.0, 1000.0, "steps", "Use 0 for none.");
    check.range("sub_step", options.sub_step, 1.0e-6, 1.0e-3, "s", "Use 2e-5.");
    check.append(validate(options.hand));
    return check.take();
}

SimulatedPantograph::SimulatedPantograph(const SimulatedPantographOptions& options)
    : options_(checked(options))
    , kinematics_(options.geometry)
    , hand_(options.hand, options.hand.mass + handle_mass(options.geometry.home)(0, 0),
            options.hand.inertia + handle_mass(options.geometry.home)(2, 2), options.geometry.home)
    , command_steps_(static_cast<std::size_t>(options.command_delay_steps), Command{})
    , command_time_(options.command_delay)
    , readings_(static_cast<std::size_t>(options.reading_delay_steps), Sample{})
    , random_(options.seed)
    , pose_(options.geometry.home)
    , measured_(options.geometry.home) {
    readings_.fill(exactly());
}

Mat3 SimulatedPantograph::handle_mass(const Pose& pose) const {
    if (options_.inertia_model == InertiaModel::linkage)
        return handle_mass_matrix(kinematics_, kinematics_.locate(pose));
    return Vec3(options_.mass, options_.mass, options_.inertia).asDiagonal();
}

SimulatedPantograph::Sample SimulatedPantograph::exactly() const {
    Sample sample{pose_, JointVector::Zero()};
    kinematics_.inverse(pose_, sample.angles);
    return sample;
}

SimulatedPantograph::Sample SimulatedPantograph::measure() {
    Sample sample{pose_, JointVector::Zero()};
    if (options_.encoder_model == EncoderModel::joint) {
        sample = exactly();
        for (int i = 0; i < kinematics_.motors(); ++i) {
            const double count = std::round(kinematics_.count_of_angle(i, sample.angles[i])) + slip_[i];
            sample.angles[i] = kinematics_.angle_of_count(i, count);
        }
        const PoseEstimate estimate = kinematics_.forward(sample.angles);
        residual_ = estimate.residual;
        // as a driver does: angles that are no pose leave the last one
        if (estimate.valid)
            measured_ = estimate.pose;
        sample.pose = measured_;
        return sample;
    }
    std::normal_distribution<double> normal;
    for (int axis = 0; axis < 3; ++axis) {
        if (options_.noise[axis] > 0.0)
            sample.pose[axis] += options_.noise[axis] * normal(random_);
        if (options_.encoder_model == EncoderModel::handle)
            sample.pose[axis] = rounded(sample.pose[axis], options_.encoder_resolution[axis]);
    }
    if (freedoms() == 2)
        sample.pose.z() = 0.0;
    return sample;
}

bool SimulatedPantograph::read(DeviceReading& reading) {
    const Sample sample = readings_.push(measure());
    reading.pose = sample.pose;
    reading.angles = sample.angles;
    reading.has_angles = options_.encoder_model == EncoderModel::joint;
    reading.velocity = options_.measures_velocity ? twist_ : Twist(Twist::Zero());
    reading.has_velocity = options_.measures_velocity;
    reading.hand_force = options_.measures_force ? hand_force_ : Wrench(Wrench::Zero());
    reading.has_hand_force = options_.measures_force;
    reading.buttons = buttons_;
    reading.homings = homings_;
    reading.sequence = ++sequence_;
    return true;
}

void SimulatedPantograph::slip_encoder(int axis, double counts) {
    if (axis >= 0 && axis < kinematics_.motors() && std::isfinite(counts))
        slip_[axis] += std::round(counts);
}

void SimulatedPantograph::write(const Wrench& force) {
    Command given;
    given.wrench = force.allFinite() ? force : Wrench(Wrench::Zero());
    written_ = given.wrench;
    if (freedoms() == 2)
        given.wrench.z() = 0.0;
    const bool linkage = options_.inertia_model == InertiaModel::linkage;
    if (options_.limit_motors || linkage) {
        const TorqueSolution solution = joint_torques(kinematics_, kinematics_.locate(pose_), given.wrench);
        given.torque = solution.torque;
        if (options_.limit_motors)
            given.wrench *= solution.scale;
        else if (solution.scale > 0.0)
            given.torque /= solution.scale;
    }
    command_time_.put(time_, command_steps_.push(given));
}

void SimulatedPantograph::advance(double dt) {
    if (!std::isfinite(dt) || !(dt > 0.0))
        return;
    const double parts = std::max(1.0, std::ceil(dt / options_.sub_step - 1.0e-6));
    const double h = dt / parts;
    const double start = time_;
    for (double k = 0.0; k < parts; k += 1.0) {
        time_ = start + k * h;
        sub_step(h);
    }
    time_ = start + dt;
}

void SimulatedPantograph::sub_step(double h) {
    const Command& command = command_time_.get(time_, 0.5 * h);
    motor_force_ = command.wrench;
    hand_.advance(time_ + 0.5 * h);
    const Pose before = pose_;
    const Twist was = twist_;
    const Pose middle = pose_ + 0.5 * h * twist_;

    // inertia: handle (and links), plus the hand's own
    const bool linkage = options_.inertia_model == InertiaModel::linkage;
    PantographState state;
    Mat3 mass = Vec3(options_.mass, options_.mass, options_.inertia).asDiagonal();
    Mat3 drag = Vec3(options_.viscous_friction, options_.viscous_friction, options_.rotation_viscous_friction)
                    .asDiagonal();
    Wrench steady = motor_force_;
    if (linkage) {
        state = kinematics_.locate(middle);
        mass = handle_mass_matrix(kinematics_, state);
        motor_force_ = state.rates.transpose() * command.torque;
        drag += options_.geometry.motor.viscous_friction * state.rates.transpose() * state.rates;
        steady = motor_force_;
        steady += gravity_wrench(kinematics_, state, options_.gravity);
    } else {
        steady.head<2>() += options_.mass * options_.gravity;
    }
    const Vec3 hand_mass(options_.hand.mass, options_.hand.mass, options_.hand.inertia);
    mass.diagonal() += hand_mass;
    const Mat3 mobility = mass.inverse();
    const auto acceleration = [&](const Twist& twist) -> Twist {
        Wrench force = steady + hand_.force(middle, twist) - drag * twist;
        if (linkage)
            force -= velocity_wrench(kinematics_, state, twist);
        Twist result = mobility * force;
        if (freedoms() == 2)
            result.z() = 0.0;
        return result;
    };
    const Twist predicted = was + 0.5 * h * acceleration(was);
    twist_ = was + h * acceleration(predicted);

    // Coulomb friction
    if (linkage && options_.geometry.motor.coulomb_friction > 0.0)
        rub_joints(state, mobility, h);
    twist_.head<2>() *=
        slowed(twist_.head<2>().norm(), h * options_.coulomb_friction, 0.5 * (mass(0, 0) + mass(1, 1)));
    twist_.z() *= slowed(std::abs(twist_.z()), h * options_.rotation_coulomb_friction, mass(2, 2));

    pose_ = middle + 0.5 * h * twist_;
    if (options_.bounded)
        hold_inside(before, mobility);
    if (!pose_.allFinite() || !twist_.allFinite()) {
        pose_ = before;
        twist_.setZero();
    }
    hand_force_ = hand_.force(pose_, twist_) - hand_mass.cwiseProduct(twist_ - was) / h;
}

void SimulatedPantograph::rub_joints(const PantographState& state, const Mat3& mobility, double h) {
    const double most = h * options_.geometry.motor.coulomb_friction;
    // the last sub-step's impulses are nearly this one's
    rubbing_ = rubbing_.cwiseMax(-most).cwiseMin(most);
    twist_ += mobility * (state.rates.transpose() * rubbing_);
    constexpr int k_sweeps = 20;
    for (int sweep = 0; sweep < k_sweeps; ++sweep) {
        double change = 0.0;
        for (int i = 0; i < kinematics_.motors(); ++i) {
            const Eigen::RowVector3d joint = state.rates.row(i);
            const Vec3 response = mobility * joint.transpose();
            const double lightness = joint * response;
            if (!(lightness > 0.0))
                continue;
            const double wanted = std::clamp(rubbing_[i] - joint.dot(twist_) / lightness, -most, most);
            const double given = wanted - rubbing_[i];
            rubbing_[i] = wanted;
            twist_ += given * response;
            change = std::max(change, std::abs(given));
        }
        if (change < 1.0e-4 * most)
            break;
    }
    if (freedoms() == 2)
        twist_.z() = 0.0;
}

double SimulatedPantograph::room(const Pose& pose) const {
    const WorkspaceReport report = kinematics_.workspace(pose);
    const double length = freedoms() == 3 ? kinematics_.characteristic_length() : 1.0;
    const double least = std::min({report.reach_margin - k_edge, report.rotation_margin * length,
                                   (report.singularity - k_least_singularity) * 0.1});
    return report.inside ? least : std::min(least, -1.0e-9);
}

void SimulatedPantograph::hold_inside(const Pose& before, const Mat3& mobility) {
    const double inside = room(pose_);
    if (inside >= 0.0)
        return;
    // outward normal by differences
    Vec3 slope = Vec3::Zero();
    constexpr double k_step = 1.0e-7;
    for (int axis = 0; axis < freedoms(); ++axis) {
        Pose ahead = pose_;
        Pose behind = pose_;
        ahead[axis] += k_step;
        behind[axis] -= k_step;
        slope[axis] = (room(ahead) - room(behind)) / (2.0 * k_step);
    }
    const Vec3 response = mobility * slope;
    const double size = slope.dot(response);
    const double rate = slope.dot(twist_);
    if (size > 0.0 && std::isfinite(size)) {
        if (rate < 0.0)
            twist_ -= response * (rate / size);
        pose_ -= response * (inside / size) * 1.001;
    }
    if (!(room(pose_) >= 0.0)) {
        pose_ = before;
        twist_.setZero();
    }
}

bool SimulatedPantograph::place(const Pose& pose, const Twist& twist) {
    if (!pose.allFinite() || !twist.allFinite() || room(pose) < 0.0)
        return false;
    pose_ = pose;
    twist_ = twist;
    if (freedoms() == 2) {
        pose_.z() = 0.0;
        twist_.z() = 0.0;
    }
    hand_.restart(time_, pose_);
    measured_ = pose_;
    rubbing_.setZero();
    readings_.fill(exactly());
    return true;
}

} // namespace haptics
