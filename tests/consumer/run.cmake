# Installs a build of clgi aside, then builds and runs the project in this folder against it.
#
#   cmake -DBUILD_DIR=... -DWORK_DIR=... -DGENERATOR=... -DCXX=... -DCXX_FLAGS=... -DCONFIG=...
#         -DKERNELS=share/clgi/kernels -P run.cmake

cmake_minimum_required(VERSION 3.22)

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result COMMAND_ECHO STDOUT)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "consumer: failed with ${result}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
set(build "${WORK_DIR}/build")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${prefix}" --config "${CONFIG}")

# Nothing installed may point back into the source or build tree.
file(GLOB_RECURSE files "${prefix}/*.cmake" "${prefix}/*.hpp" "${prefix}/*.h" "${prefix}/*.cl")
foreach(file IN LISTS files)
    file(READ "${file}" text)
    foreach(tree IN ITEMS "${BUILD_DIR}" "${CMAKE_CURRENT_LIST_DIR}")
        string(FIND "${text}" "${tree}" found)
        if(NOT found EQUAL -1)
            message(FATAL_ERROR "consumer: ${file} names ${tree}")
        endif()
    endforeach()
endforeach()

string(TOUPPER "${CONFIG}" upper)
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${build}" -G "${GENERATOR}"
    "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
    "-DCMAKE_BUILD_TYPE=${CONFIG}" "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${build}/bin"
    "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY_${upper}=${build}/bin")
run("${CMAKE_COMMAND}" --build "${build}" --config "${CONFIG}")
run("${build}/bin/furnace" "${WORK_DIR}/furnace.glb")
run("${build}/bin/raw_kernel" "${prefix}/${KERNELS}/image/tonemap.cl")
if(EXISTS "${build}/bin/textures")
    run("${build}/bin/textures")
endif()
run("${prefix}/bin/clgi" --version)
