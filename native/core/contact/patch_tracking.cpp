/// A patch goes on when the same two bodies (all fixed bodies count as one) touch at nearly the same place in
/// nearly the same direction; the same features settle it first. The mismatch of two patches is
///     distance of their nearest points + k_turn_length * |n - n'|,
/// pairs are taken from the smallest mismatch upward, and each patch is used once: a box that rolls from its
/// face onto its corner, slides over a seam or turns around a rounded corner keeps its state.

#include "patch_tracking.hpp"

#include <algorithm>
#include <limits>

namespace haptics::contact {
namespace {

using Face = PatchSide::Face;

/// Mismatch of a turn by one radian, m.
constexpr double k_turn_length = 0.005;
/// Cosine of the largest turn of the normal from step to step (60 degrees).
constexpr double k_same_way = 0.5;
/// How far a patch may jump beyond the reach of the pair, m.
constexpr double k_jump = 0.003;
/// Planes of neighboring pieces that count as one, m and sine.
constexpr double k_same_plane = 1e-5;
constexpr double k_same_plane_turn = 1e-3;
/// Depth from which a one-way piece lets pass what has no history, m.
constexpr double k_one_way_depth = 1e-6;

/// Index of a body, -1 when it is gone; mostly it is where it was.
std::int32_t find(const BodySet& set, std::uint64_t id, std::int32_t hint) {
    if (hint >= 0 && hint < set.body_count && set.body[static_cast<std::size_t>(hint)].id == id)
        return hint;
    for (std::int32_t i = 0; i < set.body_count; ++i)
        if (set.body[static_cast<std::size_t>(i)].id == id)
            return i;
    return -1;
}

/// Index of the k-th deepest.
std::size_t index_at(const Memory& memory, int k) {
    return static_cast<std::size_t>(memory.by_depth[static_cast<std::size_t>(k)]);
}

bool same_pair(const PatchSide& p, const PatchSide& q) {
    return p.id_a == q.id_a && p.tool_a == q.tool_a && p.fixed_b == q.fixed_b &&
           (p.fixed_b || p.id_b == q.id_b);
}

/// Edge of b on the given plane, -1 when there is none.
int edge_on_plane(const PlacedConvex& b, const Vec2& normal, double offset) {
    for (int edge = 0; edge < b.faces(); ++edge) {
        if (b.n(edge).dot(normal) <= 0.0 || std::abs(cross(b.n(edge), normal)) > k_same_plane_turn ||
            is_hidden(*b.shape, edge))
            continue;
        const double start = std::abs(normal.dot(b.v(edge)) + b.radius - offset);
        const double end = std::abs(normal.dot(b.v(b.next(edge))) + b.radius - offset);
        if (std::min(start, end) < k_same_plane)
            return edge;
    }
    return -1;
}

double distance(const Patch& p, const Patch& q) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < p.point_count; ++i)
        for (int k = 0; k < q.point_count; ++k)
            nearest = std::min(nearest, (p.point[static_cast<std::size_t>(i)].position -
                                         q.point[static_cast<std::size_t>(k)].position)
                                            .norm());
    return nearest;
}

/// What lies on a plane has come from its free side, whichever piece it lay on; contact with other matter
/// near by tells nothing of that.
bool came_from_free_side(const Remembered& old, const Draft& draft) {
    const PatchSide& p = old.patch->side;
    const PatchSide& q = draft.patch.side;
    if (p.id_b == q.id_b && p.piece_b == q.piece_b)
        return true;
    return std::abs(cross(old.normal, draft.plane_normal)) < k_same_plane_turn &&
           std::abs(old.offset - draft.plane_offset) < k_same_plane;
}

bool may_go_on(const Remembered& old, const Draft& draft) {
    return same_pair(old.patch->side, draft.patch.side) && old.normal.dot(draft.patch.normal) >= k_same_way &&
           (!draft.one_way || came_from_free_side(old, draft));
}

double mismatch(const Remembered& old, const Draft& draft) {
    if (!may_go_on(old, draft))
        return std::numeric_limits<double>::infinity();
    const double apart = distance(*old.patch, draft.patch);
    if (apart > k_jump + draft.reach)
        return std::numeric_limits<double>::infinity();
    return apart + k_turn_length * (old.normal - draft.patch.normal).norm();
}

void go_on(const Memory& memory, int old, Draft& draft, std::array<bool, k_max_patches>& used) {
    used[static_cast<std::size_t>(old)] = true;
    draft.previous = old;
    draft.patch.memory = memory.patch[static_cast<std::size_t>(old)].patch->memory;
}

/// Same features first; mostly the patches are those of the last step, in the same order.
int match_features(const Memory& memory, DraftList& drafts, std::array<bool, k_max_patches>& used) {
    const auto match = [&](int k, int i) {
        const Remembered& old = memory.patch[static_cast<std::size_t>(i)];
        Draft& draft = drafts[k];
        if (used[static_cast<std::size_t>(i)] || old.patch->feature_a != draft.patch.feature_a ||
            old.patch->feature_b != draft.patch.feature_b || !may_go_on(old, draft))
            return false;
        go_on(memory, i, draft, used);
        return true;
    };
    int matched = 0;
    for (int k = 0; k < drafts.count; ++k) {
        bool found = k < memory.count && match(k, k);
        for (int i = 0; i < memory.count && !found; ++i)
            found = match(k, i);
        matched += found ? 1 : 0;
    }
    return matched;
}

