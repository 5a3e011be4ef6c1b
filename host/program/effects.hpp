// Which effects a picture has, in the words of --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/renderer.hpp>
#include <string>
#include <vector>

namespace clgi::program {

std::vector<std::string> effects_of(const Renderer& renderer);

}  // namespace clgi::program
