// Movable neighbors belong to the local model between ticks. A snapshot says where the environment had them
// at time s, after it was told what the model believed at the step `echo`; both have moved on since. With
// the belief (x, v), sums of corrections of velocity, c(t), and of what corrections have moved the body by,
// d(t) (its rate is c(t) plus the corrections of the pose themselves), all including what is still to be
// blended in, the environment is expected at
//     v(echo) + c' ,  c' = c(now) - c(echo),
//     x(echo) + (s - echo) v(echo) + d(now) - d(echo) - (now - echo) c(echo) - (now - s) c' - lead,
// the c' and d terms being what is corrected already and must not be corrected twice. What the snapshot says
// beyond that is blended in within one tick, moved on from s to now.
//
// Lead. A push that the tool gives now acts in the environment from its next tick on: an object that takes a
// velocity V at once is ahead there by up to V times a few ticks, for good, though both agree on all
// momentum. To draw it back within a tick would press it into the tool that pushes it and hurl it away. So
// while a body is joined to the tool, and until the environment has heard of all that happened then, a
// difference of poses up to V times the time since the last echo (and a little more, for the tolerances of
// the scene's solver) is not corrected but kept as lead, if the environment agrees about the velocity. It
// is taken away over k_lead_ticks, by less than a hundredth of V; once nothing joins the object to the
// tool, over k_free_lead_ticks, but at no more than half the speed at which the two part. A body that
// something unknown holds in place has another velocity in the environment, and is held here within a tick.
//
// Contacts. What holds a joined body may swing: a stack of heavy objects against a wall has modes of 5-20 Hz
// with little damping, of which the environment, whose contacts are rigid, knows nothing. The velocity of the
// echo is a tick and more old, half a swing when reports are lost, and the difference from it would drive the
// swing instead of damping it. So a joined body is compared as it is now: the environment's velocity goes on
// from v_s to v_s + u (u what the tool gave since the echo, by the mass) where nothing holds it, and stays at
// v_s where walls take the push; the difference is the distance of the belief from the nearest point between
// the two. The tool that carries a body's weight always has an untold push, -g times the lag, that gravity
// takes away again; counted as velocity to come it would leave the body in the environment sinking for good.
// So the part of the mean push that opposes gravity, times the mean lag, is left out of u.
//
// That nearest point hides differences up to the size of u. What nothing but the tool holds needs no such
// caution: there the environment's velocity goes on to all of v_s + u, and to the fall until now; what it is
// ahead by for its weight is found in carried.cpp.
//
// Shift. A body that is joined to the tool works off the rest of a difference e with a velocity of its own,
// -e'(t) of the cubic that ends with e = e' = 0, so that what is in its way meets its mass. Moved without
// asking, it would be a wall of infinite mass, and its contacts would gain K e^2 / 2.

#include "movables.hpp"

#include <algorithm>
#include <cmath>

#include "path.hpp"

