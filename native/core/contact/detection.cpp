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
    const BodySet* set{nullptr};
    BodyCache* cache{nullptr};
    const Body* body{nullptr};
    const Piece* piece{nullptr};
    const PieceBounds* bounds{nullptr};
    std::size_t first_piece{0};
    Transform at;
    double radius{0.0};
    std::int32_t index{0};
    bool tool{false};
    /// How deep it was pressed into other matter in the last step, m.
    double depth{0.0};
    /// A disc that holds the body, in scene axes, for body b of a pair.
    Vec2 disc_center{0.0, 0.0};
    double disc_radius{0.0};
    /// Centers of its pieces' bounds in scene axes, for body a of a pair.
    const Vec2* center{nullptr};

    [[nodiscard]] const PlacedConvex& placed(std::int32_t i) const {
        return cache->piece(*set, first_piece + static_cast<std::size_t>(i), at);
    }
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

/// A hit of one end of an edge with the speed v adds (1 + e) v (a^2 - k^2) / (a^2 + k^2) to that of the
/// other, a the half length, k the radius of gyration: below 2 v. With room for what forces add.
constexpr double k_hit_gain = 4.0;

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
    const double dx = std::max(std::max(box.low.x() - center.x(), center.x() - box.high.x()), 0.0);
    const double dy = std::max(std::max(box.low.y() - center.y(), center.y() - box.high.y()), 0.0);
    return dx * dx + dy * dy <= distance * distance;
}

void write_side(const Actor& a, const Actor& b, const PairContact& contact, PatchSide& side) {
    side.face = contact.face;
    side.edge = contact.edge;
    const Transform& owner = contact.face == PatchSide::Face::of_a ? a.at : b.at;
    side.normal = owner.turn_back(contact.normal);
    side.scene_offset = contact.normal.dot(contact.point[0].position);
    if (contact.face == PatchSide::Face::of_a)
        side.scene_offset += contact.point[0].gap;
    side.offset = side.scene_offset - contact.normal.dot(owner.origin);
}

void collide_pieces(const Search& search, const Actor& a, const PlacedConvex& placed_a, std::int32_t index_a,
                    const Actor& b, std::int32_t index_b, double reach) {
    const Piece& piece_a = a.piece[index_a];
    const Piece& piece_b = b.piece[index_b];
    Draft& draft = search.drafts.next();
    PatchSide& side = draft.patch.side;
    side.id_a = a.body->id;
    side.id_b = b.body->id;
    side.piece_a = piece_a.id;
    side.piece_b = piece_b.id;
    side.tool_a = a.tool;
    side.fixed_b = b.body->kind == BodyKind::fixed;

    const PlacedConvex& placed_b = b.placed(index_b);
    PairQuery query;
    query.limit = search.settings.margin + reach;
    query.one_way = piece_b.one_way;
    if (query.one_way)
        query.one_way_normal = b.at.turn(piece_b.one_way_normal);
    if (search.memory.count > 0)
        query.hint = side_of(search.memory, side, placed_a, placed_b, b.at.apply(b.bounds[index_b].center),
                             b.bounds[index_b].radius);

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
    surface = surface_between(*a.body, *b.body);
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
    const double limit = search.settings.margin + reach + a.depth;
    for (std::int32_t i = 0; i < a.body->piece_count; ++i) {
        const double near = a.bounds[i].radius + limit;
        const double wide = near + b.disc_radius;
        const double dx = a.center[i].x() - b.disc_center.x();
        const double dy = a.center[i].y() - b.disc_center.y();
        if (dx * dx + dy * dy > wide * wide)
            continue;
        const Vec2 center = b.at.apply_inverse(a.center[i]);
        const PlacedConvex* placed_a = nullptr;
        for (std::int32_t k = 0; k < b.body->piece_count; ++k) {
            if (!near_box(b.bounds[k], center, near))
                continue;
            if (placed_a == nullptr)
                placed_a = &a.placed(i);
            if (placed_a->count > 0 && !placed_a->half_plane && b.piece[k].convex.count > 0)
                collide_pieces(search, a, *placed_a, i, b, k, reach);
        }
    }
}

Actor actor(const BodySet& set, BodyCache& cache, std::int32_t i, std::int32_t first_index, bool tool) {
    const Body& body = set.body[static_cast<std::size_t>(i)];
    const auto first = static_cast<std::size_t>(std::clamp(body.first_piece, 0, k_max_pieces - 1));
    Actor actor;
    actor.set = &set;
    actor.cache = &cache;
    actor.body = &body;
    actor.first_piece = first;
    actor.piece = &set.piece[first];
    actor.bounds = &cache.bounds.piece[first];
    actor.at = cache.place(set, i);
    actor.radius = cache.bounds.radius[static_cast<std::size_t>(i)];
    actor.disc_center = actor.at.apply(cache.bounds.center[static_cast<std::size_t>(i)]);
    actor.disc_radius = cache.bounds.extent[static_cast<std::size_t>(i)];
    actor.index = first_index + i;
    actor.tool = tool;
    return actor;
}

