// Pictures of glossy surfaces: the lobe at a pixel, and rooms against the path tracer.
// SPDX-License-Identifier: MIT
#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "glossy_scenes.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"

namespace clgi {
namespace {

using test::antiradiance_options;
using test::GlossyPicture;
using test::lobe_albedo_at;
using test::metal;
using test::shown_height;
using test::shown_width;

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(GlossyPixels);

// What arrives at a glossy pixel under light from everywhere is reflected with the lobe's albedo.
TEST_P(GlossyPixels, ShowTheAlbedoUnderAnEvenSky) {
    for (const float roughness : {0.03f, 0.4f, 0.9f})
        for (const bool orthographic : {false, true}) {
            // The parallel view in half storage.
            const double within = orthographic ? 3e-3 : 1e-4;
            Scene scene = test::plain_scene();
            // Others before it: each has albedos of its own.
            for (int k = 0; k < 10; ++k)
                test::add_material(scene, metal({1.0f, 1.0f, 1.0f}, 0.05f + 0.09f * float(k)));
            Material both = metal({0.9f, 0.5f, 0.2f}, roughness);
            both.double_sided = true;
            test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0.3, 1}, {1, 0.3, -1}, {-1, 0, -1}},
                           test::add_material(scene, both));
            scene.environment = Environment();
            scene.environment->factor = {2.0f, 3.0f, 5.0f};
            scene.cameras = {test::camera_at({0.3, 1.0, 1.8}, {0, 0, 0})};
            if (orthographic) {
                scene.cameras[0].kind = Camera::Kind::orthographic;
                scene.cameras[0].half_height = 1.2f;
            }
            AntiradianceOptions options = antiradiance_options(GetParam(), 128, 60);
            if (orthographic) options.build.storage = Storage::half;
            GlossyPicture shown(scene, options);
            ASSERT_TRUE(shown.solver.run());
            const auto found = shown.picture(scene.cameras[0]);
            const Picture& picture = shown.view.picture();
            const auto seen = test::places_of(picture);
            const auto ids = test::download<cl_int>(
                picture.gbuffer().ids, GBUFFER_ID_PLANES * std::size_t{picture.stride()});
            const Reflectance shares = reflectance(test::finished(1.0f, roughness));
            const std::vector<float> curve =
                lobe_albedos(std::max(double{roughness} * double{roughness}, 0.01));
            const glm::dvec3 n = glm::normalize(glm::dvec3(-0.3, 2.0, 0.0)), light(2.0, 3.0, 5.0);
            const glm::dvec3 forward =
                glm::normalize(glm::dvec3(0, 0, 0) - scene.cameras[0].position);
            int counted = 0;
            for (std::size_t p = 0; p < found.size(); ++p) {
                if (ids[GBUFFER_TRIANGLE * picture.stride() + p] < 0) continue;
                const SceneFrame& frame = shown.scene.frame();
                const glm::dvec3 at = glm::dvec3(seen[p]) / frame.scale + frame.origin;
                const glm::dvec3 eye =
                    orthographic ? -forward : glm::normalize(scene.cameras[0].position - at);
                const double gloss = lobe_albedo_at(curve, glm::dot(n, eye));
                for (int c = 0; c < 3; ++c) {
                    const double base = c == 0 ? 0.9 : c == 1 ? 0.5 : 0.2;
                    const double wanted =
                        light[c] *
                        (base * (shares.diffuse + shares.lobe * gloss) + shares.coat * gloss);
                    ASSERT_NEAR(found[p][c], wanted, within * wanted) << p;
                }
                ++counted;
            }
            EXPECT_GT(counted, 500);
            EXPECT_EQ(picture.non_finite(), 0u);
        }
}

