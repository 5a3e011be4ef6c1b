# Installs a build of clgi aside, then builds and runs the projects of its users against it.
#
#   cmake -DBUILD_DIR=... -DWORK_DIR=... -DGENERATOR=... -DCXX=... -DCXX_FLAGS=...
#         -DCONFIG=... -DLIBDIR=lib -DKERNELS=share/clgi/kernels -DSHARED=ON|OFF
#         -DCOMPONENTS=io,reference -P run.cmake

cmake_minimum_required(VERSION 3.22)
set(here "${CMAKE_CURRENT_LIST_DIR}")
get_filename_component(source "${here}/../.." ABSOLUTE)
string(REPLACE "," ";" components "${COMPONENTS}")

function(run)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result COMMAND_ECHO STDOUT)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "consumer: failed with ${result}")
    endif()
endfunction()

# configure(folder build components): a user's project on the installed clgi. What is tried is whether
# it builds and runs, not its speed: -O0 compiles in half the time.
function(configure folder build wanted)
    string(TOUPPER "${CONFIG}" upper)
    set(flags "")
    if(NOT WIN32 AND NOT CONFIG STREQUAL "Debug")
        set(flags "-DCMAKE_CXX_FLAGS_${upper}=-O0 -DNDEBUG")
    endif()
    run("${CMAKE_COMMAND}" -S "${folder}" -B "${build}" -G "${GENERATOR}"
        "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}"
        "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DCMAKE_BUILD_TYPE=${CONFIG}" ${flags}
        "-DCONSUMER_COMPONENTS=${wanted}" "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY=${build}/bin"
        "-DCMAKE_RUNTIME_OUTPUT_DIRECTORY_${upper}=${build}/bin")
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
set(prefix "${WORK_DIR}/first")
run("${CMAKE_COMMAND}" --install "${BUILD_DIR}" --prefix "${prefix}" --config "${CONFIG}")
# An installed tree may be moved: everything below finds itself.
file(RENAME "${prefix}" "${WORK_DIR}/prefix")
set(prefix "${WORK_DIR}/prefix")

# Nothing installed may point back into the source or build tree.
file(GLOB_RECURSE files "${prefix}/*.cmake" "${prefix}/*.hpp" "${prefix}/*.h" "${prefix}/*.cl"
     "${prefix}/*.pc")
foreach(file IN LISTS files)
    file(READ "${file}" text)
    foreach(tree IN ITEMS "${BUILD_DIR}" "${source}" "${WORK_DIR}/first")
        string(FIND "${text}" "${tree}" found)
        if(NOT found EQUAL -1)
            message(FATAL_ERROR "consumer: ${file} names ${tree}")
        endif()
    endforeach()
endforeach()

# find_package
configure("${here}" "${WORK_DIR}/build" "${COMPONENTS}")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build" --config "${CONFIG}")
run("${WORK_DIR}/build/bin/furnace")
if("io" IN_LIST components AND "reference" IN_LIST components)
    run("${WORK_DIR}/build/bin/truth" "${WORK_DIR}/furnace.glb")
endif()
if("gl" IN_LIST components)
    run("${WORK_DIR}/build/bin/textures")
endif()

# A component that is not there is named, with those that are.
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${here}" -B "${WORK_DIR}/absent" -G "${GENERATOR}"
                        "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX}"
                        -DCONSUMER_COMPONENTS=nosuch
                RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE error)
string(REGEX REPLACE "[ \n]+" " " error "${error}")
if(result EQUAL 0 OR NOT error MATCHES "without the component 'nosuch'; its components are: core")
    message(FATAL_ERROR "consumer: an absent component is not named:\n${error}")
endif()

# An optional component whose dependency is missing leaves the rest found. Shared libraries need none.
if("io" IN_LIST components AND NOT SHARED)
    execute_process(COMMAND "${CMAKE_COMMAND}" -S "${here}" -B "${WORK_DIR}/optional"
                            -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
                            "-DCMAKE_CXX_COMPILER=${CXX}" -DCONSUMER_COMPONENTS=
                            -DCONSUMER_OPTIONAL=io,nosuch -DCMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON
                    RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE error)
    if(NOT result EQUAL 0 OR NOT said MATCHES "optional components: io FALSE, nosuch FALSE,")
        message(FATAL_ERROR "consumer: optional components that cannot be had:\n${said}${error}")
    endif()
endif()

