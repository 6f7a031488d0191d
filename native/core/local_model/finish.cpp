// After the motion: contact states, counts and events of the step.
//
// States (section 3.2 of the paper): none -> colliding when a collision was resolved, for one step; then
// sticking or sliding by Coulomb while the gap is not open; none as soon as every point of the patch is
// apart. A frictionless contact always slides.

#include <algorithm>

#include "internal.hpp"
#include "outcome.hpp"

namespace haptics::local {
namespace {

ContactState next_state(const ContactSystem& s, const PatchRow& t) {
    if (t.collided)
        return ContactState::colliding;
    bool touching = false;
    for (int k = 0; k < t.point_count; ++k) {
        const PointRow& p = s.point[static_cast<std::size_t>(t.first_point + k)];
        // a touch that began and ended within the step is told once
        touching = touching || p.gap <= 0.0 || (p.impulse > 0.0 && !t.continuing);
    }
    if (!touching)
        return ContactState::none;
    return t.mode == FrictionMode::stick ? ContactState::sticking : ContactState::sliding;
}

// motion of the tool and springs of its contacts
double stored_energy(const Model& model, const Data& data) {
    const ContactSystem& s = data.system;
    double energy = tool_energy(model, data);
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (t.patch >= 0 &&
            data.patches.patch[static_cast<std::size_t>(t.patch)].body_a >= data.tool.body_count)
            continue;
        energy += 0.5 * t.stiffness * t.spring * t.spring;
        for (int k = 0; k < t.point_count; ++k) {
            const PointRow& p = s.point[static_cast<std::size_t>(t.first_point + k)];
            energy += p.gap < 0.0 ? 0.5 * p.stiffness * p.gap * p.gap : 0.0;
        }
    }
    return energy;
}

// a joint remembers its friction's anchor, and that it rests against a limit
void remember_joint(const ContactSystem& s, const PatchRow& t, Data& data) {
    JointMemory& joint = data.joint[t.freedom];
    if (t.point_count > 0) {
        joint.at_limit = s.point[static_cast<std::size_t>(t.first_point)].gap <= 0.0;
        return;
    }
    joint.slip_spring = t.spring;
    joint.sliding = t.was_sliding;
}

} // namespace

void Outcomes::add_event(ContactEventKind kind, std::uint64_t body, const Patch* patch, double impulse) {
    if (output_.event_count == StepOutput::k_max_events) {
        ++output_.events_dropped;
        return;
    }
    ContactEvent& e = output_.event[static_cast<std::size_t>(output_.event_count++)];
    e = ContactEvent{kind, body, data_.time, {0.0, 0.0}, {0.0, 1.0}, impulse};
    if (patch != nullptr) {
        Vec2 middle{0.0, 0.0};
        for (int k = 0; k < patch->point_count; ++k)
            middle += patch->point[static_cast<std::size_t>(k)].weight *
                      patch->point[static_cast<std::size_t>(k)].position;
        e.position = {middle.x(), middle.y()};
        e.normal = {patch->normal.x(), patch->normal.y()};
    }
}

void finish(const Model& model, Data& data, StepOutput& output) {
    ContactSystem& s = data.system;
    end_tool_step(model, data);
    for (int i = 0; i < k_max_freedoms && model.tool.articulated; ++i)
        data.joint[i].at_limit = false;
    Outcomes outcomes(data, output);
    for (int i = 0; i < s.patches; ++i) {
        const PatchRow& t = s.row[static_cast<std::size_t>(i)];
        if (t.patch < 0) {
            remember_joint(s, t, data);
            continue;
        }
        Patch& p = data.patches.patch[static_cast<std::size_t>(t.patch)];
        double normal = 0.0;
        for (int k = 0; k < t.point_count; ++k) {
            const PointRow& row = s.point[static_cast<std::size_t>(t.first_point + k)];
            normal += row.force;
            p.point[static_cast<std::size_t>(row.slot)].gap = row.gap;
            output.max_penetration = std::max(output.max_penetration, -row.gap);
        }
        outcomes.tell(p, {next_state(s, t), normal, t.force, t.spring, t.impulse, t.collided});
    }
    outcomes.end();
    output.stored_energy = stored_energy(model, data);
}

} // namespace haptics::local
