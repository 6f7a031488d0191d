#pragma once
/// Sine and cosine for the haptic loop: branch-free, the same bits on every machine, one, two or four at a
/// time.
///
/// Derivation. k = round(x 2/pi), r = x - k pi/2 with pi/2 cut into a part of 33 bits and the rest (Cody and
/// Waite), so that k times the first part is exact for |k| < 2^20 and the rest adds at most 2^-67. On |r| <=
/// pi/4 the minimax polynomials of fdlibm (Sun Microsystems, k_sin.c, k_cos.c) hold to 2^-58. The last two
/// bits of k swap and negate. Rounding and k's bits come from adding 1.5 2^52. Valid for |x| < 1e6; what lies
/// beyond, infinities and NaN go to the C library.

#include <cmath>
#include <cstdint>
#include <cstring>

namespace haptics {

#if defined(__GNUC__)
#define HAPTICS_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define HAPTICS_ALWAYS_INLINE inline
#endif

/// Two doubles in one value: one SSE2 register.
typedef double Pair __attribute__((vector_size(16)));
/// Two 64-bit integers in one value.
typedef std::uint64_t PairBits __attribute__((vector_size(16)));
/// Four doubles in one value: one AVX register, or two SSE2 ones.
typedef double Lanes __attribute__((vector_size(32)));
/// Four 64-bit integers in one value.
typedef std::uint64_t LaneBits __attribute__((vector_size(32)));

namespace detail {

/// x = r + k pi/2 with |r| <= pi/4; the last bits of `quadrant` are those of k.
/// `Number` is double or a vector of doubles, `Bits` the unsigned integers of its size.
template <class Number, class Bits>
HAPTICS_ALWAYS_INLINE void reduce_angle(const Number& x, Number& r, Bits& quadrant) {
    constexpr double magic = 6755399441055744.0; // 1.5 * 2^52
    const Number shifted = x * 0.63661977236758134308 + magic;
    const Number k = shifted - magic;
    std::memcpy(&quadrant, &shifted, sizeof(quadrant));
    r = (x - k * 1.57079632673412561417e+00) - k * 6.07710050650619224932e-11;
}

/// Sine and cosine of |r| <= pi/4. The powers are multiplied into the polynomials early, so that as little as
/// possible is left to do when the last of them is there.
template <class Number>
HAPTICS_ALWAYS_INLINE void sincos_reduced(const Number& r, Number& sine, Number& cosine) {
    const Number z = r * r;
    const Number z2 = z * z;
    const Number r3 = r * z;
    const Number s0 = -1.66666666666666324348e-01 + z * 8.33333333332248946124e-03;
    const Number s1 = -1.98412698298579493134e-04 + z * 2.75573137070700676789e-06;
    const Number s2 = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10;
    const Number z4 = z2 * z2;
    sine = r + ((r3 * s0 + (r3 * z2) * s1) + (r3 * z4) * s2);
    const Number c0 = 4.16666666666666019037e-02 + z * -1.38888888888741095749e-03;
    const Number c1 = 2.48015872894767294178e-05 + z * -2.75573143513906633035e-07;
    const Number c2 = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
    cosine = 1.0 - (z * 0.5 - ((z2 * c0 + z4 * c1) + (z2 * z4) * c2));
}

/// The body of all forms.
template <class Number, class Bits>
HAPTICS_ALWAYS_INLINE void sincos_in_range(const Number& x, Number& sine, Number& cosine) {
    Number r;
    Bits quadrant;
    reduce_angle<Number, Bits>(x, r, quadrant);
    Number s;
    Number c;
    sincos_reduced(r, s, c);
    Bits s_bits;
    Bits c_bits;
    std::memcpy(&s_bits, &s, sizeof(s_bits));
    std::memcpy(&c_bits, &c, sizeof(c_bits));
    const Bits one = quadrant & 1U;
    const Bits swap = (s_bits ^ c_bits) & (~one + 1U);
    s_bits = (s_bits ^ ((quadrant & 2U) << 62U)) ^ swap;
    c_bits = (c_bits ^ (((quadrant + 1U) & 2U) << 62U)) ^ swap;
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
