#pragma once
/// Dense decompositions of any size for tests and benchmarks, compiled once: Eigen's take half a minute in
/// each file that names one.

#include <Eigen/Core>

namespace haptics::shared {

/// The x of least norm among those that make |a x - b| least (rank-revealing orthogonal decomposition).
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Orthonormal columns that span the x with a x = 0; no columns when there is none but 0.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& a);

/// Inverse of a square matrix that has one.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& a);

/// Singular values, the largest first.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);

/// Eigenvalues of a symmetric matrix, the smallest first.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& a);

} // namespace haptics::shared
