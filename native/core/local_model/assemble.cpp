// From patches to rows in configuration space.
//
// The system's velocity is v = (tool; movable 1; movable 2; ...): the rates of the tool's coordinates, then
// three entries for each movable, about its center of mass. For a point p with normal n between bodies a and
// b the gap rate is n . (v_a(p) - v_b(p)). A side that is in the system gives the row n J(p), for a rigid
// body [n_x, n_y, r x n] (minus for b); a side that is not gives the number `drive`, so that gap rate =
// row v - drive.
//
// Joints of a linkage join in as rows of their own. A limit is a normal row +-e_i with the spring and damper
// of the JointSpec, or those of the paper's wall at a lever of 0.1 m when it has none; it takes part in
// collisions without restitution. Friction is a tangent row e_i with the joint's Coulomb friction as a
// constant bound. Its spring is as stiff as every integrator bears: with m = 1 / (D^-1)_ii the semi-implicit
// one needs m > (k h^2 + 2 b h) / 4, and k h^2 = b h / 2 = m / 10 stay far below it also where joints couple.
//
// A movable that joints tie to others has a full block in the mass matrix, the inverse of its mobility.
//
// Only movables that a chain of contacts joins to the tool are in the system: the others touch nothing that
// the hand can feel, and the environment moves them.

#include <haptics/core/dynamics/kinematics.hpp>

#include <algorithm>
#include <cmath>

#include "fading.hpp"
#include "internal.hpp"

