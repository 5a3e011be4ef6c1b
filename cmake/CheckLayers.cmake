# Checks who includes whom, and what every source file owes its reader (docs/architecture.md).
#
#   cmake -DSOURCE_DIR=... -P CheckLayers.cmake

cmake_minimum_required(VERSION 3.22)
set(faults "")

function(fault text)
    set(faults "${faults}\n  ${text}" PARENT_SCOPE)
endfunction()

# The names in a file's #include lines, as a list.
function(read_includes path)
    file(READ "${path}" text)
    string(REGEX MATCHALL "(^|\n)[ \t]*#[ \t]*include[ \t]*[<\"][^>\"\n]+" lines "${text}")
    set(names "")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE ".*[<\"]" "" name "${line}")
        list(APPEND names "${name}")
    endforeach()
    set(includes "${names}" PARENT_SCOPE)
endfunction()

# forbid(pattern reason glob...): no file that matches a glob includes what matches pattern.
macro(forbid pattern reason)
    set(paths "")
    foreach(glob IN ITEMS ${ARGN})
        if(glob MATCHES "\\*")
            file(GLOB_RECURSE found RELATIVE "${SOURCE_DIR}" "${glob}")
        else()  # one file, not all of that name
            file(RELATIVE_PATH found "${SOURCE_DIR}" "${glob}")
        endif()
        list(APPEND paths ${found})
    endforeach()
    foreach(path IN LISTS paths)
        read_includes("${SOURCE_DIR}/${path}")
        foreach(name IN LISTS includes)
            if(name MATCHES "${pattern}")
                fault("${path} includes ${name}: ${reason}")
            endif()
        endforeach()
    endforeach()
endmacro()

# ---- what the library is made of --------------------------------------------------------------
set(library "")
foreach(room IN ITEMS opencl parallel scene gbuffer lights image vpl atlas antiradiance transfer plan kit solvers)
    list(APPEND library "${SOURCE_DIR}/host/${room}/*.?pp")
endforeach()
set(public "${SOURCE_DIR}/include/clgi/*.hpp" "${SOURCE_DIR}/include/clgi/*.h")
set(core ${library} "${SOURCE_DIR}/include/clgi/shared/*.h")
foreach(folder IN ITEMS passes kit solvers plan)
    list(APPEND core "${SOURCE_DIR}/include/clgi/${folder}/*.hpp")
