// From texels to planes: hand-made pictures, and the two kernels against each other.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::nan;
constexpr float infinity = std::numeric_limits<float>::infinity();

// A picture as arrays of texels, row 0 at the bottom.
struct Picture {
    int width = 5, height = 3;
    std::vector<glm::vec4> position, normal, geometric, albedo, emission;
    std::vector<float> depth;
    std::vector<glm::ivec2> labels;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
    std::size_t texel(int column, int row_from_top) const {
        return static_cast<std::size_t>(height - 1 - row_from_top) * width + column;
    }
};

// Points on a wall 2 m before an eye at (0, 0, 2) that looks along -z.
Picture wall(int width = 5, int height = 3) {
    Picture out;
    out.width = width;
    out.height = height;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const float x = static_cast<float>(column), y = static_cast<float>(row);
            out.position.emplace_back(0.1f * x, 0.1f * y, 0.0f, 1.0f);
            out.normal.emplace_back(0.1f, 0.0f, 2.0f, 0.0f);
            out.geometric.emplace_back(0.0f, 0.0f, -3.0f, 0.0f);
            out.albedo.emplace_back(0.2f, 0.4f + 0.01f * x, 1.5f, 0.3f);
            out.emission.emplace_back(1.0f, 2.0f, 4.0f, 0.0f);
            out.depth.push_back(2.0f);
            out.labels.emplace_back(column - 1, row);
        }
    return out;
}

// A room of known size: 2 m high and wide, its middle at (3, 0, 0).
const DeviceScene& room() {
    static const DeviceScene placed = [] {
        Scene scene = test::plain_scene();
        test::add_material(scene, Material());
        test::add_box(scene, {2, -1, -1}, {4, 1, 1}, -1);
        scene.materials[0].emission = glm::vec3(100.0f);
        return test::on_device(scene);
    }();
    return placed;
}

View view_of(const Picture& picture) {
    Camera camera;
    camera.position = glm::dvec3(0, 0, 2);
    return make_view(camera, room().frame(), picture.width, picture.height);
}

constexpr std::uint32_t everything = IMPORT_POSITION | IMPORT_GEOMETRIC | IMPORT_EMISSION |
                                     IMPORT_DEPTH | IMPORT_MATERIAL | IMPORT_TRIANGLE;

struct Imported {
    test::Drawing planes;
    std::uint32_t non_finite = 0;
};

cl::Image2D image(const Picture& picture, cl_channel_order order, cl_channel_type type,
                  const void* texels) {
    return cl::Image2D(test::device().context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                       cl::ImageFormat(order, type), static_cast<std::size_t>(picture.width),
                       static_cast<std::size_t>(picture.height), 0, const_cast<void*>(texels));
}

// Four channels throughout: not every device has images of one or two.
ImportImages images_of(const Picture& p) {
    std::vector<glm::vec4> depth;
    std::vector<glm::ivec4> labels;
    for (const float d : p.depth) depth.emplace_back(d, 7.0f, 7.0f, 7.0f);
    for (const glm::ivec2& label : p.labels) labels.emplace_back(label, 7, 7);
    return {image(p, CL_RGBA, CL_FLOAT, p.position.data()),
            image(p, CL_RGBA, CL_FLOAT, p.normal.data()),
            image(p, CL_RGBA, CL_FLOAT, p.geometric.data()),
            image(p, CL_RGBA, CL_FLOAT, p.albedo.data()),
            image(p, CL_RGBA, CL_FLOAT, p.emission.data()),
            image(p, CL_RGBA, CL_FLOAT, depth.data()),
            image(p, CL_RGBA, CL_SIGNED_INT32, labels.data())};
}

ImportBuffers buffers_of(const Picture& p) {
    return {test::upload(p.position), test::upload(p.normal),   test::upload(p.geometric),
            test::upload(p.albedo),   test::upload(p.emission), test::upload(p.depth),
            test::upload(p.labels)};
}

