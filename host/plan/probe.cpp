// SPDX-License-Identifier: MIT
#include "plan/probe.hpp"

#include <algorithm>
#include <clgi/second_order.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/kit/pass_timing.hpp"
#include "core/opencl/timing.hpp"
#include "plan/expected_error.hpp"
#include "plan/picture_luminance.hpp"
#include "plan/sky.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr int longest_side = 160;  // pixels
constexpr int probe_vpls = 256;
constexpr double coarse = 0.25;  // direct light, against the defaults
constexpr int sky_lights = 4;    // reflections of the sky's light are asked for, not its shadows

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

// The size of its pictures: a fourth of the pixels, so that they take less than the one to come.
void make_small(SecondOrderOptions& options, const PlanRequest& request) {
    const double longest = std::max(request.width, request.height);
    const double shrink = std::min(0.5, longest_side / longest);
    options.width = std::max(1, static_cast<int>(std::lround(request.width * shrink)));
    options.height = std::max(1, static_cast<int>(std::lround(request.height * shrink)));
}

}  // namespace

ProbeResult probe(const cl::CommandQueue& queue, const Programs& programs, const DeviceScene& scene,
                  const Camera& camera, const Plan& plan) {
    SecondOrderOptions options;
    make_small(options, plan.request);
    options.emitters.vpls = probe_vpls;
    make_fine(options.emitters, coarse);
    options.emitters.environment_lights = sky_lights;
    options.negative_vpls = 0;
    options.low_resolution_step = 1;
    options.build = plan.request.build;
    options.indirect = plan.on(Effect::first_bounce);
    SecondOrderSolver solver(programs, queue, scene, options);
    ProbeResult out;
    const auto picture = [&] {
        const auto start = timing::Clock::now();
        std::vector<double> found = picture_luminance(queue, solver, solver.render(camera));
        out.milliseconds += timing::without_compiling(
            queue, timing::milliseconds(timing::Clock::now() - start), solver.events());
        return found;
    };
    const std::vector<double> lit = picture();
    const double level = mean(lit);
    // A picture without light tells nothing about light that arrives over more bounces, and VPLs
    // without light nothing about what lights the picture.
    constexpr double unknown = std::numeric_limits<double>::infinity();
    const auto over_level = [&](double what) { return level > 0.0 ? what / level : unknown; };
    std::vector<double> direct = lit;
    if (options.indirect) {
        const double flux = reflected_flux(queue, solver);
        options.indirect = false;
        solver.reconfigure(options);
        direct = picture();
        const SceneFrame& frame = scene.frame();
        const double lumen = flux * frame.exposure / (frame.scale * frame.scale);
        const bool seen = flux > 0.0;
        out.first_bounce =
            seen ? over_level(std::sqrt(mean_square_difference(lit, direct))) : unknown;
        out.reflected =
            seen ? over_level(lumen / (std::numbers::pi * plan.analysis.surfaces.area)) : unknown;
    }
    // Methods that plans take for a sky are measured with their direct light.
    const bool measured = has_sky(plan) && !plan.request.method;
    if (!has_exact_direct_light(plan) && !measured) {
        make_fine(options.emitters, 2.0 * coarse);
        solver.reconfigure(options);
        out.direct_error =
            over_level(std::sqrt(coarse * mean_square_difference(direct, picture())));
    }
    return out;
}

}  // namespace clgi
