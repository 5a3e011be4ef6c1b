// Environments in spherical harmonics, against closed forms and sums in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/io/image.hpp>
#include <cstring>
#include <fstream>
#include <numbers>

#include "math_modes.hpp"
#include "refusals.hpp"
#include "scenes.hpp"
#include "skies.hpp"
#include "sky_projection.hpp"

namespace clgi {
namespace {

using test::ProjectedSky;
using test::relative_difference;
using test::SkyProjector;

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(ShEnvironment);

// Every texel and channel has a value of its own; those of red lie between 0.01 and 10.
Environment random_sky(int width, int height, std::uint64_t seed) {
    test::Random random(seed);
    Environment sky;
    sky.width = width;
    sky.height = height;
    for (int i = 0; i < width * height; ++i) {
        const double r = std::pow(10.0, random(-2, 1)), g = random(0, 2), b = random(0, 0.1);
        sky.texels.emplace_back(r, g, b);
    }
    sky.factor = {1.0f, 0.25f, 3.0f};
    return sky;
}

TEST_P(ShEnvironment, OfOneColourIsItsMean) {
    for (const auto& [width, height] :
         {std::pair(0, 0), {1, 1}, {2, 1}, {1, 7}, {37, 19}, {128, 64}, {16, 300}}) {
        Environment sky = test::even_sky({1, 2, 0.5});
        sky.width = width;
        sky.height = height;
        sky.texels.assign(static_cast<std::size_t>(width * height), glm::vec3(0.5f));
        sky.rotation = 1.0f;
        const double texel = width > 0 ? 0.5 : 1.0;
        std::vector<glm::dvec3> wanted(25, glm::dvec3(0.0));
        wanted[0] = texel * std::sqrt(4 * pi) * glm::dvec3(1, 2, 0.5);
        const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
        EXPECT_LT(relative_difference(found.light, wanted), 4e-7) << width << " x " << height;
        EXPECT_EQ(found.non_finite, 0u);
    }
}

// One texel, few large ones, sizes that fill neither packet nor leaf nor block, several of each.
TEST_P(ShEnvironment, IsTheSumOverTexels) {
    for (const auto& [width, height] :
         {std::pair(1, 1), {2, 1}, {3, 2}, {1, 9}, {5, 4}, {43, 17}, {130, 257}, {300, 129}}) {
        Environment sky = random_sky(width, height, static_cast<std::uint64_t>(width));
        sky.rotation = 0.3f * static_cast<float>(height % 7);
        const int nodes = std::min(width, height) < 8 ? 30 : height < 40 ? 12 : 4;
        const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
        EXPECT_LT(relative_difference(found.light, test::projected_on_host(sky, 5, nodes)), 4e-7)
            << width << " x " << height;
    }
}

TEST_P(ShEnvironment, HasAnyNumberOfBands) {
    Environment sky = random_sky(9, 6, 1);
    sky.rotation = -2.0f;
    for (const int bands : {1, 2, 4, 8, 9}) {
        const ProjectedSky found = SkyProjector{.math = GetParam(), .bands = bands}(sky);
        EXPECT_LT(relative_difference(found.light, test::projected_on_host(sky, bands, 24)), 1e-6)
            << bands;
    }
    EXPECT_THROW(SkyProjector{.bands = 10}.passes(), Error);
    EXPECT_THROW(EnvironmentProjection(4, 2, 0), Error);
    EXPECT_THROW(EnvironmentProjection(0, 2, 5), Error);
}

// A bright texel at the pole, at either side of the seam and elsewhere.
TEST_P(ShEnvironment, OfOneTexelIsWhereTheTexelIs) {
    const std::pair<int, int> places[] = {{0, 0}, {0, 40}, {31, 5}, {31, 63}, {13, 0}, {20, 31}};
    for (const auto& [bright_row, bright_column] : places) {
        const Environment sky =
            test::picture_sky(64, 32, [&, r = bright_row, k = bright_column](int row, int column) {
                return row == r && column == k ? 1000.0f : 0.0f;
            });
        const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
        EXPECT_LT(relative_difference(found.light, test::projected_on_host(sky, 5, 10)), 4e-7);
        // Its light by closed form, and the direction of the light of degree 1: y, z, x.
        const test::SkyBlock block = test::block_of(sky, bright_row, 1, bright_column, 1);
        EXPECT_NEAR(found.light[0].x / (1000 * test::solid_angle(block) * 0.2820947918), 1.0, 1e-6);
        const glm::dvec3 vector = 1000.0 * test::vector_of(block);
        const glm::dvec3 first = glm::dvec3(found.light[3].x, found.light[1].x, found.light[2].x);
        EXPECT_LT(glm::length(first / 0.4886025119 - vector), 1e-6 * glm::length(vector));
    }
}

// Texels have the mean of 1 + z over themselves, not the function: 2e-5 of it at this size.
TEST_P(ShEnvironment, OfASlopeHasTheIrradianceOfTheSlope) {
    Environment sky = test::picture_sky(256, 128, [](int, int) { return 0.0f; });
    for (int row = 0; row < sky.height; ++row)
        for (int column = 0; column < sky.width; ++column) {
            const test::SkyBlock block = test::block_of(sky, row, 1, column, 1);
            sky.texels[static_cast<std::size_t>(row * sky.width + column)] =
                glm::vec3(1.0 + test::vector_of(block).z / test::solid_angle(block));
        }
    const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
    EXPECT_NEAR(found.light[0].x, 3.54490770, 4e-6);
    EXPECT_NEAR(found.light[2].y, 2.04665342, 4e-4);
    const std::vector<glm::dvec3> light(found.light.begin(), found.light.end());
    EXPECT_NEAR(sh::irradiance(light, {0, 0, 1}).z, 5.23598776, 4e-4);
    EXPECT_NEAR(sh::irradiance(light, {0, 0, -1}).z, 1.04719755, 4e-4);
    EXPECT_NEAR(sh::irradiance(light, {0, 1, 0}).z, pi, 1e-5);
}

// max(0, s.a) around a slanted axis: irradiance of STABILITY's closed form, cut at 25 terms.
TEST_P(ShEnvironment, OfHalfASkyHasItsIrradiance) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.4, 0.7, -0.6));
    const int width = 512, height = 256;
    Environment sky = test::picture_sky(width, height, [&](int row, int column) {
        const double down = pi * (row + 0.5) / height,
                     across = 2 * pi * (column + 0.5) / width - pi;
        const glm::dvec3 s(std::sin(down) * std::sin(across), std::cos(down),
                           -std::sin(down) * std::cos(across));
        return static_cast<float>(std::max(0.0, glm::dot(s, axis)));
    });
    const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
    const std::vector<glm::dvec3> light(found.light.begin(), found.light.end());
    const glm::dvec3 aside = glm::normalize(glm::cross(axis, glm::dvec3(0, 1, 0)));
    const std::pair<double, double> rows[] = {
        {0, 2.09030449}, {45, 1.58225245}, {90, .66728164}, {135, .10129147}, {180, -.00409062}};
    for (const auto& [degrees, wanted] : rows) {
        const double angle = degrees * pi / 180;
        const glm::dvec3 n = std::cos(angle) * axis + std::sin(angle) * aside;
        EXPECT_NEAR(sh::irradiance(light, n).x, wanted, 1e-4) << degrees;
    }
}

