// One random path's light at a pixel or a place.
// SPDX-License-Identifier: MIT
#pragma once

#include "reference/camera_rays.hpp"
#include "reference/path.hpp"

namespace clgi::reference {

// Samples of the radiance of pixels, cd/m^2.
class PixelLight {
public:
    PixelLight(const Geometry& geometry, const Tracer& tracer, const Paths& paths,
               const Camera& camera, int width, int height, Filter filter)
        : geometry_(geometry),
          tracer_(tracer),
          paths_(paths),
          rays_(camera, geometry, width, height),
          width_(static_cast<std::size_t>(width)),
          filter_(filter) {}

    // pixel: row * width + column. met: as of Paths::sample().
    glm::vec3 operator()(std::size_t pixel, Random& random, std::vector<Met>* met = nullptr) const;

private:
    Hit texture_place(float x, float y, const Hit& seen, Random& random) const;

    const Geometry& geometry_;
    const Tracer& tracer_;
    const Paths& paths_;
    CameraRays rays_;
    std::size_t width_;
    Filter filter_;
};

// A sample of the irradiance of a place, lux.
glm::vec3 light_at(const Place& place, const Geometry& geometry, const Paths& paths, Random& random,
                   std::vector<Met>* met = nullptr);

// Throws Error for options out of range.
void check_options(const Options& options);

}  // namespace clgi::reference