namespace haptics::local {
namespace {

constexpr int k_none = -1;

// wall of the paper at a lever of 0.1 m
constexpr double k_limit_stiffness = 15000.0;
constexpr double k_limit_damping = 20.0;
constexpr double k_limit_lever = 0.1;
// damping of what fades, in units of sqrt(K m)
constexpr double k_fade_damping = 4.0;

// first system row of a body of the patch list (tool links first, then neighbors), or k_none
int first_row(const Data& data, std::int32_t body) {
    if (body < data.tool.body_count)
        return 0;
    const std::int32_t neighbor = body - data.tool.body_count;
    for (int i = 0; i < data.movable_count; ++i) {
        const MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.body == neighbor)
            return m.row;
    }
    return k_none;
}

// gives rows to the movables that contacts join to the tool
void choose_island(Data& data) {
    for (int i = 0; i < data.movable_count; ++i)
        data.movable[static_cast<std::size_t>(i)].row = k_none;
    int rows = data.system.tool_freedoms;
    bool grew = data.plan.runs(Stage::movables);
    while (grew) {
        grew = false;
        for (int i = 0; i < data.patches.count; ++i) {
            const Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
            for (const auto& [inside, outside] :
                 {std::pair{p.body_a, p.body_b}, std::pair{p.body_b, p.body_a}}) {
                const std::int32_t m = outside < data.tool.body_count ? -1 : movable_of(data, outside);
                if (m < 0 || data.movable[static_cast<std::size_t>(m)].row != k_none ||
                    first_row(data, inside) == k_none)
                    continue;
                data.movable[static_cast<std::size_t>(m)].row = rows;
                rows += 3;
                grew = true;
            }
        }
    }
    data.system.freedoms = rows;
}

// adds `sign` times the row of direction `n` at `p` on `body` to `target`, or its velocity to `drive`
void add_side(const Model& model, const Data& data, std::int32_t body, int row, const Vec2& p, const Vec2& n,
              double sign, double* target, double& drive) {
    if (body < data.tool.body_count) {
        add_tool_row(model, data, body, p, n, sign, target);
        return;
    }
    if (row == k_none && !data.plan.runs(Stage::moving_walls))
        return;
    const Body& b = body_of(data, body);
    const Vec2 arm = p - b.pose.head<2>() - data.system.ahead * b.velocity.head<2>();
    if (row == k_none) {
        drive -= sign * n.dot(velocity_at(b.velocity, arm));
        return;
    }
    target[row] += sign * n.x();
    target[row + 1] += sign * n.y();
    target[row + 2] += sign * cross(arm, n);
}

// Where a point of a patch is, and its normal there, `ahead` s later.
struct Place {
    Vec2 point;
    Vec2 normal;
};

Place ahead(const Model& model, const Data& data, const Patch& patch, const Vec2& point) {
    Place at{point, patch.normal};
    const double time = data.system.ahead;
    if (time == 0.0)
        return at;
    // the face turns the normal, the other side carries the point
    const auto turn = [&](std::int32_t body) {
        if (body >= data.tool.body_count)
            return time * body_of(data, body).velocity.z();
        return link_center_pose(model.tool.linkage, data.linkage, body).z() - body_of(data, body).pose.z();
    };
    const bool face_of_a = patch.side.face == PatchSide::Face::of_a;
    const std::int32_t face = face_of_a ? patch.body_a : patch.body_b;
    const std::int32_t carrier = face_of_a ? patch.body_b : patch.body_a;
    const Body& b = body_of(data, carrier);
    const Vec2 arm = point - b.pose.head<2>();
    Vec2 center = b.pose.head<2>() + time * b.velocity.head<2>();
    if (carrier < data.tool.body_count)
        center = link_center_pose(model.tool.linkage, data.linkage, carrier).head<2>();
    at.point = center + rotate(turn(carrier), arm);
    at.normal = rotate(turn(face), patch.normal);
    return at;
}

// the same for a rigid tool and something that is not in the system: the row is written, not added to
void write_rigid_row(const Data& data, const Body& other, bool moves, const Vec2& p, const Vec2& n,
                     double* target, double& drive) {
    target[0] = n.x();
    target[1] = n.y();
    target[2] = cross(p - data.pose.head<2>(), n);
    drive = moves ? n.dot(velocity_at(other.velocity, p - other.pose.head<2>())) : 0.0;
}

// Links of one linkage answer together.
void couple_links(Data& data) {
    ContactSystem& s = data.system;
    std::array<bool, k_max_movables> done{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(data.movable_count); ++i) {
        const auto body = [&data](std::size_t k) -> const Body& {
            return data.neighbors.body[static_cast<std::size_t>(data.movable[k].body)];
        };
        const auto joined = [&](std::size_t k) { return data.movable[k].row != k_none && body(k).jointed; };
        if (done[i] || !joined(i))
            continue;
        std::array<std::size_t, k_max_movables> link;
        std::size_t count = 0;
        for (std::size_t k = i; k < static_cast<std::size_t>(data.movable_count); ++k)
            if (joined(k) && body(k).linkage == body(i).linkage) {
                link[count++] = k;
                done[k] = true;
            }
        if (count < 2)
            continue;
        constexpr int k_most = 3 * k_max_movables;
        using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, k_most, k_most>;
        const auto size = static_cast<Eigen::Index>(3 * count);
        Block mobility(size, size);
        Eigen::Matrix<double, Eigen::Dynamic, 1, 0, k_most, 1> acceleration(size);
        const auto at = [](std::size_t k) { return static_cast<Eigen::Index>(3 * k); };
        for (std::size_t a = 0; a < count; ++a) {
            acceleration.segment<3>(at(a)) = body(link[a]).acceleration;
            for (std::size_t b = 0; b < count; ++b)
                mobility.block<3, 3>(at(a), at(b)) =
                    a == b ? body(link[a]).mobility : data.link_coupling[link[a]][link[b]];
        }
        const Block mass = mobility.llt().solve(Block::Identity(size, size));
        acceleration = mass * acceleration.eval();
        for (std::size_t a = 0; a < count; ++a) {
            const std::int32_t row = data.movable[link[a]].row;
            s.external.segment<3>(row) = acceleration.segment<3>(at(a));
            for (std::size_t b = 0; b < count; ++b) {
                const std::int32_t column = data.movable[link[b]].row;
                s.mass.block<3, 3>(row, column) = mass.block<3, 3>(at(a), at(b));
                s.inverse_mass.block<3, 3>(row, column) = mobility.block<3, 3>(at(a), at(b));
            }
        }
    }
}

void assemble_mass(const Model& model, Data& data, double dt) {
    ContactSystem& s = data.system;
    const int n = s.freedoms;
    s.velocity.setZero(n);
    s.external.setZero(n);
    s.mass.setZero(n, n);
    s.inverse_mass.setZero(n, n);
    const auto set = [&](int row, const Body& b) {
        for (int k = 0; k < 3; ++k) {
            const double m = k < 2 ? b.mass : b.inertia;
            s.mass(row + k, row + k) = m;
            s.inverse_mass(row + k, row + k) = 1.0 / m;
        }
        s.external(row) = b.mass * (data.gravity.x() + b.acceleration.x());
        s.external(row + 1) = b.mass * (data.gravity.y() + b.acceleration.y());
    };
    write_tool_mass(model, data, dt);
    for (int i = 0; i < data.movable_count; ++i) {
        const MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row == k_none)
            continue;
        const Body& b = data.neighbors.body[static_cast<std::size_t>(m.body)];
        if (!b.jointed) {
            set(m.row, b);
            continue;
        }
        const Mat3 mass = b.mobility.inverse();
        s.mass.block<3, 3>(m.row, m.row) = mass;
        s.inverse_mass.block<3, 3>(m.row, m.row) = b.mobility;
        s.external.segment<3>(m.row) = mass * b.acceleration;
    }
    couple_links(data);
    load_velocities(model, data);
}

