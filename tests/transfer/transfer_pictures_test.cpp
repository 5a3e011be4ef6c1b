// Pictures of random solids under environments, by dynamic transfer and by the path tracer.
// SPDX-License-Identifier: MIT
#include <clgi/io/image.hpp>
#include <filesystem>
#include <numbers>

#include "apart.hpp"
#include "frames.hpp"
#include "math_modes.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr int picture_width = 160, picture_height = 120;

struct Shown {
    std::vector<glm::vec3> radiance;
    std::uint32_t receivers = 0;  // pixels
};

Shown picture_of(const Scene& scene, float threshold, const MaskOptions& masks = {},
                 Math math = Math::strict) {
    const DeviceScene device = test::on_device(scene);
    const cl::CommandQueue& queue = test::device().queue;
    DynamicTransferOptions options;
    options.masks = masks;
    options.build.math = math;
    DynamicTransferSolver solver(test::programs(), queue, scene, device, options);
    DynamicTransferViewOptions view_options;
    view_options.picture.width = picture_width;
    view_options.picture.height = picture_height;
    view_options.picture.build.math = math;
    view_options.threshold = threshold;
    DynamicTransferView view(test::programs(), queue, device, solver, view_options);
    EXPECT_TRUE(solver.run());
    view.render(scene.cameras[0]).wait();
    EXPECT_EQ(view.picture().non_finite() + solver.status().non_finite, 0u);
    return {test::vectors(queue, view.picture().radiance(), view.picture().stride(),
                          std::size_t{picture_width} * picture_height),
            view.receiver_pixels()};
}

test::Twice truth_of(const Scene& scene, int samples) {
    reference::Options options;
    options.width = picture_width;
    options.height = picture_height;
    options.samples = samples;
    options.effects = reference::parse_effects("emission,direct");
    return test::render_twice(scene, scene.cameras[0], options);
}

// Pixels that show the environment itself are left out: both have it.
// Where a surface is seen: the environment is black.
std::vector<bool> surfaces(Scene scene) {
    scene.environment.reset();
    for (Material& material : scene.materials) material.emission = glm::vec3(1.0f);
    std::vector<bool> out;
    for (const glm::vec3& radiance : truth_of(scene, 16).first) out.push_back(radiance.x > 0.5f);
    return out;
}

void expect_like(const Scene& scene, Math math, const std::string& name, int samples = 48) {
    const test::Twice truth = truth_of(scene, samples);
    const std::vector<bool> seen = surfaces(scene);
    const Shown shown = picture_of(scene, 0.1f, {}, math);
    const test::Apart result = test::apart(shown.radiance, truth, seen);
    MaskOptions more;
    more.bands = 9;
    const test::Apart uncut =
        test::apart(picture_of(scene, 0.1f, more, math).radiance, truth, seen);
    std::printf("%s: error %.2f %%, energy %.4f, %u pixels; with 81 terms %.2f %%\n", name.c_str(),
                100 * result.error, result.energy, shown.receivers, 100 * uncut.error);
    EXPECT_LT(result.high, 0.08) << name;
    EXPECT_NEAR(result.energy, 1.0, 0.03) << name;
}

CLGI_IN_BOTH_MATHS(TransferPictures);

TEST_P(TransferPictures, UnderASkyAreThoseOfThePathTracer) {
    Scene scene = test::heap_of_solids(11);
    test::light_by_gradient(scene, {0.8f, 1.0f, 1.3f}, glm::normalize(glm::dvec3(0.5, 0.6, 0.3)));
    expect_like(scene, GetParam(), "gradient");
}

TEST(TransferViewPictures, UnderPhotographedSkiesHasThePicturesOfThePathTracer) {
    const std::filesystem::path folder = std::filesystem::path(CLGI_SCENES_DIR) / "hdr";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no folder " << folder;
    std::uint64_t seed = 20;
    for (const char* name :
         {"venice_sunset_1k", "empty_warehouse_01_1k", "st_fagans_interior_1k"}) {
        Scene scene = test::heap_of_solids(++seed);
        const io::Image image = io::load_image(folder / (std::string(name) + ".hdr"));
        Environment sky;
        sky.width = image.width;
        sky.height = image.height;
        for (std::size_t i = 0; i < image.find("R")->values.size(); ++i)
            sky.texels.emplace_back(image.find("R")->values[i], image.find("G")->values[i],
                                    image.find("B")->values[i]);
        scene.environment = std::move(sky);
        expect_like(scene, Math::strict, name, 96);
    }
}

