/// Cores apart: their distance d is realised either at a face (then it equals the largest distance of one
/// core along a face normal of the other, and the foot lies on that face) or between two vertices. All face
/// normals of both are tried, which gives the face case at once; otherwise the nearest pair of vertices is
/// the answer. Radii only shift the gap, and the direction between two vertices turns continuously: a rounded
/// corner.
///
/// Cores overlapping: the direction can only come from a face. Which one is a matter of history, not of
/// depth: a tool deep in a thin wall is nearer to the far side. So the face of the last step stays as long as
/// the other piece is behind it and in front of its extent. It is handed over only to a less deep face within
/// k_handover of its normal: to the edge of the other piece that faces it or, once the deepest vertex has
/// passed the end of the face, to the next face of the same owner. Without a history the least deep face is
/// taken.

#include "pair_contact.hpp"

#include <algorithm>
#include <limits>

#include "face_contact.hpp"

namespace haptics::contact {
namespace {

using Face = PatchSide::Face;

/// Two separations that differ by less count as equal, m.
constexpr double k_tie = 1e-12;
/// A zone's deepest end is a closest point when it is this near to the distance of the cores, m.
constexpr double k_foot = 1e-9;
/// Vertices nearer than this give no direction, m.
constexpr double k_no_direction = 1e-10;
/// Cosine of the largest turn of the normal in one handover of overlapping cores (75 degrees).
constexpr double k_handover = 0.2588;
/// Cosine between a one-way piece's direction and the normals that it can give (45 degrees).
constexpr double k_one_way = 0.7071;

struct Pair {
    const PlacedConvex& a;
    const PlacedConvex& b;
    const PairQuery& query;

    [[nodiscard]] const PlacedConvex& owner(Face face) const { return face == Face::of_a ? a : b; }
    [[nodiscard]] const PlacedConvex& other(Face face) const { return face == Face::of_a ? b : a; }
    /// Normal of the patch (out of b into a) for a face.
    [[nodiscard]] Vec2 normal(Face face, int edge) const {
        return face == Face::of_a ? Vec2{-a.n(edge)} : b.n(edge);
    }
    [[nodiscard]] bool allowed(const Vec2& n) const {
        return !query.one_way || n.dot(query.one_way_normal) > k_one_way;
    }
    /// The face can be felt, and the other side can show it its deepest vertex.
    [[nodiscard]] bool felt(Face face, const FaceSeparation& s) const {
        const PlacedConvex& o = owner(face);
        return !is_hidden(*o.shape, s.face) && allowed(normal(face, s.face)) &&
               shows_normal(other(face), s.deepest, -o.n(s.face));
    }
};

int vertex_feature(int vertex) {
    return k_max_vertices + vertex;
}

/// Fills in a contact along a face.
bool fill_face(const Pair& pair, Face face, const FaceSeparation& s, const FacePoints& points,
               PairContact& contact) {
    const bool of_a = face == Face::of_a;
    const PlacedConvex& other = pair.other(face);
    contact.face = face;
    contact.edge = s.face;
    contact.normal = pair.normal(face, s.face);
    contact.count = points.count;
    for (int i = 0; i < points.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        PatchPoint& point = contact.point[k];
        point.gap = points.gap[k];
        const double back = of_a ? pair.b.radius : -(pair.a.radius + points.gap[k]);
        point.position = points.core[k] + back * contact.normal;
    }
    const int other_feature = points.edge >= 0 ? points.edge : vertex_feature(s.deepest);
    contact.feature_a = of_a ? s.face : other_feature;
    contact.feature_b = of_a ? other_feature : s.face;
    // plane of b's matter
    if (!of_a) {
        contact.plane_normal = contact.normal;
        contact.plane_offset = contact.normal.dot(pair.b.v(s.face)) + pair.b.radius;
    } else if (points.edge >= 0 && other.n(points.edge).dot(contact.normal) > k_one_way) {
        contact.plane_normal = other.n(points.edge);
        contact.plane_offset = contact.plane_normal.dot(other.v(points.edge)) + other.radius;
    } else {
        contact.plane_normal = contact.normal;
        contact.plane_offset = contact.normal.dot(contact.point[0].position);
    }
    return true;
}

void nearest_vertices(const PlacedConvex& a, const PlacedConvex& b, int& best_a, int& best_b) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < a.count; ++i) {
        for (int k = 0; k < b.count; ++k) {
            const double squared = (a.v(i) - b.v(k)).squaredNorm();
            if (squared < smallest) {
                smallest = squared;
                best_a = i;
                best_b = k;
            }
        }
    }
}

