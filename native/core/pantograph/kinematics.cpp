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
// (end_side picks), the pose from the two end points. Then the least squares over the encoders, |m|^2 with
// the misfit m = phi - phi(q), by Newton's method: (G^T G - sum m_i H_i) delta q = G^T m, G = rates.
// Differentiating the rate once more at zero acceleration of the handle (P'' = -theta'^2 r, E'' = phi''
// perp(e) - phi'^2 e) gives
//   H_i(q', q') = phi''_i = ( d . (P'' + phi'^2 e) + |P' - E'|^2 ) / (e x d).
// Without the H_i (Gauss-Newton) a slipped encoder makes it converge slowly or not at all. What remains of m
// at the end is orthogonal to all columns of G: the part no pose explains.

#include <haptics/core/pantograph/five_bar.hpp>
#include <haptics/core/pantograph/kinematics.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptics {

namespace {

// least |e x d| that is divided by: keeps rates finite at full stretch (m^2)
constexpr double k_least_moment = 1.0e-9;
// angles of a real pose take two passes, those of a slipped encoder a few more
constexpr int k_refinements = 12;
// steps of the refinement: too small for the sum of squares to judge, good enough, done (m)
constexpr double k_flat = 1.0e-8;
constexpr double k_settled = 1.0e-9;
constexpr double k_exact = 1.0e-14;
// more than that is no slip but no pose at all (rad)
constexpr double k_absurd_misfit = 0.25;
// angles of a five-bar in its working mode fit their own inverse but for rounding; the other mode is far off,
// save where an arm is so nearly straight that both are the same (rad)
constexpr double k_mode_slack = 0.02;
// no handle is that far away (m, rad)
constexpr double k_far = 1.0e6;

double wrap(double angle) {
    return std::remainder(angle, 2.0 * std::numbers::pi);
}

std::size_t nth(int i) {
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

// least singular value of the two unit lines of one five-bar: 0 where they line up
double line_up(const PantographState& state, std::size_t bar) {
    const double cosine =
        state.leg[2 * bar].distal.normalized().dot(state.leg[2 * bar + 1].distal.normalized());
    return std::sqrt(std::max(0.0, 1.0 - std::abs(cosine)));
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
    const bool finite = pose.allFinite() && pose.cwiseAbs().maxCoeff() < k_far;
    const Pose used = finite ? pose : geometry_.home;
    const Transform handle(freedoms() == 3 ? used : Pose(used.x(), used.y(), 0.0));
    state.pose = used;
    state.closed = finite;
    state.reachable = finite;
    state.reach_margin = finite ? 1.0e9 : -1.0e9;
    for (std::size_t b = 0; b < nth(geometry_.bar_count); ++b) {
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
            state.closed = state.closed && elbow.meets;
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
    state.reachable = state.reachable && state.closed;
    return state;
}

bool PantographKinematics::inverse(const Pose& pose, JointVector& angles) const {
    const PantographState state = locate(pose);
    angles.setZero();
    for (int i = 0; i < motors(); ++i) {
        const Vec2& e = state.leg[nth(i)].proximal;
        angles[i] = std::atan2(e.y(), e.x());
    }
    return state.reachable;
}

PoseEstimate PantographKinematics::forward(const JointVector& angles) const {
    PoseEstimate estimate;
    estimate.pose = geometry_.home;
    if (!angles.head(motors()).allFinite())
        return estimate;

    // end points from the elbows; where two distal links nearly line up, errors of the angles can part the
    // circles, and the nearest point starts the least squares as well
    std::array<Vec2, 2> end{Vec2::Zero(), Vec2::Zero()};
    bool meets = true;
    for (std::size_t b = 0; b < nth(geometry_.bar_count); ++b) {
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
        const PantographState state = locate(estimate.pose);
        estimate.valid = meets && misfit(state, angles).cwiseAbs().maxCoeff() < k_mode_slack;
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
    PantographState state = locate(estimate.pose);
    estimate.misfit = misfit(state, angles);
    bool converged = false;
    double last_size = 1.0e9;
    for (int pass = 0; pass < k_refinements && state.closed && !converged; ++pass) {
        const Pose change = refinement(state, estimate.misfit);
        const double size = change.head<2>().norm() + length_ * std::abs(change.z());
        // steps that no longer shrink are rounding
        if (size >= last_size && size < k_settled) {
            converged = true;
            break;
        }
        last_size = size;
        // the whole step, or as much of it as brings the pose nearer
        double part = 1.0;
        bool nearer = false;
        for (; part > 0.01 && !nearer; part *= 0.5) {
            const Pose candidate = estimate.pose + part * change;
            const PantographState there = locate(candidate);
            const JointVector left = misfit(there, angles);
            // the sum of squares is flat at its least: it cannot judge steps below the root of its rounding
            nearer = there.closed && (size < k_flat || left.squaredNorm() <= estimate.misfit.squaredNorm());
            if (!nearer)
                continue;
            estimate.pose = candidate;
            estimate.misfit = left;
            state = there;
        }
        converged = size < k_exact;
        if (!nearer)
            break;
    }
    converged = converged || last_size < k_settled;
    estimate.residual = estimate.misfit.norm();
    estimate.valid = converged && state.reachable && estimate.residual < k_absurd_misfit;
    return estimate;
}

Pose PantographKinematics::refinement(const PantographState& state, const JointVector& misfit) const {
    const Vec3 unit(1.0, 1.0, 1.0 / length_);
    const JointJacobian rates = state.rates * unit.asDiagonal();
    const Vec3 slope = rates.transpose() * misfit;
    const Mat3 normal = rates.transpose() * rates;
    // what the misfit adds through the curvature of the joint angles
    Mat3 curved = normal;
    for (int i = 0; i < motors(); ++i) {
        const LegState& leg = state.leg[nth(i)];
        const double moment = cross(leg.proximal, leg.distal);
        if (std::abs(moment) < k_least_moment)
            continue;
        const Eigen::RowVector3d g = rates.row(i);
        Eigen::Matrix<double, 2, 3> relative = -perpendicular(leg.proximal) * g;
        relative.leftCols<2>() += Mat2::Identity();
        relative.col(2) += perpendicular(leg.arm) / length_;
        Mat3 second = leg.distal.dot(leg.proximal) * g.transpose() * g + relative.transpose() * relative;
        second(2, 2) -= leg.distal.dot(leg.arm) / (length_ * length_);
        curved -= misfit[i] / moment * second;
    }
    // Newton where the sum of squares is a bowl, Gauss-Newton where it is not
    const Eigen::LLT<Mat3> bowl(curved);
    if (bowl.info() == Eigen::Success && curved.determinant() > 0.05 * normal.determinant())
        return unit.cwiseProduct(bowl.solve(slope));
    return unit.cwiseProduct(inverse_or_zero(normal) * slope);
}

JointVector PantographKinematics::misfit(const PantographState& state, const JointVector& angles) const {
    JointVector left = JointVector::Zero();
    for (int i = 0; i < motors(); ++i) {
        const Vec2& e = state.leg[nth(i)].proximal;
        left[i] = wrap(angles[i] - std::atan2(e.y(), e.x()));
    }
    return left;
}

JointVector PantographKinematics::unexplained(const PantographState& state) const {
    if (freedoms() == 2)
        return JointVector::Zero();
    // by cofactors: polynomials of the entries, hence smooth
    const JointJacobian& a = state.rates;
    const auto minor = [&a](int i, int j, int k) {
        return a(i, 0) * (a(j, 1) * a(k, 2) - a(j, 2) * a(k, 1)) -
               a(i, 1) * (a(j, 0) * a(k, 2) - a(j, 2) * a(k, 0)) +
               a(i, 2) * (a(j, 0) * a(k, 1) - a(j, 1) * a(k, 0));
    };
    const JointVector n(minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2));
    const double size = n.norm();
    // columns of the rates span a box of that volume; none, and the direction is not unique
    const double box = a.col(0).norm() * a.col(1).norm() * a.col(2).norm();
    if (!std::isfinite(size) || !(size > 1.0e-9 * box))
        return JointVector::Zero();
    return n / size;
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
    report.rotation_margin = freedoms() == 3 && std::isfinite(pose.z())
                                 ? geometry_.rotation_limit - std::abs(pose.z())
                                 : std::numbers::pi;
    report.inside = state.reachable && report.rotation_margin >= 0.0;
    if (freedoms() == 2) {
        report.singularity = line_up(state, 0);
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
    report.singularity =
        std::min({std::sqrt(std::max(0.0, solver.eigenvalues()[0])), line_up(state, 0), line_up(state, 1)});
    return report;
}

double PantographKinematics::angle_of_count(int i, double count) const {
    return geometry_.encoder_offset[nth(i)] + geometry_.encoder_direction[nth(i)] * count * 2.0 *
                                                  std::numbers::pi / geometry_.motor.counts_per_revolution;
}

double PantographKinematics::count_of_angle(int i, double angle) const {
    return geometry_.encoder_direction[nth(i)] * (angle - geometry_.encoder_offset[nth(i)]) *
           geometry_.motor.counts_per_revolution / (2.0 * std::numbers::pi);
}

} // namespace haptics
