// SPDX-License-Identifier: MIT
#include "lab/peak.hpp"

#include <clgi/device.hpp>
#include <string>

namespace clgi::lab {
namespace {

constexpr int chains = 10;  // enough to cover the latency of two units, few enough for registers
constexpr int steps = 20000;

std::string source(int width) {
    const std::string type = width == 1 ? "float" : "float" + std::to_string(width);
    std::string text = "kernel void peak(global float* sink, float a, float b) {\n";
    for (int i = 0; i < chains; ++i)
        text += type + " x" + std::to_string(i) + " = (" + type + ")(get_global_id(0) + " +
                std::to_string(i) + ".0f);\n";
    text += type + " s = (" + type + ")(a), t = (" + type + ")(b);\n";
    text += "for (int i = 0; i < " + std::to_string(steps) + "; ++i) {\n";
    for (int i = 0; i < chains; ++i) {
        const std::string x = "x" + std::to_string(i);
        text += x + " = fma(" + x + ", s, t);\n";
    }
    text += "}\n" + type + " sum = x0";
    for (int i = 1; i < chains; ++i) text += " + x" + std::to_string(i);
    text += ";\nsink[get_global_id(0)] = sum" + std::string(width == 1 ? "" : ".s0") + ";\n}\n";
    return text;
}

}  // namespace

PeakMeter::PeakMeter(const cl::CommandQueue& queue)
    : queue_(queue),
      width_(packet_width(queue.getInfo<CL_QUEUE_DEVICE>())),
      items_(width_ == 1 ? 1 << 18 : 256) {
    const cl::Context context = queue.getInfo<CL_QUEUE_CONTEXT>();
    cl::Program program(context, source(width_));
    program.build("-cl-std=CL1.2");
    kernel_ = cl::Kernel(program, "peak");
    sink_ = cl::Buffer(context, CL_MEM_WRITE_ONLY, items_ * sizeof(float));
    kernel_.setArg(0, sink_);
    kernel_.setArg(1, 0.999f);
    kernel_.setArg(2, 0.001f);
    gflops();  // compiles and warms up
}

double PeakMeter::gflops() {
    cl::Event event;
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(items_),
                                cl::NDRange(width_ == 1 ? 64 : 4), nullptr, &event);
    event.wait();
    const double ns = static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                          event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    return 2.0 * chains * steps * width_ * static_cast<double>(items_) / ns;
}

}  // namespace clgi::lab
