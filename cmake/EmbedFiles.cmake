# clgi_embed_files(target module type table files...): compiles small text files into target as the
# table that host/<module>/embedded.hpp declares, in namespace clgi::<module>: of structs `type` with
# name and source. They are small enough for one literal each.

function(clgi_embed_files target module type table)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
    set(text "// Generated from host/${module}. Do not edit.\n#include \"${module}/embedded.hpp\"\n\n")
    string(APPEND text "namespace clgi::${module} {\n\nconst ${type} ${table}s[] = {\n")
    foreach(file IN LISTS ARGN)
        get_filename_component(name "${file}" NAME)
        string(REGEX REPLACE "\\.glsl$" "" name "${name}")
        file(READ "${file}" source)
        string(APPEND text "{\"${name}\", R\"text(${source})text\"},\n")
    endforeach()
    list(LENGTH ARGN count)
    string(APPEND text "};\n\nconst unsigned ${table}_count = ${count};\n\n}  // namespace clgi::${module}\n")
    file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${table}s.cpp" CONTENT "${text}" @ONLY)
    target_sources(${target} PRIVATE "${PROJECT_BINARY_DIR}/${table}s.cpp")
endfunction()
