# Fewer seconds of compilation for clgi's own targets: headers of other projects are compiled once,
# and source files in batches.
#
#   clgi_precompile(target <header>... [BATCH n] [TEXT])   precompiles the headers for this target
#   clgi_precompile(target REUSE owner [BATCH n])          takes those of another one with the same flags
#
# BATCH n: so many source files of a folder are compiled as one (CMake's unity builds). TEXT: for code
# that is mostly std::string.
#
# Neither changes anything but the time: each file includes what it uses and compiles alone. Both are
# off where clgi is part of another project, and beside compiler caches and clang-tidy, which work on
# files that stand alone. Who edits one file often sets CLGI_UNITY to OFF.
set(CLGI_QUICK_BUILD ${PROJECT_IS_TOP_LEVEL})
if(CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_CLANG_TIDY)
    set(CLGI_QUICK_BUILD OFF)
endif()
option(CLGI_PCH "Precompiled headers" ${CLGI_QUICK_BUILD})
option(CLGI_UNITY "Source files are compiled in batches" ${CLGI_QUICK_BUILD})

function(clgi_precompile target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "TEXT" "REUSE;BATCH" "")
    if(CLGI_UNITY AND arg_BATCH)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
        get_target_property(sources ${target} SOURCES)
        list(FILTER sources INCLUDE REGEX "\\.cpp$")
        foreach(source IN LISTS sources)
            get_filename_component(path "${source}" ABSOLUTE)
            file(RELATIVE_PATH path "${PROJECT_SOURCE_DIR}" "${path}")
            get_filename_component(folder "${path}" DIRECTORY)
            string(MAKE_C_IDENTIFIER "${folder}" folder)
            math(EXPR batch "0${count_${folder}} / ${arg_BATCH}")
            set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${folder}_${batch}")
            math(EXPR count_${folder} "0${count_${folder}} + 1")
        endforeach()
    endif()
    if(NOT CLGI_PCH)
        return()
    endif()
    if(arg_REUSE)
        target_precompile_headers(${target} REUSE_FROM ${arg_REUSE})
    else()
        target_precompile_headers(${target} PRIVATE ${arg_UNPARSED_ARGUMENTS})
    endif()
    # GCC 12 forgets that precompiled headers are the system's and warns of sizes in std::string that
    # cannot be (its bug 105651 again). Builds without them keep these warnings.
    if(arg_TEXT AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-array-bounds)
    endif()
endfunction()
