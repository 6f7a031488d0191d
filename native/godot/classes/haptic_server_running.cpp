// What a scene sends to a world that runs, and asks of it.

#include <haptics/classes/haptic_server.hpp>

#include <algorithm>

namespace haptics {

using namespace godot;

PackedStringArray HapticServer::world_submit(int64_t world, const PackedInt64Array& bodies,
                                             const PackedFloat64Array& states, double tick,
                                             const PackedFloat64Array& gravity,
                                             const PackedFloat64Array& discs, const PackedInt64Array& masks,
                                             int64_t frame, int64_t most_ticks) {
    Problems problems;
    HapticWorld* w = find(world);
    if (w == nullptr)
        return problems.to_godot();
    const auto wanted = static_cast<std::size_t>(bodies.size()) * BodyRegistry::k_state;
    if (static_cast<std::size_t>(states.size()) != wanted || gravity.size() != 2 || discs.size() % 3 != 0) {
        problems.add("world_submit() got " + std::to_string(states.size()) + " state numbers for " +
                     std::to_string(bodies.size()) +
                     " bodies (8 each: x, y, angle, vx, vy, angular velocity, free fall x, y), " +
                     std::to_string(gravity.size()) + " for gravity (2) and " + std::to_string(discs.size()) +
                     " for discs (3 each: x, y, radius).");
        return problems.to_godot();
    }
    std::vector<ReachDisc> near;
    for (int64_t i = 0; i < discs.size(); i += 3)
        near.push_back({Vec2(discs[i], discs[i + 1]), discs[i + 2]});
    w->submit(bodies.span(), states.span(), near, masks.span(), {tick, frame, most_ticks},
              Vec2(gravity[0], gravity[1]), problems);
    return problems.to_godot();
}

Array HapticServer::world_get_neighborhood(int64_t world) const {
    const HapticWorld* w = find(world);
    return w == nullptr ? Array() : w->neighborhood();
}

int64_t HapticServer::world_get_left_out(int64_t world) const {
    const HapticWorld* w = find(world);
    return w == nullptr ? 0 : w->left_out();
}

int64_t HapticServer::world_advance(int64_t world, double seconds) {
    HapticWorld* w = find(world);
    return w == nullptr ? 0 : w->advance(seconds);
}

void HapticServer::world_refresh(int64_t world) {
    if (HapticWorld* w = find(world))
        w->refresh();
}

PackedFloat64Array HapticServer::world_get_state(int64_t world) const {
    PackedFloat64Array out;
    const HapticWorld* w = find(world);
    if (w == nullptr)
        return out;
    const HapticReport& r = w->report();
    const Pose tool = center_to_node(r.proxy, w->tool_center());
    out.resize(STATE_COUNT);
    double* s = out.ptrw();
    const auto put3 = [s](int at, const Vec3& v) { std::copy_n(v.data(), 3, s + at); };
    s[STATE_STEP] = static_cast<double>(r.step);
    s[STATE_TIME] = r.time;
    put3(STATE_TOOL_X, tool);
    put3(STATE_GRIP_X, r.grip);
    put3(STATE_DEVICE_X, r.device);
    put3(STATE_VELOCITY_X, r.velocity);
    put3(STATE_FORCE_X, r.force);
    put3(STATE_CONTACT_FORCE_X, r.contact);
    s[STATE_CONTACTS] = r.contacts;
    s[STATE_COLLIDING] = r.colliding;
    s[STATE_STICKING] = r.sticking;
    s[STATE_SLIDING] = r.sliding;
    s[STATE_PENETRATION] = r.max_penetration;
    s[STATE_ENERGY_INJECTED] = r.energy_injected;
    s[STATE_ARMED] = r.armed ? 1.0 : 0.0;
    s[STATE_HELD] = r.held ? 1.0 : 0.0;
    s[STATE_FAULTS] = static_cast<double>(r.faults);
    s[STATE_BUTTONS] = static_cast<double>(r.buttons);
    s[STATE_HAND_SHARE] = r.hand_share;
    return out;
}

Array HapticServer::world_get_contacts(int64_t world) const {
    Array out;
    const HapticWorld* w = find(world);
    if (w == nullptr)
        return out;
    static constexpr std::array<const char*, 4> k_states{"none", "colliding", "sticking", "sliding"};
    const HapticReport& r = w->report();
    for (std::int32_t i = 0; i < r.contact_count; ++i) {
        const ContactReport& c = r.contact_list[static_cast<std::size_t>(i)];
        Dictionary d;
        d["body"] = static_cast<int64_t>(c.body);
        d["state"] = k_states[static_cast<std::size_t>(c.state)];
        d["position"] = PackedFloat64Array({c.position.x(), c.position.y()});
        d["normal"] = PackedFloat64Array({c.normal.x(), c.normal.y()});
        d["normal_force"] = c.normal_force;
        d["tangent_force"] = c.tangent_force;
        d["penetration"] = c.penetration;
        out.push_back(d);
    }
    return out;
}

PackedInt64Array HapticServer::world_get_touched(int64_t world) const {
    PackedInt64Array out;
    const HapticWorld* w = find(world);
    if (w == nullptr)
        return out;
    const HapticReport& r = w->report();
    for (std::int32_t i = 0; i < r.contact_count; ++i) {
        const auto id = static_cast<int64_t>(r.contact_list[static_cast<std::size_t>(i)].body);
        const auto seen = out.span();
        if (std::find(seen.begin(), seen.end(), id) == seen.end())
            out.push_back(id);
    }
    return out;
}

Array HapticServer::world_take_events(int64_t world) {
    HapticWorld* w = find(world);
    return w == nullptr ? Array() : w->take_events();
}

PackedFloat64Array HapticServer::world_take_impulses(int64_t world) {
    PackedFloat64Array out;
    HapticWorld* w = find(world);
    if (w == nullptr)
        return out;
    for (const GivenImpulse& g : w->take_impulses()) {
        out.push_back(static_cast<double>(g.body));
        for (int i = 0; i < 3; ++i)
            out.push_back(g.impulse(i));
    }
    return out;
}

PackedStringArray HapticServer::world_get_faults(int64_t world) const {
    PackedStringArray out;
    const HapticWorld* w = find(world);
    if (w == nullptr)
        return out;
    for (int bit = 0; bit < k_fault_count; ++bit)
        if (((static_cast<std::uint32_t>(w->report().faults) >> bit) & 1U) != 0U)
            out.push_back(describe_fault(bit));
    return out;
}

void HapticServer::world_book_tick(int64_t world, double seconds) {
    if (HapticWorld* w = find(world))
        w->book_tick(seconds);
}

Dictionary HapticServer::world_get_statistics(int64_t world) const {
    const HapticWorld* w = find(world);
    return w == nullptr ? Dictionary() : w->statistics();
}

void HapticServer::world_aim(int64_t world, const PackedFloat64Array& grip) {
    HapticWorld* w = find(world);
    if (w == nullptr)
        return;
    if (grip.size() != 3) {
        print_error("world_aim() needs 3 numbers (x, y, angle), got " + std::to_string(grip.size()) + ".");
        return;
    }
    w->aim(Pose(grip[0], grip[1], grip[2]));
}

void HapticServer::world_hold(int64_t world, bool held) {
    if (HapticWorld* w = find(world))
        w->send(held ? RunnerCommand::hold : RunnerCommand::release);
}

PackedStringArray HapticServer::world_place(int64_t world, const Dictionary& placement) {
    Problems problems;
    const HandPlacement wanted = read_placement(placement, problems);
    HapticWorld* w = find(world);
    if (w != nullptr && problems.none())
        w->place(wanted);
    return problems.to_godot();
}

void HapticServer::world_arm(int64_t world, bool armed) {
    if (HapticWorld* w = find(world))
        w->send(armed ? RunnerCommand::arm : RunnerCommand::disarm);
}

void HapticServer::world_set_paused(int64_t world, bool paused) {
    if (HapticWorld* w = find(world))
        w->send(paused ? RunnerCommand::pause : RunnerCommand::resume);
}

void HapticServer::world_press_stop(int64_t world) {
    if (HapticWorld* w = find(world))
        w->send(RunnerCommand::stop);
}

PackedStringArray HapticServer::world_grab(int64_t world, int64_t link, const PackedFloat64Array& point,
                                           bool pose) {
    Problems problems;
    HapticWorld* w = find(world);
    if (w == nullptr)
        return problems.to_godot();
    if (point.size() != 2)
        problems.add("world_grab() needs 2 numbers for the point (x, y), got " +
                     std::to_string(point.size()) + ".");
    else
        w->grab(link, Vec2(point[0], point[1]), pose, problems);
    return problems.to_godot();
}

PackedFloat64Array HapticServer::world_get_links(int64_t world) const {
    const HapticWorld* w = find(world);
    if (w == nullptr)
        return {};
    PackedFloat64Array out;
    for (const double number : w->links())
        out.push_back(number);
    return out;
}

PackedStringArray HapticServer::world_start_beside(int64_t world, int64_t host) {
    Problems problems;
    HapticWorld* w = find(world);
    HapticWorld* h = find(host);
    if (w != nullptr && h != nullptr)
        w->start_beside(*h, world, problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_tie_body(int64_t world, int64_t body, int64_t linkage, int64_t link) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->tie_body(body, linkage, link, problems);
    return problems.to_godot();
}

int64_t HapticServer::world_get_held_link(int64_t world) const {
    const HapticWorld* w = find(world);
    return w == nullptr ? 0 : w->report().held_link;
}

PackedStringArray HapticServer::world_home_device(int64_t world) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->home_device(problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_save_recording(int64_t world, const String& path) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->save_recording(path.utf8(), problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_save_samples(int64_t world, const String& path, double interval) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->save_samples(path.utf8(), interval, problems);
    return problems.to_godot();
}

} // namespace haptics
