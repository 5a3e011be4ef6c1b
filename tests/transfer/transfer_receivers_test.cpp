// Receivers at pixels and other sides, and their light brought to pixels, number by number.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "device.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::nan;
constexpr std::uint32_t stride = 16;

CLGI_IN_BOTH_MATHS(TransferReceivers);

const ReceiverPasses& receiver_passes(Math math) {
    return test::shared_passes<ReceiverPasses>(math);
}

// A tilted triangle, and a second one that has another material.
Scene two_triangles() {
    Scene scene = test::plain_scene();
    Material glossy;
    glossy.metallic = 0.6f;
    glossy.roughness = 0.5f;
    test::add_material(scene, glossy);
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0.25}, {0, 1, 0.5});
    test::add_triangle(scene, {1, 1, 0}, {0, 1, 0.5}, {1, 0, 0.25}, 1);
    return scene;
}

// Planes of a few pixels, each a function of the pixel.
struct Pixels {
    Pixels() : planes(GBUFFER_PLANES * stride, 0.0f), ids(GBUFFER_ID_PLANES * stride, -1) {}
    void set(int plane, std::uint32_t pixel, const glm::vec3& value) {
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(plane + c) * stride + pixel] = value[c];
    }
    GBuffer buffer() const {
        GBuffer out;
        out.planes = test::upload(planes);
        out.ids = test::upload(ids);
        out.stride = stride;
        return out;
    }
    std::vector<float> planes;
    std::vector<int> ids;
};

ReceiverBuffers receivers(const std::vector<float>& planes) {
    ReceiverBuffers out;
    out.stride = stride;
    out.planes = test::upload(planes);
    return out;
}

glm::vec3 row(const std::vector<float>& planes, int plane, std::size_t at) {
    const auto p = static_cast<std::size_t>(plane);
    return {planes[p * stride + at], planes[(p + 1) * stride + at], planes[(p + 2) * stride + at]};
}

TEST_P(TransferReceivers, OfOtherSidesAreTurnedRound) {
    std::vector<float> planes(RECEIVER_PLANES * stride);
    for (std::size_t i = 0; i < planes.size(); ++i) planes[i] = static_cast<float>(i) + 1.0f;
    const ReceiverBuffers buffers = receivers(planes);
    receiver_passes(GetParam())
        .other_sides(test::device().queue, {6, 2, stride, 0},
                     test::upload(std::vector<cl_uint>{4, 1}), buffers);
    const auto found = test::download<float>(buffers.planes, planes.size());
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t front = i == 0 ? 4 : 1;
        EXPECT_EQ(row(found, RECEIVER_POSITION, 6 + i), row(planes, RECEIVER_POSITION, front));
        EXPECT_EQ(row(found, RECEIVER_TANGENT, 6 + i), row(planes, RECEIVER_BITANGENT, front));
        EXPECT_EQ(row(found, RECEIVER_BITANGENT, 6 + i), row(planes, RECEIVER_TANGENT, front));
        EXPECT_EQ(row(found, RECEIVER_NORMAL, 6 + i), -row(planes, RECEIVER_NORMAL, front));
    }
    for (std::size_t k = 0; k < planes.size(); ++k) {
        if (k % stride == 6 || k % stride == 7) continue;
        EXPECT_EQ(found[k], planes[k]) << k;
    }
}

