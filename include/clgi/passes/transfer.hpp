// Light and visibility in spherical harmonics, one method per kernel. Structs:
// clgi/shared/transfer.h, conventions: clgi/advanced/sh.hpp. Rules for all methods:
// clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/transfer.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/advanced/sh.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>
#include <vector>

namespace clgi {

// How the picture of an environment becomes coefficients. Coefficients are in the world's frame:
// the polar axis of their basis is z, though the picture's is +Y.
struct CLGI_API EnvironmentProjection {
    // Of a picture of this size and a light of so many bands, 1 to SH_MOST_BANDS.
    EnvironmentProjection(int width, int height, int bands);

    int bands;
    ProjectParams params{};             // factor 1, no directional lights
    std::vector<float> row_weights;     // [height][SH_WAVES(bands)]
    std::vector<float> column_weights;  // [SH_WAVES(bands)][params.stride]
    std::vector<float> waves;           // [SH_MOMENT(bands, 0)][bands]

    std::size_t sums_bytes() const;    // scratch of the first step
    std::size_t leaves_bytes() const;  // of the second
};

// sh::Rotation::blocks() of an environment turned by this angle (Environment::rotation), radians.
CLGI_API std::vector<float> environment_rotation(double angle, int bands);

// The scene's directional lights, exposed.
CLGI_API std::vector<DirectionalLight> directional_lights(const DeviceScene& scene);

// Of `count` receivers with normals in the planes from `normal` on; nothing is negative.
CLGI_API OpenParams open_params(int bands, sh::Window window, std::uint32_t normal,
                                std::uint32_t count, std::uint32_t stride);

struct ProjectionBuffers {
    cl::Buffer texels;          // [height][width][3] float: DeviceScene::environment_texels()
    cl::Buffer row_weights;     // of EnvironmentProjection
    cl::Buffer column_weights;  // of EnvironmentProjection
    cl::Buffer waves;           // of EnvironmentProjection
    cl::Buffer rotation;        // [sh::rotation_block(bands)] float: environment_rotation()
    cl::Buffer lights;          // [light_count] DirectionalLight; none if there are no lights
    cl::Buffer sums;            // EnvironmentProjection::sums_bytes()
    cl::Buffer leaves;          // EnvironmentProjection::leaves_bytes()
    cl::Buffer light;           // [terms] float4: rgb exposed cd/m^2 sr; w: 0
    cl::Buffer non_finite;      // [1] uint, only added to: floats of the picture read as 0
};

class CLGI_API TransferPasses {
public:
    // bands: of light and transfer vectors, 1 to SH_MOST_BANDS.
    explicit TransferPasses(const Programs& programs, const BuildOptions& options = {},
                            int bands = SH_DEFAULT_BANDS);
    TransferPasses(const cl::Context& context, const cl::Device& device,
                   const BuildOptions& options = {}, int bands = SH_DEFAULT_BANDS)
        : TransferPasses(Programs(context, device), options, bands) {}

    int bands() const { return bands_; }

    // Reads the picture -> sums, non_finite. Only this step reads the picture.
    cl::Event project_rows(const cl::CommandQueue& queue, const ProjectParams& params,
                           const ProjectionBuffers& buffers, const WaitList& wait = {}) const;

    // sums -> leaves.
    cl::Event project_columns(const cl::CommandQueue& queue, const ProjectParams& params,
                              const ProjectionBuffers& buffers, const WaitList& wait = {}) const;

    // leaves, rotation, lights -> light. Alone when only the factor, the rotation or the lights
    // have changed.
    cl::Event project_environment(const cl::CommandQueue& queue, const ProjectParams& params,
                                  const ProjectionBuffers& buffers,
                                  const WaitList& wait = {}) const;

    // The three of them in a row. Refuses what one of them would refuse before the first runs.
    cl::Event project(const cl::CommandQueue& queue, const ProjectParams& params,
                      const ProjectionBuffers& buffers, const WaitList& wait = {}) const;

    // What arrives at receivers of which nothing blocks the light -> irradiance [3][params.stride].
    // planes: of receivers (MaskPasses::receivers; BuildOptions::storage must be full), or a
    // G-buffer's. light: [terms] float4. non_finite: [1] uint, counts packets.
    cl::Event open(const cl::CommandQueue& queue, const OpenParams& params,
                   const cl::Buffer& planes, const cl::Buffer& light, const cl::Buffer& irradiance,
                   const cl::Buffer& non_finite, const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    int bands_;
    std::size_t column_parts_ = 1;  // work-items of project_columns for each wave
    PassKernel project_rows_, project_columns_, project_environment_, open_;
};

}  // namespace clgi
