// SPDX-License-Identifier: MIT
#include "scene/median_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// A rectangle of cells; last ones not included.
struct Patch {
    int top, bottom, left, right;
    double power;  // luminance times solid angle
    bool whole() const { return bottom - top == 1 && right - left == 1; }
};

// The picture in cells at least this fine, each a share of one texel, and sums over rectangles.
class Cells {
public:
    explicit Cells(const Environment& picture)
        : picture_(picture),
          across_((255 + picture.width) / picture.width),
          down_((127 + picture.height) / picture.height),
          sums_(std::size_t(width() + 1) * std::size_t(height() + 1), 0.0) {
        for (int column = 0; column < width(); ++column)
            round_.push_back(environment_direction(picture, (column + 0.5) / width(), 0.5));
        for (int row = 0; row < height(); ++row) {
            solid_angle_.push_back(texel_solid_angle(width(), height(), row));
            double of_row = 0.0;
            for (int column = 0; column < width(); ++column) {
                of_row += luminance(light(row, column));
                sums_[at(row + 1, column + 1)] = sums_[at(row, column + 1)] + of_row;
            }
        }
    }

    int width() const { return picture_.width * across_; }
    int height() const { return picture_.height * down_; }

    // Radiance times solid angle of a cell.
    glm::dvec3 light(int row, int column) const {
        const auto texel =
            static_cast<std::size_t>(row / down_) * static_cast<std::size_t>(picture_.width) +
            static_cast<std::size_t>(column / across_);
        return glm::dvec3(picture_.texels[texel]) * glm::dvec3(picture_.factor) *
               solid_angle_[static_cast<std::size_t>(row)];
    }

    Patch patch(int top, int bottom, int left, int right) const {
        const double power = sums_[at(bottom, right)] - sums_[at(top, right)] -
                             sums_[at(bottom, left)] + sums_[at(top, left)];
        return {top, bottom, left, right, power};
    }

    CutLight light_of(const Patch& patch) const {
        glm::dvec3 sum(0.0), centre(0.0);
        for (int row = patch.top; row < patch.bottom; ++row) {
            glm::dvec3 level(0.0);
            double power = 0.0;
            for (int column = patch.left; column < patch.right; ++column) {
                const glm::dvec3 here = light(row, column);
                sum += here;
                power += luminance(here);
                level += luminance(here) * round_[static_cast<std::size_t>(column)];
            }
            const double down = pi * (row + 0.5) / height();
            centre += level * std::sin(down) + glm::dvec3(0, power * std::cos(down), 0);
        }
        const double length = glm::length(centre);
        // An even sky as one light has no centre.
        return {length > 1e-6 * luminance(sum) ? centre / length : glm::dvec3(0, 1, 0), sum};
    }

private:
    std::size_t at(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width() + 1) +
               static_cast<std::size_t>(column);
    }

    const Environment& picture_;
    int across_, down_;
    std::vector<glm::dvec3> round_;    // [width] direction of a column at the horizon
    std::vector<double> solid_angle_;  // [height] of a cell
    std::vector<double> sums_;  // [height + 1][width + 1] over all cells above and to the left
};

// Both halves of a patch, as equal in power as whole cells allow.
std::pair<Patch, Patch> cut(const Cells& cells, const Patch& patch) {
    const double high = pi * (patch.bottom - patch.top) / cells.height();
    const double wide = 2.0 * pi * (patch.right - patch.left) / cells.width() *
                        std::sin(pi * 0.5 * (patch.top + patch.bottom) / cells.height());
    const bool by_rows =
        patch.right - patch.left == 1 || (high > wide && patch.bottom - patch.top > 1);
    const auto first = [&](int place) {
        return by_rows ? cells.patch(patch.top, place, patch.left, patch.right)
                       : cells.patch(patch.top, patch.bottom, patch.left, place);
    };
    int best = by_rows ? patch.top + 1 : patch.left + 1;
    const int end = by_rows ? patch.bottom : patch.right;
    double least = std::abs(first(best).power - 0.5 * patch.power);
    for (int place = best + 1; place < end; ++place) {
        const double off = std::abs(first(place).power - 0.5 * patch.power);
        if (off < least) {
            least = off;
            best = place;
        }
    }
    return {first(best), by_rows ? cells.patch(best, patch.bottom, patch.left, patch.right)
                                 : cells.patch(patch.top, patch.bottom, best, patch.right)};
}

}  // namespace

std::vector<CutLight> median_cut(const Environment& environment, int count) {
    std::vector<CutLight> lights;
    if (count < 1) return lights;
    const Environment picture = with_picture(environment);
    const Cells cells(picture);
    std::vector<Patch> patches = {cells.patch(0, cells.height(), 0, cells.width())};
    const double nothing = 1e-14 * patches[0].power;  // less than sums of doubles can tell
    while (patches.size() < static_cast<std::size_t>(count)) {
        const auto strongest =
            std::max_element(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
                return (a.whole() ? 0.0 : a.power) < (b.whole() ? 0.0 : b.power);
            });
        if (strongest->whole() || !(strongest->power > 0.0)) break;
        auto [first, second] = cut(cells, *strongest);
        if (!(first.power > nothing)) std::swap(first, second);
        *strongest = first;
        if (second.power > nothing) patches.push_back(second);
    }
    for (const Patch& patch : patches) {
        const CutLight light = cells.light_of(patch);
        if (luminance(light.lux) > 0.0) lights.push_back(light);
    }
    return lights;
}

}  // namespace clgi
