// What is asked of a light alone, at load and when it is replaced; and of animation.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <string>

namespace clgi {

// Throws InputError that names the light and what is wrong with it.
void validate_light(const Light& light, std::size_t index);

// Throws InputError that names the first array, index and value that break Scene::animation's
// contract. The scene's own arrays are sound.
CLGI_API void validate_animation(const Animation& animation, const Scene& scene);

}  // namespace clgi
