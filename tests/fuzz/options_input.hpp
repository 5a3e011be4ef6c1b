// A small valid scene and options of a solver from any bytes: the solver refuses them with
// clgi::Error, or all that it computes is finite. Numbers that are not finite may be counted
// instead only where a choice of the input explains them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "device.hpp"
#include "fuzz/random_scene.hpp"

namespace clgi::fuzz {

constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

struct Input {
    Scene scene;
    DeviceScene placed;
    Camera camera;
    BuildOptions build;
};

inline void demand(bool kept, const std::string& what) {
    if (!kept) throw std::logic_error(what);
}

// [planes][stride] float of which `count` a plane are in use.
inline void demand_finite(const cl::Buffer& buffer, std::size_t planes, std::size_t stride,
                          std::size_t count, float least, const char* what) {
    const auto values = test::download<float>(buffer, planes * stride);
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t i = 0; i < count; ++i) {
            const float value = values[plane * stride + i];
            demand(std::isfinite(value) && value >= least,
                   std::string(what) + ": " + std::to_string(value));
        }
}

inline EmitterOptions random_emitters(Choices& choices) {
    EmitterOptions out;
    out.vpls = choices.option(choices.integer(0, 60), {-1, -1000});
    out.shadow_size = choices.option(choices.any_of({16, 33, 64}), {0, -1, 1, 1 << 20});
    out.face_size = choices.option(choices.any_of({16, 31, 64}), {0, -1, 1, 1 << 20});
    out.area_size = choices.option(choices.any_of({0, 15, 64}), {-1, 1 << 20});
    out.area_samples = choices.option(choices.integer(1, 6), {0, -1});
    out.environment_lights = choices.option(choices.integer(0, 6), {-1, 1 << 20});
    out.replicate = choices.one_in(4) ? 7u : 0u;
    return out;
}

inline PictureOptions random_picture(Choices& choices, const BuildOptions& build) {
    PictureOptions out;
    out.width = choices.option(choices.integer(1, 24), {0, -1, 1 << 20});
    out.height = choices.option(choices.integer(1, 24), {0, -1, 1 << 20});
    out.emitters = random_emitters(choices);
    out.direct = choices.coin();
    if (choices.one_in(10)) out.memory_budget = static_cast<std::size_t>(choices.integer(1, 65535));
    out.build = build;
    return out;
}

inline void demand_picture(const Picture& picture, const char* what) {
    demand_finite(picture.radiance(), RADIANCE_PLANES, picture.stride(), picture.pixels(), 0.0f,
                  what);
    demand(picture.non_finite() == 0, std::string(what) + ": counted numbers that are not finite");
}

inline void second_order(Choices& choices, const Input& input) {
    SecondOrderOptions options;
    const PictureOptions picture = random_picture(choices, input.build);
    options.width = picture.width;
    options.height = picture.height;
    options.emitters = picture.emitters;
    options.direct = picture.direct;
    options.memory_budget = picture.memory_budget;
    options.build = input.build;
    options.negative_vpls = choices.option(choices.integer(0, 30), {-1});
    options.low_resolution_step = choices.option(choices.any_of({1, 2, 4}), {0, 3, -2});
    options.discontinuity_threshold =
        choices.option(static_cast<float>(choices.between(0, 1)), {-1.0f, no_number, infinite});
    options.footprint =
        choices.option(static_cast<float>(choices.between(0, 4)), {-1.0f, no_number, infinite});
    options.indirect = !choices.one_in(8);
    options.emitters.shadows = !choices.one_in(6);
    SecondOrderSolver solver(test::programs(), test::device().queue, input.placed, options);
    solver.render(input.camera).wait();
    const std::size_t pixels = static_cast<std::size_t>(options.width) * options.height;
    demand_finite(solver.radiance(), RADIANCE_PLANES, solver.stride(), pixels, 0.0f,
                  "second order");
    // A bare 1/d^2 is infinite where a pixel is the place of a VPL.
    demand(solver.status().non_finite == 0 || options.footprint < 0.01f,
           "second order: counted numbers that are not finite");
}

