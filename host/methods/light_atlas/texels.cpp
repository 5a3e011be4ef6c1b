// The texels that charts cover: exact shares by clipping, centres by the rule of a lightmap.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cfloat>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <string>

#include "methods/light_atlas/clip.hpp"
#include "methods/light_atlas/placement.hpp"
#include "scene/texel_centre.hpp"

namespace clgi {
namespace {

// What one chart covers of one texel.
struct ChartShare {
    double coverage = 0.0;          // texels^2
    double area = 0.0;              // m^2
    std::uint32_t next = no_index;  // share of the same texel
    std::uint32_t chart = 0;
    std::uint32_t triangle = 0;
    float b1 = 0.0f, b2 = 0.0f;
    float largest = -1.0f;  // part of a triangle, texels^2; beyond any at the centre
};
constexpr float at_the_centre = 2.0f;

enum class Place { outside, within, across };

// Half-planes of a triangle's edges, in texels; positive inside.
class Edges {
public:
    explicit Edges(const std::array<glm::dvec2, 3>& corner) : corner_(corner) {
        const double whole = doubled(corner[0], corner[1], corner[2]);
        inverse_ = 1.0 / whole;
        for (std::size_t k = 0; k < 3; ++k) {
            along_[k] = (whole > 0.0 ? 1.0 : -1.0) * (corner[(k + 2) % 3] - corner[(k + 1) % 3]);
            reach_[k] = 0.5 * (std::abs(along_[k].x) + std::abs(along_[k].y));
        }
    }

    double area() const { return 0.5 / std::abs(inverse_); }

    // Of a texel's square to the triangle; `across` where they may overlap in part.
    Place of(int column, int row) const {
        const glm::dvec2 centre(column + 0.5, row + 0.5);
        bool within = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2 to = centre - corner_[(k + 1) % 3];
            const double distance = along_[k].x * to.y - along_[k].y * to.x;
            if (distance <= -reach_[k]) return Place::outside;
            within = within && distance >= reach_[k];
        }
        return within ? Place::within : Place::across;
    }

    glm::dvec2 weights(const glm::dvec2& p) const {
        return {doubled(corner_[2], corner_[0], p) * inverse_,
                doubled(corner_[0], corner_[1], p) * inverse_};
    }

private:
    static double doubled(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    }

    std::array<glm::dvec2, 3> corner_, along_{};
    std::array<double, 3> reach_{};
    double inverse_ = 0.0;
};

class Lister {
public:
    Lister(const Scene& scene, const AtlasPlacement& placed, int size)
        : scene_(scene), placed_(placed), size_(size), side_(static_cast<std::size_t>(size)) {
        first_.assign(side_ * side_ * static_cast<std::size_t>(placed.pages), no_index);
        shares_.reserve(std::min(expected_shares(), first_.size()));
    }

    void add(std::uint32_t t) {
        const double on_surface = 0.5 * glm::length(doubled_area_of(scene_, t));
        const std::uint32_t chart = placed_.triangle_chart[t];
        if (chart == no_chart) {
            skipped_ += on_surface;
            return;
        }
        std::array<glm::dvec2, 3> unit, corner;
        for (std::size_t k = 0; k < 3; ++k) {
            unit[k] = placed_.corners[3 * std::size_t{t} + k];
            corner[k] = unit[k] * double(size_);
        }
        const TexelCentre centre(unit, size_);
        const Edges edges(corner);
        if (centre.without_area() || !(edges.area() > 0.0)) {
            skipped_ += on_surface;
            return;
        }
        // Less is what rounding puts beyond the edge of a texel.
        const double least = 1e-9 * std::min(1.0, edges.area());
        const glm::dvec2 low = glm::min(corner[0], glm::min(corner[1], corner[2]));
        const glm::dvec2 high = glm::max(corner[0], glm::max(corner[1], corner[2]));
        const glm::ivec2 from(glm::clamp(glm::floor(low), 0.0, double(size_)));
        const glm::ivec2 to(glm::clamp(glm::ceil(high), 0.0, double(size_)));
        double listed = 0.0;
        for (int row = from.y; row < to.y; ++row)
            for (int column = from.x; column < to.x; ++column) {
                const Place place = edges.of(column, row);
                if (place == Place::outside) continue;
                ClippedPart part{1.0, {column + 0.5, row + 0.5}};
                if (place == Place::across) part = clip_to_texel(corner, column, row);
                glm::dvec2 weights(0.0);
                const bool at_centre = centre.covers(column, row, weights.x, weights.y);
                if (!at_centre && !(part.area > least)) continue;
                listed += part.area;
                ChartShare& share = find(chart, column, row);
                share.coverage += part.area;
                share.area += part.area / edges.area() * on_surface;
                const float rank = at_centre ? at_the_centre : static_cast<float>(part.area);
                if (rank <= share.largest) continue;
                share.largest = rank;
                share.triangle = t;
                if (!at_centre) weights = edges.weights(part.centroid);
                share.b1 = static_cast<float>(weights.x);
                share.b2 = static_cast<float>(weights.y);
            }
        const double missing = 1.0 - listed / edges.area();
        if (missing > 1e-9) skipped_ += missing * on_surface;
    }

