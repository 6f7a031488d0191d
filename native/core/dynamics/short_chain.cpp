/// A semi-implicit step of one to three bodies. See closed_chain.cpp for the equations.
///
/// Every step waits for the one before, so its time is that of the longest chain of operations that wait for
/// each other. Five things shorten it.
/// - D and the turning terms hang on differences of angles alone: with e the angle between the bodies i < j,
///   a = l_i . mu_j and b = mu_j x l_i for e = 0,
///       l_i . mu_j = a cos e + b sin e,   l_i x mu_j = a sin e - b cos e.
///   So the sums of angles from the ground on are not needed; only gravity asks for them.
/// - The angle offsets of the joints are turned into a and b beforehand.
/// - With e = r + k pi/2 the quarter turns are turned into a and b while the polynomials of r are still being
///   computed: (a, b) -> (b, -a) -> (-a, -b) -> (-b, a).
/// - The third pair comes by the addition theorem, and the determinant takes it in last:
///       det = K + d02 (2 d01 d12 - d11 d02),   K = d00 (d11 d22 - d12^2) - d22 d01^2.
/// - With a = n / det, q + h (v + h a) is taken as (q + h v) + n (h^2 / det): three divisions side by side.

#include "dynamics/short_chain.hpp"

#include <haptics/core/dynamics/sincos.hpp>

#include <cmath>

// Packing these scalars into vectors sends them through memory and costs a third of the time.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-vectorize")
#endif

