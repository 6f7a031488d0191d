// Rows J where bodies turn.
//
// The motion between two events is exact for rows that stay as they are (exact.cpp), but turning bodies turn
// their rows. With the rows of the start of a stretch h the gap at its end is wrong by J' v h^2 / 2, for a
// corner at r that turns with w by r w^2 h^2 / 2, and the contact's energy by the force times that: at w = 10
// rad/s, r = 2 cm and 2 ms by 4 um, which is most of the overlap of a hard wall. So a stretch ends where a
// point closes or opens, contacts are found again there, and a touch begins with the true gap. And a stretch
// with contact is run twice, the second time with the rows of the place halfway between its ends: for rows
// J(q) the gap then changes by J((q0 + q1)/2) (q1 - q0), which is the true change up to the third order in
// the motion, whatever the path in time, and the springs take the energy that the motion gives. The error
// left is r w^3 h^3 / 24: 7 nm in the example. The shares of a patch that tilts are taken halfway as well;
// where they change the contacts' energy by much the stretch is run again with half the length.
//
// What no row watches, say the second corner of a box that the first one sets spinning, would be found as an
// overlap only at the end. The energy of all gaps that are not what the rows made them is the measure of both
// errors; a stretch where it is too large is run again with half the length.

#include "exact_rows.hpp"

#include <haptics/core/contact/detection.hpp>

#include <algorithm>
#include <cmath>

#include "fading.hpp"

namespace haptics::local {
namespace {

// places that differ by less are one, m
constexpr double k_same_place = 1e-5;
// contacts of two steps that are nearer than this and the motion are one, m
constexpr double k_near_row = 1e-3;

std::size_t index(int i) {
    return static_cast<std::size_t>(i);
}

const PatchPoint& place_of(const PatchList& patches, const PatchRow& t, const PointRow& p) {
    return patches.patch[index(t.patch)].point[index(p.slot)];
}

// finds the patches of the present poses; each names the row it had. The old ones go to `previous`.
void look(const Model& model, Data& data, double dt) {
    const ContactSystem& s = data.system;
    for (int i = 0; i < data.patches.count; ++i)
        data.patches.patch[index(i)].memory.row = -1;
    for (int i = 0; i < s.patches; ++i)
        data.patches.patch[index(s.row[index(i)].patch)].memory.row = i;
    data.previous = data.patches;
    detect_patches(data.tool, data.tool_cache, data.neighbors, data.neighbor_cache,
                   {model.settings.margin, dt}, data.previous, data.patches);
    if (data.plan.runs(Stage::moving_walls))
        weigh_contacts(data);
}

// point of a row that is nearest to a place, with its distance; -1 when there is none
template <typename Points>
int nearest(const Points& points, const PatchRow& t, const PatchList& patches, const Vec2& place,
            double& distance) {
    int best = -1;
    distance = 0.0;
    for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
        const double d = (place_of(patches, t, points[index(q)]).position - place).norm();
        if (best < 0 || d < distance) {
            best = q;
            distance = d;
        }
    }
    return best;
}

// between the ends of a patch, 0 of one point
template <typename Points>
double length_of(const PatchList& patches, const PatchRow& t, const Points& points) {
    if (t.point_count < 2)
        return 0.0;
    return (place_of(patches, t, points[index(t.first_point)]).position -
            place_of(patches, t, points[index(t.first_point + 1)]).position)
        .norm();
}

double overlap_energy(double stiffness, double gap) {
    const double depth = std::min(gap, 0.0);
    return 0.5 * stiffness * depth * depth;
}

// Poses along the way that a stretch moved: part 0 is where it began, 1 where it ends.
class Way {
  public:
    Way(const Data& data, const ExactMotion& motion)
        : motion_(motion)
        , time_(data.time)
        , pose_(data.pose) {
        for (int i = 0; i < data.movable_count; ++i) {
            movable_[index(i)] = data.movable[index(i)].belief.pose;
            row_[index(i)] = data.movable[index(i)].row;
        }
    }
    void go(const Model& model, Data& data, double part) const {
        data.time = time_ + part * motion_.done;
        data.pose = pose_ + part * motion_.moved.head<3>();
        for (int i = 0; i < data.movable_count; ++i) {
            MovableState& m = data.movable[index(i)];
            const int row = row_[index(i)];
            m.belief.pose = movable_[index(i)];
            if (row >= 0)
                m.belief.pose += part * motion_.moved.segment<3>(row);
            else
                m.belief.pose += part * motion_.done * m.belief.velocity;
        }
        move_neighbors(data, 0.0);
        place_tool(model, data);
    }
    // the same movables have the same rows as at the start
    [[nodiscard]] bool same_island(const Data& data) const {
        for (int i = 0; i < data.movable_count; ++i)
            if (row_[index(i)] != data.movable[index(i)].row)
                return false;
        return true;
    }
    void restore_island(Data& data) const {
        for (int i = 0; i < data.movable_count; ++i)
            data.movable[index(i)].row = row_[index(i)];
    }

