// Kernels are built when they are first needed, once, and shared.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <thread>

#include "core/opencl/kernel_slot.hpp"
#include "frames.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

TEST(Programs, BuildAKernelWhenItIsFirstEnqueued) {
    const test::Device& on = test::device();
    const Programs programs(on.context, on.device);
    const ImagePasses passes(programs), others(programs);
    EXPECT_EQ(programs.built(), 0u);
    const cl::Buffer any = test::empty<float>(1024);
    passes.count(on.queue, 100, any, any).wait();
    EXPECT_EQ(programs.built(), 1u);
    others.count(on.queue, 100, any, any).wait();  // the same kernel
    EXPECT_EQ(programs.built(), 1u);
    passes.build({"count", "place"});
    EXPECT_EQ(programs.built(), 2u);
    const ImagePasses fast(programs, {.math = Math::fast});
    fast.count(on.queue, 100, any, any).wait();
    EXPECT_EQ(programs.built(), 3u);
    EXPECT_THROW(passes.build({"counts"}), Error);
    EXPECT_THROW(programs.kernel("image", "nothing"), Error);
}

cl_program program_of(const PassKernel& pass) {
    return pass.slot->with_kernel(
        [](const cl::Kernel& kernel) { return kernel.getInfo<CL_KERNEL_PROGRAM>()(); });
}

TEST(Programs, AreOneForTheKernelsOfAFolderWithTheSameOptions) {
    const Programs programs(test::device().context, test::device().device);
    const BuildOptions fast{.math = Math::fast};
    const PassKernel count = programs.kernel("image", "count"),
                     place = programs.kernel("image", "place"),
                     compact = programs.kernel("image", "compact", fast),
                     alone = programs.kernel("image", "upsample"),
                     offsets = programs.kernel("parallel", "offsets");
    build({count, place, compact, offsets, count});
    EXPECT_EQ(programs.built(), 4u);
    EXPECT_EQ(program_of(count), program_of(place));
    EXPECT_NE(program_of(count), program_of(compact));
    EXPECT_NE(program_of(count), program_of(offsets));
    EXPECT_NE(program_of(count), program_of(alone));
    EXPECT_THROW(build({programs.kernel("image", "tonemap", {}, "-DCLGI_WIDTH=5"),
                        programs.kernel("image", "gather", {}, "-DCLGI_WIDTH=5")}),
                 DeviceError);
}

// Those of a unit are one program on PoCL, also where each is first needed by itself, and no others
// are: what PoCL keeps of them serves whoever asks for some of them.
TEST(Programs, AreThoseOfUnitsOnPocl) {
    const test::Device& on = test::device();
    const Programs programs(on.context, on.device);
    const std::vector<std::string> unit = {"count", "place", "upsample"};
    const PassKernel count = programs.kernel("image", "count", {}, "", unit),
                     place = programs.kernel("image", "place", {}, "", unit),
                     compact = programs.kernel("image", "compact"),
                     fast = programs.kernel("image", "place", {.math = Math::fast}, "", unit);
    const cl_program first = program_of(count);
    EXPECT_EQ(programs.built(), 1u);
    build({place, compact, fast});
    EXPECT_EQ(programs.built(), 4u);
    EXPECT_NE(program_of(compact), first);
    EXPECT_NE(program_of(fast), first);
    const cl::Platform platform(on.device.getInfo<CL_DEVICE_PLATFORM>());
    if (platform.getInfo<CL_PLATFORM_NAME>() != "Portable Computing Language")
        GTEST_SKIP() << "this driver builds several programs at a time";
    EXPECT_EQ(program_of(place), first);
    cl::Kernel beside(cl::Program(first, true), "image_upsample");
    EXPECT_EQ(beside.getInfo<CL_KERNEL_NUM_ARGS>() > 0, true);
}

TEST(Programs, AreBuiltForEachOwnerThatAsks) {
    const test::Device& on = test::device();
    const Programs one(on.context, on.device), other(on.context, on.device);
    build({one.kernel("image", "count"), other.kernel("image", "count"),
           one.kernel("image", "place")});
    EXPECT_EQ(one.built(), 2u);
    EXPECT_EQ(other.built(), 1u);
}

// Kernels of the folder "transfer" that would not build as one program do so each alone.
TEST(Programs, BuildAloneWhatDoesNotBuildTogether) {
    const Programs programs(test::device().context, test::device().device);
    const PassKernel mask = programs.kernel("transfer", "mask"),
                     bounce = programs.kernel("transfer", "bounce");
    build({mask, bounce});
    EXPECT_EQ(programs.built(), 2u);
    EXPECT_NE(program_of(mask), program_of(bounce));
    const Programs units(test::device().context, test::device().device);
    const std::vector<std::string> unit = {"mask", "bounce"};
    build({units.kernel("transfer", "mask", {}, "", unit),
           units.kernel("transfer", "bounce", {}, "", unit)});
    EXPECT_EQ(units.built(), 2u);
}

