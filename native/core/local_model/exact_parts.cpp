// Steps of a linkage with the exact integrator that are made of parts.
//
// The exact integrator takes the rows and masses of a linkage at the place foreseen halfway. Where a link
// turns with w and a contact stops it or throws it back within the step, it is elsewhere: the rows miss the
// gap by up to u w h^2 / 2, u the gap rate. A wall of stiffness K takes the link's mass m at a point to the
// depth u / sqrt(K / m), so a share e of that depth is missed by no more with steps of
//     h = sqrt(2 e / (w sqrt(K / m))),
// 0.9 ms for 5 rad/s on 1e6 N/m. Joints make the link's point no lighter than it is alone, a rod's end m / 4.
// A hit may turn links faster than they come: a part ends where one begins, and the next is measured anew.

#include "exact_parts.hpp"

#include <algorithm>
#include <cmath>

#include "internal.hpp"

namespace haptics::local {
namespace {

constexpr double k_missed = 2e-3;
// least share of what is left of the step that a part takes
constexpr double k_least = 1.0 / 32.0;
// room for what forces add to the way to a contact, in terms of the present motion, and m
constexpr double k_ahead = 2.0;
constexpr double k_near = 1e-5;

} // namespace

double part_of_step(const Model& model, const Data& data, double left) {
    double fastest = 0.0;
    for (std::int32_t i = 0; i < data.tool.body_count; ++i)
        fastest = std::max(fastest, std::abs(data.tool.body[static_cast<std::size_t>(i)].velocity.z()));
    double most = 0.0; // of w sqrt(K / m)
    double closes = left;
    for (std::int32_t i = 0; i < data.patches.count; ++i) {
        const Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
        if (p.body_a >= data.tool.body_count)
            continue;
        const Body& a = body_of(data, p.body_a);
        const Body& b = body_of(data, p.body_b);
        const bool moves = b.kind != BodyKind::fixed;
        const LinkageModel& linkage = model.tool.linkage;
        double mass = 0.25 * linkage.body[linkage.link[p.body_a].slot].mass;
        if (b.kind == BodyKind::movable && !b.jointed)
            mass = std::min(mass, 0.25 * b.mass);
        const double turn = std::max(fastest, moves ? std::abs(b.velocity.z()) : 0.0);
        for (std::int32_t k = 0; k < p.point_count; ++k) {
            const PatchPoint& point = p.point[static_cast<std::size_t>(k)];
            Vec2 velocity = velocity_at(a.velocity, point.position - a.pose.head<2>());
            if (moves)
                velocity -= velocity_at(b.velocity, point.position - b.pose.head<2>());
            const double rate = p.normal.dot(velocity);
            if (point.gap > k_ahead * left * std::abs(rate) + k_near)
                continue;
            most = std::max(most, turn * std::sqrt(p.surface.stiffness / mass));
            if (point.gap > k_near && rate < 0.0)
                closes = std::min(closes, point.gap / -rate);
        }
    }
    const double bears = std::sqrt(2.0 * k_missed / std::max(most, 1e-300));
    if (bears >= left)
        return left;
    // equal parts up to where something closes, or to the end
    return std::max(closes / std::ceil(closes / bears), k_least * left);
}

HandInput hand_of_part(const HandInput& hand, double left) {
    HandInput part = hand;
    part.target -= left * hand.target_velocity;
    return part;
}

void add_part(const StepFigures& part, double share, StepFigures& sum) {
    sum.coupling += share * part.coupling;
    sum.full_coupling += share * part.full_coupling;
    sum.environment += share * part.environment;
    sum.contact += share * part.contact;
    sum.grip_acceleration += share * part.grip_acceleration;
    sum.grip_bias += share * part.grip_bias;
    sum.grip_mobility = part.grip_mobility;
    sum.grip_velocity_jump += part.grip_velocity_jump;
    sum.collision_impulse += part.collision_impulse;
    sum.contacts = part.contacts;
    sum.colliding = part.colliding;
    sum.sticking = part.sticking;
    sum.sliding = part.sliding;
    sum.max_penetration = std::max(sum.max_penetration, part.max_penetration);
    sum.stored_energy = part.stored_energy;
    sum.source_work += part.source_work;
    sum.impulse_size += part.impulse_size;
    sum.events_dropped += part.events_dropped;
    sum.fell_back = sum.fell_back || part.fell_back;
    sum.exact_gave_way = sum.exact_gave_way || part.exact_gave_way;
}

} // namespace haptics::local