// Half of a square is metal by its texture: shares are those of the pixel, the lobe's width that of
// the mean.
TEST_P(GlossyPixels, HaveTheFinishOfATexture) {
    Scene scene = test::plain_scene();
    Material both = metal({0.9f, 0.5f, 0.2f}, 0.6f);
    both.double_sided = true;
    both.metallic = 0.5f;
    both.metallic_roughness_texture.texture = 0;
    Texture halves{"halves", 2, 1, {0, 153, 255, 255, 0, 153, 0, 255}};  // roughness 0.6
    halves.nearest = true;
    halves.srgb = false;
    scene.textures.push_back(halves);
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0.3, 1}, {1, 0.3, -1}, {-1, 0, -1}},
                   test::add_material(scene, both));
    for (const float u : {0.0f, 1.0f, 1.0f, 0.0f}) scene.uvs.emplace_back(u, 0.5f, 0.0f, 0.0f);
    scene.environment = Environment();
    scene.environment->factor = {2.0f, 3.0f, 5.0f};
    scene.cameras = {test::camera_at({0.3, 1.0, 1.8}, {0, 0, 0})};
    GlossyPicture shown(scene, antiradiance_options(GetParam(), 128, 60));
    ASSERT_TRUE(shown.solver.run());
    const auto found = shown.picture(scene.cameras[0]);
    const Picture& picture = shown.view.picture();
    const auto seen = test::places_of(picture);
    const auto ids = test::download<cl_int>(picture.gbuffer().ids,
                                            GBUFFER_ID_PLANES * std::size_t{picture.stride()});
    const std::vector<float> curve = lobe_albedos(0.36);
    const glm::dvec3 n = glm::normalize(glm::dvec3(-0.3, 2.0, 0.0)), light(2.0, 3.0, 5.0);
    int counted[2] = {0, 0};
    for (std::size_t p = 0; p < found.size(); ++p) {
        if (ids[GBUFFER_TRIANGLE * picture.stride() + p] < 0) continue;
        const SceneFrame& frame = shown.scene.frame();
        const glm::dvec3 at = glm::dvec3(seen[p]) / frame.scale + frame.origin;
        if (std::abs(at.x) < 0.02) continue;
        const bool metallic = at.x < 0.0;
        const Reflectance shares = reflectance(test::finished(metallic ? 1.0f : 0.0f, 0.6f));
        const double gloss =
            lobe_albedo_at(curve, glm::dot(n, glm::normalize(scene.cameras[0].position - at)));
        for (int c = 0; c < 3; ++c) {
            const double base = c == 0 ? 0.9 : c == 1 ? 0.5 : 0.2;
            const double wanted =
                light[c] * (base * shares.diffuse + (base * shares.lobe + shares.coat) * gloss);
            ASSERT_NEAR(found[p][c], wanted, 5e-3 * wanted) << p;
        }
        ++counted[metallic];
    }
    EXPECT_GT(counted[0], 200);
    EXPECT_GT(counted[1], 200);
}

