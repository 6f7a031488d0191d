// A linkage beside the tool.
//
// One step of length h: the tool's step solves its contacts with the links together with its own motion,
// taking each link for a body with the mobility W and the acceleration a below; then the wrenches P that it
// gave act on the linkage during the linkage's own step. With D the mass matrix of the linkage, R = J the
// three rows of the link's center of mass, f all forces on the joints but P, and springs and contacts with
// stiffness K_j and damping B_j along rows r_j, that step is backward Euler (integrate.cpp):
//     A (v+ - v) = h (f - h sum K_j r_j' r_j v) + h R' P,   A = D + sum (h B_j + h^2 K_j) r_j' r_j,
// so the link's center of mass moves by
//     W = R A^-1 R',   a = R A^-1 (f - h sum K_j r_j' r_j v) + J' v
// and what the tool's step foresees is what the linkage then does, as long as the same contacts press. A push
// on link k moves link i by R_i A^-1 R_k': without that the tool would take links that it touches at once for
// bodies of their own, and throw a row of four that are fixed to each other with twice the energy of a hit.
// Several linkages take turns: each meets those whose turn comes later in the same way, with what pushed them
// before it in f, and they know nothing of it but the wrench, so that a hit between two is resolved once, for
// both. Rows are those of the last step that pressed or stuck; what slid goes on with the force it had.
// Contacts of the linkage with movables are left out: the tool's model has these itself.

#include <haptics/core/dynamics/jacobian.hpp>
#include <haptics/core/dynamics/kinematics.hpp>
#include <haptics/core/dynamics/mass_matrix.hpp>
#include <haptics/core/local_model/free_linkage.hpp>

#include <algorithm>
#include <array>
#include <optional>

#include "internal.hpp"

namespace haptics {
namespace {

// what is stiffer is as good as rigid within a step, N/m and N s/m
constexpr double k_rigid = 1e9;

// Joints may leave a link without any freedom along some line, and the solvers need a mass for it: there it
// yields by a millionth of what it would without joints.
constexpr double k_least = 1e-6;

struct Yielding {
    LinkageMatrix matrix;
    LinkageVector force;
    const LinkageVector& velocity;
    double dt;

    void spring(const LinkageVector& row, double stiffness, double damping, double rate) {
        const double k = std::min(stiffness, k_rigid);
        matrix.noalias() += dt * (dt * k + std::min(damping, k_rigid)) * row * row.transpose();
        force -= dt * k * rate * row;
    }
};

bool with_movable(const Data& data, const PatchRow& t) {
    if (t.patch < 0)
        return false;
    const Patch& p = data.patches.patch[static_cast<std::size_t>(t.patch)];
    const std::int32_t links = data.tool.body_count;
    if (p.body_a >= links)
        return true;
    return p.body_b >= links &&
           data.neighbors.body[static_cast<std::size_t>(p.body_b - links)].kind == BodyKind::movable;
}

void add_joint_springs(const LinkageModel& linkage, const LinkageData& state, Yielding& y) {
    for (int i = linkage.floating ? 3 : 0; i < linkage.freedoms; ++i) {
        const JointSpec& joint = linkage.passive[i];
        if (joint.spring_stiffness <= 0.0 && joint.damping <= 0.0)
            continue;
        y.force(i) -= joint.spring_stiffness * (state.position(i) - joint.spring_rest) +
                      joint.damping * state.velocity(i);
        y.spring(LinkageVector::Unit(linkage.freedoms, i), joint.spring_stiffness, joint.damping,
                 state.velocity(i));
    }
}

void add_rows(const Data& data, Yielding& y) {
    const ContactSystem& s = data.system;
    const int n = s.tool_freedoms;
    LinkageVector row(n);
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (with_movable(data, t))
            continue;
        for (int k = t.first_point; k < t.first_point + t.point_count; ++k) {
            const PointRow& p = s.point[static_cast<std::size_t>(k)];
            if (p.force <= 0.0)
                continue;
            row = s.normal_rows.row(k).head(n).transpose();
            y.force += p.force * row;
            y.spring(row, p.stiffness, p.damping, row.dot(y.velocity) - p.drive);
        }
        if (t.force == 0.0)
            continue;
        row = s.tangent_rows.row(i).head(n).transpose();
        y.force += t.force * row;
        if (t.mode == FrictionMode::stick)
            y.spring(row, t.stiffness, t.damping, row.dot(y.velocity) - t.drive);
    }
}

void add_pushes(const LinkageModel& linkage, const Data& data, Yielding& y) {
    PointJacobian rows;
    for (int i = 0; i < linkage.link_count; ++i) {
        const Wrench& push = data.push[static_cast<std::size_t>(i)];
        if (push.isZero(0.0))
            continue;
        point_jacobian(linkage, data.linkage, i, link_center_pose(linkage, data.linkage, i).head<2>(), rows);
        y.force += rows.transpose().lazyProduct(push);
    }
}

// The linkage's step as it would be without what is asked about: A and the forces on the joints.
class Step {
  public:
    Step(const Model& model, const Data& data, double dt)
        : linkage_(model.tool.linkage)
        , data_(data)
        , yielding_{{}, {}, data.linkage.velocity, dt} {
        mass_matrix(linkage_, data.linkage, yielding_.matrix);
        bias_forces(linkage_, data.linkage, data.gravity, yielding_.force);
        yielding_.force = -yielding_.force;
        if (linkage_.has_passive)
            add_joint_springs(linkage_, data.linkage, yielding_);
        if (data.step > 0)
            add_rows(data, yielding_);
        if (data.pushed)
            add_pushes(linkage_, data, yielding_);
        factor_.compute(yielding_.matrix);
        factor_.solveInPlace(yielding_.force);
    }
    [[nodiscard]] PointJacobian rows(int link) const {
        PointJacobian rows;
        point_jacobian(linkage_, data_.linkage, link, center(link), rows);
        return rows;
    }
    // velocity of `to` for unit impulses along `from`
    [[nodiscard]] Mat3 mobility(const PointJacobian& to, const PointJacobian& from) const {
        Mat3 out;
        for (int i = 0; i < 3; ++i) {
            LinkageVector column = from.row(i).transpose();
            factor_.solveInPlace(column);
            out.col(i) = to.lazyProduct(column);
        }
        return out;
    }
    [[nodiscard]] LinkResponse response(int link) const {
        const PointJacobian own = rows(link);
        const Mat3 mobility_of_own = mobility(own, own);
        LinkResponse out;
        out.mobility = 0.5 * (mobility_of_own + mobility_of_own.transpose());
        out.acceleration = own.lazyProduct(yielding_.force);
        if (linkage_.coriolis)
            out.acceleration += point_bias(linkage_, data_.linkage, link, center(link));
        return out;
    }

