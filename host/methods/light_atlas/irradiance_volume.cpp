// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/error.hpp>
#include <cmath>

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

}  // namespace

IrradianceVolume make_irradiance_volume(const Bounds& box, int most) {
    const glm::dvec3 size = box.high - box.low;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(size.x >= 0.0 && size.y >= 0.0 && size.z >= 0.0) || !std::isfinite(longest))
        throw Error("irradiance-volume: the box is not finite, or its corners are not in order");
    if (most < 1)
        throw Error("irradiance-volume: most is " + std::to_string(most) + ", at least 1 needed");
    IrradianceVolume out;
    if (!(longest > 0.0)) {
        out.first = box.low;
        return out;
    }
    // The finest grid of so many points: counts fall as the spacing grows.
    double fine = longest / most, coarse = longest;
    for (int step = 0; step < 60; ++step) {
        const double middle = std::sqrt(fine * coarse);
        (points(size, middle) <= most ? coarse : fine) = middle;
    }
    out.spacing = coarse;
    out.count = cubes(size, coarse);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);
    out.first = middle - 0.5 * out.spacing * glm::dvec3(out.count - 1);
    return out;
}

std::vector<BakePoint> points_of(const IrradianceVolume& volume) {
    std::vector<BakePoint> out;
    for (int z = 0; z < volume.count.z; ++z)
        for (int y = 0; y < volume.count.y; ++y)
            for (int x = 0; x < volume.count.x; ++x)
                for (int i = 0; i < VOLUME_DIRECTIONS; ++i)
                    out.push_back(
                        {volume.first + volume.spacing * glm::dvec3(x, y, z), volume_direction(i)});
    return out;
}

}  // namespace clgi
