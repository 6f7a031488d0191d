// Derivation.
// End point of bar b: P_b = p + R(theta) a_b. Leg i (axis B, elbow E, end P): |E - B| = l, |P - E| = L, so
// that E is the intersection of two circles; elbow_side picks which. With e = E - B, d = P - E and arm r = P
// - p:
//   d . (P' - phi' perp(e)) = 0     (the distal link keeps its length)
//   phi' = d . P' / (e x d),  P' = p' + theta' perp(r)  =>  row i of the rates:  [ d_x, d_y, r x d ] / (e x
//   d).
// Power is the same on both sides, tau . phi' = F . q', hence F = rates^T tau.
// e x d = 0 is the stretched or folded arm (edge of reach). All distal lines through one point, or parallel,
// is the other singularity: rates^T, and so the matrix of unit lines [ d^, r x d^ / length ], loses rank; its
// least singular value measures it.
//
// Forward: the elbows from the angles, each end point as an intersection of circles about its two elbows
// (end_side picks), the pose from the two end points, then Gauss-Newton over the encoders, delta q = (G^T
// G)^-1 G^T (phi - phi(q)), G = rates. Angles of a real pose are a zero of that, so the iteration converges
// quadratically; what remains is the part no pose explains.

#include <haptics/core/pantograph/five_bar.hpp>
#include <haptics/core/pantograph/kinematics.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptics {

namespace {

constexpr double k_pi = std::numbers::pi;
// least |e x d| that is divided by: keeps rates finite at full stretch (m^2)
constexpr double k_least_moment = 1.0e-9;
constexpr int k_refinements = 4;
// no handle is that far away (m, rad)
constexpr double k_absurd = 1.0e6;

double wrap(double angle) {
    return std::remainder(angle, 2.0 * k_pi);
}

std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

// inverse of a symmetric 3x3, zero when singular
Mat3 inverse_or_zero(const Mat3& m) {
    const double determinant = m.determinant();
    const double scale = m.trace();
    if (!std::isfinite(determinant) || !(determinant > 1.0e-15 * scale * scale * scale))
        return Mat3::Zero();
    return m.inverse();
}

} // namespace

PantographKinematics::PantographKinematics(const PantographGeometry& geometry)
    : geometry_(geometry)
    , base_{Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()}
    , front_{Vec2::Zero(), Vec2::Zero()}
    , length_(1.0) {
    for (std::size_t b = 0; b < 2; ++b) {
        const FiveBarGeometry& bar = geometry_.bar[b];
        const Vec2 half = rotate(bar.base_angle, Vec2(0.5 * bar.base_spacing, 0.0));
        base_[2 * b] = bar.base_center - half;
        base_[2 * b + 1] = bar.base_center + half;
        front_[b] = rotate(bar.base_angle, Vec2(0.0, 1.0));
    }
    if (geometry_.bar_count == 2)
        length_ = std::max(1.0e-4, 0.5 * (geometry_.attachment[1] - geometry_.attachment[0]).norm());
}

PantographState PantographKinematics::locate(const Pose& pose) const {
    PantographState state;
    // a pose beyond all devices is as good as none, and its squares overflow
    const bool finite = pose.allFinite() && pose.cwiseAbs().maxCoeff() < k_absurd;
    const Pose used = finite ? pose : geometry_.home;
    const Transform handle(freedoms() == 3 ? used : Pose(used.x(), used.y(), 0.0));
    state.reachable = finite;
    state.reach_margin = finite ? 1.0e9 : -1.0e9;
    for (std::size_t b = 0; b < index(geometry_.bar_count); ++b) {
        const FiveBarGeometry& bar = geometry_.bar[b];
        const Vec2 arm = handle.turn(geometry_.attachment[b]);
        const Vec2 end = handle.origin + arm;
        // behind the motors the arms are crossed or would run into the base
        const double front = front_[b].dot(end - bar.base_center);
        state.reach_margin = std::min(state.reach_margin, front);
        state.reachable = state.reachable && front > 0.0;
        for (std::size_t k = 0; k < 2; ++k) {
            const std::size_t i = 2 * b + k;
            const double l = bar.proximal_length[k];
            const double L = bar.distal_length[k];
            const CirclePoint elbow = intersect_circles(base_[i], l, end, L, bar.elbow_side[k]);
            const double distance = (end - base_[i]).norm();
            state.reach_margin = std::min({state.reach_margin, l + L - distance, distance - std::abs(l - L)});
            state.reachable = state.reachable && elbow.meets;
            LegState& leg = state.leg[i];
            leg.base = base_[i];
            leg.proximal = elbow.point - base_[i];
            leg.distal = end - elbow.point;
            leg.arm = arm;
            // far away the arm is stretched towards the handle, so that every figure stays of its own size
            if (!elbow.meets)
                leg.distal *= L / std::max(leg.distal.norm(), 1.0e-12);
            // angle about the axis per end point motion
            double moment = cross(leg.proximal, leg.distal);
            if (std::abs(moment) < k_least_moment)
                moment = std::copysign(k_least_moment, moment);
            state.rates.row(static_cast<Eigen::Index>(i)) << leg.distal.x() / moment, leg.distal.y() / moment,
                freedoms() == 3 ? cross(arm, leg.distal) / moment : 0.0;
        }
        // the forward kinematics would find the other end point
        const LegState& first = state.leg[2 * b];
        const LegState& second = state.leg[2 * b + 1];
        const Vec2 elbows = second.base + second.proximal - first.base - first.proximal;
        const double side = cross(elbows, first.distal);
        state.reachable = state.reachable && side * bar.end_side > 0.0;
    }
    return state;
}

