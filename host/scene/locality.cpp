// SPDX-License-Identifier: MIT
#include "scene/locality.hpp"

#include <clgi/shared/scene.h>
#include <algorithm>
#include <future>

#include "core/on_threads.hpp"

namespace clgi {
namespace {

// Every third bit of the result holds a bit of the 10-bit value.
std::uint32_t spread_bits(std::uint32_t value) {
    value = (value | value << 16) & 0x030000ffu;
    value = (value | value << 8) & 0x0300f00fu;
    value = (value | value << 4) & 0x030c30c3u;
    return (value | value << 2) & 0x09249249u;
}

std::uint32_t z_order(const glm::vec3& point) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::clamp((point[axis] + 1.0f) * 512.0f, 0.0f, 1023.0f);
        code |= spread_bits(static_cast<std::uint32_t>(cell)) << axis;
    }
    return code;
}

struct Item {
    glm::vec3 middle;  // of its box
    std::uint32_t triangle;
};

constexpr std::ptrdiff_t worth_a_thread = 1 << 16;  // triangles
constexpr std::ptrdiff_t least_share = 16;          // a side has no fewer than one in so many

void gather_near(Item* first, Item* last, int threads) {
    const std::ptrdiff_t count = last - first;
    if (count <= PART_TRIANGLES) {
        std::sort(first, last,
                  [](const Item& a, const Item& b) { return a.triangle < b.triangle; });
        return;
    }
    glm::vec3 low = first->middle, high = low;
    for (const Item* item = first; item != last; ++item) {
        low = glm::min(low, item->middle);
        high = glm::max(high, item->middle);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::ptrdiff_t unit =
        count > CLUSTER_TRIANGLES ? int{CLUSTER_TRIANGLES} : int{PART_TRIANGLES};
    const std::ptrdiff_t units = (count + unit - 1) / unit;
    const std::ptrdiff_t least = std::max<std::ptrdiff_t>(1, units / least_share);
    const float centre = 0.5f * (low[axis] + high[axis]);
    // What lies in one place is halved.
    const std::ptrdiff_t below =
        size[axis] > 0.0f
            ? std::count_if(first, last,
                            [&](const Item& item) { return item.middle[axis] < centre; })
            : count / 2;
    Item* middle = first + std::clamp((below + unit / 2) / unit, least, units - least) * unit;
    std::nth_element(first, middle, last, [axis](const Item& a, const Item& b) {
        return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                : a.triangle < b.triangle;
    });
    if (threads < 2 || count < worth_a_thread) {
        gather_near(first, middle, 1);
        gather_near(middle, last, 1);
    } else {
        auto other = std::async(std::launch::async, gather_near, first, middle, threads / 2);
        gather_near(middle, last, threads - threads / 2);
        other.get();
    }
}

}  // namespace

std::uint32_t place_on_curve(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return z_order((a + b + c) / 3.0f);
}

SpatialOrder spatial_order(const std::vector<glm::vec4>& local,
                           const std::vector<SceneTriangle>& triangles) {
    std::vector<Item> items;
    items.reserve(triangles.size());
    for (const SceneTriangle& t : triangles) {
        const glm::vec3 a(local[t.vertex[0]]), b(local[t.vertex[1]]), c(local[t.vertex[2]]);
        items.push_back({0.5f * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c))),
                         static_cast<std::uint32_t>(items.size())});
    }
    gather_near(items.data(), items.data() + items.size(), thread_count(0));
    SpatialOrder order;
    order.triangles.reserve(items.size());
    for (const Item& item : items) order.triangles.push_back(item.triangle);

    constexpr std::uint32_t unused = 0xffffffffu;
    order.renumbered.assign(local.size(), unused);
    for (const std::uint32_t triangle : order.triangles)
        for (const std::uint32_t vertex : triangles[triangle].vertex)
            if (order.renumbered[vertex] == unused) {
                order.renumbered[vertex] = static_cast<std::uint32_t>(order.vertices.size());
                order.vertices.push_back(vertex);
            }
    return order;
}

}  // namespace clgi