TEST_P(ShEnvironment, TurnsWithTheEnvironment) {
    Environment sky = random_sky(24, 12, 3);
    Environment shifted = sky;  // by six columns to the left, which is a quarter turn
    for (int i = 0; i < 24 * 12; ++i) {
        const int row = i / 24, column = i % 24;
        shifted.texels[static_cast<std::size_t>(24 * row + (column + 18) % 24)] =
            sky.texels[static_cast<std::size_t>(i)];
    }
    sky.rotation = static_cast<float>(0.5 * pi);
    const SkyProjector project{.math = GetParam()};
    const auto wanted = project(shifted).light;
    EXPECT_LT(relative_difference(project(sky).light, {wanted.begin(), wanted.end()}), 1e-6);
}

// The measured skies of the examples: five orders of magnitude in one picture.
TEST_P(ShEnvironment, OfMeasuredSkiesIsTheirSum) {
    for (const char* name :
         {"dikhololo_night_1k.hdr", "empty_warehouse_01_1k.hdr", "venice_sunset_1k.hdr"}) {
        const std::string path = std::string(CLGI_SCENES_DIR) + "/hdr/" + name;
        if (!std::ifstream(path)) GTEST_SKIP() << "no " << path;
        const io::Image image = io::load_image(path);
        Environment sky;
        sky.width = image.width;
        sky.height = image.height;
        for (std::size_t i = 0; i < image.find("R")->values.size(); ++i)
            sky.texels.emplace_back(image.find("R")->values[i], image.find("G")->values[i],
                                    image.find("B")->values[i]);
        sky.rotation = 0.8f;
        const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
        EXPECT_LT(relative_difference(found.light, test::projected_on_host(sky, 5, 2)), 1e-6)
            << name;
    }
}

