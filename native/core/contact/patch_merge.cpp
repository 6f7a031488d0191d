/// Contacts belong to one patch when they are of the same body a, lie on one plane of b's matter (all fixed
/// matter with one surface is one solid) and push in nearly the same direction. Of the points of a patch the
/// two ends along the tangent stay: with a linear gap in between they give the same force and torque as all
/// of them.
///
/// Shares. Level ends have a half each. When one end is higher, its share w falls with the rise r = (g_up -
/// g_low) / max(tilt, -g_low) as
///     w = 1/2 (1 - 3 r^2 + 2 r^3),
/// and is gone at r = 1: a box that is tilted onto its corner feels the full stiffness of the wall there, and
/// nothing jumps on the way. (A share that follows the depths alone would be stiffer to turning than the
/// wall, and chatter on hard walls; and so would one that never does, pressed in deep: a force F at a lever l
/// that changes ends within the tilt s is a spring of 3 F l^2 / s to turning, 16 times the wall's for 20 N on
/// 15000 N/m, and more than 500 Hz bear. With the depth F / K it is one of 3 K l^2 at most, and an end has a
/// share as long as it overlaps.) An end without a share has no spring, but its hit must not be missed: where
/// a box tips over onto it within the step, it stays a point of the patch.
///
/// Matter that fades. Of two contacts with presences p >= q, the ends go from those of p alone (q = 0) to
/// those of both (q = p), and the presence of the patch is min(1, p + q): the pressure of a tool that stands
/// half on a tile that leaves moves over to the other half, and what is replaced by its like is not felt.

#include "patch_merge.hpp"

#include <algorithm>
#include <utility>

namespace haptics::contact {
namespace {

/// Planes that differ by less are one, m and sine.
constexpr double k_merge_plane = 1e-5;
constexpr double k_merge_turn = 2e-3;
/// Directions of push that may merge, cosine of 0.1 rad.
constexpr double k_same_push = 0.995;
/// A point that is deeper than both ends by more than this is the patch on its own, m.
constexpr double k_proud = 1e-6;
/// Points nearer than this are one, m.
constexpr double k_one_point = 1e-8;
/// Gaps that differ by less are equal, m.
constexpr double k_merge_tie = 1e-12;

bool one_patch(const Draft& p, const Draft& q) {
    if (p.patch.normal.dot(q.patch.normal) < k_same_push)
        return false;
    const PatchSide& s = p.patch.side;
    const PatchSide& t = q.patch.side;
    if (s.id_a != t.id_a || s.tool_a != t.tool_a || s.fixed_b != t.fixed_b ||
        (!s.fixed_b && s.id_b != t.id_b))
        return false;
    if (!(p.surface_b == q.surface_b))
        return false;
    const double turn = cross(p.plane_normal, q.plane_normal);
    return std::abs(turn) < k_merge_turn && p.plane_normal.dot(q.plane_normal) > 0.0 &&
           std::abs(p.plane_normal.dot(q.patch.point[0].position) - p.plane_offset -
                    (q.plane_normal.dot(q.patch.point[0].position) - q.plane_offset)) < k_merge_plane;
}

bool leads(const Draft& p, const Draft& q) {
    const double difference = smallest_gap(p.patch) - smallest_gap(q.patch);
    if (std::abs(difference) > k_merge_tie)
        return difference < 0.0;
    if (p.patch.feature_b != q.patch.feature_b)
        return p.patch.feature_b < q.patch.feature_b;
    return p.patch.feature_a < q.patch.feature_a;
}

/// The ends of `patch`, as many as `ends` has: a single point is both of its ends.
const PatchPoint& end_of(const Patch& patch, std::size_t end) {
    return patch.point[patch.point_count < 2 ? 0 : end];
}

/// Draws the ends of a joined patch back to those of the contact that is there for longer.
void draw_back(const Patch& stays, double share, Patch& joined) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(joined.point_count); ++k) {
        const Vec2 tangent = perpendicular(joined.normal);
        const bool ordered =
            stays.point_count < 2 || tangent.dot(stays.point[1].position - stays.point[0].position) >= 0.0;
        const PatchPoint& from = end_of(stays, ordered ? k : 1 - k);
        PatchPoint& p = joined.point[k];
        p.position = from.position + share * (p.position - from.position);
        p.gap = from.gap + share * (p.gap - from.gap);
    }
}

