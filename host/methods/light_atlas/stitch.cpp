// Light that agrees across the charts of a smooth surface.
//
//   minimise  sum_p (a_p x - b_p x)^2 + w sum_i (x_i - y_i)^2
//
// p: points on the edges along which charts cut a smooth surface; a_p, b_p: weights of the texels
// that are read there on either side; y: the light as it was. Solved by conjugate gradients.
//                                                       [derived: least squares; see
//                                                       atlas/seams.hpp]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/atlas_light.hpp>
#include <cmath>

#include "methods/light_atlas/seams.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double keep_weight = 0.1;    // w: an edge between two texels keeps 5 % of its jump
constexpr double same_light = 0.5;     // less, of the other side's: a shadow ends there
constexpr double close_enough = 1e-3;  // of the first residual
constexpr int most_steps = 200;

struct Entry {
    std::uint32_t texel;  // index of an unknown
    double weight;        // positive on one side, negative on the other
};

class Stitching {
public:
    Stitching(const std::vector<SeamPoint>& points, const std::vector<glm::vec3>& light) {
        number_.assign(light.size(), no_number);
        for (const SeamPoint& point : points) {
            const double a = luminance(point.side[0].of(light)),
                         b = luminance(point.side[1].of(light));
            // Not of numbers that are not finite either.
            if (!(std::min(a, b) >= same_light * std::max(a, b)) || !std::isfinite(a + b)) continue;
            for (const double sign : {1.0, -1.0}) {
                const AtlasTaps& side = point.side[sign > 0.0 ? 0 : 1];
                for (std::size_t i = 0; i < static_cast<std::size_t>(side.count); ++i)
                    entries_.push_back({unknown(side.texel[i]), sign * side.weight[i]});
            }
            ends_.push_back(entries_.size());
        }
    }

    const std::vector<std::uint32_t>& texels() const { return texels_; }

    // What to add to the light of texels().
    std::vector<glm::dvec3> change(const std::vector<glm::vec3>& light) const {
        std::vector<glm::dvec3> x(texels_.size(), glm::dvec3(0.0)), was;
        for (const std::uint32_t texel : texels_) was.emplace_back(light[texel]);
        std::vector<glm::dvec3> residual = times(was, 0.0);
        for (glm::dvec3& value : residual) value = -value;
        std::vector<glm::dvec3> along = residual;
        glm::dvec3 size = dot(residual, residual);
        const glm::dvec3 enough = close_enough * close_enough * size;
        for (int step = 0; step < most_steps; ++step) {
            if (!glm::any(glm::greaterThan(size, enough))) break;
            const std::vector<glm::dvec3> image = times(along, keep_weight);
            const glm::dvec3 length = quotient(size, dot(along, image));
            for (std::size_t i = 0; i < x.size(); ++i) {
                x[i] += length * along[i];
                residual[i] -= length * image[i];
            }
            const glm::dvec3 next = dot(residual, residual);
            const glm::dvec3 turn = quotient(next, size);
            size = next;
            for (std::size_t i = 0; i < x.size(); ++i) along[i] = residual[i] + turn * along[i];
        }
        return x;
    }

private:
    static constexpr std::uint32_t no_number = 0xffffffffu;

    std::uint32_t unknown(std::uint32_t texel) {
        std::uint32_t& number = number_[texel];
        if (number == no_number) {
            number = static_cast<std::uint32_t>(texels_.size());
            texels_.push_back(texel);
        }
        return number;
    }

    // The sum over all points of their weights times what they make of x, and `keep` times x.
    std::vector<glm::dvec3> times(const std::vector<glm::dvec3>& x, double keep) const {
        std::vector<glm::dvec3> out;
        for (const glm::dvec3& value : x) out.push_back(keep * value);
        std::size_t begin = 0;
        for (const std::size_t end : ends_) {
            glm::dvec3 jump(0.0);
            for (std::size_t i = begin; i < end; ++i)
                jump += entries_[i].weight * x[entries_[i].texel];
            for (std::size_t i = begin; i < end; ++i)
                out[entries_[i].texel] += entries_[i].weight * jump;
            begin = end;
        }
        return out;
    }

    static glm::dvec3 dot(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
        glm::dvec3 sum(0.0);
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    }
    static glm::dvec3 quotient(const glm::dvec3& a, const glm::dvec3& b) {
        glm::dvec3 out(0.0);
        for (int c = 0; c < 3; ++c)
            if (b[c] > 0.0) out[c] = a[c] / b[c];
        return out;
    }

    std::vector<std::uint32_t> number_;  // [texels of the atlas] unknown, or no_number
    std::vector<std::uint32_t> texels_;  // [unknowns]
    std::vector<Entry> entries_;
    std::vector<std::size_t> ends_;  // [points] in entries_
};

}  // namespace

std::vector<glm::vec3> stitched_seams(const Scene& scene, const AtlasLayout& atlas,
                                      const std::vector<glm::vec3>& irradiance) {
    need_layout_of("stitched_seams", scene, atlas);
    need_light_of("stitched_seams", atlas, irradiance.size());
    const Stitching stitching(seam_points(scene, atlas), irradiance);
    const std::vector<glm::dvec3> change = stitching.change(irradiance);
    std::vector<glm::vec3> out = irradiance;
    for (std::size_t i = 0; i < change.size(); ++i) {
        glm::vec3& value = out[stitching.texels()[i]];
        value = glm::vec3(glm::max(glm::dvec3(value) + change[i], glm::dvec3(0.0)));
    }
    return out;
}

}  // namespace clgi
