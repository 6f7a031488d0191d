# The second compiler: a clang++ of the system, else a private one.
if(NOT DEFINED CMAKE_CXX_COMPILER)
    execute_process(COMMAND "${CMAKE_CURRENT_LIST_DIR}/../tools/setup/provide" clang
        OUTPUT_VARIABLE clang OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    if(failed)
        message(FATAL_ERROR "no clang++ here and none could be set up; the messages above say what to do.")
    endif()
    set(CMAKE_CXX_COMPILER "${clang}" CACHE FILEPATH "clang++")
endif()
