// Half storage: what is stored where, how far it is off, and that nothing large overflows in it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "frames.hpp"
#include "lighting.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr BuildOptions halves{.storage = Storage::half};

// Of rounding to 11 bits.
constexpr float half_error = 1.0f / 2048.0f;

SecondOrderOptions small_frame(const BuildOptions& build) {
    SecondOrderOptions options;
    options.width = 61;
    options.height = 43;
    options.emitters.vpls = 100;
    options.emitters.shadow_size = 128;
    options.emitters.face_size = 64;
    options.negative_vpls = 50;
    options.build = build;
    return options;
}

TEST(HalfStorage, HoldsTheSamePlanesRounded) {
    const Scene scene = cornell();
    const DeviceScene placed = test::on_device(scene);
    const View view = make_view(scene.cameras[0], placed.frame(), 61, 43);
    const test::Drawing full = test::draw(placed, view);

    const GBufferPasses passes(test::programs(), halves);
    const RasterBuffers buffers = test::raster_buffers(placed, full.pixels());
    const cl::Buffer planes =
        test::empty<std::uint16_t>(gbuffer_bytes(Storage::half, full.stride) / 2);
    const cl::Buffer ids = test::empty<cl_int>(GBUFFER_ID_PLANES * full.stride);
    test::draw_visibility(passes, placed, view, buffers);
    passes.resolve(test::device().queue, view, placed, {full.stride, RESOLVE_ALL, 0, 0},
                   buffers.pixels, planes, ids);
    const auto rows = test::download<std::uint16_t>(planes, GBUFFER_HALF_ROWS * full.stride);

    int shining = 0;
    for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
        for (std::size_t pixel = 0; pixel < full.pixels(); ++pixel) {
            const float value = full.planes[plane * full.stride + pixel];
            const std::uint16_t* row = rows.data() + HALF_ROW(plane) * full.stride;
            if (HALF_PLANE(plane)) {
                const float stored = glm::unpackHalf1x16(row[pixel]);
                ASSERT_NEAR(stored, value, half_error * std::abs(value) + 1e-7f) << plane;
                shining += plane == GBUFFER_EMISSION && stored > 0.0f;
            } else {
                ASSERT_EQ(std::memcmp(row + 2 * pixel, &value, sizeof value), 0) << plane;
            }
        }
    EXPECT_GT(shining, 0);
}

TEST(HalfStorage, TakesFewerBytesAndGivesNearlyTheSamePicture) {
    const Scene scene = cornell();
    const DeviceScene placed = test::on_device(scene);
    const auto frame = [&](const BuildOptions& build, std::size_t& bytes) {
        SecondOrderSolver solver(test::programs(), test::device().queue, placed,
                                 small_frame(build));
        bytes = solver.bytes();
        // Besides what is estimated, a few words.
        EXPECT_NEAR(
            static_cast<double>(bytes),
            static_cast<double>(estimate(test::device().device, placed, small_frame(build)).bytes),
            0.01 * static_cast<double>(bytes));
        solver.render(scene.cameras[0]).wait();
        return test::read_frame(test::device().queue, placed, solver);
    };
    std::size_t full_bytes = 0, half_bytes = 0;
    const test::Frame full = frame({}, full_bytes);
    const test::Frame half = frame(halves, half_bytes);
    EXPECT_LT(half_bytes, full_bytes);
    EXPECT_TRUE(test::same_bits(half.position, full.position));
    double square = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < full.pixels; ++i) {
        const glm::dvec3 apart = glm::dvec3(half.radiance[i]) - glm::dvec3(full.radiance[i]);
        square += glm::dot(apart, apart) / 3.0;
        mean += (full.radiance[i].x + full.radiance[i].y + full.radiance[i].z) / 3.0;
    }
    const double error = std::sqrt(square / full.pixels) / (mean / full.pixels);
    // Four factors of a pixel are rounded: two cosines, irradiance and albedo.
    EXPECT_LT(error, 4.0 * half_error);
    EXPECT_GT(error, 0.0);
    EXPECT_EQ(half.status.non_finite, 0u);
}

TEST(HalfStorage, IsTheSameForEveryWorkGroupAndPacket) {
    const Scene scene = cornell();
    const test::Frame usual = test::render(scene, scene.cameras[0], small_frame(halves));
    ASSERT_GT(usual.status.refined_pixels, 0u);
    for (BuildOptions build :
         {BuildOptions{.packet_width = 1, .local_size = 7}, {.packet_width = 4, .local_size = 1}}) {
        build.storage = Storage::half;
        const test::Frame frame = test::render(scene, scene.cameras[0], small_frame(build));
        EXPECT_TRUE(test::same_bits(frame.radiance, usual.radiance)) << build.packet_width;
        EXPECT_TRUE(test::same_bits(frame.irradiance, usual.irradiance)) << build.packet_width;
    }
}

// One light of the given flux right in front of a wall.
glm::vec3 lit_by(float flux, const ImagePasses& passes, Storage storage) {
    const std::uint32_t stride = 16;
    const std::vector<Vpl> lights{{{0, 0, 0.1f, 0}, {0, 0, -1, 0}, {flux, 1, -flux, 1}}};
    std::vector<std::uint16_t> rows(point_bytes(Storage::half, stride) / sizeof(std::uint16_t));
    const float position = 0.0f;
    std::memcpy(rows.data(), &position, sizeof position);
    rows[HALF_ROW(GBUFFER_NORMAL + 2) * stride] = glm::packHalf1x16(1.0f);
    const cl::Buffer irradiance = test::empty<std::uint16_t>(irradiance_bytes(storage, stride) / 2);
    const cl::Buffer points = test::upload(rows), held = test::upload(lights);
    const cl::Buffer count = test::upload(std::vector<cl_uint>{1});
    passes.gather(test::device().queue, {stride, 1, 0, 0}, 1, count, points, held, held,
                  irradiance);
    const auto out = test::download<std::uint16_t>(irradiance, IRRADIANCE_PLANES * stride);
    return {glm::unpackHalf1x16(out[0]), glm::unpackHalf1x16(out[stride]),
            glm::unpackHalf1x16(out[2 * stride])};
}

TEST(HalfStorage, KeepsLargeNumbersFiniteAndShowsWhatIsNot) {
    for (const int width : {0, 1, 4}) {
        BuildOptions build = halves;
        build.packet_width = width;
        const ImagePasses passes(test::programs(), build);
        // 1 / (pi 0.1^2) of the flux arrives.
        const glm::vec3 some = lit_by(100.0f, passes, Storage::half);
        EXPECT_NEAR(some.x, 100.0f / (0.01f * 3.14159265f), 3183.1f * half_error);
        EXPECT_NEAR(some.y, 1.0f / (0.01f * 3.14159265f), 31.831f * half_error);
        const glm::vec3 much = lit_by(1e30f, passes, Storage::half);
        EXPECT_EQ(much.x, 65504.0f);
        EXPECT_EQ(much.z, -65504.0f);
        EXPECT_EQ(much.y, some.y);
        const glm::vec3 none =
            lit_by(std::numeric_limits<float>::infinity(), passes, Storage::half);
        EXPECT_FALSE(std::isfinite(none.x));
        EXPECT_FALSE(std::isfinite(none.z));
    }
}

}  // namespace
}  // namespace clgi
