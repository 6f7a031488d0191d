#pragma once

#include <haptics/binder/godot.hpp>
#include <haptics/classes/haptic_world.hpp>

#include <map>
#include <memory>

namespace haptics {

/// The singleton through which scripts reach everything native, as Godot's own servers are reached: a plain
/// Object that hands out ids. Everything is SI, y up, relative to the world; main thread only. The class
/// reference is native/godot/doc/HapticServer.xml.
class HapticServer : public godot::Object {
    GDCLASS(HapticServer, godot::Object)

  public:
    HapticServer();
    ~HapticServer() override;

    /// Null before scene level and after it. After a hot reload it is null until the engine has made the new
    /// C++ side.
    static HapticServer* get_singleton();
    /// Stops every world and its thread: before the library goes.
    static void stop_all();

    /// Version of the library, as "0.1.0".
    godot::String get_version() const;
    /// What was built and what runs it: version, build_type, compiler, architecture, godot_version.
    godot::Dictionary get_build_info() const;

    /// All figures of a pantograph that exists; empty, after an error, when there is none of that name.
    godot::Dictionary get_pantograph_preset(const godot::String& preset) const;
    /// What is wrong with the figures of a pantograph, and what follows from them.
    godot::Dictionary describe_pantograph(const godot::Dictionary& geometry) const;

    /// Indices into world_get_state().
    enum State {
        STATE_STEP,
        STATE_TIME,
        STATE_TOOL_X,
        STATE_TOOL_Y,
        STATE_TOOL_ANGLE,
        STATE_GRIP_X,
        STATE_GRIP_Y,
        STATE_GRIP_ANGLE,
        STATE_DEVICE_X,
        STATE_DEVICE_Y,
        STATE_DEVICE_ANGLE,
        STATE_VELOCITY_X,
        STATE_VELOCITY_Y,
        STATE_VELOCITY_ANGLE,
        STATE_FORCE_X,
        STATE_FORCE_Y,
        STATE_TORQUE,
        STATE_CONTACT_FORCE_X,
        STATE_CONTACT_FORCE_Y,
        STATE_CONTACT_TORQUE,
        STATE_CONTACTS,
        STATE_COLLIDING,
        STATE_STICKING,
        STATE_SLIDING,
        STATE_PENETRATION,
        STATE_ENERGY_INJECTED,
        STATE_ARMED,
        STATE_HELD,
        STATE_FAULTS,
        STATE_BUTTONS,
        STATE_HAND_SHARE,
        STATE_COUNT,
    };

    int64_t world_create();
    void world_free(int64_t world);
    godot::PackedStringArray world_configure(int64_t world, const godot::Dictionary& settings);
    godot::PackedStringArray world_set_tool(int64_t world, const godot::Dictionary& tool);
    godot::PackedStringArray world_set_device(int64_t world, const godot::Dictionary& device);
    godot::PackedStringArray world_set_body(int64_t world, int64_t body,
                                            const godot::Dictionary& description);
    void world_remove_body(int64_t world, int64_t body);
    godot::PackedStringArray world_start(int64_t world, bool realtime, double record_seconds);
    void world_stop(int64_t world);
    godot::PackedFloat64Array world_get_last_force(int64_t world) const;
    bool world_is_running(int64_t world) const;
    godot::PackedStringArray world_submit(int64_t world, const godot::PackedInt64Array& bodies,
                                          const godot::PackedFloat64Array& states, double tick,
                                          const godot::PackedFloat64Array& gravity,
                                          const godot::PackedFloat64Array& discs,
                                          const godot::PackedInt64Array& masks, int64_t frame,
                                          int64_t most_ticks);
    godot::Array world_get_neighborhood(int64_t world) const;
    int64_t world_get_left_out(int64_t world) const;
    int64_t world_advance(int64_t world, double seconds);
    void world_refresh(int64_t world);
    godot::PackedFloat64Array world_get_state(int64_t world) const;
    godot::Array world_get_contacts(int64_t world) const;
    godot::PackedInt64Array world_get_touched(int64_t world) const;
    godot::Array world_take_events(int64_t world);
    godot::PackedFloat64Array world_take_impulses(int64_t world);
    godot::PackedStringArray world_get_faults(int64_t world) const;
    void world_book_tick(int64_t world, double seconds);
    godot::Dictionary world_get_statistics(int64_t world) const;
    void world_aim(int64_t world, const godot::PackedFloat64Array& grip);
    void world_hold(int64_t world, bool held);
    godot::PackedStringArray world_place(int64_t world, const godot::Dictionary& placement);
    void world_arm(int64_t world, bool armed);
    void world_set_paused(int64_t world, bool paused);
    void world_press_stop(int64_t world);
    godot::PackedStringArray world_grab(int64_t world, int64_t link, const godot::PackedFloat64Array& point,
                                        bool pose);
    godot::PackedFloat64Array world_get_links(int64_t world) const;
    int64_t world_get_held_link(int64_t world) const;
    godot::PackedStringArray world_start_beside(int64_t world, int64_t host);
    godot::PackedStringArray world_tie_body(int64_t world, int64_t body, int64_t linkage, int64_t link);
    godot::PackedStringArray world_home_device(int64_t world);
    godot::PackedStringArray world_save_recording(int64_t world, const godot::String& path);
    godot::PackedStringArray world_save_samples(int64_t world, const godot::String& path, double interval);

  protected:
    static void _bind_methods();

  private:
    HapticWorld* find(int64_t world) const;

    static inline HapticServer* singleton_ = nullptr;
    std::map<int64_t, std::unique_ptr<HapticWorld>> worlds_;
    int64_t next_world_ = 1;
};

} // namespace haptics

VARIANT_ENUM_CAST(haptics::HapticServer::State)
