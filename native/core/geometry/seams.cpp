/// The pieces are cut to the union of their drawn outlines.
/// Edges: an edge is moved outward by two tolerances and cut with every other piece, grown by one tolerance.
/// What is inside is covered; an edge with nothing left is hidden. Coplanar neighbors do not cover each
/// other's faces that way. Corners: every piece that holds the corner point adds the sector of directions
/// that it fills there. The connected sector around the piece's own, of angle s, tells what the corner is in
/// the union: s >= pi is a flat place or a concave corner (ghost); s < pi a convex corner, felt in the
/// normals of the union only, from (end + pi/2) to (start - pi/2). Faces: exposed edges on one line, with
/// equal group, that touch or overlap are one flat face.

#include <haptics/core/geometry/seams.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <algorithm>
#include <numbers>
#include <vector>

namespace haptics {
namespace {

constexpr double k_pi = std::numbers::pi;
/// Sectors that leave a smaller gap touch, and corners blunter than pi by less are flat, rad.
constexpr double k_angle = 1e-3;

/// A piece in scene axes, as drawn.
struct Drawn {
    int count{0};
    bool half_plane{false};
    bool solid{false};  ///< can cover others: polygons and half-planes
    double offset{0.0}; ///< of the faces from the corners: the radius of a capsule
    std::array<Vec2, k_max_vertices> corner;
    std::array<Vec2, k_max_vertices> normal;
    Vec2 low;
    Vec2 high;