/// Body a of pairs, with the room for the centers of its pieces.
void become_first(const Memory& memory, std::array<Vec2, k_max_pieces>& center, Actor& a) {
    a.depth = memory.count > 0 ? last_depth(memory, a.body->id, a.tool) : 0.0;
    for (std::int32_t i = 0; i < a.body->piece_count; ++i)
        center[static_cast<std::size_t>(i)] = a.at.apply(a.bounds[i].center);
    a.center = center.data();
}

/// Movable neighbors against the others; of two movable ones the smaller id is a. What a jointed one touches
/// is in its mobility already, but for movables that are free.
void collide_neighbors(const Search& search, const BodySet& neighbors, BodyCache& cache, const Disc* disc,
                       std::int32_t first_index) {
    std::array<Vec2, k_max_pieces> center;
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
            if (!do_meet(one, other))
                continue;
            const bool first = other.kind != BodyKind::movable || one.id < other.id;
            Actor a = actor(neighbors, cache, first ? i : k, first_index, false);
            become_first(search.memory, center, a);
            collide_bodies(search, a, actor(neighbors, cache, first ? k : i, first_index, false));
        }
    }
}

/// How far the ends of a patch may close in a step: what they do now, and what a hit of one gives the other.
double closing_reach(const BodySet& tool, const BodySet& neighbors, const Patch& patch,
                     const DetectionSettings& settings) {
    if (patch.point_count < 2 || std::abs(patch.point[0].gap - patch.point[1].gap) < settings.tilt)
        return 0.0; // both have a share
    const auto velocity = [&](std::int32_t body, const Vec2& at) -> Vec2 {
        const std::int32_t neighbor = body - tool.body_count;
        const Body& b = neighbor < 0 ? tool.body[static_cast<std::size_t>(body)]
                                     : neighbors.body[static_cast<std::size_t>(neighbor)];
        if (b.kind == BodyKind::fixed)
            return Vec2::Zero();
        return velocity_at(b.velocity, at - b.pose.head<2>());
    };
    double closing = 0.0;
    for (const PatchPoint& p : patch.point)
        closing = std::max(closing, patch.normal.dot(velocity(patch.body_b, p.position) -
                                                     velocity(patch.body_a, p.position)));
    return k_hit_gain * settings.step * closing;
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

void detect_patches(const BodySet& tool, BodyCache& tool_cache, const BodySet& neighbors,
                    BodyCache& neighbor_cache, const DetectionSettings& settings, const PatchList& previous,
                    PatchList& patches) {
    tool_cache.update(tool);
    neighbor_cache.update(neighbors);
    Memory memory;
    recall(tool, tool_cache, neighbors, neighbor_cache, previous, memory);
    DraftList drafts;
    const Search search{settings, memory, drafts};

    // find and merge
    std::array<Disc, k_max_bodies> disc; // written for the bodies there are
    for (std::int32_t k = 0; k < neighbors.body_count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        disc[index] = disc_of(search, neighbors.body[index], neighbor_cache.bounds.radius[index], false);
    }
    std::array<Vec2, k_max_pieces> center;
    for (std::int32_t i = 0; i < tool.body_count; ++i) {
        const auto index = static_cast<std::size_t>(i);
        const Disc own = disc_of(search, tool.body[index], tool_cache.bounds.radius[index], true);
        Actor a;
        for (std::int32_t k = 0; k < neighbors.body_count; ++k) {
            if ((tool.body[index].mask & neighbors.body[static_cast<std::size_t>(k)].layer) == 0 ||
                own.apart(disc[static_cast<std::size_t>(k)]))
                continue;
            if (a.body == nullptr) {
                a = actor(tool, tool_cache, i, 0, true);
                become_first(memory, center, a);
            }
            collide_bodies(search, a, actor(neighbors, neighbor_cache, k, tool.body_count, false));
        }
    }
    collide_neighbors(search, neighbors, neighbor_cache, disc.data(), tool.body_count);

    // remember and order
    sort(drafts);
    if (carry_over(memory, drafts))
        sort(drafts);

    patches.overflow = previous.overflow + static_cast<std::uint64_t>(drafts.dropped);
    patches.count = drafts.count;
    for (std::int32_t i = 0; i < drafts.count; ++i) {
        Patch& patch = patches.patch[static_cast<std::size_t>(i)];
        patch = drafts[i].patch;
        share_out(patch, settings.tilt, closing_reach(tool, neighbors, patch, settings));
    }
}

void detect_patches(const BodySet& tool, const BodySet& neighbors, const DetectionSettings& settings,
                    const PatchList& previous, PatchList& patches) {
    BodyCache tool_cache;
    BodyCache neighbor_cache;
    detect_patches(tool, tool_cache, neighbors, neighbor_cache, settings, previous, patches);
}

} // namespace haptics
