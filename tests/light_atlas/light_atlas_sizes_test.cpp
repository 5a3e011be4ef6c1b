// Sizes of light atlases beyond 32 bits, refused before anything is written.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/atlas_light.hpp>
#include <clgi/error.hpp>
#include <string>

#include "light_baking.hpp"
#include "methods/light_atlas/placement.hpp"
#include "methods/light_atlas/solver_state.hpp"
#include "one_batch.hpp"

namespace clgi {
namespace {

TEST(LightAtlasSizes, BeyondWhatKernelsCountAreRefused) {
    const std::size_t most = (std::size_t{1} << 28) - 1024;
    EXPECT_NO_THROW(light_atlas::check_sizes(1000, most - 1000, most - 16, 0));
    EXPECT_THROW(light_atlas::check_sizes(1000, most - 999, 1, 0), Error);
    EXPECT_THROW(light_atlas::check_sizes(1, 1, most + 1, 0), Error);
    EXPECT_THROW(light_atlas::check_sizes(1, 1, 16, most), Error);
    EXPECT_THROW(light_atlas::check_sizes(1, 1, std::size_t{1} << 32, 0), Error);
}

TEST(LightAtlasSizes, OfPagesBeyond32BitsAreRefused) {
    EXPECT_NO_THROW(need_countable_texels("atlas", 16384, 15));
    EXPECT_THROW(need_countable_texels("atlas", 16384, 16), InputError);
    EXPECT_NO_THROW(need_countable_texels("atlas", 1024, 4095));
    EXPECT_THROW(need_countable_texels("atlas", 1024, 4096), InputError);
    // Before a finer one takes memory.
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    AtlasLayout atlas =
        make_atlas(scene, make_patches(scene).triangle_patch, AtlasOptions{.size = 16});
    atlas.pages = 20;
    EXPECT_THROW(finer_atlas(scene, atlas, 1024), InputError);
}

// Kernels of texels multiply plane and stride in 32 bits.
TEST(LightAtlasSizes, OfPlanesBeyond32BitsAreRefusedBeforeAnythingIsWritten) {
    const std::uint32_t stride = 477218592;  // times 9 planes: 2^32 and 32
    const auto refusal = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const AtlasPasses& passes = test::atlas_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer none = test::empty<float>(16);
    const std::string wanted = " texels has 9 planes of 477218592, at most 2^32 numbers needed";
    EXPECT_EQ(refusal([&] {
                  passes.see(queue, {1, 64, 7, stride, 0, 0, 0, 0}, none, none, none, none);
              }),
              "atlas.see:" + wanted);
    const FillParams fill{0, 1, 16, 16, 7, stride, 0, 0};
    EXPECT_EQ(refusal([&] { passes.nearest(queue, fill, {}, none, none); }),
              "atlas.nearest:" + wanted);
    EXPECT_EQ(refusal([&] { passes.complete(queue, fill, none, none, none, none, none); }),
              "atlas.complete:" + wanted);
    BlockParams blocks{};
    blocks.stride = stride;
    blocks.listed_stride = 16;
    EXPECT_EQ(refusal([&] { passes.flat(queue, blocks, none, {}); }), "atlas.flat:" + wanted);
    // A page more than 2^32 texels: their numbers wrap around.
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    const DeviceScene device = test::on_device(scene);
    const ShowParams show{16, 16, 2, 1, 16, 16384, 17, 0};
    EXPECT_EQ(refusal([&] {
                  passes.show(queue, show, device, GBuffer{none, none, 16, Storage::full}, {}, none,
                              none);
              }),
              "atlas.show: map has 17 planes of 268435456, at most 2^32 numbers needed");
}

}  // namespace
}  // namespace clgi