// One bright bin: it is seen about the mirrored direction to the eye, through the pixel's own
// normal, interpolated between the corners of leaves.
TEST_P(GlossyPixels, ShowABinWhereItIsMirrored) {
    Scene scene = test::plain_scene();
    Material both = metal({0.9f, 0.5f, 0.2f}, 0.55f);
    both.double_sided = true;
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0.3, 1}, {1, 0.3, -1}, {-1, 0, -1}},
                   test::add_material(scene, both));
    for (glm::vec3& normal : scene.normals) normal = glm::normalize(glm::vec3(0.1f, 1.0f, -0.2f));
    scene.cameras = {test::camera_at({0.3, 1.0, 1.8}, {0, 0, 0})};
    GlossyPicture shown(scene, antiradiance_options(GetParam(), 128, 60));
    ASSERT_TRUE(shown.solver.run());
    const GlossBuffers& gloss = shown.solver.gloss();
    const DirectionBins& bins = shown.solver.bins();
    // Light that grows with x, at each vertex.
    const ElementTree& tree = shown.solver.elements();
    const auto patches = test::download<PatchCorners>(shown.solver.surface().patches, tree.count());
    const auto of_vertex =
        test::download<std::uint32_t>(gloss.rows, shown.solver.surface().vertex_count);
    const auto bright = static_cast<std::size_t>(bins.nearest({-0.1, -0.6, 0.8}));
    std::vector<float> light(gloss.vertex_count * std::size_t{3} * 128, 0.0f);
    for (const std::uint32_t i : shown.solver.leaf_elements())
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < 3; ++c)
                light[(of_vertex[patches[i].vertex[k]] * std::size_t{3} + c) * 128 + bright] =
                    static_cast<float>((c + 1) * (2.0 + tree.corners[i][k].x));
    test::device().queue.enqueueWriteBuffer(gloss.light, CL_TRUE, 0, light.size() * sizeof(float),
                                            light.data());
    const auto found = shown.picture(scene.cameras[0]);
    const Picture& picture = shown.view.picture();
    const auto seen = test::places_of(picture);
    const auto ids = test::download<cl_int>(picture.gbuffer().ids,
                                            GBUFFER_ID_PLANES * std::size_t{picture.stride()});
    const Reflectance shares = reflectance(test::finished(1.0f, 0.55f));
    const std::vector<float> curve =
        lobe_albedos(double{surface_of(test::finished(1.0f, 0.55f)).y});
    const double exponent = std::min<double>(shares.exponent, 128.0 / (2.0 * pi));
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.1, 1.0, -0.2));
    int counted = 0;
    for (std::size_t p = 0; p < found.size(); ++p) {
        if (ids[GBUFFER_TRIANGLE * picture.stride() + p] < 0) continue;
        const SceneFrame& frame = shown.scene.frame();
        const glm::dvec3 at = glm::dvec3(seen[p]) / frame.scale + frame.origin;
        const glm::dvec3 eye = glm::normalize(scene.cameras[0].position - at);
        const glm::dvec3 mirror = 2.0 * glm::dot(n, eye) * n - eye;
        double all = 0.0, one = 0.0;
        for (std::size_t b = 0; b < 128; ++b) {
            const glm::dvec3 from = -bins.directions[b];
            const double share = std::pow(std::max(0.0, glm::dot(from, mirror)), exponent) *
                                 std::max(0.0, glm::dot(from, n)) * bins.solid_angles[b];
            all += share;
            if (b == bright) one = share;
        }
        for (int c = 0; c < 3; ++c) {
            const double base = c == 0 ? 0.9 : c == 1 ? 0.5 : 0.2;
            const double wanted =
                shown.scene.frame().exposure * (base * shares.lobe + shares.coat) *
                lobe_albedo_at(curve, glm::dot(n, eye)) * one / all * (c + 1) * (2.0 + at.x);
            ASSERT_NEAR(found[p][c], wanted, 2e-5 + 1e-4 * wanted) << p;
        }
        ++counted;
    }
    EXPECT_GT(counted, 500);
}

// A closed room, and in it a box of a rough metal, turned about the vertical.
Scene room_with_metal(float roughness) {
    Scene scene = test::plain_scene(glm::vec3(0.7f, 0.65f, 0.6f));
    test::add_box(scene, {0, 0, 0}, {4, 2.5, 3}, -1);
    Material red;
    red.base_color = {0.8f, 0.15f, 0.1f, 1.0f};
    test::add_box(scene, {0.05, 0.05, 0.4}, {0.15, 1.8, 2.6}, 1, test::add_material(scene, red));
    const std::size_t first = scene.positions.size();
    test::add_box(scene, {1.4, 0.02, 1.0}, {2.6, 1.4, 2.0}, 1,
                  test::add_material(scene, metal({0.9f, 0.85f, 0.7f}, roughness)));
    const double cosine = std::cos(0.5), sine = std::sin(0.5);
    for (std::size_t i = first; i < scene.positions.size(); ++i) {
        const glm::dvec3 at = scene.positions[i] - glm::dvec3(2.0, 0.0, 1.5);
        scene.positions[i] = {2.0 + cosine * at.x + sine * at.z, at.y,
                              1.5 - sine * at.x + cosine * at.z};
        const glm::vec3 n = scene.normals[i];
        scene.normals[i] = glm::vec3(float(cosine) * n.x + float(sine) * n.z, n.y,
                                     -float(sine) * n.x + float(cosine) * n.z);
    }
    scene.lights = {test::point_light({0.9, 2.2, 0.6})};
    scene.lights[0].intensity = {100.0f, 90.0f, 80.0f};
    scene.cameras = {test::camera_at({0.4, 1.5, 0.25}, {2.1, 0.8, 1.5}, 1.1f)};
    return scene;
}

