// What a session tells of a step.

#include <haptics/core/control/session.hpp>

#include <algorithm>

namespace haptics {

void Session::write_report(const GateOutput& gate, const Wrench& command) {
    report_linkage();
    const Mapping& map = settings_.mapping;
    HapticReport& r = report_;
    r.step = data_->step;
    r.time = data_->time;
    r.device = target();
    r.device_velocity = handle_velocity_;
    r.proxy = data_->pose;
    r.grip = grip_pose(data_->grip, data_->pose);
    r.velocity = data_->velocity;
    r.hand_share = grasp_.share() * placement_.share();
    r.force = map.wrench_to_scene(gate.applied);
    r.compensation = map.wrench_to_scene(care_.applied());
    r.command = map.wrench_to_scene(command);
    r.contact = output_.contact;
    r.coupling = output_.coupling;
    r.hand = hand_force_;
    r.impulse_demanded = impulses_.demanded();
    r.impulse_delivered = impulses_.delivered();
    r.impulse_dropped = impulses_.dropped();
    r.contacts = output_.contacts;
    r.colliding = output_.colliding;
    r.sticking = output_.sticking;
    r.sliding = output_.sliding;
    r.max_penetration = output_.max_penetration;
    r.energy_injected = ledger_.injected();
    r.held = held_;
    r.armed = gate_.armed();
    r.arm_wanted = arm_wanted_;
    r.arming = arm_result_;
    r.gate = gate.flags;
    r.faults = gate.faults;
    r.fallbacks += output_.fell_back ? 1U : 0U;
    r.exact_gave_way += output_.exact_gave_way ? 1U : 0U;
    r.patch_overflow = data_->patches.overflow;
    r.movable_overflow = data_->movable_overflow;
    r.reading_missing = missing_;
    r.buttons = reading_.buttons;
    r.contact_count = 0;
    for (int i = 0; i < data_->patches.count && r.contact_count < HapticReport::k_max_contacts; ++i) {
        const Patch& p = data_->patches.patch[static_cast<std::size_t>(i)];
        // movable neighbors touch others too; the list is the tool's
        if (p.memory.state == ContactState::none || p.body_a >= data_->tool.body_count ||
            p.body_b < data_->tool.body_count)
            continue;
        ContactReport& c = r.contact_list[static_cast<std::size_t>(r.contact_count++)];
        c.body = data_->neighbors.body[static_cast<std::size_t>(p.body_b - data_->tool.body_count)].id;
        c.link = p.body_a;
        c.state = p.memory.state;
        c.normal = p.normal;
        c.normal_force = p.memory.normal_force;
        c.tangent_force = p.memory.tangent_force;
        c.position.setZero();
        c.penetration = 0.0;
        for (int k = 0; k < p.point_count; ++k) {
            const PatchPoint& point = p.point[static_cast<std::size_t>(k)];
            c.position += point.weight * point.position;
            c.penetration = std::max(c.penetration, -point.gap);
        }
    }
    r.run.max_force = std::max(r.run.max_force, gate.applied.head<2>().norm());
    r.run.max_penetration = std::max(r.run.max_penetration, r.max_penetration);
    r.run.collisions += static_cast<std::uint64_t>(r.colliding);
    if (held_ && gate_.armed()) {
        r.run.error_sum += (r.grip - r.device).head<2>().squaredNorm();
        ++r.run.error_count;
    }
    r.movable_count = data_->movable_count;
    for (int i = 0; i < data_->movable_count; ++i)
        r.movable[static_cast<std::size_t>(i)] = data_->movable[static_cast<std::size_t>(i)].belief;
}

} // namespace haptics
