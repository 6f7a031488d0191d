# How every room is compiled. Third-party headers are SYSTEM includes and escape the warnings.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(HAPTICS_OPTIMIZATION "-O3" CACHE STRING "Of C++ in the Release configuration")
set(CMAKE_CXX_FLAGS_RELEASE "${HAPTICS_OPTIMIZATION} -DNDEBUG")
# for the sanitizers: -g1 is enough for the lines of a stack
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 -fno-omit-frame-pointer")
set(CMAKE_CXX_FLAGS_DEBUG "-O0 -g")
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1 -fno-omit-frame-pointer")
set(CMAKE_C_FLAGS_DEBUG "-O0 -g")

set(HAPTICS_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize=")

option(HAPTICS_USE_CCACHE "Compile through ccache where it is installed" ON)
if(HAPTICS_USE_CCACHE)
    find_program(HAPTICS_CCACHE ccache)
endif()
if(HAPTICS_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${HAPTICS_CCACHE}")
    set(CMAKE_C_COMPILER_LAUNCHER "${HAPTICS_CCACHE}")
endif()

# A compiler cache knows precompiled headers and joined sources badly, and makes them needless.
option(HAPTICS_PCH "Precompile the headers of the libraries: two seconds less for each of some two hundred files" ON)
option(HAPTICS_UNITY "Compile the sources of a room sixteen at a time: less than half the work from nothing, more after a change" ON)
if(HAPTICS_CCACHE OR CMAKE_CXX_COMPILER_LAUNCHER)
    set(HAPTICS_PCH OFF)
    set(HAPTICS_UNITY OFF)
endif()

add_library(haptics_options INTERFACE)
target_compile_options(haptics_options INTERFACE
    -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wdouble-promotion -Wnon-virtual-dtor
    -Woverloaded-virtual -Wold-style-cast -Wcast-align -Wunused -Wformat=2 -Wimplicit-fallthrough
    # what a designated initializer leaves out is zero by the language's own rule
    -Wno-missing-field-initializers
    # the same bits from every build and compiler: no fused multiply-add behind our back
    -ffp-contract=off
    # messages name our files from the root of the project
    "-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # a unique symbol would keep the library mapped, and the editor would run the old code after a reload
    target_compile_options(haptics_options INTERFACE -fno-gnu-unique -Wduplicated-cond -Wlogical-op)
    if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        # false alarms on string concatenation (gcc bug 105651)
        target_compile_options(haptics_options INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)
    endif()
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(haptics_options INTERFACE -march=x86-64)
endif()
if(HAPTICS_SANITIZE)
    target_compile_options(haptics_options INTERFACE -fsanitize=${HAPTICS_SANITIZE} -fno-sanitize-recover=all)
    target_link_options(haptics_options INTERFACE -fsanitize=${HAPTICS_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # gcc's own manual: with sanitizers its flow analysis warns of what is not so; the plain builds stop at it
        target_compile_options(haptics_options INTERFACE -Wno-maybe-uninitialized)
    endif()
    if(HAPTICS_SANITIZE MATCHES "address.*undefined")
        # Each of these asks at every access and together they double the compile time, for which CI has no room. The address
        # checks stop most of what they look for; a misaligned access that the processor bears is not seen.
        target_compile_options(haptics_options INTERFACE -fno-sanitize=alignment,null,object-size,pointer-overflow,vptr)
    endif()
endif()

# C is for what runs without an operating system (firmware/) and for what has to stand between a program and the C library
add_library(haptics_c_options INTERFACE)
target_compile_options(haptics_c_options INTERFACE
    -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wsign-conversion -Wcast-align -Wcast-qual -Wstrict-prototypes
    -Wmissing-prototypes -Wundef -Wvla -Wformat=2 -Wimplicit-fallthrough "-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")
if(HAPTICS_SANITIZE)
    target_compile_options(haptics_c_options INTERFACE -fsanitize=${HAPTICS_SANITIZE} -fno-sanitize-recover=all)
endif()
