// Sums of doubles in integers (kernels/scene/wide.clh) against the host's own, bit for bit.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <cstring>

#include "device.hpp"
#include "kernel_text.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

template <typename To, typename From>
To bits_of(From value) {
    static_assert(sizeof(To) == sizeof(From));
    To out;
    std::memcpy(&out, &value, sizeof out);
    return out;
}

struct Numbers {
    std::vector<double> first, second;
    std::vector<float> narrow;
};

// All kinds of numbers of a scene, and pairs that cancel, carry, and lie half-way between two.
Numbers numbers(std::size_t count) {
    test::Random random(3);
    const auto any = [&](int low, int high) {
        const double sign = random(-1, 1) < 0 ? -1.0 : 1.0;
        double fraction = random(1, 2);
        if (random(0, 1) < 0.3) fraction = std::round(fraction * 64) / 64;  // few digits: ties
        return std::ldexp(sign * fraction, random.integer(low, high));
    };
    Numbers out;
    for (std::size_t i = 0; i < count; ++i) {
        const double a = i % 16 == 0 ? any(-1060, -1000) : any(-70, 62);
        double b = any(-70, 62);
        if (i % 3 == 0) b = std::ldexp(any(-3, 3), std::ilogb(a));
        if (i % 5 == 0) b = -a * (1.0 + random.integer(-3, 3) * 0x1p-52);
        if (i % 7 == 0) b = std::ldexp(a, random.integer(-56, -51));  // half an ulp, or so
        if (i % 16 == 0) b = i % 32 == 0 ? any(-1070, -1010) : -a;
        out.first.push_back(a);
        out.second.push_back(b);
        out.narrow.push_back(i % 9 == 0 ? std::ldexp(1.0f + float(i % 64), -149 + int(i % 20))
                                        : static_cast<float>(i % 3 == 0 ? -a : b));
        if (!std::isfinite(out.narrow.back())) out.narrow.back() = 0.0f;
    }
    for (const double special :
         {0.0, -0.0, 0x1p-1074, 0x1.fffffep127, 0x1.ffffffp127, 0x1p128, 0x1p-149, 0x1.8p-149,
          0x1p-150, 0x1.8p-150, 0x1.fffffffp-127, 0x1.8p128})
        for (const double other : {0.0, -0.0, 1.0, -special}) {
            out.first.push_back(special);
            out.second.push_back(other);
            out.narrow.push_back(std::abs(other) > 1e38 ? 1.0f : static_cast<float>(other));
        }
    // A carry moves the last bit that was kept below one half of an ulp.
    for (const double sign : {1.0, -1.0}) {
        out.first.push_back(sign * 0x1.fffffffffffffp0);
        out.second.push_back(sign * 0x1.0000000000001p-51);
        out.narrow.push_back(0.0f);
    }
    return out;
}

TEST(WideSums, AreThoseOfDoublesToTheLastBit) {
    const Numbers n = numbers(1 << 20);
    const std::size_t count = n.first.size();
    const test::Device& on = test::device();
    for (const char* options : {"-cl-std=CL1.2", "-cl-std=CL1.2 -cl-fast-relaxed-math"})
        for (const int scale : {0, -3, 40, -100}) {
            cl::Program program(on.context, test::kernel_text("tests/support/wide.cl"));
            program.build(on.device, options);
            cl::Kernel kernel(program, "wide_sums");
            const cl::Buffer first = test::upload(n.first), second = test::upload(n.second),
                             narrow = test::upload(n.narrow);
            const cl::Buffer sums = test::empty<cl_ulong>(count),
                             widened = test::empty<cl_ulong>(count),
                             rounded = test::empty<cl_uint>(count);
            cl_uint index = 0;
            for (const cl::Buffer& buffer : {first, second, narrow}) kernel.setArg(index++, buffer);
            kernel.setArg(index++, cl_int{scale});
            for (const cl::Buffer& buffer : {sums, widened, rounded})
                kernel.setArg(index++, buffer);
            on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(count));
            const auto got_sums = test::download<cl_ulong>(sums, count);
            const auto got_widened = test::download<cl_ulong>(widened, count);
            const auto got_rounded = test::download<cl_uint>(rounded, count);
            std::size_t wrong = 0;
            for (std::size_t i = 0; i < count && wrong < 5; ++i) {
                const double a = n.first[i], b = n.second[i];
                const bool same =
                    got_sums[i] == bits_of<cl_ulong>(a + b) &&
                    got_widened[i] == bits_of<cl_ulong>(a + double{n.narrow[i]}) &&
                    got_rounded[i] == bits_of<cl_uint>(static_cast<float>(std::ldexp(a, scale)));
                wrong += !same;
                EXPECT_TRUE(same) << options << ", " << a << " and " << b << ", "
                                  << double{n.narrow[i]} << ", 2^" << scale << ": "
                                  << bits_of<double>(got_sums[i]) << ", "
                                  << bits_of<double>(got_widened[i]) << ", "
                                  << double{bits_of<float>(got_rounded[i])};
            }
        }
}

}  // namespace
}  // namespace clgi