Imported import(const Picture& picture, std::uint32_t flags, bool from_images = false,
                const BuildOptions& build = {}) {
    static std::map<int, ImportPasses> built;
    const int key = build.packet_width + 100 * (build.math == Math::fast) +
                    200 * (build.storage == Storage::half);
    const ImportPasses& passes =
        built.try_emplace(key, test::device().context, test::device().device, build).first->second;
    const View view = view_of(picture);
    const std::uint32_t stride = test::padded(picture.pixels());
    const GBuffer out{test::upload(std::vector<float>(GBUFFER_PLANES * stride, -77.0f)),
                      test::upload(std::vector<cl_int>(GBUFFER_ID_PLANES * stride, -77)), stride,
                      build.storage};
    const cl::Buffer count = test::upload(std::vector<cl_uint>{5});
    ImportParams params = import_params(room(), stride);
    params.flags = flags;
    const cl::CommandQueue& queue = test::device().queue;
    if (from_images)
        passes.images(queue, view, params, images_of(picture), out, count);
    else
        passes.buffers(queue, view, params, buffers_of(picture), out, count);
    Imported result;
    result.planes.view = view;
    result.planes.stride = stride;
    result.planes.planes = test::read_planes(out);
    result.planes.ids = test::download<std::int32_t>(out.ids, GBUFFER_ID_PLANES * stride);
    result.non_finite = test::download<cl_uint>(count, 1)[0] - 5;
    return result;
}

void expect_near(const glm::vec3& got, const glm::vec3& wanted, const char* what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], wanted[c], 4e-7f) << what << " " << c;
}

TEST(Import, BringsTexelsIntoTheLocalFrameAndExposure) {
    const Imported got = import(wall(), everything);
    const SceneFrame& frame = room().frame();
    EXPECT_EQ(frame.scale, 0.5);  // the radius is the square root of 3
    EXPECT_EQ(frame.exposure, 128.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column) {
            const auto p = static_cast<std::size_t>(row * 5 + column);
            const float up = 0.1f * static_cast<float>(2 - row);  // row 0 is the top one
            expect_near(got.planes.at(GBUFFER_POSITION, p),
                        {0.5f * (0.1f * static_cast<float>(column) - 3.0f), 0.5f * up, 0.0f},
                        "position");
            expect_near(got.planes.at(GBUFFER_NORMAL, p), glm::normalize(glm::vec3(0.1f, 0, 2.0f)),
                        "normal");
            expect_near(got.planes.at(GBUFFER_GEOMETRIC, p), {0, 0, 1}, "geometric");
            expect_near(got.planes.at(GBUFFER_BASE, p),
                        {0.2f, 0.4f + 0.01f * static_cast<float>(column), 1.0f}, "albedo");
            expect_near(got.planes.at(GBUFFER_EMISSION, p), glm::vec3(1, 2, 4) / 128.0f,
                        "emission");
            EXPECT_EQ(got.planes.depth(p), 1.0f);
            // Two materials and twelve triangles are known; other numbers become -1.
            EXPECT_EQ(got.planes.ids[p], column == 1 || column == 2 ? column - 1 : -1);
            EXPECT_EQ(got.planes.ids[got.planes.stride + p], 2 - row);
        }
    EXPECT_EQ(got.non_finite, 0u);
    // Past the last pixel: the rest of a packet, or what was there before.
    const float past = test::gbuffer_passes().packet_width() > 1 ? 0.0f : -77.0f;
    for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
        EXPECT_EQ(got.planes.planes[plane * got.planes.stride + 15], past);
}

TEST(Import, TurnsRowsOverWhereTheTopOneComesFirst) {
    const Imported bottom = import(wall(), everything);
    const Imported top = import(wall(), everything | IMPORT_TOP_FIRST);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column)
            EXPECT_EQ(top.planes.at(GBUFFER_POSITION, static_cast<std::size_t>(row * 5 + column)),
                      bottom.planes.at(GBUFFER_POSITION,
                                       static_cast<std::size_t>((2 - row) * 5 + column)));
}

