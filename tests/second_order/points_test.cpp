// Points of the surface by triangle and weights, against interpolation in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "drawing.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

struct Points {
    std::vector<SurfaceSample> samples;
    std::vector<float> planes;      // [GBUFFER_PLANES][stride]
    std::vector<std::int32_t> ids;  // [GBUFFER_ID_PLANES][stride]
    std::vector<float> coords;      // [4][stride]
    std::uint32_t stride = 0;
    glm::vec3 at(int plane, std::size_t i) const {
        return {planes[plane * stride + i], planes[(plane + 1) * stride + i],
                planes[(plane + 2) * stride + i]};
    }
};

Points points_of(const DeviceScene& scene, const std::vector<SurfaceSample>& samples,
                 const GBufferPasses& passes = test::gbuffer_passes()) {
    const auto count = static_cast<std::uint32_t>(samples.size());
    Points out;
    out.samples = samples;
    out.stride = test::padded(count);
    const GBuffer target{test::upload(std::vector<float>(GBUFFER_PLANES * out.stride, 7.0f)),
                         test::empty<cl_int>(GBUFFER_ID_PLANES * out.stride), out.stride};
    const cl::Buffer coords = test::empty<float>(4 * out.stride);
    passes.surface(test::device().queue, scene, {count, out.stride, 1, 0}, test::upload(samples),
                   target, coords);
    out.planes = test::download<float>(target.planes, GBUFFER_PLANES * out.stride);
    out.ids = test::download<std::int32_t>(target.ids, GBUFFER_ID_PLANES * out.stride);
    out.coords = test::download<float>(coords, 4 * out.stride);
    return out;
}

std::vector<SurfaceSample> random_samples(std::uint32_t triangles, int count) {
    test::Random random(96);
    std::vector<SurfaceSample> out;
    for (int i = 0; i < count; ++i) {
        const auto b1 = static_cast<float>(random(0, 1));
        out.push_back({static_cast<std::uint32_t>(random.integer(0, int(triangles) - 1)), b1,
                       static_cast<float>(random(0, 1)) * (1.0f - b1), 0.0f});
    }
    return out;
}

TEST(Points, HaveTheAttributesOfTheirTriangles) {
    Scene world = test::patchwork(200, 97, false);
    test::Random random(98);
    world.uvs.clear();
    for (std::size_t v = 0; v < world.positions.size(); ++v)
        world.uvs.emplace_back(random(-2, 2), random(-2, 2), random(-2, 2), random(-2, 2));
    for (std::size_t t = 0; t < world.triangles.size(); t += 5)  // facing away from their triangles
        for (const std::uint32_t v : world.triangles[t].vertex)
            world.normals[v] = -world.normals[v];
    const DeviceScene scene = test::on_device(world);
    const Points found = points_of(scene, random_samples(200, 1003));
    int given_way = 0;
    for (std::size_t i = 0; i < found.samples.size(); ++i) {
        const SurfaceSample& sample = found.samples[i];
        const SceneTriangle& t = world.triangles[scene.triangle_order()[sample.triangle]];
        const double w[3] = {1.0 - double{sample.b1} - double{sample.b2}, double{sample.b1},
                             double{sample.b2}};
        glm::dvec3 at(0), normal(0);
        glm::dvec4 uv(0), color(0);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = t.vertex[k];
            at += w[k] * glm::dvec3(scene.frame().to_local(world.positions[v]));
            normal += w[k] * glm::dvec3(world.normals[v]);
            uv += w[k] * glm::dvec4(world.uvs[v]);
            color += w[k] * glm::dvec4(world.colors[v]);
        }
        const glm::dvec3 a = world.positions[t.vertex[0]], b = world.positions[t.vertex[1]],
                         c = world.positions[t.vertex[2]];
        const glm::dvec3 wound = glm::normalize(glm::cross(b - a, c - a));
        const double facing = glm::dot(glm::normalize(normal), wound);
        const Material& material = world.materials[t.material];
        const auto off = [&](int plane, const glm::dvec3& wanted) {
            return glm::distance(glm::dvec3(found.at(plane, i)), wanted);
        };
        EXPECT_LT(off(GBUFFER_POSITION, at), 4e-7);
        EXPECT_LT(off(GBUFFER_GEOMETRIC, wound), 2e-5);  // slender triangles
        if (std::abs(facing) > 1e-3) {
            given_way += facing < 0.0;
            EXPECT_LT(off(GBUFFER_NORMAL, facing > 0.0 ? glm::normalize(normal) : wound), 3e-5);
        }
        EXPECT_LT(off(GBUFFER_BASE, glm::dvec3(material.base_color) * glm::dvec3(color)), 1e-6);
        EXPECT_LT(off(GBUFFER_EMISSION, glm::dvec3(material.emission) / scene.frame().exposure),
                  1e-6);
        for (int k = 0; k < 4; ++k)
            EXPECT_NEAR(found.coords[k * found.stride + i], uv[k], 1e-6) << k;
        EXPECT_EQ(found.planes[GBUFFER_DEPTH * found.stride + i], 0.0f);
        EXPECT_EQ(found.ids[GBUFFER_MATERIAL * found.stride + i], static_cast<int>(t.material));
        EXPECT_EQ(found.ids[GBUFFER_TRIANGLE * found.stride + i],
                  static_cast<int>(sample.triangle));
    }
    EXPECT_GT(given_way, 20);
}