/// Two vertices: rounded corner against rounded corner.
bool vertex_contact(const Pair& pair, PairContact& contact) {
    int best_a = 0;
    int best_b = 0;
    nearest_vertices(pair.a, pair.b, best_a, best_b);
    Vec2 n = pair.a.v(best_a) - pair.b.v(best_b);
    double distance = n.norm();
    // a disc that was pushed past the center of another keeps its side
    const bool discs = pair.a.count == 1 && pair.b.count == 1;
    if (discs && pair.query.hint.known &&
        (distance < k_no_direction || n.dot(pair.query.hint.normal) < 0.0)) {
        distance = n.dot(pair.query.hint.normal);
        n = pair.query.hint.normal;
    } else if (distance < k_no_direction) {
        if (!discs)
            return false;
        n = Vec2{0.0, 1.0};
    } else {
        n /= distance;
    }
    if (!pair.allowed(n) || !shows_normal(pair.b, best_b, n) || !shows_normal(pair.a, best_a, -n))
        return false;
    contact.face = Face::none;
    contact.edge = 0;
    contact.normal = n;
    contact.count = 1;
    contact.point[0].gap = distance - pair.a.radius - pair.b.radius;
    contact.point[0].position = pair.b.v(best_b) + pair.b.radius * n;
    contact.feature_a = vertex_feature(best_a);
    contact.feature_b = vertex_feature(best_b);
    contact.plane_normal = n;
    contact.plane_offset = n.dot(contact.point[0].position);
    return true;
}

/// The face of a closest pair of points, when the closest points lie on one.
bool closest_face(const Pair& pair, Face face, const FaceSeparation& s, FacePoints& points) {
    if (!face_points(pair.owner(face), s, pair.other(face), points))
        return false;
    const double radii = pair.a.radius + pair.b.radius;
    double lowest = points.gap[0];
    if (points.count > 1)
        lowest = std::min(lowest, points.gap[1]);
    return lowest + radii <= s.separation + k_foot;
}

/// The least deep felt face; `cone`, when given, is a direction that the normal must be near to.
bool least_deep(const Pair& pair, const Vec2* cone, Face& face, FaceSeparation& best, FacePoints& points) {
    bool found = false;
    for (const Face side : {Face::of_b, Face::of_a}) {
        const PlacedConvex& owner = pair.owner(side);
        for (int edge = 0; edge < owner.faces(); ++edge) {
            if (cone != nullptr && pair.normal(side, edge).dot(*cone) < k_handover)
                continue;
            const FaceSeparation s = face_separation(owner, edge, pair.other(side));
            FacePoints candidate;
            if ((found && s.separation <= best.separation + k_tie) || !pair.felt(side, s) ||
                !face_points(owner, s, pair.other(side), candidate))
                continue;
            found = true;
            face = side;
            best = s;
            points = candidate;
        }
    }
    return found;
}

/// The face of the last step, or the one it is handed over to. False when the other piece is no longer behind
/// it.
bool kept_face(const Pair& pair, Face& face, FaceSeparation& best, FacePoints& points) {
    const SideHint& hint = pair.query.hint;
    const PlacedConvex& owner = pair.owner(hint.face);
    const PlacedConvex& other = pair.other(hint.face);
    best = face_separation(owner, hint.edge, other);
    face = hint.face;
    if (best.separation >= 0.0 || !face_points(owner, best, other, points))
        return false;
    const Vec2 n = pair.normal(face, best.face);
    // which end of its face has the deepest vertex passed?
    const Vec2 along = perpendicular(owner.n(best.face));
    const Vec2& origin = owner.v(best.face);
    const double u = owner.half_plane ? 0.0 : along.dot(other.v(best.deepest) - origin);
    const double length = owner.half_plane ? 0.0 : along.dot(owner.v(owner.next(best.face)) - origin);
    const auto k = static_cast<std::size_t>(best.face);
    const bool past_start = u < -owner.shape->face_before[k];
    const bool past_end = u > length + owner.shape->face_after[k];
    const int own_face = best.face;
    const int facing = points.edge;
    for (const Face side : {Face::of_b, Face::of_a}) {
        const PlacedConvex& candidate_owner = pair.owner(side);
        for (int edge = 0; edge < candidate_owner.faces(); ++edge) {
            const bool reached = side == hint.face ? (past_start && edge == owner.before(own_face)) ||
                                                         (past_end && edge == owner.next(own_face))
                                                   : edge == facing;
            if (!reached || pair.normal(side, edge).dot(n) < k_handover)
                continue;
            const FaceSeparation s = face_separation(candidate_owner, edge, pair.other(side));
            FacePoints candidate;
            if (s.separation <= best.separation + k_tie || !pair.felt(side, s) ||
                !face_points(candidate_owner, s, pair.other(side), candidate))
                continue;
            face = side;
            best = s;
            points = candidate;
        }
    }
    return true;
}

