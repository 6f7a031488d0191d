// From the Dictionary of a body to its convex pieces.

#include <haptics/classes/body_registry.hpp>
#include <haptics/classes/world_settings.hpp>
#include <haptics/core/geometry/decompose.hpp>
#include <haptics/core/geometry/outline.hpp>
#include <haptics/core/geometry/seams.hpp>
#include <haptics/core/geometry/shapes.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace haptics {

using namespace godot;

namespace {

struct ShapeContext {
    Vec2 center;
    double rounding;
    Problems& problems;
    std::vector<Piece>& pieces;
    /// Area of all shapes and its second moment about the center of mass, m^2, m^4.
    double area{0.0};
    double second_moment{0.0};
    /// Length of all segments and its second moment about the center of mass, m, m^3: what has no area has
    /// its mass along them.
    double length{0.0};
    double length_moment{0.0};

    /// Inertia per mass, m^2; 0 where there is nothing to compute it from.
    [[nodiscard]] double spread() const {
        if (area > 0.0)
            return second_moment / area;
        return length > 0.0 ? length_moment / length : 0.0;
    }
    void book(double shape_area, const Vec2& centroid, double moment) {
        area += shape_area;
        second_moment += moment + shape_area * centroid.squaredNorm();
    }
};

// a thin rod from a to b: L (a a + a b + b b) / 3 about the origin
void book_segment(ShapeContext& c, const Vec2& from, const Vec2& to) {
    const double length = (to - from).norm();
    c.length += length;
    c.length_moment += length * (from.squaredNorm() + from.dot(to) + to.squaredNorm()) / 3.0;
}

// disc: pi r^4 / 2 about its middle
void book_disc(ShapeContext& c, const Vec2& middle, double r) {
    const double area = std::numbers::pi * r * r;
    c.book(area, middle, 0.5 * area * r * r);
}

// capsule: the box between the ends and the two half discs as one disc at either end, by halves
void book_capsule(ShapeContext& c, const Vec2& from, const Vec2& to, double r) {
    const double length = (to - from).norm();
    const double box = 2.0 * r * length;
    c.book(box, 0.5 * (from + to), box * (length * length + 4.0 * r * r) / 12.0);
    // two half discs, their centroids 4 r / (3 pi) beyond the ends
    const double half = 0.5 * std::numbers::pi * r * r;
    const double beyond = 4.0 * r / (3.0 * std::numbers::pi);
    const Vec2 axis = length > 0.0 ? Vec2((to - from) / length) : Vec2(1.0, 0.0);
    const double moment = half * (0.5 * r * r - beyond * beyond);
    c.book(half, from - beyond * axis, moment);
    c.book(half, to + beyond * axis, moment);
}

const char* name_of(OutlineError error) {
    switch (error) {
    case OutlineError::none:
        return "fine";
    case OutlineError::empty:
        return "empty";
    case OutlineError::not_finite:
        return "not finite";
    case OutlineError::too_few_points:
        return "without three different corners";
    case OutlineError::zero_area:
        return "without area";
    case OutlineError::self_crossing:
        return "crossing itself";
    }
    return "unusable";
}

void add(ShapeContext& c, std::uint32_t id, const Convex& convex, DictionaryReader& r) {
    Piece p;
    p.id = id;
    p.convex = convex;
    p.one_way = r.flag("one_way", false);
    p.one_way_normal = r.vec2("one_way_normal", Vec2(0.0, 1.0)).normalized();
    c.pieces.push_back(p);
}

// nothing when a point is no number, which has then been said
std::optional<std::vector<Vec2>> read_points(DictionaryReader& r, const Vec2& center, Problems& problems) {
    const std::vector<double> flat = r.numbers("points");
    std::vector<Vec2> points;
    if (flat.size() % 2 != 0)
        problems.add(r.place() + "points has " + std::to_string(flat.size()) +
                     " numbers; it must hold pairs of x, y.");
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2)
        points.emplace_back(Vec2(flat[i], flat[i + 1]) - center);
    for (const Vec2& p : points)
        if (!p.allFinite()) {
            problems.add(r.place() +
                         "points holds a number that is not finite. Give every corner a real position.");
            return std::nullopt;
        }
    return points;
}

bool expect(std::size_t found, std::size_t wanted, const std::string& kind, const std::string& place,
            Problems& problems) {
    if (found == wanted)
        return true;
    problems.add(place + "points of a " + kind + " has " + std::to_string(found) + " points, must have " +
                 std::to_string(wanted) + ".");
    return false;
}

bool good_radius(double radius, const std::string& place, Problems& problems) {
    if (std::isfinite(radius) && radius > 0.0 && radius <= 1e3)
        return true;
    problems.add(place + "radius is " + std::to_string(radius) + " m, must lie between 0 and 1000 m.");
    return false;
}

void read_polygon(const std::vector<Vec2>& points, std::uint32_t id, ShapeContext& c, DictionaryReader& r) {
    const Decomposition cut = decompose(points, c.rounding);
    if (cut.error != OutlineError::none) {
        const std::string at = cut.where >= 0 ? " at corner " + std::to_string(cut.where) : "";
        c.problems.add(r.place() + "points: the outline is " + name_of(cut.error) + at + ". " +
                       remedy(cut.error));
        return;
    }
    const AreaProperties area = area_properties(points);
    c.book(area.area, area.centroid, area.second_moment);
    // pieces of one outline have ids of their own that depend on nothing but their order
    for (std::size_t i = 0; i < cut.pieces.size(); ++i)
        add(c, id + static_cast<std::uint32_t>(i << 20U), cut.pieces[i], r);
}

