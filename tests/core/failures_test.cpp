// What fails fails with its own message, leaves nothing half done, and what comes after works: the
// same scene is rendered after every failure.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <chrono>
#include <clgi/procedural.hpp>
#include <functional>
#include <thread>

#include "frames.hpp"
#include "math_modes.hpp"
#include "opencl_calls.hpp"

namespace clgi {
namespace {

using test::calls;

const Scene& failing_room() {
    static const Scene scene = cornell({.light = LightSource::spot});
    return scene;
}

SecondOrderOptions failing_frame() {
    SecondOrderOptions options;
    options.build = test::usual_build();
    options.width = 48;
    options.height = 36;
    options.emitters = {.vpls = 60, .shadow_size = 64};
    options.negative_vpls = 20;
    return options;
}

std::vector<glm::vec3> picture() {
    return test::render(failing_room(), failing_room().cameras[0], failing_frame()).radiance;
}

// With every kind of light.
Scene box_of_light() {
    Scene scene = cornell({.light = LightSource::spot});
    scene.environment = Environment{};
    return scene;
}

class Failures : public testing::Test {
protected:
    void SetUp() override {
        calls.clear();
        before_ = picture();
    }
    void TearDown() override {
        calls.clear();
        EXPECT_TRUE(test::same_bits(picture(), before_));  // the library is usable afterwards
    }

    // The text of the DeviceError that `work` ends with.
    static std::string failure(const std::function<void()>& work) {
        try {
            work();
        } catch (const DeviceError& error) {
            return error.what();
        }
        ADD_FAILURE() << "nothing failed";
        return "";
    }