TEST(Import, FindsPositionsFromDepth) {
    Picture picture = wall(4, 4);
    picture.depth[picture.texel(1, 2)] = 0.0f;  // nothing there
    const Imported got = import(picture, IMPORT_DEPTH);
    const View& view = got.planes.view;
    for (std::size_t p = 0; p < 16; ++p) {
        if (p == 9) {
            EXPECT_EQ(got.planes.at(GBUFFER_NORMAL, p), glm::vec3(0.0f));
            continue;
        }
        const float x = (static_cast<float>(p % 4) + 0.5f) / 2.0f - 1.0f;
        const float y = 1.0f - (static_cast<float>(p / 4) + 0.5f) / 2.0f;
        expect_near(got.planes.at(GBUFFER_POSITION, p),
                    glm::vec3(view.eye) + glm::vec3(x * view.right.w, y * view.up.w, -1.0f),
                    "position");
        expect_near(got.planes.at(GBUFFER_GEOMETRIC, p), got.planes.at(GBUFFER_NORMAL, p),
                    "the shading normal stands in");
        EXPECT_EQ(got.planes.ids[p], -1);
    }
}

TEST(Import, FindsDepthFromPositions) {
    const Imported got = import(wall(), IMPORT_POSITION);
    for (std::size_t p = 0; p < 15; ++p) EXPECT_NEAR(got.planes.depth(p), 1.0f, 2e-7f);
    EXPECT_EQ(got.planes.at(GBUFFER_EMISSION, 3), glm::vec3(0.0f));
}

TEST(Import, TurnsNormalsTowardsTheViewer) {
    Picture picture = wall();
    picture.normal[picture.texel(0, 0)] = {0, 0, -1e-30f, 0};  // seen from behind
    picture.normal[picture.texel(1, 0)] = {0, 1e30f, 0, 0};    // away from the eye, barely
    picture.geometric[picture.texel(2, 0)] = glm::vec4(0.0f);  // not known there
    picture.normal[picture.texel(3, 0)] = glm::vec4(0.0f);     // nothing
    const Imported both = import(picture, IMPORT_POSITION | IMPORT_GEOMETRIC);
    expect_near(both.planes.at(GBUFFER_NORMAL, 0), {0, 0, 1}, "gives way");
    expect_near(both.planes.at(GBUFFER_NORMAL, 1), {0, 0, 1}, "gives way");
    expect_near(both.planes.at(GBUFFER_GEOMETRIC, 2), both.planes.at(GBUFFER_NORMAL, 2), "in for");
    EXPECT_EQ(both.planes.at(GBUFFER_NORMAL, 3), glm::vec3(0.0f));
    EXPECT_EQ(both.planes.at(GBUFFER_BASE, 3), glm::vec3(0.0f));
    const Imported alone = import(picture, IMPORT_POSITION);
    expect_near(alone.planes.at(GBUFFER_NORMAL, 0), {0, 0, 1}, "is turned");
    expect_near(alone.planes.at(GBUFFER_NORMAL, 1), {0, -1, 0}, "is turned");
}

// Every channel, every kind of number that is none; in strict and in fast math.
TEST(Import, TakesWhatIsNotFiniteForBackgroundAndCountsIt) {
    for (const Math math : {Math::strict, Math::fast})
        for (const float bad : {nan, infinity, -infinity}) {
            Picture picture = wall(7, 5);
            const std::size_t hit[] = {0, 4, 9, 13, 22, 34};
            picture.position[hit[0]].y = bad;
            picture.normal[hit[1]].x = bad;
            picture.geometric[hit[2]].z = bad;
            picture.albedo[hit[3]].x = bad;
            picture.emission[hit[4]].z = bad;
            picture.depth[hit[5]] = bad;
            for (const bool from_images : {false, true}) {
                const Imported got = import(picture, everything, from_images, {.math = math});
                EXPECT_EQ(got.non_finite, 6u);
                for (const std::size_t texel : hit) {
                    const std::size_t p = (4 - texel / 7) * 7 + texel % 7;
                    for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
                        EXPECT_EQ(got.planes.planes[plane * got.planes.stride + p], 0.0f);
                    EXPECT_EQ(got.planes.ids[p], -1);
                }
                std::size_t seen = 0;
                for (std::size_t p = 0; p < 35; ++p)
                    seen += got.planes.at(GBUFFER_NORMAL, p) != glm::vec3(0.0f);
                EXPECT_EQ(seen, 29u);
                // What a texture leaves out is not looked at.
                EXPECT_EQ(import(picture, IMPORT_POSITION, from_images, {.math = math}).non_finite,
                          3u);
            }
        }
}

