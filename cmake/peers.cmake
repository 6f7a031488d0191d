# Other engines as targets haptics_mujoco, haptics_pinocchio and haptics_box2d, for the benchmarks alone: each is fetched by
# tools/setup/provide when CMake configures. One that cannot be had is left out; why is in HAPTICS_PEER_<ENGINE>_MISSING,
# in a warning here, and in the table of the benchmarks.

set(HAPTICS_PEERS "mujoco;pinocchio;box2d" CACHE STRING "Engines to compare with")
set(HAPTICS_PEERS_KNOWN mujoco pinocchio box2d)

# haptics_peer_folder(ENGINE OUT): the folder that has it, empty when there is none
function(haptics_peer_folder engine out)
    string(TOUPPER ${engine} upper)
    set(${out} "" PARENT_SCOPE)
    if(NOT engine IN_LIST HAPTICS_PEERS)
        set(HAPTICS_PEER_${upper}_MISSING "left out of HAPTICS_PEERS when the build was configured" PARENT_SCOPE)
        return()
    endif()
    message(STATUS "peer ${engine}: setting it up")
    execute_process(COMMAND "${CMAKE_SOURCE_DIR}/tools/setup/provide" ${engine}
        OUTPUT_VARIABLE folder ERROR_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    if(NOT failed)
        set(${out} "${folder}" PARENT_SCOPE)
        return()
    endif()
    string(REGEX MATCH "\\[set-up\\] error: ([^\n]*)" matched "${said}")
    if(matched)
        set(reason "${CMAKE_MATCH_1}")
    else()
        set(reason "tools/setup/provide ${engine} ended with ${failed}")
    endif()
    string(REPLACE "\"" "'" reason "${reason}")
    set(HAPTICS_PEER_${upper}_MISSING "${reason}" PARENT_SCOPE)
    message(WARNING "peer ${engine} is missing, and the benchmarks go on without it. Set-up said:\n${said}")
endfunction()

# haptics_peer_library(ENGINE LIBRARY INCLUDE): haptics_ENGINE from a shared library and its headers
function(haptics_peer_library engine library include)
    add_library(haptics_${engine}_library SHARED IMPORTED GLOBAL)
    set_target_properties(haptics_${engine}_library PROPERTIES IMPORTED_LOCATION "${library}")
    add_library(haptics_${engine} INTERFACE)
    target_include_directories(haptics_${engine} SYSTEM INTERFACE "${include}")
    target_link_libraries(haptics_${engine} INTERFACE haptics_${engine}_library)
endfunction()

haptics_peer_folder(mujoco folder)
if(folder)
    file(GLOB library "${folder}/mujoco/libmujoco.so*")
    haptics_peer_library(mujoco "${library}" "${folder}/mujoco/include")
endif()

haptics_peer_folder(box2d folder)
if(folder)
    file(GLOB library "${folder}/usr/lib/*/libbox2d.so.2")
    haptics_peer_library(box2d "${library}" "${folder}/usr/include")
endif()

haptics_peer_folder(pinocchio folder)
if(folder)
    # templates on double, compiled here; its own package asks for these definitions
    add_library(haptics_pinocchio INTERFACE)
    target_include_directories(haptics_pinocchio SYSTEM INTERFACE "${folder}/cmeel.prefix/include")
    target_compile_definitions(haptics_pinocchio INTERFACE BOOST_MPL_LIMIT_LIST_SIZE=30 BOOST_MPL_LIMIT_VECTOR_SIZE=30
        BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS BOOST_FUSION_INVOKE_MAX_ARITY=12)
endif()

# what tools/run/bench reads: a peer that was missing is asked for again at the next run
set(missing "")
foreach(engine IN LISTS HAPTICS_PEERS_KNOWN)
    string(TOUPPER ${engine} upper)
    if(HAPTICS_PEER_${upper}_MISSING AND engine IN_LIST HAPTICS_PEERS)
        string(APPEND missing "${engine}: ${HAPTICS_PEER_${upper}_MISSING}\n")
    endif()
endforeach()
file(WRITE "${CMAKE_BINARY_DIR}/missing_peers.txt" "${missing}")