// Long rows and long columns, one value and random ones: sums are trees.
TEST_P(ShEnvironment, KeepsItsPrecisionInLargePictures) {
    for (const auto& [width, height] : {std::pair(8192, 24), {24, 4096}}) {
        for (const bool constant : {true, false}) {
            Environment sky = random_sky(width, height, 5);
            if (constant) sky.texels.assign(sky.texels.size(), {0.1f, 0.7f, 1.3f});
            const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
            EXPECT_LT(relative_difference(found.light, test::projected_on_host(sky, 5, 4)), 1e-6)
                << width << " x " << height;
        }
    }
}

// Directional lights of a scene with its environment, exposed; other lights are not in it.
TEST_P(ShEnvironment, TakesInDirectionalLights) {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
    scene.environment = random_sky(7, 5, 8);
    scene.environment->rotation = 1.5f;
    Light sun = test::directional_light({0.3, -1.0, 0.2});
    sun.intensity = {5000.0f, 300.0f, 20.0f};
    Light moon = test::directional_light({-1.0, -0.1, -0.4});
    moon.intensity = {0.0f, 100.0f, 1.0f};
    Light lamp;
    lamp.position = {0, 1, 0};
    scene.lights = {sun, lamp, moon};
    const DeviceScene placed = test::on_device(scene);
    const double exposure = placed.frame().exposure;
    EXPECT_NE(exposure, 1.0);

    SkyProjector project{.math = GetParam()};
    project.lights = directional_lights(placed);
    ASSERT_EQ(project.lights.size(), 2u);
    const Environment& sky = *placed.environment();
    const ProjectedSky found = project(sky.width, sky.height, placed.environment_texels(),
                                       sky.factor / static_cast<float>(exposure), sky.rotation);
    std::vector<glm::dvec3> wanted = test::projected_on_host(sky, 5, 24);
    for (const Light& light : {sun, moon}) {
        const auto y = sh::evaluate(-glm::normalize(glm::dvec3(light.direction)), 5);
        for (std::size_t i = 0; i < 25; ++i) wanted[i] += y[i] * glm::dvec3(light.intensity);
    }
    for (glm::dvec3& c : wanted) c /= exposure;
    EXPECT_LT(relative_difference(found.light, wanted), 1e-6);
}

TEST_P(ShEnvironment, CountsWhatIsNotFinite) {
    for (const auto& [width, height] : {std::pair(5, 3), {64, 130}}) {
        Environment sky = random_sky(width, height, 2), clean = sky;
        const auto spoil = [&](std::size_t at, int c, float value) {
            sky.texels[at][c] = value;
            clean.texels[at][c] = 0.0f;
        };
        spoil(0, 0, NAN);
        spoil(0, 2, INFINITY);
        spoil(4, 1, -INFINITY);
        spoil(sky.texels.size() - 1, 2, NAN);
        spoil(sky.texels.size() - 1, 1, -NAN);
        const SkyProjector project{.math = GetParam()};
        const ProjectedSky found = project(sky), wanted = project(clean);
        EXPECT_EQ(found.non_finite, 5u);
        EXPECT_EQ(wanted.non_finite, 0u);
        EXPECT_EQ(found.light, wanted.light);
    }
}

// Too bright for a float: the sum is no number and stays none.
TEST_P(ShEnvironment, DoesNotHideAnOverflow) {
    const Environment sky = test::picture_sky(8, 4, [](int, int) { return 3e38f; });
    const ProjectedSky found = SkyProjector{.math = GetParam()}(sky);
    std::uint32_t bits;
    std::memcpy(&bits, &found.light[0].x, 4);
    EXPECT_EQ(bits & 0x7f800000u, 0x7f800000u);
}

TEST(ShEnvironments, AreTheSameForEveryPacketAndGroup) {
    const Environment sky = random_sky(133, 140, 4);
    std::vector<glm::vec3> first;
    for (const auto& [width, group] :
         {std::pair(1, 64u), {1, 3u}, {4, 1u}, {8, 3u}, {8, 64u}, {16, 16u}}) {
        const auto found = SkyProjector{.packet_width = width, .local_size = group}(sky);
        if (first.empty()) first = found.light;
        EXPECT_EQ(found.light, first) << width << ", " << group;
    }
    for (const int bands : {1, 4, int{SH_DEFAULT_BANDS}}) {
        const auto of = [&](Form form) {
            return SkyProjector{.bands = bands, .form = form}(sky).light;
        };
        EXPECT_EQ(of(Form::groups), of(Form::packets)) << bands;
    }
}

