/// Let a face lie on n . x = c with tangent t, from u = lo to u = hi along t. A convex piece Q shows it its
/// deepest vertex (the smallest n . q) and, from there, the edge that turns away least: between those two
/// ends the lower boundary of Q is straight. Cutting that edge at lo and hi gives the two ends of the zone of
/// contact; the gap is linear in between, so that no point of the zone is deeper than both ends. Both the
/// face and the edge are taken with their whole flat face, whatever the number of pieces that it was cut
/// into, and so the ends do not depend on the cuts.

#include "face_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics::contact {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// Slack of the extent of a face, m: a vertex exactly above an end belongs to the face.
constexpr double k_end_slack = 1e-9;
/// Sine of the angle within which a direction counts as the normal of an edge.
constexpr double k_same_direction = 1e-6;

} // namespace

FaceSeparation face_separation(const PlacedConvex& owner, int face, const PlacedConvex& other) {
    const Vec2& n = owner.n(face);
    int deepest = 0;
    double lowest = n.dot(other.v(0));
    for (int k = 1; k < other.count; ++k) {
        const double height = n.dot(other.v(k));
        if (height < lowest) {
            lowest = height;
            deepest = k;
        }
    }
    return {face, deepest, lowest - n.dot(owner.v(face))};
}

FaceSeparation widest_separation(const PlacedConvex& owner, const PlacedConvex& other) {
    FaceSeparation widest;
    widest.separation = -k_infinity;
    for (int face = 0; face < owner.faces(); ++face) {
        const FaceSeparation candidate = face_separation(owner, face, other);
        if (candidate.separation > widest.separation)
            widest = candidate;
    }
    return widest;
}

bool face_points(const PlacedConvex& owner, const FaceSeparation& face, const PlacedConvex& other,
                 FacePoints& points) {
    const Vec2& n = owner.n(face.face);
    const Vec2& origin = owner.v(face.face);
    const Vec2 t = perpendicular(n);
    double lo = -k_infinity;
    double hi = k_infinity;
    if (!owner.half_plane) {
        const auto k = static_cast<std::size_t>(face.face);
        lo = -owner.shape->face_before[k] - k_end_slack;
        hi = t.dot(owner.v(owner.next(face.face)) - origin) + owner.shape->face_after[k] + k_end_slack;
    }
    const double radii = owner.radius + other.radius;

    // the edge of the other piece that faces ours
    points.edge = -1;
    if (other.faces() > 0) {
        const int e0 = other.before(face.deepest);
        const int e1 = face.deepest;
        const bool first = is_hidden(*other.shape, e1) ||
                           (!is_hidden(*other.shape, e0) && other.n(e0).dot(n) < other.n(e1).dot(n));
        const int edge = first ? e0 : e1;
        if (!is_hidden(*other.shape, edge) && other.n(edge).dot(n) < 0.0)
            points.edge = edge;
    }
    if (points.edge < 0) {
        const Vec2& q = other.v(face.deepest);
        const double u = t.dot(q - origin);
        if (u < lo || u > hi)
            return false;
        points.count = 1;
        points.core[0] = q;
        points.gap[0] = face.separation - radii;
        return true;
    }

    const auto e = static_cast<std::size_t>(points.edge);
    const Vec2 along = perpendicular(other.n(points.edge));
    const Vec2 q0 = other.v(points.edge) - other.shape->face_before[e] * along;
    const Vec2 q1 = other.v(other.next(points.edge)) + other.shape->face_after[e] * along;
    // the edge runs against t
    const double u0 = t.dot(q0 - origin);
    const double u1 = t.dot(q1 - origin);
    if (u1 > hi || u0 < lo)
        return false;
    const double h0 = n.dot(q0 - origin);
    const double h1 = n.dot(q1 - origin);
    const double span = std::max(u0 - u1, 1e-300);
    const double cut0 = u0 > hi ? (u0 - hi) / span : 0.0;
    const double cut1 = u1 < lo ? (u0 - lo) / span : 1.0;
    points.count = 2;
    points.core[0] = cut0 > 0.0 ? Vec2{q0 + cut0 * (q1 - q0)} : q0;
    points.core[1] = cut1 < 1.0 ? Vec2{q0 + cut1 * (q1 - q0)} : q1;
    points.gap[0] = h0 + cut0 * (h1 - h0) - radii;
    points.gap[1] = (cut1 < 1.0 ? h0 + cut1 * (h1 - h0) : h1) - radii;
    return true;
}

bool shows_normal(const PlacedConvex& piece, int i, const Vec2& direction) {
    const Convex& shape = *piece.shape;
    if ((shape.hidden_edges | shape.ghost_vertices | shape.blunt_vertices) == 0)
        return true;
    if (piece.count > 1) {
        for (const int edge : {piece.before(i), i}) {
            const Vec2& n = piece.n(edge);
            if (std::abs(cross(n, direction)) < k_same_direction && n.dot(direction) > 0.0)
                return !is_hidden(shape, edge);
        }
    }
    if (is_ghost(shape, i))
        return false;
    if (((shape.blunt_vertices >> i) & 1U) == 0U)
        return true;
    // body axes of the cone: turn the direction back by the turn of this piece (known from any normal)
    const auto k = static_cast<std::size_t>(i);
    const double c = shape.normal[k].dot(piece.n(i));
    const double s = cross(shape.normal[k], piece.n(i));
    const Vec2 local{c * direction.x() + s * direction.y(), -s * direction.x() + c * direction.y()};
    const Vec2 from = shape.cone_from[k].cast<double>();
    const Vec2 to = shape.cone_to[k].cast<double>();
    return cross(from, local) >= -k_same_direction && cross(local, to) >= -k_same_direction;
}

} // namespace haptics::contact
