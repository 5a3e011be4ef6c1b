// OpenGL for tests: one context a process, textures by hand, and pictures drawn by it.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <clgi/gl/context.hpp>
#include <clgi/gl/renderer.hpp>
#include <memory>
#include <string>

#include "device.hpp"
#include "drawing.hpp"

namespace clgi::test {

// Skips, and prints the reason, where there is no OpenGL without a window.
class Gl : public testing::Test {
protected:
    void SetUp() override {
        static std::string reason;
        static const std::unique_ptr<gl::HeadlessContext> context = [] {
            try {
                return std::make_unique<gl::HeadlessContext>();
            } catch (const DeviceError& error) {
                reason = error.what();
                return std::unique_ptr<gl::HeadlessContext>();
            }
        }();
        if (!context) GTEST_SKIP() << reason;
        context->make_current();
    }
};

// A texture with these texels, row 0 at the bottom; deleted with the object.
class GlTexture {
public:
    GlTexture(GLenum internal, int width, int height, GLenum format, GLenum type,
              const void* texels) {
        glGenTextures(1, &name_);
        glBindTexture(GL_TEXTURE_2D, name_);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), width, height, 0, format, type,
                     texels);
        glBindTexture(GL_TEXTURE_2D, 0);
    }
    ~GlTexture() { glDeleteTextures(1, &name_); }
    GlTexture(const GlTexture&) = delete;
    GlTexture& operator=(const GlTexture&) = delete;
    unsigned name() const { return name_; }

private:
    GLuint name_ = 0;
};

// A G-buffer with something in it that no conversion leaves there.
inline GBuffer marked_gbuffer(std::size_t pixels) {
    const std::uint32_t stride = padded(pixels);
    const GBuffer out{empty<float>(GBUFFER_PLANES * stride),
                      empty<cl_int>(GBUFFER_ID_PLANES * stride), stride};
    const cl::CommandQueue& queue = device().queue;
    queue.enqueueFillBuffer(out.planes, -77.0f, 0, GBUFFER_PLANES * stride * sizeof(float));
    queue.enqueueFillBuffer(out.ids, cl_int{-77}, 0, GBUFFER_ID_PLANES * stride * sizeof(cl_int));
    return out;
}

// A G-buffer on the host, with nothing but what it says.
inline Drawing read_back(const GBuffer& from, const View& view, const DeviceScene& scene) {
    Drawing out;
    out.view = view;
    out.stride = from.stride;
    out.order = scene.triangle_order();
    out.planes = download<float>(from.planes, GBUFFER_PLANES * from.stride);
    out.ids = download<std::int32_t>(from.ids, GBUFFER_ID_PLANES * from.stride);
    return out;
}

// Copies, or shares where the device can.
inline gl::GBufferImport& shared_import() {
    // Never destroyed: its context may be gone by then.
    static auto* const import = new gl::GBufferImport(device().context, device().device);
    return *import;
}

inline Drawing draw_with_gl(const DeviceScene& scene, gl::SceneRenderer& renderer,
                            const View& view) {
    const GBuffer out = marked_gbuffer(std::size_t{view.width} * view.height);
    renderer.draw(view);
    shared_import().convert(device().queue, view, scene, renderer.textures(), out).wait();
    return read_back(out, view, scene);
}

}  // namespace clgi::test