TEST(Programs, ShareKernelsThatAnOptionDoesNotChange) {
    const Programs programs(test::device().context, test::device().device);
    const auto same = [&](const char* folder, const char* pass, const BuildOptions& options,
                          const std::string& defines = "") {
        return programs.kernel(folder, pass, {}, "-DCLGI_BINS=32").slot ==
               programs.kernel(folder, pass, options, "-DCLGI_BINS=32" + defines).slot;
    };
    EXPECT_TRUE(same("antiradiance", "global", {.textures = false}));
    EXPECT_FALSE(same("gbuffer", "resolve", {.textures = false}));
    EXPECT_FALSE(same("antiradiance", "global", {.storage = Storage::half}));
    EXPECT_TRUE(same("antiradiance", "refit", {.storage = Storage::half}));
    EXPECT_FALSE(same("gbuffer", "raster", {.math = Math::fast}));
    EXPECT_TRUE(same("gbuffer", "raster", {}, " -DCLGI_SH_BANDS=5"));
    EXPECT_FALSE(same("gbuffer", "raster", {}, " -DCLGI_DEPTH_ONLY"));
    EXPECT_EQ(options_for("#if CLGI_WIDTH == 1", "-a -DCLGI_WIDTH=4 -DCLGI_BINS=32 -DCLGI_HALF -b"),
              "-a -DCLGI_WIDTH=4 -b");
}

CLGI_IN_ALL_MODES(KernelsOfEffects);

TEST_P(KernelsOfEffects, AreBuiltForTheEffectsOfASolverAlone) {
    const test::Device& on = test::device();
    const Scene world = cornell({.light = LightSource::spot});
    const DeviceScene scene = test::on_device(world);
    const auto built = [&](const SecondOrderOptions& options) {
        const Programs programs(on.context, on.device);
        SecondOrderSolver solver(programs, on.queue, scene, options);
        const std::size_t before = programs.built();
        solver.render(world.cameras[0]).wait();
        EXPECT_EQ(programs.built(), before);  // the first picture waits for no compiler
        return before;
    };
    SecondOrderOptions options;
    options.build = GetParam();
    options.width = 32;
    options.height = 24;
    options.emitters.vpls = 20;
    const std::size_t all = built(options);
    options.low_resolution_step = 1;
    const std::size_t full = built(options);
    options.indirect = false;
    const std::size_t direct = built(options);
    EXPECT_EQ(all - full, 6u);     // downsample, upsample, count, offsets, compact, place
    EXPECT_EQ(full - direct, 5u);  // accept_mask, accept_list, fetch, negative, gather
}

// Copies of a pass set arguments of one kernel: each must come out with its own.
TEST(Programs, ServeSeveralThreadsAtATime) {
    const test::Device& on = test::device();
    const ImagePasses passes(test::programs());
    constexpr std::uint32_t pixels = 4096, threads = 4, rounds = 50;
    std::vector<std::thread> workers;
    std::vector<int> wrong(threads);
    for (std::uint32_t t = 0; t < threads; ++t)
        workers.emplace_back([&, t, copy = passes] {
            const cl::CommandQueue queue(on.context, on.device);
            std::vector<cl_uchar> flags(pixels);
            for (std::uint32_t i = 0; i < pixels; ++i) flags[i] = i % (t + 2) == 0;
            const cl::Buffer source(on.context, flags.begin(), flags.end(), true);
            const cl::Buffer counts(on.context, CL_MEM_READ_WRITE, 8 * sizeof(cl_uint));
            for (std::uint32_t round = 0; round < rounds; ++round) {
                copy.count(queue, pixels, source, counts);
                cl_uint found[8];
                queue.enqueueReadBuffer(counts, CL_TRUE, 0, sizeof found, found);
                for (std::uint32_t block = 0; block < 8; ++block) {
                    cl_uint wanted = 0;
                    for (std::uint32_t i = 512 * block; i < 512 * block + 512; ++i)
                        wanted += flags[i];
                    wrong[t] += found[block] != wanted;
                }
            }
        });
    for (std::thread& worker : workers) worker.join();
    EXPECT_EQ(wrong, std::vector<int>(threads));
}

}  // namespace
}  // namespace clgi
