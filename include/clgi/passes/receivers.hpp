// Receivers at pixels and on other sides, and what arrives at receivers brought to pixels; one
// method per kernel. Structs: clgi/shared/receivers.h. Rules for all methods:
// clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/receivers.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/masks.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// Some pixels of a picture: their numbers, and how many they are.
struct PixelList {
    cl::Buffer pixels;  // [*listed] uint, row by row
    cl::Buffer listed;  // [1] uint
};

class CLGI_API ReceiverPasses {
public:
    explicit ReceiverPasses(const Programs& programs, const BuildOptions& options = {});

    // Receivers params.first to params.first + params.count - 1 become the other sides of
    // `fronts` [params.count] uint, which lie before them.
    cl::Event other_sides(const cl::CommandQueue& queue, const SidesParams& params,
                          const cl::Buffer& fronts, const ReceiverBuffers& receivers,
                          const WaitList& wait = {}) const;

    // Receivers at a run of listed pixels, and the exponents [params.stride] float of their lobes.
    // seen has positions, normals, geometric normals and materials.
    cl::Event pixels(const cl::CommandQueue& queue, const PixelParams& params,
                     const PixelList& list, const DeviceScene& scene, const GBuffer& seen,
                     const ReceiverBuffers& receivers, const cl::Buffer& exponents,
                     const WaitList& wait = {}) const;

    // light [3][params.stride] of those receivers -> shown [3][params.pixel_stride].
    cl::Event place(const cl::CommandQueue& queue, const PixelParams& params, const PixelList& list,
                    const cl::Buffer& light, const cl::Buffer& shown,
                    const WaitList& wait = {}) const;

    // light [3][params.receiver_stride] of the scene's vertices, and of their other sides
    // (other_side [vertex_count] uint: receiver or RECEIVER_NONE) -> shown [3][pixel_stride].
    // seen has positions and triangles.
    cl::Event show(const cl::CommandQueue& queue, const ShowVerticesParams& params,
                   const DeviceScene& scene, const cl::Buffer& other_side, const GBuffer& seen,
                   const cl::Buffer& light, const cl::Buffer& shown,
                   const WaitList& wait = {}) const;

    // probes [4][params.probe_stride]: what arrives at the probes becomes what is missing in shown
    // there; the last plane becomes the sum of what is shown. states [columns * rows] uint:
    // PROBE_...
    cl::Event compare_probes(const cl::CommandQueue& queue, const ProbeParams& params,
                             const GBuffer& seen, const cl::Buffer& shown, const cl::Buffer& probes,
                             const cl::Buffer& states, const WaitList& wait = {}) const;

    // The same of gloss [3][params.pixel_stride] as it is shown, after compare_probes: more probes
    // fail where materials have lobes. shown: what arrives. seen has base colours and materials.
    cl::Event compare_gloss(const cl::CommandQueue& queue, const ProbeParams& params,
                            const DeviceScene& scene, const GBuffer& seen, const cl::Buffer& shown,
                            const cl::Buffer& gloss, const cl::Buffer& probes,
                            const cl::Buffer& states, const WaitList& wait = {}) const;

    // flags [width * height] uchar of pixels around probes that fail; elsewhere what probes miss is
    // added to shown [3][pixel_stride], at most by the share of it that they miss.
    cl::Event undersampled(const cl::CommandQueue& queue, const ProbeParams& params,
                           const GBuffer& seen, const cl::Buffer& probes, const cl::Buffer& states,
                           const cl::Buffer& shown, const cl::Buffer& flags,
                           const WaitList& wait = {}) const;

    // Adds the lobes' light [3][pixel_stride] to radiance [RADIANCE_PLANES][pixel_stride].
    // non_finite: [1] uint, counts values that are left out.
    cl::Event add_gloss(const cl::CommandQueue& queue, const AddGlossParams& params,
                        const DeviceScene& scene, const GBuffer& seen, const cl::Buffer& light,
                        const cl::Buffer& radiance, const cl::Buffer& non_finite,
                        const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel other_sides_, pixels_, place_, show_, compare_probes_, compare_gloss_, undersampled_,
        add_gloss_;
};

}  // namespace clgi
