// Sampling emitters, placing VPLs, direct light; one method per kernel. Structs:
// clgi/shared/lights.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/lights.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// The emitters with their shadow maps.
struct EmitterBuffers {
    cl::Buffer emitters;         // [emitter_count] Emitter
    cl::Buffer views;            // of all emitters, View
    cl::Buffer visibility;       // [pixels of all views] ulong, or uint where kind is depth
    std::size_t view_count = 0;  // how many views and pixels the buffers must hold at least
    std::size_t pixels = 0;
    Pixels kind = Pixels::visibility;
};

class CLGI_API LightPasses {
public:
    explicit LightPasses(const Programs& programs, const BuildOptions& options = {});
    LightPasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {})
        : LightPasses(Programs(context, device), options) {}

    // Which Halton candidates lie in the cone. mask: [candidate_count / 32] uint.
    cl::Event accept_mask(const cl::CommandQueue& queue, const AcceptParams& params,
                          const cl::Buffer& emitters, const cl::Buffer& mask,
                          const WaitList& wait = {}) const;

    // The first accepted candidates in index order -> accepted [vpl_count of all emitters] uint.
    cl::Event accept_list(const cl::CommandQueue& queue, const AcceptParams& params,
                          const cl::Buffer& emitters, const cl::Buffer& mask,
                          const cl::Buffer& accepted, const WaitList& wait = {}) const;

    // lights: [vpl_count] Vpl. The shadow maps must hold visibility.
    cl::Event fetch(const cl::CommandQueue& queue, const FetchParams& params,
                    const DeviceScene& scene, const EmitterBuffers& sources,
                    const cl::Buffer& accepted, const cl::Buffer& lights,
                    const WaitList& wait = {}) const;

    // planes: a G-buffer with geometric normals; lights: the VPLs; negative: [negative_count] Vpl.
    cl::Event negative(const cl::CommandQueue& queue, const NegativeParams& params,
                       const View& view, const cl::Buffer& planes, const cl::Buffer& lights,
                       const cl::Buffer& negative, const WaitList& wait = {}) const;

    // The same for a range of the samples.
    cl::Event negative(const cl::CommandQueue& queue, const NegativeParams& params,
                       const Range& samples, const View& view, const cl::Buffer& planes,
                       const cl::Buffer& lights, const cl::Buffer& negative,
                       const WaitList& wait = {}) const;

    // Shadowed direct irradiance, exposed lux, by emitter_count emitters from first_emitter on, of
    // the first point_count points of planes
    // [>= GBUFFER_GEOMETRIC + 3][stride] -> irradiance [IRRADIANCE_PLANES][stride]. A point with a
    // number that is not finite gets NaN; packets with such points are counted in non_finite [1]
    // uint, which is only added to.
    cl::Event direct(const cl::CommandQueue& queue, const DirectParams& params,
                     const EmitterBuffers& sources, const cl::Buffer& planes,
                     const cl::Buffer& irradiance, const cl::Buffer& non_finite,
                     const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel accept_mask_, accept_list_, fetch_, negative_, direct_;
    bool textures_;
};

}  // namespace clgi