endforeach()
file(GLOB top RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/include/clgi/*.hpp")
list(TRANSFORM top PREPEND "${SOURCE_DIR}/")
list(APPEND core ${top})

forbid("^(clgi/)?(io|cli|report|reference|gl|mesh)/" "the library knows no files, program or window"
       ${core})
forbid("tiny_gltf|^stb_image|OpenEXR/|^Im(f|ath)|^png\\.h|nlohmann/|embree|^meshoptimizer|^(GL|EGL|GLES|GLFW|epoxy)/|^CLI/|^fmt/"
       "the library stands on OpenCL and GLM alone" ${public} ${library})

# A header without a library to it, compiled into one file.
file(GLOB packless "${SOURCE_DIR}/host/*/*.?pp")
list(REMOVE_ITEM packless "${SOURCE_DIR}/host/atlas/pack.cpp")
forbid("stb_rect_pack" "only the atlas packs, in host/atlas/pack.cpp" ${public} ${packless})

forbid("tiny_gltf" "glTF is io's business" "${SOURCE_DIR}/host/cli/*" "${SOURCE_DIR}/host/report/*"
       "${SOURCE_DIR}/host/reference/*" "${SOURCE_DIR}/host/gl/*")

# OpenGL: the library below it, OpenGL itself through epoxy alone, and nobody but the program above.
set(gl "${SOURCE_DIR}/host/gl/*.?pp" "${SOURCE_DIR}/include/clgi/gl/*.hpp")
forbid("^(clgi/)?(io|cli|report|reference)/|^clgi/reference\\.hpp|^(OpenEXR|nlohmann|CLI|fmt)/|^png\\.h"
       "gl stands on the library alone" ${gl})
forbid("^(GL|EGL|GLES[0-9]?|GLFW|X11)/" "OpenGL and EGL are seen through epoxy" ${gl})
forbid("^(clgi/)?gl/|^epoxy/" "only the program uses gl"
       "${SOURCE_DIR}/host/io/*" "${SOURCE_DIR}/host/report/*" "${SOURCE_DIR}/host/reference/*")

# Meshes: the library below, and meshoptimizer nowhere else.
forbid("^(clgi/)?(io|cli|report|reference|gl)/|^clgi/reference\\.hpp" "mesh stands on the library alone"
       "${SOURCE_DIR}/host/mesh/*" "${SOURCE_DIR}/include/clgi/mesh/*.hpp")
forbid("^meshoptimizer" "meshoptimizer is mesh's business" "${SOURCE_DIR}/host/io/*"
       "${SOURCE_DIR}/host/gl/*" "${SOURCE_DIR}/host/reference/*" "${SOURCE_DIR}/host/report/*"
       "${SOURCE_DIR}/host/cli/*")

# Ground truth is no use where it shares a mistake with what it judges.
forbid("^(clgi/)?(passes|solvers|shared|gbuffer|lights|image|opencl|io|report|cli)/|^clgi/(clgi|device_scene|emitters|device|pass)\\.hpp"
       "the path tracer shares no transport code with the library"
       "${SOURCE_DIR}/host/reference/*" "${SOURCE_DIR}/include/clgi/reference.hpp")

# Passes and what they stand on know no solver, by name or through the umbrella header.
set(below ${core})
list(FILTER below EXCLUDE REGEX "/(solvers|plan)/|clgi/clgi\\.hpp$")
forbid("solvers/|^clgi/clgi\\.hpp" "passes know no solver" ${below})
list(FILTER below EXCLUDE REGEX "/kit/|clgi/reference\\.hpp$")
forbid("^(clgi/)?kit/" "passes know no kit" ${below})
set(planless ${core})
list(FILTER planless EXCLUDE REGEX "/plan/|clgi/clgi\\.hpp$")
forbid("^(clgi/)?plan/" "nothing of the library knows the plan" ${planless} "${SOURCE_DIR}/host/io/*"
       "${SOURCE_DIR}/host/reference/*" "${SOURCE_DIR}/host/gl/*" "${SOURCE_DIR}/host/mesh/*")

# ---- rooms ------------------------------------------------------------------------------------
set(upstream_parallel "")
set(upstream_scene parallel)
set(upstream_gbuffer parallel scene)
set(upstream_lights parallel gbuffer scene)
foreach(transport IN ITEMS image vpl antiradiance transfer)
    set(upstream_${transport} parallel gbuffer lights scene)
endforeach()
set(upstream_atlas parallel vpl gbuffer lights scene)
set(rooms parallel scene gbuffer lights image vpl atlas antiradiance transfer)

# check_room(path room): path, a file of room, includes its own room and those upstream only.
macro(check_room path room)
    read_includes("${SOURCE_DIR}/${path}")
    foreach(name IN LISTS includes)
        if(name MATCHES "^(clgi/passes/|clgi/shared/)?(${room_pattern})(/|\\.)")
            set(other "${CMAKE_MATCH_2}")
            if(NOT other STREQUAL "${room}" AND NOT other IN_LIST upstream_${room})
                fault("${path} includes ${name}: room ${room} may use (${upstream_${room}})")
            endif()
        endif()
    endforeach()
endmacro()
list(JOIN rooms "|" room_pattern)

foreach(room IN LISTS rooms)
    file(GLOB paths RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/kernels/${room}/*"
         "${SOURCE_DIR}/host/${room}/*" "${SOURCE_DIR}/include/clgi/passes/${room}.hpp"
         "${SOURCE_DIR}/include/clgi/shared/${room}.h")
    foreach(path IN LISTS paths)
        check_room("${path}" "${room}")
    endforeach()
endforeach()

# ---- kernels ----------------------------------------------------------------------------------
file(GLOB_RECURSE paths RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/kernels/*"
     "${SOURCE_DIR}/include/clgi/shared/*")
foreach(path IN LISTS paths)
    file(READ "${SOURCE_DIR}/${path}" text)
    # Some OpenCL compilers choke on anything else, in comments too.
    if(text MATCHES "[^\t\n -~]")
        fault("${path} is not plain ASCII")
    endif()
    if(path MATCHES "^kernels/([^/]+)/" AND NOT CMAKE_MATCH_1 IN_LIST rooms)
        fault("${path} is in no known room")
    endif()
    if(path MATCHES "\\.cl$")
        string(REGEX MATCH "^(//[^\n]*\n)+" header "${text}")
        if(NOT header MATCHES "\\[(derived: |[A-Z][a-z]+[0-9][0-9])")
            fault("${path} names no source: [Paper, section] or [derived: from what] in its header")
        endif()
    endif()
    # A kernel sees shared headers and kernels/, nothing else.
    read_includes("${SOURCE_DIR}/${path}")
    foreach(name IN LISTS includes)
        set(from_system FALSE)
        if(path MATCHES "/base\\.h$" AND name MATCHES "^(cstdint|glm/glm\\.hpp)$")
            set(from_system TRUE)
        endif()
        if(NOT from_system AND NOT name MATCHES "^clgi/shared/" AND
           (path MATCHES "^include/" OR NOT EXISTS "${SOURCE_DIR}/kernels/${name}"))
            fault("${path} includes ${name}: neither clgi/shared/ nor kernels/")
        endif()
    endforeach()
endforeach()

# ---- length -----------------------------------------------------------------------------------
set(most_lines 400)
set(globs "")
foreach(folder IN ITEMS cmake host include kernels samples tests)
    foreach(extension IN ITEMS c cl clh cmake cpp glsl h hpp sh txt)
        list(APPEND globs "${SOURCE_DIR}/${folder}/*.${extension}")
    endforeach()
endforeach()
file(GLOB_RECURSE paths RELATIVE "${SOURCE_DIR}" ${globs})
foreach(path IN LISTS paths)
    file(READ "${SOURCE_DIR}/${path}" text)
    # On a line of its own, where tools and readers look for it.
    if(path MATCHES "\\.(c|h|cpp|hpp|cl|clh)$" AND
       NOT text MATCHES "(^|\n)(// | *)SPDX-License-Identifier: MIT")
        fault("${path} has no line with its licence")
    endif()
    string(REGEX REPLACE "[^\n]" "" breaks "${text}")
    string(LENGTH "${breaks}" lines)
    if(path MATCHES "^tests/mutants/.*\\.txt$")
        continue()  # a list, not a text to be read
    endif()
    if(lines GREATER most_lines)
        fault("${path} has ${lines} lines, ${most_lines} at most")
    endif()
endforeach()

if(faults)
    message(FATAL_ERROR "layers:${faults}")
endif()
message(STATUS "layers: every arrow points the right way")
