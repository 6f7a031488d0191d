// The path of a neighbor that the scene moves.
//
// Extrapolation. At the age t of a snapshot the pose is x + v t + a t^2 / 2 + j t^3 / 6 + s t^4 / 24, up to
// t = reach (two ticks and the known latency). From there the body is brought to rest within k_rest = 50 ms:
// with u = (t - reach) / k_rest its speed falls as 1 - 3 u^2 + 2 u^3 without a kink, and it travels
// v k_rest (u - u^3 + u^4 / 2) more.
//
// Derivatives. With x and v alone the error grows as a t^2 / 2: 0.1 m/s^2 seen 100 ms late are 0.5 mm, 7 N on
// a wall of 15000 N/m, and all of it is corrected anew at every tick. The told velocities v_0 (now), v_1, ...
// have the divided differences d1 = (v_0 - v_1) / (t_0 - t_1), d2, d3, and Newton's polynomial through them
// has at t_0, with p_i = t_0 - t_i,
//     a = d1 + p_1 d2 + p_1 p_2 d3,  j = 2 d2 + 2 (p_1 + p_2) d3,  s = 6 d3.
// They are used only where the motion is smooth: the weight w = 2 - 3 |d1 - d1'| / S, within 0..1, with d1'
// the slope before and S the size of slopes of late (fading over k_memory), is 0 when a body starts, stops,
// turns back or is only noise, and 1 once two rates agree within a third. Poses are rounded somewhere (15 nm
// in a scene of 1000 pixels), and a term of order k magnifies the noise of a velocity by (t / spacing)^k. So
// the last velocities one after the other, with d3, are taken where d3 agrees in the same way with the one
// before, now and of late; where it does not, velocities that are k_apart reaches from each other, without
// d3. A scene that differences poses tells v half a tick late. Told velocities are then short by c a tick / 2
// with c = 1 (c = 0 when they are true), which shows in the distance travelled, with a of half a step ago:
//     (x_0 - x_1) / dt - (v_0 + v_1) / 2 + d2 dt^2 / 6 = c a tick / 2;
// c is the least-squares fit of that over the last k_late_memory seconds or so, within 0..1, and the
// derivatives above hold c tick / 2 before the snapshot: where ticks change their length T, told velocities
// are not as far apart as their snapshots, but dt - c (T_0 - T_1) / 2.
//
// Joining. A new snapshot seldom puts a body where it is shown. The difference e at the time of taking, with
// its first two derivatives, is taken away over one tick, T, by the polynomial of degree 5 in u that starts
// with these and ends with three zeros,
//     (1 - u)^3 (e + (v + 3 e) u + (a / 2 + 3 v + 6 e) u^2),  v = e' T,  a = e'' T^2.
// So pose, velocity and acceleration go on without a jump: a linear blend would kick a contact damper B
// with B e / T.
//
// What contacts feel. That way costs a speed of up to 1.9 e / T, which is the correction of our own error and
// no motion of the body. A damper that felt it would push with B times that: 200 N s/m turn 10 um in 8 ms
// into 0.5 N. So contacts feel the velocity of the path and a difference w of its own, which starts where
// they left off, with its slope, and is gone with the rest: (1 - u)^2 (w + (2 w + w' T) u). The pose moves by
// the rest beside it, and friction's anchors are moved along (neighbors.cpp). Where the correction is too
// large for that, it is felt as motion and takes longer (gentle.cpp).
//
// Coming back. A body whose snapshot came so late that it had begun to come to rest has to make up for more
// than an update corrects; in one tick it would be thrown at the tool. It takes the longer the farther it
// had come to rest, up to k_back, and the snapshots that come meanwhile end the blend no sooner. Its ends
// are as far apart as those of coming to rest and back at speed: what stopped gently starts gently. A body
// that is in nobody's way has its one tick (neighbors.cpp).

#include "path.hpp"

#include <algorithm>
#include <cmath>

