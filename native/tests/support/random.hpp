#pragma once
/// Seeded random numbers for property tests: the same on every machine (no standard distribution, those
/// differ).

#include <cstdint>

namespace haptics::testing {

/// splitmix64 (Steele, Lea and Flood 2014): fast, and every seed is a good one.
class Random {
  public:
    explicit Random(std::uint64_t seed)
        : state_(seed) {}

    /// 64 random bits.
    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31U);
    }
    /// Uniform in [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11U) * 0x1.0p-53);
    }
    /// Uniform in 0 .. count - 1.
    int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }

  private:
    std::uint64_t state_;
};

} // namespace haptics::testing
