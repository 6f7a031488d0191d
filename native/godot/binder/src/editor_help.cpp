#include <haptics/binder/editor_help.hpp>
#include <haptics/binder/interface.hpp>

#include <cstdint>

namespace haptics::godot {

void load_editor_help(std::string_view xml) {
    internal::api.editor_help_load_xml_from_utf8_chars_and_len(xml.data(), static_cast<int64_t>(xml.size()));
}

} // namespace haptics::godot