bool PantographKinematics::inverse(const Pose& pose, JointVector& angles) const {
    const PantographState state = locate(pose);
    angles.setZero();
    for (int i = 0; i < motors(); ++i) {
        const Vec2& e = state.leg[index(i)].proximal;
        angles[i] = std::atan2(e.y(), e.x());
    }
    return state.reachable;
}

PoseEstimate PantographKinematics::forward(const JointVector& angles) const {
    PoseEstimate estimate;
    estimate.pose = geometry_.home;
    if (!angles.head(motors()).allFinite())
        return estimate;

    // end points from the elbows
    std::array<Vec2, 2> end{Vec2::Zero(), Vec2::Zero()};
    bool meets = true;
    for (std::size_t b = 0; b < index(geometry_.bar_count); ++b) {
        const FiveBarGeometry& bar = geometry_.bar[b];
        std::array<Vec2, 2> elbow;
        for (std::size_t k = 0; k < 2; ++k)
            elbow[k] = base_[2 * b + k] + rotate(angles[static_cast<Eigen::Index>(2 * b + k)],
                                                 Vec2(bar.proximal_length[k], 0.0));
        const CirclePoint found =
            intersect_circles(elbow[0], bar.distal_length[0], elbow[1], bar.distal_length[1], bar.end_side);
        end[b] = found.point;
        meets = meets && found.meets;
    }
    if (geometry_.bar_count == 1) {
        estimate.pose << end[0].x(), end[0].y(), 0.0;
        estimate.valid = meets;
        return estimate;
    }

    // pose from the two end points
    const Vec2 wanted = geometry_.attachment[1] - geometry_.attachment[0];
    const Vec2 found = end[1] - end[0];
    const double theta = wrap(std::atan2(found.y(), found.x()) - std::atan2(wanted.y(), wanted.x()));
    const Vec2 middle =
        0.5 * (end[0] + end[1]) - rotate(theta, 0.5 * (geometry_.attachment[0] + geometry_.attachment[1]));
    estimate.pose << middle.x(), middle.y(), theta;

    // least squares over all four encoders
    bool reachable = true;
    for (int pass = 0; pass <= k_refinements; ++pass) {
        const PantographState state = locate(estimate.pose);
        reachable = state.reachable;
        JointVector error;
        for (int i = 0; i < k_max_motors; ++i) {
            const Vec2& e = state.leg[index(i)].proximal;
            error[i] = wrap(angles[i] - std::atan2(e.y(), e.x()));
        }
        estimate.residual = error.norm();
        if (pass == k_refinements || !reachable)
            break;
        const Pose change = jacobian(state) * error;
        estimate.pose += change;
        if (change.head<2>().norm() + length_ * std::abs(change.z()) < 1.0e-13)
            break;
    }
    estimate.valid = meets && reachable;
    return estimate;
}

Eigen::Matrix<double, 3, 4> PantographKinematics::jacobian(const PantographState& state) const {
    Eigen::Matrix<double, 3, 4> result = Eigen::Matrix<double, 3, 4>::Zero();
    if (freedoms() == 2) {
        const Mat2 rates = state.rates.topLeftCorner<2, 2>();
        const double determinant = rates.determinant();
        if (std::isfinite(determinant) && std::abs(determinant) > 1.0e-9 * rates.squaredNorm())
            result.topLeftCorner<2, 2>() = rates.inverse();
        return result;
    }
    // moments in units of the handle's half width keep the normal matrix well conditioned
    const Vec3 unit(1.0, 1.0, 1.0 / length_);
    const JointJacobian scaled = state.rates * unit.asDiagonal();
    const Mat3 normal = scaled.transpose() * scaled;
    result = unit.asDiagonal() * inverse_or_zero(normal) * scaled.transpose();
    return result;
}

WorkspaceReport PantographKinematics::workspace(const Pose& pose, const PantographState& state) const {
    WorkspaceReport report;
    report.reach_margin = state.reach_margin;
    report.rotation_margin =
        freedoms() == 3 && std::isfinite(pose.z()) ? geometry_.rotation_limit - std::abs(pose.z()) : k_pi;
    report.inside = state.reachable && report.rotation_margin >= 0.0;
    if (freedoms() == 2) {
        const double cosine = state.leg[0].distal.normalized().dot(state.leg[1].distal.normalized());
        report.singularity = std::sqrt(std::max(0.0, 1.0 - std::abs(cosine)));
        return report;
    }
    Mat3 gram = Mat3::Zero();
    for (const LegState& leg : state.leg) {
        const Vec2 d = leg.distal.normalized();
        const Vec3 line(d.x(), d.y(), cross(leg.arm, d) / length_);
        gram.noalias() += line * line.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(gram, Eigen::EigenvaluesOnly);
    report.singularity = std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
    return report;
}

double PantographKinematics::angle_of_count(int i, double count) const {
    return geometry_.encoder_offset[index(i)] +
           geometry_.encoder_direction[index(i)] * count * 2.0 * k_pi / geometry_.motor.counts_per_revolution;
}

double PantographKinematics::count_of_angle(int i, double angle) const {
    return geometry_.encoder_direction[index(i)] * (angle - geometry_.encoder_offset[index(i)]) *
           geometry_.motor.counts_per_revolution / (2.0 * k_pi);
}

} // namespace haptics
