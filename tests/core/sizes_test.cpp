// Every pass refuses a buffer that is one byte too small, and says which and by how much; with
// nothing to do it does nothing.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>

#include "lighting.hpp"
#include "refusals.hpp"

namespace clgi {
namespace {

using test::expect_refusals;

constexpr std::uint32_t width = 5, height = 3, pixels = width * height, stride = 16, low = 6;

// The buffers of a frame of 5x3 pixels, all of them large enough.
struct Plenty {
    DeviceScene scene = test::on_device(cornell({.light = LightSource::spot}));
    View view = make_view(cornell().cameras[0], scene.frame(), width, height);
    RasterBuffers raster = test::raster_buffers(scene, pixels);
    EmitterSet set = make_emitters(scene, {.vpls = 4, .shadow_size = 8});
    EmitterBuffers emitters{test::upload(set.emitters), test::upload(set.views),
                            test::empty<std::uint64_t>(64)};
    cl::Buffer any = test::empty<float>(1 << 16);
};

// A copy of buffers with one of them replaced.
RasterBuffers with(RasterBuffers buffers, cl::Buffer RasterBuffers::*which,
                   const cl::Buffer& other) {
    buffers.*which = other;
    return buffers;
}

EmitterBuffers with(EmitterBuffers buffers, cl::Buffer EmitterBuffers::*which,
                    const cl::Buffer& other) {
    buffers.*which = other;
    return buffers;
}

TEST(Sizes, OfGBufferPasses) {
    const Plenty p;
    const GBufferPasses& passes = test::gbuffer_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const std::uint32_t stage = passes.stages(Pixels::visibility).front();
    const std::size_t triangles = p.scene.info().triangle_count;
    const std::size_t capacity = p.raster.capacity;
    const cl::Buffer views = test::upload(std::vector<View>{p.view});
    const ViewSpan span = span_of({p.view}, 0, 1);
    using R = RasterBuffers;
    const auto clear = [&](const R& b, const cl::Buffer& v) { passes.clear(queue, span, v, b); };
    const auto raster = [&](const R& b) {
        passes.clear(queue, span, views, p.raster);
        if (b.counts()) queue.enqueueFillBuffer(b.counts, cl_uint{0}, 0, sizeof(RasterCount));
        passes.raster(queue, span, views, p.scene, stage, b);
    };
    const auto late = [&](const R& b) {
        if (b.counts()) queue.enqueueFillBuffer(b.counts, cl_uint{0}, 0, sizeof(RasterCount));
        passes.raster_late(queue, span, views, p.scene, stage, b);
    };
    const auto large = [&](const R& b) {
        if (b.counts()) queue.enqueueFillBuffer(b.counts, cl_uint{0}, 0, sizeof(RasterCount));
        passes.raster_large(queue, span, views, p.scene, b);
    };
    const CubeParams cubes{2, 5, 8, 1, 0, 16, 0.0f, 0.1f};
    const cl::Buffer zeros = test::upload(std::vector<float>(1 << 10));
    const SurfaceParams surface{3, 16, 1, 0};
    const GBuffer target{p.any, p.any, 16, Storage::full};
    const auto resolve = [&](const cl::Buffer& visibility, const cl::Buffer& planes,
                             const cl::Buffer& ids) {
        passes.clear(queue, span, views, p.raster);
        if (visibility()) queue.enqueueFillBuffer(visibility, cl_uchar{255}, 0, pixels * 8 - 8);
        passes.resolve(queue, p.view, p.scene, {stride, RESOLVE_ALL, 0, 0}, visibility, planes,
                       ids);
    };
    const auto down = [&](const cl::Buffer& planes, const cl::Buffer& points) {
        passes.downsample(queue, {width, height, stride, stride, 2, 0, 0, 0}, planes, points);
    };
    expect_refusals({
        {"gbuffer.put_view", "views", sizeof(View),
         [&](const cl::Buffer& b) { passes.put_view(queue, p.view, 0, b); }},
        {"gbuffer.cubes", "points", POINT_PLANES * 16 * 4,
         [&](const cl::Buffer& b) { passes.cubes(queue, cubes, b, zeros, p.any); }},
        {"gbuffer.cubes", "chosen", 8,
         [&](const cl::Buffer& b) {
             if (b()) queue.enqueueFillBuffer(b, cl_uchar{0}, 0, b.getInfo<CL_MEM_SIZE>());
             passes.cubes(queue, cubes, zeros, b, p.any);
         }},
        {"gbuffer.cubes", "views", 11 * sizeof(View),
         [&](const cl::Buffer& b) { passes.cubes(queue, cubes, zeros, zeros, b); }},
        {"gbuffer.clear", "pixels", pixels * 8,
         [&](const cl::Buffer& b) { clear(with(p.raster, &R::pixels, b), views); }},
        {"gbuffer.clear", "counts", sizeof(RasterCount),
         [&](const cl::Buffer& b) { clear(with(p.raster, &R::counts, b), views); }},
        {"gbuffer.raster", "pixels", pixels * 8,
         [&](const cl::Buffer& b) { raster(with(p.raster, &R::pixels, b)); }},
        {"gbuffer.raster", "polygons", capacity * sizeof(RasterPolygon),
         [&](const cl::Buffer& b) { raster(with(p.raster, &R::polygons, b)); }},
        {"gbuffer.raster", "runs", capacity * sizeof(RasterRun),
         [&](const cl::Buffer& b) { raster(with(p.raster, &R::runs, b)); }},
        {"gbuffer.raster", "late", raster_batches(triangles) * 4,
         [&](const cl::Buffer& b) { raster(with(p.raster, &R::late, b)); }},
        {"gbuffer.raster_late", "late", raster_batches(triangles) * 4,
         [&](const cl::Buffer& b) { late(with(p.raster, &R::late, b)); }},
        {"gbuffer.raster_large", "pixels", pixels * 8,
         [&](const cl::Buffer& b) { large(with(p.raster, &R::pixels, b)); }},
        {"gbuffer.raster_views", "pixels", pixels * 8,
         [&](const cl::Buffer& b) {
             passes.raster_views(queue, span, views, p.scene, b, Pixels::visibility);
         }},
        {"gbuffer.raster_views", "pixels", pixels * 4,
         [&](const cl::Buffer& b) {
             passes.raster_views(queue, span, views, p.scene, b, Pixels::depth);
         }},
        {"gbuffer.trace_views", "pixels", pixels * 8,
         [&](const cl::Buffer& b) {
             passes.trace_views(queue, span, views, p.scene, b, Pixels::visibility);
         }},
        {"gbuffer.surface", "samples", 3 * sizeof(SurfaceSample),
         [&](const cl::Buffer& b) {
             if (b()) queue.enqueueFillBuffer(b, cl_uchar{0}, 0, 3 * sizeof(SurfaceSample) - 1);
             passes.surface(queue, p.scene, surface, b, target, p.any);
         }},
        {"gbuffer.surface", "planes", GBUFFER_PLANES * 16 * 4,
         [&](const cl::Buffer& b) {
             passes.surface(queue, p.scene, surface, zeros, {b, p.any, 16}, p.any);
         }},
        {"gbuffer.surface", "ids", GBUFFER_ID_PLANES * 16 * 4,
         [&](const cl::Buffer& b) {
             passes.surface(queue, p.scene, surface, zeros, {p.any, b, 16}, p.any);
         }},
        {"gbuffer.surface", "coords", 4 * 16 * 4,
         [&](const cl::Buffer& b) { passes.surface(queue, p.scene, surface, zeros, target, b); }},
        {"gbuffer.resolve", "planes", GBUFFER_PLANES * stride * 4,
         [&](const cl::Buffer& b) { resolve(p.raster.pixels, b, p.any); }},
        {"gbuffer.resolve", "ids", GBUFFER_ID_PLANES * stride * 4,
         [&](const cl::Buffer& b) { resolve(p.raster.pixels, p.any, b); }},
        {"gbuffer.downsample", "planes", POINT_PLANES * stride * 4,
         [&](const cl::Buffer& b) { down(b, p.any); }},
        {"gbuffer.downsample", "points", POINT_PLANES * stride * 4,
         [&](const cl::Buffer& b) { down(p.any, b); }},
    });
    EXPECT_THROW(passes.raster(queue, span, views, p.scene, 3, p.raster), Error);
    ViewSpan two = span;
    two.count = 2;  // more than the lists are for
    EXPECT_THROW(passes.raster(queue, two, test::upload(std::vector<View>(2, p.view)), p.scene,
                               stage, p.raster),
                 Error);
    EXPECT_THROW(
        passes.raster_views(queue, two, views, p.scene, p.raster.pixels, Pixels::visibility),
        Error);
    for (const CubeParams& wrong : {CubeParams{2, 4, 8, 1, 0, 16, 0.0f, 0.1f},
                                    {2, 5, 7, 1, 0, 16, 0.0f, 0.1f},
                                    {2, 5, 8, 1, 0, 16, 0.0f, 0.0f}})
        EXPECT_THROW(passes.cubes(queue, wrong, zeros, zeros, p.any), Error);
    EXPECT_THROW(
        passes.resolve(queue, p.view, p.scene, {15, 0, 0, 0}, p.raster.pixels, p.any, p.any),
        Error);
    EXPECT_THROW(
        passes.downsample(queue, {width, height, stride, low - 1, 2, 0, 0, 0}, p.any, p.any),
        Error);
    for (const std::uint32_t step : {0u, 1u, 3u, 8u})
        EXPECT_THROW(
            passes.downsample(queue, {width, height, stride, stride, step, 0, 0, 0}, p.any, p.any),
            Error);
}

TEST(Sizes, OfLightPasses) {
    const Plenty p;
    const LightPasses& passes = test::light_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer zeros = test::upload(std::vector<float>(1 << 14));
    const AcceptParams accept{0, 64, 0, 0};
    const FetchParams fetch{4, 1, 1.0f, 1.0f};
    const NegativeParams negative{4, 3, stride, 0.0f, 1.0f, 0, 0, 0};
    const std::size_t light = sizeof(Vpl);
    expect_refusals({
        {"lights.accept_mask", "mask", 8,
         [&](const cl::Buffer& b) { passes.accept_mask(queue, accept, p.emitters.emitters, b); }},
        {"lights.accept_list", "mask", 8,
         [&](const cl::Buffer& b) {
             passes.accept_list(queue, accept, p.emitters.emitters, b, p.any);
         }},
        {"lights.fetch", "lights", 4 * light,
         [&](const cl::Buffer& b) { passes.fetch(queue, fetch, p.scene, p.emitters, zeros, b); }},
        {"lights.negative", "negative", 3 * light,
         [&](const cl::Buffer& b) { passes.negative(queue, negative, p.view, zeros, zeros, b); }},
    });
    // Buffers whose contents a kernel follows are only refused here, not used.
    const cl::Buffer tiny = test::empty<char>(1);
    EXPECT_THROW(passes.accept_mask(queue, accept, tiny, p.any), Error);
    EXPECT_THROW(passes.accept_list(queue, accept, tiny, p.any, p.any), Error);
    EXPECT_THROW(passes.accept_list(queue, accept, p.emitters.emitters, p.any, tiny), Error);
    EXPECT_THROW(passes.fetch(queue, fetch, p.scene,
                              with(p.emitters, &EmitterBuffers::emitters, tiny), zeros, p.any),
                 Error);
    EXPECT_THROW(passes.fetch(queue, fetch, p.scene, p.emitters, tiny, p.any), Error);
    EXPECT_THROW(passes.negative(queue, negative, p.view, tiny, zeros, p.any), Error);
    EXPECT_THROW(passes.negative(queue, negative, p.view, zeros, tiny, p.any), Error);
    EXPECT_THROW(passes.accept_mask(queue, {0, 33, 0, 0}, p.emitters.emitters, p.any), Error);
    EXPECT_THROW(passes.negative(queue, {4, 3, pixels - 1, 0.0f}, p.view, zeros, zeros, p.any),
                 Error);
}

TEST(Sizes, OfImagePasses) {
    const Plenty p;
    const ImagePasses& passes = test::image_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer z = test::upload(std::vector<float>(1 << 14));
    RefineParams refine{};
    refine.width = width;
    refine.height = height;
    refine.stride = refine.low_stride = stride;
    refine.step = 2;
    CombineParams combine{};
    combine.width = width;
    combine.height = height;
    combine.stride = stride;
    combine.depth_words = 2;
    combine.effects = COMBINE_INDIRECT;
    const GatherParams gather{stride, 0, 0, 0};
    const EnvironmentParams environment{glm::vec4(1.0f), 1, 1, stride, 0.0f};
    const std::size_t plane = stride * sizeof(float);
    const std::size_t points = POINT_PLANES * plane, irradiance = IRRADIANCE_PLANES * plane;
    const auto into = [&](const cl::Buffer& b) {
        queue.enqueueFillBuffer(b, cl_uchar{0}, 0, b.getInfo<CL_MEM_SIZE>());
    };
    using B = const cl::Buffer&;
    const cl::Buffer& a = p.any;
    into(a);
    expect_refusals({
        {"image.gather", "points", points,
         [&](B b) { passes.gather(queue, gather, pixels, z, b, z, z, a); }},
        {"image.gather", "irradiance", irradiance,
         [&](B b) { passes.gather(queue, gather, pixels, z, z, z, z, b); }},
        {"image.count", "flags", pixels, [&](B b) { passes.count(queue, pixels, b, a); }},
        {"image.count", "counts", 4, [&](B b) { passes.count(queue, pixels, z, b); }},
        {"image.compact", "flags", pixels,
         [&](B b) {
             if (b()) into(b);
             passes.compact(queue, refine, b, z, z, a, a, a);
         }},
        {"image.compact", "planes", points,
         [&](B b) { passes.compact(queue, refine, z, z, b, a, a, a); }},
        {"image.compact", "listed", plane,
         [&](B b) { passes.compact(queue, refine, z, z, z, b, a, a); }},
        {"image.compact", "points", points,
         [&](B b) { passes.compact(queue, refine, z, z, z, a, b, a); }},
        {"image.compact", "point_count", 4,
         [&](B b) { passes.compact(queue, refine, z, z, z, a, a, b); }},
        {"image.upsample", "planes", points,
         [&](B b) { passes.upsample(queue, refine, b, z, z, a, a); }},
        {"image.upsample", "points", points,
         [&](B b) { passes.upsample(queue, refine, z, b, z, a, a); }},
        {"image.upsample", "low", irradiance,
         [&](B b) { passes.upsample(queue, refine, z, z, b, a, a); }},
        {"image.upsample", "irradiance", irradiance,
         [&](B b) { passes.upsample(queue, refine, z, z, z, b, a); }},
        {"image.upsample", "flags", pixels,
         [&](B b) { passes.upsample(queue, refine, z, z, z, a, b); }},
        {"image.place", "listed", plane, [&](B b) { passes.place(queue, refine, z, b, z, a); }},
        {"image.place", "refined", irradiance,
         [&](B b) { passes.place(queue, refine, z, z, b, a); }},
        {"image.place", "irradiance", irradiance,
         [&](B b) { passes.place(queue, refine, z, z, z, b); }},
        {"image.combine", "planes", GBUFFER_PLANES * plane,
         [&](B b) {
             passes.combine(queue, combine, p.view, p.scene, {p.emitters, {b, z, stride}, z, a, a});
         }},
        {"image.combine", "ids", GBUFFER_ID_PLANES * plane,
         [&](B b) {
             passes.combine(queue, combine, p.view, p.scene, {p.emitters, {z, b, stride}, z, a, a});
         }},
        {"image.combine", "irradiance", irradiance,
         [&](B b) {
             passes.combine(queue, combine, p.view, p.scene, {p.emitters, {z, z, stride}, b, a, a});
         }},
        {"image.combine", "radiance", RADIANCE_PLANES * plane,
         [&](B b) {
             passes.combine(queue, combine, p.view, p.scene, {p.emitters, {z, z, stride}, z, b, a});
         }},
        {"image.combine", "non_finite", 4,
         [&](B b) {
             passes.combine(queue, combine, p.view, p.scene, {p.emitters, {z, z, stride}, z, a, b});
         }},
        {"image.environment", "texels", 3 * sizeof(float),
         [&](B b) { passes.environment(queue, environment, p.view, b, z, a); }},
        {"image.environment", "planes", (GBUFFER_NORMAL + 3) * plane,
         [&](B b) { passes.environment(queue, environment, p.view, z, b, a); }},
        {"image.environment", "radiance", RADIANCE_PLANES * plane,
         [&](B b) { passes.environment(queue, environment, p.view, z, z, b); }},
        {"image.tonemap", "radiance", RADIANCE_PLANES * plane,
         [&](B b) {
             passes.tonemap(queue, {width, height, stride, 1.0f}, b, a);
         }},
        {"image.tonemap", "preview", pixels * 4,
         [&](B b) {
             passes.tonemap(queue, {width, height, stride, 1.0f}, z, b);
         }},
    });
    const cl::Buffer tiny = test::empty<char>(1);
    EXPECT_THROW(passes.gather(queue, {stride, 1, 0, 0}, pixels, z, z, tiny, z, a), Error);
    EXPECT_THROW(passes.gather(queue, {stride, 0, 1, 0}, pixels, z, z, z, tiny, a), Error);
    EXPECT_THROW(passes.gather(queue, gather, pixels, tiny, z, z, z, a), Error);
    EXPECT_THROW(passes.gather(queue, {15, 0, 0, 0}, pixels, z, z, z, z, a), Error);
    EXPECT_THROW(passes.place(queue, refine, tiny, z, z, a), Error);
    EXPECT_THROW(passes.environment(queue, {glm::vec4(1.0f), 0, 1, stride, 0.0f}, p.view, z, z, a),
                 Error);
    EXPECT_THROW(passes.compact(queue, refine, z, tiny, z, a, a, a), Error);
}

TEST(Sizes, OfNothingAtAllAreFine) {
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer any = test::empty<float>(1024);
    test::image_passes().gather(queue, {16, 0, 0, 0}, 0, any, any, any, any, any).wait();
    test::image_passes().count(queue, 0, any, any).wait();
    test::image_passes().tonemap(queue, {0, 0, 16, 1.0f}, any, any).wait();
    const DeviceScene scene = test::on_device(Scene());
    const RasterBuffers buffers = test::raster_buffers(scene, 1);
    const View view = make_view(Camera(), scene.frame(), 1, 1);
    test::draw_visibility(test::gbuffer_passes(), scene, view, buffers);
    EXPECT_EQ(test::download<std::uint64_t>(buffers.pixels, 1)[0], ~std::uint64_t{0});
}

}  // namespace
}  // namespace clgi
