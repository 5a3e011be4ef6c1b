// What a texture that a user hands in must be, and what it is.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>
#include <clgi/gl/gbuffer.hpp>

#include <vector>

namespace clgi::gl {

// A format that both APIs know.
struct TextureFormat {
    GLenum internal;
    const char* name;  // "RGBA16F"
    GLenum format;     // of glGetTexImage, without conversion
    GLenum type;
    std::size_t bytes;    // of a texel
    std::uint32_t texel;  // TEXEL_... of import_buffers
    cl_channel_order order;
    cl_channel_type channel;
};

// A texture with its place among those of a G-buffer.
struct Channel {
    const char* name;  // "normal"
    unsigned texture;  // 0: none
    const TextureFormat* format;
};

struct Channels {
    Channel position, normal, geometric, albedo, emission, depth, ids;

    std::vector<Channel*> given() {
        std::vector<Channel*> out;
        for (Channel* channel : {&position, &normal, &geometric, &albedo, &emission, &depth, &ids})
            if (channel->texture) out.push_back(channel);
        return out;
    }
    std::uint32_t flags(bool top_first) const;  // IMPORT_...
};

// Looks every texture up in the current context. Throws Error naming the texture, what it is and
// what is needed.
Channels inspect(const GBufferTextures& textures, const View& view);

// Sets a texture binding back as it was.
class KeptBinding {
public:
    KeptBinding() { glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_); }
    ~KeptBinding() { glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_)); }
    KeptBinding(const KeptBinding&) = delete;
    KeptBinding& operator=(const KeptBinding&) = delete;

private:
    GLint texture_ = 0;
};

}  // namespace clgi::gl
