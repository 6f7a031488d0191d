// The path of a neighbor that the scene moves.
//
// Extrapolation. At the age t of a snapshot the pose is x + v t + a t^2 / 2 + j t^3 / 6, up to t = reach (two
// ticks and the known latency). From there the body is brought to rest within k_rest = 50 ms: with
// u = (t - reach) / k_rest its speed falls as 1 - 3 u^2 + 2 u^3 without a kink, and it travels
// v k_rest (u - u^3 + u^4 / 2) more.
//
// Derivatives. With x and v alone the error grows as a t^2 / 2: 0.1 m/s^2 seen 100 ms late are 0.5 mm, 7 N on
// a wall of 15000 N/m, and all of it is corrected anew at every tick. The rate of change of v over the last
// two snapshots, s = (v_k - v_k-1) / dt, is the acceleration half a dt ago, and the change of s the jerk:
//     j = (s_k - s_k-1) / ((dt_k + dt_k-1) / 2),  a = s_k + j (dt_k + c tick) / 2.
// They are used only where the motion is smooth: the weight w = 2 - 3 |s_k - s_k-1| / S, within 0..1, with S
// the size of s of late (fading over k_memory), is 0 when a body starts, stops, turns back or is only
// noise, and 1 once two rates agree within a third.
// A scene that differences poses tells v half a tick late. Told velocities are then short by c s tick / 2
// with c = 1 (c = 0 when they are true), which shows in the distance travelled:
//     (x_k - x_k-1) / dt - (v_k + v_k-1) / 2 = c s tick / 2;
// c is the least-squares fit of that over the last k_late_memory or so snapshots, within 0..1.
//
// Joining. A new snapshot seldom puts a body where it is shown. The difference e at the time of taking, with
// its first two derivatives, is taken away over one tick, T, by the polynomial of degree 5 in u that starts
// with these and ends with three zeros,
//     (1 - u)^3 (e + (v + 3 e) u + (a / 2 + 3 v + 6 e) u^2),  v = e' T,  a = e'' T^2.
// So pose, velocity and acceleration go on without a jump: a linear blend would kick a contact damper B
// with B e / T.
//
// Coming back. A body whose snapshot came so late that it had begun to come to rest has to make up for more
// than an update corrects; in one tick it would be thrown at the tool. It takes the longer the farther it
// had come to rest, up to k_back, and the snapshots that come meanwhile end the blend no sooner. Its ends
// are as far apart as those of coming to rest and back at speed: what stopped gently starts gently.

#include "path.hpp"

#include <algorithm>
#include <cmath>

namespace haptics::local {
namespace {

constexpr double k_rest = 0.05;
constexpr double k_back = 0.1;
// time in which the size of past accelerations is forgotten, s
constexpr double k_memory = 0.7;
constexpr double k_late_memory = 10.0;

} // namespace

void estimate(const Track& before, Track& track) {
    const double dt = track.time - before.time;
    if (dt <= 0.0 || dt > k_memory)
        return;
    track.interval = dt;
    track.slope = (track.told - before.told) / dt;
    const Vec3 change = track.slope - before.slope;
    const Vec3 drift = (track.pose - before.pose) / dt - 0.5 * (track.told + before.told);
    const Vec3 half = 0.5 * track.tick * track.slope;
    const Vec3 jerk =
        before.interval > 0.0 ? Vec3(change / (0.5 * (dt + before.interval))) : Vec3(Vec3::Zero());
    // translation and turning are judged apart
    for (const std::size_t part : {0U, 1U}) {
        const Vec3 axes = part == 0 ? Vec3(1.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
        const auto size = [&axes](const Vec3& v) { return v.cwiseProduct(axes).norm(); };
        // how late are the told velocities?
        constexpr double k_keep = 1.0 - 1.0 / k_late_memory;
        track.late_sum[part] = k_keep * before.late_sum[part] + drift.dot(half.cwiseProduct(axes));
        track.late_weight[part] = k_keep * before.late_weight[part] + half.dot(half.cwiseProduct(axes));
        // is the motion smooth?
        track.size[part] =
            std::max({size(track.slope), size(before.slope), (1.0 - dt / k_memory) * before.size[part]});
        if (before.interval <= 0.0 || track.size[part] <= 0.0 || track.late_weight[part] <= 0.0)
            continue;
        const double late = std::clamp(track.late_sum[part] / track.late_weight[part], 0.0, 1.0);
        const double weight = std::clamp(2.0 - 3.0 * size(change) / track.size[part], 0.0, 1.0);
        const Vec3 acceleration = track.slope + 0.5 * (dt + late * track.tick) * jerk;
        track.jerk += weight * jerk.cwiseProduct(axes);
        track.acceleration += weight * acceleration.cwiseProduct(axes);
        track.velocity += weight * late * half.cwiseProduct(axes);
    }
}

PathPoint extrapolated(const Track& t, double time) {
    if (t.still)
        return {t.pose, t.velocity, Vec3::Zero()};
    const double age = time - t.time;
    const double run = std::clamp(age, -t.reach, t.reach); // a tick's own time may lie ahead of the loop's
    PathPoint p{t.pose + run * (t.velocity + run * (0.5 * t.acceleration + run / 6.0 * t.jerk)),
                t.velocity + run * (t.acceleration + 0.5 * run * t.jerk), t.acceleration + run * t.jerk};
    if (age <= t.reach)
        return p;
    const double u = std::min((age - t.reach) / k_rest, 1.0);
    p.pose += k_rest * u * (1.0 - u * u * (1.0 - 0.5 * u)) * p.velocity;
    p.acceleration = -6.0 * u * (1.0 - u) / k_rest * p.velocity;
    p.velocity *= 1.0 - u * u * (3.0 - 2.0 * u);
    return p;
}

PathPoint shown(const Track& t, double time) {
    PathPoint p = extrapolated(t, time);
    const double u = (time - t.taken) / t.blend;
    if (u < 0.0 || u >= 1.0)
        return p;
    const double w = 1.0 - u;
    const Vec3 v = t.blend * t.offset_velocity;
    const Vec3 c1 = v + 3.0 * t.offset;
    const Vec3 c2 = 0.5 * t.blend * t.blend * t.offset_acceleration + 3.0 * v + 6.0 * t.offset;
    const Vec3 q = t.offset + u * (c1 + u * c2);
    const Vec3 q1 = c1 + 2.0 * u * c2;
    p.pose += w * w * w * q;
    p.velocity += w * w * (w * q1 - 3.0 * q) / t.blend;
    p.acceleration += w * (2.0 * w * w * c2 - 6.0 * w * q1 + 6.0 * q) / (t.blend * t.blend);
    return p;
}

double blend_time(const Track& before, const Track& t) {
    const double stopped = t.taken - before.time - before.reach;
    const double back = std::min(2.0 * std::max(stopped, 0.0), k_back);
    return std::max({t.tick, back, before.taken + before.blend - t.taken});
}

void join(const PathPoint& from, Track& t) {
    const PathPoint to = extrapolated(t, t.taken);
    t.offset = from.pose - to.pose;
    t.offset_velocity = from.velocity - to.velocity;
    t.offset_acceleration = from.acceleration - to.acceleration;
}

} // namespace haptics::local