namespace haptics {
namespace {

/// a cos + b sin and a sin - b cos of an angle.
struct PairTerms {
    double dot;
    double turn;
};

/// Takes k quarter turns into (a, b): bit 0 swaps, the others negate.
HAPTICS_ALWAYS_INLINE void quarter_turns(std::uint64_t k, double& a, double& b) {
    std::uint64_t a_bits;
    std::uint64_t b_bits;
    std::memcpy(&a_bits, &a, sizeof(a_bits));
    std::memcpy(&b_bits, &b, sizeof(b_bits));
    const std::uint64_t swap = (a_bits ^ b_bits) & (~(k & 1U) + 1U);
    a_bits = (a_bits ^ swap) ^ ((k & 2U) << 62U);
    b_bits = (b_bits ^ swap) ^ (((k + 1U) & 2U) << 62U);
    std::memcpy(&a, &a_bits, sizeof(a));
    std::memcpy(&b, &b_bits, sizeof(b));
}

HAPTICS_ALWAYS_INLINE bool in_range(double angle) {
    return std::fabs(angle) < k_sincos_range;
}

/// Torques of gravity about the joints' bodies, from the angles added up.
template <int N>
inline void add_gravity(const LinkageModel& model, const double* q, double* right) {
    double angle = 0.0;
    for (int i = 0; i < N; ++i) {
        angle += model.turn_offset[i + 1] + q[i];
        double s;
        double c;
        fast_sincos(angle, s, c);
        const double moment_x = c * model.chain.moment_x[i + 1] - s * model.chain.moment_y[i + 1];
        const double moment_y = s * model.chain.moment_x[i + 1] + c * model.chain.moment_y[i + 1];
        right[i] += model.gravity.y() * moment_x - model.gravity.x() * moment_y;
    }
}

/// Position, velocity and acceleration of coordinate i from the numerator of its acceleration.
HAPTICS_ALWAYS_INLINE void finish(int i, double numerator, double per_det, double h_per_det,
                                  double h2_per_det, double h, double* q, double* v, double* acceleration) {
    q[i] = (q[i] + h * v[i]) + numerator * h2_per_det;
    v[i] += numerator * h_per_det;
    acceleration[i] = numerator * per_det;
}

inline void step_one(const LinkageModel& model, LinkageData& data, const double* force, double h,
                     double* acceleration) {
    double right[1] = {force[0]};
    if (model.has_gravity) {
        add_gravity<1>(model, data.position.data(), right);
    }
    // a constant inertia: its reciprocal waits for nothing
    const double inverse = 1.0 / model.chain.diagonal[1];
    finish(0, right[0], inverse, h * inverse, h * h * inverse, h, data.position.data(), data.velocity.data(),
           acceleration);
}

inline void step_two(const LinkageModel& model, LinkageData& data, const double* force, double h,
                     double* acceleration) {
    const ChainModel& chain = model.chain;
    double* q = data.position.data();
    double* v = data.velocity.data();
    double a = chain.pair_along[0];
    double b = chain.pair_across[0];
    double r = 0.0;
    double s;
    double c;
    if (in_range(q[1])) [[likely]] {
        std::uint64_t k;
        detail::reduce_angle<double, std::uint64_t>(q[1], r, k);
        quarter_turns(k, a, b);
        detail::sincos_reduced(r, s, c);
    } else {
        fast_sincos(q[1], s, c);
    }
    const double d01 = c * a + s * b;
    double right[2] = {force[0] - force[1], force[1]};
    if (model.has_gravity) {
        add_gravity<2>(model, q, right);
    }
    if (model.coriolis) {
        const double turn = s * a - c * b;
        const double rate = v[0] + v[1];
        right[0] += turn * (rate * rate);
        right[1] -= turn * (v[0] * v[0]);
    }
    const double d00 = chain.diagonal[1];
    const double d11 = chain.diagonal[2];
    const double det = d00 * d11 - d01 * d01;
    const double h2_per_det = h * h / det;
    const double h_per_det = h / det;
    const double per_det = 1.0 / det;
    const double first = d11 * right[0] - d01 * right[1];
    const double second = d00 * right[1] - d01 * right[0];
    finish(1, second - first, per_det, h_per_det, h2_per_det, h, q, v, acceleration);
    finish(0, first, per_det, h_per_det, h2_per_det, h, q, v, acceleration);
}

/// Dots and turns of the pairs 0-1, 1-2 and 0-2 from the joint angles q[1] and q[2].
HAPTICS_ALWAYS_INLINE void three_pairs(const ChainModel& chain, const double* q, PairTerms& p01,
                                       PairTerms& p12, PairTerms& p02) {
    const Pair x = {q[1], q[2]};
    double a01 = chain.pair_along[0];
    double b01 = chain.pair_across[0];
    double a12 = chain.pair_along[1];
    double b12 = chain.pair_across[1];
    double a02 = chain.pair_along[2];
    double b02 = chain.pair_across[2];
    Pair s;
    Pair c;
    if (in_range(q[1]) && in_range(q[2])) [[likely]] {
        Pair r;
        PairBits k;
        detail::reduce_angle<Pair, PairBits>(x, r, k);
        quarter_turns(k[0], a01, b01);
        quarter_turns(k[1], a12, b12);
        quarter_turns(k[0] + k[1], a02, b02);
        detail::sincos_reduced(r, s, c);
    } else {
        for (int i = 0; i < 2; ++i) {
            double sine;
            double cosine;
            fast_sincos(x[i], sine, cosine);
            s[i] = sine;
            c[i] = cosine;
        }
    }
    const Pair a = {a01, a12};
    const Pair b = {b01, b12};
    const Pair dot = c * a + s * b;
    const Pair turn = s * a - c * b;
    p01 = {dot[0], turn[0]};
    p12 = {dot[1], turn[1]};
    const double along = c[1] * a02 + s[1] * b02;
    const double across = c[1] * b02 - s[1] * a02;
    p02 = {c[0] * along + s[0] * across, s[0] * along - c[0] * across};
}

inline void step_three(const LinkageModel& model, LinkageData& data, const double* force, double h,
                       double* acceleration) {
    const ChainModel& chain = model.chain;
    double* q = data.position.data();
    double* v = data.velocity.data();
    PairTerms p01;
    PairTerms p12;
    PairTerms p02;
    three_pairs(chain, q, p01, p12, p02);
    double right[3] = {force[0] - force[1], force[1] - force[2], force[2]};
    if (model.has_gravity) {
        add_gravity<3>(model, q, right);
    }
    if (model.coriolis) {
        const double rate1 = v[0] + v[1];
        const double rate2 = rate1 + v[2];
        const double square0 = v[0] * v[0];
        const double square1 = rate1 * rate1;
        const double square2 = rate2 * rate2;
        right[0] += p01.turn * square1 + p02.turn * square2;
        right[1] += p12.turn * square2 - p01.turn * square0;
        right[2] -= p02.turn * square0 + p12.turn * square1;
    }
    const double d00 = chain.diagonal[1];
    const double d11 = chain.diagonal[2];
    const double d22 = chain.diagonal[3];
    const double d01 = p01.dot;
    const double d12 = p12.dot;
    const double d02 = p02.dot;
    const double c00 = d11 * d22 - d12 * d12;
    const double d01_d12 = d01 * d12;
    const double det = (d00 * c00 - d22 * (d01 * d01)) + d02 * ((d01_d12 + d01_d12) - d11 * d02);
    const double h2_per_det = h * h / det;
    const double h_per_det = h / det;
    const double per_det = 1.0 / det;
    const double c01 = d02 * d12 - d01 * d22;
    const double c02 = d01_d12 - d02 * d11;
    const double c11 = d00 * d22 - d02 * d02;
    const double c12 = d01 * d02 - d00 * d12;
    const double c22 = d00 * d11 - d01 * d01;
    const double first = c00 * right[0] + (c01 * right[1] + c02 * right[2]);
    const double second = c01 * right[0] + (c11 * right[1] + c12 * right[2]);
    const double third = c02 * right[0] + (c12 * right[1] + c22 * right[2]);
    // the coordinates that the next step waits for come first
    finish(1, second - first, per_det, h_per_det, h2_per_det, h, q, v, acceleration);
    finish(2, third - second, per_det, h_per_det, h2_per_det, h, q, v, acceleration);
    finish(0, first, per_det, h_per_det, h2_per_det, h, q, v, acceleration);
}

} // namespace

void short_chain_step(const LinkageModel& model, LinkageData& data, const double* force, double dt,
                      double* acceleration) {
    switch (model.body_count) {
    case 1:
        return step_one(model, data, force, dt, acceleration);
    case 2:
        return step_two(model, data, force, dt, acceleration);
    default:
        return step_three(model, data, force, dt, acceleration);
    }
}

void describe_short_chain(LinkageModel& model) {
    ChainModel& chain = model.chain;
    constexpr int pairs[3][2] = {{1, 2}, {2, 3}, {1, 3}};
    for (int i = 0; i < 3; ++i) {
        const int first = pairs[i][0];
        const int second = pairs[i][1];
        if (second > model.body_count) {
            continue;
        }
        double offset = 0.0;
        for (int slot = first + 1; slot <= second; ++slot) {
            offset += model.turn_offset[slot];
        }
        double s;
        double c;
        fast_sincos(offset, s, c);
        const double along =
            chain.link_x[first] * chain.moment_x[second] + chain.link_y[first] * chain.moment_y[second];
        const double across =
            chain.link_y[first] * chain.moment_x[second] - chain.link_x[first] * chain.moment_y[second];
        chain.pair_along[i] = c * along + s * across;
        chain.pair_across[i] = c * across - s * along;
    }
}

} // namespace haptics