inline void light_atlas(Choices& choices, const Input& input) {
    VplOptions vpls;
    vpls.count = static_cast<std::uint32_t>(choices.integer(1, 60));
    vpls.samples_per_vpl = choices.option<std::uint32_t>(choices.integer(1, 12), {0u, 5000u});
    AtlasOptions texels;
    texels.size = choices.option(choices.integer(4, 40), {0, -1, 1});
    texels.padding = choices.option(choices.integer(1, 3), {0, -1, 65});
    texels.most_pages = choices.option(choices.integer(1, 3), {0, 65});
    if (choices.one_in(6)) texels.texels_per_metre = choices.power_of_two(-24, 12);

    LightAtlasOptions options;
    options.emitters = random_emitters(choices);
    options.bounces = static_cast<std::uint32_t>(choices.integer(0, 5));
    options.threshold = choices.option(static_cast<float>(choices.power_of_two(-20, -3)),
                                       {0.0f, -1.0f, no_number, 2.0f});
    options.one_at_a_time = choices.one_in(4);
    options.exchange_samples = static_cast<std::uint32_t>(choices.integer(0, 8));
    options.hemicube_size = choices.option(choices.any_of({32, 64}), {0, -2, 17});
    options.filling = choices.one_in(4) ? Filling::project : Filling::gather;
    options.refine = choices.option(choices.any_of({1, 2, 4}), {0, 3});
    options.mesh = choices.option(choices.any_of({8, 32, 128}), {0, 7, 1 << 20});
    options.kernel = choices.option(choices.integer(0, 5), {-1, 65});
    options.direct = choices.coin();
    if (choices.one_in(10))
        options.memory_budget = static_cast<std::size_t>(choices.integer(1, 65535));
    options.build = input.build;
    PictureOptions shown = random_picture(choices, input.build);
    texels.largest_size = choices.option(choices.any_of({0, 64, 200}), {-1, 1, 1 << 20});
    options.emitters.shadows = !choices.one_in(6);
    shown.emitters.shadows = !choices.one_in(6);
    const BakeLayout layout = make_bake_layout(input.scene, vpls, texels);
    LightAtlasSolver solver(test::programs(), test::device().queue, input.placed, layout.vpls,
                            layout.atlas, options);
    demand(solver.run(), "light atlas: was not cancelled");
    for (const glm::vec3& e : solver.irradiance())
        demand(std::isfinite(e.x + e.y + e.z), "light atlas: irradiance is not finite");
    demand(solver.status().non_finite == 0, "light atlas: counted numbers that are not finite");

    LightAtlasView view(test::programs(), test::device().queue, input.placed, layout.atlas, shown);
    view.render(input.camera, solver.irradiance_planes(), solver.stride()).wait();
    demand_picture(view.picture(), "light atlas");
}

inline void dynamic_transfer(Choices& choices, const Input& input) {
    DynamicTransferOptions options;
    options.masks.size = choices.option(choices.any_of({8, 16, 32}), {0, 9, 256});
    options.masks.planes = choices.one_in(6) ? EdgePlanes::table : EdgePlanes::exact;
    options.masks.table_size = choices.option(16, {0, 7, 1 << 20});
    options.masks.block = choices.option(choices.any_of({1, 2, 4}), {0, 3, -1});
    options.masks.bands = choices.option(choices.integer(1, 5), {0, 10});
    options.cells = choices.any_of({CellIntegral::exact, CellIntegral::centre});
    options.window = choices.any_of({sh::Window::none, sh::Window::hann});
    options.gloss = choices.coin();
    options.directional = choices.coin();
    options.interreflections = choices.option(choices.integer(0, 1), {-1, 2});
    options.rings = choices.option(choices.integer(0, 2), {-1, 3});
    if (choices.one_in(10))
        options.memory_budget = static_cast<std::size_t>(choices.integer(1, 65535));
    options.build = input.build;
    DynamicTransferViewOptions shown;
    shown.picture = random_picture(choices, input.build);
    shown.threshold =
        choices.option(static_cast<float>(choices.between(0, 1)), {-1.0f, no_number, infinite});
    shown.probe_step = choices.option(choices.any_of({2, 4, 8}), {0, 1, 65, 3});
    options.occlusion = choices.one_in(4) ? Occlusion::none : Occlusion::automatic;
    shown.picture.emitters.shadows = !choices.one_in(6);
    DynamicTransferSolver solver(test::programs(), test::device().queue, input.scene, input.placed,
                                 options);
    demand(solver.run(), "transfer: was not cancelled");
    const ReceiverBuffers& receivers = solver.receivers();
    const TransferStatus status = solver.status();
    demand(status.bad_receivers + status.bad_blockers + status.bad_texels + status.non_finite == 0,
           "transfer: counted numbers that are not finite");
    demand_finite(solver.irradiance(), 3, receivers.stride, receivers.count, -infinite, "transfer");

    DynamicTransferView view(test::programs(), test::device().queue, input.placed, solver, shown);
    view.render(input.camera).wait();
    demand_picture(view.picture(), "transfer");
}