  private:
    [[nodiscard]] Vec2 center(int link) const {
        return link_center_pose(linkage_, data_.linkage, link).head<2>();
    }

    const LinkageModel& linkage_;
    const Data& data_;
    Yielding yielding_;
    Eigen::LLT<LinkageMatrix> factor_;
};

} // namespace

LinkResponse link_response(const Model& model, const Data& data, int link, double dt) {
    if (!model.tool.articulated || link < 0 || link >= model.tool.linkage.link_count || !(dt > 0.0))
        return {};
    return Step(model, data, dt).response(link);
}

void push_link(Data& data, int link, const Wrench& wrench) {
    if (!data.pushed)
        data.push.fill(Wrench::Zero());
    data.pushed = true;
    data.push[static_cast<std::size_t>(link)] += wrench;
}

void end_pushes(Data& data) {
    data.pushed = false;
}

void follow_linkage(Data& data, std::uint64_t id, const Model& model, const Data& linkage, double dt) {
    if (!model.tool.articulated || !(dt > 0.0))
        return;
    std::optional<Step> step; // none of its links may be near
    std::array<PointJacobian, k_max_movables> rows;
    std::array<std::int32_t, k_max_movables> followed;
    std::size_t count = 0;
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.body < 0)
            continue;
        Body& b = data.neighbors.body[static_cast<std::size_t>(m.body)];
        if (!b.jointed || b.linkage != id || b.link < 0 || b.link >= linkage.tool.body_count)
            continue;
        const Body& link = linkage.tool.body[static_cast<std::size_t>(b.link)];
        m.belief.pose = b.pose = link.pose;
        m.belief.velocity = b.velocity = link.velocity;
        m.blend_left = 0.0;
        m.lead.setZero();
        m.shift_velocity.setZero();
        if (!step)
            step.emplace(model, linkage, dt);
        const LinkResponse response = step->response(b.link);
        b.mobility = response.mobility;
        b.mobility.diagonal() += k_least * Vec3(1.0 / b.mass, 1.0 / b.mass, 1.0 / b.inertia);
        b.acceleration = response.acceleration;
        rows[count] = step->rows(b.link);
        for (std::size_t k = 0; k < count; ++k) {
            const auto other = static_cast<std::size_t>(followed[k]);
            const auto own = static_cast<std::size_t>(i);
            data.link_coupling[own][other] = step->mobility(rows[count], rows[k]);
            data.link_coupling[other][own] = data.link_coupling[own][other].transpose();
        }
        followed[count++] = i;
    }
}

void push_linkage(Data& data, std::uint64_t id, Data& linkage, double dt) {
    for (std::int32_t i = 0; i < data.movable_count; ++i) {
        MovableState& m = data.movable[static_cast<std::size_t>(i)];
        if (m.body < 0)
            continue;
        const Body& b = data.neighbors.body[static_cast<std::size_t>(m.body)];
        if (!b.jointed || b.linkage != id || b.link < 0 || b.link >= linkage.tool.body_count)
            continue;
        const Wrench given = m.belief.given - m.passed;
        m.passed = m.belief.given;
        if (!given.isZero(0.0))
            push_link(linkage, b.link, given / dt);
    }
}

} // namespace haptics
