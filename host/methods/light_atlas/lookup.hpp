// The light of an atlas at any point of its charts, on the host: the same four texels with the same
// weights as atlas.show reads. [derived: bilinear interpolation, see kernels/atlas/show.cl]
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/atlas_layout.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// Weights add up to 1; none if no texel around the point is listed.
struct AtlasTaps {
    std::array<std::uint32_t, 4> texel{};  // index into AtlasLayout::texels
    std::array<double, 4> weight{};
    int count = 0;

    glm::dvec3 of(const std::vector<glm::vec3>& light) const {
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            sum += weight[i] * glm::dvec3(light[texel[i]]);
        return sum;
    }
};

class AtlasLookup {
public:
    explicit AtlasLookup(const AtlasLayout& atlas);  // which must outlive it

    // place: texels of the page of this chart.
    AtlasTaps at(std::uint32_t chart, const glm::dvec2& place) const;

private:
    const AtlasLayout& atlas_;
    std::vector<std::uint32_t> listed_;  // [pages * size * size] index, or none
};

// Where a point of a triangle lies in its page, texels. b1, b2: weights of its second and third
// corner.
glm::dvec2 atlas_place(const AtlasLayout& atlas, std::uint32_t triangle, double b1, double b2);

// Throw Error that begins with `name`.
void need_layout_of(const char* name, const Scene& scene, const AtlasLayout& atlas);
void need_light_of(const char* name, const AtlasLayout& atlas, std::size_t values);

}  // namespace clgi
