// How long a touched body is on its way from where it is shown to where the new snapshot has it, and how.
//
// A blend that takes T for the difference e goes at up to 1.9 e / T, with an acceleration of up to 5.8 e /
// T^2 and a jerk of 60 e / T^3; for a difference r of the rates alone these are r, 2.4 r / T and 12 r / T^2,
// for one of the accelerations, c, they are 0.1 c T, c and 9 c / T. An update may change the force F by max(7
// %, 0.05 N) in a step h, of which k_share is used. Two ways lead there.
//
// Unfelt: the correction of our own error was no motion, and the damper does not act on it, nor does what
// sticks lose its anchor by it. The spring gives K (1.9 e / T + r) h in a step; the damper sees the
// difference w of the velocities go in T, (1.5 w / T + a) B h. But a wall that draws back unfelt leaves a
// tool behind that the damper holds, so it may draw back by a part of the spring's deflection F / K only.
//
// Felt: the body moves, for all that touches it. The step in force is that of a spring and damper,
// K (1.9 e / T + r) h and B (5.8 e / T^2 + 2.4 r / T + c) h, or, where the tool's mass m follows, that of its
// inertia, m (60 e / T^3 + 12 r / T^2 + 9 c / T) h; the smaller counts.
//
// The shorter of the two is taken, and one tick wherever that is enough.

#include "gentle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "internal.hpp"

namespace haptics::local {
namespace {

constexpr double k_share = 0.8;
constexpr double k_least_change = 0.05;
constexpr double k_change = 0.07;
// an update may change the force by that in a step of 1 ms, or a longer one
constexpr double k_least_step = 0.001;
// part of the deflection by which a body may draw back unfelt
constexpr double k_draw_back = 0.3;

constexpr double k_least_rest = 0.1;

struct Times {
    double unfelt{0.0};
    double felt{0.0};
};

double most_change(const Patch& p) {
    return k_share * std::max(k_change * p.memory.normal_force, k_least_change);
}

// T of c / T + d / T^2 = 1
double time_of(double first, double second) {
    return 0.5 * (first + std::sqrt(first * first + 4.0 * second));
}

// what is left of a bound, but not nothing
double rest_of(double most, double used) {
    return std::max(most - used, k_least_rest * most);
}

// sizes of the differences at a point, as in PathOffset
struct Sizes {
    double pose, rate, bend, velocity, acceleration;
};

void add_point(const Patch& p, double mass, double step, const Sizes& d, Times& times) {
    const double most = most_change(p) / step;
    const auto [stiffness, damping] = std::pair{p.surface.stiffness, p.surface.damping};
    const double springs = 1.9 * stiffness * d.pose / rest_of(most, stiffness * d.rate);
    const double drags = 1.5 * damping * d.velocity / rest_of(most, damping * d.acceleration);
    times.unfelt = std::max({times.unfelt, springs, drags});
    const double left = rest_of(most, damping * d.bend);
    const double damps = time_of(2.4 * damping * d.rate / left, 5.8 * damping * d.pose / left);
    // enough for the three together
    const double inertia = std::cbrt(60.0 * mass * d.pose / most) + std::sqrt(12.0 * mass * d.rate / most) +
                           9.0 * mass * d.bend / most;
    times.felt = std::max(times.felt, std::min(std::max(springs, damps), inertia));
}

// calls `visit(patch, point)` for all points where neighbor `i` is touched
template <class Visit>
void visit_touched(const Data& data, std::int32_t body, const Visit& visit) {
    for (std::int32_t k = 0; k < data.patches.count; ++k) {
        const Patch& p = data.patches.patch[static_cast<std::size_t>(k)];
        if (p.memory.state == ContactState::none || (p.body_a != body && p.body_b != body))
            continue;
        for (std::int32_t n = 0; n < p.point_count; ++n)
            visit(p, p.point[static_cast<std::size_t>(n)].position);
    }
}

} // namespace

Blending gentle_blending(const Data& data, std::int32_t i, const PathOffset& by, double least, double most) {
    const std::int32_t body = i + data.tool.body_count;
    const Vec2 origin = data.neighbors.body[static_cast<std::size_t>(i)].pose.head<2>();
    const double step = std::max(data.step_length, k_least_step);
    Times times;
    bool touched = false;
    visit_touched(data, body, [&](const Patch& p, const Vec2& at) {
        touched = true;
        const Body& other = body_of(data, p.body_a == body ? p.body_b : p.body_a);
        const double mass = data.tool_mass + (other.kind == BodyKind::movable ? other.mass : 0.0);
        const auto size = [&](const Vec3& of) {
            const Vec2 v = velocity_at(of, at - origin);
            return p.memory.state == ContactState::sticking ? v.norm() : std::abs(p.normal.dot(v));
        };
        add_point(p, mass, step,
                  {size(by.pose), size(by.rate), size(by.bend), size(by.velocity), size(by.acceleration)},
                  times);
    });
    if (!touched)
        return {least, 1.0};
    const double felt = std::clamp(times.felt, least, most);
    const double unfelt = std::max(times.unfelt, least);
    bool keeps = unfelt <= felt;
    visit_touched(data, body, [&](const Patch& p, const Vec2& at) {
        // what is left of the way when the velocity that is felt has done its part
        for (const Pose& way : {by.pose, Pose(by.pose + 0.5 * unfelt * by.velocity)}) {
            const double away = (p.body_b == body ? 1.0 : -1.0) * p.normal.dot(velocity_at(way, at - origin));
            keeps = keeps && p.surface.stiffness * away <= k_draw_back * p.memory.normal_force;
        }
    });
    return keeps ? Blending{unfelt, 0.0} : Blending{felt, 1.0};
}

double gentle_time(const Data& data, const Surface& surface, double distance) {
    Patch p;
    p.surface = surface;
    Times times;
    add_point(p, data.tool_mass, std::max(data.step_length, k_least_step), {distance, 0.0, 0.0, 0.0, 0.0},
              times);
    return times.felt;
}

} // namespace haptics::local
