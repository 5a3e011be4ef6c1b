# Precompiled headers of clgi's own targets: what many of their files include, from other projects.
#
#   clgi_precompile(target <header>...)      compiles them for this target
#   clgi_precompile(target REUSE owner)      takes those of another one with the same flags
#
#   clgi_precompile(... TEXT)                for code that is mostly std::string
#
# They change nothing but the time: each file includes what it uses and compiles without them. They
# are off where clgi is part of another project, and beside compiler caches and clang-tidy, which
# work on files that stand alone.
set(CLGI_PCH_DEFAULT ${PROJECT_IS_TOP_LEVEL})
if(CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_CLANG_TIDY)
    set(CLGI_PCH_DEFAULT OFF)
endif()
option(CLGI_PCH "Precompiled headers" ${CLGI_PCH_DEFAULT})

function(clgi_precompile target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "TEXT" "REUSE" "")
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
