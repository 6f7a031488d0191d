#include <haptics/core/dynamics/mass_inverse.hpp>

namespace haptics {

void inverse_mass_matrix(const LinkageModel& model, const LinkageData& data, const ArticulatedFactor& factor,
                         LinkageMatrix& inverse) {
    const int n = model.freedoms;
    inverse.resize(n, n);
    LinkageVector column(n);
    for (int i = 0; i < n; ++i) {
        column.setZero();
        column[i] = 1.0;
        solve(model, data, factor, column, column);
        inverse.col(i) = column;
    }
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i; ++j) {
            const double mean = 0.5 * (inverse(i, j) + inverse(j, i));
            inverse(i, j) = mean;
            inverse(j, i) = mean;
        }
    }
}

} // namespace haptics
