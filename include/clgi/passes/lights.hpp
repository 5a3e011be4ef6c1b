// Sampling the sources and placing indirect lights, one method a kernel. Structs:
// clgi/shared/lights.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/lights.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>

namespace clgi {

// The sources with their images of the scene.
struct SourceBuffers {
    cl::Buffer emitters;         // [emitter_count] Emitter
    cl::Buffer views;            // of all emitters, View
    cl::Buffer visibility;       // [pixels of all views] ulong
    std::size_t view_count = 0;  // how many views and pixels the buffers must hold at least
    std::size_t pixels = 0;
};

class CLGI_API LightPasses {
public:
    LightPasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {});

    // Which Halton candidates lie in the cone. mask: [candidate_count / 32] uint.
    cl::Event accept_mask(const cl::CommandQueue& queue, const AcceptParams& params,
                          const cl::Buffer& emitters, const cl::Buffer& mask,
                          const WaitList& wait = {}) const;

    // The first of them, in index order, as accepted [light_count of all emitters] uint.
    cl::Event accept_list(const cl::CommandQueue& queue, const AcceptParams& params,
                          const cl::Buffer& emitters, const cl::Buffer& mask,
                          const cl::Buffer& accepted, const WaitList& wait = {}) const;

    // lights: [light_count] IndirectLight.
    cl::Event fetch(const cl::CommandQueue& queue, const FetchParams& params,
                    const DeviceScene& scene, const SourceBuffers& sources,
                    const cl::Buffer& accepted, const cl::Buffer& lights,
                    const WaitList& wait = {}) const;

    // planes: a G-buffer with geometric normals; negative: [negative_count] IndirectLight.
    cl::Event negative(const cl::CommandQueue& queue, const NegativeParams& params,
                       const View& view, const cl::Buffer& planes, const cl::Buffer& lights,
                       const cl::Buffer& negative, const WaitList& wait = {}) const;

    // The same for a range of the samples.
    cl::Event negative(const cl::CommandQueue& queue, const NegativeParams& params,
                       const Range& samples, const View& view, const cl::Buffer& planes,
                       const cl::Buffer& lights, const cl::Buffer& negative,
                       const WaitList& wait = {}) const;

private:
    PassKernel accept_mask_, accept_list_, fetch_, negative_;
    bool textures_;
};

}  // namespace clgi
