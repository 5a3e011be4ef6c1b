# clgi_embed_kernels(target kernel...): flattens each kernels/<kernel>.cl into the build tree and
# compiles the same bytes into target as a table that host/core/opencl/embedded.hpp declares.

set(CLGI_CMAKE_DIR "${CMAKE_CURRENT_LIST_DIR}")

function(clgi_embed_kernels target)
    file(GLOB_RECURSE parts CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/kernels/*.clh"
         "${PROJECT_SOURCE_DIR}/include/clgi/shared/*.h")
    set(flattened "")
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
    endforeach()
    set(table "${PROJECT_BINARY_DIR}/embedded_kernels.cpp")
    add_custom_command(
        OUTPUT "${table}"
        COMMAND "${CMAKE_COMMAND}" "-DKERNELS=${ARGN}" -DFOLDER=${PROJECT_BINARY_DIR}/kernels
                -DOUTPUT=${table} -P "${CLGI_CMAKE_DIR}/EmbedTable.cmake"
        DEPENDS ${flattened} "${CLGI_CMAKE_DIR}/EmbedTable.cmake"
        COMMENT "Embedding kernels"
        VERBATIM)
    target_sources(${target} PRIVATE "${table}")
endfunction()
