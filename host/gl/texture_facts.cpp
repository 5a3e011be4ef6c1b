// SPDX-License-Identifier: MIT
#include "gl/texture_facts.hpp"

#include <clgi/error.hpp>
#include <cstdio>
#include <string>

namespace clgi::gl {
namespace {

const TextureFormat formats[] = {
    {GL_RGBA32F, "RGBA32F", GL_RGBA, GL_FLOAT, 16, TEXEL_RGBA32F, CL_RGBA, CL_FLOAT},
    {GL_RGBA16F, "RGBA16F", GL_RGBA, GL_HALF_FLOAT, 8, TEXEL_RGBA16F, CL_RGBA, CL_HALF_FLOAT},
    {GL_RGBA8, "RGBA8", GL_RGBA, GL_UNSIGNED_BYTE, 4, TEXEL_RGBA8, CL_RGBA, CL_UNORM_INT8},
    {GL_R32F, "R32F", GL_RED, GL_FLOAT, 4, 0, CL_R, CL_FLOAT},
    {GL_R32I, "R32I", GL_RED_INTEGER, GL_INT, 4, 0, CL_R, CL_SIGNED_INT32},
    {GL_RG32I, "RG32I", GL_RG_INTEGER, GL_INT, 8, 0, CL_RG, CL_SIGNED_INT32},
};

const TextureFormat* known(GLenum internal) {
    for (const TextureFormat& format : formats)
        if (format.internal == internal) return &format;
    return nullptr;
}

std::string size_text(long width, long height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

Channel look_up(const char* name, unsigned texture, const View& view,
                std::initializer_list<GLenum> allowed) {
    if (!texture) return {name, 0, nullptr};
    const std::string who = std::string("gl.import: ") + name;
    if (!glIsTexture(texture))
        throw Error(who + " is " + std::to_string(texture) +
                    ", which names no texture of the current context");
    GLint bound = 0;
    glBindTexture(GL_TEXTURE_2D, texture);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    if (static_cast<unsigned>(bound) != texture) {
        glGetError();  // that of the binding
        throw Error(who + " is a texture of another kind, GL_TEXTURE_2D needed");
    }
    GLint width = 0, height = 0, internal = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_INTERNAL_FORMAT, &internal);
    if (width != static_cast<GLint>(view.width) || height != static_cast<GLint>(view.height))
        throw Error(who + " is " + size_text(width, height) + ", " +
                    size_text(view.width, view.height) + " needed, the view's size");
    std::string needed;
    for (const GLenum format : allowed) {
        if (format == static_cast<GLenum>(internal)) return {name, texture, known(format)};
        needed += (needed.empty() ? "" : " or ") + std::string(known(format)->name);
    }
    char code[16];
    std::snprintf(code, sizeof code, "0x%04x", static_cast<unsigned>(internal));
    const TextureFormat* got = known(static_cast<GLenum>(internal));
    throw Error(who + " has the internal format " + (got ? got->name : code) + ", " + needed +
                " needed");
}

}  // namespace

Channels inspect(const GBufferTextures& textures, const View& view) {
    const KeptBinding kept;
    Channels out;
    out.position = look_up("position", textures.position, view, {GL_RGBA32F});
    out.normal = look_up("normal", textures.normal, view, {GL_RGBA16F, GL_RGBA32F});
    out.geometric = look_up("geometric", textures.geometric, view, {GL_RGBA16F, GL_RGBA32F});
    out.albedo = look_up("albedo", textures.albedo, view, {GL_RGBA8, GL_RGBA16F, GL_RGBA32F});
    out.emission = look_up("emission", textures.emission, view, {GL_RGBA16F, GL_RGBA32F});
    out.depth = look_up("depth", textures.depth, view, {GL_R32F});
    out.ids = look_up("ids", textures.ids, view, {GL_R32I, GL_RG32I});
    for (const Channel* channel : {&out.normal, &out.albedo})
        if (!channel->texture)
            throw Error(std::string("gl.import: ") + channel->name + " is 0, a texture needed");
    if (!out.position.texture && !out.depth.texture)
        throw Error("gl.import: position and depth are both 0, one of the textures needed");
    return out;
}

std::uint32_t Channels::flags(bool top_first) const {
    std::uint32_t out = top_first ? IMPORT_TOP_FIRST : 0;
    if (position.texture) out |= IMPORT_POSITION;
    if (geometric.texture) out |= IMPORT_GEOMETRIC;
    if (emission.texture) out |= IMPORT_EMISSION;
    if (depth.texture) out |= IMPORT_DEPTH;
    if (ids.texture) out |= IMPORT_MATERIAL;
    if (ids.texture && ids.format->internal == GL_RG32I) out |= IMPORT_TRIANGLE;
    return out;
}

}  // namespace clgi::gl
