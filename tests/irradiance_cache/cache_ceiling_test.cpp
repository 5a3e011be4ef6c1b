// Which records stand in for what a hemicube sees, pixel by pixel, in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "glossy_records.hpp"
#include "math_modes.hpp"
#include "shares_by_hand.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(CacheCeiling);

constexpr std::uint32_t ceiling_face = 32;

// A record below a tilted ceiling, and four records on that, which face some other ways.
struct Ceiling {
    Ceiling() {
        scene.materials[0].base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
        const glm::dvec3 x = glm::normalize(glm::cross(normal, glm::dvec3(0.1, 0.2, 1.0))),
                         y = glm::cross(normal, x);
        test::add_quad(scene, {middle - 6.0 * x - 6.0 * y, middle + 6.0 * x - 6.0 * y,
                               middle + 6.0 * x + 6.0 * y, middle - 6.0 * x + 6.0 * y});
        places.push_back({{0.3, 0.0, -0.2}, glm::normalize(glm::dvec3(0.1, 1.0, 0.2))});
        const glm::dvec2 at[] = {{-0.9, -0.4}, {0.8, -0.6}, {0.5, 1.1}, {-0.3, 0.4}};
        for (const glm::dvec2& there : at)
            places.push_back({middle + there.x * x + there.y * y,
                              glm::normalize(normal + 0.3 * there.x * there.y * x)});
    }

    const glm::dvec3 middle{0.0, 1.5, 0.0}, normal = glm::normalize(glm::dvec3(0.2, -1.0, 0.1));
    Scene scene = test::plain_scene();
    std::vector<test::RecordPlace> places;
};

// What pixels see of the ceiling, by the rays through their middles: form factors, and the shares
// of the records.
struct Pixel {
    double factor = 0.0;
    std::vector<double> share;  // none where nothing is seen
};

std::vector<Pixel> pixels_of(const Ceiling& ceiling, const DeviceScene& scene,
                             const CacheBuffers& b) {
    const auto local = [&](const glm::dvec3& at) {
        return scene.frame().scale * (at - scene.frame().origin);
    };
    std::vector<glm::dvec3> places, normals;
    for (std::size_t r = 1; r < ceiling.places.size(); ++r) {
        places.push_back(local(ceiling.places[r].eye));
        normals.push_back(ceiling.places[r].normal);
    }
    const auto views = test::download<View>(b.views, 5);
    const auto words = test::download<std::uint64_t>(b.visibility, 3 * ceiling_face * ceiling_face);
    std::vector<Pixel> out;
    for (int face = 0; face < 5; ++face) {
        const View& view = views[static_cast<std::size_t>(face)];
        for (std::uint32_t row = 0; row < view.height; ++row)
            for (std::uint32_t column = 0; column < view.width; ++column) {
                const double x = double{view.window.x} +
                                 ((column + 0.5) / view.width * 2.0 - 1.0) * double{view.right.w},
                             y = double{view.window.y} +
                                 (1.0 - (row + 0.5) / view.height * 2.0) * double{view.up.w};
                const double square = 1.0 + x * x + y * y, side = 2.0 / ceiling_face;
                Pixel pixel;
                pixel.factor =
                    (face == 0 ? 1.0 : y) * side * side / (glm::pi<double>() * square * square);
                const std::uint64_t word = words[view.first_pixel + row * view.width + column];
                if (word != ~std::uint64_t{0}) {
                    const glm::dvec3 d = glm::dvec3(view.forward) + x * glm::dvec3(view.right) +
                                         y * glm::dvec3(view.up),
                                     eye(view.eye);
                    const double far = glm::dot(ceiling.normal, local(ceiling.middle) - eye) /
                                       glm::dot(ceiling.normal, d);
                    pixel.share = shares_by_hand(places, normals, eye + far * d, ceiling.normal);
                }
                out.push_back(pixel);
            }
    }
    return out;
}

// Rows of link, and around's radiance in each pixel, whose packets see different places.
TEST_P(CacheCeiling, IsThatOfItsRecordsInEachPixel) {
    const Ceiling ceiling;
    const DeviceScene scene = test::on_device(ceiling.scene);
    CacheBuffers b = test::record_cubes(scene, ceiling.places, ceiling_face);
    CacheTree tree = one_leaf(5, test::record_stride);
    tree.centre.w = 1e3f;
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    for (std::uint32_t way = 0; way < CACHE_WAYS; ++way)
        for (std::uint32_t r = 1; r < 5; ++r) lists[way * CACHE_LISTED + r - 1] = r;
    std::vector<float> light(3 * test::record_stride, 0.0f);
    test::Random random(5);
    for (float& value : light) value = static_cast<float>(random(0.5, 4.0));
    b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
    b.lists = test::upload(lists);
    b.light = test::upload(light);
    b.sky = test::empty<float>(4);
    b.rows = test::empty<float>(3 * test::record_stride);
    for (cl::Buffer* of : {&b.base, &b.bright, &b.reflected})
        *of = test::empty<float>(3 * test::record_stride);
    CacheParams params{};
    params.count = 1;
    params.stride = params.row_stride = test::record_stride;
    params.size = ceiling_face;
    params.emitter_step = params.thin = params.every = 1;
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    passes.link(queue, params, tree, scene, no_emitters(), b);
    const CacheAround of{1, 0, 1, ceiling_face};
    const cl::Buffer around = test::empty<std::uint64_t>(around_bytes(of) / sizeof(std::uint64_t));
    passes.around(queue, params, of, tree, scene, no_emitters(), b, around).wait();
    const auto rows = test::download<float>(b.rows, 3 * test::record_stride);
    const auto words = test::download<std::uint64_t>(around, 3 * ceiling_face * ceiling_face);

    const std::vector<Pixel> pixels = pixels_of(ceiling, scene, b);
    ASSERT_EQ(pixels.size(), words.size());
    const double albedo[] = {0.2, 0.5, 0.7};
    double all = 0.0, of_record[4] = {};
    std::size_t seen = 0;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
        all += pixels[p].factor;
        const glm::dvec3 found = unpacked(words[p]);
        if (pixels[p].share.empty()) {
            EXPECT_EQ(found, glm::dvec3(0.0));
            continue;
        }
        ++seen;
        for (std::size_t r = 0; r < 4; ++r) of_record[r] += pixels[p].factor * pixels[p].share[r];
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = 0.0;
            for (std::size_t r = 0; r < 4; ++r)
                sum += pixels[p].share[r] * double{light[c * test::record_stride + r + 1]};
            const double wanted = albedo[c] / glm::pi<double>() * sum;
            EXPECT_NEAR(found[static_cast<int>(c)], wanted, 1e-3 * wanted) << p << " " << c;
        }
    }
    EXPECT_GT(seen, 1500u);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t r = 0; r < 4; ++r) {
            const double wanted = albedo[c] * of_record[r] / all;
            EXPECT_GT(wanted, 0.01);
            EXPECT_NEAR(rows[c * test::record_stride + r + 1], wanted, 1e-3 * wanted)
                << c << " " << r;
        }
}

}  // namespace
}  // namespace clgi
