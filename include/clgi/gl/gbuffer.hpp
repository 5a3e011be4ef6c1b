// From the textures of any engine to a clgi G-buffer.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/gl/sharing.hpp>
#include <clgi/passes/import.hpp>
#include <memory>

namespace clgi::gl {

// Names of OpenGL 2D textures, level 0 of each, all of the view's size; 0: none.
// The normal is zero in the background. Without positions, depth that is not above 0 is background.
struct GBufferTextures {
    unsigned position = 0;   // RGBA32F; xyz: world, metres, relative to `origin`
    unsigned normal = 0;     // RGBA16F, RGBA32F; xyz: shading normal in world space, any length
    unsigned geometric = 0;  // RGBA16F, RGBA32F; of the triangle; 0: the shading normal is used
    unsigned albedo = 0;     // RGBA8, RGBA16F, RGBA32F; rgb: linear base colour, [0,1]; without a
                             // material id it is the diffuse reflectance
    unsigned emission = 0;   // RGBA16F, RGBA32F; rgb: radiance, cd/m^2; 0: none
    unsigned depth = 0;      // R32F; along the view's axis, metres; 0: from positions
    unsigned ids = 0;        // R32I: index of the material in the scene, -1: unknown;
                             // RG32I: with the device's triangle index, -1: unknown
    // normal and albedo are required, and position or depth.

    bool top_first = false;               // row 0 is the top row; in OpenGL it is the bottom row
    glm::dvec3 origin = glm::dvec3(0.0);  // metres; for large worlds, such as the camera's place
};

// All functions, including the destructor, need the OpenGL context (3.3 or later, not ES) of the
// textures current on the calling thread. OpenGL state is left as it was found.
class CLGI_API GBufferImport {
public:
    // Chooses between zero copy and copy, with find_sharing or as given; the first conversion
    // builds the kernel. The storage of `options` must be that of the G-buffers to write, such as a
    // solver's.
    // Throws Error when no OpenGL context is current.
    GBufferImport(const cl::Context& context, const cl::Device& device,
                  const BuildOptions& options = {});
    GBufferImport(const cl::Context& context, const cl::Device& device, const Sharing& sharing,
                  const BuildOptions& options = {});
    ~GBufferImport();
    GBufferImport(const GBufferImport&) = delete;
    GBufferImport& operator=(const GBufferImport&) = delete;

    // Converts textures of the view to planes and ids in the scene's local frame, exposed.
    //
    // Earlier OpenGL commands of the current context finish before textures are read. Writing `out`
    // waits for `wait`. The event covers the whole conversion: once it is complete, `out` holds the
    // G-buffer and the textures may be drawn to again.
    // A texel with a number that is not finite becomes background and is counted.
    // Throws Error for a texture that is missing, of another size or of another format, naming what
    // it got and what it needs, and for a pending OpenGL error; DeviceError when OpenGL or OpenCL
    // fails.
    cl::Event convert(const cl::CommandQueue& queue, const View& view, const DeviceScene& scene,
                      const GBufferTextures& textures, const GBuffer& out,
                      const WaitList& wait = {});

    // Releases the OpenCL images that zero copy keeps of the textures of the last conversion.
    // convert() reuses them for textures of the same name, size and format. Call this if a texture
    // was deleted, or its storage specified anew, and another one of the same name, size and format
    // follows: OpenGL does not tell the two apart. Not needed for any other change.
    void forget_textures();

    // Of the last conversion; before the first one, the choice of the constructor.
    bool zero_copy() const;
    const std::string& path() const;  // "zero copy: ...", "copied: ..."

    // Texels that were not finite, since the start. Waits for the last conversion.
    std::uint32_t non_finite() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::gl
