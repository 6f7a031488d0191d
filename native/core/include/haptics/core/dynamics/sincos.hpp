#pragma once
/// Sine and cosine for the haptic loop: branch-free, the same bits on every machine, one or four at a time.
///
/// Derivation. k = round(x 2/pi), r = x - k pi/2 with pi/2 cut into three parts of 33 bits (Cody and Waite),
/// so that k times the first two parts is exact for |k| < 2^20. On |r| <= pi/4 the minimax polynomials of
/// fdlibm (Sun Microsystems, k_sin.c, k_cos.c) hold to 2^-58. The last two bits of k swap and negate.
/// Rounding and k's bits come from adding 1.5 2^52. Valid for |x| < 1e6; what lies beyond, infinities and NaN
/// go to the C library.

#include <cmath>
#include <cstdint>
#include <cstring>

namespace haptics {

#if defined(__GNUC__)
#define HAPTICS_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define HAPTICS_ALWAYS_INLINE inline
#endif

/// Four doubles in one value: one AVX register, or two SSE2 ones.
typedef double Lanes __attribute__((vector_size(32)));
/// Four 64-bit integers in one value.
typedef std::uint64_t LaneBits __attribute__((vector_size(32)));

namespace detail {

/// The body of both forms: `Number` is double or Lanes, `Bits` the unsigned integer of its size.
template <class Number, class Bits>
HAPTICS_ALWAYS_INLINE void sincos_in_range(const Number& x, Number& sine, Number& cosine) {
    constexpr double magic = 6755399441055744.0; // 1.5 * 2^52
    const Number shifted = x * 0.63661977236758134308 + magic;
    const Number k = shifted - magic;
    Bits quadrant;
    std::memcpy(&quadrant, &shifted, sizeof(quadrant));
    const Number r = (x - k * 1.57079632673412561417e+00) -
                     (k * 6.07710050630396597660e-11 + k * 2.02226624879595063154e-21);
    // polynomials in pairs (Estrin): shorter chains than Horner's
    const Number z = r * r;
    const Number z2 = z * z;
    const Number z4 = z2 * z2;
    const Number s0 = -1.66666666666666324348e-01 + z * 8.33333333332248946124e-03;
    const Number s1 = -1.98412698298579493134e-04 + z * 2.75573137070700676789e-06;
    const Number s2 = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10;
    const Number s = r + (r * z) * ((s0 + z2 * s1) + z4 * s2);
    const Number c0 = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
    const Number c1 = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
    const Number c2 = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
    const Number half = z * 0.5;
    const Number one_less = 1.0 - half;
    const Number c = one_less + (((1.0 - one_less) - half) + z2 * ((c0 + z2 * c1) + z4 * c2));
    Bits s_bits;
    Bits c_bits;
    std::memcpy(&s_bits, &s, sizeof(s_bits));
    std::memcpy(&c_bits, &c, sizeof(c_bits));
    const Bits one = quadrant & 1U;
    const Bits swap = (s_bits ^ c_bits) & (~one + 1U);
    s_bits = (s_bits ^ swap) ^ ((quadrant & 2U) << 62U);
    c_bits = (c_bits ^ swap) ^ (((quadrant + 1U) & 2U) << 62U);
    std::memcpy(&sine, &s_bits, sizeof(sine));
    std::memcpy(&cosine, &c_bits, sizeof(cosine));
}

} // namespace detail

/// Largest |x| (rad) of the fast path.
inline constexpr double k_sincos_range = 1e6;

/// Sine and cosine of x (rad), within 1 unit in the last place of 1.
inline void fast_sincos(double x, double& sine, double& cosine) {
    if (std::fabs(x) < k_sincos_range) [[likely]] {
        detail::sincos_in_range<double, std::uint64_t>(x, sine, cosine);
        return;
    }
    sine = std::sin(x);
    cosine = std::cos(x);
}

} // namespace haptics
