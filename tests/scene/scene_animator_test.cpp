// Animation on the device against the host's double precision, and pictures of moved geometry
// against a fresh load of the same pose.
// SPDX-License-Identifier: MIT
#include <clgi/procedural.hpp>
#include <clgi/scene_animator.hpp>
#include <cmath>
#include <limits>

#include "frames.hpp"
#include "posing.hpp"
#include "read_back.hpp"
#include "refusals.hpp"
#include "turning.hpp"

namespace clgi {
namespace {

using test::GltfDraft;
using test::json;
using test::posed_at;

SceneAnimator animator_of(const Scene& scene, DeviceScene& device,
                          const BuildOptions& options = {}) {
    return SceneAnimator(test::programs(), test::device().queue, scene, device, options);
}

// The device has the host's pose. A dozen roundings of numbers as large as the scene; normals are
// of a few numbers near 1.
void expect_as_on_the_host(const Scene& source, double time, const std::string& where,
                           const BuildOptions& options = {}) {
    Scene scene = source;
    scene.moving_bounds = motion_bounds(scene, 0);
    DeviceScene device = test::on_device(scene);
    SceneAnimator animator(test::programs(), test::device().queue, scene, device, options);
    animator.animate(0, time).done.wait();
    const Scene found = test::read_back(scene, device), wanted = posed_at(scene, time);
    const double radius = device.frame().radius / device.frame().scale;
    for (std::size_t v = 0; v < wanted.positions.size(); ++v) {
        EXPECT_LE(glm::length(found.positions[v] - wanted.positions[v]), 16 * 0x1p-24 * radius)
            << where << " at " << time << ", position " << v;
        EXPECT_LE(glm::length(found.normals[v] - wanted.normals[v]), 2e-6f)
            << where << " at " << time << ", normal " << v;
    }
    EXPECT_EQ(animator.status().not_finite, 0u);
}

void expect_as_on_the_host(const GltfDraft& draft, const std::string& where) {
    const Scene scene = draft.load();
    for (const double time : {0.0, 0.3, 0.5, 1.0})
        for (const Math math : {Math::strict, Math::fast})
            expect_as_on_the_host(scene, time, where, {.math = math});
}

// A slanted patch with normals, under two nodes that move it and are far from simple.
GltfDraft patch_draft(const char* path, const std::vector<float>& keys) {
    GltfDraft draft;
    draft.show({{"attributes",
                 {{"POSITION", draft.vec3({{1, 0.5f, 0}, {0.2f, 1, 0.1f}, {0, 0, 1}, {1, 1, 2}})},
                  {"NORMAL", draft.vec3({{1, 1, 1}, {0, 1, 0}, {-1, 2, 0.5f}, {0.3f, 0, -1}})}}},
                {"indices", draft.indices({0, 1, 2, 2, 1, 3})}},
               {{"translation", {0.5, 0, 0}}});
    draft.add("nodes",
              {{"children", {0}}, {"rotation", {0.1, 0.2, 0.3, 0.9}}, {"scale", {1, 2, 0.7}}});
    const std::size_t width = std::string(path) == "rotation" ? 4 : 3;
    const int values =
        width == 4 ? test::vec4s(draft, keys)
                   : draft.accessor(draft.view(keys), keys.size() / 3, "VEC3", test::float_type);
    test::animate(draft, 0, path, test::scalars(draft, {0, 1}), values);
    return draft;
}

TEST(SceneAnimator, PosesAsTheHostDoes) {
    expect_as_on_the_host(test::strip_draft(), "strip");
    expect_as_on_the_host(patch_draft("translation", {0, 0, 0, 3, -1, 2}), "translation");
    expect_as_on_the_host(patch_draft("rotation", {0, 0, 0, 1, 1, 2, 3, 4}), "rotation");
    expect_as_on_the_host(patch_draft("scale", {1, 1, 1, 0.2f, 3, 1.5f}), "scale");
    GltfDraft lifted = test::strip_draft();
    lifted.document["nodes"][0]["weights"] = {1.7};
    expect_as_on_the_host(lifted, "target and joint");
    GltfDraft loose = test::strip_draft("JOINTS_0", "WEIGHTS_0",
                                        {0.5f, 0, 0, 0, 0.5f,  0,    0, 0, 0,    0,    0, 0,
                                         0,    0, 0, 0, 0.25f, 0.5f, 0, 0, 0.1f, 3.0f, 0, 0});
    loose.document["nodes"][0]["translation"] = {0.5, 7, 0};
    expect_as_on_the_host(loose, "vertices without weights");
}

// Ranges read their own matrices, weights, influences and targets.
TEST(SceneAnimator, KeepsRangesApart) {
    GltfDraft draft = test::strip_draft();
    draft.document["nodes"][0]["weights"] = {1.7};
    const int mesh = draft.add("meshes", draft.document["meshes"][0]);
    draft.add("skins", {{"joints", {2, 1}}});
    draft.add("nodes", {{"mesh", mesh}, {"skin", 0}, {"weights", {0.3}}});
    draft.add("nodes", {{"mesh", mesh}, {"skin", 1}, {"weights", {-1.0}}});
    expect_as_on_the_host(draft, "three strips");
}

TEST(SceneAnimator, ScalesThatMirrorOrFlattenGiveNormals) {
    expect_as_on_the_host(patch_draft("scale", {-1, 1, 1, -0.5f, 2, 1}), "mirrored");
    expect_as_on_the_host(patch_draft("scale", {1, 1, 1, 1, 1, 0}), "flattened");
    expect_as_on_the_host(patch_draft("scale", {1, 1, 1, 0, 0, 0}), "vanishing");
    expect_as_on_the_host(patch_draft("scale", {1, 1, 1, 1, 0, 0}), "a line");
    expect_as_on_the_host(patch_draft("scale", {1e-14f, 1e-14f, 1e-14f, 1e-14f, -2e-14f, 1e-14f}),
                          "tiny");
}

TEST(SceneAnimator, MovesNormalsByTargetsToo) {
    GltfDraft draft = patch_draft("translation", {0, 0, 0, 1, 0, 0});
    const test::Floats3 zero(4, {0, 0, 0});
    const json first = {{"POSITION", draft.vec3({{0, 1, 0}, {1, 0, 0}, {0, 0, 2}, {0.3f, 0, 0}})}};
    const json second = {
        {"POSITION", draft.vec3(zero)},
        {"NORMAL", draft.vec3({{0, -1, 0}, {0.5f, 0, 0}, {1, -2, -0.5f}, {0, 3, 0}})}};
    draft.document["meshes"][0]["primitives"][0]["targets"] = {first, second};
    const int times = test::scalars(draft, {0, 1});
    const json sampler = {{"input", times}, {"output", test::scalars(draft, {0, 0, 0.5f, 1})}};
    json& clip = draft.document["animations"][0];
    clip["samplers"].push_back(sampler);
    clip["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}});
    expect_as_on_the_host(draft, "targets");  // at 1 s the third normal has no direction
}

TEST(SceneAnimator, GivesFlatTrianglesTheirNormals) {
    for (const double size : {1.0, 1e-12, 1e-23}) {
        GltfDraft draft = test::triangle_draft();
        draft.add("nodes", {{"children", {0}}, {"scale", {size, size, size}}});
        test::animate(draft, 0, "rotation", test::scalars(draft, {0, 1}),
                      test::vec4s(draft, {0, 0, 0, 1, 1, 2, 3, 4}));
        expect_as_on_the_host(draft, "flat");
    }
    GltfDraft vanishing = test::triangle_draft();
    test::animate(vanishing, 0, "scale", test::scalars(vanishing, {0, 1}),
                  vanishing.vec3({{-1, 1, 1}, {0, 0, 0}}));
    expect_as_on_the_host(vanishing, "flat and vanishing");
    // So thin that the square of its area is 0 in a float.
    GltfDraft sliver;
    sliver.show(
        {{"attributes", {{"POSITION", sliver.vec3({{0, 0, 0}, {1, 0, 0}, {0.5f, -1e-25f, 0}})}}}});
    test::animate(sliver, 0, "translation", test::scalars(sliver, {0, 1}),
                  sliver.vec3({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(sliver.load().normals[0], glm::vec3(0, 0, -1));
    expect_as_on_the_host(sliver, "thin");
}

TEST(SceneAnimator, IsAsPreciseFarFromTheOrigin) {
    GltfDraft draft = test::strip_draft();
    draft.document["nodes"][1]["translation"] = {1e7, -3e6, 0.125};
    expect_as_on_the_host(draft, "far away");
    GltfDraft far_mesh = patch_draft("rotation", {0, 0, 0, 1, 0, 0, 1, 4});
    far_mesh.document["nodes"][0].erase("translation");
    far_mesh.document["nodes"][1]["translation"] = {2e6, 0, -1e6};
    expect_as_on_the_host(far_mesh, "far away");
}

// A strip that bends above a floor that stands still, a patch that moves; the floor's vertices lie
// between theirs. A point light is carried, the second patch shines.
Scene stage() {
    GltfDraft draft = test::strip_draft();
    const float wide = 3.0f;
    draft.show(
        {{"attributes",
          {{"POSITION",
            draft.vec3(
                {{-wide, -1, -wide}, {-wide, -1, wide}, {wide, -1, wide}, {wide, -1, -wide}})},
           {"NORMAL", draft.vec3(test::Floats3(4, {0, 1, 0}))}}},
         {"indices", draft.indices({0, 1, 2, 0, 2, 3})}});
    const int glowing = draft.add("materials", {{"emissiveFactor", {1, 0.5, 0.25}}});
    draft.add(
        "nodes",
        {{"translation", {-1, 0, 0}},
         {"mesh",
          draft.add("meshes",
                    {{"primitives",
                      json::array({json{
                          {"attributes",
                           {{"POSITION", draft.vec3({{0, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}})}}},
                          {"material", glowing}}})}})}});
    draft.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 5}}};
    draft.document["extensionsUsed"] = {"KHR_lights_punctual"};
    draft.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                        {"translation", {1, 2, 0}}});
    json& clip = draft.document["animations"][0];
    const int times = test::scalars(draft, {0, 1});
    const int moves = draft.vec3({{-1, 0, 0}, {-1, 0.5f, 0.3f}});
    clip["samplers"].push_back({{"input", times}, {"output", moves}});
    clip["channels"].push_back(
        {{"sampler", 1}, {"target", {{"node", 4}, {"path", "translation"}}}});
    clip["samplers"].push_back({{"input", times}, {"output", draft.vec3({{1, 2, 0}, {0, 2, 1}})}});
    clip["channels"].push_back(
        {{"sampler", 2}, {"target", {{"node", 5}, {"path", "translation"}}}});
    Scene scene = draft.load();
    scene.cameras.push_back(default_camera(scene));
    scene.moving_bounds = motion_bounds(scene, 0);
    return scene;
}

SecondOrderOptions animated_frame() {
    SecondOrderOptions options;
    options.width = 120;
    options.height = 90;
    options.emitters.vpls = 100;
    options.negative_vpls = 30;
    return options;
}

TEST(SceneAnimator, GivesThePictureOfAFreshLoad) {
    const Scene scene = stage();
    DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, animated_frame());
    SceneAnimator animator = animator_of(scene, device);
    std::vector<glm::vec3> last;
    for (const double time : {0.0, 0.4, 1.0}) {
        const Animated step = animator.animate(0, time);
        EXPECT_TRUE(step.lights);
        solver.lights_changed();
        solver.render(scene.cameras[0], {step.done}).wait();
        const auto found = test::read_frame(test::device().queue, device, solver).radiance;

        const Scene host = posed_at(scene, time);
        Scene fresh = host;
        const Scene found_there = test::read_back(scene, device);
        for (const PosedRange& range : scene.animation->ranges)
            for (std::uint32_t v = range.first_vertex; v < range.first_vertex + range.vertex_count;
                 ++v) {
                fresh.positions[v] = found_there.positions[v];
                fresh.normals[v] = found_there.normals[v];
            }
        EXPECT_EQ(device.lights()[0].position, host.lights[0].position);
        const DeviceScene again = test::on_device(fresh);
        EXPECT_EQ(again.frame().origin, device.frame().origin);
        EXPECT_EQ(again.frame().radius, device.frame().radius);
        EXPECT_TRUE(test::same_bits(test::vertex_bits(again), test::vertex_bits(device)));
        const auto wanted = test::render(fresh, scene.cameras[0], animated_frame()).radiance;
        EXPECT_TRUE(test::same_bits(found, wanted)) << time;
        EXPECT_FALSE(test::same_bits(found, last));
        last = found;

        // The host's pose differs by roundings: edges may fall on the other side of a pixel.
        const auto host_picture = test::render(host, scene.cameras[0], animated_frame()).radiance;
        double difference = 0.0, sum = 0.0;
        for (std::size_t p = 0; p < found.size(); ++p) {
            difference += glm::length(glm::dvec3(found[p]) - glm::dvec3(host_picture[p]));
            sum += glm::length(glm::dvec3(host_picture[p]));
        }
        EXPECT_LE(difference, 0.01 * sum) << time;
        EXPECT_GT(sum, 0.0);
        EXPECT_TRUE(animator.status().fits);
    }
}

