// SPDX-License-Identifier: MIT
#include "plan/probe.hpp"

#include <algorithm>
#include <chrono>
#include <clgi/solvers/second_order.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr int longest_side = 160;  // pixels
constexpr int probe_vpls = 256;
constexpr double coarse = 0.25;  // direct light, against the defaults

std::vector<double> luminances(const cl::CommandQueue& queue, const SecondOrderSolver& solver,
                               const cl::Event& done) {
    const std::size_t pixels =
        static_cast<std::size_t>(solver.options().width) * solver.options().height;
    std::vector<float> planes(3 * static_cast<std::size_t>(solver.stride()));
    const WaitList wait{done};
    queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, 0, planes.size() * sizeof(float),
                            planes.data(), &wait);
    std::vector<double> out(pixels);
    for (std::size_t k = 0; k < pixels; ++k)
        out[k] = luminance(glm::dvec3(planes[k], planes[k + solver.stride()],
                                      planes[k + 2 * static_cast<std::size_t>(solver.stride())]));
    return out;
}

// Root of the mean squared difference.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

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

ProbeFacts probe(const cl::CommandQueue& queue, const Programs& programs, const DeviceScene& scene,
                 const Camera& camera, const Plan& plan) {
    const PlanWish& wish = plan.wish;
    SecondOrderOptions options;
    const double shrink =
        std::min(1.0, static_cast<double>(longest_side) / std::max(wish.width, wish.height));
    options.width = std::max(1, static_cast<int>(std::lround(wish.width * shrink)));
    options.height = std::max(1, static_cast<int>(std::lround(wish.height * shrink)));
    options.emitters.vpls = probe_vpls;
    make_fine(options.emitters, coarse);
    options.negative_vpls = 0;
    options.low_resolution_step = 1;
    options.build = wish.build;
    options.indirect = plan.on(Effect::first_bounce);
    SecondOrderSolver solver(programs, queue, scene, options);
    const auto start = std::chrono::steady_clock::now();  // kernels are built
    const std::vector<double> lit = luminances(queue, solver, solver.render(camera));
    const double flux = options.indirect ? reflected_flux(queue, solver) : 0.0;
    options.indirect = false;
    solver.reconfigure(options);
    const std::vector<double> direct = luminances(queue, solver, solver.render(camera));

    make_fine(options.emitters, 2.0 * coarse);
    solver.reconfigure(options);
    const std::vector<double> finer = luminances(queue, solver, solver.render(camera));

    double sum = 0.0;
    for (const double one : lit) sum += one;
    const double count = static_cast<double>(lit.size());
    const SceneFrame& frame = scene.frame();
    const double lumen = flux * frame.exposure / (frame.scale * frame.scale);
    const double radiance = lumen / (std::numbers::pi * plan.facts.surfaces.area);
    ProbeFacts out;
    // A picture without light tells nothing about light that arrives over more bounces.
    out.first_bounce = out.reflected = out.direct_error = std::numeric_limits<double>::infinity();
    if (sum > 0.0) {
        out.first_bounce = distance(lit, direct) / (sum / count);
        out.direct_error = std::sqrt(coarse) * distance(direct, finer) / (sum / count);
        out.reflected = radiance / (sum / count);
    }
    out.milliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace clgi