namespace haptics::local {
namespace {

constexpr double k_rest = 0.05;
constexpr double k_back = 0.1;
// time in which the size of past accelerations is forgotten, s
constexpr double k_memory = 0.7;
constexpr double k_late_memory = 1.0;
// how far apart told velocities are used that are not exact, in terms of the reach
constexpr double k_apart = 0.2;

void remember(const Track& before, Track& track) {
    track.past_count = std::min(before.past_count + 1, k_past_velocities);
    track.past[0] = {before.time, before.tick, before.told};
    std::copy_n(before.past.begin(), track.past_count - 1, track.past.begin() + 1);
}

// Divided differences of the last told velocities that are at least `apart` s from each other, each of them
// `late` half ticks late; what takes more of them than there are is 0.
class Differences {
  public:
    Differences(const Track& t, double apart, double late) {
        add(t.time - 0.5 * late * t.tick, t.told);
        double newer = t.time;
        for (std::int32_t i = 0; i < t.past_count && count_ < k_nodes; ++i) {
            const PastVelocity& p = t.past[static_cast<std::size_t>(i)];
            const double time = p.time - 0.5 * late * p.tick;
            if (time_[static_cast<std::size_t>(count_ - 1)] - time < std::max(apart, 0.25 * (newer - p.time)))
                continue;
            add(time, p.told);
            newer = p.time;
        }
    }
    [[nodiscard]] int count() const { return count_; }
    // of the order `k`, over the nodes from `i` on, the newest being 0
    [[nodiscard]] const Vec3& of(int k, int i) const {
        return table_[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)];
    }
    // from the newest to node `i`, s
    [[nodiscard]] double span(int i) const { return time_[0] - time_[static_cast<std::size_t>(i)]; }

  private:
    static constexpr int k_nodes = 5;

    void add(double time, const Twist& told) {
        const auto n = static_cast<std::size_t>(count_++);
        time_[n] = time;
        table_[0][n] = told;
        for (std::size_t k = 1; k <= n; ++k)
            table_[k][n - k] = (table_[k - 1][n - k] - table_[k - 1][n - k + 1]) / (time_[n - k] - time_[n]);
    }

    int count_{0};
    std::array<double, k_nodes> time_{};
    std::array<std::array<Vec3, k_nodes>, k_nodes> table_{zero_table()};

    static std::array<std::array<Vec3, k_nodes>, k_nodes> zero_table() {
        std::array<std::array<Vec3, k_nodes>, k_nodes> table;
        for (auto& row : table)
            row.fill(Vec3::Zero());
        return table;
    }
};

// 1 where a difference agrees with the one before within a third of its recent size, 0 where by less than two
double agreement(double change, double size) {
    return size > 0.0 ? std::clamp(2.0 - 3.0 * change / size, 0.0, 1.0) : 0.0;
}

// coefficients of the two polynomials by which an offset goes
struct Blend {
    explicit Blend(const Track& t)
        : c1(t.blend * t.offset.rate + 3.0 * t.offset.pose)
        , c2(0.5 * t.blend * t.blend * t.offset.bend + 3.0 * t.blend * t.offset.rate + 6.0 * t.offset.pose)
        , felt(2.0 * t.offset.velocity + t.blend * t.offset.acceleration) {}
    Vec3 c1;
    Vec3 c2;
    Vec3 felt;
};

// how late the told velocities were so far, in half ticks
double lateness(const Track& t) {
    const std::size_t part = t.late_weight[0] > 0.0 ? 0 : 1;
    return t.late_weight[part] > 0.0 ? std::clamp(t.late_sum[part] / t.late_weight[part], 0.0, 1.0) : 0.0;
}

} // namespace