    static void expect_in(const std::string& text, std::initializer_list<const char*> parts) {
        for (const char* part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
    }

private:
    std::vector<glm::vec3> before_;
};

TEST_F(Failures, OfFindingADevice) {
    calls.fail_devices = CL_DEVICE_NOT_FOUND;
    expect_in(failure([] { choose_device(); }), {"no OpenCL device on any platform"});
    calls.fail_devices = CL_SUCCESS;
    expect_in(failure([] { choose_device("nobody::"); }),
              {"nothing matches \"nobody::\"", "there is"});
    EXPECT_THROW(choose_device(":TPU"), Error);
}

TEST_F(Failures, OfACompilerShowItsLog) {
    calls.build_option = " -Dkernel=no_such_word";
    expect_in(failure([] {
                  GBufferPasses(test::device().context, test::device().device).build({"clear"});
              }),
              {"gbuffer/clear.cl does not build on", "CL_BUILD_PROGRAM_FAILURE", "no_such_word"});
}

TEST_F(Failures, OfMemoryNameTheBuffer) {
    const DeviceScene scene = test::on_device(failing_room());
    for (const int which : {1, 7, 20}) {
        calls.fail_buffer = which;
        calls.code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
        expect_in(failure([&] { SecondOrderSolver(test::device().queue, scene, failing_frame()); }),
                  {"second-order: no room for a buffer of", "out of device memory",
                   "CL_MEM_OBJECT_ALLOCATION_FAILURE"});
    }
    calls.fail_buffer = 2;
    expect_in(failure([] { test::on_device(failing_room()); }),
              {"scene: no room for positions", "out of device memory"});
}

// Whichever pass it is that the device is lost before, the solver itself goes on afterwards.
TEST_F(Failures, BetweenPassesNameThePass) {
    const DeviceScene scene = test::on_device(failing_room());
    const auto expect_names = [&](cl_command_queue_properties order) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        SecondOrderSolver solver(test::programs(), queue, scene, failing_frame());
        solver.render(failing_room().cameras[0]).wait();
        const auto whole = test::read_frame(queue, scene, solver).radiance;
        std::vector<std::string> names;
        for (const PassEvent& pass : solver.events()) names.push_back(pass.name);
        for (std::size_t pass = 0; pass < names.size(); ++pass) {
            calls.fail_enqueue = static_cast<int>(pass) + 1;
            calls.code = pass % 2 == 0 ? CL_DEVICE_NOT_AVAILABLE : CL_OUT_OF_RESOURCES;
            const std::string text = failure([&] { solver.render(failing_room().cameras[0]); });
            const std::string kernel =
                names[pass] == "image.gather_low" ? "image.gather" : names[pass];
            EXPECT_EQ(text.rfind(kernel + ": clEnqueueNDRangeKernel failed: the device ", 0), 0u)
                << text;
            EXPECT_EQ(solver.events().size(), pass);
            solver.render(failing_room().cameras[0]).wait();
            EXPECT_TRUE(test::same_bits(test::read_frame(queue, scene, solver).radiance, whole))
                << names[pass];
        }
    };
    expect_names(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    for (const BuildOptions& build :
         {BuildOptions{}, BuildOptions{.math = Math::fast}, {.storage = Storage::half}}) {
        const test::UsualBuild usual(build);
        expect_names(0);
    }
}

// Every call that makes a buffer and every one that enqueues a kernel, with one of the codes that
// a driver may answer, in turn: an error in one line, and what was made before it is given back.
TEST_F(Failures, OfAnyCallLeaveNothingBehind) {
    const cl_int codes[] = {CL_DEVICE_NOT_AVAILABLE,  CL_MEM_OBJECT_ALLOCATION_FAILURE,
                            CL_OUT_OF_RESOURCES,      CL_OUT_OF_HOST_MEMORY,
                            CL_INVALID_COMMAND_QUEUE, CL_INVALID_WORK_GROUP_SIZE,
                            CL_INVALID_BUFFER_SIZE,   -9999};
    const Scene scene = box_of_light();
    const DeviceScene placed = test::on_device(scene);
    const BakeLayout bake = make_bake_layout(scene, {.count = 20}, {.size = 16});
    const cl::CommandQueue& queue = test::device().queue;
    const auto references = [] {
        return test::device().context.getInfo<CL_CONTEXT_REFERENCE_COUNT>();
    };
    // The driver lets go of what commands held a moment after they ended.
    const auto wait_until = [&](const std::function<bool()>& done) {
        queue.finish();
        for (int wait = 0; wait < 200 && !done(); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
    };
    const std::function<void()> solvers[] = {
        [&] {
            SecondOrderSolver solver(test::programs(), queue, placed, failing_frame());
            solver.render(failing_room().cameras[0]).wait();
        },
        [&] { LightAtlasSolver(test::programs(), queue, placed, bake.vpls, bake.atlas).run(); },
        [&] { DynamicTransferSolver(test::programs(), queue, scene, placed).run(); },
        [&] {
            AntiradianceOptions options;
            options.bins = 32;
            options.elements.requested = 40;
            options.steps = 3;
            AntiradianceSolver(test::programs(), queue, scene, placed, options).run();
        }};
    for (const std::function<void()>& work : solvers) {
        work();
        calls.clear();
        work();
        const int buffers = calls.buffers, enqueued = calls.enqueued;
        cl_uint before = references();
        int same = 0;  // for 100 ms
        wait_until([&] {
            const cl_uint now = references();
            same = now == before ? same + 1 : 0;
            before = now;
            return same > 20;
        });
        std::size_t code = 0;
        for (int k = 1; k <= buffers + enqueued; ++k) {
            (k <= buffers ? calls.fail_buffer : calls.fail_enqueue) =
                k <= buffers ? k : k - buffers;
            calls.code = codes[code++ % std::size(codes)];
            try {
                work();
                ADD_FAILURE() << "nothing failed";
            } catch (const Error& error) {  // a queue that is none is a wrong call
                const std::string text = error.what();
                EXPECT_EQ(text.find('\n'), std::string::npos) << text;
            }
            calls.clear();
            wait_until([&] { return references() == before; });
            EXPECT_EQ(references(), before) << k;
        }
        EXPECT_GT(buffers, 10);
        EXPECT_GT(enqueued, 5);
    }
}

// What a frame waits for may fail long after the call.
TEST_F(Failures, OfWhatAFrameWaitsForEndThatFrameOnly) {
    const DeviceScene scene = test::on_device(failing_room());
    for (const cl_command_queue_properties order :
         {cl_command_queue_properties{0},
          cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE}}) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        SecondOrderSolver solver(test::programs(), queue, scene, failing_frame());
        solver.render(failing_room().cameras[0]).wait();
        const auto whole = test::read_frame(queue, scene, solver).radiance;
        cl::UserEvent gate(test::device().context);
        const cl::Event done = solver.render(failing_room().cameras[0], {gate});
        gate.setStatus(CL_DEVICE_NOT_AVAILABLE);
        EXPECT_THROW(done.wait(), cl::Error);
        EXPECT_LT(done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), 0);
        ASSERT_TRUE(solver.run(failing_room().cameras[0], [](double) { return true; }));
        EXPECT_TRUE(test::same_bits(test::read_frame(queue, scene, solver).radiance, whole));
    }
}

}  // namespace
}  // namespace clgi
