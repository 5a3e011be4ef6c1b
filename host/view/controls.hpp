// What mouse, keys and a panel change of what is shown.
// SPDX-License-Identifier: MIT
#pragma once

#include "view/painter.hpp"
#include "view/window.hpp"

namespace clgi::view {

struct Controls {
    Bounds box;  // of the scene
    bool panel = true, playing = false, save = false;
    bool automatic = true;  // exposure, from the picture
    float stops = 0.0f;
    std::size_t light = 0;  // that is dragged
};

// Keys and the mouse where the panel does not want them, over what is drawn.
void follow_input(Window& window, const Subject& subject, const Drawn& drawn, Shown& shown,
                  Controls& controls);

// The panel of Dear ImGui.
void draw_panel(const Subject& subject, const Drawn& drawn, const Painter::Status& status,
                double frames_a_second, Shown& shown, Controls& controls);

}  // namespace clgi::view
