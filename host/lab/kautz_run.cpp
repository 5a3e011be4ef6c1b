// SPDX-License-Identifier: MIT
#include "lab/kautz_run.hpp"
#include "lab/timing.hpp"

#include <chrono>
#include <clgi/mesh/simplify.hpp>
#include <cmath>

namespace clgi::lab {
namespace {

// About `count` triangles for the far blockers. Parts of a few triangles stay whole: as solids of
// four they would no longer cover what is under them, such as the nails of the hand.
std::vector<glm::uvec3> coarse_mesh(Scene scene, std::size_t count) {
    constexpr std::uint32_t few = 32;
    std::vector<glm::uvec3> small;
    std::vector<SceneTriangle> rest;
    for (const Part& part : scene.parts)
        for (std::uint32_t i = 0; i < part.triangle_count; ++i) {
            const SceneTriangle& triangle = scene.triangles[part.first_triangle + i];
            if (part.triangle_count <= few)
                small.emplace_back(triangle.vertex[0], triangle.vertex[1], triangle.vertex[2]);
            else
                rest.push_back(triangle);
        }
    scene.triangles = std::move(rest);
    scene.parts.clear();
    std::vector<glm::uvec3> out = mesh::simplify(scene, count);
    out.insert(out.end(), small.begin(), small.end());
    return out;
}

}  // namespace

KautzRun::KautzRun(const KautzSetup& setup, const Programs& programs, const Scene& scene,
                   std::size_t paper_coarse, const KautzSettings& settings, int looks)
    : queue_(setup.queue),
      device_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(), setup.queue.getInfo<CL_QUEUE_DEVICE>(),
              scene),
      animator_(setup.queue, scene, device_, setup.build),
      solver_(programs, setup.queue, scene, device_,
              options(setup, scene, paper_coarse, settings)) {
    if (!settings.sets) return;
    for (int look = 0; look < looks; ++look) {
        const Animated at = animator_.animate(0, duration() * look / looks);
        solver_.look({at.done}).wait();
    }
    solver_.restrict(solver_.sets());
}

DynamicTransferOptions KautzRun::options(const KautzSetup& setup, const Scene& scene,
                                         std::size_t coarse, const KautzSettings& settings) {
    DynamicTransferOptions out;
    out.masks = settings.masks;
    out.cells = settings.cells;
    out.rings = settings.rings;
    out.build = setup.build;
    if (settings.coarse > 0.0) {
        const double time = settings.pose * scene.animation->clips[0].duration;
        out.coarse =
            coarse_mesh(posed(scene, pose_at(*scene.animation, 0, time)),
                        static_cast<std::size_t>(std::lround(settings.coarse * double(coarse))));
        coarse_ = out.coarse.size();
    }
    return out;
}

double KautzRun::frame(double seconds) {
    const Clock::time_point begin = Clock::now();
    const Animated at = animator_.animate(0, seconds);
    solver_.transfer({at.done});
    solver_.light();
    queue_.finish();
    return milliseconds(Clock::now() - begin);
}

KautzRun::Steps KautzRun::steps(double seconds, const std::optional<glm::dvec3>& eye) {
    Steps out;
    const Clock::time_point begin = Clock::now();
    animator_.animate(0, seconds).done.wait();
    out.pose_ms = milliseconds(Clock::now() - begin);
    const auto keep = [&] {
        queue_.finish();
        for (const PassEvent& pass : solver_.events()) out.passes.push_back(pass);
    };
    solver_.transfer();
    keep();
    if (eye) {
        solver_.reflect(device_.frame().to_local(*eye));
        keep();
    }
    solver_.light();
    keep();
    return out;
}

std::vector<double> KautzRun::vectors(const std::vector<std::uint32_t>& vertices) const {
    const ReceiverBuffers& receivers = solver_.receivers();
    const auto terms = static_cast<std::size_t>(sh::terms(solver_.options().masks.bands));
    std::vector<float> all(terms * receivers.stride);
    queue_.enqueueReadBuffer(receivers.transfer, CL_TRUE, 0, all.size() * sizeof(float),
                             all.data());
    std::vector<std::uint32_t> on_device(device_.file_vertex_count(), ~0u);
    for (std::uint32_t v = 0; v < device_.vertex_order().size(); ++v)
        on_device[device_.vertex_order()[v]] = v;
    std::vector<double> out;
    out.reserve(vertices.size() * terms);
    for (const std::uint32_t v : vertices)
        for (std::size_t i = 0; i < terms; ++i)
            out.push_back(all[i * receivers.stride + on_device[v]]);
    return out;
}

}  // namespace clgi::lab
