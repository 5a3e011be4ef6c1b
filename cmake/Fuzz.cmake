# Targets for libFuzzer: the whole build is instrumented, so they have a build folder of their own
# (preset `fuzz`, tests/fuzz/run.sh).
option(CLGI_FUZZ "Fuzz targets (needs clang)" OFF)

if(CLGI_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
        message(FATAL_ERROR "clgi: CLGI_FUZZ needs clang's libFuzzer; "
                            "this compiler is ${CMAKE_CXX_COMPILER_ID}")
    endif()
    add_compile_options(-fsanitize=fuzzer-no-link,address,undefined
                        -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
    add_link_options(-fsanitize=address,undefined)
endif()