TEST_P(TransferReceivers, AtPixelsStandAboveTheSurface) {
    const DeviceScene scene = test::on_device(two_triangles());
    Pixels seen;
    const glm::vec3 normal(0.6f, -0.64f, 0.48f), flat(0, 0.6f, 0.8f);
    seen.set(GBUFFER_POSITION, 0, {1, 2, 3});
    for (const std::uint32_t pixel : {2u, 5u, 7u, 11u}) {
        seen.set(GBUFFER_POSITION, pixel, glm::vec3(0.25f, 0.5f, 0.125f) * float(pixel));
        seen.set(GBUFFER_NORMAL, pixel, normal);
        seen.set(GBUFFER_GEOMETRIC, pixel, flat);
        if (pixel == 11) seen.planes[GBUFFER_POSITION * stride + pixel] = nan;
        seen.ids[GBUFFER_MATERIAL * stride + pixel] = pixel == 5 ? 1 : 0;
    }
    const std::vector<cl_uint> pixels = {9, 7, 5, 0, 11, 2, 7, 7};
    const ReceiverBuffers out = receivers(std::vector<float>(RECEIVER_PLANES * stride, 7.0f));
    const cl::Buffer exponents = test::upload(std::vector<float>(stride, 7.0f));
    // From the second place on; pixel 0 shows nothing, and after 2 the list ends.
    receiver_passes(GetParam())
        .pixels(test::device().queue, {1, 7, stride, stride, 0.5f, 0, 0, 0},
                {test::upload(pixels), test::upload(std::vector<cl_uint>{6})}, scene, seen.buffer(),
                out, exponents);
    const auto planes = test::download<float>(out.planes, RECEIVER_PLANES * stride);
    const auto lobes = test::download<float>(exponents, stride);
    const float glossy = reflectance(test::finished(0.6f, 0.5f)).exponent;
    EXPECT_GT(glossy, 1.0f);
    const std::uint32_t listed[] = {7, 5, 0, 11, 2};
    for (std::size_t i = 0; i < 7; ++i) {
        const std::uint32_t pixel = i < 5 ? listed[i] : 0;
        const glm::vec3 n = row(planes, RECEIVER_NORMAL, i), t = row(planes, RECEIVER_TANGENT, i),
                        b = row(planes, RECEIVER_BITANGENT, i);
        EXPECT_EQ(lobes[i], i == 1 ? glossy : 0.0f) << i;
        if (pixel == 0) {
            for (int plane = 0; plane < RECEIVER_PLANES; ++plane)
                EXPECT_EQ(planes[static_cast<std::size_t>(plane) * stride + i], 0.0f) << i;
            continue;
        }
        if (pixel == 11) {
            for (const glm::vec3& v : {n, t, b}) EXPECT_TRUE(std::isnan(v.x + v.y + v.z));
            continue;
        }
        const glm::vec3 wanted = glm::vec3(0.25f, 0.5f, 0.125f) * float(pixel) + 0.5f * flat;
        const glm::vec3 position = row(planes, RECEIVER_POSITION, i);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(position[c], wanted[c], 1e-6f);
            EXPECT_NEAR(n[c], normal[c], 1e-6f);
            EXPECT_NEAR(glm::cross(t, b)[c], normal[c], 1e-6f);
        }
        EXPECT_NEAR(glm::dot(t, b), 0.0f, 1e-6f);
        EXPECT_NEAR(glm::length(t), 1.0f, 1e-6f);
    }
    for (std::size_t i = 7; i < stride; ++i) EXPECT_EQ(planes[i], 7.0f);
}

