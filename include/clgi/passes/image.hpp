// From lights and points to a picture, one method a kernel. Structs: clgi/shared/image.h.
// Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/image.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>
#include <clgi/planes.hpp>
#include <clgi/passes/lights.hpp>

namespace clgi {

class CLGI_API ImagePasses {
public:
    ImagePasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {});

    // points [POINT_PLANES][stride] lit by lights and negative lights into irradiance
    // [IRRADIANCE_PLANES][stride], for those of the range that are among the first *point_count.
    // A range begins at a multiple of 16.
    cl::Event gather(const cl::CommandQueue& queue, const GatherParams& params, const Range& range,
                     const cl::Buffer& point_count, const cl::Buffer& points,
                     const cl::Buffer& lights, const cl::Buffer& negative,
                     const cl::Buffer& irradiance, const WaitList& wait = {}) const;

    // counts: [pixels / COMPACT_BLOCK, rounded up] uint. ParallelPasses::offsets makes of them the
    // offsets that compact takes.
    cl::Event count(const cl::CommandQueue& queue, std::uint32_t pixels, const cl::Buffer& flags,
                    const cl::Buffer& counts, const WaitList& wait = {}) const;

    // Flagged pixels in a row: listed [stride] uint, points [POINT_PLANES][stride], point_count
    // [1].
    cl::Event compact(const cl::CommandQueue& queue, const RefineParams& params,
                      const cl::Buffer& flags, const cl::Buffer& offsets, const cl::Buffer& planes,
                      const cl::Buffer& listed, const cl::Buffer& points,
                      const cl::Buffer& point_count, const WaitList& wait = {}) const;

    // low [IRRADIANCE_PLANES][low_stride] -> irradiance [IRRADIANCE_PLANES][stride], and flags
    // [width * height] uchar, 1 where low resolution does not suit.
    cl::Event upsample(const cl::CommandQueue& queue, const RefineParams& params,
                       const cl::Buffer& planes, const cl::Buffer& points, const cl::Buffer& low,
                       const cl::Buffer& irradiance, const cl::Buffer& flags,
                       const WaitList& wait = {}) const;

    // refined [IRRADIANCE_PLANES][stride] of listed pixels -> irradiance, the same.
    cl::Event place(const cl::CommandQueue& queue, const RefineParams& params,
                    const cl::Buffer& point_count, const cl::Buffer& listed,
                    const cl::Buffer& refined, const cl::Buffer& irradiance,
                    const WaitList& wait = {}) const;

    // radiance: [RADIANCE_PLANES][stride] cd/m^2; non_finite [1] uint is only added to.
    cl::Event combine(const cl::CommandQueue& queue, const CombineParams& params, const View& view,
                      const DeviceScene& scene, const SourceBuffers& sources,
                      const cl::Buffer& planes, const cl::Buffer& ids, const cl::Buffer& irradiance,
                      const cl::Buffer& radiance, const cl::Buffer& non_finite,
                      const WaitList& wait = {}) const;

    // Pixels of the view in which nothing is (no normal in planes) -> radiance
    // [RADIANCE_PLANES][stride]; texels: [environment_height][environment_width][3] float, times
    // the factor in cd/m^2.
    cl::Event environment(const cl::CommandQueue& queue, const EnvironmentParams& params,
                          const View& view, const cl::Buffer& texels, const cl::Buffer& planes,
                          const cl::Buffer& radiance, const WaitList& wait = {}) const;

    // preview: [width * height] uint, RGBA8.
    cl::Event tonemap(const cl::CommandQueue& queue, const TonemapParams& params,
                      const cl::Buffer& radiance, const cl::Buffer& preview,
                      const WaitList& wait = {}) const;

    int packet_width() const { return gather_.packet_width; }

private:
    PassKernel gather_, count_, compact_, upsample_, place_, combine_, tonemap_, environment_;
};

}  // namespace clgi
