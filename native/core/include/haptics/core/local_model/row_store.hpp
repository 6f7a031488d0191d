#pragma once
/// Rows over the freedoms of a system, one after the other in memory. A plain array behind Eigen's maps:
/// Eigen itself refuses to hold a matrix of this size without the heap.

#include <haptics/core/contact/collision.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace haptics {

template <int MaxRows>
class RowStore {
  public:
    using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, k_max_collision_freedoms>;

    /// `rows` (at most MaxRows) rows of `columns` zeros.
    void set_zero(int rows, int columns) {
        columns_ = columns;
        std::fill_n(number_.begin(), static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 0.0);
    }
    double& operator()(int row, int column) { return data()[row * columns_ + column]; }
    const double& operator()(int row, int column) const { return data()[row * columns_ + column]; }
    [[nodiscard]] Eigen::Map<Row> row(int i) { return {data() + i * columns_, columns_}; }
    [[nodiscard]] Eigen::Map<const Row> row(int i) const { return {data() + i * columns_, columns_}; }
    [[nodiscard]] double* data() { return number_.data(); }
    [[nodiscard]] const double* data() const { return number_.data(); }

  private:
    int columns_{0};
    std::array<double, static_cast<std::size_t>(MaxRows) * k_max_collision_freedoms> number_;
};

} // namespace haptics