TEST_P(TransferReceivers, ArePutWhereTheirPixelsAre) {
    std::vector<float> light(3 * stride);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = static_cast<float>(i);
    const std::vector<cl_uint> pixels = {5, 6, 9, 3, 0, 1, 2, 4};
    for (const Storage storage : {Storage::full, Storage::half})
        for (const std::size_t listed : {8u, 5u}) {  // the run ends before the list, or after it
            const ReceiverPasses some(test::programs(), {.math = GetParam(), .storage = storage});
            const cl::Buffer shown = test::upload(std::vector<float>(3 * stride, 0.0f));
            some.place(test::device().queue, {2, 5, stride, stride, 0, 0, 0, 0},
                       {test::upload(pixels),
                        test::upload(std::vector<cl_uint>{static_cast<cl_uint>(listed)})},
                       test::upload(light), shown);
            std::vector<float> wanted(3 * stride, 0.0f);
            for (std::size_t i = 0; i < 5 && i + 2 < listed; ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    wanted[c * stride + pixels[i + 2]] = light[c * stride + i];
            auto found = test::download<float>(shown, 3 * stride);
            const auto halves = test::download<std::uint16_t>(shown, 3 * stride);
            if (storage == Storage::half)
                for (std::size_t k = 0; k < found.size(); ++k)
                    found[k] = glm::unpackHalf1x16(halves[k]);
            EXPECT_EQ(found, wanted) << listed;
        }
}

TEST_P(TransferReceivers, LightPixelsBetweenThem) {
    const Scene world = two_triangles();
    const DeviceScene scene = test::on_device(world);
    const auto order = scene.vertex_order();
    // Light is a linear function of the place, another one on the other side.
    const auto front = [](const glm::dvec3& p) {
        return glm::dvec3(1 + p.x, 2 + 3 * p.y, 0.5 + p.x - 0.25 * p.y);
    };
    const auto back = [](const glm::dvec3& p) {
        return glm::dvec3(4 - p.x, 1 + 0.5 * p.x * 2, 3 - p.y);
    };
    std::vector<float> light(3 * stride, nan);
    std::vector<cl_uint> other(6);
    std::uint32_t next = 6;
    for (std::size_t v = 0; v < 6; ++v) {
        const glm::dvec3 p = world.positions[order[v]];
        // The second triangle has one side.
        other[v] = order[v] < 3 ? next++ : RECEIVER_NONE;
        for (std::size_t c = 0; c < 3; ++c) {
            light[c * stride + v] = static_cast<float>(front(p)[int(c)]);
            if (other[v] != RECEIVER_NONE)
                light[c * stride + other[v]] = static_cast<float>(back(p)[int(c)]);
        }
    }
    Pixels seen;
    std::vector<glm::dvec3> places(12);
    for (std::uint32_t pixel = 0; pixel < 12; ++pixel) {
        const std::size_t t = pixel % 2;
        const double b1 = 0.05 * pixel, b2 = 0.3 - 0.02 * pixel;
        const std::uint32_t on_device = static_cast<std::uint32_t>(
            std::find(scene.triangle_order().begin(), scene.triangle_order().end(), t) -
            scene.triangle_order().begin());
        const auto& corner = world.triangles[t].vertex;
        places[pixel] = (1 - b1 - b2) * world.positions[corner[0]] +
                        b1 * world.positions[corner[1]] + b2 * world.positions[corner[2]];
        seen.set(GBUFFER_POSITION, pixel, scene.frame().to_local(places[pixel]));
        seen.ids[GBUFFER_TRIANGLE * stride + pixel] =
            pixel == 11 ? -1 : static_cast<int>(on_device);
    }
    const GBuffer buffer = seen.buffer();
    // Both triangles face z. From the front and the back, in perspective and not.
    // An eye between the first triangle's plane and the one beside it through the origin sees the
    // back; the same numbers as a direction lead to the front.
    const auto little = static_cast<float>(0.06 * scene.frame().scale);
    const std::pair<glm::vec4, bool> eyes[] = {
        {{0, 0, 9, 0}, false},    {{0, 0, -9, 0}, true},     {{0, 0, 1, 1}, false},
        {{0.2f, 0, -1, 1}, true}, {{0, 0, little, 0}, true}, {{0, 0, little, 1}, false}};
    for (const auto& [eye, from_behind] : eyes) {
        const cl::Buffer shown = test::upload(std::vector<float>(3 * stride, nan));
        receiver_passes(GetParam())
            .show(test::device().queue, {eye, 12, stride, 2, stride}, scene, test::upload(other),
                  buffer, test::upload(light), shown);
        const auto found = test::download<float>(shown, 3 * stride);
        for (std::size_t pixel = 0; pixel < 12; ++pixel) {
            const bool behind = from_behind && pixel % 2 == 0;
            glm::dvec3 wanted = behind ? back(places[pixel]) : front(places[pixel]);
            if (pixel == 11) wanted = glm::dvec3(0.0);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c * stride + pixel], wanted[int(c)], 2e-5)
                    << pixel << ", " << eye.z;
        }
        EXPECT_TRUE(std::isnan(found[12]));
    }
    // A triangle beyond the number that was given is none.
    const cl::Buffer shown = test::upload(std::vector<float>(3 * stride, nan));
    receiver_passes(GetParam())
        .show(test::device().queue, {eyes[0].first, 12, stride, 1, stride}, scene,
              test::upload(other), buffer, test::upload(light), shown);
    const auto found = test::download<float>(shown, 3 * stride);
    for (std::size_t pixel = 0; pixel < 12; ++pixel)
        EXPECT_EQ(found[pixel] != 0.0f, seen.ids[GBUFFER_TRIANGLE * stride + pixel] == 0) << pixel;
}

TEST_P(TransferReceivers, AddTheGlossOfTheirMaterials) {
    const DeviceScene scene = test::on_device(two_triangles());
    const Reflectance r = reflectance(test::finished(0.6f, 0.5f));
    EXPECT_GT(r.coat * r.lobe, 0.0f);
    Pixels seen;
    std::vector<float> light(3 * stride), radiance(3 * stride);
    for (std::uint32_t pixel = 0; pixel < 6; ++pixel) {
        seen.set(GBUFFER_BASE, pixel, {0.2f, 0.5f, 0.8f});
        seen.ids[GBUFFER_MATERIAL * stride + pixel] = pixel == 0 ? -1 : pixel == 1 ? 0 : 1;
        for (std::size_t c = 0; c < 3; ++c) {
            light[c * stride + pixel] = 1.0f + static_cast<float>(c + pixel);
            radiance[c * stride + pixel] = 0.25f * static_cast<float>(c + 1);
        }
    }
    light[3] = nan;
    light[1] = nan;  // of a surface without a lobe
    light[stride + 4] = -2.0f;
    light[5] = std::numeric_limits<float>::infinity();
    const cl::Buffer values = test::upload(radiance);
    const cl::Buffer bad = test::upload(std::vector<cl_uint>{3});
    receiver_passes(GetParam())
        .add_gloss(test::device().queue, {6, stride, 8.0f, 0}, scene, seen.buffer(),
                   test::upload(light), values, bad);
    const auto found = test::download<float>(values, radiance.size());
    EXPECT_EQ(test::download<cl_uint>(bad, 1)[0], 5u);
    const float base[] = {0.2f, 0.5f, 0.8f};
    for (std::size_t pixel = 0; pixel < 6; ++pixel)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = c * stride + pixel;
            const bool none = pixel < 2 || (pixel == 3 && c == 0) || (pixel == 4 && c == 1) ||
                              (pixel == 5 && c == 0);
            const float gloss =
                none ? 0.0f
                     : 8.0f * (r.coat + r.lobe * base[c]) / test::lobe_mean(r.exponent) * light[at];
            EXPECT_NEAR(found[at], radiance[at] + gloss, 1e-5f * (1 + gloss)) << pixel << ", " << c;
        }
}

