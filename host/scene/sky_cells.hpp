// The picture of an environment in cells, and the light of any rectangle of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <vector>

namespace clgi {

// A directional light that stands for some of the environment.
struct SkyLight {
    glm::dvec3 toward;  // unit, to where the light comes from
    glm::dvec3 lux;     // on a plane that faces it
};

// Cells are at least 256 across and 128 down, each a share of one texel.
class SkyCells {
public:
    // A rectangle; last ones not included.
    struct Patch {
        int top, bottom, left, right;
        double power;  // weighted luminance times solid angle
        bool whole() const { return bottom - top == 1 && right - left == 1; }
    };

    // weights: by which luminance counts; without values: all alike.
    explicit SkyCells(const Environment& environment, const SkyWeights& weights = {});

    int width() const { return picture_.width * across_; }
    int height() const { return picture_.height * down_; }
    Patch patch(int top, int bottom, int left, int right) const;

    // All light of a patch, where it has its centre.
    SkyLight light_of(const Patch& patch) const;

    // One direction of all, drawn by weighted luminance: the mean over all places, [0,1), is the
    // light of the environment. at.y first chooses a row of cells, then at.x a column.
    SkyLight drawn(glm::dvec2 at) const;

private:
    glm::dvec3 light(int row, int column) const;  // radiance times solid angle of a cell
    double power(int row, int column) const;      // weighted
    double power(int top, int bottom, int left, int right) const;

    Environment picture_;
    SkyWeights weights_;
    int across_, down_;
    std::vector<glm::dvec3> round_;    // [width] direction of a column at the horizon
    std::vector<double> solid_angle_;  // [height] of a cell
    std::vector<double> sums_;  // [height + 1][width + 1] over all cells above and to the left
};

}  // namespace clgi