struct Difference {
    double relative, energy;  // root mean square of the mean; of the truth
};

Difference compare(const std::vector<glm::vec3>& found, const std::vector<glm::vec3>& truth,
                   const std::vector<int>& where) {
    double square = 0.0, sum = 0.0, wanted = 0.0;
    for (const int p : where)
        for (int c = 0; c < 3; ++c) {
            const auto i = static_cast<std::size_t>(p);
            square += std::pow(double(found[i][c]) - truth[i][c], 2);
            sum += found[i][c];
            wanted += truth[i][c];
        }
    const double count = 3.0 * static_cast<double>(where.size());
    return {std::sqrt(square / count) / (wanted / count), sum / wanted};
}

// Indirect light alone, its gloss included.
TEST(GlossyReference, ARoomWithABoxOfMetal) {
    for (const float roughness : {0.35f, 0.6f}) {
        const Scene scene = room_with_metal(roughness);
        GlossyPicture shown(scene), flat(scene, [] {
            AntiradianceOptions o;
            o.least_gloss = 1.0;
            return o;
        }());
        ASSERT_TRUE(shown.solver.run());
        ASSERT_TRUE(flat.solver.run());
        EXPECT_TRUE(shown.solver.status().converged);
        const Camera& camera = scene.cameras[0];
        const auto found = shown.picture(camera), without = flat.picture(camera);
        EXPECT_EQ(shown.solver.status().non_finite + shown.view.picture().non_finite(), 0u);
        reference::Options tracing;
        tracing.width = shown_width;
        tracing.height = shown_height;
        tracing.samples = 400;
        tracing.effects = reference::parse_effects("indirect");
        const reference::Picture truth = reference::PathTracer(scene).render(camera, tracing);
        const auto ids =
            test::download<cl_int>(shown.view.picture().gbuffer().ids,
                                   GBUFFER_ID_PLANES * std::size_t{shown.view.picture().stride()});
        std::vector<int> all, box;
        for (int p = 0; p < shown_width * shown_height; ++p) {
            all.push_back(p);
            if (ids[GBUFFER_MATERIAL * shown.view.picture().stride() +
                    static_cast<std::size_t>(p)] == 2)
                box.push_back(p);
        }
        ASSERT_GT(box.size(), 500u);
        // Truth has noise of some 8 %. Where leaves are diffuse alone the box is darker, the more
        // the smoother it is.
        const auto error = [&](const std::vector<glm::vec3>& picture, const std::vector<int>& of) {
            return compare(picture, truth.radiance, of);
        };
        EXPECT_LT(truth.relative_error, 0.1);
        EXPECT_LT(error(found, all).relative, 0.15) << roughness;
        EXPECT_LT(error(found, box).relative, 0.15) << roughness;
        EXPECT_NEAR(error(found, all).energy, 1.0, 0.02) << roughness;
        EXPECT_NEAR(error(found, box).energy, 1.0, 0.03) << roughness;
        EXPECT_LT(error(without, all).energy, roughness < 0.5f ? 0.8 : 0.85) << roughness;
        EXPECT_LT(error(without, box).energy, roughness < 0.5f ? 0.5 : 0.75) << roughness;
    }
}

}  // namespace
}  // namespace clgi