    [[nodiscard]] const Vec2& c(int i) const { return corner[static_cast<std::size_t>(i % count)]; }
    [[nodiscard]] const Vec2& n(int i) const { return normal[static_cast<std::size_t>(i)]; }
    [[nodiscard]] int faces() const { return half_plane ? 1 : (count > 1 ? count : 0); }
    [[nodiscard]] bool near(const Drawn& other, double slack) const {
        return half_plane || other.half_plane ||
               ((low - other.high).maxCoeff() <= slack && (other.low - high).maxCoeff() <= slack);
    }
};

Drawn draw(const SeamPiece& piece) {
    Drawn drawn;
    const Convex& convex = *piece.convex;
    drawn.half_plane = convex.half_plane;
    drawn.count = convex.half_plane ? 1 : convex.count;
    drawn.solid = convex.half_plane || convex.count >= 3;
    drawn.offset = drawn.solid ? 0.0 : convex.radius;
    drawn_corners(convex, drawn.corner);
    const Transform at(piece.pose);
    for (int i = 0; i < drawn.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        drawn.corner[k] = at.apply(drawn.corner[k]);
        drawn.normal[k] = at.turn(convex.normal[k]);
        drawn.low = i == 0 ? drawn.corner[k] : Vec2{drawn.low.cwiseMin(drawn.corner[k])};
        drawn.high = i == 0 ? drawn.corner[k] : Vec2{drawn.high.cwiseMax(drawn.corner[k])};
    }
    drawn.low.array() -= drawn.offset;
    drawn.high.array() += drawn.offset;
    return drawn;
}

struct Interval {
    double from;
    double to;
};

/// Part of the segment that is inside a solid grown by `slack`, as lengths from its start.
bool covered_part(const Vec2& from, const Vec2& along, double length, const Drawn& solid, double slack,
                  Interval& part) {
    part = {0.0, length};
    for (int i = 0; i < solid.faces(); ++i) {
        const double height = solid.n(i).dot(from - solid.c(i)) - slack;
        const double slope = solid.n(i).dot(along);
        if (std::abs(slope) * length < 1e-3 * slack) {
            if (height > 0.0)
                return false;
        } else if (slope > 0.0) {
            part.to = std::min(part.to, -height / slope);
        } else {
            part.from = std::max(part.from, -height / slope);
        }
    }
    return part.to > part.from;
}

/// First and last exposed length of an edge; false when none is.
bool exposed_part(std::vector<Interval>& covered, double length, double slack, Interval& exposed) {
    std::sort(covered.begin(), covered.end(),
              [](const Interval& p, const Interval& q) { return p.from < q.from; });
    bool any = false;
    double reached = 0.0;
    covered.push_back({length, length});
    for (const Interval& part : covered) {
        if (part.from > reached + slack) {
            if (!any)
                exposed.from = reached;
            exposed.to = part.from;
            any = true;
        }
        reached = std::max(reached, part.to);
    }
    return any;
}

/// Sector of directions, counter-clockwise from `from` over `span` (rad).
struct Sector {
    double from;
    double span;
};

double angle_of(const Vec2& v) {
    return std::atan2(v.y(), v.x());
}

/// Angle from a to b, counter-clockwise, 0 to 2 pi.
double turn_to(double a, double b) {
    const double turn = std::fmod(b - a, 2.0 * k_pi);
    return turn < 0.0 ? turn + 2.0 * k_pi : turn;
}

Sector corner_sector(const Vec2& normal_before, const Vec2& normal_after) {
    const double from = angle_of(normal_after) + 0.5 * k_pi;
    return {from, turn_to(from, angle_of(normal_before) + 1.5 * k_pi)};
}

/// Sector that a solid fills around a point; false when it does not hold the point.
bool sector_at(const Vec2& point, const Drawn& solid, double slack, Sector& sector) {
    int first = -1;
    int second = -1;
    for (int i = 0; i < solid.faces(); ++i) {
        const double height = solid.n(i).dot(point - solid.c(i));
        if (height > slack)
            return false;
        if (height < -slack)
            continue;
        if (first < 0)
            first = i;
        else
            second = i;
    }
    if (first < 0)
        sector = {0.0, 2.0 * k_pi};
    else if (second < 0)
        sector = {angle_of(solid.n(first)) + 0.5 * k_pi, k_pi};
    else if (second == first + 1)
        sector = corner_sector(solid.n(first), solid.n(second));
    else
        sector = corner_sector(solid.n(second), solid.n(first));
    return true;
}

/// Grows `own` by the sectors that touch it.
void unite(Sector& own, std::vector<Sector>& others) {
    bool grown = true;
    while (grown && own.span < 2.0 * k_pi) {
        grown = false;
        for (Sector& other : others) {
            if (other.span <= 0.0)
                continue;
            const double start = turn_to(own.from, other.from);
            const double back = turn_to(other.from, own.from);
            if (start <= own.span + k_angle) { // begins inside
                own.span = std::max(own.span, start + other.span);
            } else if (back <= other.span + k_angle) { // begins before, reaches in
                const double end = own.span + back;
                own = {other.from, std::max(end, other.span)};
            } else {
                continue;
            }
            other.span = 0.0;
            grown = true;
        }
    }
}

std::uint16_t bit(int i) {
    return static_cast<std::uint16_t>(1U << i);
}

class SeamMarker {
  public:
    SeamMarker(std::span<SeamPiece> solid, double tolerance)
        : solid_(solid)
        , tolerance_(tolerance)
        , exposed_(solid.size()) {
        for (const SeamPiece& piece : solid)
            drawn_.push_back(draw(piece));
    }

    void mark() {
        for (std::size_t i = 0; i < solid_.size(); ++i)
            mark_edges(i);
        for (std::size_t i = 0; i < solid_.size(); ++i)
            mark_corners(i);
        for (std::size_t i = 0; i < solid_.size(); ++i)
            move_hidden_edges(i);
        for (std::size_t i = 0; i < solid_.size(); ++i)
            mark_faces(i);
    }

  private:
    [[nodiscard]] double length(std::size_t i, int edge) const {
        return (drawn_[i].c(edge + 1) - drawn_[i].c(edge)).norm();
    }

