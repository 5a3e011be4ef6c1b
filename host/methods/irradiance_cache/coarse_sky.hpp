// The sky's picture in coarse texels, each the mean over its solid angle: about what a pixel of a
// hemicube sees, or what a smooth surface mirrors.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <optional>
#include <vector>

namespace clgi {

struct CoarseSky {
    int width = 0, height = 0;
    int parts = 1;
    std::vector<float> texels;  // [parts][height][width][3]
    // One part more, of the same size.
    void add(const CoarseSky& part);
};

// At most so many columns, and half as many rows. Of 0 texels without an environment.
CoarseSky coarse_sky(const std::optional<Environment>& environment, int columns);

}  // namespace clgi
