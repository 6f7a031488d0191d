#pragma once
/// Kernels compiled twice, for baseline x86-64 and for AVX2, and chosen at load. Fused multiply-add stays
/// off, so that both give the same bits.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(HAPTICS_NO_MULTIVERSION)
#define HAPTICS_MULTIVERSION 1
#define HAPTICS_AVX2 [[gnu::target("avx2"), gnu::noinline]]
#else
#define HAPTICS_MULTIVERSION 0
#endif
#if defined(__GNUC__)
#define HAPTICS_BASELINE [[gnu::noinline]]
#else
#define HAPTICS_BASELINE
#endif

namespace haptics {

#if HAPTICS_MULTIVERSION
/// This machine has AVX2. Set while the library loads, false before that.
extern const bool k_has_avx2;
#endif

} // namespace haptics
