#include <haptics/core/local_model/model.hpp>
#include <haptics/core/local_model/neighborhood.hpp>
#include <haptics/core/local_model/plan.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace haptics {
namespace {

struct StageText {
    Stage stage;
    std::string_view name;
    std::string_view reason;
};

constexpr std::array<StageText, k_stage_count> k_text{{
    {Stage::moving_walls, "moving walls", "the scene moves nothing that is near"},
    {Stage::movables, "movable neighbors", "nothing near has a mass that can be pushed"},
    {Stage::detection, "contact detection", "nothing is near"},
    {Stage::linkage, "linkage kinematics", "the tool is rigid"},
    {Stage::coriolis, "Coriolis terms", "the tool is rigid, or its linkage leaves them out"},
    {Stage::gravity, "gravity", "gravity is zero"},
    {Stage::joint_springs, "joint springs and dampers", "no joint has a spring or damping"},
    {Stage::joint_limits, "joint limits", "no joint has a limit"},
    {Stage::joint_friction, "joint friction", "no joint has friction"},
    {Stage::collisions, "collision impulses", "nothing can collide, or contacts are penalty forces alone"},
    {Stage::restitution, "restitution", "no surface near bounces"},
    {Stage::friction, "friction", "no pair of surfaces has friction"},
    {Stage::free_system, "matrices in steps without contact", "a rigid tool that touches nothing needs none"},
    {Stage::contact_system, "matrices in steps with contact",
     "a rigid tool among what it cannot move needs none"},
}};

// surfaces of the tool's links and of the neighbors: whether any pair gives `figure` > 0
template <class Figure>
bool any_pair(const Model& model, const Neighborhood& n, const Figure& figure) {
    const BodySet& tool = model.tool.shape;
    for (std::int32_t b = 0; b < n.bodies.body_count; ++b) {
        const Body& other = n.bodies.body[static_cast<std::size_t>(b)];
        for (std::int32_t a = 0; a < tool.body_count; ++a)
            if (figure(combine(tool.body[static_cast<std::size_t>(a)].surface, other.surface)) > 0.0)
                return true;
        // movables touch each other and the walls too
        if (other.kind == BodyKind::movable && figure(other.surface) > 0.0)
            return true;
    }
    return false;
}

template <class Test>
bool any_body(const Neighborhood& n, const Test& test) {
    return std::any_of(n.bodies.body.begin(), n.bodies.body.begin() + n.bodies.body_count, test);
}

template <class Test>
bool any_joint(const Model& model, const Test& test) {
    const LinkageModel& linkage = model.tool.linkage;
    for (int i = linkage.floating ? 3 : 0; i < linkage.freedoms; ++i)
        if (test(linkage.passive[i]))
            return true;
    return false;
}

} // namespace

Plan choose_plan(const Model& model, const Neighborhood& n) {
    Plan plan;
    const auto need = [&plan](Stage stage, bool needed) {
        if (!needed)
            plan.leave_out(stage);
    };
    const bool articulated = model.tool.articulated;
    const bool near = n.bodies.body_count > 0;
    const bool limits = articulated && any_joint(model, [](const JointSpec& j) {
                            return std::isfinite(j.lower_limit) || std::isfinite(j.upper_limit);
                        });
    need(Stage::detection, near);
    need(Stage::moving_walls, any_body(n, [](const Body& b) { return b.kind == BodyKind::kinematic; }));
    need(Stage::movables, any_body(n, [](const Body& b) { return b.kind == BodyKind::movable; }));
    need(Stage::collisions, (near || limits) && model.settings.contact_mode == ContactMode::penalty_impulse);
    need(Stage::restitution,
         plan.runs(Stage::collisions) && any_pair(model, n, [](const Surface& s) { return s.restitution; }));
    need(Stage::friction,
         any_pair(model, n,
                  [](const Surface& s) { return std::max(s.static_friction, s.dynamic_friction); }) ||
             any_body(n, [](const Body& b) {
                 return b.kind == BodyKind::movable && std::abs(b.scene_friction) > 0.0;
             }));
    need(Stage::gravity, !n.gravity.isZero(0.0));
    need(Stage::linkage, articulated);
    need(Stage::coriolis, articulated && model.tool.linkage.coriolis);
    need(Stage::joint_limits, limits);
    need(Stage::joint_friction,
         articulated && any_joint(model, [](const JointSpec& j) { return j.friction > 0.0; }));
    need(Stage::joint_springs, articulated && any_joint(model, [](const JointSpec& j) {
                                   return j.spring_stiffness > 0.0 || j.damping > 0.0;
                               }));
    const bool exact = model.settings.integrator == Integrator::exact;
    need(Stage::free_system, articulated || exact);
    need(Stage::contact_system, articulated || exact || plan.runs(Stage::movables));
    return plan;
}

std::vector<PlanLine> describe(const Plan& plan) {
    std::vector<PlanLine> lines;
    for (const StageText& text : k_text) {
        const bool runs = plan.runs(text.stage);
        lines.push_back({text.name, runs, runs ? std::string_view() : text.reason});
    }
    return lines;
}

std::string_view kernel_name(const Model& model) {
    if (!model.tool.articulated)
        return "rigid tool, 3 freedoms, fixed size";
    switch (model.tool.linkage.freedoms) {
    case 1:
        return "linkage, 1 freedom, fixed size";
    case 2:
        return "linkage, 2 freedoms, fixed size";
    case 3:
        return "linkage, 3 freedoms, fixed size";
    case 4:
        return "linkage, 4 freedoms, fixed size";
    default:
        return model.tool.linkage.freedoms > model.settings.dense_freedoms ? "long linkage, row by row"
                                                                           : "linkage, dense matrix";
    }
}

} // namespace haptics
