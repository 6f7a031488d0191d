// One haptic step: find contacts, resolve collisions at their own time, integrate continuous contact, take
// stock.
//
// Sampled collision detection leaves up to h |v| of overlap, whose spring energy K (h v)^2 / 2 can be most of
// the impact energy at stiff walls. So the step is cut at the time of impact: points that are apart close at
// t = gap / |gap rate|; the model is integrated up to t, the impulses are applied with the gap at zero, and
// the rest of the step follows. The time is foreseen with the velocities at the start; what closes only
// because forces speed it up on the way is found after the motion is known, and the motion is done again up
// to there (integrate.cpp). At most `max_events` cuts are made; what would close later is met by the contact
// spring.

#include <haptics/core/contact/detection.hpp>

#include <algorithm>
#include <utility>

#include "exact_parts.hpp"
#include "fading.hpp"
#include "internal.hpp"

namespace haptics {
namespace {

void find_contacts(const Model& model, Data& data, double dt) {
    if (!data.plan.runs(Stage::detection)) {
        data.patches.count = 0;
        return;
    }
    const bool fades = data.plan.runs(Stage::moving_walls);
    if (fades) {
        local::end_fades(data);
        local::move_anchors(data);
    }
    const bool exact = model.settings.integrator == Integrator::exact;
    if (exact) // it asks for them later in the step
        data.previous = data.patches;
    detect_patches(data.tool, data.tool_cache, data.neighbors, data.neighbor_cache,
                   {model.settings.margin, dt}, exact ? data.previous : data.patches, data.patches);
    if (fades)
        local::weigh_contacts(data);
}

void advance(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    double left = dt;
    const bool may_hit = data.system.points > 0 && data.plan.runs(Stage::collisions);
    const int events =
        may_hit && model.settings.contact_mode != ContactMode::penalty ? model.settings.max_events : 0;
    for (int event = 0; event < events; ++event) {
        const double foreseen = local::next_collision(model, data, left);
        const double wanted = foreseen < 0.0 ? left : foreseen;
        double done = 0.0;
        if (wanted > 0.0)
            done = local::integrate_to_hit(model, data, hand, wanted, left - wanted, dt, output);
        left -= done;
        if (foreseen < 0.0 && done >= wanted)
            return;
        // what forces slowed down on the way has not closed yet
        if (!local::collide(model, data, output) && done == 0.0)
            break;
    }
    if (left > 0.0)
        local::integrate(model, data, hand, left, 0.0, left / dt, output);
}

enum class Contacts : std::uint8_t { sought, kept };

// from the contacts on
void make_step(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    const bool exact = model.settings.integrator == Integrator::exact;
    if (data.patches.count == 0 && !exact && !data.plan.runs(Stage::free_system)) {
        local::step_freely(model, data, hand, dt, output);
        return;
    }
    if (!exact && !data.plan.runs(Stage::contact_system) &&
        local::step_in_contact(model, data, hand, dt, output))
        return;
    data.system.ahead = exact && model.tool.articulated ? 0.5 * dt : 0.0;
    local::assemble(model, data, dt);

    output.grip_mobility = local::mobility(model, data);

    if (exact)
        local::step_exactly(model, data, hand, dt, output);
    else
        advance(model, data, hand, dt, output);
    local::finish(model, data, output);
}

// A step with the exact integrator: where a linkage turns fast at a contact it is made of parts.
void make_exact_step(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    constexpr int k_most_parts = 64;
    StepFigures sum;
    double left = dt;
    double before = dt;
    for (int part = 1; left > 0.0; ++part) {
        local::begin_tool_step(model, data);
        find_contacts(model, data, left);
        const double next = part < k_most_parts ? local::part_of_step(model, data, left) : left;
        const double rest = next < left ? left - next : 0.0;
        data.half_step *= next / before;
        static_cast<StepFigures&>(output) = StepFigures{};
        make_step(model, data, local::hand_of_part(hand, rest), next, output);
        local::add_part(output, next / dt, sum);
        before = next;
        left = rest;
    }
    data.half_step *= dt / before;
    static_cast<StepFigures&>(output) = std::move(sum);
}

void guarded_step(const Model& model, Data& data, const HandInput& hand, double dt, Contacts contacts,
                  StepOutput& output) {
    output.clear();
    const Pose start = data.pose;
    LinkageVector coordinates; // assigned: a copy would take all that it has room for
    if (model.tool.articulated)
        coordinates = data.linkage.position;
    const bool exact = model.settings.integrator == Integrator::exact;
    if (exact && model.tool.articulated && contacts == Contacts::sought) {
        make_exact_step(model, data, hand, dt, output);
    } else {
        if (model.tool.articulated || data.plan.runs(Stage::detection))
            local::begin_tool_step(model, data);
        if (contacts == Contacts::sought)
            find_contacts(model, data, dt);
        make_step(model, data, hand, dt, output);
    }
    output.source_work += data.correction_work;
    data.correction_work = 0.0;
    data.step_length = dt;
    if (local::ran_away(model, data)) {
        if (!model.tool.articulated)
            coordinates = start;
        local::put_back(model, data, coordinates, output);
    }
    ++data.step;
}

} // namespace

void reset(const Model& model, Data& data, const LinkageVector& configuration) {
    if (model.tool.articulated) {
        reset(model.tool.linkage, data.linkage);
        data.linkage.position = configuration;
        data.half_step.setZero(model.tool.linkage.freedoms);
        data.energy_budget = 0.0;
        data.tool_mass = 0.0;
        for (int i = 0; i < model.tool.linkage.link_count; ++i)
            data.tool_mass += model.tool.linkage.link[i].mass;
    } else {
        data.tool_mass = model.tool.mass;
        data.pose = configuration;
        data.velocity.setZero();
    }
    data.joint = {};
    data.pushed = false;
    data.grip = model.tool.grip;
    data.patches.count = 0;
    data.correction_work = 0.0;
    data.touched_count = 0;
    data.tool_cache.known = false;
    data.tool.body_count = model.tool.shape.body_count;
    data.tool.piece_count = model.tool.shape.piece_count;
    std::copy_n(model.tool.shape.body.begin(), model.tool.shape.body_count, data.tool.body.begin());
    std::copy_n(model.tool.shape.piece.begin(), model.tool.shape.piece_count, data.tool.piece.begin());
    local::move_neighbors(data, 0.0);
    local::place_tool(model, data);
}

Mat3 grip_mobility(const Model& model, Data& data) {
    ContactSystem& s = data.system;
    local::grip_rows(model, data, s.grip);
    if (model.tool.articulated)
        factorize(model.tool.linkage, data.linkage, nullptr, data.factor);
    return local::mobility(model, data);
}

void step_direct(const Model& model, Data& data, const Pose& pose, const Twist& velocity, double dt,
                 StepOutput& output) {
    output.clear();
    data.pose = pose;
    data.velocity = velocity;
    local::move_neighbors(data, dt);
    local::place_tool(model, data);
    find_contacts(model, data, dt);
    data.system.ahead = 0.0;
    local::assemble(model, data, dt);
    output.grip_mobility = local::mobility(model, data);
    local::explicit_forces(model, data, dt, output);
    local::finish(model, data, output);
    output.source_work += data.correction_work;
    data.correction_work = 0.0;
    ++data.step;
}

void step(const Model& model, Data& data, const HandInput& hand, double dt, StepOutput& output) {
    guarded_step(model, data, hand, dt, Contacts::sought, output);
}

void step_without_detection(const Model& model, Data& data, const HandInput& hand, double dt,
                            StepOutput& output) {
    guarded_step(model, data, hand, dt, Contacts::kept, output);
}

} // namespace haptics
