# Fewer seconds of compilation for clgi's own targets: headers of other projects are compiled once,
# and source files in batches.
#
#   clgi_precompile(target [<header>...] [BATCH n] [TOGETHER <folder>...] [TEXT])
#   clgi_precompile(target REUSE owner ...)     precompiled headers of another one with the same flags
#
# Headers are precompiled for this target; a target of one or two batches saves less than that costs,
# and names none. BATCH n: the source files of a folder are compiled in batches of n at most (CMake's
# unity builds), which share headers and instances of templates. TOGETHER: the folders below each of
# these count as one. TEXT: for code that is mostly std::string.
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

# The folder whose files share batches with this one.
function(clgi_batch_folder out source)
    get_filename_component(path "${source}" ABSOLUTE)
    file(RELATIVE_PATH path "${PROJECT_SOURCE_DIR}" "${path}")
    get_filename_component(folder "${path}" DIRECTORY)
    foreach(top IN LISTS ARGN)
        if(folder MATCHES "^${top}/")
            set(folder "${top}")
        endif()
    endforeach()
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    set(${out} "${folder}" PARENT_SCOPE)
endfunction()

function(clgi_batches target most)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    set(folders "")
    foreach(source IN LISTS sources)
        clgi_batch_folder(folder "${source}" ${ARGN})
        list(APPEND folders ${folder})
        list(APPEND files_${folder} "${source}")
    endforeach()
    list(REMOVE_DUPLICATES folders)
    foreach(folder IN LISTS folders)
        list(LENGTH files_${folder} count)
        math(EXPR batches "(${count} + ${most} - 1) / ${most}")
        set(index 0)
        foreach(source IN LISTS files_${folder})
            math(EXPR batch "${index} * ${batches} / ${count}")
            set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${folder}_${batch}")
            math(EXPR index "${index} + 1")
        endforeach()
    endforeach()
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # a local name may be that of another file's helper
        target_compile_options(${target} PRIVATE -Wno-shadow -Wshadow=local)
    endif()
endfunction()

function(clgi_precompile target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "TEXT" "REUSE;BATCH" "TOGETHER")
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # its garbage collector takes a tenth of the time
        target_compile_options(${target} PRIVATE "SHELL:--param ggc-min-expand=1000"
                                                 "SHELL:--param ggc-min-heapsize=2000000")
    endif()
    if(CLGI_UNITY AND arg_BATCH)
        clgi_batches(${target} ${arg_BATCH} ${arg_TOGETHER})
    endif()
    if(NOT CLGI_PCH)
        return()
    endif()
    if(arg_REUSE)
        target_precompile_headers(${target} REUSE_FROM ${arg_REUSE})
    elseif(arg_UNPARSED_ARGUMENTS)
        target_precompile_headers(${target} PRIVATE ${arg_UNPARSED_ARGUMENTS})
    endif()
    # GCC 12 forgets that precompiled headers are the system's and warns of sizes in std::string that
    # cannot be (its bug 105651 again). Builds without them keep these warnings.
    if(arg_TEXT AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-array-bounds)
    endif()
endfunction()
