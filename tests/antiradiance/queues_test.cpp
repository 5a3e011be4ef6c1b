// Two queues: what one waits for on the other is on its way, since a queue that nobody flushes need
// never begin.
// SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <chrono>
#include <clgi/advanced/antiradiance_view.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <set>
#include <thread>

#include "rooms.hpp"
#include "solved_antiradiance.hpp"

namespace {

// Queues that were flushed, of this program.
std::set<cl_command_queue>& flushed() {
    static std::set<cl_command_queue> out;
    return out;
}

}  // namespace

// Stands between clgi and the loader, as in tests/support/opencl_calls.hpp: some drivers begin
// without being flushed, so that waiting alone would not tell.
extern "C" cl_int clFlush(cl_command_queue queue) {
    flushed().insert(queue);
    return reinterpret_cast<decltype(&clFlush)>(dlsym(RTLD_NEXT, "clFlush"))(queue);
}

namespace clgi {
namespace {

// Whether an event completes within some time, with nothing but looking at it.
bool ends(const cl::Event& event) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() != CL_COMPLETE) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

struct TwoQueues {
    cl::CommandQueue first{test::device().context, test::device().device};
    cl::CommandQueue second{test::device().context, test::device().device};
    cl::Buffer here = test::empty<cl_uint>(16), there = test::empty<cl_uint>(16);
    Recorder one{first, "one"}, two{second, "two"};
    ~TwoQueues() { first.flush(), second.finish(); }
};

// A sequence flushes the queues of what it waits for; its own is its user's to flush.
TEST(RecorderQueues, ASequenceFlushesTheQueuesThatItWaitsFor) {
    TwoQueues of;
    flushed().clear();
    of.one.fill(of.here, 7);
    of.two.begin({of.one.last()});
    of.two.fill(of.there, 8);
    EXPECT_EQ(flushed(), std::set{of.first()});
    of.second.flush();
    EXPECT_TRUE(ends(of.two.last()));
    EXPECT_TRUE(ends(of.one.last()));
}

// So does a pass on another queue that stands in the middle of a sequence.
TEST(RecorderQueues, APassBesideIsFlushed) {
    TwoQueues of;
    flushed().clear();
    of.one.fill(of.here, 7);
    of.two.begin({});
    of.two.beside("fill", 1, of.one.last());
    of.two.fill(of.there, 8);
    EXPECT_EQ(flushed(), std::set{of.first()});
    of.second.flush();
    EXPECT_TRUE(ends(of.two.last()));
}

// Events of users are on no queue.
TEST(RecorderQueues, AUsersEventIsWaitedForAsWell) {
    TwoQueues of;
    flushed().clear();
    cl::UserEvent gate(test::device().context);
    of.two.begin({gate});
    of.two.fill(of.there, 8);
    EXPECT_TRUE(flushed().empty());
    of.second.flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_NE(of.two.last().getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_COMPLETE);
    gate.setStatus(CL_COMPLETE);
    EXPECT_TRUE(ends(of.two.last()));
}

// What a view waits for is flushed by the view: nobody else may do so before the picture is waited
// for, and its solver's queue is idle.
TEST(AntiradianceQueues, OfAViewAndItsSolverMayBeTwo) {
    const test::Device& on = test::device();
    const cl::CommandQueue first(on.context, on.device), second(on.context, on.device);
    const Scene scene = test::furnished_room(5);
    const DeviceScene device = test::on_device(scene);
    AntiradianceOptions options = test::options_of(test::usual_build(), 64, 200);
    options.steps = 2;
    AntiradianceSolver solver(test::programs(), first, scene, device, options);
    ASSERT_TRUE(solver.run());
    PictureOptions shown;
    shown.width = shown.height = 16;
    AntiradianceView view(test::programs(), second, device, solver, shown);
    const Camera camera = test::camera_at({1.5, 1.2, 1.0}, {0.2, 0.5, 0.1});
    view.render(camera).wait();  // everything is built
    flushed().clear();
    solver.lights_changed();  // enqueues writes that nobody flushes
    const cl::Event picture = view.render(camera);
    EXPECT_TRUE(flushed().count(first()));
    second.flush();
    EXPECT_TRUE(ends(picture)) << "the picture waits for a queue that was never flushed";
    first.flush();  // so that the test ends
}

}  // namespace
}  // namespace clgi
