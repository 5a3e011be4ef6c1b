// A scene's device buffers as OpenGL textures, texel for texel, for shaders to fetch from.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/device_scene.hpp>

#include "gl/objects.hpp"

namespace clgi::gl {

class SceneData {
public:
    // Reads the buffers back and waits. Throws DeviceError when a texture cannot hold one.
    SceneData(const cl::CommandQueue& queue, const DeviceScene& scene);

    // Binds the textures to units 0 to unit_count - 1.
    void bind() const;
    // Tells a program, which must be in use, where they are bound.
    void connect(const Object& program) const;

    static constexpr int unit_count = 9;

private:
    std::array<Object, unit_count> textures_;
    std::uint32_t flags_ = 0;  // SCENE_HAS_...
};

}  // namespace clgi::gl