    void mark_edges(std::size_t i) {
        const Drawn& own = drawn_[i];
        Convex& convex = *solid_[i].convex;
        for (int edge = 0; edge < own.faces() && !own.half_plane; ++edge) {
            const double full = length(i, edge);
            const Vec2 along = perpendicular(own.n(edge));
            const Vec2 from = own.c(edge) + (own.offset + 2.0 * tolerance_) * own.n(edge);
            std::vector<Interval> covered;
            for (std::size_t k = 0; k < solid_.size(); ++k) {
                Interval part;
                if (k != i && drawn_[k].solid && own.near(drawn_[k], 4.0 * tolerance_) &&
                    covered_part(from, along, full, drawn_[k], tolerance_, part))
                    covered.push_back(part);
            }
            Interval& exposed = exposed_[i][static_cast<std::size_t>(edge)];
            exposed = {0.0, full};
            if (is_hidden(convex, edge) || !exposed_part(covered, full, 4.0 * tolerance_, exposed))
                newly_hidden(convex, edge);
        }
    }

    static void newly_hidden(Convex& convex, int edge) {
        convex.ghost_vertices = 0; // rebuilt below
        convex.hidden_edges = static_cast<std::uint16_t>(convex.hidden_edges | bit(edge));
    }

    void mark_corners(std::size_t i) {
        const Drawn& own = drawn_[i];
        Convex& convex = *solid_[i].convex;
        convex.ghost_vertices = 0;
        convex.blunt_vertices = 0;
        for (int corner = 0; corner < own.count && !own.half_plane; ++corner) {
            const bool round = !own.solid;
            const Vec2& before = own.n(corner == 0 ? own.count - 1 : corner - 1);
            Sector sector = round ? Sector{0.0, 0.0} : corner_sector(before, own.n(corner));
            const double own_span = sector.span;
            std::vector<Sector> others;
            bool held = false;
            for (std::size_t k = 0; k < solid_.size(); ++k) {
                Sector other;
                if (k == i || !drawn_[k].solid || !own.near(drawn_[k], 4.0 * tolerance_) ||
                    !sector_at(own.c(corner), drawn_[k], tolerance_, other))
                    continue;
                held = true;
                others.push_back(other);
            }
            const auto k = static_cast<std::size_t>(corner);
            if (round) {
                if (held && own.count == 2 && own.offset <= tolerance_)
                    convex.ghost_vertices = static_cast<std::uint16_t>(convex.ghost_vertices | bit(corner));
                continue;
            }
            unite(sector, others);
            if (sector.span >= k_pi - k_angle) {
                convex.ghost_vertices = static_cast<std::uint16_t>(convex.ghost_vertices | bit(corner));
            } else if (sector.span > own_span + 1e-6) {
                convex.blunt_vertices = static_cast<std::uint16_t>(convex.blunt_vertices | bit(corner));
                const double turn = solid_[i].pose.z();
                const double from = sector.from + sector.span + 0.5 * k_pi - turn;
                const double to = sector.from - 0.5 * k_pi - turn;
                convex.cone_from[k] = Vec2{std::cos(from), std::sin(from)}.cast<float>();
                convex.cone_to[k] = Vec2{std::cos(to), std::sin(to)}.cast<float>();
            }
        }
    }

    /// Takes the core from the drawn corners again, now that more edges are known to be hidden.
    void move_hidden_edges(std::size_t i) {
        Convex& convex = *solid_[i].convex;
        if (convex.half_plane || convex.count < 3 || convex.radius <= 0.0 || convex.hidden_edges == 0)
            return;
        const Transform at(solid_[i].pose);
        for (int k = 0; k < convex.count; ++k)
            convex.vertex[static_cast<std::size_t>(k)] = at.apply_inverse(drawn_[i].c(k));
        shrink_core(convex);
    }

