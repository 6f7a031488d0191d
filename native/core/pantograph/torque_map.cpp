// Derivation.
// F = G^T tau with G = rates; u_i = tau_i / limit_i and A = diag(limit) G give F = A^T u, |u_i| <= 1.
// Two motors: u is unique. Four motors, three freedoms: all solutions are u0 + lambda n with
//   u0 = A (A^T A)^-1 F   (least 2-norm)   and n the unit vector with A^T n = 0; u0 . n = 0, so |u|^2 =
//   |u0|^2 + lambda^2.
// Each bound |u0_i + lambda n_i| <= 1 is an interval of lambda. When the intervals meet, the lambda nearest
// to 0 in them has the least norm. When they do not, lambda is chosen to make the largest |u_i| as small as
// can be, m > 1, and everything is divided by m: the largest share of the wrench that fits (a share s fits if
// and only if s m <= 1). At the border of both cases the intervals meet in the very lambda of the second
// case, so torques are continuous in F. max_i |u0_i + lambda n_i| is convex and piecewise linear: its least
// value lies where two of the pieces cross.

#include <haptics/core/pantograph/torque_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

namespace {

using Vec4 = Eigen::Vector4d;

double largest(const Vec4& u0, const Vec4& n, double lambda) {
    return (u0 + lambda * n).cwiseAbs().maxCoeff();
}

// lambda with the least largest |u0 + lambda n|
double flattest(const Vec4& u0, const Vec4& n) {
    double best = 0.0;
    double value = largest(u0, n, 0.0);
    const auto consider = [&](double numerator, double denominator) {
        if (std::abs(denominator) < 1.0e-12)
            return;
        const double lambda = numerator / denominator;
        const double candidate = largest(u0, n, lambda);
        if (candidate < value) {
            value = candidate;
            best = lambda;
        }
    };
    for (int i = 0; i < 4; ++i) {
        consider(-u0[i], n[i]);
        for (int j = i + 1; j < 4; ++j) {
            consider(u0[j] - u0[i], n[i] - n[j]);
            consider(-u0[j] - u0[i], n[i] + n[j]);
        }
    }
    return best;
}

} // namespace

TorqueSolution joint_torques(const PantographKinematics& kinematics, const PantographState& state,
                             const Wrench& wrench) {
    TorqueSolution solution;
    if (!wrench.allFinite())
        return solution;
    Vec4 limit = Vec4::Ones();
    for (int i = 0; i < kinematics.motors(); ++i)
        limit[i] = kinematics.geometry().joint_torque_limit(i);

    if (kinematics.freedoms() == 2) {
        const Mat2 a = limit.head<2>().asDiagonal() * state.rates.topLeftCorner<2, 2>();
        const double determinant = a.determinant();
        if (!std::isfinite(determinant) || std::abs(determinant) < 1.0e-9 * a.squaredNorm())
            return solution;
        const Vec2 u = a.transpose().inverse() * wrench.head<2>();
        solution.scale = 1.0 / std::max(1.0, u.cwiseAbs().maxCoeff());
        solution.torque.head<2>() = limit.head<2>().cwiseProduct(u) * solution.scale;
        return solution;
    }

    // least norm
    const double length = kinematics.characteristic_length();
    const Vec3 unit(1.0, 1.0, 1.0 / length);
    const Eigen::Matrix<double, 4, 3> a = limit.asDiagonal() * state.rates * unit.asDiagonal();
    const Mat3 normal = a.transpose() * a;
    const double determinant = normal.determinant();
    const double size = normal.trace();
    if (!std::isfinite(determinant) || !(determinant > 1.0e-12 * size * size * size))
        return solution;
    const Vec4 u0 = a * (normal.inverse() * unit.cwiseProduct(wrench));
    // A^T n = 0 with A = diag(limit) G
    Vec4 n = kinematics.unexplained(state).cwiseQuotient(limit);
    const double norm = n.norm();
    n = norm > 0.0 ? Vec4(n / norm) : Vec4(Vec4::Zero());
    if (!u0.allFinite() || !n.allFinite())
        return solution;

    // nearest to it within limits
    double low = -std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::max();
    bool fits = true;
    for (int i = 0; i < 4; ++i) {
        if (std::abs(n[i]) < 1.0e-9) {
            fits = fits && std::abs(u0[i]) <= 1.0;
            continue;
        }
        const double at_plus = (1.0 - u0[i]) / n[i];
        const double at_minus = (-1.0 - u0[i]) / n[i];
        low = std::max(low, std::min(at_plus, at_minus));
        high = std::min(high, std::max(at_plus, at_minus));
    }
    fits = fits && low <= high;
    const double lambda = fits ? std::clamp(0.0, low, high) : flattest(u0, n);
    const Vec4 u = u0 + lambda * n;
    const double peak = std::max(1.0, u.cwiseAbs().maxCoeff());
    if (!std::isfinite(peak))
        return solution;
    solution.scale = 1.0 / peak;
    solution.torque = limit.cwiseProduct(u) * solution.scale;
    return solution;
}

} // namespace haptics