TEST(Import, GivesTheSameBitsFromImagesAndBuffersAtEveryWidth) {
    const Picture picture = wall(33, 9);
    const Imported first = import(picture, everything, false, {.packet_width = 1});
    for (const int width : test::widths())
        for (const bool from_images : {false, true}) {
            const Imported other =
                import(picture, everything, from_images, {.packet_width = width});
            for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
                for (std::size_t p = 0; p < picture.pixels(); ++p)
                    ASSERT_EQ(first.planes.planes[plane * first.planes.stride + p],
                              other.planes.planes[plane * other.planes.stride + p]);
        }
}

TEST(Import, StoresTheSamePlanesRoundedToHalves) {
    const Picture picture = wall(33, 9);
    const Imported full = import(picture, everything);
    for (const int width : {1, 4})
        for (const bool from_images : {false, true}) {
            const Imported half = import(picture, everything, from_images,
                                         {.storage = Storage::half, .packet_width = width});
            EXPECT_EQ(half.non_finite, 0u);
            for (std::size_t p = 0; p < picture.pixels(); ++p)
                ASSERT_EQ(half.planes.ids[p], full.planes.ids[p]) << p;
            for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
                for (std::size_t p = 0; p < picture.pixels(); ++p) {
                    const float value = full.planes.planes[plane * full.planes.stride + p];
                    const float step = HALF_PLANE(plane) ? std::abs(value) / 2048.0f : 0.0f;
                    ASSERT_NEAR(half.planes.planes[plane * half.planes.stride + p], value, step)
                        << plane << " " << p;
                }
        }
}

TEST(Import, WorksOnOnePixel) {
    const Imported got = import(wall(1, 1), everything);
    expect_near(got.planes.at(GBUFFER_POSITION, 0), {-1.5f, 0, 0}, "position");
}

// Halves and bytes, bit patterns by hand.
TEST(Import, ReadsHalvesAndBytes) {
    const Picture picture = wall(2, 1);
    const ImportPasses passes(test::programs());
    ImportBuffers texels = buffers_of(picture);
    // 0, 0.5, -1.5, 0; 65504 (the largest), 2^-24 (the smallest), 0, 0.
    texels.normal =
        test::upload(std::vector<cl_ushort>{0, 0x3800, 0x3e00, 0, 0x7bff, 0x0001, 0, 0});
    texels.albedo = test::upload(std::vector<cl_uchar>{0, 51, 255, 9, 128, 1, 254, 0});
    texels.emission =
        test::upload(std::vector<cl_ushort>{0x3c00, 0x4000, 0x7bff, 0, 0x7c00, 0, 0, 0});
    ImportParams params = import_params(room(), 16);
    params.flags = IMPORT_POSITION | IMPORT_EMISSION;
    params.normal_format = TEXEL_RGBA16F;
    params.albedo_format = TEXEL_RGBA8;
    params.emission_format = TEXEL_RGBA16F;
    const GBuffer out{test::empty<float>(16 * 16), test::empty<cl_int>(GBUFFER_ID_PLANES * 16), 16};
    const cl::Buffer count = test::upload(std::vector<cl_uint>{0});
    passes.buffers(test::device().queue, view_of(picture), params, texels, out, count);
    const auto planes = test::download<float>(out.planes, 16 * 16);
    const auto at = [&](int plane, int pixel) {
        return glm::vec3(planes[plane * 16 + pixel], planes[(plane + 1) * 16 + pixel],
                         planes[(plane + 2) * 16 + pixel]);
    };
    expect_near(at(GBUFFER_NORMAL, 0), glm::normalize(glm::vec3(0, 0.5f, 1.5f)), "normal");
    EXPECT_EQ(at(GBUFFER_BASE, 0), glm::vec3(0.0f, 51.0f / 255.0f, 1.0f));
    EXPECT_EQ(at(GBUFFER_EMISSION, 0), glm::vec3(1, 2, 65504) / 128.0f);
    EXPECT_EQ(at(GBUFFER_NORMAL, 1), glm::vec3(0.0f)) << "its emission is infinite";
    EXPECT_EQ(test::download<cl_uint>(count, 1)[0], 1u);
}

