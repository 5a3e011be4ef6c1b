// Filling a light atlas, one method per kernel. Structs: clgi/shared/atlas.h. Rules for all
// methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/atlas.h>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>
#include <clgi/passes/vpl.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

class CLGI_API AtlasPasses {
public:
    explicit AtlasPasses(const Programs& programs, const BuildOptions& options = {});
    AtlasPasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {})
        : AtlasPasses(Programs(context, device), options) {}

    // Adds the light of a batch of VPLs to texels. views, depth: their hemicubes.
    // texels: a G-buffer's planes, float; irradiance: [3][stride] float, exposed lux.
    cl::Event gather(const cl::CommandQueue& queue, const FillParams& params,
                     const SiteBuffers& buffers, const cl::Buffer& views, const cl::Buffer& depth,
                     const cl::Buffer& texels, const cl::Buffer& irradiance,
                     const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel gather_;
};

}  // namespace clgi
