#pragma once
/// A motion as it is compared with another one: samples at equal times, whatever the rate that made them.

#include <haptics/core/types.hpp>

#include <vector>

namespace haptics::sweep {

/// Time between two samples, s: a whole number of steps at every rate of the sweeps.
inline constexpr double k_sample_time = 0.004;

struct Sample {
    /// The point that is compared (center of the tool, tip of a linkage), m.
    Vec2 position{0.0, 0.0};
    /// Of the tool: motion, weight, steady push and normal contact springs, J.
    double energy{0.0};
    /// Of all contact forces and collisions on the tool since the start, N s.
    Vec2 impulse{0.0, 0.0};
};

using Track = std::vector<Sample>;

/// Distance between two tracks.
struct TrackError {
    double position_rms{0.0}; ///< m
    double position_max{0.0}; ///< m
    double force_rms{0.0};    ///< of the mean force between two samples, N
    double energy_max{0.0};   ///< J
};

/// Compares sample by sample. A track that is shorter, or not finite, is infinitely far away.
[[nodiscard]] TrackError compare(const Track& track, const Track& reference);

} // namespace haptics::sweep
