#include <haptics/sweep/track.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics::sweep {

namespace {

bool is_finite(const Sample& s) {
    return s.position.allFinite() && std::isfinite(s.energy) && s.impulse.allFinite();
}

} // namespace

TrackError compare(const Track& track, const Track& reference) {
    constexpr double k_infinite = std::numeric_limits<double>::infinity();
    const TrackError lost{k_infinite, k_infinite, k_infinite, k_infinite};
    if (track.size() != reference.size() || track.empty())
        return lost;
    TrackError e;
    Vec2 offset = Vec2::Zero();
    for (std::size_t i = 0; i < track.size(); ++i) {
        if (!is_finite(track[i]) || !is_finite(reference[i]))
            return lost;
        const double distance = (track[i].position - reference[i].position).norm();
        e.position_rms += distance * distance;
        e.position_max = std::max(e.position_max, distance);
        // the mean force between two samples is the change of impulse over their distance in time
        const Vec2 now = track[i].impulse - reference[i].impulse;
        e.force_rms += ((now - offset) / k_sample_time).squaredNorm();
        offset = now;
        e.energy_max = std::max(e.energy_max, std::abs(track[i].energy - reference[i].energy));
    }
    const auto count = static_cast<double>(track.size());
    e.position_rms = std::sqrt(e.position_rms / count);
    e.force_rms = std::sqrt(e.force_rms / count);
    return e;
}

} // namespace haptics::sweep
