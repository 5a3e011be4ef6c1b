// What the solver promises to a program that it is part of: wait lists, one event, an interval,
// exact estimates, budgets, dispatches that can be cancelled, several devices.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>

#include "core/kit/ranges.hpp"
#include "drawing.hpp"
#include "frames.hpp"
#include "math_modes.hpp"
#include "opencl_calls.hpp"

namespace clgi {
namespace {

using test::calls;
using test::Frame;

SecondOrderOptions small() {
    SecondOrderOptions options;
    options.width = 61;
    options.height = 43;
    options.emitters = {.vpls = 120, .shadow_size = 64, .face_size = 32};
    options.negative_vpls = 40;
    return options;
}

const Scene& room() {
    static const Scene scene = cornell({.light = LightSource::spot});
    return scene;
}

const Frame& usual() {
    static const Frame frame = test::render(room(), room().cameras[0], small());
    return frame;
}

constexpr cl_command_queue_properties kinds[] = {
    CL_QUEUE_PROFILING_ENABLE, CL_QUEUE_PROFILING_ENABLE | CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE};

TEST(Embedding, AFrameBeginsAfterWhatItWaitsFor) {
    const DeviceScene scene = test::on_device(room());
    for (const cl_command_queue_properties kind : kinds) {
        const cl::CommandQueue queue(test::device().context, test::device().device, kind);
        SecondOrderSolver solver(test::programs(), queue, scene, small());
        for (int frame = 0; frame < 2; ++frame) {
            cl::UserEvent gate(test::device().context);
            calls.clear();
            const cl::Event done = solver.render(room().cameras[0], {gate});
            EXPECT_EQ(calls.blocking, 0);
            EXPECT_EQ(calls.buffers, 0);
            for (const PassEvent& pass : solver.events())
                EXPECT_GT(pass.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_RUNNING)
                    << pass.name;
            EXPECT_THROW(solver.interval(), Error);  // it has not ended
            gate.setStatus(CL_COMPLETE);
            done.wait();
            for (const PassEvent& pass : solver.events())
                EXPECT_EQ(pass.event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE)
                    << pass.name;
        }
        EXPECT_TRUE(
            test::same_bits(test::read_frame(queue, scene, solver).radiance, usual().radiance));
    }
}

TEST(Embedding, ABlackFrameWaitsToo) {
    Scene dark = room();
    dark.lights.clear();
    const DeviceScene scene = test::on_device(dark);
    SecondOrderSolver solver(test::device().queue, scene, small());
    cl::UserEvent gate(test::device().context);
    const cl::Event done = solver.render(dark.cameras[0], {gate});
    EXPECT_GT(done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_RUNNING);
    gate.setStatus(CL_COMPLETE);
    done.wait();
    EXPECT_GT(solver.interval().end, 0u);
}

TEST(Embedding, TheIntervalCoversEveryPassOfTheFrame) {
    const DeviceScene scene = test::on_device(room());
    for (const cl_command_queue_properties kind : kinds) {
        const cl::CommandQueue queue(test::device().context, test::device().device, kind);
        SecondOrderSolver solver(test::programs(), queue, scene, small());
        const cl::Event done = solver.render(room().cameras[0]);
        done.wait();
        const Interval whole = solver.interval();
        ASSERT_GT(solver.events().size(), 10u);
        for (const PassEvent& pass : solver.events()) {
            EXPECT_LE(whole.queued, pass.event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>());
            EXPECT_LE(whole.submitted, pass.event.getProfilingInfo<CL_PROFILING_COMMAND_SUBMIT>());
            EXPECT_LE(whole.start, pass.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
            EXPECT_GE(whole.end, pass.event.getProfilingInfo<CL_PROFILING_COMMAND_END>());
        }
        // The frame's event is that of its last command: it ends with the frame, and began later.
        EXPECT_EQ(whole.end, done.getProfilingInfo<CL_PROFILING_COMMAND_END>());
        EXPECT_LT(whole.start, done.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        EXPECT_LE(whole.queued, whole.start);
    }
}

TEST(Embedding, WithoutProfilingThereIsNoInterval) {
    const DeviceScene scene = test::on_device(room());
    const cl::CommandQueue queue(test::device().context, test::device().device);
    SecondOrderSolver solver(test::programs(), queue, scene, small());
    solver.render(room().cameras[0]).wait();
    EXPECT_THROW(solver.interval(), Error);
}

TEST(Embedding, TheEstimateIsWhatIsAllocated) {
    const DeviceScene scene = test::on_device(room());
    for (int variant = 0; variant < 5; ++variant) {
        SecondOrderOptions options = small();
        if (variant == 1) options.low_resolution_step = 1;
        if (variant == 2) options.indirect = false;
        if (variant == 3) options.negative_vpls = 0;
        if (variant == 4) options.width = 300;
        calls.clear();
        const SecondOrderSolver solver(test::device().queue, scene, options);
        EXPECT_EQ(static_cast<std::size_t>(calls.bytes), solver.bytes()) << variant;
        EXPECT_EQ(estimate(test::device().device, scene, options).bytes, solver.bytes()) << variant;
    }
}

std::string refusal(const DeviceScene& scene, const SecondOrderOptions& options) {
    try {
        SecondOrderSolver solver(test::programs(), test::device().queue, scene, options);
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "";
}

TEST(Embedding, ABudgetIsKeptAndNamesTheOptionToLower) {
    const DeviceScene scene = test::on_device(room());
    SecondOrderOptions options = small();
    options.memory_budget = estimate(test::device().device, scene, options).bytes;
    EXPECT_EQ(refusal(scene, options), "");
    --options.memory_budget;
    calls.clear();
    const std::string text = refusal(scene, options);
    EXPECT_EQ(calls.buffers, 0);
    EXPECT_NE(text.find("memory_budget allows"), std::string::npos) << text;
    EXPECT_NE(text.find("emitters.vpls"), std::string::npos) << text;
    options.emitters.shadow_size = 2048;
    EXPECT_NE(refusal(scene, options).find("emitters.shadow_size"), std::string::npos);
    options = small();
    options.emitters.vpls = 1 << 20;
    options.memory_budget = 10 << 20;
    EXPECT_NE(refusal(scene, options).find("emitters.vpls"), std::string::npos);
}

TEST(Embedding, ARefusedChangeLeavesTheSolverAsItWas) {
    const Scene world = room();
    const DeviceScene scene = test::on_device(world);
    const cl::CommandQueue& queue = test::device().queue;
    SecondOrderSolver solver(test::programs(), queue, scene, small());
    const auto picture = [&] {
        solver.render(world.cameras[0]).wait();
        return test::read_frame(queue, scene, solver).radiance;
    };
    const auto before = picture();
    SecondOrderOptions other = small();
    other.emitters.vpls = 7;
    other.memory_budget = 1000;
    EXPECT_THROW(solver.reconfigure(other), DeviceError);
    EXPECT_EQ(solver.options().emitters.vpls, small().emitters.vpls);
    EXPECT_TRUE(test::same_bits(picture(), before));
    other.memory_budget = 0;
    solver.reconfigure(other);
    EXPECT_FALSE(test::same_bits(picture(), before));
}

TEST(Embedding, ABufferLargerThanTheDeviceAllowsIsNamed) {
    const DeviceScene scene = test::on_device(room());
    SecondOrderOptions options = small();
    options.width = options.height = 16384;
    const std::size_t planes = std::size_t{GBUFFER_PLANES} * options.width * options.height * 4;
    if (planes <= test::device().device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>())
        GTEST_SKIP() << "the device takes buffers of 17 GB";
    calls.clear();
    const std::string text = refusal(scene, options);
    EXPECT_EQ(calls.buffers, 0);
    EXPECT_NE(text.find(" need "), std::string::npos) << text;
    EXPECT_NE(text.find("in one buffer"), std::string::npos) << text;
    EXPECT_NE(text.find("lower width and height"), std::string::npos) << text;
}

// ---- dispatches -----------------------------------------------------------------------------

TEST(Dispatches, CoverEveryItemOnce) {
    for (const std::size_t count : {0u, 1u, 255u, 4096u, 307200u})
        for (const double pairs : {1.0, 3e4, 1e6})
            for (const auto& speeds : {std::vector<double>{1e9}, {1e9, 1e9}, {4e9, 1e9, 2e9}}) {
                std::size_t next = 0;
                std::vector<double> work(speeds.size());
                for (const Share& share : deal(count, pairs, speeds)) {
                    EXPECT_EQ(share.range.first, next);
                    next += share.range.count;
                    work[share.worker] += static_cast<double>(share.range.count);
                    const double grain = 256.0 * pairs;
                    EXPECT_LE(pairs * static_cast<double>(share.range.count),
                              std::max(0.1 * speeds[share.worker], grain));
                }
                EXPECT_EQ(next, count);
                if (count < 100000) continue;
                for (std::size_t w = 1; w < speeds.size(); ++w)  // by speed
                    EXPECT_NEAR(work[w] / work[0], speeds[w] / speeds[0], 0.35);
            }
}

// So many lights that a frame is many dispatches, and still the frame of one.
TEST(Dispatches, OfManyLightsChangeNoBit) {
    const DeviceScene scene = test::on_device(room());
    SecondOrderOptions options = small();
    options.low_resolution_step = 1;
    options.width = 40;
    options.height = 30;
    options.emitters.vpls = 1 << 20;
    options.emitters.shadow_size = 64;
    options.negative_vpls = 3;
    options.emitters.face_size = 16;
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, options);
    std::vector<double> seen;
    ASSERT_TRUE(solver.run(room().cameras[0], [&](double done) {
        seen.push_back(done);
        return true;
    }));
    std::size_t gathers = 0;
    for (const PassEvent& pass : solver.events()) gathers += pass.name == "image.gather";
    if (gathers == 1 && !(test::device().device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU))
        GTEST_SKIP() << "one dispatch is short enough on this device";
    EXPECT_GT(gathers, 1u);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.front(), 0.0);
    EXPECT_EQ(seen.back(), 1.0);
    // The same gather as one dispatch.
    const auto pixels = static_cast<std::uint32_t>(options.width * options.height);
    const auto lights = static_cast<std::uint32_t>(solver.emitters().vpl_count);
    const std::size_t floats = IRRADIANCE_PLANES * std::size_t{solver.stride()};
    const cl::Buffer whole = test::empty<float>(floats);
    solver.image_passes().gather(test::device().queue, {solver.stride(), lights, 3, 0}, pixels,
                                 test::upload(std::vector<cl_uint>{pixels}), solver.planes(),
                                 solver.vpls(), solver.negative_vpls(), whole);
    const auto one = test::vectors(test::device().queue, whole, solver.stride(), pixels);
    const auto many =
        test::vectors(test::device().queue, solver.irradiance(), solver.stride(), pixels);
    EXPECT_TRUE(test::same_bits(one, many));
    float brightest = 0.0f;
    for (const glm::vec3& lit : many) brightest = std::max(brightest, lit.x);
    EXPECT_GT(brightest, 0.0f);

    // Cancelled between two of them: the rest is never enqueued.
    std::size_t calls_left = 0;
    const auto first_gather = [&](double done) { return done <= 0.4 || calls_left++ > 0; };
    EXPECT_FALSE(solver.run(room().cameras[0], first_gather));
    std::size_t begun = 0;
    for (const PassEvent& pass : solver.events()) begun += pass.name == "image.gather";
    EXPECT_LT(begun, gathers);
    EXPECT_NE(solver.events().back().name, "image.combine");
}

CLGI_IN_ALL_MODES(DispatchesOfParts);

TEST_P(DispatchesOfParts, OfARangeTouchNothingBesideIt) {
    const DeviceScene scene = test::on_device(room());
    SecondOrderOptions options = small();
    options.build = GetParam();
    options.low_resolution_step = 1;
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, options);
    solver.render(room().cameras[0]).wait();
    const std::size_t floats = IRRADIANCE_PLANES * std::size_t{solver.stride()};
    const cl::Buffer part = test::upload_irradiance(std::vector<float>(floats, -7.0f));
    const auto gather = [&](const Range& range) {
        solver.image_passes().gather(test::device().queue, {solver.stride(), 120, 40, 0}, range,
                                     test::upload(std::vector<cl_uint>{61 * 43}), solver.planes(),
                                     solver.vpls(), solver.negative_vpls(), part);
    };
    gather({512, 96});
    const auto found = test::read_irradiance(part, solver.stride());
    const auto full = test::read_irradiance(solver.irradiance(), solver.stride());
    for (std::size_t p = 0; p < solver.stride(); ++p)
        EXPECT_EQ(found[p], p >= 512 && p < 608 ? full[p] : -7.0f) << p;
    EXPECT_THROW(gather({8, 16}), Error);
    EXPECT_THROW(gather({0, solver.stride() + 16u}), Error);
}

// ---- several devices ------------------------------------------------------------------------

struct Pair {
    std::vector<cl::Device> devices;
    cl::Context context;
    std::vector<cl::CommandQueue> queues;
};

// Two halves of the device; empty where it cannot be divided.
Pair halves(cl_command_queue_properties kind) {
    Pair out;
    const cl_device_partition_property by_one[] = {CL_DEVICE_PARTITION_EQUALLY, 1, 0};
    try {
        cl::Device(test::device().device).createSubDevices(by_one, &out.devices);
    } catch (const cl::Error&) {
        return {};
    }
    if (out.devices.size() < 2) return {};
    out.devices.resize(2);
    out.context = cl::Context(out.devices);
    for (const cl::Device& device : out.devices) out.queues.emplace_back(out.context, device, kind);
    return out;
}

TEST(SeveralDevices, GiveTheBitsOfOne) {
    for (const cl_command_queue_properties kind : kinds) {
        const Pair pair = halves(kind);
        if (pair.devices.empty()) GTEST_SKIP() << "the device has no two parts";
        const DeviceScene scene(pair.context, pair.devices[0], room());
        for (const int step : {1, 4}) {
            SecondOrderOptions options = small();
            options.low_resolution_step = step;
            options.width = 211;
            options.height = 157;
            const auto own = std::vector<cl::CommandQueue>{pair.queues[1]};
            SecondOrderSolver together(pair.queues[0], scene, options, own);
            EXPECT_EQ(together.bytes(), estimate(pair.devices[0], scene, options, 2).bytes);
            for (int frame = 0; frame < 2; ++frame) together.render(room().cameras[0]).wait();
            SecondOrderSolver alone(pair.queues[0], scene, options);
            alone.render(room().cameras[0]).wait();
            const Frame a = test::read_frame(pair.queues[0], scene, together);
            const Frame b = test::read_frame(pair.queues[0], scene, alone);
            EXPECT_TRUE(test::same_bits(a.radiance, b.radiance)) << step;
            EXPECT_TRUE(test::same_bits(a.irradiance, b.irradiance)) << step;
            EXPECT_GT(a.radiance[a.pixels / 2].x, 0.0f);
            std::size_t collected = 0;
            for (const PassEvent& pass : together.events())
                if (pass.name == "image.collect") collected += pass.items;
            EXPECT_GT(collected, a.pixels / 64);  // the other device had a share
        }
    }
}

TEST(SeveralDevices, MustShareAContext) {
    const DeviceScene scene = test::on_device(room());
    const cl::Context other(test::device().device);
    const cl::CommandQueue stranger(other, test::device().device);
    EXPECT_THROW(SecondOrderSolver(test::device().queue, scene, small(), {stranger}), Error);
}

}  // namespace
}  // namespace clgi
