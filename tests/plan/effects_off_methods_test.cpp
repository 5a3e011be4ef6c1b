// What a scene does not call for costs nothing in methods for many bounces and in dynamic transfer:
// kernels are not built, passes not enqueued, buffers not allocated, and the light is the same.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/antiradiance_view.hpp>
#include <clgi/advanced/dynamic_transfer_view.hpp>

#include "effect_cost.hpp"
#include "frames.hpp"
#include "light_baking.hpp"
#include "rooms.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

constexpr int width = 64, height = 48;
constexpr std::size_t pixels = std::size_t{width} * height;

const cl::CommandQueue& queue() { return test::device().queue; }

// Pictures of other methods, and the direct light that those start from.
struct Baked {
    test::Cost solver, view;
    EmitterCapacity capacity;
    std::vector<glm::vec3> radiance;
};

Baked antiradiance(const Scene& scene, bool shadows, bool direct = true) {
    const Programs own = test::own_programs();
    const DeviceScene device = test::on_device(scene);
    AntiradianceOptions options;
    options.bins = 32;
    options.elements.requested = 40;
    options.emitters = test::small_maps(shadows);
    AntiradianceSolver solver(own, queue(), scene, device, options);
    EXPECT_TRUE(solver.run());
    Baked out;
    out.solver.kernels = own.built_kernels();
    out.solver.add(solver.events());
    out.solver.bytes = solver.bytes();
    PictureOptions shown;
    shown.width = width;
    shown.height = height;
    shown.emitters = options.emitters;
    shown.direct = direct;
    const Programs of_view = test::own_programs();
    AntiradianceView view(of_view, queue(), device, solver, shown);
    view.render(scene.cameras.at(0)).wait();
    out.view.kernels = of_view.built_kernels();
    out.view.add(view.picture().events());
    out.view.bytes = view.bytes();
    out.capacity = view.picture().emitters().capacity;
    out.radiance =
        test::vectors(queue(), view.picture().radiance(), view.picture().stride(), pixels);
    return out;
}

TEST(WithoutShadows, AntiradianceAndItsPicturesDrawNoMap) {
    const Scene scene = test::convex_room();
    const Baked on = antiradiance(scene, true), off = antiradiance(scene, false);
    test::expect_no_less(on.radiance, off.radiance, 0.02);
    EXPECT_EQ(off.solver.enqueued("gbuffer.raster") + off.solver.enqueued("gbuffer.clear"), 0u);
    EXPECT_GT(on.solver.enqueued("gbuffer.raster"), 0u);
    EXPECT_EQ(off.solver.built("gbuffer/raster") + off.solver.built("gbuffer/clear"), 0u);
    EXPECT_GT(on.solver.built("CLGI_DEPTH_ONLY"), 0u);
    EXPECT_EQ(off.view.built("CLGI_DEPTH_ONLY"), 0u);
    EXPECT_GT(on.view.built("CLGI_DEPTH_ONLY"), 0u);
    EXPECT_EQ(off.view.enqueued("gbuffer.raster_large"), 1u);
    const std::size_t maps =
        on.capacity.views * sizeof(View) + on.capacity.pixels * sizeof(std::uint32_t) - 32;
    EXPECT_EQ(on.view.bytes - off.view.bytes, maps);
    EXPECT_GT(on.solver.bytes - off.solver.bytes, maps);  // lists of large triangles as well
}

// Direct light that is not wanted needs no shadow maps.
TEST(WithoutDirectLight, PicturesHaveNoShadowMaps) {
    const Baked on = antiradiance(test::convex_room(), true),
                off = antiradiance(test::convex_room(), true, false);
    EXPECT_EQ(off.view.built("CLGI_DEPTH_ONLY"), 0u);
    EXPECT_EQ(off.view.enqueued("gbuffer.raster_large"), 1u);
    EXPECT_EQ(off.capacity.pixels, 0u);
    EXPECT_LT(off.view.bytes, on.view.bytes);
}