void add_limit(const JointSpec& joint, int i, double dt, Data& data) {
    ContactSystem& s = data.system;
    const double q = data.linkage.position[i] + s.displacement[i];
    const double below = q - joint.lower_limit;
    const double above = joint.upper_limit - q;
    const double gap = std::min(below, above);
    // what it can reach within the step, with room for what pushes it
    if (!(gap < 2.0 * dt * std::abs(data.linkage.velocity[i]) + 1e-2))
        return;
    const double lever = joint.kind == JointKind::prismatic ? 1.0 : k_limit_lever * k_limit_lever;
    // a damper alone is no stop: it goes with the wall's spring
    const bool given = joint.limit_stiffness > 0.0 || joint.limit_damping > 0.0;
    PatchRow& t = s.row[static_cast<std::size_t>(s.patches)];
    t = PatchRow{};
    t.freedom = i;
    t.first_point = s.points;
    t.point_count = 1;
    t.continuing = data.joint[i].at_limit;
    PointRow& r = s.point[static_cast<std::size_t>(s.points)];
    r = PointRow{};
    r.patch = s.patches;
    r.gap = gap;
    r.stiffness = joint.limit_stiffness > 0.0 ? joint.limit_stiffness : k_limit_stiffness * lever;
    r.damping = given ? joint.limit_damping : k_limit_damping * lever;
    r.was_apart = gap > 0.0;
    s.normal_rows(s.points, i) = below <= above ? 1.0 : -1.0;
    ++s.points;
    ++s.patches;
}

void add_joint_friction(const Model& model, const JointSpec& joint, int i, double dt, Data& data) {
    need_inverse(model, data);
    ContactSystem& s = data.system;
    const double mass = 1.0 / s.inverse_mass(i, i);
    PatchRow& t = s.row[static_cast<std::size_t>(s.patches)];
    t = PatchRow{};
    t.freedom = i;
    t.first_point = s.points;
    t.stiffness = 0.1 * mass / (dt * dt);
    t.damping = 0.2 * mass / dt;
    t.bound = joint.friction;
    t.spring = data.joint[i].slip_spring;
    t.was_sliding = data.joint[i].sliding;
    s.tangent_rows(s.patches, i) = 1.0;
    ++s.patches;
}

// limits within reach, and friction, of the tool's joints
void assemble_joints(const Model& model, Data& data, double dt) {
    const LinkageModel& linkage = model.tool.linkage;
    const bool any = data.plan.runs(Stage::joint_limits) || data.plan.runs(Stage::joint_friction);
    if (!model.tool.articulated || !linkage.has_passive || !any)
        return;
    for (int i = linkage.floating ? 3 : 0; i < linkage.freedoms; ++i) {
        if (data.plan.runs(Stage::joint_limits))
            add_limit(linkage.passive[i], i, dt, data);
        if (data.plan.runs(Stage::joint_friction) && linkage.passive[i].friction > 0.0)
            add_joint_friction(model, linkage.passive[i], i, dt, data);
    }
}

// what fades is damped, see fading.cpp
void damp_fading(const Model& model, Data& data, int point, double presence) {
    need_inverse(model, data);
    ContactSystem& s = data.system;
    PointRow& r = s.point[static_cast<std::size_t>(point)];
    const auto row = s.normal_rows.row(point);
    const double mobility = row.dot(s.inverse_mass * row.transpose());
    if (mobility > 0.0)
        r.damping +=
            k_fade_damping * (1.0 - presence) * std::sqrt(r.stiffness * presence_weight(presence) / mobility);
}

} // namespace

