# Builds the library alone, shared or static as SHARED says, and has run.cmake try it. Arguments as
# there, without BUILD_DIR and COMPONENTS.

cmake_minimum_required(VERSION 3.22)
get_filename_component(source "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
set(build "${WORK_DIR}/library")

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result COMMAND_ECHO STDOUT)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "consumer: failed with ${result}")
    endif()
endfunction()

# What is tried is what it installs, shows and links, not its speed: -O0 compiles in half the time.
string(TOUPPER "${CONFIG}" upper)
set(flags "")
if(NOT WIN32 AND NOT CONFIG STREQUAL "Debug")
    set(flags "-DCMAKE_CXX_FLAGS_${upper}=-O0 -DNDEBUG")
endif()
run("${CMAKE_COMMAND}" -S "${source}" -B "${build}" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DCMAKE_BUILD_TYPE=${CONFIG}" ${flags}
    "-DBUILD_SHARED_LIBS=${SHARED}" -DCLGI_IO=OFF -DCLGI_GL=OFF -DCLGI_MESH=OFF -DCLGI_REFERENCE=OFF)
run("${CMAKE_COMMAND}" --build "${build}" --config "${CONFIG}" --parallel 2)
if(SHARED)
    # Users see what the headers promise and nothing of what is inside.
    find_program(nm nm REQUIRED)
    execute_process(COMMAND "${nm}" -DC --defined-only "${build}/libclgi.so" OUTPUT_VARIABLE symbols)
    foreach(inside IN ITEMS "clgi::build_room" "clgi::second_order::" "clgi::embedded_files")
        string(FIND "${symbols}" "${inside}" found)
        if(NOT found EQUAL -1)
            message(FATAL_ERROR "consumer: libclgi.so shows ${inside}")
        endif()
    endforeach()
    string(FIND "${symbols}" "clgi::choose_device" found)
    if(found EQUAL -1)
        message(FATAL_ERROR "consumer: libclgi.so does not show clgi::choose_device")
    endif()
endif()
set(BUILD_DIR "${build}")
set(WORK_DIR "${WORK_DIR}/user")
set(COMPONENTS "")
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")