/// Cores apart.
bool collide_apart(const Pair& pair, const FaceSeparation& on_b, const FaceSeparation& on_a,
                   PairContact& contact) {
    FacePoints points;
    const bool b_first = on_b.separation >= on_a.separation - k_tie;
    bool on_face = false;
    for (const bool first : {true, false}) {
        const Face face = first == b_first ? Face::of_b : Face::of_a;
        const FaceSeparation& s = face == Face::of_b ? on_b : on_a;
        if (s.face < 0 || !closest_face(pair, face, s, points))
            continue;
        on_face = true;
        if (pair.felt(face, s)) {
            contact.rank = Rank::felt;
            return fill_face(pair, face, s, points, contact);
        }
    }
    contact.rank = Rank::felt;
    if (!on_face && vertex_contact(pair, contact))
        return true;
    // the nearest features are seams, or give no direction: a flat face that the other piece is in front of
    Face face = Face::of_b;
    FaceSeparation best;
    if (!least_deep(pair, nullptr, face, best, points) || best.separation < 0.0 ||
        !closest_face(pair, face, best, points))
        return false;
    contact.rank = Rank::followed;
    return fill_face(pair, face, best, points, contact);
}

/// Cores overlapping.
bool collide_overlapping(const Pair& pair, const FaceSeparation& on_b, const FaceSeparation& on_a,
                         PairContact& contact) {
    const SideHint& hint = pair.query.hint;
    Face face = Face::of_b;
    FaceSeparation best;
    FacePoints points;
    const bool in_cone = hint.known && least_deep(pair, &hint.normal, face, best, points);
    if (!in_cone && !least_deep(pair, nullptr, face, best, points))
        return false;
    // entered through a seam?
    const double shallowest = std::max(on_b.separation, on_a.separation);
    contact.rank = in_cone || best.separation >= shallowest - k_tie ? Rank::felt : Rank::inside;
    return fill_face(pair, face, best, points, contact);
}

} // namespace

double separate(const PlacedConvex& a, const PlacedConvex& b, Vec2& normal) {
    const PairQuery query;
    const Pair pair{a, b, query};
    const double radii = a.radius + b.radius;
    const FaceSeparation on_b = widest_separation(b, a);
    const FaceSeparation on_a = b.half_plane ? FaceSeparation{-1, 0, -std::numeric_limits<double>::infinity()}
                                             : widest_separation(a, b);
    const Face face = on_b.separation >= on_a.separation - k_tie ? Face::of_b : Face::of_a;
    const FaceSeparation& s = face == Face::of_b ? on_b : on_a;
    FacePoints points;
    const bool discs = a.faces() == 0 && b.faces() == 0;
    if (!discs && (s.separation < k_no_direction || closest_face(pair, face, s, points))) {
        normal = pair.normal(face, s.face);
        return s.separation - radii;
    }
    int best_a = 0;
    int best_b = 0;
    nearest_vertices(a, b, best_a, best_b);
    const Vec2 between = a.v(best_a) - b.v(best_b);
    const double distance = between.norm();
    normal = distance > 0.0 ? Vec2{between / distance} : Vec2{0.0, 1.0};
    return distance - radii;
}

bool collide(const PlacedConvex& a, const PlacedConvex& b, const PairQuery& query, PairContact& contact) {
    const Pair pair{a, b, query};
    Face face = Face::of_b;
    FaceSeparation kept;
    FacePoints points;
    bool found = false;
    if (query.hint.face != Face::none && kept_face(pair, face, kept, points)) {
        contact.rank = Rank::felt;
        found = fill_face(pair, face, kept, points, contact);
    } else {
        const FaceSeparation on_b = widest_separation(b, a);
        const FaceSeparation on_a = b.half_plane
                                        ? FaceSeparation{-1, 0, -std::numeric_limits<double>::infinity()}
                                        : widest_separation(a, b);
        const double widest = std::max(on_b.separation, on_a.separation);
        if (widest - a.radius - b.radius > query.limit)
            return false;
        const bool discs = a.faces() == 0 && b.faces() == 0;
        found = widest > 0.0 || discs ? collide_apart(pair, on_b, on_a, contact)
                                      : collide_overlapping(pair, on_b, on_a, contact);
    }
    if (!found)
        return false;
    double lowest = contact.point[0].gap;
    if (contact.count > 1)
        lowest = std::min(lowest, contact.point[1].gap);
    return lowest <= query.limit;
}

} // namespace haptics::contact
