// SPDX-License-Identifier: MIT
#include "plan/probe.hpp"

#include <algorithm>
#include <clgi/second_order.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/opencl/timing.hpp"
#include "plan/picture_luminance.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr int longest_side = 160;  // pixels
constexpr int probe_vpls = 256;
constexpr double coarse = 0.25;  // direct light, against the defaults

void make_fine(EmitterOptions& options, double fineness) {
    const EmitterOptions usual;
    options.shadow_size = static_cast<int>(usual.shadow_size * fineness);
    options.face_size = static_cast<int>(usual.face_size * fineness);
    options.area_samples = static_cast<int>(usual.area_samples * fineness);
}

// lumen that surfaces reflect of direct light
double reflected_flux(const cl::CommandQueue& queue, const SecondOrderSolver& solver) {
    std::vector<Vpl> vpls(solver.emitters().vpl_count);
    if (vpls.empty()) return 0.0;
    queue.enqueueReadBuffer(solver.vpls(), CL_TRUE, 0, vpls.size() * sizeof(Vpl), vpls.data());
    double out = 0.0;
    for (const Vpl& vpl : vpls) out += luminance(glm::dvec3(vpl.flux.x, vpl.flux.y, vpl.flux.z));
    return out;
}

}  // namespace

ProbeResult probe(const cl::CommandQueue& queue, const Programs& programs, const DeviceScene& scene,
                  const Camera& camera, const Plan& plan) {
    const PlanRequest& request = plan.request;
    SecondOrderOptions options;
    const double shrink =
        std::min(1.0, static_cast<double>(longest_side) / std::max(request.width, request.height));
    options.width = std::max(1, static_cast<int>(std::lround(request.width * shrink)));
    options.height = std::max(1, static_cast<int>(std::lround(request.height * shrink)));
    options.emitters.vpls = probe_vpls;
    make_fine(options.emitters, coarse);
    options.negative_vpls = 0;
    options.low_resolution_step = 1;
    options.build = request.build;
    options.indirect = plan.on(Effect::first_bounce);
    SecondOrderSolver solver(programs, queue, scene, options);
    const auto start = timing::Clock::now();  // kernels are built
    const std::vector<double> lit = picture_luminance(queue, solver, solver.render(camera));
    const double flux = options.indirect ? reflected_flux(queue, solver) : 0.0;
    const bool unseen = options.indirect && !(flux > 0.0);
    options.indirect = false;
    solver.reconfigure(options);
    const std::vector<double> direct = picture_luminance(queue, solver, solver.render(camera));

    make_fine(options.emitters, 2.0 * coarse);
    solver.reconfigure(options);
    const std::vector<double> finer = picture_luminance(queue, solver, solver.render(camera));

    const SceneFrame& frame = scene.frame();
    const double lumen = flux * frame.exposure / (frame.scale * frame.scale);
    const double radiance = lumen / (std::numbers::pi * plan.analysis.surfaces.area);
    ProbeResult out;
    const double level = mean(lit);
    // A picture without light tells nothing about light that arrives over more bounces, and VPLs
    // without light nothing about what lights the picture.
    out.first_bounce = out.reflected = out.direct_error = std::numeric_limits<double>::infinity();
    if (level > 0.0)
        out.direct_error = std::sqrt(coarse * mean_square_difference(direct, finer)) / level;
    if (level > 0.0 && !unseen) {
        out.first_bounce = std::sqrt(mean_square_difference(lit, direct)) / level;
        out.reflected = radiance / level;
    }
    out.milliseconds = timing::milliseconds(timing::Clock::now() - start);
    return out;
}

}  // namespace clgi
