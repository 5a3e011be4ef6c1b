// A scene drawn by OpenGL: the same G-buffer as the OpenCL rasteriser's, as textures.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/gl/gbuffer.hpp>
#include <memory>

namespace clgi::gl {

// Draws triangles to a visibility texture, and every visible pixel's attributes from there, as the
// passes of the gbuffer room do. Corners are rounded to 1/256 pixel in the same way and attributes
// come from the same formulas, so pictures agree up to rounding and to pixels on an edge.
//
// Needs an OpenGL context (3.3 core or later, not ES) current in all its functions, the destructor
// too, and leaves its state changed: give it a context of its own.
class CLGI_API SceneRenderer {
public:
    // Reads the scene's buffers back from the device, once, and waits for that; neither scene nor
    // queue is needed afterwards. Throws DeviceError when OpenGL cannot hold them.
    SceneRenderer(const cl::CommandQueue& queue, const DeviceScene& scene);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    // Any view in the scene's local frame. Enqueues OpenGL commands and does not wait for them.
    // Textures are made anew when the size changes. Throws Error for a size out of range,
    // DeviceError when OpenGL fails.
    void draw(const View& view);

    // What was drawn last: position, normal, geometric, albedo and emission RGBA32F, depth R32F,
    // ids RG32I (material; triangle as the device counts, DeviceScene::triangle_order() leads
    // back). Valid until the next draw. All 0 before the first.
    const GBufferTextures& textures() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::gl
