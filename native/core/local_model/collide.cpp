// Collisions: which contacts take part, and what their impulses do to the tool, to its movable neighbors and
// to the hand.
//
// A collision happens where a point that was apart has closed and still approaches, or where a patch overlaps
// without having been in contact (a fast motion met the spring first). All other points that touch take part
// with restitution 0, whatever their motion: the impulse of a neighbor may close a contact that rests or
// opens. The restitution of a hit slower than the collision speed is 0 as well.
//
// A wall that moves goes on at its speed w whatever it hits. Where it presses on a link next to its joint,
// with a lever d, the rigid answer is a rate w / d, without bound. Joints never make a link easier to move
// than it is free, so yield J D^-1 J' compared with 1 / mass of the link tells how short the lever is (3 d^2
// / l^2 for a rod of length l about its end). Below k_short_lever such a contact counts as one that cannot be
// moved: its spring presses on the joint instead.

#include <algorithm>
#include <array>

#include "contact_rules.hpp"
#include "internal.hpp"

namespace haptics::local {
namespace {

// closed to within this, m: far below what can be felt, far above rounding
constexpr double k_closed = 1e-6;
// where a stretch of the exact integrator stops for a hit, up to rounding, m: taken wider, a hit would be
// resolved above the surface, and the contact count as open right after
constexpr double k_reached = 1e-9;

// of what the link would yield without joints: a lever below 0.6 % of a rod
constexpr double k_short_lever = 1e-4;

double rate(const ContactSystem& s, int point) {
    return s.normal_rows.row(point).dot(s.velocity) - s.point[static_cast<std::size_t>(point)].drive;
}

// A wall that moves presses on a link of the tool so near to a joint that no impulse can make it give way.
bool presses_on_joint(const Model& model, const Data& data, int point) {
    const ContactSystem& s = data.system;
    const PointRow& p = s.point[static_cast<std::size_t>(point)];
    const PatchRow& t = s.row[static_cast<std::size_t>(p.patch)];
    if (!model.tool.articulated || p.drive == 0.0 || t.patch < 0)
        return false;
    const std::int32_t touched = data.patches.patch[static_cast<std::size_t>(t.patch)].body_a;
    if (touched >= data.tool.body_count)
        return false;
    const LinkageModel& linkage = model.tool.linkage;
    const int slot = linkage.link[touched].slot;
    const FreedomVector row = s.normal_rows.row(point).transpose();
    FreedomVector change(s.freedoms);
    change.noalias() = s.inverse_mass * row;
    return row.dot(change) * linkage.body[slot].mass < k_short_lever;
}

} // namespace

bool hits_now(const Model& model, const Data& data) {
    if (model.settings.contact_mode == ContactMode::penalty)
        return false;
    const ContactSystem& s = data.system;
    for (int i = 0; i < s.points; ++i) {
        const PointRow& p = s.point[static_cast<std::size_t>(i)];
        if (p.gap <= k_reached && may_collide(s, p) && -rate(s, i) > model.settings.collision_speed)
            return true;
    }
    return false;
}

double next_collision(const Model& model, const Data& data, double limit) {
    if (model.settings.contact_mode == ContactMode::penalty)
        return -1.0;
    const ContactSystem& s = data.system;
    double earliest = -1.0;
    for (int i = 0; i < s.points; ++i) {
        const PointRow& p = s.point[static_cast<std::size_t>(i)];
        const double closing = -rate(s, i);
        if (closing <= model.settings.collision_speed || !may_collide(s, p))
            continue;
        const double time = std::max(p.gap, 0.0) / closing;
        if (time <= limit && (earliest < 0.0 || time < earliest))
            earliest = time;
    }
    return earliest;
}

bool collide(const Model& model, Data& data, StepOutput& output) {
    ContactSystem& s = data.system;
    std::array<int, k_max_collision_contacts> chosen;
    int count = 0;
    bool hit = false;
    for (int i = 0; i < s.points && count < k_max_collision_contacts; ++i) {
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        if (p.gap > k_closed) {
            // what has opened since its hit may be hit again before the step ends
            p.was_apart = p.was_apart || s.row[static_cast<std::size_t>(p.patch)].collided;
            continue;
        }
        chosen[static_cast<std::size_t>(count++)] = i;
        hit = hit || (may_collide(s, p) && rate(s, i) < 0.0);
    }
    if (!hit)
        return false;

    need_inverse(model, data);
    CollisionProblem& problem = data.collision;
    problem.resize(s.freedoms, count);
    problem.inverse_mass = s.inverse_mass;
    problem.velocity = s.velocity;
    for (int c = 0; c < count; ++c) {
        const int i = chosen[static_cast<std::size_t>(c)];
        const PointRow& p = s.point[static_cast<std::size_t>(i)];
        const PatchRow& t = s.row[static_cast<std::size_t>(p.patch)];
        if (presses_on_joint(model, data, i))
            problem.normal_rows.row(c).setZero();
        else
            problem.normal_rows.row(c) = s.normal_rows.row(i);
        problem.tangent_rows.row(c) = s.tangent_rows.row(p.patch);
        problem.wall_normal_velocity(c) = p.drive;
        problem.wall_tangent_velocity(c) = t.drive;
        const bool bounces = may_collide(s, p) && -rate(s, i) > model.settings.collision_speed;
        problem.restitution(c) = bounces ? t.restitution : 0.0;
        problem.friction(c) = t.dynamic_friction;
    }
    resolve_collisions(model.settings.collision_method, problem, data.workspace, data.solution);
    output.fell_back = output.fell_back || data.solution.fell_back;

    const int n = s.tool_freedoms;
    s.velocity = data.solution.velocity;
    if (model.tool.articulated) {
        s.jump += s.velocity.head(n) - problem.velocity.head(n);
        // what a wall or a movable hits the linkage with is its to keep (proxy.cpp)
        const FreedomVector sum = problem.velocity + s.velocity;
        s.force_work += 0.5 * data.solution.momentum_change.head(n).dot(sum.head(n));
    }
    output.grip_velocity_jump += s.grip * (s.velocity.head(n) - problem.velocity.head(n));
    const Vec2 grip = grip_pose(data.grip, data.pose).head<2>();
    std::array<double, k_max_points> normal_impulse{};
    std::array<double, k_max_rows> tangent_impulse{};
    for (int c = 0; c < count; ++c) {
        const int i = chosen[static_cast<std::size_t>(c)];
        PointRow& p = s.point[static_cast<std::size_t>(i)];
        PatchRow& t = s.row[static_cast<std::size_t>(p.patch)];
        const double normal = data.solution.normal_impulse(c);
        if (normal != 0.0 && may_collide(s, p)) {
            t.collided = true;
            t.impulse += std::abs(normal);
        }
        p.was_apart = false;
        if (t.patch < 0)
            continue;
        const Patch& patch = data.patches.patch[static_cast<std::size_t>(t.patch)];
        if (patch.body_a < data.tool.body_count) {
            const Vec2 impulse =
                normal * patch.normal + data.solution.tangent_impulse(c) * perpendicular(patch.normal);
            const Vec2 arm = patch.point[static_cast<std::size_t>(p.slot)].position - grip;
            output.collision_impulse += Wrench(impulse.x(), impulse.y(), cross(arm, impulse));
        }
        if (t.movable >= 0 || t.drive != 0.0 || p.drive != 0.0) {
            // work of the other side: impulse times its mean velocity, v_other = v_tool - gap rate
            const auto other = [&](const auto& row, double drive) {
                const FreedomVector sum = problem.velocity + s.velocity;
                return 0.5 * (row.head(n).dot(sum.head(n)) - row.dot(sum)) + drive;
            };
            output.source_work +=
                normal * other(s.normal_rows.row(i), p.drive) +
                data.solution.tangent_impulse(c) * other(s.tangent_rows.row(p.patch), t.drive);
        }
        normal_impulse[static_cast<std::size_t>(i)] += normal;
        tangent_impulse[static_cast<std::size_t>(p.patch)] += data.solution.tangent_impulse(c);
    }
    tell_push(data, normal_impulse.data(), tangent_impulse.data());
    store_velocities(model, data);
    // Coriolis forces of the rest of the step are those of the new velocity
    write_tool_force(model, data);
    return true;
}

} // namespace haptics::local
