// From the Dictionary of a linkage to the tool of the local model. A link's frame is its node: the joint sits
// at the node's origin, and the coordinate is 0 where the scene drew it.

#include <haptics/classes/body_registry.hpp>
#include <haptics/classes/linkage_reader.hpp>
#include <haptics/classes/world_settings.hpp>
#include <haptics/core/local_model/validate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptics {

using namespace godot;

namespace {

JointSpec read_joint(DictionaryReader& r) {
    constexpr double k_free = std::numeric_limits<double>::infinity();
    JointSpec joint;
    joint.kind = r.choice("joint", JointKind::revolute,
                          {{"revolute", JointKind::revolute},
                           {"prismatic", JointKind::prismatic},
                           {"fixed", JointKind::fixed}});
    joint.frame = r.vec3("frame", Vec3::Zero());
    const Vec2 limits = r.vec2("limits", Vec2(-k_free, k_free));
    joint.lower_limit = limits.x();
    joint.upper_limit = limits.y();
    joint.limit_stiffness = r.number("limit_stiffness", joint.limit_stiffness);
    joint.limit_damping = r.number("limit_damping", joint.limit_damping);
    joint.damping = r.number("damping", joint.damping);
    joint.friction = r.number("friction", joint.friction);
    joint.spring_stiffness = r.number("spring_stiffness", joint.spring_stiffness);
    joint.spring_rest = r.number("spring_rest", joint.spring_rest);
    return joint;
}

// 0, and a problem, for what is no number: the loop would start from 0 without a word
double read_finite(DictionaryReader& r, const char* key, Problems& problems) {
    const double given = r.number(key, 0.0);
    if (std::isfinite(given))
        return given;
    problems.add(r.place() + key + " is " + std::to_string(given) + ", which is not a number. Give it one.");
    return 0.0;
}

// the same for three numbers
Vec3 read_finite_vector(DictionaryReader& r, const char* key, Problems& problems) {
    Vec3 given = r.vec3(key, Vec3::Zero());
    if (given.allFinite())
        return given;
    problems.add(r.place() + key + " is (" + std::to_string(given.x()) + ", " + std::to_string(given.y()) +
                 ", " + std::to_string(given.z()) +
                 "), which is not a number. Give the first link a real one.");
    return Vec3::Zero();
}

// appends the shapes of one link, and says when they are too many
void add_shapes(const BodySpec& body, BodySet& shape, Problems& problems) {
    const auto count = static_cast<std::int32_t>(body.pieces.size());
    Body& b = shape.body[static_cast<std::size_t>(shape.body_count)];
    b = body.body;
    b.id = static_cast<std::uint64_t>(shape.body_count++);
    b.kind = BodyKind::tool;
    b.first_piece = shape.piece_count;
    b.piece_count = count;
    if (shape.piece_count + count > k_max_pieces) {
        problems.add("The linkage needs more than " + std::to_string(k_max_pieces) +
                     " convex pieces. Draw its links with fewer corners.");
        b.piece_count = 0;
        return;
    }
    std::copy(body.pieces.begin(), body.pieces.end(), shape.piece.begin() + shape.piece_count);
    shape.piece_count += count;
}

// of each link, and of the base that floats
struct Start {
    Pose base{0.0, 0.0, 0.0};
    Twist base_velocity{0.0, 0.0, 0.0};
    std::vector<double> coordinate;
    std::vector<double> rate;
};

void start_from(const LinkageModel& model, const Start& from, LinkageTool& out) {
    out.start = LinkageVector::Zero(model.freedoms);
    out.rates = LinkageVector::Zero(model.freedoms);
    if (model.floating) {
        const LinkModel& first = model.link[0];
        out.start.head<3>() = node_to_center(from.base, -first.origin);
        // from the center of mass of the body to the one of the link
        const Vec2 arm = rotate(from.base.z(), first.origin + rotate(first.angle, first.center));
        const double turn = from.base_velocity.z();
        out.rates.head<3>() = from.base_velocity - Twist(-turn * arm.y(), turn * arm.x(), 0.0);
    }
    for (int i = 0; i < model.link_count; ++i) {
        const int slot = model.link[i].slot;
        const BodyModel& body = model.body[slot];
        bool moves = slot > 0 && body.joint != BodyJoint::floating;
        // links fixed to another have no coordinate of their own
        for (int before = 0; before < i; ++before)
            moves = moves && model.link[before].slot != slot;
        if (!moves)
            continue;
        out.start(body.freedom) = from.coordinate[static_cast<std::size_t>(i)];
        out.rates(body.freedom) = from.rate[static_cast<std::size_t>(i)];
    }
}

} // namespace

LinkageTool read_linkage_tool(const Dictionary& from, Problems& problems) {
    LinkageTool out;
    out.tool.articulated = true;
    LinkageSpec spec;
    Start start;
    std::vector<Vec2> centers;
    DictionaryReader r(from, "tool.", problems);
    spec.base = r.flag("grounded", true) ? BaseKind::grounded : BaseKind::floating;
    start.base = read_finite_vector(r, "base", problems);
    start.base_velocity = read_finite_vector(r, "base_velocity", problems);
    const Array links = r.array("links");
    if (links.size() > k_max_links) {
        problems.add("The linkage has " + std::to_string(links.size()) + " links, at most " +
                     std::to_string(k_max_links) + " fit. Remove some.");
        return out;
    }
    for (int64_t i = 0; i < links.size(); ++i) {
        const std::string place = "links[" + std::to_string(i) + "].";
        if (links[i].get_type() != Variant::DICTIONARY) {
            problems.add(place + " is not a Dictionary.");
            continue;
        }
        const auto entry = links[i].to<Dictionary>();
        DictionaryReader link(entry, place, problems);
        const BodySpec body = read_body(link.dictionary("body"), place, neutral_surface(), problems);
        LinkSpec l;
        l.parent = static_cast<int>(link.number("parent", static_cast<double>(i) - 1.0));
        l.mass = body.body.mass;
        l.inertia = body.body.inertia;
        l.center = body.center;
        l.joint = read_joint(link);
        start.coordinate.push_back(read_finite(link, "coordinate", problems));
        start.rate.push_back(read_finite(link, "rate", problems));
        link.finish();
        spec.links.push_back(l);
        centers.push_back(body.center);
        add_shapes(body, out.tool.shape, problems);
    }
    const double held = r.number("grip_link", static_cast<double>(links.size()) - 1.0);
    const Vec2 point = r.vec2("grip_point", Vec2::Zero());
    out.tool.grip.pose = r.flag("grip_pose", false);
    r.finish();
    if (!problems.none())
        return out;
    for (const LinkageFault& fault : build_model(spec, out.tool.linkage))
        problems.add(describe(fault));
    if (!(held >= 0.0 && held < static_cast<double>(centers.size())))
        problems.add("grip_link is " + std::to_string(held) + "; the linkage has the links 0 to " +
                     std::to_string(static_cast<int>(centers.size()) - 1) + ".");
    if (!problems.none())
        return out;
    out.tool.grip.link = static_cast<std::int32_t>(held);
    out.tool.grip.point = point - centers[static_cast<std::size_t>(held)];
    Model model;
    model.tool = out.tool;
    problems.add(validate(model));
    start_from(out.tool.linkage, start, out);
    return out;
}

} // namespace haptics
