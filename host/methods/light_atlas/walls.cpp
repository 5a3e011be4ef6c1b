// SPDX-License-Identifier: MIT
#include "methods/light_atlas/walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace clgi {
namespace {

constexpr std::uint32_t leaf = 4;  // triangles that are tried one by one
constexpr int deepest = 60;        // so many nodes may wait in a search

// Of the weights of a triangle's corners: what rounding may put beside an edge.
constexpr double edge = 1e-9;

// Does from + t way, 0 <= t <= last, meet the box?
bool enters(const glm::vec3& low, const glm::vec3& high, const glm::dvec3& from,
            const glm::dvec3& per_way, double last) {
    double first = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        double a = (double{low[axis]} - from[axis]) * per_way[axis];
        double b = (double{high[axis]} - from[axis]) * per_way[axis];
        if (a > b) std::swap(a, b);
        first = std::max(first, a);
        last = std::min(last, b);
    }
    return first <= last;
}

}  // namespace

Walls::Walls(const Scene& scene) : scene_(scene) {
    if (scene.triangles.empty()) return;
    const Bounds all = bounds(scene);
    middle_ = 0.5 * (all.low + all.high);
    order_.resize(scene.triangles.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Box> boxes;
    boxes.reserve(order_.size());
    for (const std::uint32_t t : order_) boxes.push_back(box_of(t));
    nodes_.reserve(order_.size());
    build(boxes, 0, static_cast<std::uint32_t>(order_.size()), 0);
}

Walls::Box Walls::box_of(std::uint32_t triangle) const {
    constexpr float far = std::numeric_limits<float>::infinity();
    Box out;
    for (int axis = 0; axis < 3; ++axis) {
        double low = far, high = -far;
        for (const std::uint32_t vertex : scene_.triangles[triangle].vertex) {
            low = std::min(low, scene_.positions[vertex][axis] - middle_[axis]);
            high = std::max(high, scene_.positions[vertex][axis] - middle_[axis]);
        }
        out.low[axis] = std::nextafter(static_cast<float>(low), -far);
        out.high[axis] = std::nextafter(static_cast<float>(high), far);
    }
    return out;
}

// Halves space across the longest side of the boxes' middles.
void Walls::build(std::vector<Box>& boxes, std::uint32_t first, std::uint32_t last, int depth) {
    constexpr float far = std::numeric_limits<float>::infinity();
    Node node{{glm::vec3(far), glm::vec3(-far)}, first, last - first};
    glm::vec3 low(far), high(-far);  // of the middles, twice
    for (std::uint32_t i = first; i < last; ++i) {
        const Box& box = boxes[order_[i]];
        node.box.low = glm::min(node.box.low, box.low);
        node.box.high = glm::max(node.box.high, box.high);
        low = glm::min(low, box.low + box.high);
        high = glm::max(high, box.low + box.high);
    }
    const auto at = nodes_.size();
    nodes_.push_back(node);
    if (node.count <= leaf || depth == deepest - 1) return;
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const float half = 0.5f * (low[axis] + high[axis]);
    const auto cut = std::partition(
        order_.begin() + first, order_.begin() + last,
        [&](std::uint32_t t) { return boxes[t].low[axis] + boxes[t].high[axis] < half; });
    const auto middle = static_cast<std::uint32_t>(cut - order_.begin());
    if (middle == first || middle == last) return;  // all at one place
    nodes_[at].count = 0;
    build(boxes, first, middle, depth + 1);
    nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
    build(boxes, middle, last, depth + 1);
}

// Whether it meets a triangle nearer than `met`, which it then becomes.
bool Walls::meets(const glm::dvec3& from, const glm::dvec3& way, std::uint32_t triangle,
                  Met& met) const {
    const auto& vertex = scene_.triangles[triangle].vertex;
    const glm::dvec3 first = scene_.positions[vertex[0]];
    const glm::dvec3 edge1 = scene_.positions[vertex[1]] - first;
    const glm::dvec3 edge2 = scene_.positions[vertex[2]] - first;
    const glm::dvec3 across = glm::cross(edge1, edge2);
    const double volume = -glm::dot(way, across);
    if (volume == 0.0) return false;  // along it, or no triangle
    const glm::dvec3 to = from - first;
    const double at = glm::dot(to, across) / volume;
    if (!(at >= 0.0 && at <= met.share)) return false;
    const glm::dvec3 turned = glm::cross(way, to);
    const double b1 = -glm::dot(edge2, turned) / volume, b2 = glm::dot(edge1, turned) / volume;
    if (!(b1 >= -edge && b2 >= -edge && b1 + b2 <= 1.0 + edge)) return false;
    met = {at, triangle, volume < 0.0};
    return true;
}

Walls::Met Walls::first_met(const glm::dvec3& from, const glm::dvec3& to,
                            const std::function<bool(std::uint32_t)>& counts, bool any) const {
    Met met;
    if (nodes_.empty()) return met;
    const glm::dvec3 way = to - from, start = from - middle_;
    // Not infinite, which times 0 is no number.
    glm::dvec3 per_way;
    for (int axis = 0; axis < 3; ++axis)
        per_way[axis] = 1.0 / (std::abs(way[axis]) > 1e-100 ? way[axis] : 1e-100);
    std::uint32_t waiting[deepest];
    int count = 0;
    std::uint32_t next = 0;
    for (;;) {
        const Node& node = nodes_[next];
        if (enters(node.box.low, node.box.high, start, per_way, met.share)) {
            if (node.count == 0) {
                waiting[count++] = node.first;
                ++next;
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (counts(order_[i]) && meets(from, way, order_[i], met) && any) return met;
        }
        if (count == 0) return met;
        next = waiting[--count];
    }
}

}  // namespace clgi