namespace haptics::local {
namespace {

constexpr double k_lead_ticks = 400.0;
constexpr double k_free_lead_ticks = 20.0;
// differences that every solver leaves, m
constexpr double k_tolerance = 1e-3;
// weight of the last difference of velocities in their mean, and the part of one that is taken in any case
constexpr double k_surprise = 0.25;
constexpr double k_least_trust = 0.2;
// beliefs over which the push of the tool and the time until they come back are averaged
constexpr std::int32_t k_push_memory = 5;
constexpr std::int32_t k_lag_memory = 20;
constexpr double k_least_lag = 1e-6;
constexpr double k_turn = 6.28318530717958647692;

const MovableBelief* find_echo(const Neighborhood& n, const MovableBelief& belief) {
    for (std::int32_t i = 0; i < n.echo_count; ++i) {
        const MovableBelief& e = n.echo[static_cast<std::size_t>(i)];
        if (e.id == belief.id && e.epoch == belief.epoch)
            return &e;
    }
    return nullptr;
}

// size of a motion in the metric of the body's mass, in terms of its translation
double size_of(const Vec3& motion, const Body& body) {
    return std::sqrt(motion.head<2>().squaredNorm() + body.inertia / body.mass * motion.z() * motion.z());
}

// what the environment's velocity, once it has heard all, lacks to the belief of a body that contacts hold
Twist present_surprise(MovableState& m, const Body& seen, const MovableBelief& echo, const Neighborhood& n,
                       double now) {
    const MovableBelief& b = m.belief;
    const Vec2 gravity = fall_of(n.gravity, seen);
    const Vec3 metric(1.0, 1.0, seen.inertia / seen.mass);
    Twist untold = (b.given - echo.given).cwiseQuotient(seen.mass * metric);
    Twist ahead = b.velocity - m.shift_velocity + m.pending_velocity - seen.velocity;

    // what the tool bears of the weight stays untold, but changes no velocity
    const double lag = std::max(now - echo.time, k_least_lag);
    m.heard = std::min(m.heard + 1, k_lag_memory);
    m.lag += (lag - m.lag) / m.heard;
    m.push += (untold / lag - m.push) / std::min(m.heard, k_push_memory);
    const double fall = gravity.norm();
    if (!m.free)
        m.lift = m.mean_untold =
            fall > 0.0 ? std::clamp(-m.push.head<2>().dot(gravity) / (fall * fall), 0.0, 1.0) * m.lag * fall
                       : 0.0;
    else if (fall > 0.0)
        hear(-untold.head<2>().dot(gravity) / fall, n.tick, fall, m);
    if (fall > 0.0)
        untold.head<2>() += m.lift / fall * gravity;
    if (m.free) {
        ahead -= (now - n.time) * Twist(gravity.x(), gravity.y(), 0.0);
        return untold - ahead;
    }
    const double size = untold.dot(metric.cwiseProduct(untold));
    const double taken =
        size > 0.0 ? std::clamp(ahead.dot(metric.cwiseProduct(untold)) / size, 0.0, 1.0) : 0.0;
    return taken * untold - ahead;
}

// the part of a difference of velocities that is taken over at once
double trust(const Twist& surprise, const Body& body, MovableState& m) {
    m.surprise += k_surprise * (surprise - m.surprise);
    m.surprise_size += k_surprise * (size_of(surprise, body) - m.surprise_size);
    const double lasting = size_of(m.surprise, body) / std::max(m.surprise_size, 1e-300);
    return k_least_trust + (1.0 - k_least_trust) * std::min(lasting * lasting, 1.0);
}

// the part of a difference of poses that becomes lead
double lead_part(const MovableState& m, const Body& seen, const MovableBelief& echo, double window,
                 double fall, const Pose& difference) {
    const Vec3 gained = (echo.given - m.heard_given).cwiseQuotient(Vec3(seen.mass, seen.mass, seen.inertia));
    double speed =
        std::max({size_of(echo.velocity, seen), size_of(seen.velocity, seen), size_of(gained, seen)});
    if (m.free)
        speed = std::max(speed, window * fall);
    const double doubt = speed > 0.0 ? size_of(m.surprise, seen) / speed : 0.0;
    const double most = std::clamp(1.5 - 2.0 * doubt, 0.0, 1.0) * window * speed + k_tolerance;
    return std::min(1.0, most / std::max(size_of(difference, seen), 1e-300));
}

void correct(MovableState& m, const Body& seen, const Neighborhood& n, double now) {
    const MovableBelief* echo = find_echo(n, m.belief);
    if (echo == nullptr)
        return; // the environment has not seen this belief yet
    const MovableBelief& b = m.belief;
    const Twist since =
        b.corrected_velocity - m.shift_velocity + m.pending_velocity - echo->corrected_velocity;
    const Pose moved = b.corrected_pose + m.pending_pose - echo->corrected_pose -
                       (now - echo->time) * echo->corrected_velocity - (now - n.time) * since;
    Twist surprise = seen.velocity - echo->velocity - since;
    Pose difference = seen.pose - echo->pose - (n.time - echo->time) * echo->velocity - moved + m.lead;
    difference.z() = std::remainder(difference.z(), k_turn);
    watch_answer(seen, *echo, n, m);
    if (m.joined_time >= m.heard_time - n.tick) {
        surprise = present_surprise(m, seen, *echo, n, now);
        const double part = trust(surprise, seen, m);
        const double window = std::max(n.time - m.heard_time, 0.0) + n.tick;
        const double fall = fall_of(n.gravity, seen).norm();
        const Pose lead = lead_part(m, seen, *echo, window, fall, difference) * difference;
        surprise *= part;
        m.lead -= lead;
        difference -= lead;
    } else {
        m.heard = 0;
    }
    m.pending_pose += difference + (now - n.time) * surprise;
    m.pending_velocity += surprise;
    m.blend_left = n.tick;
    m.heard_given = echo->given;
    m.heard_time = echo->time;
}

// starts where the body was shown until now, if it was
void meet(MovableState& m, const Body& seen, const Track& track, const Data& data) {
    m = MovableState{};
    const PathPoint at = extrapolated(track, data.time);
    const Twist felt = track.offset.velocity + track.felt * track.offset.rate;
    m.belief.id = seen.id;
    m.belief.epoch = data.step;
    m.belief.time = data.time;
    m.belief.pose = at.pose + track.offset.pose;
    m.belief.velocity = at.velocity + felt;
    m.pending_pose = -track.offset.pose;
    m.pending_velocity = -felt;
    m.blend_left = track.blend;
    m.heard_time = data.time;
}

// forgets movables that left and whose last impulses the environment has taken
void forget_movables(Data& data, std::uint64_t echo_step) {
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        const MovableState m = data.movable[static_cast<std::size_t>(i)];
        if (m.body >= 0 || m.given_step > echo_step)
            data.movable[static_cast<std::size_t>(kept++)] = m;
    }
    data.movable_count = kept;
}

// blends in what is pending
void blend(double dt, MovableState& m) {
    if (m.blend_left <= 0.0 || dt <= 0.0)
        return;
    const double part = std::min(1.0, dt / m.blend_left);
    add_velocity(m, part * m.pending_velocity);
    m.pending_velocity *= 1.0 - part;
    m.pending_pose -= dt * m.shift_velocity; // what the velocity of the last steps has done
    const bool shifts = m.row >= 0 && part < 1.0;
    if (shifts) {
        const double u = part;
        const Twist shift = 6.0 * u * (1.0 - u) / m.blend_left * m.pending_pose +
                            (1.0 - u) * (1.0 - 3.0 * u) * m.shift_velocity;
        add_velocity(m, shift - m.shift_velocity);
        m.shift_velocity = shift;
    } else {
        add_velocity(m, -m.shift_velocity);
        m.shift_velocity.setZero();
        add_pose(m, part * m.pending_pose);
        m.pending_pose *= 1.0 - part;
    }
    m.blend_left -= dt;
}

// takes a part of the lead away
void draw_back(const Data& data, double dt, MovableState& m) {
    if (m.lead.isZero(0.0))
        return;
    const double tick = data.tick;
    double rate = 1.0 / (k_lead_ticks * tick);
    if (m.row < 0) {
        const double parting = (m.belief.velocity - data.velocity).head<2>().norm();
        const double gentle = 0.5 * parting / std::max(m.lead.head<2>().norm(), 1e-12);
        rate = std::max(rate, std::min(gentle, 1.0 / (k_free_lead_ticks * tick)));
    }
    Pose back = std::min(1.0, dt * rate) * m.lead;
    if (m.row >= 0 && m.free && m.body >= 0) { // along its weight it is lifted
        const Vec2 fall = fall_of(data.gravity, data.neighbors.body[static_cast<std::size_t>(m.body)]);
        if (!fall.isZero(0.0))
            back.head<2>() -= back.head<2>().dot(fall) / fall.squaredNorm() * fall;
    }
    m.lead -= back;
    add_pose(m, -back);
}

std::int32_t slot_of(const Data& data, std::uint64_t id) {
    std::int32_t slot = 0;
    while (slot < data.movable_count && data.movable[static_cast<std::size_t>(slot)].belief.id != id)
        ++slot;
    return slot;
}

} // namespace

