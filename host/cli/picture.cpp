// SPDX-License-Identifier: MIT
#include "cli/picture.hpp"

#include <algorithm>
#include <clgi/io/image.hpp>
#include <cmath>
#include <vector>

namespace clgi::cli {
namespace {

// All but three in a hundred of the pixels that are not black stay below white.
float exposure_of(const std::vector<float>& radiance, std::size_t pixels, std::size_t stride) {
    std::vector<float> luminance;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float y = 0.2126f * radiance[i] + 0.7152f * radiance[stride + i] +
                        0.0722f * radiance[2 * stride + i];
        if (y > 0.0f) luminance.push_back(y);
    }
    if (luminance.empty()) return 1.0f;
    const auto white = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() * 97 / 100);
    std::nth_element(luminance.begin(), white, luminance.end());
    return 1.0f / *white;
}

}  // namespace

void save_picture(const cl::CommandQueue& queue, const SecondOrderSolver& solver,
                  const PictureFlags& flags) {
    const int width = solver.options().width;
    const int height = solver.options().height;
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    const std::size_t stride = solver.stride();
    std::vector<float> radiance(RADIANCE_PLANES * stride);
    queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, 0, radiance.size() * sizeof(float),
                            radiance.data());
    if (!flags.exr.empty()) {
        io::Image image;
        image.width = width;
        image.height = height;
        image.attributes = {{"clgi:quantity", "radiance"}, {"clgi:unit", "cd/m^2"}};
        for (int c = 0; c < 3; ++c) {
            const auto first = radiance.begin() + static_cast<std::ptrdiff_t>(c * stride);
            image.channels.push_back(
                {std::string(1, "RGB"[c]), {first, first + static_cast<std::ptrdiff_t>(pixels)}});
        }
        io::save_exr(image, flags.exr, flags.full ? io::Storage::full : io::Storage::half);
    }
    if (!flags.png.empty()) {
        const float exposure =
            flags.exposure ? std::exp2(*flags.exposure) : exposure_of(radiance, pixels, stride);
        const cl::Context context = queue.getInfo<CL_QUEUE_CONTEXT>();
        cl::Buffer preview(context, CL_MEM_READ_WRITE, 4 * pixels);
        const TonemapParams params{static_cast<std::uint32_t>(width),
                                   static_cast<std::uint32_t>(height), solver.stride(), exposure};
        solver.image_passes().tonemap(queue, params, solver.radiance(), preview);
        std::vector<std::uint8_t> rgba(4 * pixels);
        queue.enqueueReadBuffer(preview, CL_TRUE, 0, rgba.size(), rgba.data());
        io::save_png(width, height, rgba, flags.png);
    }
}

}  // namespace clgi::cli
