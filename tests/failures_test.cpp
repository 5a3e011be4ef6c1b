// What fails fails with its own message, leaves nothing half done, and what comes after works: the
// same scene is rendered after every failure.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <functional>

#include "frames.hpp"
#include "opencl_calls.hpp"

namespace clgi {
namespace {

using test::calls;

const Scene& room() {
    static const Scene scene = cornell({.light = LightSource::spot});
    return scene;
}

SecondOrderOptions small() {
    SecondOrderOptions options;
    options.width = 48;
    options.height = 36;
    options.emitters = {.vpls = 60, .shadow_size = 64};
    options.negative_vpls = 20;
    return options;
}

std::vector<glm::vec3> picture() {
    return test::render(room(), room().cameras[0], small()).radiance;
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
    const DeviceScene scene = test::on_device(room());
    for (const int which : {1, 7, 20}) {
        calls.fail_buffer = which;
        calls.code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
        expect_in(failure([&] { SecondOrderSolver(test::device().queue, scene, small()); }),
                  {"second-order: no room for a buffer of", "out of device memory",
                   "CL_MEM_OBJECT_ALLOCATION_FAILURE"});
    }
    calls.fail_buffer = 2;
    expect_in(failure([] { test::on_device(room()); }),
              {"scene: no room for positions", "out of device memory"});
}

// Whichever pass it is that the device is lost before, the solver itself goes on afterwards.
TEST_F(Failures, BetweenPassesNameThePass) {
    const DeviceScene scene = test::on_device(room());
    for (const cl_command_queue_properties order :
         {cl_command_queue_properties{0},
          cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE}}) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        SecondOrderSolver solver(queue, scene, small());
        solver.render(room().cameras[0]).wait();
        const auto whole = test::read_frame(queue, scene, solver).radiance;
        std::vector<std::string> names;
        for (const PassEvent& pass : solver.events()) names.push_back(pass.name);
        for (std::size_t pass = 0; pass < names.size(); ++pass) {
            calls.fail_enqueue = static_cast<int>(pass) + 1;
            calls.code = pass % 2 == 0 ? CL_DEVICE_NOT_AVAILABLE : CL_OUT_OF_RESOURCES;
            const std::string text = failure([&] { solver.render(room().cameras[0]); });
            const std::string kernel =
                names[pass] == "image.gather_low" ? "image.gather" : names[pass];
            EXPECT_EQ(text.rfind(kernel + ": clEnqueueNDRangeKernel failed: the device ", 0), 0u)
                << text;
            EXPECT_EQ(solver.events().size(), pass);
            solver.render(room().cameras[0]).wait();
            EXPECT_TRUE(test::same_bits(test::read_frame(queue, scene, solver).radiance, whole))
                << names[pass];
        }
    }
}

// What a frame waits for may fail long after the call.
TEST_F(Failures, OfWhatAFrameWaitsForEndThatFrameOnly) {
    const DeviceScene scene = test::on_device(room());
    for (const cl_command_queue_properties order :
         {cl_command_queue_properties{0},
          cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE}}) {
        const cl::CommandQueue queue(test::device().context, test::device().device, order);
        SecondOrderSolver solver(queue, scene, small());
        solver.render(room().cameras[0]).wait();
        const auto whole = test::read_frame(queue, scene, solver).radiance;
        cl::UserEvent gate(test::device().context);
        const cl::Event done = solver.render(room().cameras[0], {gate});
        gate.setStatus(CL_DEVICE_NOT_AVAILABLE);
        EXPECT_THROW(done.wait(), cl::Error);
        EXPECT_LT(done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), 0);
        ASSERT_TRUE(solver.run(room().cameras[0], [](double) { return true; }));
        EXPECT_TRUE(test::same_bits(test::read_frame(queue, scene, solver).radiance, whole));
    }
}

}  // namespace
}  // namespace clgi
