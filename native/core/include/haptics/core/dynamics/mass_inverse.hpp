#pragma once
/// D^-1 as the contact solver needs it: applied to rows, dense, and seen from the contacts.

#include <haptics/core/dynamics/articulated.hpp>

namespace haptics {

/// solutions (n x m) = D^-1 rows^T for m dense rows over the n freedoms: O(n) a row. `solutions` has its size
/// already.
template <class Rows, class Solutions>
void solve_rows(const LinkageModel& model, const LinkageData& data, const ArticulatedFactor& factor,
                const Eigen::MatrixBase<Rows>& rows, Eigen::MatrixBase<Solutions>& solutions) {
    LinkageVector column(model.freedoms);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        column = rows.row(i).transpose();
        solve(model, data, factor, column, column);
        solutions.col(i) = column;
    }
}

/// inverse (m x m) = rows D^-1 rows^T, symmetric to the last bit, from solutions = D^-1 rows^T.
template <class Rows, class Solutions, class Inverse>
void operational_inverse(const Eigen::MatrixBase<Rows>& rows, const Eigen::MatrixBase<Solutions>& solutions,
                         Eigen::MatrixBase<Inverse>& inverse) {
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        for (Eigen::Index j = 0; j <= i; ++j) {
            double sum = 0.0;
            for (Eigen::Index k = 0; k < rows.cols(); ++k) {
                sum += rows(i, k) * solutions(k, j);
            }
            inverse(i, j) = sum;
            inverse(j, i) = sum;
        }
    }
}

/// D^-1 itself, symmetric to the last bit: O(n^2).
void inverse_mass_matrix(const LinkageModel& model, const LinkageData& data, const ArticulatedFactor& factor,
                         LinkageMatrix& inverse);

} // namespace haptics
