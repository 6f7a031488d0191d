/// How fast this core is at the moment: 64 additions, `yardstick/chained` each waiting for the one before,
/// `yardstick/side_by_side` four at a time. A core to itself does the second nearly four times as fast; much
/// less means that its other half was busy and all times are too long.

#include <benchmark/benchmark.h>

#include <cstdint>

namespace {

constexpr int k_additions = 64;

void chained(benchmark::State& state) {
    std::uint64_t a = 0;
    for (auto _ : state) {
#pragma GCC unroll 64
        for (int i = 0; i < k_additions; ++i) {
            a += 1;
            // in a register, and not folded with the next one
            asm volatile("" : "+r"(a));
        }
    }
}

void side_by_side(benchmark::State& state) {
    std::uint64_t a = 0;
    std::uint64_t b = 0;
    std::uint64_t c = 0;
    std::uint64_t d = 0;
    for (auto _ : state) {
#pragma GCC unroll 16
        for (int i = 0; i < k_additions / 4; ++i) {
            a += 1;
            b += 1;
            c += 1;
            d += 1;
            asm volatile("" : "+r"(a), "+r"(b), "+r"(c), "+r"(d));
        }
    }
}

BENCHMARK(chained)->Name("yardstick/chained");
BENCHMARK(side_by_side)->Name("yardstick/side_by_side");

} // namespace
