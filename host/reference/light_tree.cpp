// SPDX-License-Identifier: MIT
#include "reference/light_tree.hpp"

#include <algorithm>
#include <numeric>

namespace clgi::reference {
namespace {

double weight(const LightTree::Item& item, const glm::vec3& point) {
    const glm::dvec3 apart(item.centre - point);
    const double radius = std::max(double{item.radius}, 1e-9);
    return item.power / std::max(glm::dot(apart, apart), radius * radius);
}

}  // namespace

LightTree::LightTree(const std::vector<Item>& items) : leaves_(items.size()) {
    std::vector<std::uint32_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!items.empty()) divide(items, order.data(), order.data() + order.size(), 0);
}

// The longest side of the centres is cut in the middle.
void LightTree::divide(const std::vector<Item>& items, std::uint32_t* first, std::uint32_t* last,
                       std::uint32_t parent) {
    const auto here = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_[here].parent = parent;
    if (last - first == 1) {
        nodes_[here].all = items[*first];
        nodes_[here].item = *first;
        leaves_[*first] = here;
        return;
    }
    glm::vec3 low = items[*first].centre, high = low;
    double power = 0.0;
    for (const std::uint32_t* at = first; at != last; ++at) {
        low = glm::min(low, items[*at].centre);
        high = glm::max(high, items[*at].centre);
        power += items[*at].power;
    }
    const glm::vec3 centre = 0.5f * (low + high), size = high - low;
    float radius = 0.0f;
    for (const std::uint32_t* at = first; at != last; ++at)
        radius = std::max(radius, glm::distance(centre, items[*at].centre) + items[*at].radius);
    nodes_[here].all = {centre, radius, power};
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::uint32_t* middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
        return items[a].centre[axis] < items[b].centre[axis];
    });
    divide(items, first, middle, here);
    nodes_[here].second = static_cast<std::uint32_t>(nodes_.size());
    divide(items, middle, last, here);
}

double LightTree::share_of_first(const Node& node, std::uint32_t first,
                                 const glm::vec3& point) const {
    const double one = weight(nodes_[first].all, point);
    return one / (one + weight(nodes_[node.second].all, point));
}

std::uint32_t LightTree::sample(const glm::vec3& point, Random& random) const {
    double at = double{random()} + static_cast<double>(random.bits() >> 40) * 0x1p-48;
    std::uint32_t node = 0;
    while (nodes_[node].second != 0) {
        const double share = share_of_first(nodes_[node], node + 1, point);
        const bool first = at < share;
        at = first ? at / share : (at - share) / (1.0 - share);
        node = first ? node + 1 : nodes_[node].second;
    }
    return nodes_[node].item;
}

float LightTree::probability(std::uint32_t item, const glm::vec3& point) const {
    double out = 1.0;
    for (std::uint32_t node = leaves_[item]; node != 0; node = nodes_[node].parent) {
        const std::uint32_t parent = nodes_[node].parent;
        const double share = share_of_first(nodes_[parent], parent + 1, point);
        out *= node == parent + 1 ? share : 1.0 - share;
    }
    return static_cast<float>(out);
}

}  // namespace clgi::reference