// A pixel's attributes are those of the point that its ray meets: textures at the finest level.
TEST(Points, AreTexturedLikeThePixelsThatShowThem) {
    Scene world = test::patchwork(40, 99);
    for (Texture& texture : world.textures) texture.nearest = false;
    const DeviceScene scene = test::on_device(world);
    // From so close that every pixel is less than a texel.
    const View view =
        make_view(test::camera_at({0.3, 0.2, 0.9}, {0, 0, 0}), scene.frame(), 2048, 64);
    const test::Drawing drawing = test::draw(scene, view);
    std::vector<SurfaceSample> samples;
    std::vector<std::size_t> pixels;
    for (std::size_t p = 0; p < drawing.pixels(); p += 37) {
        if (drawing.triangle(p) < 0) continue;
        const auto t =
            static_cast<std::uint32_t>(drawing.ids[GBUFFER_TRIANGLE * drawing.stride + p]);
        const SceneTriangle& triangle = world.triangles[scene.triangle_order()[t]];
        glm::dvec3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = scene.frame().to_local(world.positions[triangle.vertex[k]]);
        const glm::dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
        const glm::dvec3 n = glm::cross(e1, e2), at(drawing.at(GBUFFER_POSITION, p));
        const double area = glm::dot(n, n);
        samples.push_back(
            {t, static_cast<float>(glm::dot(glm::cross(at - corner[0], e2), n) / area),
             static_cast<float>(glm::dot(glm::cross(e1, at - corner[0]), n) / area), 0.0f});
        pixels.push_back(p);
    }
    ASSERT_GT(samples.size(), 100u);
    const Points found = points_of(scene, samples);
    std::size_t off = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        off +=
            glm::distance(found.at(GBUFFER_BASE, i), drawing.at(GBUFFER_BASE, pixels[i])) > 2e-3f;
    EXPECT_LE(off, samples.size() / 50) << "of " << samples.size();
}

TEST(Points, ThatDoNotExistAreZerosAtEveryWidth) {
    const DeviceScene scene = test::on_device(test::patchwork(50, 94, false));
    std::vector<SurfaceSample> samples = random_samples(50, 37);
    samples[5].triangle = 50;
    samples[36].triangle = 0xffffffffu;
    const Points usual = points_of(scene, samples);
    for (const std::size_t gone : {5u, 36u}) {
        for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
            EXPECT_EQ(usual.planes[plane * usual.stride + gone], 0.0f) << plane;
        EXPECT_EQ(usual.ids[GBUFFER_MATERIAL * usual.stride + gone], -1);
    }
    for (const int width : test::widths()) {
        const GBufferPasses passes(test::programs(), {.packet_width = width});
        const Points other = points_of(scene, samples, passes);
        for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
            for (std::size_t i = 0; i < samples.size(); ++i)
                EXPECT_EQ(other.planes[plane * other.stride + i],
                          usual.planes[plane * usual.stride + i]);
    }
}

}  // namespace
}  // namespace clgi
