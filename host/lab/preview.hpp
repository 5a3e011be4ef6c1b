// Pictures as eyes take them: exposure, then the sRGB curve.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <clgi/renderer.hpp>
#include <cstdint>
#include <vector>

namespace clgi::lab {

// The last picture of a renderer, with planes R, G and B. Waits for it.
io::Image radiance_picture(const Renderer& renderer);

// Of a picture with planes R, G and B, [height][width] cd/m^2, as PathTracer::verify takes it.
std::vector<glm::vec3> radiance_of(const io::Image& picture);

// A factor that leaves all but three in a hundred of the pixels that are not black below white.
float preview_exposure(const io::Image& picture);

// RGBA8 of a picture with planes R, G and B; the curve of IEC 61966-2-1, rounded to nearest.
std::vector<std::uint8_t> preview(const io::Image& picture, float exposure);

}  // namespace clgi::lab