void read_shape(const Dictionary& from, const std::string& place, ShapeContext& c) {
    DictionaryReader r(from, place, c.problems);
    const std::string kind = r.text("kind", "");
    const auto id = static_cast<std::uint32_t>(r.number("id", 1.0));
    const double radius = r.number("radius", 0.0);
    const auto read = read_points(r, kind == "half_plane" ? Vec2(Vec2::Zero()) : c.center, c.problems);
    if (!read)
        return;
    const std::vector<Vec2>& points = *read;
    if (kind == "polygon") {
        read_polygon(points, id, c, r);
    } else if (kind == "circle") {
        if (expect(points.size(), 1, kind, place, c.problems) && good_radius(radius, place, c.problems)) {
            add(c, id, make_disc(points[0], radius), r);
            book_disc(c, points[0], radius);
        }
    } else if (kind == "capsule") {
        if (expect(points.size(), 2, kind, place, c.problems) && good_radius(radius, place, c.problems)) {
            add(c, id, make_capsule(points[0], points[1], radius), r);
            book_capsule(c, points[0], points[1], radius);
        }
    } else if (kind == "segment") {
        if (expect(points.size(), 2, kind, place, c.problems)) {
            add(c, id, make_segment(points[0], points[1]), r);
            book_segment(c, points[0], points[1]);
        }
    } else if (kind == "half_plane") {
        if (expect(points.size(), 2, kind, place, c.problems) && points[1].norm() > 1e-9)
            add(c, id, make_half_plane(points[0] - c.center, points[1].normalized()), r);
        else
            c.problems.add(place + "points of a half_plane must hold a point and a normal that is not zero.");
    } else {
        c.problems.add(place + "kind is \"" + kind +
                       "\", must be one of: polygon, circle, capsule, segment, half_plane.");
    }
    r.finish();
}

// bits of layers, all without the key
std::uint32_t read_bits(DictionaryReader& r, const char* key) {
    constexpr double k_all = std::numeric_limits<std::uint32_t>::max();
    const double bits = r.number(key, k_all);
    return bits >= 0.0 && bits <= k_all ? static_cast<std::uint32_t>(bits) : 0U;
}

} // namespace

BodySpec read_body(const Dictionary& from, const std::string& place, const Surface& fallback,
                   Problems& problems) {
    BodySpec spec;
    DictionaryReader r(from, place, problems);
    spec.body.kind = r.choice("kind", BodyKind::fixed,
                              {{"fixed", BodyKind::fixed},
                               {"kinematic", BodyKind::kinematic},
                               {"movable", BodyKind::movable},
                               {"tool", BodyKind::tool}});
    spec.center = r.vec2("center", Vec2::Zero());
    FigureCheck figures(place);
    // one that is nowhere would make every corner of the shapes wrong
    for (int i = 0; i < 2; ++i)
        if (!figures.range(i == 0 ? "center_of_mass.x" : "center_of_mass.y", spec.center(i), -1e5, 1e5, "m",
                           "Put it on the body."))
            spec.center(i) = 0.0;
    spec.body.surface = read_surface(r.dictionary("surface"), place + "surface.", fallback, problems);
    spec.body.layer = read_bits(r, "layer");
    spec.body.mask = read_bits(r, "mask");
    spec.body.scene_friction = r.number("scene_friction", spec.body.scene_friction);
    double rounding = r.number("rounding", 0.0);
    if (!figures.range("rounding", rounding, 0.0, 10.0, "m", "0 leaves the corners sharp."))
        rounding = 0.0;
    problems.add(figures.take());
    ShapeContext c{spec.center, rounding, problems, spec.pieces, 0.0, 0.0};
    const Array shapes = r.array("shapes");
    for (int64_t i = 0; i < shapes.size(); ++i) {
        if (shapes[i].get_type() != Variant::DICTIONARY) {
            problems.add(place + "shapes holds something that is not a Dictionary at place " +
                         std::to_string(i) + ".");
            continue;
        }
        read_shape(shapes[i].to<Dictionary>(), place + "shapes[" + std::to_string(i) + "].", c);
    }
    if (spec.pieces.empty() && problems.none())
        problems.add(place + "shapes is empty. Give the body a collision shape.");
    spec.body.mass = r.number("mass", 0.0);
    const double density = r.number("density", 0.0);
    if (density != 0.0)
        spec.body.mass = density * c.area;
    spec.body.inertia = r.number("inertia", 0.0);
    const bool has_mass = spec.body.kind == BodyKind::movable || spec.body.kind == BodyKind::tool;
    if (has_mass) {
        FigureCheck check(place);
        const bool has_shape = problems.none();
        const bool dense =
            check.range("density", density, 0.0, 1e9, "kg/m^2", "0 leaves the mass as it is given.");
        const bool heavy = dense && check.range("mass", spec.body.mass, 1e-6, 1e4, "kg",
                                                density > 0.0 ? "It is density times the area of the shapes."
                                                              : "Give it a mass; 0.1 kg suits what a desktop "
                                                                "device moves.");
        const bool computed = spec.body.inertia == 0.0;
        if (computed)
            spec.body.inertia = spec.body.mass * c.spread();
        // an inertia that follows from a wrong mass or shape is no second mistake
        if (!computed || (heavy && has_shape))
            check.range(
                "inertia", spec.body.inertia, 1e-12, 1e4, "kg m^2",
                computed && c.area <= 0.0
                    ? "Its shapes have no area to compute it from: give it one that encloses something, "
                      "or an inertia."
                    : "Leave it at 0 to have it computed from the shapes.");
        problems.add(check.take());
    }
    r.finish();
    std::vector<SeamPiece> solid;
    for (Piece& p : spec.pieces)
        if (!p.one_way)
            solid.push_back({&p.convex, Pose::Zero(), 0});
    if (solid.size() > 1)
        mark_seams(solid);
    return spec;
}

} // namespace haptics
