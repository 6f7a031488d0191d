# Puts class reference pages (the engine's class XML) into a library, so that the editor shows them without a file.
# haptics_embed_class_reference(TARGET FOLDER) defines what class_reference.hpp declares.
# Run as a script it writes that source: cmake -DPAGES=a.xml,b.xml -DTO=out.cpp -P embed_class_reference.cmake

if(CMAKE_SCRIPT_MODE_FILE)
    string(REPLACE "," ";" pages "${PAGES}")
    set(literals "")
    foreach(page IN LISTS pages)
        file(READ "${page}" text)
        string(APPEND literals "    R\"class_xml(${text})class_xml\",\n")
    endforeach()
    file(WRITE "${TO}" "#include \"class_reference.hpp\"\n\nnamespace haptics {\n\nnamespace {\n"
        "constexpr std::string_view k_pages[] = {\n${literals}};\n} // namespace\n\n"
        "std::span<const std::string_view> class_reference_pages() {\n    return k_pages;\n}\n\n} // namespace haptics\n")
    return()
endif()

set(HAPTICS_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

function(haptics_embed_class_reference target folder)
    file(GLOB pages CONFIGURE_DEPENDS "${folder}/*.xml")
    string(REPLACE ";" "," joined "${pages}")
    set(source "${CMAKE_CURRENT_BINARY_DIR}/class_reference.cpp")
    add_custom_command(OUTPUT "${source}"
        COMMAND "${CMAKE_COMMAND}" "-DPAGES=${joined}" "-DTO=${source}" -P "${HAPTICS_EMBED_SCRIPT}"
        DEPENDS ${pages} "${HAPTICS_EMBED_SCRIPT}" COMMENT "Embedding the class reference" VERBATIM)
    target_sources(${target} PRIVATE "${source}")
endfunction()
