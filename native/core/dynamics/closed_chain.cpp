/// Grounded revolute chains in absolute angles, in closed form.
///
/// With absolute angles phi the velocity of body j's center is the sum of phi_i' l_i' (i < j) plus phi_j'
/// c_j', so that
///     D_ij = l_i . mu_j  (i < j),   D_ii = J_i + m_i |c_i|^2 + M_i |l_i|^2,   mu_j = m_j c_j + M_j l_j,
/// where l_i leads from joint i to joint i + 1, M_i is the mass beyond body i; l and mu turn with their body.
/// Lagrange's equations give
///     sum_j D_ij phi_j'' = force_i - force_{i+1} + g . mu_i' - sum_{j<i} (l_j x mu_i) w_j^2 + sum_{j>i} (l_i
///     x mu_j) w_j^2,
/// and q_i'' = phi_i'' - phi_{i-1}''.
///
/// One to three bodies step in a shorter way: see short_chain.cpp.

#include <haptics/core/dynamics/closed_chain.hpp>
#include <haptics/core/dynamics/multiversion.hpp>
#include <haptics/core/dynamics/sincos.hpp>

#include <cmath>

#include "dynamics/closed_chain_solve.hpp"
#include "dynamics/short_chain.hpp"

// Packing these scalars into vectors sends them through memory and costs a third of the time.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-vectorize")
#endif

namespace haptics {
namespace {

/// q'' of N bodies into `acceleration`, from the cosines and sines of their absolute angles.
template <int N>
HAPTICS_ALWAYS_INLINE void chain_acceleration(const LinkageModel& model, const Lanes& cosine,
                                              const Lanes& sine, const double* rate, const double* force,
                                              double* acceleration) {
    constexpr std::size_t size = N;
    const ChainModel& chain = model.chain;
    Lanes link_x;
    Lanes link_y;
    Lanes moment_x;
    Lanes moment_y;
    std::memcpy(&link_x, chain.link_x.data() + 1, sizeof(link_x));
    std::memcpy(&link_y, chain.link_y.data() + 1, sizeof(link_y));
    std::memcpy(&moment_x, chain.moment_x.data() + 1, sizeof(moment_x));
    std::memcpy(&moment_y, chain.moment_y.data() + 1, sizeof(moment_y));
    const Lanes lx = cosine * link_x - sine * link_y;
    const Lanes ly = sine * link_x + cosine * link_y;
    const Lanes mx = cosine * moment_x - sine * moment_y;
    const Lanes my = sine * moment_x + cosine * moment_y;
    double square[size];
    double right[size];
    for (int i = 0; i < N; ++i) {
        square[i] = rate[i] * rate[i];
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
    solve_closed_chain<N>(d, right, acceleration);
}

template <int N>
HAPTICS_ALWAYS_INLINE void accelerate(const LinkageModel& model, const LinkageData& data, const double* force,
                                      double* acceleration) {
    Lanes cosine;
    Lanes sine;
    std::memcpy(&cosine, data.cosine.data() + 1, sizeof(cosine));
    std::memcpy(&sine, data.sine.data() + 1, sizeof(sine));
    chain_acceleration<N>(model, cosine, sine, data.rate.data() + 1, force, acceleration);
}

/// A whole semi-implicit step of four bodies, kept in registers.
HAPTICS_ALWAYS_INLINE void advance_four(const LinkageModel& model, LinkageData& data, const double* force,
                                        double dt, double* acceleration) {
    double* q = data.position.data();
    double* v = data.velocity.data();
    double angle[4];
    double rate[4];
    bool in_range = true;
    for (int i = 0; i < 4; ++i) {
        const double turn = model.turn_offset[i + 1] + q[i];
        angle[i] = i > 0 ? angle[i - 1] + turn : turn;
        rate[i] = i > 0 ? rate[i - 1] + v[i] : v[i];
        in_range &= std::fabs(angle[i]) < k_sincos_range;
    }
    const Lanes x = {angle[0], angle[1], angle[2], angle[3]};
    Lanes sine;
    Lanes cosine;
    detail::sincos_in_range<Lanes, LaneBits>(x, sine, cosine);
    if (!in_range) [[unlikely]] {
        for (int i = 0; i < 4; ++i) {
            double s;
            double c;
            fast_sincos(angle[i], s, c);
            sine[i] = s;
            cosine[i] = c;
        }
    }
    double a[4];
    chain_acceleration<4>(model, cosine, sine, rate, force, a);
    for (int i = 0; i < 4; ++i) {
        acceleration[i] = a[i];
        v[i] += dt * a[i];
        q[i] += dt * v[i];
    }
}

HAPTICS_ALWAYS_INLINE void accelerate_any(const LinkageModel& model, const LinkageData& data,
                                          const double* force, double* acceleration) {
    switch (model.body_count) {
    case 1:
        return accelerate<1>(model, data, force, acceleration);
    case 2:
        return accelerate<2>(model, data, force, acceleration);
    case 3:
        return accelerate<3>(model, data, force, acceleration);
    default:
        return accelerate<4>(model, data, force, acceleration);
    }
}

#if HAPTICS_MULTIVERSION
HAPTICS_AVX2 void accelerate_avx2(const LinkageModel& model, const LinkageData& data, const double* force,
                                  double* acceleration) {
    accelerate_any(model, data, force, acceleration);
}
HAPTICS_AVX2 void advance_four_avx2(const LinkageModel& model, LinkageData& data, const double* force,
                                    double dt, double* acceleration) {
    advance_four(model, data, force, dt, acceleration);
}
#endif

} // namespace

void closed_chain_acceleration(const LinkageModel& model, const LinkageData& data, const LinkageVector& force,
                               LinkageVector& acceleration) {
    acceleration.resize(model.freedoms);
#if HAPTICS_MULTIVERSION
    if (k_has_avx2) {
        return accelerate_avx2(model, data, force.data(), acceleration.data());
    }
#endif
    accelerate_any(model, data, force.data(), acceleration.data());
}

void closed_chain_step(const LinkageModel& model, LinkageData& data, const LinkageVector& force, double dt,
                       LinkageVector& acceleration) {
    acceleration.resize(model.freedoms);
    if (model.body_count < 4) {
        return short_chain_step(model, data, force.data(), dt, acceleration.data());
    }
#if HAPTICS_MULTIVERSION
    if (k_has_avx2) {
        return advance_four_avx2(model, data, force.data(), dt, acceleration.data());
    }
#endif
    advance_four(model, data, force.data(), dt, acceleration.data());
}

} // namespace haptics
