// Edges of pictures of several samples, against the exact area of what pixels show.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <cmath>

#include "coverage.hpp"
#include "device.hpp"
#include "scene/luminance.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// A glowing polygon whose edges run aslant of the pixels.
struct Edges {
    static constexpr int width = 43, height = 29;  // no multiples of a packet's
    static RendererOptions options() {
        RendererOptions out;
        out.method = Method::direct;
        out.picture.width = width;
        out.picture.height = height;
        out.picture.build = test::usual_build();
        return out;
    }

    std::vector<glm::vec3> read() const {
        const auto planes = renderer.read_radiance();
        std::vector<glm::vec3> out;
        for (std::size_t i = 0; i < planes[0].size(); ++i)
            out.emplace_back(planes[0][i], planes[1][i], planes[2][i]);
        return out;
    }

    const std::vector<glm::dvec2> polygon{{5.3, 4.1}, {37.7, 7.9}, {33.2, 24.6}, {11.9, 21.3}};
    const Scene scene = test::glowing_quad(polygon, {1.0f, 2.0f, 4.0f});
    const std::vector<double> exact = test::coverage(polygon, width, height);
    const Camera camera = test::pixel_camera(width, height);
    Renderer renderer{test::programs(), test::device().queue, scene, options()};
};

// Against the differences of the means themselves, for each number of samples: from those of the
// two last powers of two before it. Where the error is known it is the larger one, within a factor.
TEST(Samples, KnowHowFarTheyAre) {
    Edges edges;
    Renderer& renderer = edges.renderer;
    renderer.render(edges.camera);
    std::vector<std::vector<double>> means(1);  // luminance by the number of samples
    for (int samples = 1; samples <= 17; ++samples) {
        if (samples > 1) renderer.refine();
        double sum = 0.0, wrong = 0.0;
        std::vector<int> earlier;
        for (int power = 1; power < samples; power *= 2) earlier.push_back(power);
        if (earlier.size() > 2) earlier.erase(earlier.begin(), earlier.end() - 2);
        std::vector<double> apart(earlier.size());
        means.emplace_back();
        const std::vector<glm::vec3> found = edges.read();
        for (std::size_t i = 0; i < found.size(); ++i) {
            means.back().push_back(luminance(glm::dvec3(found[i])));
            sum += means.back()[i];
            wrong += std::pow(
                means.back()[i] - luminance(glm::dvec3(1.0, 2.0, 4.0)) * edges.exact[i], 2);
            for (std::size_t k = 0; k < earlier.size(); ++k)
                apart[k] += std::pow(means.back()[i] - means[earlier[k]][i], 2);
        }
        if (samples == 1) continue;
        const auto count = static_cast<double>(found.size());
        const double error = renderer.sampling_error();
        double square = 0.0;
        for (std::size_t k = 0; k < earlier.size(); ++k)
            square += apart[k] / (static_cast<double>(samples) / earlier[k] - 1.0) /
                      static_cast<double>(earlier.size());
        EXPECT_NEAR(error, std::sqrt(square / count) / (sum / count), 1e-5) << samples;
        EXPECT_GT(error, 0.8 * std::sqrt(wrong / count) / (sum / count)) << samples;
        EXPECT_LT(error, 4.0 * std::sqrt(wrong / count) / (sum / count)) << samples;
    }
}

// Edges against the exact area of what pixels show: the error falls faster than 1 / sqrt(N).
TEST(Samples, SmoothEdgesToTheirArea) {
    Edges edges;
    Renderer& renderer = edges.renderer;
    double first = 0.0;
    for (const int samples : {1, 4, 16, 64}) {
        if (samples == 1) renderer.render(edges.camera);
        while (renderer.samples() < static_cast<std::uint32_t>(samples)) renderer.refine();
        const std::vector<glm::vec3> found = edges.read();
        double squares = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double off =
                    found[i][c] / edges.scene.materials[0].emission[c] - edges.exact[i];
                squares += off * off / 3.0;
            }
        const double error = std::sqrt(squares);
        if (samples == 1)
            first = error;
        else
            EXPECT_LT(error, 1.1 * first / std::sqrt(samples)) << samples;
    }
    EXPECT_GT(first, 0.5);  // there are edges
    renderer.render(edges.camera);
    EXPECT_TRUE(std::isinf(renderer.sampling_error()));
}

// The edge of a shadow that a point light casts along the columns of its cube map lies where it
// should, as the mean of eight maps. In one map it lies anywhere within half a texel.
TEST(Samples, PlaceShadowsOfPointLights) {
    constexpr int width = 48, height = 32;
    constexpr double texel = 2.0 * 30.0 / 32.0;  // pixels, on the wall
    Scene wall = test::plain_scene(glm::vec3(0.8f));
    test::add_quad(wall, {{{0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0}}});
    wall.lights = {test::point_light({16, 16, 30}, 1e4f)};
    RendererOptions options = Edges::options();
    options.picture.width = width;
    options.picture.height = height;
    options.picture.emitters.face_size = 32;
    const auto drawn = [&](const Scene& scene, std::uint32_t samples) {
        options.samples = samples;
        Renderer renderer(test::programs(), test::device().queue, scene, options);
        renderer.render(test::pixel_camera(width, height));
        return renderer.read_radiance()[1];
    };
    const std::vector<float> open = drawn(wall, 128);
    Material black;
    black.base_color = {0.0f, 0.0f, 0.0f, 1.0f};
    double one = 0.0, many = 0.0;
    constexpr int places = 12;
    for (int k = 0; k < places; ++k) {
        const double past = 3.0 + 0.49 * k, edge = 16.0 + 3.0 * past;
        Scene scene = wall;
        const double x = 16.0 + past;  // the sheet's own edge, before the wall
        test::add_quad(scene, {{{-40, -40, 20}, {x, -40, 20}, {x, 80, 20}, {-40, 80, 20}}},
                       test::add_material(scene, black));
        const auto off = [&](std::uint32_t samples) {
            const std::vector<float> lit = drawn(scene, samples);
            double sum = 0.0;  // lit columns
            for (int row = 0; row < height; ++row)
                for (int column = static_cast<int>(x) + 2; column < width; ++column)
                    sum += double{lit[row * width + column]} / open[row * width + column] / height;
            return (width - sum - edge) / texel;
        };
        one += std::pow(off(1), 2) / places;
        many += std::pow(off(128), 2) / places;
    }
    EXPECT_GT(std::sqrt(one), 0.2);
    EXPECT_LT(std::sqrt(many), 0.08);
}

}  // namespace
}  // namespace clgi
