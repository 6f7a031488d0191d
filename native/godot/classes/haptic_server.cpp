#include <haptics/classes/geometry_reader.hpp>
#include <haptics/classes/haptic_server.hpp>

namespace haptics {

using namespace godot;

namespace {

#if defined(__clang__)
constexpr const char* k_compiler = "clang " __clang_version__;
#else
constexpr const char* k_compiler = "g++ " __VERSION__;
#endif

#if defined(__x86_64__)
constexpr const char* k_architecture = "x86_64";
#elif defined(__aarch64__)
constexpr const char* k_architecture = "arm64";
#else
constexpr const char* k_architecture = "unknown";
#endif

} // namespace

HapticServer::HapticServer() {
    singleton_ = this;
}

HapticServer::~HapticServer() {
    singleton_ = nullptr;
}

HapticServer* HapticServer::get_singleton() {
    return singleton_;
}

void HapticServer::stop_all() {
    if (singleton_ == nullptr)
        return;
    for (auto& [id, world] : singleton_->worlds_)
        world->stop();
}

HapticWorld* HapticServer::find(int64_t world) const {
    const auto found = worlds_.find(world);
    if (found != worlds_.end())
        return found->second.get();
    print_error("HapticServer: there is no world " + std::to_string(world) +
                ". Use an id from world_create().");
    return nullptr;
}

String HapticServer::get_version() const {
    return HAPTICS_VERSION;
}

Dictionary HapticServer::get_build_info() const {
    Dictionary info;
    info["version"] = HAPTICS_VERSION;
    info["build_type"] = HAPTICS_BUILD_TYPE;
    info["compiler"] = k_compiler;
    info["architecture"] = k_architecture;
    info["godot_version"] = Engine::get_singleton()->get_version_string();
    return info;
}

Dictionary HapticServer::get_pantograph_preset(const String& preset) const {
    PantographGeometry geometry;
    if (find_preset(preset.utf8(), geometry))
        return describe_geometry(geometry);
    print_error("HapticServer: there is no pantograph preset \"" + preset.utf8() +
                "\". Use ubc_twin_pantograph, pantograph_mk2, haply_2diy_v2 or haply_2diy_v3.");
    return {};
}

Dictionary HapticServer::describe_pantograph(const Dictionary& geometry) const {
    Problems problems;
    Dictionary device;
    device["geometry"] = geometry;
    DictionaryReader reader(device, "", problems);
    const DeviceGeometry read = read_geometry(reader, problems);
    Dictionary out = problems.none() ? derived_figures(read.figures) : Dictionary();
    out["problems"] = problems.to_godot();
    return out;
}

int64_t HapticServer::world_create() {
    const int64_t id = next_world_++;
    worlds_[id] = std::make_unique<HapticWorld>();
    return id;
}

void HapticServer::world_free(int64_t world) {
    if (HapticWorld* w = find(world)) {
        w->stop();
        worlds_.erase(world);
    }
}

PackedStringArray HapticServer::world_configure(int64_t world, const Dictionary& settings) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->configure(settings, problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_set_tool(int64_t world, const Dictionary& tool) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->set_tool(tool, problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_set_device(int64_t world, const Dictionary& device) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->set_device(device, problems);
    return problems.to_godot();
}

PackedStringArray HapticServer::world_set_body(int64_t world, int64_t body, const Dictionary& description) {
    Problems problems;
    if (body <= 0)
        problems.add("Body ids must be positive, got " + std::to_string(body) + ".");
    else if (HapticWorld* w = find(world))
        w->set_body(body, description, problems);
    return problems.to_godot();
}

void HapticServer::world_remove_body(int64_t world, int64_t body) {
    if (HapticWorld* w = find(world))
        w->remove_body(body);
}

PackedStringArray HapticServer::world_start(int64_t world, bool realtime, double record_seconds) {
    Problems problems;
    if (HapticWorld* w = find(world))
        w->start(realtime, record_seconds, problems);
    return problems.to_godot();
}

void HapticServer::world_stop(int64_t world) {
    if (HapticWorld* w = find(world))
        w->stop();
}

PackedFloat64Array HapticServer::world_get_last_force(int64_t world) const {
    const HapticWorld* w = find(world);
    if (w == nullptr || w->running())
        return {};
    const Wrench& force = w->last_force();
    return PackedFloat64Array({force.x(), force.y(), force.z()});
}

bool HapticServer::world_is_running(int64_t world) const {
    const HapticWorld* w = find(world);
    return w != nullptr && w->running();
}

void HapticServer::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_version"), &HapticServer::get_version);
    ClassDB::bind_method(D_METHOD("get_build_info"), &HapticServer::get_build_info);
    ClassDB::bind_method(D_METHOD("get_pantograph_preset", "preset"), &HapticServer::get_pantograph_preset);
    ClassDB::bind_method(D_METHOD("describe_pantograph", "geometry"), &HapticServer::describe_pantograph);
    ClassDB::bind_method(D_METHOD("world_create"), &HapticServer::world_create);
    ClassDB::bind_method(D_METHOD("world_free", "world"), &HapticServer::world_free);
    ClassDB::bind_method(D_METHOD("world_configure", "world", "settings"), &HapticServer::world_configure);
    ClassDB::bind_method(D_METHOD("world_set_tool", "world", "tool"), &HapticServer::world_set_tool);
    ClassDB::bind_method(D_METHOD("world_set_device", "world", "device"), &HapticServer::world_set_device);
    ClassDB::bind_method(D_METHOD("world_set_body", "world", "body", "description"),
                         &HapticServer::world_set_body);
    ClassDB::bind_method(D_METHOD("world_remove_body", "world", "body"), &HapticServer::world_remove_body);
    ClassDB::bind_method(D_METHOD("world_start", "world", "realtime", "record_seconds"),
                         &HapticServer::world_start, DEFVAL(0.0));
    ClassDB::bind_method(D_METHOD("world_stop", "world"), &HapticServer::world_stop);
    ClassDB::bind_method(D_METHOD("world_get_last_force", "world"), &HapticServer::world_get_last_force);
    ClassDB::bind_method(D_METHOD("world_is_running", "world"), &HapticServer::world_is_running);
    ClassDB::bind_method(D_METHOD("world_submit", "world", "bodies", "states", "tick", "gravity", "discs",
                                  "masks", "frame", "most_ticks"),
                         &HapticServer::world_submit);
    ClassDB::bind_method(D_METHOD("world_get_neighborhood", "world"), &HapticServer::world_get_neighborhood);
    ClassDB::bind_method(D_METHOD("world_get_left_out", "world"), &HapticServer::world_get_left_out);
    ClassDB::bind_method(D_METHOD("world_advance", "world", "seconds"), &HapticServer::world_advance);
    ClassDB::bind_method(D_METHOD("world_refresh", "world"), &HapticServer::world_refresh);
    ClassDB::bind_method(D_METHOD("world_get_state", "world"), &HapticServer::world_get_state);
    ClassDB::bind_method(D_METHOD("world_get_contacts", "world"), &HapticServer::world_get_contacts);
    ClassDB::bind_method(D_METHOD("world_get_touched", "world"), &HapticServer::world_get_touched);
    ClassDB::bind_method(D_METHOD("world_take_events", "world"), &HapticServer::world_take_events);
    ClassDB::bind_method(D_METHOD("world_take_impulses", "world"), &HapticServer::world_take_impulses);
    ClassDB::bind_method(D_METHOD("world_get_faults", "world"), &HapticServer::world_get_faults);
    ClassDB::bind_method(D_METHOD("world_book_tick", "world", "seconds"), &HapticServer::world_book_tick);
    ClassDB::bind_method(D_METHOD("world_get_statistics", "world"), &HapticServer::world_get_statistics);
    ClassDB::bind_method(D_METHOD("world_aim", "world", "grip"), &HapticServer::world_aim);
    ClassDB::bind_method(D_METHOD("world_hold", "world", "held"), &HapticServer::world_hold);
    ClassDB::bind_method(D_METHOD("world_place", "world", "placement"), &HapticServer::world_place);
    ClassDB::bind_method(D_METHOD("world_arm", "world", "armed"), &HapticServer::world_arm);
    ClassDB::bind_method(D_METHOD("world_set_paused", "world", "paused"), &HapticServer::world_set_paused);
    ClassDB::bind_method(D_METHOD("world_press_stop", "world"), &HapticServer::world_press_stop);
    ClassDB::bind_method(D_METHOD("world_grab", "world", "link", "point", "pose"), &HapticServer::world_grab);
    ClassDB::bind_method(D_METHOD("world_get_links", "world"), &HapticServer::world_get_links);
    ClassDB::bind_method(D_METHOD("world_start_beside", "world", "host"), &HapticServer::world_start_beside);
    ClassDB::bind_method(D_METHOD("world_tie_body", "world", "body", "linkage", "link"),
                         &HapticServer::world_tie_body);
    ClassDB::bind_method(D_METHOD("world_get_held_link", "world"), &HapticServer::world_get_held_link);
    ClassDB::bind_method(D_METHOD("world_home_device", "world"), &HapticServer::world_home_device);
    ClassDB::bind_method(D_METHOD("world_save_recording", "world", "path"),
                         &HapticServer::world_save_recording);
    ClassDB::bind_method(D_METHOD("world_save_samples", "world", "path", "interval"),
                         &HapticServer::world_save_samples);

    BIND_ENUM_CONSTANT(STATE_STEP);
    BIND_ENUM_CONSTANT(STATE_TIME);
    BIND_ENUM_CONSTANT(STATE_TOOL_X);
    BIND_ENUM_CONSTANT(STATE_TOOL_Y);
    BIND_ENUM_CONSTANT(STATE_TOOL_ANGLE);
    BIND_ENUM_CONSTANT(STATE_GRIP_X);
    BIND_ENUM_CONSTANT(STATE_GRIP_Y);
    BIND_ENUM_CONSTANT(STATE_GRIP_ANGLE);
    BIND_ENUM_CONSTANT(STATE_DEVICE_X);
    BIND_ENUM_CONSTANT(STATE_DEVICE_Y);
    BIND_ENUM_CONSTANT(STATE_DEVICE_ANGLE);
    BIND_ENUM_CONSTANT(STATE_VELOCITY_X);
    BIND_ENUM_CONSTANT(STATE_VELOCITY_Y);
    BIND_ENUM_CONSTANT(STATE_VELOCITY_ANGLE);
    BIND_ENUM_CONSTANT(STATE_FORCE_X);
    BIND_ENUM_CONSTANT(STATE_FORCE_Y);
    BIND_ENUM_CONSTANT(STATE_TORQUE);
    BIND_ENUM_CONSTANT(STATE_CONTACT_FORCE_X);
    BIND_ENUM_CONSTANT(STATE_CONTACT_FORCE_Y);
    BIND_ENUM_CONSTANT(STATE_CONTACT_TORQUE);
    BIND_ENUM_CONSTANT(STATE_CONTACTS);
    BIND_ENUM_CONSTANT(STATE_COLLIDING);
    BIND_ENUM_CONSTANT(STATE_STICKING);
    BIND_ENUM_CONSTANT(STATE_SLIDING);
    BIND_ENUM_CONSTANT(STATE_PENETRATION);
    BIND_ENUM_CONSTANT(STATE_ENERGY_INJECTED);
    BIND_ENUM_CONSTANT(STATE_ARMED);
    BIND_ENUM_CONSTANT(STATE_HELD);
    BIND_ENUM_CONSTANT(STATE_FAULTS);
    BIND_ENUM_CONSTANT(STATE_BUTTONS);
    BIND_ENUM_CONSTANT(STATE_HAND_SHARE);
    BIND_ENUM_CONSTANT(STATE_COUNT);
}

} // namespace haptics
