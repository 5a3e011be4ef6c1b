// What the light of several frames of antiradiance says of itself, taken together.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/antiradiance.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace clgi::program {

// Frames of which the same is to be told.
struct FramesTold {
    int count = 0;
    int first = 0;              // the number of the first of them
    AntiradianceStatus status;  // of that one

    void add(int frame, const AntiradianceStatus& of);
};

struct AntiradianceFrames {
    void add(int frame, const AntiradianceStatus& of, const AntiradianceOptions& options);

    // One for each kind of trouble, with the number of the first frame that had it. in_pictures:
    // Picture::non_finite() after the last frame.
    std::vector<std::string> warnings(const AntiradianceOptions& options,
                                      std::uint32_t in_pictures) const;

    int count = 0;
    AntiradianceStatus last;  // of the last frame
    bool diverged = false;    // the symmetric iteration, in some frame
    bool converged = true;    // in all frames
    FramesTold given_up;
    FramesTold unsettled;          // the residual is too large, without divergence
    std::uint32_t non_finite = 0;  // leaves, of all frames
};

}  // namespace clgi::program
