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

# ---- modules: what each may include -----------------------------------------------------------
set(methods second_order light_atlas transfer antiradiance irradiance_cache)
set(reach_core core)
set(reach_scene core scene)
set(reach_shading core scene shading)
foreach(method IN LISTS methods)
    set(reach_${method} core scene shading ${method})
endforeach()
set(reach_renderer core scene shading ${methods} renderer)
set(reach_plan ${reach_renderer} plan)
set(reach_clgi ${reach_plan})
set(reach_io core scene io)
set(reach_gl core scene shading gl)
set(reach_mesh core scene mesh)
set(reach_reference core scene reference)  # ground truth shares no transport code with the library
set(reach_lab ${reach_plan} io mesh reference lab)
set(reach_view ${reach_lab} view)
set(reach_program ${reach_view} gl program clgi)

# Every public header of the library, by module; those of io, gl and mesh lie in their own folders.
set(headers_core error opencl device programs advanced/export advanced/interval
    advanced/kernel_source advanced/kit/buffer_table advanced/kit/progress advanced/kit/recorder
    advanced/occlusion advanced/pass advanced/planes advanced/slice advanced/solver_status passes/parallel advanced/sh shared/base
    shared/gbuffer shared/halton shared/image shared/parallel shared/planes)
set(headers_scene scene device_scene scene_animator scene_mover procedural advanced/adjacency
    advanced/animation advanced/static_scene passes/scene shared/microfacet shared/scene)
set(headers_shading advanced/emitters advanced/kit/draw advanced/kit/emitters advanced/kit/picture
    passes/gbuffer passes/image passes/import passes/lights shared/lights)
set(headers_second_order second_order)
set(headers_light_atlas light_atlas advanced/atlas_blocks advanced/atlas_layout advanced/atlas_light
    advanced/bake_layout advanced/irradiance_volume advanced/light_atlas_view advanced/patches
    advanced/static_bake advanced/vpl_layout passes/atlas passes/vpl shared/atlas shared/volume
    shared/vpl)
set(headers_transfer dynamic_transfer advanced/blocker_levels advanced/dynamic_transfer_view
    advanced/environment_light advanced/mask_weights advanced/visible_sets passes/masks
    passes/receivers passes/transfer shared/masks shared/receivers shared/transfer)
set(headers_antiradiance antiradiance advanced/antiradiance_view advanced/direction_bins
    advanced/elements advanced/links advanced/moving_elements passes/antiradiance
    passes/antiradiance_gloss passes/moving_elements shared/antiradiance shared/moving_elements)
set(headers_irradiance_cache irradiance_cache passes/cache shared/cache)
set(headers_renderer options renderer)
set(headers_plan plan advanced/effects advanced/analysis advanced/reach advanced/tuning)
set(headers_reference reference)
set(headers_clgi clgi)  # the umbrella

set(library core scene shading ${methods} renderer plan)
foreach(module IN ITEMS ${library} reference clgi)
    foreach(header IN LISTS headers_${module})
        set(module_of_${header} ${module})
    endforeach()
endforeach()