TEST(WithoutShadows, ALightAtlasHasTheSameDirectLight) {
    const Scene scene = test::convex_room();
    LightAtlasOptions options;
    options.bounces = 1;
    options.hemicube_size = 32;
    const test::Bakery bakery(scene, {.vpls = 60, .atlas = 32});
    options.direct = true;
    options.emitters = test::small_maps(true);
    LightAtlasSolver with = bakery.solver(options);
    options.emitters.shadows = false;
    LightAtlasSolver without = bakery.solver(options);
    ASSERT_TRUE(with.run() && without.run());
    test::expect_no_less(with.irradiance(), without.irradiance(), 0.05);
    const EmitterCapacity room = make_emitters(bakery.on_device, test::small_maps(true)).capacity;
    // And lists of large triangles.
    EXPECT_GT(with.bytes() - without.bytes(),
              room.views * sizeof(View) + room.pixels * sizeof(std::uint32_t) - 32);
}

// ---- an environment that nothing blocks --------------------------------------------------------

struct Sky {
    test::Cost solver, view;
    std::uint32_t stride = 0, triangles = 0;
};

Sky transfer(const Scene& scene, bool shadowed, bool gloss) {
    const DeviceScene device = test::on_device(scene);
    const Programs own = test::own_programs(), of_view = test::own_programs();
    DynamicTransferOptions options;
    options.occlusion = shadowed ? Occlusion::automatic : Occlusion::none;
    options.gloss = gloss;
    DynamicTransferSolver solver(own, queue(), scene, device, options);
    EXPECT_TRUE(solver.run());
    Sky out;
    out.solver.add(solver.events());
    DynamicTransferViewOptions shown;
    shown.picture.width = width;
    shown.picture.height = height;
    shown.picture.emitters.shadow_size = 32;
    DynamicTransferView view(of_view, queue(), device, solver, shown);
    view.render(scene.cameras.at(0)).wait();
    out.solver.kernels = own.built_kernels();
    if (solver.glossy()) out.solver.add(solver.events());  // of the lobes, for the camera
    out.solver.bytes = solver.bytes();
    out.view.kernels = of_view.built_kernels();
    out.view.add(view.picture().events());
    out.view.bytes = view.bytes();
    out.stride = solver.receivers().stride;
    out.triangles = static_cast<std::uint32_t>(scene.triangles.size());
    return out;
}

Scene ball_under_the_sky() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    scene.materials[0].roughness = 0.5f;
    scene.materials[0].specular = 1.0f;
    test::add_sphere(scene, {0, 0, 0}, 1.0, 2);
    test::light_by_gradient(scene, {2.0f, 3.0f, 4.0f}, {0.6, 0.8, 0.0}, 32);
    scene.cameras = {test::camera_at({0.3, 0.4, 3.5}, {0, 0, 0})};
    return scene;
}

TEST(WithoutSelfShadows, NoMaskIsDrawnAndNoDiffuseVectorKept) {
    const Scene scene = ball_under_the_sky();
    const Sky on = transfer(scene, true, false), off = transfer(scene, false, false);
    for (const char* name :
         {"transfer.mask", "transfer.integrate", "transfer.shade", "transfer.blockers"}) {
        EXPECT_EQ(off.solver.enqueued(name), 0u) << name;
        EXPECT_EQ(off.view.enqueued(name), 0u) << name;
        EXPECT_GT(on.solver.enqueued(name), 0u) << name;
    }
    for (const char* name :
         {"transfer/mask", "transfer/integrate", "transfer/shade", "transfer/blockers"}) {
        EXPECT_EQ(off.solver.built(name), 0u) << name;
        EXPECT_EQ(off.view.built(name), 0u) << name;
        EXPECT_EQ(on.solver.built(name), 1u) << name;
    }
    EXPECT_EQ(on.solver.built("transfer/open") + on.view.built("transfer/open"), 0u);
    EXPECT_EQ(off.solver.built("transfer/open"), 1u);
    EXPECT_EQ(off.view.built("transfer/open"), 1u);
    for (const char* name : {"transfer/show", "transfer/pixels", "transfer/undersampled"})
        EXPECT_EQ(off.view.built(name), 0u) << name;
    // Masks of 32 words, vectors of 25 terms, triangles and their planes in whole clusters.
    EXPECT_GE(on.solver.bytes - off.solver.bytes,
              std::size_t{on.stride} * (32 + 25) * 4 + std::size_t{on.triangles} * (16 + 36));
    EXPECT_LT(off.view.bytes, on.view.bytes);
}

