# Third-party libraries as targets haptics_eigen, haptics_doctest, haptics_benchmark, haptics_hidapi: the system's where it is
# new enough, else a private copy that tools/setup/provide fetches at configure time. Each private copy is in a
# folder of its own, so that a room which may use one does not see the others.

# minimum versions come from the one file that has them all
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/tools/setup/versions.env")
file(STRINGS "${CMAKE_SOURCE_DIR}/tools/setup/versions.env" lines REGEX "^[A-Z]+_MINIMUM=")
foreach(line IN LISTS lines)
    string(REGEX MATCH "^([A-Z]+)_MINIMUM=(.*)$" matched "${line}")
    set(HAPTICS_MINIMUM_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
endforeach()

# haptics_provide(COMPONENT OUT): the folder of a private copy, fetched when it is not there yet
function(haptics_provide component out)
    execute_process(COMMAND "${CMAKE_SOURCE_DIR}/tools/setup/provide" ${component}
        OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    if(failed)
        message(FATAL_ERROR "'${component}' is missing and could not be set up; the messages above say what to do.")
    endif()
    set(${out} "${prefix}" PARENT_SCOPE)
endfunction()

# haptics_package(COMPONENT PACKAGE TARGET): haptics_COMPONENT from the CMake package of that name
function(haptics_package component package target)
    string(TOUPPER ${component} upper)
    set(minimum "${HAPTICS_MINIMUM_${upper}}")
    find_package(${package} CONFIG QUIET GLOBAL)
    if(NOT ${package}_FOUND OR ${package}_VERSION VERSION_LESS minimum)
        haptics_provide(${component} prefix)
        # kept: the next configure finds the package at once and does not come here
        set(HAPTICS_PREFIX_${component} "${prefix}" CACHE INTERNAL "")
        unset(${package}_DIR CACHE)
        find_package(${package} CONFIG REQUIRED GLOBAL PATHS "${prefix}/usr" NO_DEFAULT_PATH)
        if(${package}_VERSION VERSION_LESS minimum)
            message(FATAL_ERROR "${package} ${${package}_VERSION} in ${prefix} is older than ${minimum}; "
                "install a newer one and name it in CMAKE_PREFIX_PATH.")
        endif()
    endif()
    message(STATUS "${package} ${${package}_VERSION} in ${${package}_DIR}")
    add_library(haptics_${component} INTERFACE)
    if(HAPTICS_PREFIX_${component})
        # some packages count on /usr/include being searched
        target_include_directories(haptics_${component} SYSTEM INTERFACE "${HAPTICS_PREFIX_${component}}/usr/include")
    endif()
    target_link_libraries(haptics_${component} INTERFACE ${target})
endfunction()

find_package(Threads REQUIRED)
haptics_package(eigen Eigen3 Eigen3::Eigen)
# the part of Eigen under another licence stays out
target_compile_definitions(haptics_eigen INTERFACE EIGEN_MPL2_ONLY)
if(HAPTICS_TESTS)
    haptics_package(doctest doctest doctest::doctest)
endif()
if(HAPTICS_BENCH)
    haptics_package(benchmark benchmark benchmark::benchmark)
    include(peers)
endif()

# only its header: the library is opened at run time. Not asked for until a room includes it.
file(GLOB_RECURSE hid_sources CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/native/devices/hid/*.cpp")
if(hid_sources)
    find_path(HAPTICS_HIDAPI_INCLUDE hidapi/hidapi.h)
    if(NOT HAPTICS_HIDAPI_INCLUDE)
        haptics_provide(hidapi prefix)
        find_path(HAPTICS_HIDAPI_INCLUDE hidapi/hidapi.h PATHS "${prefix}/usr/include" NO_DEFAULT_PATH REQUIRED)
    endif()
    add_library(haptics_hidapi INTERFACE)
    if(NOT HAPTICS_HIDAPI_INCLUDE STREQUAL "/usr/include")
        target_include_directories(haptics_hidapi SYSTEM INTERFACE "${HAPTICS_HIDAPI_INCLUDE}")
    endif()
endif()
