// A G-buffer from another renderer's images, one method per kernel. Layouts: shared/gbuffer.h.
// Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/programs.hpp>

namespace clgi {

// Texels as images of the view's size. Images that ImportParams::flags does not name may be empty.
struct ImportImages {
    cl::Image2D position;  // xyz, metres
    cl::Image2D normal;    // xyz, any length
    cl::Image2D geometric;
    cl::Image2D albedo;    // rgb: linear base colour; without material: diffuse reflectance
    cl::Image2D emission;  // rgb, cd/m^2
    cl::Image2D depth;     // metres along the view's axis
    cl::Image2D labels;    // x: material; y: triangle
};

// The same as rows of texels without gaps; formats are those of ImportParams.
struct ImportBuffers {
    cl::Buffer position;  // [height][width][4] float
    cl::Buffer normal;    // [height][width] normal_format
    cl::Buffer geometric;
    cl::Buffer albedo;
    cl::Buffer emission;
    cl::Buffer depth;   // [height][width] float
    cl::Buffer labels;  // [height][width][1, or 2 with IMPORT_TRIANGLE] int
};

// Scale, exposure and counts of a scene; flags and formats are left at 0. origin: the world point,
// in metres, that positions in the texels are relative to.
CLGI_API ImportParams import_params(const DeviceScene& scene, std::uint32_t stride,
                                    const glm::dvec3& origin = glm::dvec3(0.0));

// Bytes of a texel in a TEXEL_... layout.
CLGI_API std::size_t texel_bytes(std::uint32_t format);

class CLGI_API ImportPasses {
public:
    explicit ImportPasses(const Programs& programs, const BuildOptions& options = {});
    ImportPasses(const cl::Context& context, const cl::Device& device,
                 const BuildOptions& options = {})
        : ImportPasses(Programs(context, device), options) {}

    // Adds the number of pixels that are not finite to non_finite [1] uint.
    cl::Event buffers(const cl::CommandQueue& queue, const View& view, const ImportParams& params,
                      const ImportBuffers& texels, const GBuffer& out, const cl::Buffer& non_finite,
                      const WaitList& wait = {}) const;

    // Throws Error on a device without images.
    cl::Event images(const cl::CommandQueue& queue, const View& view, const ImportParams& params,
                     const ImportImages& texels, const GBuffer& out, const cl::Buffer& non_finite,
                     const WaitList& wait = {}) const;

private:
    PassKernel buffers_, images_;
};

}  // namespace clgi