TEST(WithoutSelfShadows, LobesNeedNoMasksEither) {
    const Scene scene = ball_under_the_sky();
    const Sky on = transfer(scene, true, true), off = transfer(scene, false, true);
    EXPECT_EQ(off.solver.enqueued("transfer.mask") + off.view.enqueued("transfer.mask"), 0u);
    EXPECT_EQ(off.solver.built("transfer/mask") + off.solver.built("transfer/blockers"), 0u);
    EXPECT_EQ(off.solver.built("-DCLGI_OPEN"), 1u);
    EXPECT_EQ(on.solver.built("-DCLGI_OPEN"), 0u);
    // What arrives without a lobe: at all pixels, and at the probes.
    EXPECT_EQ(off.view.enqueued("transfer.open"), 2u);
    EXPECT_GT(off.view.enqueued("transfer.pixels"), 1u);
    EXPECT_GE(on.solver.bytes - off.solver.bytes, std::size_t{on.stride} * (32 + 25) * 4);
}

// ---- antiradiance ------------------------------------------------------------------------------

struct Exchanged {
    std::vector<glm::dvec3> light;  // of leaves, lux
    AntiradianceStatus status;
    test::Cost cost;
    std::size_t rows, elements, table_bytes;
};

Exchanged exchange(const Scene& scene, const AntiradianceOptions& options) {
    const Programs own = test::own_programs();
    const DeviceScene device = test::on_device(scene);
    AntiradianceSolver solver(own, queue(), scene, device, options);
    EXPECT_TRUE(solver.run());
    Exchanged out{{},
                  solver.status(),
                  {},
                  solver.row_count(),
                  solver.elements().count(),
                  solver.table_bytes()};
    for (const glm::vec4& e :
         test::download<glm::vec4>(solver.leaves().irradiances, solver.elements().leaves))
        out.light.push_back(device.frame().exposure * glm::dvec3(e));
    out.cost.kernels = own.built_kernels();
    out.cost.add(solver.events());
    out.cost.bytes = solver.bytes();
    return out;
}

AntiradianceOptions few_elements() {
    AntiradianceOptions out;
    out.bins = 64;
    out.elements.requested = 100;
    out.emitters.shadow_size = out.emitters.face_size = 64;
    out.emitters.area_samples = 4;
    return out;
}

// A row of intensities has 16 bytes a bin, and there are two tables of them.
TEST(WithoutOcclusion, NoAntiradianceIsStoredOrLetThrough) {
    AntiradianceOptions options = few_elements();
    options.iteration = Iteration::asymmetric;
    const Exchanged none = exchange(test::convex_room(false), options);
    options.occlusion = Occlusion::always;
    const Exchanged all = exchange(test::convex_room(false), options);
    EXPECT_EQ(none.rows, 0u);
    EXPECT_EQ(all.rows, all.elements);
    EXPECT_EQ(all.table_bytes - none.table_bytes, 2 * (all.elements * 64 * 16 - 16));
    EXPECT_EQ(all.cost.bytes - none.cost.bytes, all.table_bytes - none.table_bytes);
    // No steps that let light through alone.
    EXPECT_EQ(none.status.iteration, Iteration::symmetric);
    EXPECT_EQ(all.status.iteration, Iteration::asymmetric);
    EXPECT_TRUE(none.status.converged);
    EXPECT_LT(none.cost.enqueued("antiradiance.local"), all.cost.enqueued("antiradiance.local"));
}

