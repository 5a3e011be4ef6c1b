# clgi_embed_shaders(target folder): compiles the folder's .glsl files into target as a table that
# host/gl/embedded.hpp declares. They are small enough for one literal each.

function(clgi_embed_shaders target folder)
    file(GLOB shaders CONFIGURE_DEPENDS "${folder}/*.glsl")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${shaders})
    set(text "// Generated from ${folder}. Do not edit.\n#include \"gl/embedded.hpp\"\n\n")
    string(REPLACE "${PROJECT_SOURCE_DIR}/" "" text "${text}")
    string(APPEND text "namespace clgi::gl {\n\nconst EmbeddedShader embedded_shaders[] = {\n")
    foreach(shader IN LISTS shaders)
        get_filename_component(name "${shader}" NAME_WE)
        file(READ "${shader}" source)
        string(APPEND text "{\"${name}\", R\"glsl(${source})glsl\"},\n")
    endforeach()
    list(LENGTH shaders count)
    string(APPEND text "};\n\nconst unsigned embedded_shader_count = ${count};\n\n}  // namespace clgi::gl\n")
    file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/embedded_shaders.cpp" CONTENT "${text}" @ONLY)
    target_sources(${target} PRIVATE "${PROJECT_BINARY_DIR}/embedded_shaders.cpp")
endfunction()
