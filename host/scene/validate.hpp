// What is asked of a light alone, at load and when it is replaced.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <string>

namespace clgi {

// Throws InputError that names the light and what is wrong with it.
void validate_light(const Light& light, std::size_t index);

}  // namespace clgi
