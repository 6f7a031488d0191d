# Puts the built library into the addon under a temporary name and renames it: writing over a file that a running editor
# has mapped would crash that editor.
cmake_path(GET FROM FILENAME name)
if(EXISTS "${TO}/${name}")
    execute_process(COMMAND "${CMAKE_COMMAND}" -E compare_files "${FROM}" "${TO}/${name}" RESULT_VARIABLE differs ERROR_QUIET)
else()
    set(differs 1)
endif()
if(differs)
    file(MAKE_DIRECTORY "${TO}")
    file(COPY_FILE "${FROM}" "${TO}/${name}.new")
    file(RENAME "${TO}/${name}.new" "${TO}/${name}")
    message(STATUS "${TO}/${name} is new")
endif()
