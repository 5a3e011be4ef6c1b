// A scene drawn by OpenGL: the same G-buffer as that of the OpenCL rasteriser, as textures.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/gl/gbuffer.hpp>
#include <memory>

namespace clgi::gl {

// Draws triangles to a visibility texture, and from it the attributes of every visible pixel, as
// the passes of the gbuffer room do. Both round corners to 1/256 pixel in the same way and use the
// same formulas for attributes, so pictures agree except for rounding and pixels on an edge.
//
// All functions, including the destructor, need an OpenGL context (3.3 core or later, not ES)
// current. They leave its state changed, so give the renderer a context of its own.
class CLGI_API SceneRenderer {
public:
    // Reads the scene's buffers back from the device once, and waits for that. Later moves of the
    // geometry are not seen. Scene and queue are not needed afterwards. Throws DeviceError when
    // OpenGL cannot hold them.
    SceneRenderer(const cl::CommandQueue& queue, const DeviceScene& scene);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    // Draws any view in the scene's local frame. Enqueues OpenGL commands and does not wait.
    // Textures are made anew when the size changes. Throws Error for a size out of range,
    // DeviceError when OpenGL fails.
    void draw(const View& view);

    // The last drawing: position, normal, geometric, albedo (base colour) and emission RGBA32F,
    // depth R32F, ids RG32I (material; the device's triangle index, which
    // DeviceScene::triangle_order() maps back). Valid until the next draw. All 0 before the first.
    const GBufferTextures& textures() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::gl
