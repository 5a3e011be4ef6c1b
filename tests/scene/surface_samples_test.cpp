// Surfaces given by triangle and weights: what a pixel shows there, without a view.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "patchwork.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;

struct Found {
    Drawing at;                 // planes and ids alone
    std::vector<float> coords;  // [4][stride]
};

Found surfaces(const DeviceScene& scene, const std::vector<SurfaceSample>& samples,
               const BuildOptions& build = {}) {
    const test::Device& on = test::device();
    const auto count = static_cast<std::uint32_t>(samples.size());
    Found out;
    out.at.stride = test::padded(count);
    const GBuffer planes{test::upload(std::vector<float>(GBUFFER_PLANES * out.at.stride, 9.0f)),
                         test::upload(std::vector<cl_int>(GBUFFER_ID_PLANES * out.at.stride, 9)),
                         out.at.stride};
    const cl::Buffer coords = test::upload(std::vector<float>(4 * out.at.stride, 9.0f));
    const GBufferPasses passes(on.context, on.device, build);
    passes.surface(on.queue, scene, {count, out.at.stride, 1, 0}, test::upload(samples), planes,
                   coords);
    out.at.planes = test::download<float>(planes.planes, GBUFFER_PLANES * out.at.stride);
    out.at.ids = test::download<std::int32_t>(planes.ids, GBUFFER_ID_PLANES * out.at.stride);
    out.coords = test::download<float>(coords, 4 * out.at.stride);
    return out;
}

double apart(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 off = glm::abs(a - b);
    return glm::max(glm::max(off.x, off.y), off.z);
}

// The front of every triangle of a picture, at the weights that its pixels have, with as much
// surface as a pixel covers.
TEST(SurfaceSamples, AreWhatPixelsShowThere) {
    const Scene scene = test::patchwork(90, 101);
    const DeviceScene placed = test::on_device(scene);
    const View view = test::looking(Looking::perspective, placed, 211, 157);
    const Drawing drawing = test::draw(placed, view);
    const test::SurfaceReference reference(scene, placed);
    std::vector<SurfaceSample> samples;
    std::vector<std::size_t> pixels;
    std::vector<test::SurfaceTruth> truths;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int triangle = drawing.triangle(p);
        if (triangle < 0) continue;
        const test::SurfaceTruth truth =
            reference.at(view, triangle, static_cast<double>(p % view.width) + 0.5,
                         static_cast<double>(p / view.width) + 0.5);
        if (glm::min(glm::min(truth.weights.x, truth.weights.y), truth.weights.z) < 1e-3 ||
            truth.slant < 0.25 || !truth.front || truth.near_border)
            continue;
        const double pixel = 4.0 * double{view.right.w} * double{view.up.w} /
                             (double(view.width) * double(view.height));
        const glm::dvec3 ray = test::pixel_ray(view, static_cast<double>(p % view.width) + 0.5,
                                               static_cast<double>(p / view.width) + 0.5)
                                   .direction;
        const double covered =
            pixel * truth.depth * truth.depth / std::abs(glm::dot(ray, truth.geometric));
        samples.push_back({static_cast<std::uint32_t>(drawing.visibility[p]),
                           static_cast<float>(truth.weights.y), static_cast<float>(truth.weights.z),
                           static_cast<float>(covered)});
        pixels.push_back(p);
        truths.push_back(truth);
    }
    ASSERT_GT(samples.size(), 1000u);
    const Found found = surfaces(placed, samples);
    std::size_t leaning = 0;
    double position = 0, geometric = 0, normal = 0, base = 0, emission = 0, uv = 0;
    const auto most = [](double& of, double value) { of = std::max(of, value); };
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const test::SurfaceTruth& truth = truths[i];
        const SceneTriangle& t = scene.triangles[drawing.order[samples[i].triangle]];
        glm::dvec3 shading = test::between(
            t, truth.weights, [&](std::uint32_t v) { return glm::dvec3(scene.normals[v]); });
        const double toward = glm::dot(shading, truth.geometric) / glm::length(shading);
        shading = toward > 0.0 ? glm::normalize(shading) : truth.geometric;
        leaning += toward < 0.0;
        most(position, apart(found.at.at(GBUFFER_POSITION, i), truth.position));
        most(geometric, apart(found.at.at(GBUFFER_GEOMETRIC, i), truth.geometric));
        if (std::abs(toward) > 1e-3) most(normal, apart(found.at.at(GBUFFER_NORMAL, i), shading));
        const auto shown = [&](int plane) { return glm::dvec3(drawing.at(plane, pixels[i])); };
        most(base, apart(found.at.at(GBUFFER_BASE, i), shown(GBUFFER_BASE)));
        most(emission, apart(found.at.at(GBUFFER_EMISSION, i), shown(GBUFFER_EMISSION)) *
                           placed.frame().exposure / 50.0);  // emission goes up to 50 cd/m^2
        EXPECT_EQ(found.at.depth(i), 0.0f);
        EXPECT_EQ(found.at.ids[GBUFFER_TRIANGLE * found.at.stride + i],
                  static_cast<int>(samples[i].triangle));
        EXPECT_EQ(found.at.ids[GBUFFER_MATERIAL * found.at.stride + i],
                  static_cast<int>(t.material));
        const glm::dvec4 coords = test::between(
            t, truth.weights, [&](std::uint32_t v) { return glm::dvec4(scene.uvs[v]); });
        for (int c = 0; c < 4; ++c)
            most(uv, std::abs(double{found.coords[c * found.at.stride + i]} - coords[c]));
    }
    EXPECT_GT(leaning, 5u);
    // The bounds of surface_test.cpp; coordinates reach 3.
    EXPECT_LT(position, 2e-6);
    EXPECT_LT(geometric, 3e-6);
    EXPECT_LT(normal, 2e-5);
    EXPECT_LT(base, 1.2e-4);
    EXPECT_LT(emission, 1.2e-4);
    EXPECT_LT(uv, 2e-6);
}

// Samples of no triangle, alone or beside others in their packet, give zeros in every plane.
TEST(SurfaceSamples, OfNoTriangleAreNothing) {
    const Scene scene = test::patchwork(40, 102);
    const DeviceScene placed = test::on_device(scene);
    const std::uint32_t count = placed.info().triangle_count;
    std::vector<SurfaceSample> samples;
    for (std::uint32_t i = 0; i < 37; ++i) {
        const std::uint32_t none[] = {count, ~0u, 0x80000000u};
        samples.push_back({i % 3 == 1 || i >= 16 ? none[i % 3] : i, 0.2f, 0.3f, 1e-4f});
    }
    for (const int width : test::widths()) {
        const Found found = surfaces(placed, samples, {.packet_width = width});
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const bool there = samples[i].triangle < count;
            const int triangle = there ? static_cast<int>(samples[i].triangle) : -1;
            EXPECT_EQ(found.at.ids[GBUFFER_TRIANGLE * found.at.stride + i], triangle);
            EXPECT_EQ(found.at.ids[GBUFFER_MATERIAL * found.at.stride + i] >= 0, there);
            EXPECT_EQ(glm::length(found.at.at(GBUFFER_NORMAL, i)) > 0.5f, there);
            for (int plane = 0; plane < GBUFFER_PLANES && !there; ++plane)
                EXPECT_EQ(found.at.planes[plane * found.at.stride + i], 0.0f) << plane;
            for (int c = 0; c < 4 && !there; ++c)
                EXPECT_EQ(found.coords[c * found.at.stride + i], 0.0f) << c;
        }
    }
}

}  // namespace
}  // namespace clgi