# pkg-config
find_program(pkg_config pkg-config REQUIRED)
set(static "--static")
set(ENV{LD_LIBRARY_PATH} "")
if(SHARED)
    set(static "")
    set(ENV{LD_LIBRARY_PATH} "${prefix}/${LIBDIR}")
endif()
set(ENV{PKG_CONFIG_PATH} "${prefix}/${LIBDIR}/pkgconfig")
run(sh "${here}/pkgconfig.sh" "${CXX} ${CXX_FLAGS}" "${here}/furnace.cpp"
    "${WORK_DIR}/furnace_pc" clgi ${static})
run("${WORK_DIR}/furnace_pc")
if("io" IN_LIST components AND "reference" IN_LIST components)
    run(sh "${here}/pkgconfig.sh" "${CXX} ${CXX_FLAGS}" "${here}/truth.cpp"
        "${WORK_DIR}/truth_pc" "clgi-io clgi-reference" ${static})
    run("${WORK_DIR}/truth_pc" "${WORK_DIR}/furnace_pc.glb")
endif()

# The samples, and the kernels alone: they give the library's bits.
configure("${source}/samples" "${WORK_DIR}/samples" "")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/samples" --config "${CONFIG}")
execute_process(COMMAND "${WORK_DIR}/build/bin/same_bits" "${WORK_DIR}/library.pfm"
                RESULT_VARIABLE result OUTPUT_VARIABLE said COMMAND_ECHO STDOUT ECHO_OUTPUT_VARIABLE)
if(NOT result EQUAL 0 OR NOT said MATCHES "on device ([0-9]+)")
    message(FATAL_ERROR "consumer: same_bits failed with ${result}")
endif()
run("${WORK_DIR}/samples/bin/raw_kernels" "${prefix}/${KERNELS}" "${WORK_DIR}/raw.pfm"
    "${CMAKE_MATCH_1}")
run("${CMAKE_COMMAND}" -E compare_files "${WORK_DIR}/raw.pfm" "${WORK_DIR}/library.pfm")
if("io" IN_LIST components)
    run("${CMAKE_COMMAND}" -E chdir "${WORK_DIR}" "${WORK_DIR}/samples/bin/hello_clgi")
    run("${CMAKE_COMMAND}" -E chdir "${WORK_DIR}" "${WORK_DIR}/samples/bin/planned_clgi")
    foreach(sample IN ITEMS hello planned)
        if(NOT EXISTS "${WORK_DIR}/${sample}.exr")
            message(FATAL_ERROR "consumer: ${sample}_clgi wrote no picture")
        endif()
    endforeach()
endif()
if(EXISTS "${prefix}/bin/clgi")
    run("${prefix}/bin/clgi" --version)
endif()

# Debian packages, where their tools are.
find_program(cpack cpack)
find_program(dpkg_deb dpkg-deb)
find_program(shlibdeps dpkg-shlibdeps)
if(NOT cpack OR NOT dpkg_deb OR NOT shlibdeps)
    message(STATUS "consumer: no cpack, dpkg-deb or dpkg-shlibdeps here; no package was made")
    return()
endif()
run("${cpack}" -G DEB --config "${BUILD_DIR}/CPackConfig.cmake" -C "${CONFIG}" -B "${WORK_DIR}/deb")
file(GLOB packages "${WORK_DIR}/deb/*.deb")
set(listed "")
foreach(package IN LISTS packages)
    execute_process(COMMAND "${dpkg_deb}" --info "${package}" OUTPUT_VARIABLE info)
    execute_process(COMMAND "${dpkg_deb}" --contents "${package}" OUTPUT_VARIABLE contents)
    message(STATUS "${package}\n${info}${contents}")
    string(APPEND listed "${info}${contents}")
endforeach()
set(wanted "/usr/include/clgi/clgi.hpp" "/usr/${LIBDIR}/cmake/clgi/clgiConfig.cmake"
    "/usr/${LIBDIR}/pkgconfig/clgi.pc" "/usr/${KERNELS}/image/gather.cl" "Package: libclgi-dev")
if(SHARED)
    list(APPEND wanted "/usr/${LIBDIR}/libclgi.so.0" "Package: clgi\n" "ocl-icd-libopencl1")
endif()
foreach(text IN LISTS wanted)
    string(FIND "${listed}" "${text}" found)
    if(found EQUAL -1)
        message(FATAL_ERROR "consumer: the packages are without ${text}")
    endif()
endforeach()