// 6 x 5 pixels, probes at (1, 1), (3, 1), (5, 1), (1, 3) and so on.
constexpr std::uint32_t compared_probes = 16, compared_pixels = 32;
const ProbeParams comparing{6, 5, compared_pixels, compared_probes, 2, 3, 2, 0.25f};

TEST_P(TransferReceivers, RefuseWhatDoesNotFit) {
    const DeviceScene scene = test::on_device(two_triangles());
    const ReceiverPasses& p = receiver_passes(GetParam());
    const cl::CommandQueue& queue = test::device().queue;
    const Pixels pixels;
    const GBuffer seen = pixels.buffer();
    GBuffer other = seen;
    other.stride = 32;
    const cl::Buffer some = test::upload(std::vector<float>(GBUFFER_PLANES * 32, 0.0f));
    const cl::Buffer one = test::empty<float>(1);
    const PixelList list{some, some}, short_list{one, some};
    const ReceiverBuffers out = receivers(std::vector<float>(RECEIVER_PLANES * stride));
    const PixelParams run{0, 7, stride, stride, 0, 0, 0, 0};
    EXPECT_NO_THROW(p.place(queue, run, list, some, some).wait());
    EXPECT_THROW(p.place(queue, run, short_list, some, some), Error);
    EXPECT_THROW(p.place(queue, run, list, one, some), Error);
    EXPECT_THROW(p.place(queue, run, list, some, one), Error);
    EXPECT_THROW(p.pixels(queue, run, list, scene, other, out, some), Error);
    EXPECT_THROW(p.pixels(queue, run, list, scene, seen, out, one), Error);
    EXPECT_THROW(p.other_sides(queue, {10, 7, stride, 0}, some, out), Error);
    EXPECT_THROW(p.other_sides(queue, {10, 6, stride, 0}, one, out), Error);
    const ShowVerticesParams shows{glm::vec4(0), 12, stride, 2, stride};
    EXPECT_THROW(p.show(queue, shows, scene, some, other, some, some), Error);
    EXPECT_THROW(p.show(queue, shows, scene, one, seen, some, some), Error);
    ShowVerticesParams many = shows;
    many.triangle_count = 3;
    EXPECT_THROW(p.show(queue, many, scene, some, seen, some, some), Error);
    GBuffer wide = other;
    wide.planes = wide.ids = some;
    ProbeParams wrong = comparing;
    EXPECT_NO_THROW(p.compare_probes(queue, wrong, wide, some, some, some).wait());
    wrong.columns = 4;
    EXPECT_THROW(p.compare_probes(queue, wrong, wide, some, some, some), Error);
    wrong = comparing;
    wrong.step = 1;
    EXPECT_THROW(p.undersampled(queue, wrong, wide, some, some, some, some), Error);
    EXPECT_THROW(p.undersampled(queue, comparing, wide, some, some, some, one), Error);
    EXPECT_THROW(p.compare_gloss(queue, comparing, scene, wide, some, one, some, some), Error);
    EXPECT_THROW(p.compare_gloss(queue, comparing, scene, wide, some, some, one, some), Error);
    const cl::Buffer three = test::empty<float>(3 * compared_probes);
    EXPECT_THROW(p.compare_probes(queue, comparing, wide, some, three, some), Error);
    EXPECT_THROW(p.add_gloss(queue, {6, stride, 1, 0}, scene, seen, one, some, some), Error);
    EXPECT_THROW(p.add_gloss(queue, {6, stride, 1, 0}, scene, other, some, some, some), Error);
}

}  // namespace
}  // namespace clgi
