#include <haptics/core/contact/body_cache.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

void BodyCache::update(const BodySet& set) {
    if (known)
        return;
    compute_bounds(set, bounds);
    // equal to no place
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    std::fill_n(place_.begin(), set.body_count, Place{k_none, k_none, k_none, 1.0, 0.0});
    known = true;
}

Transform BodyCache::place(const BodySet& set, std::int32_t i) {
    const Body& body = set.body[static_cast<std::size_t>(i)];
    Place& p = place_[static_cast<std::size_t>(i)];
    if (p.angle != body.pose.z()) {
        p.angle = body.pose.z();
        p.cosine = std::cos(p.angle);
        p.sine = std::sin(p.angle);
        p.x = std::numeric_limits<double>::quiet_NaN();
    }
    if (p.x != body.pose.x() || p.y != body.pose.y()) {
        p.x = body.pose.x();
        p.y = body.pose.y();
        std::fill_n(is_placed_.begin() + body.first_piece, body.piece_count, false);
    }
    Transform at;
    at.origin = body.pose.head<2>();
    at.cosine = p.cosine;
    at.sine = p.sine;
    return at;
}

} // namespace haptics