    void finish(AtlasLayout& layout) {
        std::size_t shared = 0;
        layout.texels.reserve(shares_.size());
        for (std::size_t texel = 0; texel < first_.size(); ++texel) {
            if (first_[texel] == no_index) continue;
            const ChartShare* chosen = &shares_[first_[texel]];
            shared += chosen->next != no_index;
            for (std::uint32_t i = chosen->next; i != no_index; i = shares_[i].next)
                if (better(shares_[i], *chosen)) chosen = &shares_[i];
            for (std::uint32_t i = first_[texel]; i != no_index; i = shares_[i].next)
                if (&shares_[i] != chosen) skipped_ += shares_[i].area;
            layout.texels.push_back(listed(static_cast<std::uint32_t>(texel), *chosen));
        }
        if (shared > 0)
            layout.warnings.push_back(std::to_string(shared) + " of " +
                                      std::to_string(layout.texels.size()) +
                                      " texels are shared by charts; one of them counts");
        layout.skipped_area = skipped_;
    }

private:
    // What triangles cover, and a texel for every one along the sides of their charts. A guess: a
    // chart may be the frame around others, so its box says little.
    std::size_t expected_shares() const {
        double covered = 0.0;
        for (std::size_t t = 0; t < placed_.triangle_chart.size(); ++t) {
            if (placed_.triangle_chart[t] == no_chart) continue;
            const glm::dvec2* corner = placed_.corners.data() + 3 * t;
            const glm::dvec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
            covered += 0.5 * std::abs(a.x * b.y - a.y * b.x) * double(size_) * double(size_);
        }
        for (const AtlasChart& chart : placed_.charts)
            covered += 2.0 * (chart.width + chart.height);
        return static_cast<std::size_t>(std::min(covered, 1e18));
    }

    ChartShare& find(std::uint32_t chart, int column, int row) {
        const auto page = static_cast<std::size_t>(placed_.charts[chart].page);
        const std::size_t texel = (page * side_ + static_cast<std::size_t>(row)) * side_ +
                                  static_cast<std::size_t>(column);
        std::uint32_t* link = &first_[texel];
        while (*link != no_index) {
            if (shares_[*link].chart == chart) return shares_[*link];
            link = &shares_[*link].next;
        }
        *link = static_cast<std::uint32_t>(shares_.size());
        ChartShare share;
        share.chart = chart;
        shares_.push_back(share);
        return shares_.back();
    }

    // Of several centres the first triangle counts, as for the reference.
    static bool better(const ChartShare& a, const ChartShare& b) {
        const bool centre = a.largest == at_the_centre;
        if (centre != (b.largest == at_the_centre)) return centre;
        if (centre) return a.triangle < b.triangle;
        return a.coverage != b.coverage ? a.coverage > b.coverage : a.chart < b.chart;
    }

    static AtlasTexel listed(std::uint32_t texel, const ChartShare& share) {
        AtlasTexel out{};
        out.texel = texel;
        out.triangle = share.triangle;
        out.b1 = std::clamp(share.b1, 0.0f, 1.0f);
        out.b2 = std::clamp(share.b2, 0.0f, 1.0f);
        if (out.b1 + out.b2 > 1.0f) out.b2 = 1.0f - out.b1;
        out.coverage = std::clamp(static_cast<float>(share.coverage), FLT_MIN, 1.0f);
        out.area = static_cast<float>(share.area);
        out.chart = share.chart;
        out.centre = share.largest == at_the_centre;
        return out;
    }

    const Scene& scene_;
    const AtlasPlacement& placed_;
    int size_;
    std::size_t side_;
    std::vector<std::uint32_t> first_;  // [pages * size * size] share, or no_index
    std::vector<ChartShare> shares_;
    double skipped_ = 0.0;
};

}  // namespace

void need_countable_texels(const char* name, int size, int pages) {
    const auto side = static_cast<std::uint64_t>(size);
    if (static_cast<std::uint64_t>(pages) > no_index / (side * side))
        throw InputError(std::string(name) + ": " + std::to_string(pages) + " pages of " +
                         std::to_string(size) + " texels a side, at most 2^32 - 1 texels needed");
}

void list_texels(const Scene& scene, const AtlasPlacement& placed, AtlasLayout& layout) {
    need_countable_texels("atlas", layout.size, placed.pages);
    Lister lister(scene, placed, layout.size);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) lister.add(t);
    lister.finish(layout);

    layout.charts = placed.charts;
    layout.triangle_chart = placed.triangle_chart;
    layout.triangle_page.assign(scene.triangles.size(), no_index);
    layout.uvs.resize(3 * scene.triangles.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (placed.triangle_chart[t] == no_chart) continue;
        layout.triangle_page[t] =
            static_cast<std::uint32_t>(placed.charts[placed.triangle_chart[t]].page);
        for (std::size_t k = 0; k < 3; ++k)
            layout.uvs[3 * t + k] = glm::vec2(placed.corners[3 * t + k] * double(layout.size));
    }
}

}  // namespace clgi
