# haptics_gdextension_header: Godot's C interface header, written by the engine in use. Asked at every build, written only
# when the engine changes. All presets share it.
set(header_folder "${CMAKE_SOURCE_DIR}/build/gdextension")
set(header "${header_folder}/gdextension_interface.h")

add_custom_target(haptics_gdextension_dump
    COMMAND "${CMAKE_SOURCE_DIR}/tools/setup/dump_gdextension_header" "${header_folder}"
    BYPRODUCTS "${header}"
    COMMENT "Asking Godot for its C interface header" VERBATIM)

add_library(haptics_gdextension_header INTERFACE)
target_include_directories(haptics_gdextension_header SYSTEM INTERFACE "${header_folder}")
add_dependencies(haptics_gdextension_header haptics_gdextension_dump)