void load_velocities(const Model& model, Data& data) {
    load_tool(model, data);
    ContactSystem& s = data.system;
    for (int i = 0; i < data.movable_count; ++i) {
        const MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row != k_none)
            s.velocity.segment<3>(m.row) = m.belief.velocity;
    }
}

void store_velocities(const Model& model, Data& data) {
    store_tool(model, data);
    const ContactSystem& s = data.system;
    for (int i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.row != k_none)
            m.belief.velocity = s.velocity.segment<3>(m.row);
    }
}

void assemble(const Model& model, Data& data, double dt) {
    ContactSystem& s = data.system;
    s.tool_freedoms = model.tool.freedoms();
    choose_island(data);
    assemble_mass(model, data, dt);
    grip_rows(model, data, s.grip);
    const int n = s.freedoms;
    const int joints = model.tool.articulated && model.tool.linkage.has_passive ? s.tool_freedoms : 0;
    // the common case needs no look-up: a rigid tool among what it cannot move
    const bool lone = !model.tool.articulated && data.movable_count == 0;
    const bool walls_move = data.plan.runs(Stage::moving_walls);
    s.points = 0;
    s.patches = 0;
    s.normal_rows.set_zero(2 * data.patches.count + joints, n);
    s.tangent_rows.set_zero(data.patches.count + 2 * joints, n);
    for (int i = 0; i < data.patches.count; ++i) {
        const Patch& p = data.patches.patch[static_cast<std::size_t>(i)];
        const int row_a = lone ? 0 : first_row(data, p.body_a);
        const int row_b = lone ? k_none : first_row(data, p.body_b);
        const Body& other = body_of(data, p.body_b);
        if (row_a == k_none && row_b == k_none)
            continue;
        PatchRow& t = s.row[static_cast<std::size_t>(s.patches)];
        t = PatchRow{};
        t.patch = i;
        t.first_point = s.points;
        t.point_count = p.point_count;
        t.stiffness = p.surface.stiffness;
        t.damping = p.surface.damping;
        t.static_friction = std::max(p.surface.static_friction, p.surface.dynamic_friction);
        t.dynamic_friction = p.surface.dynamic_friction;
        t.restitution = p.surface.restitution;
        t.spring = p.memory.slip_spring;
        t.continuing = p.memory.state != ContactState::none;
        t.was_sliding = p.memory.state == ContactState::sliding;
        if (p.body_a < data.tool.body_count && p.body_b >= data.tool.body_count)
            t.movable = movable_of(data, p.body_b);
        Vec2 middle{0.0, 0.0};
        for (int k = 0; k < p.point_count; ++k) {
            const PatchPoint& point = p.point[static_cast<std::size_t>(k)];
            PointRow& r = s.point[static_cast<std::size_t>(s.points)];
            r = PointRow{};
            r.patch = s.patches;
            r.slot = k;
            r.gap = point.gap;
            r.stiffness = p.surface.stiffness * point.weight;
            r.damping = p.surface.damping * point.weight;
            r.was_apart = point.gap > 0.0 && p.presence >= 1.0; // what fades is not hit
            double* row = &s.normal_rows(s.points, 0);
            if (lone) {
                write_rigid_row(data, other, walls_move, point.position, p.normal, row, r.drive);
            } else {
                const Place at = ahead(model, data, p, point.position);
                add_side(model, data, p.body_a, row_a, at.point, at.normal, 1.0, row, r.drive);
                add_side(model, data, p.body_b, row_b, at.point, at.normal, -1.0, row, r.drive);
            }
            if (p.presence < 1.0)
                damp_fading(model, data, s.points, p.presence);
            middle += point.weight * point.position;
            ++s.points;
        }
        ++s.patches;
        if (!data.plan.runs(Stage::friction))
            continue;
        const Vec2 tangent = perpendicular(p.normal);
        double* row = &s.tangent_rows(s.patches - 1, 0);
        if (lone) {
            write_rigid_row(data, other, walls_move, middle, tangent, row, t.drive);
            continue;
        }
        const Place at = ahead(model, data, p, middle);
        const Vec2 along = perpendicular(at.normal);
        add_side(model, data, p.body_a, row_a, at.point, along, 1.0, row, t.drive);
        add_side(model, data, p.body_b, row_b, at.point, along, -1.0, row, t.drive);
    }
    assemble_joints(model, data, dt);
}

} // namespace haptics::local
