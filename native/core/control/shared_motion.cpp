// Acceleration feed-forward.
//
// Proxy at the grip: a = b + P L with P = J_h D^-1 J_h^T, b = J_h D^-1 (tau - C) + J_h' q' and L the force of
// the device on it. Device: M_d a_d = F_h + u. The hand is to feel the linkage and the part M' of the
// device's inertia: M' a = F_h - L. With a common a,
//     F_h - L = M' b + M' P L,   L = (1 + M' P)^-1 (F_h - M' b),   a = b + P L,   u = M_d a - F_h.
// P is never inverted and M' may be zero: L exists wherever the linkage is singular (1 + M' P has eigenvalues
// >= 1). Where P = 0 along some direction, a = b there: the device is told to stand still. At rest a = 0, so
// that u = -F_h and L = F_h: nothing is left for the coupling to carry.
//
// With nothing hidden, M' = M_d, u = M_d b + M_d P L - F_h = -L: device and proxy receive opposite forces,
// whatever the estimates of F_h, b, P and M_d are; the pair obeys Newton's third law like a spring between
// them. A hidden part adds u + L = (M_d - M') a, which drives the device by an estimate of its own
// acceleration: with M_d assumed r times too large and the observer's F_h = m a - u, the estimate returns to
// itself with gain (r - 1)(g - 1), g = M_d a / F_h = 1/(v + p), where v is the visible part of the device's
// mass and p the proxy's mass over the device's. So what may be hidden depends on how well the mass is known
// and on the proxy: coupling_design.cpp looks for the most that its computed loop bears beside a proxy
// without mass, v + p >= 1 - alone. A proxy with mass lets more be hidden: v = max(1 - most, 1 - alone - p).
// For matrices that holds along the principal directions of L' P L (M_d = L L'), whose values are 1/p.
//
// Contacts stay out of b. Fed into a, a contact force would return through L within the same step (the proxy
// answers L at once), with gain M_d P / (1 + M' P), that is up to 1/(1 - hidden), a loop without delay. So
// contacts come through the coupling, and while the tool touches something nothing is hidden: at rest against
// a wall the coupling carries F_h - L and the hand gets its push back exactly.

#include <haptics/core/control/shared_motion.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>

namespace haptics {

SharedMotion share_motion(const Mat3& mobility, const Vec3& free_acceleration, const Mat3& device_mass,
                          const Mat3& visible_mass, const Wrench& hand_force) {
    SharedMotion shared;
    const Mat3 one_plus = Mat3::Identity() + visible_mass * mobility;
    shared.to_proxy = one_plus.inverse() * (hand_force - visible_mass * free_acceleration);
    shared.acceleration = free_acceleration + mobility * shared.to_proxy;
    shared.to_device = device_mass * shared.acceleration - hand_force;
    return shared;
}

double visible_part(double alone, double most, double r) {
    return std::clamp(1.0 - alone - r, 1.0 - most, 1.0);
}

Mat3 visible_mass(const Mat3& device_mass, const Mat3& mobility, const HiddenInertia& hidden, double amount) {
    if (amount <= 0.0 || hidden.most <= 0.0)
        return device_mass;
    const Mat3 root = device_mass.llt().matrixL();
    Eigen::SelfAdjointEigenSolver<Mat3> directions;
    directions.computeDirect(root.transpose() * mobility * root);
    Vec3 part;
    for (int i = 0; i < 3; ++i) {
        const Vec3 along = directions.eigenvectors().col(i).cwiseAbs2();
        const double inverse = directions.eigenvalues()(i);
        const double r = inverse > 1e-9 ? 1.0 / inverse : 1e9;
        part(i) = 1.0 - amount * (1.0 - visible_part(along.dot(hidden.alone), hidden.most, r));
    }
    const Mat3 turned = root * directions.eigenvectors();
    return turned * part.asDiagonal() * turned.transpose();
}

} // namespace haptics
