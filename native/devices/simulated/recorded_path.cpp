// Smooth: cubic Hermite on u = (t - t_i)/(t_{i+1} - t_i) with tangents m_i = (p_{i+1} - p_{i-1})/(t_{i+1} -
// t_{i-1}), zero at both ends:
//   p = (2u^3 - 3u^2 + 1) p_i + (u^3 - 2u^2 + u) h m_i + (3u^2 - 2u^3) p_{i+1} + (u^3 - u^2) h m_{i+1}.

#include <haptics/devices/simulated/recorded_path.hpp>

#include <cmath>
#include <utility>

namespace haptics {

RecordedPath::RecordedPath(std::vector<HandTarget> points, PathInterpolation interpolation, bool repeat)
    : points_(std::move(points))
    , interpolation_(interpolation)
    , repeat_(repeat) {}

Twist RecordedPath::tangent(std::size_t i) const {
    if (i == 0 || i + 1 == points_.size()) {
        // a closed path goes on smoothly where it starts over
        if (!repeat_ || points_.size() < 3)
            return Twist::Zero();
        const HandTarget& before = points_[points_.size() - 2];
        const double span = points_.back().time_s - before.time_s + points_[1].time_s - points_[0].time_s;
        return (points_[1].pose - points_[0].pose + points_.back().pose - before.pose) / span;
    }
    return (points_[i + 1].pose - points_[i - 1].pose) / (points_[i + 1].time_s - points_[i - 1].time_s);
}

PathSample RecordedPath::sample(double time) {
    if (points_.empty())
        return {};
    const double first = points_.front().time_s;
    const double last = points_.back().time_s;
    if (!(time > first))
        return {points_.front().pose, Twist::Zero()};
    if (time >= last) {
        if (!repeat_ || last <= first)
            return {points_.back().pose, Twist::Zero()};
        time = first + std::fmod(time - first, last - first);
    }
    // time grows from call to call, so the piece is the last one or soon after it
    if (cursor_ + 1 >= points_.size() || points_[cursor_].time_s > time)
        cursor_ = 0;
    while (cursor_ + 2 < points_.size() && points_[cursor_ + 1].time_s <= time)
        ++cursor_;
    const HandTarget& a = points_[cursor_];
    const HandTarget& b = points_[cursor_ + 1];
    const double h = b.time_s - a.time_s;
    const double u = (time - a.time_s) / h;
    if (interpolation_ == PathInterpolation::linear)
        return {a.pose + u * (b.pose - a.pose), (b.pose - a.pose) / h};
    const Twist ma = tangent(cursor_);
    const Twist mb = tangent(cursor_ + 1);
    const double u2 = u * u;
    const double u3 = u2 * u;
    PathSample sample;
    sample.pose = (2.0 * u3 - 3.0 * u2 + 1.0) * a.pose + (u3 - 2.0 * u2 + u) * h * ma +
                  (3.0 * u2 - 2.0 * u3) * b.pose + (u3 - u2) * h * mb;
    sample.velocity = (6.0 * u2 - 6.0 * u) / h * (a.pose - b.pose) + (3.0 * u2 - 4.0 * u + 1.0) * ma +
                      (3.0 * u2 - 2.0 * u) * mb;
    return sample;
}

} // namespace haptics