void estimate(const Track& before, Track& track) {
    const double dt = track.time - before.time;
    if (dt <= 0.0 || dt > k_memory)
        return;
    remember(before, track);
    const double late_so_far = lateness(before);
    const Differences fine(track, 0.0, late_so_far);
    const Differences coarse(track, k_apart * track.reach, late_so_far);
    const double keep = std::max(0.0, 1.0 - dt / k_late_memory);
    const double fade = 1.0 - dt / k_memory;
    // the trapezoid's rule misses a jerk
    const Vec3 drift =
        (track.pose - before.pose) / dt - 0.5 * (track.told + before.told) + dt * dt / 6.0 * fine.of(2, 0);
    const Vec3 lag = 0.25 * (track.tick + before.tick) * fine.of(1, 0);
    // translation and turning are judged apart
    for (const std::size_t part : {0U, 1U}) {
        const Vec3 axes = part == 0 ? Vec3(1.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
        const auto size = [&axes](const Vec3& v) { return v.cwiseProduct(axes).norm(); };
        track.slope_size[part] =
            std::max({size(fine.of(1, 0)), size(fine.of(1, 1)), fade * before.slope_size[part]});
        track.third_size[part] =
            std::max({size(fine.of(3, 0)), size(fine.of(3, 1)), fade * before.third_size[part]});
        track.third_change[part] =
            std::max(size(fine.of(3, 0) - fine.of(3, 1)), fade * before.third_change[part]);
        track.late_sum[part] = keep * before.late_sum[part];
        track.late_weight[part] = keep * before.late_weight[part];
        if (fine.count() < 3)
            continue;
        // how late are the told velocities?
        track.late_sum[part] += dt * drift.dot(lag.cwiseProduct(axes));
        track.late_weight[part] += dt * lag.dot(lag.cwiseProduct(axes));
        if (track.late_weight[part] <= 0.0)
            continue;
        const double late =
            0.5 * track.tick * std::clamp(track.late_sum[part] / track.late_weight[part], 0.0, 1.0);
        // is the motion smooth, and are the told velocities exact?
        const double exact =
            fine.count() < 5 ? 0.0 : agreement(track.third_change[part], track.third_size[part]);
        const auto add = [&](const Differences& d, double share, const Vec3& third) {
            if (d.count() < 3)
                return;
            const Vec3 use = share * agreement(size(d.of(1, 0) - d.of(1, 1)), track.slope_size[part]) * axes;
            // the derivatives at the snapshot, `late` after what was told
            const Vec3 snap = 6.0 * third;
            const Vec3 jerk = 2.0 * (d.of(2, 0) + (d.span(1) + d.span(2)) * third);
            const Vec3 acceleration = d.of(1, 0) + d.span(1) * (d.of(2, 0) + d.span(2) * third);
            track.snap += use.cwiseProduct(snap);
            track.jerk += use.cwiseProduct(jerk + late * snap);
            track.acceleration += use.cwiseProduct(acceleration + late * (jerk + 0.5 * late * snap));
            track.velocity +=
                use.cwiseProduct(late * (acceleration + 0.5 * late * (jerk + late / 3.0 * snap)));
        };
        add(fine, exact, fine.of(3, 0));
        add(coarse, 1.0 - exact, Vec3::Zero());
    }
}

PathPoint extrapolated(const Track& t, double time) {
    if (t.still)
        return moving_point(t.pose, t.velocity, Vec3::Zero());
    const double age = time - t.time;
    const double run = std::clamp(age, -t.reach, t.reach); // a tick's own time may lie ahead of the loop's
    const auto at = [run, &t](double a, double j, double s) {
        return Vec3(a * t.acceleration + run * (j * t.jerk + run * s * t.snap));
    };
    const Pose pose = t.pose + run * (t.velocity + run * at(1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0));
    const Twist velocity = t.velocity + run * at(1.0, 1.0 / 2.0, 1.0 / 6.0);
    if (age <= t.reach)
        return moving_point(pose, velocity, at(1.0, 1.0, 1.0 / 2.0));
    const double u = std::min((age - t.reach) / k_rest, 1.0);
    return moving_point(pose + k_rest * u * (1.0 - u * u * (1.0 - 0.5 * u)) * velocity,
                        (1.0 - u * u * (3.0 - 2.0 * u)) * velocity, -6.0 * u * (1.0 - u) / k_rest * velocity);
}

PathPoint shown(const Track& t, double time) {
    PathPoint p = extrapolated(t, time);
    const double u = (time - t.taken) / t.blend;
    if (u < 0.0 || u >= 1.0)
        return p;
    const double w = 1.0 - u;
    const PathOffset& o = t.offset;
    const Blend blend(t);
    const Vec3 q = o.pose + u * (blend.c1 + u * blend.c2);
    const Vec3 q1 = blend.c1 + 2.0 * u * blend.c2;
    const Twist rate = w * w * (w * q1 - 3.0 * q) / t.blend;
    const Vec3 bend = w * (2.0 * w * w * blend.c2 - 6.0 * w * q1 + 6.0 * q) / (t.blend * t.blend);
    p.pose += w * w * w * q;
    p.rate += rate;
    p.bend += bend;
    p.velocity += t.felt * rate + w * w * (o.velocity + u * blend.felt);
    p.acceleration += t.felt * bend + w * (w * blend.felt - 2.0 * (o.velocity + u * blend.felt)) / t.blend;
    return p;
}

Pose corrected(const Track& t, double time) {
    const double u = std::clamp((time - t.taken) / t.blend, 0.0, 1.0);
    const double w = 1.0 - u;
    const PathOffset& o = t.offset;
    const Blend blend(t);
    const Vec3 felt =
        (1.0 - w * w * w) / 3.0 * o.velocity + u * u * (0.5 - u * (2.0 / 3.0 - 0.25 * u)) * blend.felt;
    return (1.0 - t.felt) * (w * w * w * (o.pose + u * (blend.c1 + u * blend.c2)) - o.pose) - t.blend * felt;
}

double blend_time(const Track& before, const Track& t) {
    const double stopped = t.taken - before.time - before.reach;
    const double back = std::min(2.0 * std::max(stopped, 0.0), k_back);
    return std::max({t.tick, back, before.taken + before.blend - t.taken});
}

void join(const PathPoint& from, const PathPoint& to, Track& t) {
    t.offset = {from.pose - to.pose, from.rate - to.rate, from.bend - to.bend,
                from.velocity - to.velocity - t.felt * (from.rate - to.rate),
                from.acceleration - to.acceleration - t.felt * (from.bend - to.bend)};
    t.anchored.setZero();
    t.settled = t.offset.is_zero();
}

} // namespace haptics::local