TEST(WithoutOcclusion, TheLightIsThatOfRowsEverywhere) {
    Scene behind = test::furnished_room(5);
    for (const Scene& scene : {test::convex_room(false), behind}) {
        AntiradianceOptions options = few_elements();
        options.iteration = Iteration::symmetric;
        options.steps = 5;
        const Exchanged some = exchange(scene, options);
        options.occlusion = Occlusion::always;
        const Exchanged all = exchange(scene, options);
        EXPECT_EQ(all.rows, all.elements);
        EXPECT_LT(some.rows, some.elements);
        EXPECT_EQ(some.rows > 0, scene.triangles.size() > 4);
        double most = 0.0;
        for (const glm::dvec3& e : all.light) most = std::max(most, e.y);
        ASSERT_GT(most, 1e-3);
        for (std::size_t i = 0; i < all.light.size(); ++i)
            for (int c = 0; c < 3; ++c)  // sums of hundreds of links in another order
                EXPECT_NEAR(some.light[i][c], all.light[i][c], 2e-5 * most) << i;
    }
}

// ---- what was there before ----------------------------------------------------------------

TEST(WithoutGloss, NoLobeIsIntegrated) {
    const Scene scene = ball_under_the_sky();
    const Sky on = transfer(scene, true, true), off = transfer(scene, true, false);
    EXPECT_EQ(off.solver.built("CLGI_GLOSS") + off.solver.enqueued("gloss"), 0u);
    EXPECT_EQ(on.solver.built("CLGI_GLOSS"), 1u);
    EXPECT_EQ(off.view.built("gloss") + off.view.enqueued("gloss"), 0u);
    EXPECT_GE(on.solver.bytes - off.solver.bytes, std::size_t{on.stride} * (25 + 3 + 1) * 4);

    Scene room = test::convex_room();
    AntiradianceOptions options = few_elements();
    const Exchanged dull = exchange(room, options);
    room.materials[0].metallic = 1.0f;
    room.materials[0].roughness = 0.3f;
    const Exchanged shiny = exchange(room, options);
    for (const char* name : {"antiradiance/gloss", "antiradiance/lobes"}) {
        EXPECT_EQ(dull.cost.built(name), 0u) << name;
        EXPECT_GT(shiny.cost.built(name), 0u) << name;
    }
    EXPECT_EQ(dull.cost.enqueued("gloss") + dull.cost.enqueued("lobes"), 0u);
    EXPECT_GT(shiny.cost.enqueued("gloss"), 0u);
    EXPECT_LT(dull.cost.bytes, shiny.cost.bytes);
}

// Nothing is reflected: the first step finds nothing that changed.
TEST(WithoutReflection, AntiradianceComesToRestAtOnce) {
    Scene scene = test::convex_room();
    for (Material& material : scene.materials) material.base_color = {0, 0, 0, 1};
    const Exchanged black = exchange(scene, few_elements());
    EXPECT_EQ(black.status.residuals, std::vector<double>{0.0});
    EXPECT_TRUE(black.status.converged);
    for (const glm::dvec3& e : black.light) EXPECT_EQ(e, glm::dvec3(0.0));
}

TEST(WithoutLights, NoMapIsDrawn) {
    Scene scene = test::shaded_floor();
    scene.lights.clear();
    test::light_by(scene, {1, 2, 3});
    const Baked sky = antiradiance(scene, true);
    EXPECT_EQ(sky.solver.built("CLGI_DEPTH_ONLY") + sky.view.built("CLGI_DEPTH_ONLY"), 0u);
    EXPECT_EQ(sky.view.enqueued("gbuffer.raster_large"), 1u);
    EXPECT_EQ(sky.solver.enqueued("gbuffer.raster"), 0u);
}

}  // namespace
}  // namespace clgi
