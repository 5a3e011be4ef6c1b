// SPDX-License-Identifier: MIT
#include "gl/readback.hpp"

#include <clgi/error.hpp>
#include <string>

#include "gl/current.hpp"

namespace clgi::gl {
namespace {

// Packed rows into a pixel buffer, and everything back as it was.
class PackState {
public:
    PackState() {
        glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &buffer_);
        for (std::size_t i = 0; i < std::size(names); ++i) {
            glGetIntegerv(names[i], &values_[i]);
            glPixelStorei(names[i], names[i] == GL_PACK_ALIGNMENT ? 1 : 0);
        }
    }
    ~PackState() {
        for (std::size_t i = 0; i < std::size(names); ++i) glPixelStorei(names[i], values_[i]);
        glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(buffer_));
    }
    PackState(const PackState&) = delete;
    PackState& operator=(const PackState&) = delete;

private:
    static constexpr GLenum names[] = {GL_PACK_ALIGNMENT,   GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS,
                                       GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES, GL_PACK_LSB_FIRST};
    GLint buffer_ = 0;
    GLint values_[std::size(names)] = {};
};

}  // namespace

Readback::~Readback() {
    const PackState kept;
    settle();
}

void Readback::settle() {
    for (const cl::Event& user : users_) {
        try {
            user.wait();
        } catch (const cl::Error&) {
            // It failed, of which its own event tells, and no longer reads the pixel buffers.
        }
    }
    users_.clear();
    for (Slot& slot : slots_) {
        if (!slot.mapped) continue;
        glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.name());
        glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
        slot.mapped = false;
    }
}

ImportBuffers Readback::read(const cl::CommandQueue& queue, Channels& channels, const View& view,
                             WaitList& copied) {
    const KeptBinding kept_texture;
    const PackState kept_pack;
    settle();
    const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
    Channel* all[] = {&channels.position, &channels.normal, &channels.geometric, &channels.albedo,
                      &channels.emission, &channels.depth,  &channels.ids};

    // Ask for all of them first, so that OpenGL can work ahead.
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (!all[i]->texture) continue;
        Slot& slot = slots_[i];
        const std::size_t bytes = pixels * all[i]->format->bytes;
        if (!slot.pixels.name()) slot.pixels = make_buffer();
        glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.name());
        if (slot.bytes != bytes) {
            slot.bytes = 0;
            glBufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr,
                         GL_STREAM_READ);
            check_errors("gl.import: a pixel buffer of " + std::to_string(bytes) + " bytes");
            slot.buffer = cl::Buffer(context_, CL_MEM_READ_ONLY, bytes);
            slot.bytes = bytes;
        }
        glBindTexture(GL_TEXTURE_2D, all[i]->texture);
        glGetTexImage(GL_TEXTURE_2D, 0, all[i]->format->format, all[i]->format->type, nullptr);
    }
    check_errors("gl.import: reading the textures");

    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (!all[i]->texture) continue;
        Slot& slot = slots_[i];
        glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.pixels.name());
        const void* texels = glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0,
                                              static_cast<GLsizeiptr>(slot.bytes), GL_MAP_READ_BIT);
        if (!texels) check_errors("gl.import: mapping a pixel buffer");
        if (!texels) throw DeviceError("gl.import: a pixel buffer cannot be mapped");
        slot.mapped = true;
        cl::Event event;
        queue.enqueueWriteBuffer(slot.buffer, CL_FALSE, 0, slot.bytes, texels, nullptr, &event);
        copied.push_back(event);
        users_.push_back(event);
    }
    return {slots_[0].buffer, slots_[1].buffer, slots_[2].buffer, slots_[3].buffer,
            slots_[4].buffer, slots_[5].buffer, slots_[6].buffer};
}

}  // namespace clgi::gl
