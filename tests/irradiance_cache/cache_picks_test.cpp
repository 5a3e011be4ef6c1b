// What hemicubes see by directions of a cosine lobe, against rays in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "device.hpp"
#include "record_cubes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// In a box whose walls differ: each pick lies where its ray of a cosine lobe meets them, as nearly
// as pixels tell; a wall that turns its back sends nothing.
TEST(CachePasses, PickWhereRaysMeetWalls) {
    const glm::dvec3 low(-1.0, -0.6, -0.8), high(0.9, 1.1, 1.3), eye(0.2, 0.1, -0.1);
    Scene box = test::plain_scene();
    test::add_box(box, low, high, -1);
    const auto colour = [](std::size_t wall) {
        const auto k = static_cast<float>(wall);
        return glm::vec3(0.1f + 0.1f * k, 0.9f - 0.1f * k, 0.15f * k + 0.05f);
    };
    box.materials[0].base_color = glm::vec4(colour(0), 1.0f);
    for (std::size_t wall = 1; wall < 6; ++wall) {
        Material material;
        material.base_color = glm::vec4(colour(wall), 1.0f);
        const std::uint32_t added = test::add_material(box, material);
        for (const std::size_t half : {0, 1}) box.triangles[2 * wall + half].material = added;
    }
    for (const std::size_t half : {0, 1})
        std::swap(box.triangles[half].vertex[1],
                  box.triangles[half].vertex[2]);  // -x
    const DeviceScene scene = test::on_device(box);
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    constexpr std::uint32_t size = 64, picks = 2000, stride = 2000;
    const double scale = scene.frame().scale;
    int backs = 0, walls[6] = {};
    for (const glm::dvec3& up : {glm::dvec3(0.5, 0.8, -0.7), glm::dvec3(-0.6, -0.7, 0.9)}) {
        const glm::dvec3 normal = glm::normalize(up);
        const CacheBuffers b = test::record_cubes(scene, {{eye, normal}}, size);
        CacheParams params{};
        params.count = 1;
        params.stride = test::record_stride;
        params.size = size;
        params.picks = picks;
        params.pick_stride = stride;
        params.first_sample = 7;
        const cl::Buffer places = test::empty<float>(PICK_PLANES * stride);
        passes.pick(queue, params, scene, b, places);
        std::vector<float> found(PICK_PLANES * stride);
        queue.enqueueReadBuffer(places, CL_TRUE, 0, found.size() * sizeof(float), found.data());
        View front;
        queue.enqueueReadBuffer(b.views, CL_TRUE, 0, sizeof front, &front);
        const auto inverse = [](std::uint32_t index, std::uint32_t base) {
            double out = 0.0, place = 1.0;
            for (; index > 0; index /= base) out += (place /= base) * (index % base);
            return out;
        };
        for (std::uint32_t i = 0; i < picks; ++i) {
            const double radius = std::sqrt(inverse(i + 8, 2)),
                         angle = 2.0 * glm::pi<double>() * inverse(i + 8, 3);
            const glm::dvec3 way = radius * std::cos(angle) * glm::dvec3(front.right) +
                                   radius * std::sin(angle) * glm::dvec3(front.up) +
                                   std::sqrt(1.0 - radius * radius) * glm::dvec3(front.forward);
            int wall = 0;
            double reach = 1e9, second = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                const double to = ((way[axis] > 0 ? high : low)[axis] - eye[axis]) / way[axis];
                if (to < reach) {
                    second = reach;
                    reach = to;
                    wall = 2 * axis + (way[axis] > 0 ? 1 : 0);
                } else {
                    second = std::min(second, to);
                }
            }
            if (second < 1.15 * reach) continue;  // near an edge a pixel may show either wall
            const auto plane_of = [&](std::uint32_t p) { return double{found[p * stride + i]}; };
            const glm::dvec3 facing(plane_of(RECORD_NORMAL), plane_of(RECORD_NORMAL + 1),
                                    plane_of(RECORD_NORMAL + 2));
            if (wall == 0) {
                ++backs;
                EXPECT_EQ(facing, glm::dvec3(0.0));
                for (std::uint32_t p = 0; p < PICK_PLANES; ++p) EXPECT_EQ(plane_of(p), 0.0) << p;
                continue;
            }
            ++walls[wall];
            glm::dvec3 inward(0.0);
            inward[wall / 2] = wall % 2 == 0 ? 1.0 : -1.0;
            EXPECT_LT(glm::length(facing - inward), 1e-5);
            const glm::dvec3 place =
                glm::dvec3(plane_of(0), plane_of(1), plane_of(2)) / scale + scene.frame().origin;
            EXPECT_NEAR(place[wall / 2], (wall % 2 == 0 ? low : high)[wall / 2], 1e-5);
            EXPECT_LT(glm::length(glm::cross(glm::normalize(place - eye), way)), 1.5 / size) << i;
            for (std::uint32_t c = 0; c < 3; ++c)
                EXPECT_NEAR(plane_of(PICK_ALBEDO + c),
                            colour(static_cast<std::size_t>(wall))[static_cast<int>(c)], 1e-5);
        }
    }
    EXPECT_GT(backs, 5);
    for (int wall = 1; wall < 6; ++wall) EXPECT_GT(walls[wall], 4) << wall;
}

