// A part of a buffer of views: these are drawn, and no others.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "patchwork.hpp"

namespace clgi {
namespace {

using test::Looking;

std::vector<View> side_by_side(const DeviceScene& scene) {
    std::vector<View> out;
    std::uint32_t pixel = 3;
    for (const Looking how : {Looking::perspective, Looking::orthographic, Looking::aside,
                              Looking::orthographic_aside}) {
        View view = test::looking(how, scene, 61, 47);
        view.first_pixel = pixel;
        pixel += view.width * view.height;
        out.push_back(view);
    }
    return out;
}

// The pixels of all views after drawing `count` of them from `first` on.
template <typename Word>
std::vector<Word> drawn(const DeviceScene& scene, const std::vector<View>& views, std::size_t first,
                        std::size_t count, bool whole, std::uint32_t capacity = 0) {
    const cl::CommandQueue& queue = test::device().queue;
    const Pixels kind = sizeof(Word) == 4 ? Pixels::depth : Pixels::visibility;
    const ViewSpan all = span_of(views, 0, views.size()), span = span_of(views, first, count);
    const RasterBuffers buffers = test::raster_buffers(scene, all.pixels, kind, 2, capacity);
    queue.enqueueFillBuffer(buffers.pixels, cl_uchar{0x5a}, 0, all.pixels * sizeof(Word));
    const cl::Buffer on_device = test::upload(views);
    const GBufferPasses& passes = test::gbuffer_passes();
    if (whole) {
        passes.raster_views(queue, span, on_device, scene, buffers.pixels, kind);
    } else {
        Recorder record(queue, "test");
        record.begin({});
        draw_by_lists(record, passes, scene, span, on_device, buffers);
    }
    return test::download<Word>(buffers.pixels, all.pixels);
}

template <typename Word>
void expect_parts(const DeviceScene& scene, bool whole, std::uint32_t capacity = 0) {
    const std::vector<View> views = side_by_side(scene);
    const auto all = drawn<Word>(scene, views, 0, views.size(), false);
    for (const auto& [first, count] : {std::pair(1u, 2u), {3, 1}, {0, 1}, {2, 2}}) {
        const auto found = drawn<Word>(scene, views, first, count, whole, capacity);
        const std::size_t begin = views[first].first_pixel;
        const std::size_t end =
            begin + std::size_t{count} * views[first].width * views[first].height;
        for (std::size_t p = 0; p < all.size(); ++p)
            ASSERT_EQ(found[p], p < begin || p >= end ? all[0] : all[p]) << first << ", " << p;
    }
}

TEST(LaterViews, AreDrawnAndNoOthers) {
    const DeviceScene scene = test::on_device(test::patchwork(150, 121));
    for (const bool whole : {true, false}) {
        expect_parts<std::uint64_t>(scene, whole);
        expect_parts<std::uint32_t>(scene, whole);
    }
    expect_parts<std::uint64_t>(scene, false, 20);  // lists too short for what is large
    expect_parts<std::uint32_t>(scene, false, 20);
}

TEST(LaterViews, ArePutAtTheirPlace) {
    const DeviceScene scene = test::on_device(test::patchwork(5, 122));
    const std::vector<View> views = side_by_side(scene);
    const cl::Buffer found = test::upload(std::vector<View>(4));
    for (const std::uint32_t place : {2u, 0u, 3u})
        test::gbuffer_passes().put_view(test::device().queue, views[place], place, found);
    const auto put = test::download<View>(found, 4);
    const View none{};
    for (std::uint32_t v = 0; v < 4; ++v) {
        const View& wanted = v == 1 ? none : views[v];
        EXPECT_EQ(std::memcmp(&put[v], &wanted, sizeof wanted), 0) << v;
    }
}

}  // namespace
}  // namespace clgi
