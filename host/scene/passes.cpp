// SPDX-License-Identifier: MIT
#include <clgi/passes/scene.hpp>

#include "opencl/launch.hpp"
#include "opencl/program.hpp"

namespace clgi {

ScenePasses::ScenePasses(const cl::Context& context, const cl::Device& device,
                         const BuildOptions& options) {
    auto kernels = build_room(context, device, "scene", {"clusters"}, options);
    clusters_ = kernels[0];
}

cl::Event ScenePasses::clusters(const cl::CommandQueue& queue, DeviceScene& scene,
                                const WaitList& wait) const {
    const SceneInfo& info = scene.info();
    return launch(clusters_, queue, info.cluster_count, wait, info.triangle_count,
                  scene.triangles(), scene.positions(), scene.clusters());
}

}  // namespace clgi
