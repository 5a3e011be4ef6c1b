// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/error.hpp>
#include <cmath>

#include "core/on_threads.hpp"
#include "methods/light_atlas/surroundings.hpp"

namespace clgi {
namespace {

// Corner i of an icosahedron, as kernels/atlas/volume.cl has it.
glm::vec3 volume_direction(int i) {
    const int zero = i / 4;
    glm::vec3 out(0.0f);
    out[(zero + 1) % 3] = i & 1 ? VOLUME_SHORT : -VOLUME_SHORT;
    out[(zero + 2) % 3] = i & 2 ? VOLUME_LONG : -VOLUME_LONG;
    return out;
}

glm::ivec3 cubes(const glm::dvec3& size, double spacing) {
    return glm::max(glm::ivec3(glm::ceil(size / spacing)), 1);
}

double points(const glm::dvec3& size, double spacing) {
    const glm::dvec3 count(cubes(size, spacing));
    return count.x * count.y * count.z;
}

constexpr int most_points = 1 << 20;  // numbers of which floats tell apart

// Solid matter costs nothing, so a grid may have more cubes than points with light.
constexpr int most_cubes_per_point = 8;
constexpr double margin = 1.1;  // what is not worth another grid

// Middles of the largest number of equal cubes, at most `most`, that cover the box.
IrradianceVolume cubes_over(const Bounds& box, int most) {
    IrradianceVolume out;
    out.first = box.low;
    const glm::dvec3 size = box.high - box.low;
    const double longest = std::max({size.x, size.y, size.z});
    if (longest > 0.0) {
        // Counts fall as the spacing grows.
        double fine = longest / most, coarse = longest;
        for (int step = 0; step < 60; ++step) {
            const double middle = std::sqrt(fine * coarse);
            (points(size, middle) <= most ? coarse : fine) = middle;
        }
        out.spacing = coarse;
        out.count = cubes(size, coarse);
        const glm::dvec3 middle = 0.5 * (box.low + box.high);
        out.first = middle - 0.5 * out.spacing * glm::dvec3(out.count - 1);
    }
    for (int z = 0; z < out.count.z; ++z)
        for (int y = 0; y < out.count.y; ++y)
            for (int x = 0; x < out.count.x; ++x) out.places.emplace_back(x, y, z, -1.0f);
    return out;
}

glm::dvec3 position(const IrradianceVolume& volume, const glm::vec4& place) {
    return volume.first + volume.spacing * glm::dvec3(place);
}

// The same, with points moved out of solid matter and those in the open numbered.
IrradianceVolume open_cubes(const Bounds& box, int most, const Surroundings& around) {
    IrradianceVolume out = cubes_over(box, most);
    for_each_of(out.places.size(), 1, [&](std::size_t i) {
        glm::dvec3 at = position(out, out.places[i]);
        if (!around.in_the_open(at, 0.5 * out.spacing)) return;
        out.places[i] = glm::vec4((at - out.first) / out.spacing, 0.0f);
    });
    for (glm::vec4& place : out.places)
        if (place.w >= 0.0f) place.w = static_cast<float>(out.open_count++);
    return out;
}

}  // namespace

IrradianceVolume make_irradiance_volume(const Bounds& box, int most, const Scene& walls) {
    const glm::dvec3 size = box.high - box.low;
    if (!(size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0) ||
        !std::isfinite(size.x + size.y + size.z))
        throw Error("irradiance-volume: the box is not finite, or its corners are not in order");
    if (most < 1 || most > most_points)
        throw Error("irradiance-volume: most is " + std::to_string(most) + ", 1 to " +
                    std::to_string(most_points) + " needed");
    const Surroundings around(walls);
    IrradianceVolume out = open_cubes(box, most, around);
    // Finer, as far as points in the open are few enough. Their share changes little with the grid.
    const double open = std::max(double(out.open_count), double(most) / most_cubes_per_point);
    double fits = most, fails = margin * most * (most / open);
    for (int step = 0; step < 4 && margin * open < most; ++step) {
        const double cubes = step == 0 ? fails / margin : std::sqrt(fits * fails);
        IrradianceVolume next = open_cubes(box, static_cast<int>(cubes), around);
        const bool fit = next.open_count <= static_cast<std::uint32_t>(most);
        (fit ? fits : fails) = cubes;
        if (!fit) continue;
        out = std::move(next);
        if (step == 0) break;
    }
    out.distances.resize(std::size_t{out.open_count} * VOLUME_TEXELS);
    for_each_of(out.places.size(), 1, [&](std::size_t i) {
        const glm::vec4& place = out.places[i];
        if (place.w >= 0.0f)
            around.distances(position(out, place), out.spacing,
                             &out.distances[static_cast<std::size_t>(place.w) * VOLUME_TEXELS]);
    });
    return out;
}

std::vector<BakePoint> points_of(const IrradianceVolume& volume) {
    std::vector<BakePoint> out;
    for (const glm::vec4& place : volume.places)
        for (int i = 0; i < VOLUME_DIRECTIONS && place.w >= 0.0f; ++i)
            out.push_back({position(volume, place), volume_direction(i)});
    return out;
}

}  // namespace clgi