// Vertices alone miss the shadows on the ground, which has four; probes find them.
TEST(TransferViewPictures, FindsWhereVerticesAreTooFew) {
    Scene scene = test::heap_of_solids(11);
    test::light_by(scene, {0.8f, 1.0f, 1.3f});
    const test::Twice truth = truth_of(scene, 48);
    const std::vector<bool> seen = surfaces(scene);
    const auto infinite = std::numeric_limits<float>::infinity();
    const Shown vertices = picture_of(scene, infinite), some = picture_of(scene, 0.1f),
                all = picture_of(scene, 0.0f);
    EXPECT_EQ(vertices.receivers, 0u);
    EXPECT_EQ(all.receivers, std::uint32_t{picture_width * picture_height});
    EXPECT_GT(some.receivers, 500u);
    EXPECT_LT(some.receivers, std::uint32_t{picture_width * picture_height / 2});
    const double coarse = test::apart(vertices.radiance, truth, seen).error,
                 fair = test::apart(some.radiance, truth, seen).high,
                 fine = test::apart(all.radiance, truth, seen).high;
    EXPECT_GT(coarse, 3.0 * fair);
    EXPECT_LT(fair, 0.03);
    EXPECT_LT(fine, 0.015);
}

// One sheet, seen from its front and its back, is lit from the side that is seen.
TEST(TransferViewPictures, ShowsTheSideThatIsSeen) {
    Scene scene = test::plain_scene({0.3f, 0.5f, 0.8f});
    scene.materials[0].double_sided = true;
    test::add_floor(scene, 10.0);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.1, 0.9, 0.2));
    test::light_by_gradient(scene, {1, 2, 3}, axis);
    for (const double side : {1.0, -1.0})
        for (const auto kind : {Camera::Kind::perspective, Camera::Kind::orthographic})
            for (const float threshold : {0.0f, std::numeric_limits<float>::infinity()}) {
                scene.cameras = {test::camera_at({0.3, 2 * side, 0.2}, {0, 0, 0})};
                scene.cameras[0].kind = kind;
                const Shown shown = picture_of(scene, threshold);
                const double lit = pi + side * 2 * pi / 3 * axis.y;
                for (const std::size_t i : {0u, 160u * 60 + 80, 160u * 119 + 40})
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(shown.radiance[i][c],
                                    scene.materials[0].base_color[c] / pi * (c + 1) * lit,
                                    2e-3 * (c + 1))
                            << side << ", " << threshold;
            }
}

// A mirror-like lobe is no part of this method; a broad one is: the path tracer's picture.
TEST_P(TransferPictures, HaveTheGlossOfBroadLobes) {
    Scene scene = test::heap_of_solids(13);
    for (Material& material : scene.materials) {
        material.metallic = 0.8f;
        material.roughness = 0.75f;
    }
    test::light_by_gradient(scene, {0.8f, 1.0f, 1.3f}, glm::normalize(glm::dvec3(0.5, 0.6, 0.3)));
    const test::Twice truth = truth_of(scene, 48);
    const std::vector<bool> seen = surfaces(scene);
    for (const float threshold : {0.1f, 0.0f}) {
        const test::Apart result =
            test::apart(picture_of(scene, threshold, {}, GetParam()).radiance, truth, seen);
        std::printf("gloss: error %.2f %%, energy %.4f\n", 100 * result.error, result.energy);
        // What is left is the Phong lobe in place of GGX.
        EXPECT_LT(result.high, 0.09);
        EXPECT_NEAR(result.energy, 1.0, 0.02);
    }
    for (Material& material : scene.materials) material.metallic = 0.0f, material.roughness = 1.0f;
    EXPECT_GT(test::apart(picture_of(scene, 0.0f, {}, GetParam()).radiance, truth, seen).error,
              0.1);
}

}  // namespace
}  // namespace clgi
