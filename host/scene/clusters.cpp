// SPDX-License-Identifier: MIT
#include "scene/clusters.hpp"

#include <algorithm>
#include <cmath>

namespace clgi {
namespace {

constexpr float least_cosine = 0.1f;  // a wider cone is hardly ever seen from behind as a whole

glm::vec4 cone_of(const std::vector<glm::uvec4>& triangles, const std::vector<glm::vec4>& positions,
                  std::size_t first, std::size_t last) {
    const auto normal = [&](std::size_t t) {
        const glm::vec3 a(positions[triangles[t].x]);
        return glm::cross(glm::vec3(positions[triangles[t].y]) - a,
                          glm::vec3(positions[triangles[t].z]) - a);
    };
    glm::vec3 axis(0.0f);
    for (std::size_t t = first; t < last; ++t) {
        if (triangles[t].w & static_cast<std::uint32_t>(TRIANGLE_DOUBLE_SIDED))
            return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
        const glm::vec3 n = normal(t);
        const float length = std::sqrt(glm::dot(n, n));
        if (length > 0.0f) axis += n / length;
    }
    const float whole = std::sqrt(glm::dot(axis, axis));
    if (!(whole > 0.0f)) return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
    axis /= whole;
    float cosine = 1.0f;
    for (std::size_t t = first; t < last; ++t) {
        const glm::vec3 n = normal(t);
        const float length = std::sqrt(glm::dot(n, n));
        if (length > 0.0f) cosine = std::min(cosine, glm::dot(n, axis) / length);
    }
    if (!(cosine > least_cosine)) return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
    return glm::vec4(axis, std::sqrt(1.0f - cosine * cosine));
}

struct Corners {
    glm::vec3 low, high;
};

Corners corners_of(const std::vector<glm::uvec4>& triangles,
                   const std::vector<glm::vec4>& positions, std::size_t first, std::size_t last) {
    Corners out;
    out.low = out.high = glm::vec3(positions[triangles[first].x]);
    for (std::size_t t = first; t < last; ++t)
        for (int k = 0; k < 3; ++k) {
            const glm::vec4& p = positions[triangles[t][k]];
            for (int axis = 0; axis < 3; ++axis) {
                // Of 0 and -0 the first one stays, here and on the device.
                if (p[axis] < out.low[axis]) out.low[axis] = p[axis];
                if (p[axis] > out.high[axis]) out.high[axis] = p[axis];
            }
        }
    return out;
}

// Triangles first .. last - 1, or none.
void set_part(const std::vector<glm::uvec4>& triangles, const std::vector<glm::vec4>& positions,
              std::size_t first, std::size_t last, Cluster& cluster, std::size_t part) {
    glm::vec3 middle(0.0f);
    float square = 0.0f;
    Corners box{glm::vec3(0.0f), glm::vec3(0.0f)};
    if (first < last) {
        box = corners_of(triangles, positions, first, last);
        middle = 0.5f * (box.low + box.high);
        for (std::size_t t = first; t < last; ++t)
            for (int k = 0; k < 3; ++k) {
                const glm::vec3 d = glm::vec3(positions[triangles[t][k]]) - middle;
                square = std::max(square, (d.x * d.x + d.y * d.y) + d.z * d.z);
            }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cluster.part[axis][part] = middle[static_cast<int>(axis)];
        cluster.part_low[axis][part] = box.low[static_cast<int>(axis)];
        cluster.part_high[axis][part] = box.high[static_cast<int>(axis)];
    }
    cluster.part[3][part] = std::sqrt(square);
}

}  // namespace

std::vector<Cluster> make_clusters(const std::vector<glm::uvec4>& triangles,
                                   const std::vector<glm::vec4>& positions) {
    std::vector<Cluster> out;
    for (std::size_t first = 0; first < triangles.size(); first += CLUSTER_TRIANGLES) {
        const std::size_t last = std::min<std::size_t>(first + CLUSTER_TRIANGLES, triangles.size());
        const Corners box = corners_of(triangles, positions, first, last);
        Cluster& cluster = out.emplace_back();
        cluster.low = glm::vec4(box.low, 0.0f);
        cluster.high = glm::vec4(box.high, 0.0f);
        cluster.cone = cone_of(triangles, positions, first, last);
        for (std::size_t part = 0; part < CLUSTER_PARTS; ++part) {
            const std::size_t begin = std::min(first + part * PART_TRIANGLES, last);
            set_part(triangles, positions, begin, std::min(begin + PART_TRIANGLES, last), cluster,
                     part);
        }
    }
    return out;
}

std::vector<PartCorners> make_parts(const std::vector<glm::uvec4>& triangles,
                                    const std::vector<glm::vec4>& positions) {
    const std::size_t clusters = (triangles.size() + CLUSTER_TRIANGLES - 1) / CLUSTER_TRIANGLES;
    std::vector<PartCorners> out(clusters * CLUSTER_PARTS);
    for (std::size_t i = 0; i < out.size() * PART_TRIANGLES; ++i) {
        const glm::uvec4& triangle = triangles[std::min(i, triangles.size() - 1)];
        PartCorners& part = out[i / PART_TRIANGLES];
        const std::size_t lane = i % PART_TRIANGLES;
        for (int c = 0; c < 3; ++c)
            for (int axis = 0; axis < 3; ++axis)
                part.corner[c][axis][lane] = positions[triangle[c]][axis];
        part.word[lane] = triangle.w;
    }
    return out;
}

}  // namespace clgi
