// What changes a scene on the device, one method a kernel. Structs: clgi/shared/scene.h.
// Rules for all methods: clgi/passes/gbuffer.hpp. SceneMover calls them in the right order.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>

namespace clgi {

class CLGI_API ScenePasses {
public:
    ScenePasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {});

    // Writes scene.clusters() for the positions as they are.
    cl::Event clusters(const cl::CommandQueue& queue, DeviceScene& scene,
                       const WaitList& wait = {}) const;

private:
    PassKernel clusters_;
};

}  // namespace clgi
