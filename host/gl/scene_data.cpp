// SPDX-License-Identifier: MIT
#include "gl/scene_data.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <string>
#include <vector>

#include "gl/current.hpp"
#include "gl/program.hpp"

namespace clgi::gl {
namespace {

struct Kind {
    const char* name;  // of the sampler in scene.glsl
    GLenum internal, format, type;
    std::size_t bytes;  // of a texel
};

// In the order of DeviceScene::kernel_arguments().
const Kind kinds[SceneData::unit_count] = {
    {"triangles", GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16},
    {"positions", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"normals", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"uvs", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"colors", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"materials", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"textures", GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16},
    {"texels", GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4},
    {"decode", GL_R32F, GL_RED, GL_FLOAT, 4},
};

Object upload(const Kind& kind, std::vector<unsigned char> bytes) {
    const std::size_t row = data_width * kind.bytes;
    const std::size_t rows = std::max<std::size_t>((bytes.size() + row - 1) / row, 1);
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (most < data_width || rows > static_cast<std::size_t>(most))
        throw DeviceError(std::string("gl: ") + kind.name + " need a texture of " +
                          std::to_string(data_width) + "x" + std::to_string(rows) +
                          ", OpenGL allows " + std::to_string(most) + " a side");
    bytes.resize(rows * row);
    Object texture = make_texture();
    glBindTexture(GL_TEXTURE_2D, texture.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(kind.internal), data_width,
                 static_cast<GLsizei>(rows), 0, kind.format, kind.type, bytes.data());
    check_errors(std::string("gl: a texture for ") + kind.name);
    return texture;
}

}  // namespace

SceneData::SceneData(const cl::CommandQueue& queue, const DeviceScene& scene)
    : flags_(scene.info().flags) {
    const auto buffers = scene.kernel_arguments();
    static_assert(std::tuple_size_v<decltype(buffers)> == unit_count);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        std::vector<unsigned char> bytes(buffers[i]->getInfo<CL_MEM_SIZE>());
        try {
            queue.enqueueReadBuffer(*buffers[i], CL_TRUE, 0, bytes.size(), bytes.data());
        } catch (const cl::Error& error) {
            throw DeviceError(std::string("gl: ") + kinds[i].name +
                              " cannot be read from the device (OpenCL error " +
                              std::to_string(error.err()) + ")");
        }
        textures_[i] = upload(kinds[i], std::move(bytes));
    }
}

void SceneData::bind() const {
    for (int i = 0; i < unit_count; ++i) {
        glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
        glBindTexture(GL_TEXTURE_2D, textures_[static_cast<std::size_t>(i)].name());
    }
}

void SceneData::connect(const Object& program) const {
    for (int i = 0; i < unit_count; ++i) glUniform1i(uniform(program, kinds[i].name), i);
    glUniform1ui(uniform(program, "scene_flags"), flags_);
}

}  // namespace clgi::gl
