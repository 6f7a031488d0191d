#pragma once
// Systems of up to four unknowns, unrolled by the compiler: a general library's factorizations are written
// for large matrices, take longer here, and much longer to compile.

#include <haptics/core/types.hpp>

#include <cmath>
#include <utility>

namespace haptics::local {

// x = a^-1 x for a symmetric positive definite matrix of which the lower half is read; `a` is overwritten (L
// D L^T)
template <class Square, class Vector>
inline void solve_definite(Square& a, Vector& x) {
    constexpr int n = Square::RowsAtCompileTime;
    for (int j = 0; j < n; ++j)
        for (int i = j + 1; i < n; ++i) {
            const double factor = a(i, j) / a(j, j);
            for (int k = i; k < n; ++k)
                a(k, i) -= factor * a(k, j);
            x[i] -= factor * x[j];
        }
    for (int j = n - 1; j >= 0; --j) {
        double sum = x[j];
        for (int i = j + 1; i < n; ++i)
            sum -= a(i, j) * x[i];
        x[j] = sum / a(j, j);
    }
}

// x = a^-1 x by elimination with row pivots; `a` is overwritten
template <class Square, class Vector>
inline void solve_pivoted(Square& a, Vector& x) {
    constexpr int n = Square::RowsAtCompileTime;
    for (int j = 0; j < n; ++j) {
        int pivot = j;
        for (int i = j + 1; i < n; ++i)
            if (std::abs(a(i, j)) > std::abs(a(pivot, j)))
                pivot = i;
        if (pivot != j) {
            a.row(pivot).swap(a.row(j));
            std::swap(x[pivot], x[j]);
        }
        for (int i = j + 1; i < n; ++i) {
            const double factor = a(i, j) / a(j, j);
            for (int k = j + 1; k < n; ++k)
                a(i, k) -= factor * a(j, k);
            x[i] -= factor * x[j];
        }
    }
    for (int j = n - 1; j >= 0; --j) {
        double sum = x[j];
        for (int k = j + 1; k < n; ++k)
            sum -= a(j, k) * x[k];
        x[j] = sum / a(j, j);
    }
}

} // namespace haptics::local