  private:
    const ExactMotion& motion_;
    double time_;
    Pose pose_;
    std::array<Pose, k_max_movables> movable_;
    std::array<int, k_max_movables> row_;
};

// how far a point of a patch can have moved
double rim_motion(const Data& data, const Vec2& place, const FreedomVector& moved) {
    const double arm = 2.0 * (place - data.pose.head<2>()).norm() + k_same_place;
    double largest = 0.0;
    for (Eigen::Index k = 0; k + 2 < moved.size(); k += 3)
        largest = std::max(largest, moved.segment<2>(k).norm() + arm * std::abs(moved(k + 2)));
    return 2.0 * largest + k_same_place;
}

} // namespace

bool StretchRows::fits(const ContactSystem& s) {
    return s.points <= k_max_exact_points && s.patches <= k_max_exact_patches &&
           s.freedoms <= k_flow_freedoms;
}

StretchRows::StretchRows(const ContactSystem& s)
    : freedoms(s.freedoms)
    , points(s.points)
    , patches(s.patches) {
    std::copy_n(s.point.begin(), points, point.begin());
    std::copy_n(s.row.begin(), patches, row.begin());
    std::copy_n(s.normal_rows.data(), points * freedoms, normal.begin());
    std::copy_n(s.tangent_rows.data(), patches * freedoms, tangent.begin());
}

void StretchRows::restore(ContactSystem& s) const {
    s.freedoms = freedoms;
    s.points = points;
    s.patches = patches;
    std::copy_n(point.begin(), points, s.point.begin());
    std::copy_n(row.begin(), patches, s.row.begin());
    s.normal_rows.set_zero(points, freedoms);
    s.tangent_rows.set_zero(patches, freedoms);
    std::copy_n(normal.begin(), points * freedoms, s.normal_rows.data());
    std::copy_n(tangent.begin(), patches * freedoms, s.tangent_rows.data());
}

namespace {

// Takes what is known of the old rows over to the rows of the present patches, the place of whose points is
// in `previous`; true when every patch that was under force is still there.
bool carry_over(const StretchRows& old, Data& data) {
    ContactSystem& s = data.system;
    std::array<bool, k_max_exact_patches> found{};
    for (int i = 0; i < s.patches; ++i) {
        PatchRow& t = s.row[index(i)];
        const int row = data.patches.patch[index(t.patch)].memory.row;
        if (row < 0)
            continue;
        found[index(row)] = true;
        const PatchRow& before = old.row[index(row)];
        t.spring = before.spring;
        t.was_sliding = before.was_sliding;
        t.continuing = before.continuing;
        t.collided = before.collided;
        t.impulse = before.impulse;
        t.tangent_impulse = before.tangent_impulse;
        for (int q = before.first_point; q < before.first_point + before.point_count; ++q) {
            const PointRow& from = old.point[index(q)];
            double distance = 0.0;
            s.point[index(nearest(s.point, t, data.patches, place_of(data.previous, before, from).position,
                                  distance))]
                .impulse += from.impulse;
        }
        // what has just closed is awaited still; an end that comes into the list is not the other one
        const double length =
            std::max(length_of(data.patches, t, s.point), length_of(data.previous, before, old.point));
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
            PointRow& to = s.point[index(q)];
            double distance = 0.0;
            const int at =
                nearest(old.point, before, data.previous, place_of(data.patches, t, to).position, distance);
            if (length == 0.0 || distance < 0.5 * length)
                to.was_apart = old.point[index(at)].was_apart;
        }
    }
    for (int i = 0; i < old.patches; ++i) {
        const PatchRow& t = old.row[index(i)];
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q)
            if (!found[index(i)] && old.point[index(q)].gap < 0.0)
                return false;
    }
    return true;
}

} // namespace

void refresh_rows(const Model& model, Data& data, double left) {
    const StretchRows old(data.system);
    look(model, data, left);
    assemble(model, data, left);
    carry_over(old, data);
}

