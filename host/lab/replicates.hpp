// How far off a picture is, from itself: several randomised shifts of its low-discrepancy points.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/progress.hpp>
#include <clgi/io/image.hpp>
#include <clgi/renderer.hpp>
#include <optional>

namespace clgi::lab {

struct Replicates {
    int count = 0;
    io::Image mean;  // R, G, B; error.Y: standard error of the mean's luminance
    // Root of the mean squared standard error over the mean luminance: of the mean picture, and of
    // one replicate alone. What all replicates share, the method's bias, is in neither.
    double error = 0.0;
    double single_error = 0.0;
};

// Renders replicates 1 to count, at least 2, and leaves the solver at the one it had. Nothing if
// progress cancelled. renderer: of second-order illumination, built. Throws Error for a smaller
// count.
std::optional<Replicates> replicate(Renderer& renderer, const Camera& camera, int count,
                                    const Progress& progress = nullptr);

}  // namespace clgi::lab