# module_of(name out): of an include like clgi/passes/vpl.hpp or methods/light_atlas/sites.hpp, or
# of a path below host/; empty for what is not clgi's.
function(module_of name out)
    set(module "")
    if(name MATCHES "^clgi/(io|gl|mesh)/")
        set(module ${CMAKE_MATCH_1})
    elseif(name MATCHES "^clgi/(.+)\\.(hpp|h)$")
        set(module "${module_of_${CMAKE_MATCH_1}}")
        if(module STREQUAL "")
            set(module unknown)
        endif()
    elseif(name MATCHES "^methods/([a-z_]+)/")
        set(module ${CMAKE_MATCH_1})
    elseif(name MATCHES "^(core|scene|shading|renderer|plan|io|gl|mesh|reference|lab|view|program)/")
        set(module ${CMAKE_MATCH_1})
    endif()
    set(${out} "${module}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE private RELATIVE "${SOURCE_DIR}/host" "${SOURCE_DIR}/host/*.?pp")
file(GLOB_RECURSE public RELATIVE "${SOURCE_DIR}/include" "${SOURCE_DIR}/include/clgi/*.hpp"
     "${SOURCE_DIR}/include/clgi/*.h")
foreach(file IN LISTS private public)
    module_of("${file}" module)
    if(module STREQUAL "" OR module STREQUAL "unknown")
        fault("${file} is in no known module")
        continue()
    endif()
    set(path "${SOURCE_DIR}/include/${file}")
    if(NOT file MATCHES "^clgi/")
        set(path "${SOURCE_DIR}/host/${file}")
    endif()
    read_includes("${path}")
    foreach(name IN LISTS includes)
        module_of("${name}" other)
        if(NOT other STREQUAL "" AND NOT other IN_LIST reach_${module})
            fault("${file} includes ${name}: module ${module} may use (${reach_${module}})")
        endif()
        # Passes are what everything else stands on.
        if(file MATCHES "^clgi/passes/|passes\\.cpp$" AND name MATCHES "/kit/")
            fault("${file} includes ${name}: passes know no kit")
        endif()
        # Other people's libraries, each where it belongs.
        if(module IN_LIST library OR file MATCHES "^clgi/")
            if(name MATCHES "tiny_gltf|^stb_image|OpenEXR/|^Im(f|ath)|^png\\.h|nlohmann/|embree|^meshoptimizer|^draco/|^webp/|^(GL|EGL|GLES|GLFW|epoxy)/|^CLI/|^fmt/")
                fault("${file} includes ${name}: the library stands on OpenCL and GLM alone")
            endif()
        endif()
        if(name MATCHES "stb_rect_pack" AND NOT file STREQUAL "methods/light_atlas/pack.cpp")
            fault("${file} includes ${name}: only methods/light_atlas/pack.cpp packs")
        endif()
        if(name MATCHES "tiny_gltf" AND NOT module STREQUAL "io")
            fault("${file} includes ${name}: glTF is io's business")
        endif()
        if(name MATCHES "^(GL|EGL|GLES[0-9]?|X11)/" OR (name MATCHES "^epoxy/" AND NOT module MATCHES "^(gl|view)$"))
            fault("${file} includes ${name}: OpenGL and EGL are seen through epoxy, in gl and view alone")
        endif()
        if(name MATCHES "^(GLFW/|imgui)" AND NOT module STREQUAL "view")
            fault("${file} includes ${name}: windows are the business of view")
        endif()
        if(module STREQUAL "gl" AND name MATCHES "^(OpenEXR|nlohmann|CLI|fmt)/|^png\\.h")
            fault("${file} includes ${name}: gl stands on the library alone")
        endif()
        if(name MATCHES "^meshoptimizer" AND NOT module MATCHES "^(io|mesh)$")
            fault("${file} includes ${name}: meshoptimizer is the business of io and mesh")
        endif()
        if(name MATCHES "^(draco|webp)/" AND NOT module STREQUAL "io")
            fault("${file} includes ${name}: codecs of glTF are io's business")
        endif()
        if(module STREQUAL "reference" AND name MATCHES "^(core/|clgi/device)")
            fault("${file} includes ${name}: the path tracer shares no code with devices")
        endif()
    endforeach()
endforeach()

# ---- kernels: folders, and what each may include ------------------------------------------------
set(upstream_parallel "")
set(upstream_scene parallel)
set(upstream_gbuffer parallel scene)
set(upstream_lights parallel gbuffer scene)
foreach(transport IN ITEMS image vpl antiradiance transfer cache)
    set(upstream_${transport} parallel gbuffer lights scene)
endforeach()
set(upstream_atlas parallel vpl gbuffer lights scene)
set(folders parallel scene gbuffer lights image vpl atlas antiradiance transfer cache)
list(JOIN folders "|" folder_pattern)

file(GLOB_RECURSE paths RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/kernels/*"
     "${SOURCE_DIR}/include/clgi/shared/*")
foreach(path IN LISTS paths)
    file(READ "${SOURCE_DIR}/${path}" text)
    # Some OpenCL compilers choke on anything else, in comments too.
    if(text MATCHES "[^\t\n -~]")
        fault("${path} is not plain ASCII")
    endif()
    set(folder "")
    if(path MATCHES "^kernels/([^/]+)/|^include/clgi/shared/([a-z]+)\\.h$")
        set(folder "${CMAKE_MATCH_1}${CMAKE_MATCH_2}")
    endif()
    if(path MATCHES "^kernels/[^/]+/" AND NOT folder IN_LIST folders)
        fault("${path} is in no known folder")
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
        if(folder IN_LIST folders AND name MATCHES "^(clgi/shared/)?(${folder_pattern})(/|\\.)")
            set(other "${CMAKE_MATCH_2}")
            if(NOT other STREQUAL "${folder}" AND NOT other IN_LIST upstream_${folder})
                fault("${path} includes ${name}: ${folder} may use (${upstream_${folder}})")
            endif()
        endif()
    endforeach()
endforeach()

# ---- length -----------------------------------------------------------------------------------
set(most_lines 400)
set(globs "")
foreach(folder IN ITEMS cmake host include kernels samples tests)
    foreach(extension IN ITEMS c cl clh cmake cpp glsl h hpp html py sh txt)
        list(APPEND globs "${SOURCE_DIR}/${folder}/*.${extension}")
    endforeach()
endforeach()
file(GLOB_RECURSE paths RELATIVE "${SOURCE_DIR}" ${globs})
foreach(path IN LISTS paths)
    file(READ "${SOURCE_DIR}/${path}" text)
    # On a line of its own, where tools and readers look for it.
    if(path MATCHES "\\.(c|h|cpp|hpp|cl|clh|html|py)$" AND
       NOT text MATCHES "(^|\n)(// |# |{#- | *)SPDX-License-Identifier: MIT")
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
