# Warnings for clgi's own targets; errors where CLGI_WERROR asks for it (CI does).
option(CLGI_WERROR "Treat warnings as errors" OFF)

function(clgi_warnings target)
    if(MSVC)
        target_compile_options(${target} PRIVATE /W4 $<$<BOOL:${CLGI_WERROR}>:/WX>)
    else()
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wno-missing-field-initializers
                               $<$<BOOL:${CLGI_WERROR}>:-Werror>)
        # GCC 12 warns of overlaps in "text" + std::string where there are none (its bug 105651).
        if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
            target_compile_options(${target} PRIVATE -Wno-restrict)
        endif()
    endif()
endfunction()
