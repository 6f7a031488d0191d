#include <haptics/core/local_model/validate.hpp>

namespace haptics {

std::vector<FigureError> validate(const Surface& s) {
    FigureCheck check("surface.");
    constexpr double k_most = 1e12;
    // infinity leaves the figure to the partner
    const auto range = [&check](const char* name, double value, double most, const char* unit,
                                const char* remedy) {
        return (std::isinf(value) && value > 0.0) || check.range(name, value, 0.0, most, unit, remedy);
    };
    range("stiffness", s.stiffness, k_most, "N/m", "The paper's wall has 15000 N/m.");
    range("damping", s.damping, k_most, "N s/m", "The paper's wall has 20 N s/m.");
    range("static_friction", s.static_friction, 100.0, "", "Most materials lie between 0.1 and 1.");
    if (range("dynamic_friction", s.dynamic_friction, 100.0, "", "Most materials lie between 0.1 and 1.") &&
        s.dynamic_friction > s.static_friction)
        check.inconsistent("dynamic_friction", s.dynamic_friction, 0.0, s.static_friction, "",
                           "Make it at most static_friction: sliding never holds better than sticking.");
    check.range("restitution", s.restitution, 0.0, 1.0, "", "0 stops dead, 1 loses nothing.");
    return check.take();
}

namespace {

void check_rigid(const ToolModel& tool, FigureCheck& check) {
    check.range("mass", tool.mass, 1e-6, 1e4, "kg", "Give the tool a mass; 0.1 kg suits a desktop device.");
    check.range("inertia", tool.inertia, 1e-12, 1e4, "kg m^2",
                "Leave it at 0 in the scene to have it computed from the shapes.");
}

// the linkage itself was checked when it was compiled
void check_linkage(const ToolModel& tool, FigureCheck& check) {
    const auto links = static_cast<double>(tool.linkage.link_count);
    check.range("links", links, 1.0, static_cast<double>(k_max_links), "links",
                "Compile a LinkageSpec into it.");
    check.range("shape.bodies", static_cast<double>(tool.shape.body_count), links, links, "bodies",
                "Give the shape one body for each link; a body may be without pieces.");
    check.range("grip.link", static_cast<double>(tool.grip.link), 0.0, links - 1.0, "(link)",
                "Hold a link that the linkage has.");
    for (int i = 0; i < 2; ++i)
        check.range("linkage.gravity", tool.linkage.gravity(i), 0.0, 0.0, "m/s^2",
                    "Leave it at 0: gravity comes with the neighborhood.");
}

} // namespace

std::vector<FigureError> validate(const Model& model) {
    FigureCheck check;
    if (model.tool.articulated)
        check_linkage(model.tool, check);
    else
        check_rigid(model.tool, check);
    check.range("grip_point.x", model.tool.grip.point.x(), -10.0, 10.0, "m", "Put the grip on the tool.");
    check.range("grip_point.y", model.tool.grip.point.y(), -10.0, 10.0, "m", "Put the grip on the tool.");
    check.range("pieces", static_cast<double>(model.tool.shape.piece_count), 1.0,
                static_cast<double>(k_max_pieces), "shapes", "Give the tool at least one collision shape.");
    check.range("collision_speed", model.settings.collision_speed, 1e-6, 10.0, "m/s",
                "Slower approaches than this give no collision impulse; 0.005 m/s is the default.");
    check.range("margin", model.settings.margin, 1e-6, 0.1, "m", "0.0005 m is the default.");
    check.range("max_events", static_cast<double>(model.settings.max_events), 0.0, 64.0, "events",
                "4 is the default.");
    for (int i = 0; i < model.tool.shape.body_count; ++i)
        check.append(validate(model.tool.shape.body[static_cast<std::size_t>(i)].surface));
    return check.take();
}

} // namespace haptics
