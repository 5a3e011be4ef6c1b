// What is asked of a light alone, at load and when it is replaced; and of animation.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cmath>
#include <string>

namespace clgi {

// "light 3"
inline std::string entry(const char* array, std::size_t i) {
    return std::string(array) + " " + std::to_string(i);
}

template <typename Vector>
bool is_finite(const Vector& v) {
    for (int i = 0; i < Vector::length(); ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

// Throws InputError that names the light and what is wrong with it.
void validate_light(const Light& light, std::size_t index);

// Throws InputError that names the first array, index and value that break Scene::animation's
// contract. The scene's own arrays are sound.
CLGI_API void validate_animation(const Animation& animation, const Scene& scene);

}  // namespace clgi
