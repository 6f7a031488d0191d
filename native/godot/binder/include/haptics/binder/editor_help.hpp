/// Class reference pages in the editor.
#pragma once

#include <string_view>

namespace haptics::godot {

/// Loads one class reference page (the engine's class XML). Only at editor level or later, in the editor
/// process.
void load_editor_help(std::string_view xml);

} // namespace haptics::godot
