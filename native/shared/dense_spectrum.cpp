#include <haptics/shared/dense_algebra.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace haptics::shared {

Eigen::VectorXd singular_values(const Eigen::MatrixXd& a) {
    return Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a, Eigen::EigenvaluesOnly).eigenvalues();
}

} // namespace haptics::shared
