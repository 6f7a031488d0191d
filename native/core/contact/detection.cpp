/// Broad phase. In a step h a point of body a at distance up to R_a from its reference point comes nearer to
/// b by at most
///     reach = h (|v_a - v_b| + |w_a| R_a + |w_b| R_b),
/// so only pairs whose discs, and pieces whose box and disc, are within margin + reach can touch. The first
/// test of a pair takes each body's own share of that (with |v_a| + |v_b| for |v_a - v_b|), which is computed
/// once per body and step. A body that was pressed deep into matter is looked for that much farther: it still
/// feels the face it came through.

#include <haptics/core/contact/detection.hpp>

#include <algorithm>
#include <tuple>

#include "pair_contact.hpp"
#include "patch_merge.hpp"
#include "patch_tracking.hpp"

namespace haptics {
namespace {

using namespace contact;

/// One body of either set with what is needed again and again.
struct Actor {
    const Body* body{nullptr};
    const Piece* piece{nullptr};
    const PieceBounds* bounds{nullptr};
    double radius{0.0};
    std::int32_t index{0};
    bool tool{false};
};

/// Disc about a body's reference point that it cannot leave in the coming step, m.
struct Disc {
    double x;
    double y;
    double radius;
    bool movable;

    [[nodiscard]] bool apart(const Disc& other) const {
        const double dx = x - other.x;
        const double dy = y - other.y;
        const double reach = radius + other.radius;
        return dx * dx + dy * dy > reach * reach;
    }
};

struct Search {
    const DetectionSettings& settings;
    const Memory& memory;
    DraftList& drafts;
};

std::uint64_t mix(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
}

std::uint64_t feature_id(const Actor& actor, const Piece& piece, int feature) {
    return mix(mix(actor.body->id + (actor.tool ? 0x5bd1e995U : 0U)) ^
               (static_cast<std::uint64_t>(piece.id) << 8 | static_cast<std::uint64_t>(feature)));
}

/// Whether a disc comes near to the box of a piece (both in the axes of the piece's body).
bool near_box(const PieceBounds& box, const Vec2& center, double distance) {
    const double dx = std::max({box.low.x() - center.x(), center.x() - box.high.x(), 0.0});
    const double dy = std::max({box.low.y() - center.y(), center.y() - box.high.y(), 0.0});
    return dx * dx + dy * dy <= distance * distance;
}

void write_side(const Actor& a, const Actor& b, const PairContact& contact, PatchSide& side) {
    side.face = contact.face;
    side.edge = contact.edge;
    const Body& owner = contact.face == PatchSide::Face::of_a ? *a.body : *b.body;
    side.normal = rotate(-owner.pose.z(), contact.normal);
    side.scene_offset = contact.normal.dot(contact.point[0].position);
    if (contact.face == PatchSide::Face::of_a)
        side.scene_offset += contact.point[0].gap;
    side.offset = side.scene_offset - contact.normal.dot(owner.pose.head<2>());
}

void collide_pieces(const Search& search, const Actor& a, const Piece& piece_a, const PlacedConvex& placed_a,
                    const Actor& b, const Piece& piece_b, const Transform& at_b, double reach) {
    Draft draft;
    PatchSide& side = draft.patch.side;
    side.id_a = a.body->id;
    side.id_b = b.body->id;
    side.piece_a = piece_a.id;
    side.piece_b = piece_b.id;
    side.tool_a = a.tool;
    side.fixed_b = b.body->kind == BodyKind::fixed;

    PlacedConvex placed_b;
    place(piece_b.convex, at_b, placed_b);
    PairQuery query;
    query.limit = search.settings.margin + reach;
    query.one_way = piece_b.one_way;
    if (query.one_way)
        query.one_way_normal = at_b.turn(piece_b.one_way_normal);
    if (search.memory.count > 0)
        query.hint = side_of(search.memory, side, placed_a, placed_b);

    PairContact contact;
    if (!collide(placed_a, placed_b, query, contact))
        return;
    draft.rank = contact.rank;
    draft.plane_normal = contact.plane_normal;
    draft.plane_offset = contact.plane_offset;
    draft.reach = reach;
    draft.one_way = piece_b.one_way;
    draft.surface_b = b.body->surface;
    draft.patch.body_a = a.index;
    draft.patch.body_b = b.index;
    draft.patch.feature_a = feature_id(a, piece_a, contact.feature_a);
    draft.patch.feature_b = feature_id(b, piece_b, contact.feature_b);
    draft.patch.normal = contact.normal;
    draft.patch.point_count = contact.count;
    draft.patch.point = contact.point;
    // two that are infinitely hard meet at the hardest that a surface may be
    constexpr double k_hardest = 1e12;
    Surface& surface = draft.patch.surface;
    surface = combine(a.body->surface, b.body->surface);
    surface.stiffness = std::min(surface.stiffness, k_hardest);
    surface.damping = std::min(surface.damping, k_hardest);
    draft.patch.presence = std::min(a.body->presence, b.body->presence);
    write_side(a, b, contact, side);
    search.drafts.add(draft);
}

/// How far a body's rim moves by its turn, m/s; an unbounded body that does not turn has none.
double rim_speed(const Body& body, double radius) {
    const double spin = std::abs(body.velocity.z());
    return spin > 0.0 ? spin * radius : 0.0;
}

Disc disc_of(const Search& search, const Body& body, double radius, bool tool) {
    const double speed = std::abs(body.velocity.x()) + std::abs(body.velocity.y()) + rim_speed(body, radius);
    double grown = radius + 0.5 * search.settings.margin + search.settings.step * speed;
    if (search.memory.count > 0 && (tool || body.kind == BodyKind::movable))
        grown += last_depth(search.memory, body.id, tool);
    return {body.pose.x(), body.pose.y(), grown, body.kind == BodyKind::movable};
}

void collide_bodies(const Search& search, const Actor& a, const Actor& b) {
    const Vec2 closing = b.body->velocity.head<2>() - a.body->velocity.head<2>();
    const double reach =
        search.settings.step * (closing.norm() + rim_speed(*a.body, a.radius) + rim_speed(*b.body, b.radius));
    double limit = search.settings.margin + reach;
    if (search.memory.count > 0)
        limit += last_depth(search.memory, a.body->id, a.tool);
    const Transform at_a(a.body->pose);
    const Transform at_b(b.body->pose);
    for (std::int32_t i = 0; i < a.body->piece_count; ++i) {
        const Piece& piece_a = a.piece[i];
        const PieceBounds& bounds_a = a.bounds[i];
        const Vec2 center = at_b.apply_inverse(at_a.apply(bounds_a.center));
        PlacedConvex placed_a;
        for (std::int32_t k = 0; k < b.body->piece_count; ++k) {
            if (!near_box(b.bounds[k], center, bounds_a.radius + limit))
                continue;
            if (placed_a.count == 0)
                place(piece_a.convex, at_a, placed_a);
            if (placed_a.count > 0 && !placed_a.half_plane && b.piece[k].convex.count > 0)
                collide_pieces(search, a, piece_a, placed_a, b, b.piece[k], at_b, reach);
        }
    }
}

Actor actor(const BodySet& set, const BodyBounds& bounds, std::int32_t i, std::int32_t first_index,
            bool tool) {
    const Body& body = set.body[static_cast<std::size_t>(i)];
    const auto first = static_cast<std::size_t>(std::clamp(body.first_piece, 0, k_max_pieces - 1));
    return {&body,
            &set.piece[first],
            &bounds.piece[first],
            bounds.radius[static_cast<std::size_t>(i)],
            first_index + i,
            tool};
}

/// Movable neighbors against the others; of two movable ones the smaller id is a. What a jointed one touches
/// is in its mobility already, but for movables that are free.
void collide_neighbors(const Search& search, const BodySet& neighbors, const BodyBounds& bounds,
                       const Disc* disc, std::int32_t first_index) {
    for (std::int32_t i = 0; i < neighbors.body_count; ++i) {
        if (!disc[i].movable)
            continue;
        for (std::int32_t k = 0; k < neighbors.body_count; ++k) {
            if ((disc[k].movable && k <= i) || disc[i].apart(disc[k]))
                continue;
            const Body& one = neighbors.body[static_cast<std::size_t>(i)];
            const Body& other = neighbors.body[static_cast<std::size_t>(k)];
            if ((one.jointed && (other.jointed || !disc[k].movable)) || (other.jointed && !disc[i].movable))
                continue;
            const bool first = other.kind != BodyKind::movable || one.id < other.id;
            collide_bodies(search, actor(neighbors, bounds, first ? i : k, first_index, false),
                           actor(neighbors, bounds, first ? k : i, first_index, false));
        }
    }
}

/// Order by ids only.
void sort(DraftList& drafts) {
    const auto key = [](const Draft& draft) {
        const PatchSide& s = draft.patch.side;
        return std::tuple(!s.tool_a, s.id_a, s.id_b, draft.patch.feature_b, draft.patch.feature_a);
    };
    for (int i = 1; i < drafts.count; ++i)
        for (int k = i; k > 0; --k) {
            Draft& before = drafts[k - 1];
            Draft& here = drafts[k];
            if (!(key(here) < key(before)))
                break;
            std::swap(here, before);
        }
}

} // namespace

void detect_patches(const BodySet& tool, const BodyBounds& tool_bounds, const BodySet& neighbors,
                    const BodyBounds& neighbor_bounds, const DetectionSettings& settings,
                    const PatchList& previous, PatchList& patches) {
    Memory memory;
    recall(tool, neighbors, previous, memory);
    DraftList drafts;
    const Search search{settings, memory, drafts};

    // find and merge
    std::array<Disc, k_max_bodies> disc; // written for the bodies there are
    for (std::int32_t k = 0; k < neighbors.body_count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        disc[index] = disc_of(search, neighbors.body[index], neighbor_bounds.radius[index], false);
    }
    for (std::int32_t i = 0; i < tool.body_count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        const Disc own = disc_of(search, tool.body[index], tool_bounds.radius[index], true);
        for (std::int32_t k = 0; k < neighbors.body_count; ++k) {
            if (!own.apart(disc[static_cast<std::size_t>(k)]))
                collide_bodies(search, actor(tool, tool_bounds, i, 0, true),
                               actor(neighbors, neighbor_bounds, k, tool.body_count, false));
        }
    }
    collide_neighbors(search, neighbors, neighbor_bounds, disc.data(), tool.body_count);

    // remember and order
    sort(drafts);
    carry_over(memory, drafts);
    sort(drafts);

    patches.overflow = previous.overflow + static_cast<std::uint64_t>(drafts.dropped);
    patches.count = drafts.count;
    for (std::int32_t i = 0; i < drafts.count; ++i) {
        Patch& patch = patches.patch[static_cast<std::size_t>(i)];
        patch = drafts[i].patch;
        share_out(patch, settings.tilt);
    }
}

void detect_patches(const BodySet& tool, const BodySet& neighbors, const DetectionSettings& settings,
                    const PatchList& previous, PatchList& patches) {
    BodyBounds tool_bounds;
    BodyBounds neighbor_bounds;
    compute_bounds(tool, tool_bounds);
    compute_bounds(neighbors, neighbor_bounds);
    detect_patches(tool, tool_bounds, neighbors, neighbor_bounds, settings, previous, patches);
}

} // namespace haptics
