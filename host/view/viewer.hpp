// A window over a painter: clgi view.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "view/painter.hpp"

namespace clgi::view {

struct ViewerOptions {
    PainterOptions pictures;
    Shown first;                      // to begin with
    std::optional<float> exposure;    // stops; none: from the picture
    std::filesystem::path output;     // saved pictures: its name with a number
    std::optional<double> turntable;  // seconds of turning around the target, then it closes
};

struct Viewed {
    std::size_t frames = 0;  // pictures that were shown
    double seconds = 0.0;
};

// Until the window is closed. Prints a line for every picture that is saved: the command that makes
// it. Throws DeviceError where no window can be opened.
Viewed view(const Programs& programs, Subject subject, const ViewerOptions& options);

}  // namespace clgi::view
