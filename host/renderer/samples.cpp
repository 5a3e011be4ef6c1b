// SPDX-License-Identifier: MIT
#include "renderer/samples.hpp"

#include <bit>
#include <cmath>
#include <vector>

#include "core/opencl/check.hpp"
#include "scene/luminance.hpp"

namespace clgi::renderer {
namespace {

// Of the mean of so many samples, a power of two.
std::uint32_t plane_before(std::uint32_t count) {
    return MEAN_BEFORE + static_cast<std::uint32_t>(std::countr_zero(count)) % 2;
}

// Of the first n points, n a power of two, one lies in each of n equal rectangles, whatever their
// shape [Sobol67].
std::uint32_t sobol(std::uint32_t index, int axis) {
    std::uint32_t out = 0;
    for (std::uint32_t column = 0x80000000u; index != 0; index >>= 1) {
        if (index & 1u) out ^= column;
        column = axis == 0 ? column >> 1 : column ^ (column >> 1);
    }
    return out;
}

std::uint32_t reversed(std::uint32_t bits) {
    bits = (bits & 0x55555555u) << 1 | (bits >> 1 & 0x55555555u);
    bits = (bits & 0x33333333u) << 2 | (bits >> 2 & 0x33333333u);
    bits = (bits & 0x0f0f0f0fu) << 4 | (bits >> 4 & 0x0f0f0f0fu);
    bits = (bits & 0x00ff00ffu) << 8 | (bits >> 8 & 0x00ff00ffu);
    return bits << 16 | bits >> 16;
}

// Flips each bit or not, at random, depending on the bits above it [Owen95], by a hash [Laine11].
std::uint32_t scrambled(std::uint32_t bits, std::uint32_t seed) {
    bits = reversed(bits) + seed;
    for (const std::uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u})
        bits ^= bits * factor;
    return reversed(bits);
}

}  // namespace

Camera sampled(const Camera& camera, std::uint32_t index) {
    // Among the best of 1500 pairs, by the error at edges of all directions, with 2 to 64 samples.
    constexpr std::uint32_t seeds[] = {0x0196deabu, 0xb262f0ccu};
    Camera out = camera;
    for (int axis = 0; axis < 2; ++axis) {
        // The same bits are flipped in all points, so that the first is the centre. That keeps the
        // rectangles.
        const std::uint32_t at =
            scrambled(sobol(index, axis), seeds[axis]) ^ scrambled(0, seeds[axis]);
        out.offset[axis] += static_cast<float>(static_cast<std::int32_t>(at)) * 0x1p-32f;
    }
    // The first picture stands alone. The mean of many has what each of them looks up: it is
    // blurred by no more than a quarter of a pixel.
    if (index > 0) out.footprint = camera.footprint / 16.0f;
    return out;
}

Samples::Samples(const Programs& programs, const cl::CommandQueue& queue)
    : programs_(programs), queue_(queue) {}

void Samples::build() {
    if (!passes_) passes_.emplace(programs_);
    passes_->build({"accumulate"});
}

void Samples::keep(const Radiance& first, std::size_t pixels, cl::Event& last) {
    if (count_ > 1) return;
    const std::size_t bytes = MEAN_PLANES * std::size_t{first.stride} * sizeof(float);
    if (bytes_ != bytes) {
        mean_ = cl::Buffer(programs_.context(), CL_MEM_READ_WRITE, bytes);
        bytes_ = bytes;
    }
    build();
    const WaitList wait = last() ? WaitList{last} : WaitList();
    queue_.enqueueFillBuffer(mean_, 0.0f, 0, bytes, &wait, &last);
    count_ = 0;
    last = add(first, pixels, last).event;
}

PassEvent Samples::add(const Radiance& sample, std::size_t pixels, const cl::Event& after) {
    const std::uint32_t kept = std::has_single_bit(count_) ? plane_before(count_) : 0;
    ++count_;
    const AccumulateParams params{static_cast<std::uint32_t>(pixels), sample.stride,
                                  1.0f / static_cast<float>(count_), kept};
    return {"image.accumulate", pixels,
            passes_->accumulate(queue_, params, sample.planes, mean_, {after})};
}

// Of n samples with an error e, independent of each other, the mean differs from that of the first
// h by e sqrt(n / h - 1); where errors fall as 1 / n, by e (n / h - 1). Halves of a Sobol sequence
// may agree by chance about the few pixels with most of an error, so both earlier means count:
// those of h = n / 2 and n / 4, or of the last two powers of two. It is on the safe side where
// errors fall as 1 / n, and rises for a moment after a power of two, where one sample alone is
// compared.
double Samples::error(std::size_t pixels, const cl::Event& last) const {
    const std::uint32_t half = std::bit_floor(count_ / 2),
                        other = std::has_single_bit(count_) ? half / 2 : 2 * half;
    const std::size_t stride = bytes_ / (MEAN_PLANES * sizeof(float));
    std::vector<float> planes(MEAN_PLANES * stride);
    const WaitList wait{last};
    queue_.enqueueReadBuffer(mean_, CL_TRUE, 0, bytes_, planes.data(), &wait);
    std::vector<double> means(pixels);
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        means[i] = luminance(glm::dvec3(planes[i], planes[stride + i], planes[2 * stride + i]));
        sum += means[i];
    }
    if (!(sum > 0.0)) return 0.0;
    const auto square_from = [&](std::uint32_t before) {
        const float* earlier = &planes[plane_before(before) * stride];
        double square = 0.0;
        for (std::size_t i = 0; i < pixels; ++i)
            square += (means[i] - earlier[i]) * (means[i] - earlier[i]);
        return square / (static_cast<double>(count_) / before - 1.0);
    };
    double square = square_from(half);
    if (other > 0) square = 0.5 * (square + square_from(other));
    const auto count = static_cast<double>(pixels);
    return std::sqrt(square / count) / (sum / count);
}

}  // namespace clgi::renderer
