// From VPLs and points to a picture, one method per kernel. Structs: clgi/shared/image.h.
// Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/image.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// What combine reads and writes.
struct CombineBuffers {
    EmitterBuffers emitters;
    GBuffer gbuffer;
    cl::Buffer irradiance;  // [IRRADIANCE_PLANES][stride]; not read without COMBINE_INDIRECT
    cl::Buffer radiance;    // [RADIANCE_PLANES][stride] cd/m^2
    cl::Buffer non_finite;  // [1] uint, only added to
};

// Size, exposure, bias and shadow maps for a picture of the scene, and COMBINE_MATERIALS if its
// materials need it. The caller adds the other effects.
CLGI_API CombineParams combine_params(const DeviceScene& scene, const View& view,
                                      std::uint32_t stride, std::size_t emitters,
                                      Pixels shadow_maps);

// For the scene's environment; the scene must have one.
// turned: about +Y, radians, beside the environment's own rotation.
CLGI_API EnvironmentParams environment_params(const DeviceScene& scene, std::uint32_t stride,
                                              double turned = 0.0);

class CLGI_API ImagePasses {
public:
    explicit ImagePasses(const Programs& programs, const BuildOptions& options = {});
    ImagePasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {})
        : ImagePasses(Programs(context, device), options) {}

    // Irradiance [IRRADIANCE_PLANES][stride] of points [POINT_PLANES][stride] by VPLs (lights) less
    // negative VPLs, for those of the range that are among the first *point_count. A range begins
    // at a multiple of 16.
    cl::Event gather(const cl::CommandQueue& queue, const GatherParams& params, const Range& range,
                     const cl::Buffer& point_count, const cl::Buffer& points,
                     const cl::Buffer& lights, const cl::Buffer& negative,
                     const cl::Buffer& irradiance, const WaitList& wait = {}) const;

    // counts: [pixels / COMPACT_BLOCK, rounded up] uint. ParallelPasses::offsets turns them into
    // the offsets that compact takes.
    cl::Event count(const cl::CommandQueue& queue, std::uint32_t pixels, const cl::Buffer& flags,
                    const cl::Buffer& counts, const WaitList& wait = {}) const;

    // Lists the flagged pixels: listed [stride] uint, points [POINT_PLANES][stride], point_count
    // [1].
    cl::Event compact(const cl::CommandQueue& queue, const RefineParams& params,
                      const cl::Buffer& flags, const cl::Buffer& offsets, const cl::Buffer& planes,
                      const cl::Buffer& listed, const cl::Buffer& points,
                      const cl::Buffer& point_count, const WaitList& wait = {}) const;

    // low [IRRADIANCE_PLANES][low_stride] -> irradiance [IRRADIANCE_PLANES][stride], and flags
    // [width * height] uchar, 1 where the pixel must be gathered itself.
    cl::Event upsample(const cl::CommandQueue& queue, const RefineParams& params,
                       const cl::Buffer& planes, const cl::Buffer& points, const cl::Buffer& low,
                       const cl::Buffer& irradiance, const cl::Buffer& flags,
                       const WaitList& wait = {}) const;

    // refined [IRRADIANCE_PLANES][stride] of listed pixels -> irradiance, the same.
    cl::Event place(const cl::CommandQueue& queue, const RefineParams& params,
                    const cl::Buffer& point_count, const cl::Buffer& listed,
                    const cl::Buffer& refined, const cl::Buffer& irradiance,
                    const WaitList& wait = {}) const;

    // Emission, direct and indirect light of every pixel of the view. Packets with numbers that are
    // not finite are counted and sanitised.
    cl::Event combine(const cl::CommandQueue& queue, const CombineParams& params, const View& view,
                      const DeviceScene& scene, const CombineBuffers& buffers,
                      const WaitList& wait = {}) const;

    // Background pixels of the view (no normal in planes) -> radiance
    // [RADIANCE_PLANES][stride]; texels: [environment_height][environment_width][3] float, times
    // the factor in cd/m^2.
    cl::Event environment(const cl::CommandQueue& queue, const EnvironmentParams& params,
                          const View& view, const cl::Buffer& texels, const cl::Buffer& planes,
                          const cl::Buffer& radiance, const WaitList& wait = {}) const;

    // radiance: [RADIANCE_PLANES][stride], mean: [MEAN_PLANES][stride]; all 0 before the first
    // sample.
    cl::Event accumulate(const cl::CommandQueue& queue, const AccumulateParams& params,
                         const cl::Buffer& radiance, const cl::Buffer& mean,
                         const WaitList& wait = {}) const;

    // preview: [width * height] uint, RGBA8.
    cl::Event tonemap(const cl::CommandQueue& queue, const TonemapParams& params,
                      const cl::Buffer& radiance, const cl::Buffer& preview,
                      const WaitList& wait = {}) const;

    int packet_width() const { return gather_.packet_width; }

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel gather_, count_, compact_, upsample_, place_, combine_, accumulate_, tonemap_,
        environment_;
};

}  // namespace clgi