void take_movables(const Neighborhood& n, Data& data) {
    for (std::int32_t i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].body = -1;
    data.movable_overflow = 0;
    for (std::int32_t b = 0; b < data.neighbors.body_count; ++b) {
        const Body& seen = data.neighbors.body[static_cast<std::size_t>(b)];
        Track& track = data.track[static_cast<std::size_t>(b)];
        if (seen.kind != BodyKind::movable)
            continue;
        const std::int32_t slot = slot_of(data, seen.id);
        if (slot == k_max_movables) {
            ++data.movable_overflow;
            continue; // the track moves it
        }
        MovableState& m = data.movable[static_cast<std::size_t>(slot)];
        track.driven = false;
        if (slot == data.movable_count) {
            meet(m, seen, track, data);
            ++data.movable_count;
        } else if (!track.leaving && !seen.jointed) {
            correct(m, seen, n, data.time);
        }
        m.body = b;
    }
    forget_movables(data, n.echo_step);
    for (auto& of : data.link_coupling) // it goes by their places in the list
        of.fill(Mat3::Zero());
}

void move_movables(Data& data, double dt) {
    lift_carried(data, dt);
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        MovableBelief& s = m.belief;
        s.time = data.time;
        if (m.row < 0)
            s.pose += dt * s.velocity;
        else
            m.joined_time = data.time;
        s.corrected_pose += dt * s.corrected_velocity;
        blend(dt, m);
        draw_back(data, dt, m);
        if (m.body >= 0) {
            data.neighbors.body[static_cast<std::size_t>(m.body)].pose = s.pose;
            data.neighbors.body[static_cast<std::size_t>(m.body)].velocity = s.velocity;
        }
    }
}

} // namespace haptics::local
