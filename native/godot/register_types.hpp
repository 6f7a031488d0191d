#pragma once

#include <haptics/binder/extension_binding.hpp>

namespace haptics {

/// Registers what the library has at each level of the engine's start: classes at scene level, the class
/// reference at editor level.
void initialize_haptics(godot::ModuleInitializationLevel level);

/// Undoes it, level by level in reverse; the classes themselves are unregistered by the binder.
void terminate_haptics(godot::ModuleInitializationLevel level);

} // namespace haptics
