// SPDX-License-Identifier: MIT
#include "lab/timing.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <string>

namespace clgi::lab {
namespace {

constexpr int peak_chains = 10, peak_steps = 20000;

// Ten chains: enough to cover the latency of two units, few enough for registers.
constexpr const char* peak_source = R"(
#define ALL(F) F(0) F(1) F(2) F(3) F(4) F(5) F(6) F(7) F(8) F(9)
#define BEGIN(i) T x##i = (T)(get_global_id(0) + (float)i);
#define STEP(i) x##i = fma(x##i, s, t);
#define ADD(i) + x##i
kernel void peak(global float* sink, float a, float b, int steps) {
    ALL(BEGIN)
    const T s = (T)(a), t = (T)(b);
    for (int i = 0; i < steps; ++i) { ALL(STEP) }
    const T sum = (T)(0.0f) ALL(ADD);
    sink[get_global_id(0)] = sum LANE;
}
)";

}  // namespace

std::vector<PassTime> pass_times(const std::vector<PassEvent>& events) {
    std::vector<PassTime> out;
    for (const PassEvent& pass : events) {
        const double ns =
            static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_END>()) -
            static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        auto same = std::find_if(out.begin(), out.end(),
                                 [&](const PassTime& time) { return time.name == pass.name; });
        if (same == out.end()) same = out.insert(out.end(), {pass.name, 0.0, 0});
        same->milliseconds += 1e-6 * ns;
        same->items += pass.items;
    }
    return out;
}

PeakMeter::PeakMeter(const cl::CommandQueue& queue)
    : queue_(queue),
      width_(packet_width(queue.getInfo<CL_QUEUE_DEVICE>())),
      items_(width_ == 1 ? 1 << 18 : 256) {
    const cl::Context context = queue.getInfo<CL_QUEUE_CONTEXT>();
    const std::string type = width_ == 1 ? " -DLANE=" : std::to_string(width_) + " -DLANE=.s0";
    cl::Program program(context, peak_source);
    program.build(("-cl-std=CL1.2 -DT=float" + type).c_str());
    kernel_ = cl::Kernel(program, "peak");
    sink_ = cl::Buffer(context, CL_MEM_WRITE_ONLY, items_ * sizeof(float));
    kernel_.setArg(0, sink_);
    kernel_.setArg(1, 0.999f);
    kernel_.setArg(2, 0.001f);
    kernel_.setArg(3, peak_steps);
    gflops();  // compiles and warms up
}

double PeakMeter::gflops() {
    cl::Event event;
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(items_),
                                cl::NDRange(width_ == 1 ? 64 : 4), nullptr, &event);
    event.wait();
    const double ns = static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                          event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    return 2.0 * peak_chains * peak_steps * width_ * static_cast<double>(items_) / ns;
}

}  // namespace clgi::lab
