// What every pass promises to a program that brings its own queue and buffers.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <set>

#include "device.hpp"
#include "opencl_calls.hpp"
#include "pass_chain.hpp"

namespace clgi {
namespace {

using test::calls;
using test::PassArgument;
using test::PassChain;
using test::PassStep;

cl::Buffer allocate(std::size_t bytes) {
    return cl::Buffer(test::device().context, CL_MEM_READ_WRITE, bytes);
}

PassChain make_chain(const PassChain::Allocate& how = allocate) {
    return PassChain(test::device().context, test::device().device, test::device().queue, how);
}

constexpr cl_command_queue_properties orders[] = {0, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE};
constexpr cl_command_queue_properties profilings[] = {0, CL_QUEUE_PROFILING_ENABLE};

using Bytes = std::vector<unsigned char>;

// A frame by passes on the tests' own queue, in buffers of exactly the size that each needs.
const Bytes& usual() {
    static const Bytes bytes = [] {
        const PassChain chain = make_chain();
        chain.enqueue(test::device().queue, {}).back().wait();
        return chain.contents(test::device().queue);
    }();
    return bytes;
}

TEST(Passes, MakeAFrameTogether) {
    const PassChain chain = make_chain();
    std::set<std::string> passes;
    for (const PassStep& step : chain.steps) passes.insert(step.pass);
    // All of them but those with tests of their own: other producers, and what a frame has no use
    // for.
    std::set<std::string> rest;
    for (std::string name : kernel_names()) {
        name.replace(name.find('/'), 1, ".");
        const bool apart = name.rfind("parallel.", 0) == 0 || name.rfind("scene.", 0) == 0 ||
                           name.rfind("vpl.", 0) == 0 || name.rfind("atlas.", 0) == 0 ||
                           name.rfind("transfer.", 0) == 0 || name.rfind("antiradiance.", 0) == 0 ||
                           name.rfind("cache.", 0) == 0 ||
                           name.find("_group") != std::string::npos;  // forms of others
        if (!passes.count(name) && !apart) rest.insert(name);
    }
    EXPECT_EQ(rest, (std::set<std::string>{
                        "gbuffer.cubes", "gbuffer.import_buffers", "gbuffer.import_images",
                        "gbuffer.raster_views", "gbuffer.surface", "gbuffer.trace_views",
                        "image.accumulate", "image.environment", "lights.direct"}));
    chain.enqueue(test::device().queue, {}).back().wait();
    const auto preview =
        test::download<cl_uint>(chain.buffers.at("preview"), PassChain::width * PassChain::height);
    std::set<cl_uint> colors(preview.begin(), preview.end());
    EXPECT_GT(colors.size(), 50u);
}

// Handles as a C program has them, wrapped; queues of every kind.
TEST(Passes, RunOnAnyQueueOfTheUser) {
    const cl_context context = test::device().context();
    const cl_device_id device = test::device().device();
    for (const cl_command_queue_properties order : orders)
        for (const cl_command_queue_properties profiling : profilings) {
            cl_int error = CL_SUCCESS;
            const cl_command_queue raw =
                clCreateCommandQueue(context, device, order | profiling, &error);
            ASSERT_EQ(error, CL_SUCCESS);
            std::vector<cl_mem> owned;
            {
                const cl::CommandQueue queue(raw, true);
                const PassChain chain(cl::Context(context, true), cl::Device(device, true), queue,
                                      [&](std::size_t bytes) {
                                          owned.push_back(clCreateBuffer(context, CL_MEM_READ_WRITE,
                                                                         bytes, nullptr, &error));
                                          return cl::Buffer(owned.back(), true);
                                      });
                chain.enqueue(queue, {}).back().wait();
                EXPECT_EQ(chain.contents(queue), usual()) << order << " " << profiling;
            }
            for (const cl_mem memory : owned) clReleaseMemObject(memory);
            clReleaseCommandQueue(raw);
        }
}

TEST(Passes, TakeSlicesAtOffsets) {
    const std::size_t alignment = slice_alignment(test::device().context);
    const cl::Buffer arena = allocate(16 << 20);
    test::device().queue.enqueueFillBuffer(arena, cl_uchar{0xa5}, 0, 16 << 20);
    std::size_t next = alignment;
    const PassChain chain = make_chain([&](std::size_t bytes) {
        const cl::Buffer part = slice(arena, next, bytes);
        next += (bytes + alignment - 1) / alignment * alignment + alignment;
        return part;
    });
    ASSERT_LT(next, std::size_t{16 << 20});
    chain.enqueue(test::device().queue, {}).back().wait();
    EXPECT_EQ(chain.contents(test::device().queue), usual());
    // Between the slices nothing was written.
    const auto all = test::download<unsigned char>(arena, 16 << 20);
    std::vector<bool> used(all.size());
    for (const auto& [name, buffer] : chain.buffers) {
        const std::size_t first = buffer.getInfo<CL_MEM_OFFSET>();
        for (std::size_t i = 0; i < buffer.getInfo<CL_MEM_SIZE>(); ++i) used[first + i] = true;
    }
    std::size_t touched = 0;
    for (std::size_t i = 0; i < all.size(); ++i) touched += !used[i] && all[i] != 0xa5;
    EXPECT_EQ(touched, 0u);
}

// Every argument of every pass: none at all, and a slice one byte short of a large buffer.
TEST(Passes, RefuseArgumentsTooSmallBeforeTheyEnqueue) {
    PassChain chain = make_chain();
    const cl::Buffer arena = allocate(1 << 20);
    std::size_t checked = 0;
    calls.clear();
    for (const PassStep& step : chain.steps)
        for (const PassArgument& argument : step.arguments) {
            const cl::Buffer right = chain.buffers.at(argument.buffer);
            for (const bool none : {true, false}) {
                const std::size_t held = none ? 0 : argument.needed - 1;
                chain.buffers[argument.buffer] = none ? cl::Buffer() : slice(arena, 0, held);
                try {
                    step.call(test::device().queue, {});
                    ADD_FAILURE() << step.pass << " took " << held << " bytes as " << argument.name;
                } catch (const Error& error) {
                    // Where one buffer serves two arguments, the first to be looked at is named.
                    EXPECT_EQ(std::string(error.what()),
                              step.pass + ": " + argument.name + " holds " + std::to_string(held) +
                                  " bytes, " + std::to_string(argument.needed) + " needed");
                    ++checked;
                }
            }
            chain.buffers[argument.buffer] = right;
        }
    EXPECT_GT(checked, 120u);
    EXPECT_EQ(calls.enqueued, 0);
}

TEST(Passes, AllocateNothingAndBlockNowhere) {
    const PassChain chain = make_chain();
    chain.enqueue(test::device().queue, {}).back().wait();  // the driver may prepare kernels once
    calls.clear();
    const WaitList events = chain.enqueue(test::device().queue, {});
    EXPECT_EQ(calls.enqueued, static_cast<int>(chain.steps.size()));
    EXPECT_EQ(calls.buffers, 0);
    EXPECT_EQ(calls.kernels, 0);
    EXPECT_EQ(calls.builds, 0);
    EXPECT_EQ(calls.blocking, 0);
    events.back().wait();
    EXPECT_EQ(calls.blocking, 1);  // the wait above: calls are seen
}

TEST(Passes, WaitForWhatTheyAreGiven) {
    for (const cl_command_queue_properties order : orders) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        const PassChain chain = make_chain();
        cl::UserEvent gate(test::device().context);
        const WaitList events = chain.enqueue(queue, {gate});
        for (const cl::Event& event : events)
            EXPECT_GT(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_RUNNING);
        gate.setStatus(CL_COMPLETE);
        events.back().wait();
        for (const cl::Event& event : events)
            EXPECT_EQ(event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE);
        EXPECT_EQ(chain.contents(queue), usual());
    }
}

TEST(Passes, LeaveTheUsersReferenceCountsAsTheyWere) {
    const cl::Context context(test::device().device);
    const cl::CommandQueue queue(context, test::device().device);
    const cl::UserEvent gate(context);
    const auto objects = [&] {
        return std::vector<cl_uint>{context.getInfo<CL_CONTEXT_REFERENCE_COUNT>(),
                                    queue.getInfo<CL_QUEUE_REFERENCE_COUNT>(),
                                    gate.getInfo<CL_EVENT_REFERENCE_COUNT>()};
    };
    const std::vector<cl_uint> before = objects();
    {
        std::vector<cl::Buffer> mine;
        for (int i = 0; i < 40; ++i) mine.emplace_back(context, CL_MEM_READ_WRITE, 1 << 17);
        {
            std::size_t next = 0;
            const PassChain chain(context, test::device().device, queue,
                                  [&](std::size_t) { return mine.at(next++); });
            const WaitList events = chain.enqueue(queue, {gate});
            cl::UserEvent(gate).setStatus(CL_COMPLETE);
            events.back().wait();
            queue.finish();
        }
        for (const cl::Buffer& buffer : mine)
            EXPECT_EQ(buffer.getInfo<CL_MEM_REFERENCE_COUNT>(), 1u);
    }
    // Not before the buffers are gone: a driver may keep with each the event of its last use, and
    // with that the queue.
    EXPECT_EQ(objects(), before);
}

TEST(Passes, OfOneContextRefuseTheQueueOfAnother) {
    const cl::Context other(test::device().device);
    const cl::CommandQueue queue(other, test::device().device);
    const PassChain chain = make_chain();
    EXPECT_THROW(chain.steps.front().call(queue, {}), Error);
    EXPECT_NO_THROW(chain.steps.front().call(test::device().queue, {}).wait());
}

TEST(Slice, NamesWhatItGotAndNeeded) {
    const std::size_t alignment = slice_alignment(test::device().context);
    const cl::Buffer buffer = allocate(4 * alignment);
    const auto message = [&](std::size_t first, std::size_t bytes) -> std::string {
        try {
            slice(buffer, first, bytes);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(alignment, 3 * alignment), "");
    EXPECT_NE(message(4, 8).find("byte 4, a multiple of " + std::to_string(alignment)),
              std::string::npos);
    EXPECT_NE(message(alignment, 3 * alignment + 1).find("within " + std::to_string(4 * alignment)),
              std::string::npos);
    EXPECT_NE(message(0, 0), "");
    EXPECT_NE(message(5 * alignment, 1), "");
    EXPECT_THROW(slice(cl::Buffer(), 0, 1), Error);
}

TEST(Slice, OfASliceIsAPartOfTheWhole) {
    const std::size_t alignment = slice_alignment(test::device().context);
    std::vector<unsigned char> values(8 * alignment);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<unsigned char>(i / 7);
    const cl::Buffer whole = test::upload(values);
    const cl::Buffer part = slice(slice(whole, 2 * alignment, 5 * alignment), alignment, 9);
    EXPECT_EQ(test::download<unsigned char>(part, 9),
              std::vector<unsigned char>(values.begin() + 3 * alignment,
                                         values.begin() + 3 * alignment + 9));
    EXPECT_EQ(slice_of<float>(whole, alignment / 4, 3).getInfo<CL_MEM_SIZE>(), 12u);
}

}  // namespace
}  // namespace clgi
