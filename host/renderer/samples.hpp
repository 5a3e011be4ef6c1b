// The samples of a picture: views through other points of its pixels, and their mean.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/image.hpp>
#include <clgi/scene.hpp>
#include <optional>

#include "renderer/methods.hpp"

namespace clgi::renderer {

// The camera that looks through the point of sample `index` in every pixel: the centre for 0, then
// the other points of a scrambled Sobol sequence. Their mean is a picture through the box filter of
// one pixel.
Camera sampled(const Camera& camera, std::uint32_t index);

class Samples {
public:
    Samples(const Programs& programs, const cl::CommandQueue& queue);

    void build();  // its kernel

    // A picture of one sample so far.
    void begin(const Camera& camera) {
        camera_ = camera;
        count_ = 1;
    }
    void forget() { count_ = 0; }
    std::uint32_t count() const { return count_; }
    const Camera& camera() const { return camera_; }

    // Keeps the only sample as the mean, where there is one, before the next is drawn into the same
    // planes. last: event of the picture, then of the mean.
    void keep(const Radiance& first, std::size_t pixels, cl::Event& last);
    // The next sample into the mean.
    PassEvent add(const Radiance& sample, std::size_t pixels, const cl::Event& after);

    // Renderer::sampling_error(), of two samples or more.
    double error(std::size_t pixels, const cl::Event& last) const;

    // The mean of two samples or more.
    const cl::Buffer& mean() const { return mean_; }
    std::size_t bytes() const { return bytes_; }

private:
    const Programs& programs_;
    const cl::CommandQueue& queue_;
    std::optional<ImagePasses> passes_;
    cl::Buffer mean_;  // [MEAN_PLANES][stride]
    std::size_t bytes_ = 0;
    Camera camera_;
    std::uint32_t count_ = 0;
};

}  // namespace clgi::renderer
