// SPDX-License-Identifier: MIT
#include "renderer/samples.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/opencl/check.hpp"
#include "scene/luminance.hpp"

namespace clgi::renderer {

Camera sampled(const Camera& camera, std::uint32_t index) {
    Camera out = camera;
    for (int axis = 0; axis < 2; ++axis) {
        const float at = radical_inverse(index, axis == 0 ? 2 : 3);
        out.offset[axis] += at < 0.5f ? at : at - 1.0f;
    }
    // The first picture stands alone. The mean of many has what each of them looks up: it is blurred by
    // no more than a quarter of a pixel.
    if (index > 0) out.footprint = camera.footprint / 16.0f;
    return out;
}

Samples::Samples(const Programs& programs, const cl::CommandQueue& queue)
    : programs_(programs), queue_(queue) {}

void Samples::keep(const Radiance& first, std::size_t pixels, cl::Event& last) {
    if (count_ > 1) return;
    const std::size_t bytes = MEAN_PLANES * std::size_t{first.stride} * sizeof(float);
    if (bytes_ != bytes) {
        mean_ = cl::Buffer(programs_.context(), CL_MEM_READ_WRITE, bytes);
        bytes_ = bytes;
    }
    if (!passes_) passes_.emplace(programs_);
    const WaitList wait = last() ? WaitList{last} : WaitList();
    queue_.enqueueFillBuffer(mean_, 0.0f, 0, bytes, &wait, &last);
    count_ = 0;
    last = add(first, pixels, last).event;
}

PassEvent Samples::add(const Radiance& sample, std::size_t pixels, const cl::Event& after) {
    ++count_;
    const AccumulateParams params{static_cast<std::uint32_t>(pixels), sample.stride,
                                  1.0f / static_cast<float>(count_), 0};
    return {"image.accumulate", pixels,
            passes_->accumulate(queue_, params, sample.planes, mean_, {after})};
}

double Samples::error(std::size_t pixels, const cl::Event& last) const {
    const std::size_t stride = bytes_ / (MEAN_PLANES * sizeof(float));
    std::vector<float> planes(MEAN_PLANES * stride);
    const WaitList wait{last};
    queue_.enqueueReadBuffer(mean_, CL_TRUE, 0, bytes_, planes.data(), &wait);
    double variance = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double mean =
            luminance(glm::dvec3(planes[i], planes[stride + i], planes[2 * stride + i]));
        variance += std::max(0.0, double{planes[MEAN_SQUARE * stride + i]} - mean * mean);
        sum += mean;
    }
    const auto count = static_cast<double>(pixels);
    return sum > 0.0 ? std::sqrt(variance / (count * (count_ - 1.0))) / (sum / count) : 0.0;
}

}  // namespace clgi::renderer
