// A model that ran away.
//
// Nothing in a scene is a thousand kilometers away or as fast as a thousand kilometers a second. A state
// beyond that, or one that is not a number, is wrong, whatever made it so: absurd figures, shapes inside of
// each other that no motion can part. It would grow and stay. So the tool is put back to where the step
// began, at rest and out of contact, with the movables that ran away at their snapshot's pose; the step gives
// no force, and StepOutput::diverged lets the session take it off the hand.

#include <algorithm>
#include <cmath>

#include "internal.hpp"

namespace haptics::local {
namespace {

// m and rad, and m/s and rad/s; for a linkage those of its coordinates
constexpr double k_farthest = 1e6;
constexpr double k_fastest = 1e6;
// a body of 1 mm may turn a thousand times as fast
constexpr double k_fastest_turn = 1e9;

template <class Vector>
bool within(const Vector& v, double most) {
    return (v.cwiseAbs().array() < most).all(); // false for what is not a number
}

bool is_sane(const Pose& pose, const Twist& velocity) {
    // each is false for what is not a number
    return std::abs(pose.x()) < k_farthest && std::abs(pose.y()) < k_farthest && std::isfinite(pose.z()) &&
           std::abs(velocity.x()) < k_fastest && std::abs(velocity.y()) < k_fastest &&
           std::abs(velocity.z()) < k_fastest_turn;
}

bool tool_is_sane(const Model& model, const Data& data) {
    if (!model.tool.articulated)
        return is_sane(data.pose, data.velocity);
    const int base = model.tool.linkage.floating ? 2 : 0;
    const auto& q = data.linkage.position;
    return q.allFinite() && within(q.head(base), k_farthest) && std::isfinite(data.energy_budget) &&
           within(data.linkage.velocity, k_fastest_turn) && is_sane(data.pose, data.velocity);
}

void put_back(MovableState& m, Data& data) {
    const std::uint64_t id = m.belief.id;
    const std::int32_t body = m.body;
    m = MovableState{};
    m.belief.id = id;
    // met anew: what it was given is counted from here
    m.belief.epoch = data.step + 1;
    m.belief.time = m.heard_time = data.time;
    m.body = body;
    if (body < 0)
        return;
    Body& b = data.neighbors.body[static_cast<std::size_t>(body)];
    b.pose = m.belief.pose = data.track[static_cast<std::size_t>(body)].pose;
    b.velocity.setZero();
}

bool is_sane(const MovableState& m) {
    return is_sane(m.belief.pose, m.belief.velocity) && m.belief.given.allFinite();
}

} // namespace

bool ran_away(const Model& model, const Data& data) {
    return !tool_is_sane(model, data) ||
           !std::all_of(data.movable.begin(), data.movable.begin() + data.movable_count,
                        [](const MovableState& m) { return is_sane(m); });
}

void put_back(const Model& model, Data& data, const LinkageVector& start, StepOutput& output) {
    for (std::int32_t i = 0; i < data.movable_count; ++i)
        if (!is_sane(data.movable[static_cast<std::size_t>(i)]))
            put_back(data.movable[static_cast<std::size_t>(i)], data);
    output.clear();
    output.diverged = true;
    data.patches.count = 0;
    data.joint = {};
    data.energy_budget = 0.0;
    // a start that was no configuration either (who runs the model may have set it)
    const bool sane = start.allFinite() && within(start, k_fastest_turn);
    const LinkageVector back = sane ? start : LinkageVector::Zero(start.size());
    if (model.tool.articulated) {
        data.linkage.position = back;
        data.linkage.velocity.setZero();
        data.half_step.setZero();
    } else {
        data.pose = back;
        data.velocity.setZero();
    }
    place_tool(model, data);
}

} // namespace haptics::local
