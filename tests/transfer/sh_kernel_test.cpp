// Spherical harmonics in kernels are those of the host.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/sh.hpp>
#include <numbers>

#include "device.hpp"
#include "kernel_text.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr std::size_t stride = 4096;

// Poles, axes and random directions: [3][stride].
std::vector<float> directions() {
    std::vector<glm::vec3> list = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    test::Random random(1);
    while (list.size() < stride) {
        const double z = random(-1, 1), turn = random(0, 2 * std::numbers::pi);
        const double ring = std::sqrt(1 - z * z);
        list.emplace_back(ring * std::cos(turn), ring * std::sin(turn), z);
    }
    std::vector<float> planes;
    for (int c = 0; c < 3; ++c)
        for (const glm::vec3& s : list) planes.push_back(s[c]);
    return planes;
}

// [terms][stride]
std::vector<float> on_device(const std::vector<float>& planes, const std::string& options,
                             int width, std::size_t terms) {
    const test::Device& on = test::device();
    cl::Program program(on.context, test::kernel_text("tests/support/sh.cl"));
    // The compiler remarks on packets that are wider than the processor's registers (core/Kernels).
    const bool narrow =
        on.device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() < static_cast<cl_uint>(width);
    program.build(on.device, ("-cl-std=CL1.2 " + std::string(narrow ? "" : "-Werror ") +
                              "-DCLGI_WIDTH=" + std::to_string(width) + options)
                                 .c_str());
    cl::Kernel kernel(program, "sh");
    const cl::Buffer given = test::upload(planes);
    const cl::Buffer values = test::empty<float>(terms * stride);
    kernel.setArg(0, static_cast<cl_uint>(stride));
    kernel.setArg(1, given);
    kernel.setArg(2, values);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange,
                                  cl::NDRange(stride / static_cast<std::size_t>(width)));
    return test::download<float>(values, terms * stride);
}

double farthest_from_host(const std::vector<float>& planes, const std::vector<float>& found,
                          int bands) {
    double worst = 0.0;
    for (std::size_t k = 0; k < stride; ++k) {
        const std::vector<double> wanted =
            sh::evaluate(glm::dvec3(planes[k], planes[stride + k], planes[2 * stride + k]), bands);
        for (std::size_t i = 0; i < wanted.size(); ++i)
            worst = std::max(worst, std::abs(found[i * stride + k] - wanted[i]));
    }
    return worst;
}

TEST(ShKernels, HaveTheBasisOfTheHostAtEveryWidth) {
    const std::vector<float> planes = directions();
    std::vector<float> first;
    for (const int width : test::widths()) {
        const auto found = on_device(planes, "", width, 25);
        EXPECT_LT(farthest_from_host(planes, found, 5), 6e-7) << width;
        if (first.empty()) first = found;
        EXPECT_TRUE(found == first) << width;
    }
}

TEST(ShKernels, HaveAnyNumberOfBands) {
    const std::vector<float> planes = directions();
    for (const int bands : {1, 2, 3, 8, 9})
        for (const char* math : {"", " -cl-fast-relaxed-math"}) {
            const auto terms = static_cast<std::size_t>(sh::terms(bands));
            const auto found =
                on_device(planes, " -DCLGI_SH_BANDS=" + std::to_string(bands) + math, 8, terms);
            EXPECT_LT(farthest_from_host(planes, found, bands), 2e-6) << bands << math;
            for (std::size_t pole = 0; pole < 2; ++pole)
                for (int l = 0; l < bands; ++l)
                    for (int m = -l; m <= l; ++m)
                        if (m != 0) {
                            EXPECT_EQ(
                                found[static_cast<std::size_t>(sh::index(l, m)) * stride + pole],
                                0.0f);
                        }
        }
}

}  // namespace
}  // namespace clgi