double turn_rows_halfway(const Model& model, Data& data, const StretchRows& start,
                         const ExactMotion& motion) {
    ContactSystem& s = data.system;
    const StretchRows end(s);
    const Way way(data, motion);
    way.go(model, data, 0.5);
    look(model, data, motion.done);
    assemble(model, data, motion.done);
    const bool same = s.freedoms == start.freedoms && way.same_island(data) && StretchRows::fits(s);
    if (!same || !carry_over(start, data)) {
        // other bodies belong to the system there, or a contact is lost: the rows stay
        way.restore_island(data);
        way.go(model, data, 0.0);
        data.patches = data.previous;
        assemble(model, data, motion.done);
        start.restore(s);
        return 0.0;
    }
    // gaps of the start: what was there, or the way back along the rows
    double shift = 0.0;
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[index(i)];
        const int row = data.patches.patch[index(t.patch)].memory.row;
        for (int q = t.first_point; q < t.first_point + t.point_count; ++q) {
            PointRow& p = s.point[index(q)];
            const Vec2& place = place_of(data.patches, t, p).position;
            double distance = 0.0;
            const int old =
                row < 0 ? -1 : nearest(start.point, start.row[index(row)], data.previous, place, distance);
            if (old >= 0 && distance <= rim_motion(data, place, motion.moved)) {
                const PointRow& from = start.point[index(old)];
                const double other_share = p.stiffness - from.stiffness;
                shift += std::abs(overlap_energy(other_share, end.point[index(old)].gap) -
                                  overlap_energy(other_share, from.gap));
                p.gap = from.gap;
            } else {
                p.gap -= 0.5 * (s.normal_rows.row(q).dot(motion.moved) - motion.done * p.drive);
            }
        }
    }
    way.go(model, data, 0.0);
    return shift;
}

double unseen_energy(const Model& model, Data& data, const ExactMotion& motion) {
    const ContactSystem& s = data.system;
    const Way way(data, motion);
    way.go(model, data, 1.0);
    look(model, data, motion.done);
    double energy = 0.0;
    for (int i = 0; i < data.patches.count; ++i) {
        const Patch& patch = data.patches.patch[index(i)];
        const int row = patch.memory.row;
        for (int k = 0; k < patch.point_count; ++k) {
            const PatchPoint& point = patch.point[index(k)];
            double distance = 0.0;
            const int q =
                row < 0 ? -1 : nearest(s.point, s.row[index(row)], data.previous, point.position, distance);
            if (q >= 0 && s.point[index(q)].stiffness > 0.0 &&
                distance <= rim_motion(data, point.position, motion.moved)) {
                const PointRow& p = s.point[index(q)];
                energy +=
                    std::abs(overlap_energy(p.stiffness, point.gap) - overlap_energy(p.stiffness, p.gap));
            } else {
                energy += overlap_energy(patch.surface.stiffness * point.weight, point.gap);
            }
        }
    }
    way.go(model, data, 0.0);
    data.patches = data.previous;
    return energy;
}

double unearned_energy(const Data& data, double dt, double& earned) {
    double unearned = 0.0;
    earned = 0.0;
    for (int i = 0; i < data.patches.count; ++i) {
        const Patch& now = data.patches.patch[index(i)];
        double energy = 0.0;
        bool goes_on = false;
        for (int k = 0; k < now.point_count; ++k) {
            const PatchPoint& point = now.point[index(k)];
            const double stiffness = now.surface.stiffness * point.weight;
            const double arm = (point.position - data.pose.head<2>()).norm();
            const double reach =
                2.0 * dt * (data.velocity.head<2>().norm() + arm * std::abs(data.velocity.z())) + k_near_row;
            double nearest = reach;
            double gap = 0.0;
            for (int j = 0; point.gap < 0.0 && j < data.previous.count; ++j) {
                const Patch& old = data.previous.patch[index(j)];
                if (old.side.id_a != now.side.id_a ||
                    (old.side.id_b != now.side.id_b && !(old.side.fixed_b && now.side.fixed_b)))
                    continue;
                for (int m = 0; m < old.point_count; ++m) {
                    const double distance = (old.point[index(m)].position - point.position).norm();
                    if (distance > nearest)
                        continue;
                    nearest = distance;
                    gap = old.point[index(m)].gap;
                    goes_on = true;
                }
            }
            // the far end of a patch that goes on may come into the list with the overlap that it had
            if (nearest < reach || !goes_on)
                energy +=
                    std::max(0.0, overlap_energy(stiffness, point.gap) - overlap_energy(stiffness, gap));
            earned += overlap_energy(stiffness, gap);
        }
        unearned += energy;
    }
    return unearned;
}

} // namespace haptics::local