/// Then the nearest of the others, best pairs first.
void match_nearest(const Memory& memory, DraftList& drafts, int rounds,
                   std::array<bool, k_max_patches>& used) {
    for (int round = 0; round < rounds; ++round) {
        double best = std::numeric_limits<double>::infinity();
        int best_old = -1;
        int best_new = -1;
        for (int i = 0; i < memory.count; ++i) {
            if (used[static_cast<std::size_t>(i)])
                continue;
            for (int k = 0; k < drafts.count; ++k) {
                if (drafts[k].previous >= 0)
                    continue;
                const double m = mismatch(memory.patch[static_cast<std::size_t>(i)], drafts[k]);
                if (m < best) {
                    best = m;
                    best_old = i;
                    best_new = k;
                }
            }
        }
        if (best_old < 0)
            return;
        go_on(memory, best_old, drafts[best_new], used);
    }
}

} // namespace

void recall(const BodySet& tool, BodyCache& tool_cache, const BodySet& neighbors, BodyCache& neighbor_cache,
            const PatchList& previous, Memory& memory) {
    memory.count = previous.count;
    for (std::int32_t i = 0; i < previous.count; ++i) {
        const Patch& patch = previous.patch[static_cast<std::size_t>(i)];
        Remembered& entry = memory.patch[static_cast<std::size_t>(i)];
        entry.patch = &patch;
        entry.gap = smallest_gap(patch);
        entry.normal = patch.normal;
        entry.offset = patch.side.scene_offset;
        const bool of_a = patch.side.face == Face::of_a;
        const bool of_tool = of_a && patch.side.tool_a;
        const BodySet& set = of_tool ? tool : neighbors;
        const std::int32_t index = of_a ? patch.body_a : patch.body_b;
        const std::int32_t owner =
            find(set, of_a ? patch.side.id_a : patch.side.id_b, of_tool ? index : index - tool.body_count);
        if (owner >= 0) {
            const Transform at = (of_tool ? tool_cache : neighbor_cache).place(set, owner);
            entry.normal = at.turn(patch.side.normal);
            entry.offset = entry.normal.dot(at.origin) + patch.side.offset;
        }
        int k = i;
        for (; k > 0 && entry.gap < memory.patch[index_at(memory, k - 1)].gap; --k)
            memory.by_depth[static_cast<std::size_t>(k)] = memory.by_depth[static_cast<std::size_t>(k - 1)];
        memory.by_depth[static_cast<std::size_t>(k)] = static_cast<std::int8_t>(i);
    }
}

SideHint side_of(const Memory& memory, const PatchSide& pair, const PlacedConvex& a, const PlacedConvex& b,
                 const Vec2& center_b, double radius_b) {
    for (int k = 0; k < memory.count; ++k) {
        const Remembered& old = memory.patch[index_at(memory, k)];
        const PatchSide& side = old.patch->side;
        if (!same_pair(side, pair))
            continue;
        const bool same_b = side.id_b == pair.id_b && side.piece_b == pair.piece_b;
        const bool same_pieces = same_b && side.piece_a == pair.piece_a;
        SideHint found;
        if (side.face == Face::of_b) {
            // most of b's neighbors are nowhere near the plane
            found.edge = std::abs(old.normal.dot(center_b) - old.offset) > radius_b + k_same_plane
                             ? -1
                             : edge_on_plane(b, old.normal, old.offset);
            if (found.edge >= 0)
                found.face = Face::of_b;
        } else if (side.face == Face::of_a && same_pieces && side.edge < a.faces() &&
                   !is_hidden(*a.shape, side.edge)) {
            found.face = Face::of_a;
            found.edge = side.edge;
        }
        if (found.face == Face::none && !same_pieces)
            continue;
        found.normal = old.normal;
        found.known = true;
        return found;
    }
    return {};
}

double last_depth(const Memory& memory, std::uint64_t id_a, bool tool_a) {
    double depth = 0.0;
    for (int i = 0; i < memory.count; ++i) {
        const Remembered& old = memory.patch[static_cast<std::size_t>(i)];
        if (old.patch->side.id_a == id_a && old.patch->side.tool_a == tool_a)
            depth = std::max(depth, -old.gap);
    }
    return depth;
}

bool carry_over(const Memory& memory, DraftList& drafts) {
    std::array<bool, k_max_patches> used{};
    const int matched = match_features(memory, drafts, used);
    match_nearest(memory, drafts, std::min(drafts.count, memory.count) - matched, used);

    // drop what cannot be
    bool dropped = false;
    for (int k = drafts.count - 1; k >= 0; --k) {
        const Draft& draft = drafts[k];
        if (draft.previous >= 0)
            continue;
        const double gap = smallest_gap(draft.patch);
        bool drop = draft.one_way && gap < -k_one_way_depth;
        for (int i = 0; i < drafts.count && !drop; ++i) {
            const Draft& other = drafts[i];
            if (i == k || !same_pair(draft.patch.side, other.patch.side) || smallest_gap(other.patch) >= 0.0)
                continue;
            drop = draft.rank == Rank::inside ? other.rank != Rank::inside
                                              : other.previous >= 0 && gap < -(draft.reach + k_jump);
        }
        if (drop)
            drafts.remove(k);
        dropped = dropped || drop;
    }
    return dropped;
}

} // namespace haptics::contact