TEST(SceneAnimator, LeavesWhatStandsStill) {
    const Scene scene = stage();
    DeviceScene device = test::on_device(scene);
    const auto before = test::vertex_bits(device);
    animator_of(scene, device).animate(0, 0.7).done.wait();
    const auto after = test::vertex_bits(device);
    ASSERT_EQ(scene.animation->ranges.size(), 2u);
    for (std::size_t v = 6; v < 10; ++v)  // the floor, between the two
        for (std::size_t i = 8 * v; i < 8 * v + 8; ++i) EXPECT_EQ(before[i], after[i]) << v;
}

TEST(SceneAnimator, DoesNotDependOnGroupsQueuesOrWhatWasBefore) {
    const Scene scene = stage();
    const auto bits = [&](const BuildOptions& options, const cl::CommandQueue& queue, bool others) {
        DeviceScene device = test::on_device(scene);
        SceneAnimator animator(test::programs(), queue, scene, device, options);
        for (int i = 0; i < 20 && others; ++i) animator.animate(0, 0.05 * i);
        animator.animate(0, 0.6).done.wait();
        return test::vertex_bits(device);
    };
    const cl::CommandQueue& in_order = test::device().queue;
    const cl::CommandQueue any_order(test::device().context, test::device().device,
                                     CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const auto wanted = bits({}, in_order, false);
    for (const std::size_t local : {1, 3, 16})
        EXPECT_TRUE(test::same_bits(bits({.local_size = local}, in_order, false), wanted)) << local;
    EXPECT_TRUE(test::same_bits(bits({.packet_width = 1}, in_order, true), wanted));
    EXPECT_TRUE(test::same_bits(bits({}, any_order, true), wanted));
}

TEST(SceneAnimator, TellsWhichLightsMoved) {
    DeviceScene still = test::on_device(test::bent_strip());
    const Scene strip = test::bent_strip();
    EXPECT_FALSE(animator_of(strip, still).animate(0, 0.5).lights);
    Scene dark = stage();
    dark.animation->lights.clear();
    DeviceScene device = test::on_device(dark);
    EXPECT_TRUE(animator_of(dark, device).animate(0, 0.5).lights);  // the patch shines
    EXPECT_EQ(device.lights()[0].position, dark.lights[0].position);
    for (Material& material : dark.materials) material.emission = glm::vec3(0.0f);
    DeviceScene darker = test::on_device(dark);
    EXPECT_FALSE(animator_of(dark, darker).animate(0, 0.5).lights);
    // Lights alone: nothing else is enqueued.
    Scene lights = stage();
    lights.animation->ranges.clear();
    DeviceScene lit = test::on_device(lights);
    const Animated step = animator_of(lights, lit).animate(0, 1.0);
    step.done.wait();
    EXPECT_TRUE(step.lights);
    EXPECT_VEC_NEAR(lit.lights()[0].position, glm::dvec3(0, 2, 1), 1e-12);
}

TEST(SceneAnimator, TakesAnyPoseAndKeepsVerticesThatAreNotFinite) {
    const Scene scene = test::bent_strip();
    DeviceScene device = test::on_device(scene);
    SceneAnimator animator = animator_of(scene, device);
    Pose pose = rest_pose(*scene.animation);
    const auto second = static_cast<std::size_t>(scene.animation->skins[0].joints[1]);
    const auto before = test::vertex_bits(device);
    pose.matrices[second][3].x = std::numeric_limits<double>::quiet_NaN();
    animator.show(pose);
    EXPECT_EQ(animator.status().not_finite, 4u);
    EXPECT_TRUE(test::same_bits(before, test::vertex_bits(device)));
    pose.matrices[second][3].x = 50.0;
    animator.show(pose);
    const MoveStatus status = animator.status();
    EXPECT_EQ(status.not_finite, 0u);
    EXPECT_FALSE(status.fits);
    pose.weights.clear();
    EXPECT_THROW(animator.show(pose), Error);
    EXPECT_THROW(animator.animate(1, 0.0), Error);
    EXPECT_THROW(animator_of(cornell(), device), Error);
    EXPECT_THROW(animator_of(stage(), device), Error);
}

TEST(ScenePose, RefusesBuffersTooSmall) {
    const ScenePasses& passes = test::shared_passes<ScenePasses>(Math::strict);
    const cl::CommandQueue& queue = test::device().queue;
    PoseRange range{};
    range.count = 3;
    const PoseParams params{3, 3, 1, 4, 5, 1, 2, 1};
    const cl::Buffer any = test::upload(std::vector<std::uint32_t>(256));
    const cl::Buffer ranges = test::upload(std::vector<PoseRange>{range});
    const PoseBuffers plenty{ranges,
                             any,
                             any,
                             any,
                             any,
                             any,
                             any,
                             any,
                             test::empty<glm::vec4>(16),
                             test::empty<glm::vec4>(16)};
    const auto with = [&](cl::Buffer PoseBuffers::*member) {
        return [&, member](const cl::Buffer& buffer) {
            PoseBuffers buffers = plenty;
            buffers.*member = buffer;
            // Ranges without influences and targets, whatever else is in them.
            if (buffer() && member != &PoseBuffers::positions)
                queue.enqueueFillBuffer(buffer, std::uint8_t{0}, 0, buffer.getInfo<CL_MEM_SIZE>());
            passes.pose(queue, params, buffers);
        };
    };
    const auto flat = [&](cl::Buffer PoseBuffers::*member) {
        return [&, member](const cl::Buffer& buffer) {
            PoseBuffers buffers = plenty;
            buffers.*member = buffer;
            if (member == &PoseBuffers::triangles && buffer())
                queue.enqueueFillBuffer(buffer, std::uint8_t{0}, 0, buffer.getInfo<CL_MEM_SIZE>());
            passes.flatten(queue, params, buffers);
        };
    };
    test::expect_refusals({{"scene.pose", "ranges", sizeof(PoseRange), with(&PoseBuffers::ranges)},
                           {"scene.pose", "rest_positions", 48, with(&PoseBuffers::rest_positions)},
                           {"scene.pose", "rest_normals", 48, with(&PoseBuffers::rest_normals)},
                           {"scene.pose", "influences", 32, with(&PoseBuffers::influences)},
                           {"scene.pose", "differences", 60, with(&PoseBuffers::differences)},
                           {"scene.pose", "matrices", 48, with(&PoseBuffers::matrices)},
                           {"scene.pose", "weights", 8, with(&PoseBuffers::weights)},
                           {"scene.pose", "positions", 48, with(&PoseBuffers::positions)},
                           {"scene.pose", "normals", 48, with(&PoseBuffers::normals)},
                           {"scene.flatten", "triangles", 16, flat(&PoseBuffers::triangles)},
                           {"scene.flatten", "positions", 48, flat(&PoseBuffers::positions)},
                           {"scene.flatten", "normals", 48, flat(&PoseBuffers::normals)}});
    PoseParams none = params;
    none.vertex_count = none.triangle_count = 0;
    EXPECT_NO_THROW(passes.pose(queue, none, plenty).wait());
    EXPECT_NO_THROW(passes.flatten(queue, none, plenty).wait());
}

}  // namespace
}  // namespace clgi
