// SPDX-License-Identifier: MIT
#include <clgi/gl/renderer.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <string>

#include "gl/current.hpp"
#include "gl/program.hpp"
#include "gl/scene_data.hpp"

namespace clgi::gl {
namespace {

// A texture to draw into, attached to the framebuffer that is bound.
Object make_target(GLenum attachment, GLenum internal, GLenum format, GLenum type, GLsizei width,
                   GLsizei height) {
    Object texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), width, height, 0, format, type,
                 nullptr);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.name(), 0);
    return texture;
}

void need_complete(const char* what) {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw DeviceError(std::string("gl: OpenGL cannot draw into the textures of ") + what);
}

void set_view(const Object& program, const View& view) {
    const auto set = [&](const char* name, const float4& value) {
        glUniform4f(uniform(program, name), value.x, value.y, value.z, value.w);
    };
    set("eye", view.eye);
    set("right", view.right);
    set("up", view.up);
    set("forward", view.forward);
    set("window", view.window);
    glUniform2i(uniform(program, "size"), static_cast<GLint>(view.width),
                static_cast<GLint>(view.height));
    glUniform1ui(uniform(program, "dither"), view.flags >> VIEW_DITHER_SHIFT);
    glUniform1ui(uniform(program, "cull"), view.flags & VIEW_CULL_BACK_FACES ? 1 : 0);
}

constexpr int attributes = 7;  // textures that resolve_fragment writes

}  // namespace

class SceneRenderer::State {
public:
    State(const cl::CommandQueue& queue, const DeviceScene& scene)
        : frame(scene.frame()),
          triangle_count(scene.info().triangle_count),
          data(queue, scene),
          draw(build_program({"view", "scene", "draw_vertex"},
                             {"view", "scene", "texture", "surface", "draw_fragment"})),
          resolve(build_program({"resolve_vertex"},
                                {"view", "scene", "texture", "surface", "resolve_fragment"})),
          nothing(make_vertex_array()) {}

    void make_targets(GLsizei width, GLsizei height) {
        width_ = height_ = 0;
        textures = GBufferTextures();  // no names of textures that are gone, should this throw
        // Texture unit 0 serves; bind() puts the scene's texture back.
        glActiveTexture(GL_TEXTURE0);
        visible_frame = make_framebuffer();
        glBindFramebuffer(GL_FRAMEBUFFER, visible_frame.name());
        visible = make_target(GL_COLOR_ATTACHMENT0, GL_R32I, GL_RED_INTEGER, GL_INT, width, height);
        depth = make_target(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT,
                            GL_FLOAT, width, height);
        check_errors("gl: a picture of " + std::to_string(width) + "x" + std::to_string(height));
        need_complete("visibility");

        attribute_frame = make_framebuffer();
        glBindFramebuffer(GL_FRAMEBUFFER, attribute_frame.name());
        GLenum buffers[attributes];
        for (int i = 0; i < attributes; ++i) {
            buffers[i] = static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + i);
            Object& texture = attribute[i];
            if (i < 5)
                texture = make_target(buffers[i], GL_RGBA32F, GL_RGBA, GL_FLOAT, width, height);
            else if (i == 5)
                texture = make_target(buffers[i], GL_R32F, GL_RED, GL_FLOAT, width, height);
            else
                texture = make_target(buffers[i], GL_RG32I, GL_RG_INTEGER, GL_INT, width, height);
        }
        glDrawBuffers(attributes, buffers);
        check_errors("gl: a picture of " + std::to_string(width) + "x" + std::to_string(height));
        need_complete("a G-buffer");
        width_ = width;
        height_ = height;
        textures.position = attribute[0].name();
        textures.normal = attribute[1].name();
        textures.geometric = attribute[2].name();
        textures.albedo = attribute[3].name();
        textures.emission = attribute[4].name();
        textures.depth = attribute[5].name();
        textures.ids = attribute[6].name();
        textures.origin = frame.origin;
    }

    // The nearest triangle of every pixel.
    void draw_visible(const View& view) {
        glBindFramebuffer(GL_FRAMEBUFFER, visible_frame.name());
        const GLint none[] = {-1, -1, -1, -1};
        const GLfloat farthest = 0.0f;
        glClearBufferiv(GL_COLOR, 0, none);
        glDepthMask(GL_TRUE);
        glClearBufferfv(GL_DEPTH, 0, &farthest);
        if (triangle_count == 0) return;
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GREATER);  // of two at one depth the smaller index, which is drawn first
        glEnable(GL_CLIP_DISTANCE0);
        glUseProgram(draw.name());
        set_view(draw, view);
        data.connect(draw);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * triangle_count));
        glDisable(GL_CLIP_DISTANCE0);
        glDisable(GL_DEPTH_TEST);
    }

    void draw_attributes(const View& view) {
        glBindFramebuffer(GL_FRAMEBUFFER, attribute_frame.name());
        glUseProgram(resolve.name());
        set_view(resolve, view);
        data.connect(resolve);
        glActiveTexture(GL_TEXTURE0 + SceneData::unit_count);
        glBindTexture(GL_TEXTURE_2D, visible.name());
        glUniform1i(uniform(resolve, "visibility"), SceneData::unit_count);
        glUniform1f(uniform(resolve, "metre"), static_cast<float>(frame.scale));
        glUniform1f(uniform(resolve, "exposure"), static_cast<float>(frame.exposure));
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindTexture(GL_TEXTURE_2D, 0);
    }

    SceneFrame frame;
    std::uint32_t triangle_count;
    SceneData data;
    Object draw, resolve, nothing;
    Object visible_frame, attribute_frame;
    Object visible, depth, attribute[attributes];
    GLsizei width_ = 0, height_ = 0;  // of the targets
    GBufferTextures textures;
};

SceneRenderer::SceneRenderer(const cl::CommandQueue& queue, const DeviceScene& scene) {
    need_context("gl.renderer");
    if (scene.info().triangle_count > 0x7fffffffu / 3)
        throw DeviceError("gl: " + std::to_string(scene.info().triangle_count) +
                          " triangles, OpenGL draws at most " + std::to_string(0x7fffffff / 3));
    state_ = std::make_unique<State>(queue, scene);
}

SceneRenderer::~SceneRenderer() = default;

void SceneRenderer::draw(const View& view) {
    need_context("gl.renderer");
    need_no_errors("gl.renderer");
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const auto side = static_cast<std::uint32_t>(std::min(most, 16384));
    if (view.width < 1 || view.height < 1 || view.width > side || view.height > side)
        throw Error("gl.renderer: the view is " + std::to_string(view.width) + "x" +
                    std::to_string(view.height) + ", 1x1 to " + std::to_string(side) + "x" +
                    std::to_string(side) + " needed");
    State& state = *state_;
    const auto width = static_cast<GLsizei>(view.width), height = static_cast<GLsizei>(view.height);
    if (width != state.width_ || height != state.height_) state.make_targets(width, height);
    for (const GLenum off : {GL_BLEND, GL_CULL_FACE, GL_DITHER, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                             GL_MULTISAMPLE, GL_RASTERIZER_DISCARD})
        glDisable(off);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glFrontFace(GL_CCW);
    glDepthRange(0.0, 1.0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glViewport(0, 0, width, height);
    glBindVertexArray(state.nothing.name());
    state.data.bind();
    state.draw_visible(view);
    state.draw_attributes(view);
    glBindVertexArray(0);
    glUseProgram(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    check_errors("gl: drawing a view");
}

const GBufferTextures& SceneRenderer::textures() const { return state_->textures; }

}  // namespace clgi::gl