/// Points of both, reduced to the two ends.
void join(Patch& kept, const Patch& other) {
    std::array<PatchPoint, 4> point;
    int count = 0;
    for (int i = 0; i < kept.point_count; ++i)
        point[static_cast<std::size_t>(count++)] = kept.point[static_cast<std::size_t>(i)];
    for (int i = 0; i < other.point_count; ++i)
        point[static_cast<std::size_t>(count++)] = other.point[static_cast<std::size_t>(i)];
    const Vec2 tangent = perpendicular(kept.normal);
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t deepest = 0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
        if (tangent.dot(point[i].position - point[first].position) < 0.0)
            first = i;
        if (tangent.dot(point[i].position - point[last].position) > 0.0)
            last = i;
        if (point[i].gap < point[deepest].gap)
            deepest = i;
    }
    if (point[deepest].gap < std::min(point[first].gap, point[last].gap) - k_proud)
        first = last = deepest;
    kept.point_count = first == last ? 1 : 2;
    kept.point[0] = point[first];
    if (first != last)
        kept.point[1] = point[last];
}

/// The same where matter fades.
void join_fading(Patch& kept, const Patch& other) {
    const Patch alone = kept.presence >= other.presence ? kept : other;
    const double less = std::min(kept.presence, other.presence);
    const bool same_body = kept.body_b == other.body_b;
    join(kept, other);
    if (less < alone.presence)
        draw_back(alone, less / alone.presence, kept);
    kept.presence = same_body ? alone.presence : std::min(1.0, alone.presence + less);
}

} // namespace

void DraftList::add(const Draft& added) {
    for (int i = 0; i < count; ++i) {
        Draft& present = (*this)[i];
        if (!one_patch(present, added))
            continue;
        if (added.rank > present.rank)
            return;
        if (added.rank < present.rank) {
            present = added;
            return;
        }
        const double reach = std::max(present.reach, added.reach);
        const bool one_way = present.one_way && added.one_way;
        const auto join_points =
            added.patch.presence < 1.0 || present.patch.presence < 1.0 ? join_fading : join;
        if (leads(added, present)) {
            Draft merged = added;
            join_points(merged.patch, present.patch);
            present = std::move(merged);
        } else {
            join_points(present.patch, added.patch);
        }
        present.reach = reach;
        present.one_way = one_way;
        return;
    }
    if (count < k_max_patches) {
        ++count;
        return;
    }
    ++dropped;
    int shallowest = 0;
    for (int i = 1; i < count; ++i) {
        if (smallest_gap((*this)[i].patch) > smallest_gap((*this)[shallowest].patch))
            shallowest = i;
    }
    if (smallest_gap(added.patch) < smallest_gap((*this)[shallowest].patch))
        (*this)[shallowest] = added;
}

void share_out(Patch& patch, double tilt, double reach) {
    patch.point[0].weight = 1.0;
    if (patch.point_count < 2)
        return;
    const std::size_t low = patch.point[0].gap <= patch.point[1].gap ? 0 : 1;
    const double scale = std::max(tilt, -patch.point[low].gap);
    const double rise = (patch.point[1 - low].gap - patch.point[low].gap) / scale;
    const double length = (patch.point[1].position - patch.point[0].position).squaredNorm();
    const bool awaited = patch.point[1 - low].gap > 0.0 && patch.point[1 - low].gap < reach;
    if ((rise >= 1.0 && !awaited) || length < k_one_point * k_one_point) {
        patch.point[0] = patch.point[low];
        patch.point[0].weight = 1.0;
        patch.point_count = 1;
        return;
    }
    const double upper = rise < 1.0 ? 0.5 * (1.0 - rise * rise * (3.0 - 2.0 * rise)) : 0.0;
    patch.point[1 - low].weight = upper;
    patch.point[low].weight = 1.0 - upper;
}

} // namespace haptics::contact