// Where textures are fine beside pixels, picks of several records, which share packets, have the
// base colour that `resolve` finds in the same pixel.
TEST(CachePasses, PickColoursOfPixels) {
    Scene box = test::plain_scene();
    test::add_box(box, {-1.0, -0.6, -0.8}, {0.9, 1.1, 1.3}, -1);
    box.materials[0].specular = 0.0f;
    box.materials[0].base_color = glm::vec4(0.9f, 0.8f, 0.7f, 1.0f);
    Texture noise;
    noise.width = noise.height = 256;
    test::Random random(3);
    for (int k = 0; k < 4 * 256 * 256; ++k)
        noise.rgba.push_back(k % 4 == 3 ? 255 : static_cast<std::uint8_t>(random.integer(0, 255)));
    box.textures.push_back(noise);
    box.materials[0].base_texture.texture = 0;
    for (const glm::dvec3& at : box.positions)
        box.uvs.emplace_back(0.4 * at.x + 0.13 * at.y, 0.5 * at.z - 0.21 * at.y, 0.0, 0.0);
    const DeviceScene scene = test::on_device(box);
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t size = 8, picks = 7, records = 3, stride = 32;
    const CacheBuffers b =
        test::record_cubes(scene,
                           {{{0.2, 0.1, -0.1}, glm::normalize(glm::dvec3(0.5, 0.8, -0.7))},
                            {{-0.7, 0.5, 0.6}, glm::normalize(glm::dvec3(1.0, -0.3, 0.2))},
                            {{0.4, -0.3, 0.9}, glm::normalize(glm::dvec3(-0.2, 0.1, -1.0))}},
                           size);
    const auto views = test::download<View>(b.views, 5 * records);
    const GBufferPasses gbuffer(test::programs(), {});
    std::vector<std::vector<float>> faces;
    for (const View& view : views) {
        const std::uint32_t pixels = size * size;
        const cl::Buffer planes = test::empty<float>(GBUFFER_PLANES * pixels),
                         ids = test::empty<cl_int>(GBUFFER_ID_PLANES * pixels);
        gbuffer.resolve(queue, view, scene, {pixels, RESOLVE_ALL, 0, 0}, b.visibility, planes, ids);
        faces.push_back(test::download<float>(planes, GBUFFER_PLANES * pixels));
    }
    CacheParams params{};
    params.count = records;
    params.stride = test::record_stride;
    params.size = size;
    params.picks = picks;
    params.pick_stride = stride;
    const cl::Buffer places = test::empty<float>(PICK_PLANES * stride);
    const CachePasses passes(test::programs(), test::usual_build());
    passes.pick(queue, params, scene, b, places);
    const auto found = test::download<float>(places, PICK_PLANES * stride);
    int sides = 0;
    for (std::uint32_t i = 0; i < picks * records; ++i) {
        double nearest = 1e9;
        glm::vec3 base(0.0f);
        std::uint32_t face = 0;
        for (std::uint32_t f = 5 * (i / picks); f < 5 * (i / picks) + 5; ++f)
            for (std::uint32_t p = 0; p < views[f].width * views[f].height; ++p) {
                const auto at = [&](std::uint32_t plane) { return faces[f][plane * 64 + p]; };
                const double away = std::hypot(at(0) - found[i], at(1) - found[stride + i],
                                               at(2) - found[2 * stride + i]);
                if (away >= nearest) continue;
                nearest = away;
                face = f % 5;
                base = {at(GBUFFER_BASE), at(GBUFFER_BASE + 1), at(GBUFFER_BASE + 2)};
            }
        EXPECT_LT(nearest, 1e-5) << i;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[(PICK_ALBEDO + c) * stride + i], base[c], 1e-4f) << i << ", " << face;
        sides += face > 0;
    }
    EXPECT_GT(sides, 5);
}

}  // namespace
}  // namespace clgi
