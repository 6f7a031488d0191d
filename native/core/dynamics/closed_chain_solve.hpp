#pragma once
/// The last part of closed_chain.cpp: D phi'' = right for one to four bodies, with D symmetric and positive
/// definite and only its upper triangle read, and q_i'' = phi_i'' - phi_{i-1}''. One, two and three bodies by
/// cofactors and one division, four by 2 x 2 blocks. The differences of phi'' are taken before the division,
/// which they need not wait for.

#include <haptics/core/dynamics/sincos.hpp>

#include <cstddef>

namespace haptics {

/// q'' of N bodies into `acceleration`.
template <int N, std::size_t Size = static_cast<std::size_t>(N)>
HAPTICS_ALWAYS_INLINE void solve_closed_chain(const double (&d)[Size][Size], const double (&right)[Size],
                                              double* acceleration) {
    if constexpr (N == 1) {
        acceleration[0] = right[0] / d[0][0];
    } else if constexpr (N == 2) {
        const double inverse = 1.0 / (d[0][0] * d[1][1] - d[0][1] * d[0][1]);
        const double first = d[1][1] * right[0] - d[0][1] * right[1];
        const double second = d[0][0] * right[1] - d[0][1] * right[0];
        acceleration[0] = first * inverse;
        acceleration[1] = (second - first) * inverse;
    } else if constexpr (N == 3) {
        const double c00 = d[1][1] * d[2][2] - d[1][2] * d[1][2];
        const double c01 = d[0][2] * d[1][2] - d[0][1] * d[2][2];
        const double c02 = d[0][1] * d[1][2] - d[0][2] * d[1][1];
        const double c11 = d[0][0] * d[2][2] - d[0][2] * d[0][2];
        const double c12 = d[0][1] * d[0][2] - d[0][0] * d[1][2];
        const double c22 = d[0][0] * d[1][1] - d[0][1] * d[0][1];
        const double inverse = 1.0 / (d[0][0] * c00 + (d[0][1] * c01 + d[0][2] * c02));
        const double first = c00 * right[0] + (c01 * right[1] + c02 * right[2]);
        const double second = c01 * right[0] + (c11 * right[1] + c12 * right[2]);
        const double third = c02 * right[0] + (c12 * right[1] + c22 * right[2]);
        acceleration[0] = first * inverse;
        acceleration[1] = (second - first) * inverse;
        acceleration[2] = (third - second) * inverse;
    } else {
        static_assert(N == 4);
        // A = first two, B = last two, E between them: S = B - E^T A^-1 E
        const double a = 1.0 / (d[0][0] * d[1][1] - d[0][1] * d[0][1]);
        const double f00 = (d[1][1] * d[0][2] - d[0][1] * d[1][2]) * a;
        const double f10 = (d[0][0] * d[1][2] - d[0][1] * d[0][2]) * a;
        const double f01 = (d[1][1] * d[0][3] - d[0][1] * d[1][3]) * a;
        const double f11 = (d[0][0] * d[1][3] - d[0][1] * d[0][3]) * a;
        const double s00 = d[2][2] - (d[0][2] * f00 + d[1][2] * f10);
        const double s01 = d[2][3] - (d[0][2] * f01 + d[1][2] * f11);
        const double s11 = d[3][3] - (d[0][3] * f01 + d[1][3] * f11);
        const double r2 = right[2] - (f00 * right[0] + f10 * right[1]);
        const double r3 = right[3] - (f01 * right[0] + f11 * right[1]);
        const double s = 1.0 / (s00 * s11 - s01 * s01);
        const double third = (s11 * r2 - s01 * r3) * s;
        const double fourth = (s00 * r3 - s01 * r2) * s;
        const double first = (d[1][1] * right[0] - d[0][1] * right[1]) * a - (f00 * third + f01 * fourth);
        const double second = (d[0][0] * right[1] - d[0][1] * right[0]) * a - (f10 * third + f11 * fourth);
        acceleration[0] = first;
        acceleration[1] = second - first;
        acceleration[2] = third - second;
        acceleration[3] = fourth - third;
    }
}

} // namespace haptics
