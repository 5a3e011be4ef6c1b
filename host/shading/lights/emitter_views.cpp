// SPDX-License-Identifier: MIT
#include "shading/lights/emitter_views.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "shading/lights/replicate.hpp"

namespace clgi::shadow_views {

glm::vec3 across(const glm::vec3& n) {
    const glm::vec3 helper = std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    return glm::normalize(glm::cross(helper, n));
}

View window(const glm::vec3& eye, const glm::vec3& right, const glm::vec3& up,
            const glm::vec3& forward, float extent_x, float extent_y, float near, int width,
            int height) {
    View view{};
    view.eye = glm::vec4(eye, 0.0f);
    view.right = glm::vec4(right, extent_x);
    view.up = glm::vec4(up, extent_y);
    view.forward = glm::vec4(forward, near);
    view.width = static_cast<std::uint32_t>(width);
    view.height = static_cast<std::uint32_t>(height);
    return view;
}

std::uint32_t seed_of(const EmitterOptions& options) {
    return options.replicate + 0x9e3779b9u * options.sample;
}

void shift_texels(View& view, const EmitterOptions& options) {
    if (options.sample == 0 || view.width < 2) return;  // a single texel has nothing beside it
    // Larger by a texel around, so that none of what is lit leaves it.
    const float texel = 2.0f / static_cast<float>(view.width);
    view.right.w *= 1.0f + texel;
    view.up.w *= 1.0f + texel;
    const auto shift = [&](std::uint32_t dimension) {
        return shifted_radical_inverse(
                   options.sample, dimension == 0 ? 2 : 3,
                   replicate_shift(options.replicate + 1, ShiftUse::texel, dimension)) -
               0.5f;
    };
    view.window.x += shift(0) * texel * view.right.w;
    view.window.y += shift(1) * texel * view.up.w;
}

std::vector<View> cube(const glm::vec3& eye, float near, const EmitterOptions& options) {
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int size = options.face_size;
    std::vector<View> views;
    for (int face = 0; face < 6; ++face) {
        const glm::vec3 forward = face % 2 == 0 ? axes[face / 2] : -axes[face / 2];
        const glm::vec3 up = axes[(face / 2 + 1) % 3];
        views.push_back(window(eye, glm::cross(forward, up), up, forward, 1, 1, near, size, size));
        shift_texels(views.back(), options);
    }
    return views;
}

std::vector<View> hemicube(const glm::vec3& eye, const glm::vec3& normal, float near, int size) {
    const glm::vec3 right = across(normal);
    const glm::vec3 up = glm::cross(right, normal);
    std::vector<View> views = {window(eye, right, up, normal, 1, 1, near, size, size)};
    for (const glm::vec3& side : {right, up, -right, -up}) {
        View half = window(eye, glm::cross(side, normal), normal, side, 1, 0.5f, near, size,
                           std::max(size / 2, 1));
        half.window.y = 0.5f;
        views.push_back(half);
    }
    return views;
}

Outline outline(const LocalBox& box, float around, const glm::vec3& axis, const glm::vec3& right) {
    constexpr float smaller = 0.99f, least_length = 1e-4f;
    std::vector<glm::vec3> turned = {right};
    for (int side = 0; side < 3; ++side) {
        glm::vec3 along(0.0f);
        along[side] = 1.0f;
        const glm::vec3 beside = glm::cross(along, axis);
        if (glm::length(beside) > least_length) turned.push_back(glm::normalize(beside));
    }
    Outline out;
    float least = std::numeric_limits<float>::infinity();
    for (const glm::vec3& one : turned) {
        Outline next{one, glm::cross(one, axis), glm::vec2(std::numeric_limits<float>::max()),
                     glm::vec2(-std::numeric_limits<float>::max())};
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 at(corner & 1 ? box.high.x : box.low.x,
                               corner & 2 ? box.high.y : box.low.y,
                               corner & 4 ? box.high.z : box.low.z);
            const glm::vec2 place(glm::dot(at, next.right), glm::dot(at, next.up));
            next.low = glm::min(next.low, place - around);
            next.high = glm::max(next.high, place + around);
        }
        const glm::vec2 size = next.high - next.low;
        if (!(size.x * size.y < smaller * least)) continue;
        least = size.x * size.y;
        out = next;
    }
    return out;
}

}  // namespace clgi::shadow_views
