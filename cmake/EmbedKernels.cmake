# clgi_embed_kernels(target kernel...): flattens each kernels/<kernel>.cl into the build tree, for
# programs that take the kernels alone, and compiles the files themselves into target as a table that
# host/core/opencl/embedded.hpp declares; the library flattens them as it needs them.

set(CLGI_CMAKE_DIR "${CMAKE_CURRENT_LIST_DIR}")

function(clgi_embed_kernels target)
    file(GLOB_RECURSE parts CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/kernels/*.clh"
         "${PROJECT_SOURCE_DIR}/include/clgi/shared/*.h")
    set(flattened "")
    set(sources "")
    foreach(kernel IN LISTS ARGN)
        set(output "${PROJECT_BINARY_DIR}/kernels/${kernel}.cl")
        add_custom_command(
            OUTPUT "${output}"
            COMMAND "${CMAKE_COMMAND}" -DKERNEL=${kernel} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
                    -DOUTPUT=${output} -P "${CLGI_CMAKE_DIR}/FlattenKernel.cmake"
            DEPENDS "${PROJECT_SOURCE_DIR}/kernels/${kernel}.cl" ${parts}
                    "${CLGI_CMAKE_DIR}/FlattenKernel.cmake"
            COMMENT "Flattening ${kernel}.cl"
            VERBATIM)
        list(APPEND flattened "${output}")
        list(APPEND sources "${PROJECT_SOURCE_DIR}/kernels/${kernel}.cl")
    endforeach()
    add_custom_target(${target}_kernels DEPENDS ${flattened})
    add_dependencies(${target} ${target}_kernels)

    list(APPEND sources ${parts})
    set(names "${sources}")
    list(TRANSFORM names REPLACE "^${PROJECT_SOURCE_DIR}/" "")
    set(table "${PROJECT_BINARY_DIR}/embedded_kernels.cpp")
    add_custom_command(
        OUTPUT "${table}"
        COMMAND "${CMAKE_COMMAND}" "-DFILES=${names}" -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
                -DOUTPUT=${table} -P "${CLGI_CMAKE_DIR}/EmbedTable.cmake"
        DEPENDS ${sources} "${CLGI_CMAKE_DIR}/EmbedTable.cmake"
        COMMENT "Embedding kernels"
        VERBATIM)
    target_sources(${target} PRIVATE "${table}")
endfunction()
