/// Grounded revolute chains in absolute angles, in closed form.
///
/// With absolute angles phi the velocity of body j's center is the sum of phi_i' l_i' (i < j) plus phi_j'
/// c_j', so that
///     D_ij = l_i . mu_j  (i < j),   D_ii = J_i + m_i |c_i|^2 + M_i |l_i|^2,   mu_j = m_j c_j + M_j l_j,
/// where l_i leads from joint i to joint i + 1, M_i is the mass beyond body i; l and mu turn with their body.
/// Lagrange's equations give
///     sum_j D_ij phi_j'' = force_i - force_{i+1} + g . mu_i' - sum_{j<i} (l_j x mu_i) w_j^2 + sum_{j>i} (l_i
///     x mu_j) w_j^2,
/// and q_i'' = phi_i'' - phi_{i-1}''. One, two and three bodies are solved with cofactors and one division,
/// four by 2 x 2 blocks.

#include <haptics/core/dynamics/closed_chain.hpp>

namespace haptics {
namespace {

/// phi'' of N bodies into `phi`.
template <int N>
inline void absolute_acceleration(const LinkageModel& model, const LinkageData& data, const double* force,
                                  double* phi) {
    constexpr std::size_t size = N;
    const ChainModel& chain = model.chain;
    double lx[size];
    double ly[size];
    double mx[size];
    double my[size];
    double square[size];
    double right[size];
    for (int i = 0; i < N; ++i) {
        const double c = data.cosine[i + 1];
        const double s = data.sine[i + 1];
        lx[i] = c * chain.link_x[i + 1] - s * chain.link_y[i + 1];
        ly[i] = s * chain.link_x[i + 1] + c * chain.link_y[i + 1];
        mx[i] = c * chain.moment_x[i + 1] - s * chain.moment_y[i + 1];
        my[i] = s * chain.moment_x[i + 1] + c * chain.moment_y[i + 1];
        square[i] = data.rate[i + 1] * data.rate[i + 1];
        right[i] = i + 1 < N ? force[i] - force[i + 1] : force[i];
    }
    if (model.has_gravity) {
        for (int i = 0; i < N; ++i) {
            right[i] += model.gravity.y() * mx[i] - model.gravity.x() * my[i];
        }
    }
    if (model.coriolis) {
        for (int i = 0; i < N; ++i) {
            for (int j = i + 1; j < N; ++j) {
                const double turn = lx[i] * my[j] - ly[i] * mx[j];
                right[i] += turn * square[j];
                right[j] -= turn * square[i];
            }
        }
    }
    double d[size][size];
    for (int i = 0; i < N; ++i) {
        d[i][i] = chain.diagonal[i + 1];
        for (int j = i + 1; j < N; ++j) {
            d[i][j] = lx[i] * mx[j] + ly[i] * my[j];
        }
    }
    if constexpr (N == 1) {
        phi[0] = right[0] / d[0][0];
    } else if constexpr (N == 2) {
        const double inverse = 1.0 / (d[0][0] * d[1][1] - d[0][1] * d[0][1]);
        phi[0] = (d[1][1] * right[0] - d[0][1] * right[1]) * inverse;
        phi[1] = (d[0][0] * right[1] - d[0][1] * right[0]) * inverse;
    } else if constexpr (N == 3) {
        const double c00 = d[1][1] * d[2][2] - d[1][2] * d[1][2];
        const double c01 = d[0][2] * d[1][2] - d[0][1] * d[2][2];
        const double c02 = d[0][1] * d[1][2] - d[0][2] * d[1][1];
        const double c11 = d[0][0] * d[2][2] - d[0][2] * d[0][2];
        const double c12 = d[0][1] * d[0][2] - d[0][0] * d[1][2];
        const double c22 = d[0][0] * d[1][1] - d[0][1] * d[0][1];
        const double inverse = 1.0 / (d[0][0] * c00 + (d[0][1] * c01 + d[0][2] * c02));
        phi[0] = (c00 * right[0] + (c01 * right[1] + c02 * right[2])) * inverse;
        phi[1] = (c01 * right[0] + (c11 * right[1] + c12 * right[2])) * inverse;
        phi[2] = (c02 * right[0] + (c12 * right[1] + c22 * right[2])) * inverse;
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
        phi[2] = (s11 * r2 - s01 * r3) * s;
        phi[3] = (s00 * r3 - s01 * r2) * s;
        phi[0] = (d[1][1] * right[0] - d[0][1] * right[1]) * a - (f00 * phi[2] + f01 * phi[3]);
        phi[1] = (d[0][0] * right[1] - d[0][1] * right[0]) * a - (f10 * phi[2] + f11 * phi[3]);
    }
}

template <int N>
void relative_acceleration(const LinkageModel& model, const LinkageData& data, const double* force,
                           double* acceleration) {
    double phi[static_cast<std::size_t>(N)];
    absolute_acceleration<N>(model, data, force, phi);
    acceleration[0] = phi[0];
    for (int i = 1; i < N; ++i) {
        acceleration[i] = phi[i] - phi[i - 1];
    }
}

} // namespace

void closed_chain_acceleration(const LinkageModel& model, const LinkageData& data, const JointVector& force,
                               JointVector& acceleration) {
    acceleration.resize(model.freedoms);
    switch (model.body_count) {
    case 1:
        relative_acceleration<1>(model, data, force.data(), acceleration.data());
        break;
    case 2:
        relative_acceleration<2>(model, data, force.data(), acceleration.data());
        break;
    case 3:
        relative_acceleration<3>(model, data, force.data(), acceleration.data());
        break;
    default:
        relative_acceleration<4>(model, data, force.data(), acceleration.data());
        break;
    }
}

} // namespace haptics
