// Means of a texture over triangles of UV space, as level 0 is looked up: between texels, or
// nearest.
//
//   integral over T of f dx dy = integral around T of F dy,   F(x, y) = integral from 0 to x of f
//
// F comes from sums along rows. Between lines of texels it is a cubic in y along an edge, which two
// Gauss points integrate exactly; so the work is that of the texels that edges cross, however many
// the triangle covers.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <vector>

namespace clgi {

using UvTriangle = std::array<glm::dvec2, 3>;

inline glm::dvec2 between(const UvTriangle& uv, const glm::dvec3& weight) {
    return weight.x * uv[0] + weight.y * uv[1] + weight.z * uv[2];
}

// Where the corners of a triangle lie in a material's texture.
UvTriangle slot_uvs(const Scene& scene, const SceneTriangle& triangle, const TextureSlot& slot);

// Calls visit with the weights of the corners at the centres of side^2 equal parts of a triangle.
template <typename Visit>
void for_lattice(int side, Visit&& visit) {
    for (int row = 0; row < side; ++row)
        for (int part = 0; part <= 2 * (side - 1 - row); ++part) {
            // Parts that stand on their base and on their tip take turns along a row.
            const double third = part % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
            const double y = (part / 2 + third) / side, z = (row + third) / side;
            visit(glm::dvec3(1.0 - y - z, y, z));
        }
}

class TextureMean {
public:
    TextureMean() = default;
    // texture: must outlive it. Without sums, over() must not be called.
    explicit TextureMean(const Texture& texture, bool sums = true);

    // Mean linear colour over a triangle. One that has no area in UV space, or whose edges cross
    // very many texels, is summed over a lattice of points.
    glm::dvec3 over(const UvTriangle& uv) const;

    glm::dvec3 at(const glm::dvec2& uv) const;
    double alpha(const glm::dvec2& uv) const;
    double extent(const UvTriangle& uv) const;  // texels along its longest side, along an axis

private:
    using Color = glm::dvec3;
    struct Point {
        long long column, row;
        double x, y;  // from there on
    };
    glm::dvec2 to_texels(const glm::dvec2& uv) const;
    Point point_at(const glm::dvec2& uv) const;
    Color texel(long long column, int row) const;
    int wrapped_row(long long row) const;
    Color row_sum(long long column, int row) const;
    Color along_row(long long column, int row, double x) const;
    Color edge(const glm::dvec2& from, const glm::dvec2& to) const;
    Color lattice(const UvTriangle& uv, int side) const;

    const Texture* texture_ = nullptr;
    std::array<float, 256> decode_{};
    std::vector<Color> sums_;  // [height][blocks of columns, and one more] of all texels before
    std::size_t blocks_ = 0;
};

}  // namespace clgi