// The scene as it is, and with some of its vertices elsewhere within its bounds or beside them.
inline VertexPoses random_poses(Choices& choices, const Scene& scene) {
    VertexPoses out = {scene.positions, scene.positions};
    const Bounds box = bounds(scene);
    glm::dvec3 way(0.0);
    for (int k = 0; k < 3; ++k) way[k] = choices.between(-0.5, 0.5) * (box.high[k] - box.low[k]);
    const auto first = static_cast<std::size_t>(choices.integer(0, 32));
    for (std::size_t v = first; v < out[1].size(); ++v) out[1][v] += way;
    return out;
}

inline void antiradiance(Choices& choices, const Input& input) {
    AntiradianceOptions options;
    options.bins = choices.option(choices.any_of({32, 64}), {0, 33, -4, 8192});
    options.elements.requested = static_cast<std::size_t>(choices.integer(1, 120));
    options.elements.backs = !choices.one_in(4);
    options.elements.vertices = choices.coin();
    options.links.bin_share =
        choices.option(choices.between(0.3, 2), {0.0, -1.0, double(no_number)});
    options.links.spread = choices.any_of({Spread::precise, Spread::gaussian});
    options.links.threads = 1;
    options.emitters = random_emitters(choices);
    options.iteration =
        choices.any_of({Iteration::automatic, Iteration::asymmetric, Iteration::symmetric});
    options.least_gloss = choices.option(choices.between(0, 1), {-1.0, 2.0, double(no_number)});
    options.steps = choices.option(choices.integer(0, 12), {-1, 10001});
    options.through_steps = choices.option(choices.integer(0, 5), {-1, 1001});
    options.residual = choices.option(choices.power_of_two(-18, -2), {0.0, 2.0, double(no_number)});
    options.most_steps = choices.option(40, {0, -1});
    if (choices.one_in(10))
        options.memory_budget = static_cast<std::size_t>(choices.integer(1, 65535));
    options.build = input.build;
    PictureOptions shown = random_picture(choices, input.build);
    if (choices.one_in(4)) options.occlusion = Occlusion::always;
    if (choices.one_in(4)) options.links.spread = Spread::none;
    if (choices.one_in(4)) options.poses = random_poses(choices, input.scene);
    options.emitters.shadows = !choices.one_in(6);
    shown.emitters.shadows = !choices.one_in(6);
    AntiradianceSolver solver(test::programs(), test::device().queue, input.scene, input.placed,
                              options);
    if (solver.moving_elements() > 0) solver.geometry_changed();
    demand(solver.run(), "antiradiance: was not cancelled");
    const AntiradianceStatus status = solver.status();
    demand(status.non_finite == 0 || options.iteration == Iteration::symmetric || status.given_up,
           "antiradiance: counted numbers that are not finite");
    const bool finite = status.non_finite == 0 || status.given_up;
    if (finite)
        for (const glm::vec4& e :
             test::download<glm::vec4>(solver.leaves().irradiances, solver.elements().leaves)) {
            demand(std::isfinite(e.x + e.y + e.z), "antiradiance: irradiance is not finite");
            demand(!status.given_up || glm::vec3(e) == glm::vec3(0.0f),
                   "antiradiance: light of an iteration that was given up");
        }

    AntiradianceView view(test::programs(), test::device().queue, input.placed, solver, shown);
    view.render(input.camera).wait();
    if (finite) demand_picture(view.picture(), "antiradiance");
}

constexpr int solver_count = 4;

// Which one an input is for.
inline std::size_t solver_of(const std::uint8_t* data, std::size_t size) {
    return static_cast<std::size_t>(Choices(data, size).integer(0, solver_count - 1));
}

// Whether the solver took the options. Throws std::logic_error for a promise that is not kept.
inline bool try_options(const std::uint8_t* data, std::size_t size) {
    Choices choices(data, size);
    const int solver = choices.integer(0, solver_count - 1);
    BuildOptions build;  // the usual one mostly: kernels of each are built once a process
    const int mode = choices.integer(0, 15);
    if (mode >= 14) build.math = Math::fast;
    if (mode >= 13 && mode != 14) build.storage = Storage::half;
    Scene scene = random_scene(choices);
    validate(scene);
    const Camera camera = random_camera(choices, scene);
    try {
        const Input input{scene, test::on_device(scene), camera, build};
        const auto solve = {second_order, light_atlas, dynamic_transfer, antiradiance};
        solve.begin()[solver](choices, input);
    } catch (const Error& error) {
        const std::string text = error.what();
        demand(!text.empty() && text.find('\n') == std::string::npos,
               "refused, though not in one line: " + text);
        return false;
    }
    return true;
}

}  // namespace clgi::fuzz