void expect_refused(const std::function<void()>& call, const std::string& because) {
    try {
        call();
        ADD_FAILURE() << "accepted, though " << because;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
    }
}

TEST(Import, RefusesWhatDoesNotFit) {
    const Picture picture = wall();
    const View view = view_of(picture);
    const ImportPasses passes(test::programs());
    const cl::CommandQueue& queue = test::device().queue;
    const GBuffer out{test::empty<float>(16 * 16), test::empty<cl_int>(GBUFFER_ID_PLANES * 16), 16};
    const cl::Buffer count = test::empty<cl_uint>(1);
    ImportParams params = import_params(room(), 16);
    params.flags = everything;
    const ImportBuffers whole = buffers_of(picture);
    const auto refused = [&](const ImportBuffers& texels, const GBuffer& target,
                             const std::string& because) {
        expect_refused([&] { passes.buffers(queue, view, params, texels, target, count); },
                       because);
    };
    using Member = cl::Buffer ImportBuffers::*;
    const std::pair<Member, std::size_t> members[] = {
        {&ImportBuffers::position, 240},  {&ImportBuffers::normal, 240},
        {&ImportBuffers::geometric, 240}, {&ImportBuffers::albedo, 240},
        {&ImportBuffers::emission, 240},  {&ImportBuffers::depth, 60},
        {&ImportBuffers::labels, 120}};
    for (const auto& [member, bytes] : members) {
        ImportBuffers texels = whole;
        texels.*member = test::empty<cl_uchar>(bytes - 1);
        refused(
            texels, out,
            "holds " + std::to_string(bytes - 1) + " bytes, " + std::to_string(bytes) + " needed");
        texels.*member = cl::Buffer();
        refused(texels, out, "holds 0 bytes");
    }
    refused(whole, {test::empty<cl_uchar>(1023), out.ids, 16}, "planes holds 1023 bytes, 1024");
    refused(whole, {out.planes, test::empty<cl_uchar>(255), 16}, "ids holds 255 bytes, 256");
    refused(whole, {out.planes, out.ids, 32}, "stride is 32, 16 needed");
    refused(whole, {out.planes, out.ids, 16, Storage::half}, "storage is half, full needed");
    params.normal_format = 3;
    refused(whole, out, "normal_format is 3");
    params.normal_format = 0;
    params.flags = IMPORT_GEOMETRIC;
    refused(whole, out, "neither positions nor depth");
    params.flags = IMPORT_POSITION | IMPORT_TRIANGLE;
    refused(whole, out, "IMPORT_MATERIAL needed");
    params.flags = everything;
    params.stride = 8;
    refused(whole, out, "stride is 8");
    params.stride = 16;
    ImportImages images = images_of(picture);
    images.depth = images_of(wall(4, 3)).depth;
    expect_refused([&] { passes.images(queue, view, params, images, out, count); },
                   "depth is 4x3, 5x3 needed");
}

}  // namespace
}  // namespace clgi
