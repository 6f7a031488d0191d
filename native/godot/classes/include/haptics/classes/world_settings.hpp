#pragma once
/// From the Dictionaries of the server's methods to the core's structures. Every problem is named.

#include <haptics/classes/dictionary_reader.hpp>
#include <haptics/core/control/session.hpp>
#include <haptics/core/local_model/model.hpp>
#include <haptics/devices/hid/hid_pantograph.hpp>
#include <haptics/devices/simulated/simulated_pantograph.hpp>

#include <variant>

namespace haptics {

/// How the loop runs.
struct LoopSettings {
    double rate_hz{1000.0};
    int priority{80};
    /// CPU to stay on; -1: any.
    int cpu{-1};
};

/// What world_configure() sets.
struct WorldSettings {
    LoopSettings loop;
    SessionSettings session;
    LocalModelSettings model;
    SafetyLimits safety;
    /// Every stage runs, whether it has something to do or not: to see what the plan saves.
    bool whole_scene{false};
};

/// Clutch, mapping and turn; keys mapping_scale, mapping_rotation, mapping_offset, clutched, turn.
HandPlacement read_placement(const godot::Dictionary& from, Problems& problems);

WorldSettings read_world_settings(const godot::Dictionary& from, Problems& problems);

/// A surface; keys stiffness, damping, static_friction, dynamic_friction, restitution.
Surface read_surface(const godot::Dictionary& from, const std::string& place, const Surface& fallback,
                     Problems& problems);

/// A device of any kind, and what the loop does for it.
struct DeviceOptions {
    std::variant<SimulatedPantographOptions, HidPantographOptions> device;
    DeviceCareSettings care;
};

/// The device that the key `kind` names: simulated_pantograph (the default) or hid_pantograph.
DeviceOptions read_device(const godot::Dictionary& from, Problems& problems);

} // namespace haptics
