// Pictures whose solver brings the light of the environment itself.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/picture.hpp>

namespace clgi {

inline PictureOptions without_sky(PictureOptions options) {
    options.emitters.environment_lights = 0;
    return options;
}

}  // namespace clgi