TEST(ShEnvironments, RefuseBuffersThatAreTooSmall) {
    const SkyProjector project{.lights = std::vector<DirectionalLight>(2)};
    EnvironmentProjection projection(150, 130, 5);
    projection.params.light_count = 2;
    const ProjectParams& params = projection.params;
    EXPECT_EQ(params.stride, 768u);
    const cl::Buffer texels = test::empty<float>(3 * 150 * 130);
    const TransferPasses passes = project.passes();
    const auto call =
        [&](cl::Event (TransferPasses::*pass)(const cl::CommandQueue&, const ProjectParams&,
                                              const ProjectionBuffers&, const WaitList&) const,
            cl::Buffer ProjectionBuffers::*member) {
            return [&, pass, member](const cl::Buffer& given) {
                ProjectionBuffers buffers = project.buffers(projection, texels, 0.0);
                buffers.*member = given;
                (passes.*pass)(test::device().queue, params, buffers, {});
                test::device().queue.finish();
            };
        };
    using B = ProjectionBuffers;
    const auto rows = &TransferPasses::project_rows;
    const auto columns = &TransferPasses::project_columns;
    const auto last = &TransferPasses::project_environment;
    test::expect_refusals({
        {"transfer.project_rows", "texels", 4 * 3 * 150 * 130, call(rows, &B::texels)},
        {"transfer.project_rows", "row_weights", 4 * 9 * 130, call(rows, &B::row_weights)},
        {"transfer.project_rows", "sums", 4 * 2 * 9 * 768, call(rows, &B::sums)},
        {"transfer.project_rows", "non_finite", 4, call(rows, &B::non_finite)},
        {"transfer.project_columns", "sums", 4 * 2 * 9 * 768, call(columns, &B::sums)},
        {"transfer.project_columns", "column_weights", 4 * 9 * 768,
         call(columns, &B::column_weights)},
        {"transfer.project_columns", "leaves", 2 * 45 * 16, call(columns, &B::leaves)},
        {"transfer.project_environment", "leaves", 2 * 45 * 16, call(last, &B::leaves)},
        {"transfer.project_environment", "waves", 4 * 15 * 5, call(last, &B::waves)},
        {"transfer.project_environment", "rotation", 4 * 165, call(last, &B::rotation)},
        {"transfer.project_environment", "lights", 2 * 32, call(last, &B::lights)},
        {"transfer.project_environment", "light", 25 * 16, call(last, &B::light)},
    });
    EXPECT_EQ(projection.sums_bytes(), 4u * 2 * 9 * 768);
    EXPECT_EQ(projection.leaves_bytes(), 2u * 45 * 16);

    const ProjectionBuffers buffers = project.buffers(projection, texels, 0.0);
    for (const auto& wrong : {ProjectParams{{}, 0, 130, 768, 0},
                              {{}, 150, 0, 768, 0},
                              {{}, 150, 130, 384, 0},
                              {{}, 150, 130, 480, 0}})
        EXPECT_THROW(passes.project(test::device().queue, wrong, buffers), Error);
}

// Only the last step runs again when the environment turns.
TEST(ShEnvironments, TurnWithoutReadingThePicture) {
    Environment sky = random_sky(20, 10, 6);
    const SkyProjector project;
    EnvironmentProjection projection(20, 10, 5);
    projection.params.factor = glm::vec4(sky.factor, 0.0f);
    ProjectionBuffers on = project.buffers(projection, test::upload(sky.texels), 0.0);
    const TransferPasses passes = project.passes();
    const cl::CommandQueue& queue = test::device().queue;
    passes.project(queue, projection.params, on);
    sky.rotation = 2.5f;
    on.rotation = test::upload(environment_rotation(sky.rotation, 5));
    passes.project_environment(queue, projection.params, on);
    std::vector<glm::vec3> found;
    for (const glm::vec4& c : test::download<glm::vec4>(on.light, 25)) found.emplace_back(c);
    EXPECT_EQ(found, project(sky).light);
}

}  // namespace
}  // namespace clgi