    /// Extent of the core's edge that can be touched, along `along` from `origin`.
    [[nodiscard]] Interval face_extent(std::size_t i, int edge, const Vec2& origin, const Vec2& along) const {
        const Convex& convex = *solid_[i].convex;
        const Transform at(solid_[i].pose);
        const int next = (edge + 1) % convex.count;
        const double drawn_from = along.dot(drawn_[i].c(edge) - origin);
        const double drawn_to = along.dot(drawn_[i].c(edge + 1) - origin);
        const Interval& exposed = exposed_[i][static_cast<std::size_t>(edge)];
        const double core_from = along.dot(at.apply(convex.vertex[static_cast<std::size_t>(edge)]) - origin);
        const double core_to = along.dot(at.apply(convex.vertex[static_cast<std::size_t>(next)]) - origin);
        const double slack = 4.0 * tolerance_;
        Interval extent{is_ghost(convex, edge) ? drawn_from : core_from,
                        is_ghost(convex, next) ? drawn_to : core_to};
        if (exposed.from > slack)
            extent.from = std::max(extent.from, drawn_from + exposed.from);
        if (exposed.to < length(i, edge) - slack)
            extent.to = std::min(extent.to, drawn_from + exposed.to);
        return extent;
    }

    void mark_faces(std::size_t i) {
        const Drawn& own = drawn_[i];
        Convex& convex = *solid_[i].convex;
        for (int edge = 0; edge < own.faces() && !own.half_plane; ++edge) {
            const auto e = static_cast<std::size_t>(edge);
            convex.face_before[e] = 0.0;
            convex.face_after[e] = 0.0;
            if (is_hidden(convex, edge))
                continue;
            const Transform at(solid_[i].pose);
            const Vec2 origin = at.apply(convex.vertex[e]);
            const Vec2 along = perpendicular(own.n(edge));
            const double core_length = along.dot(
                at.apply(convex.vertex[static_cast<std::size_t>((edge + 1) % convex.count)]) - origin);
            Interval face = face_extent(i, edge, origin, along);
            std::vector<Interval> parts;
            for (std::size_t k = 0; k < solid_.size(); ++k) {
                if (k != i && solid_[k].face_group == solid_[i].face_group && !drawn_[k].half_plane)
                    collect(i, edge, k, origin, along, parts);
            }
            bool grown = true;
            while (grown) {
                grown = false;
                for (Interval& part : parts) {
                    if (part.from > face.to + 4.0 * tolerance_ || part.to < face.from - 4.0 * tolerance_)
                        continue;
                    if (part.from >= face.from && part.to <= face.to)
                        continue;
                    face = {std::min(face.from, part.from), std::max(face.to, part.to)};
                    grown = true;
                }
            }
            convex.face_before[e] = -face.from;
            convex.face_after[e] = face.to - core_length;
            // a segment that goes on straight has no corner there
            if (!own.solid && own.count == 2) {
                const double slack = own.offset + 4.0 * tolerance_;
                if (convex.face_before[e] > slack)
                    convex.ghost_vertices = static_cast<std::uint16_t>(convex.ghost_vertices | bit(edge));
                if (convex.face_after[e] > slack)
                    convex.ghost_vertices =
                        static_cast<std::uint16_t>(convex.ghost_vertices | bit((edge + 1) % 2));
            }
        }
    }

    /// Faces of piece k on the line of a face of piece i.
    void collect(std::size_t i, int edge, std::size_t k, const Vec2& origin, const Vec2& along,
                 std::vector<Interval>& parts) const {
        const Drawn& own = drawn_[i];
        const Drawn& other = drawn_[k];
        const Vec2& n = own.n(edge);
        const double level = n.dot(own.c(edge)) + own.offset;
        for (int m = 0; m < other.faces(); ++m) {
            if (is_hidden(*solid_[k].convex, m) || n.dot(other.n(m)) <= 0.0 ||
                std::abs(cross(n, other.n(m))) > k_angle)
                continue;
            const double from = std::abs(n.dot(other.c(m)) + other.offset - level);
            const double to = std::abs(n.dot(other.c(m + 1)) + other.offset - level);
            if (std::min(from, to) <= tolerance_)
                parts.push_back(face_extent(k, m, origin, along));
        }
    }

    std::span<SeamPiece> solid_;
    double tolerance_;
    std::vector<Drawn> drawn_;
    std::vector<std::array<Interval, k_max_vertices>> exposed_;
};

} // namespace

void mark_seams(std::span<SeamPiece> solid, double tolerance) {
    SeamMarker(solid, tolerance).mark();
}

} // namespace haptics
