# Warnings for clgi's own targets; errors where CLGI_WERROR asks for it (CI does).
option(CLGI_WERROR "Treat warnings as errors" OFF)

function(clgi_warnings target)
    if(MSVC)
        target_compile_options(${target} PRIVATE /W4 $<$<BOOL:${CLGI_WERROR}>:/WX>)
    else()
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wno-missing-field-initializers
                               $<$<BOOL:${CLGI_WERROR}>:-Werror>)
    endif()
endfunction()
