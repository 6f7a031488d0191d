#include <haptics/shared/dense_algebra.hpp>

#include <Eigen/LU>
#include <Eigen/QR>

namespace haptics::shared {

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
    return a.completeOrthogonalDecomposition().solve(b);
}

// a P = Q [T 0; 0 0] Z: the last rows of Z are seen by no row of a
Eigen::MatrixXd kernel(const Eigen::MatrixXd& a) {
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(a);
    const Eigen::MatrixXd z = decomposition.matrixZ();
    return decomposition.colsPermutation() * z.bottomRows(a.cols() - decomposition.rank()).transpose();
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& a) {
    return a.inverse();
}

} // namespace haptics::shared
