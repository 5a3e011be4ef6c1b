// Charts from regions: laid flat, scaled and packed.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "methods/light_atlas/flatten.hpp"
#include "methods/light_atlas/pack.hpp"
#include "methods/light_atlas/placement.hpp"

namespace clgi {
namespace {

// Whole texels that hold a length; what rounding adds is no texel.
int texels_for(double length) { return std::max(1, static_cast<int>(std::ceil(length - 1e-9))); }

std::string times(double a, double b) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6g x %.6g", a, b);
    return text;
}

class Packing {
public:
    Packing(const std::vector<FlatChart>& charts, const AtlasOptions& options)
        : charts_(charts), options_(options) {
        for (const FlatChart& chart : charts) {
            area_ += chart.extent.x * chart.extent.y;
            if (chart.extent.x > longest_.x) longest_ = chart.extent;
        }
    }

    // No density above it can fit.
    double upper() const {
        return std::min(options_.size / longest_.x,
                        options_.size * std::sqrt(options_.most_pages / area_));
    }

    // The page has to hold the longest chart.
    bool holds_longest(double density) const {
        return longest_.x * density <= options_.size * (1.0 + 1e-9);
    }

    // Whether the charts fit at so many texels per metre; then boxes() and pages() are for these.
    bool fits(double density) {
        if (!holds_longest(density)) return false;
        std::vector<PackBox> boxes;
        boxes.reserve(charts_.size());
        smallest_ = true;
        for (const FlatChart& chart : charts_) {
            boxes.push_back(
                {texels_for(chart.extent.x * density), texels_for(chart.extent.y * density)});
            smallest_ = smallest_ && boxes.back().width == 1 && boxes.back().height == 1;
        }
        const int pages = pack(boxes, options_.size, options_.padding, options_.most_pages);
        if (pages == 0) return false;
        boxes_ = std::move(boxes);
        pages_ = pages;
        return true;
    }

    // Whether the last try had one texel for every chart.
    bool smallest() const { return smallest_; }
    const std::vector<PackBox>& boxes() const { return boxes_; }
    int pages() const { return pages_; }
    const glm::dvec2& longest() const { return longest_; }

private:
    const std::vector<FlatChart>& charts_;
    const AtlasOptions& options_;
    double area_ = 0.0;                     // of the rectangles, m^2
    glm::dvec2 longest_ = glm::dvec2(0.0);  // rectangle, metres
    bool smallest_ = false;
    std::vector<PackBox> boxes_;
    int pages_ = 0;
};

std::string room(const AtlasOptions& options) {
    return std::to_string(options.most_pages) + (options.most_pages == 1 ? " page" : " pages") +
           " of " + times(options.size, options.size) + " texels with " +
           std::to_string(options.padding) +
           " texels of padding; larger pages, or more of them, needed";
}

// The largest number of texels per metre that fits, to half a per cent.
double densest(Packing& packing, std::size_t charts, const AtlasOptions& options) {
    double high = packing.upper(), low = high;
    while (!packing.fits(low)) {
        if (packing.smallest())
            throw InputError("atlas: " + std::to_string(charts) +
                             " charts of at least a texel each do not fit on " + room(options));
        high = low;
        low *= 0.75;
    }
    while (high > 1.005 * low) {
        const double middle = std::sqrt(low * high);
        (packing.fits(middle) ? low : high) = middle;
    }
    return low;
}

double density_of(Packing& packing, std::size_t charts, const AtlasOptions& options) {
    const double density = options.texels_per_metre;
    if (density == 0.0) return densest(packing, charts, options);
    if (!packing.holds_longest(density))
        throw InputError("atlas: a chart of " + times(packing.longest().x, packing.longest().y) +
                         " m has " +
                         times(packing.longest().x * density, packing.longest().y * density) +
                         " texels, a page has " + times(options.size, options.size));
    if (!packing.fits(density))
        throw InputError("atlas: " + std::to_string(charts) + " charts at " +
                         std::to_string(density) + " texels per metre do not fit on " +
                         room(options));
    return density;
}

}  // namespace

AtlasPlacement place_by_regions(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                                const Adjacency* mesh, const AtlasOptions& options) {
    const std::vector<FlatChart> charts = flatten(scene, region_of, mesh);
    if (charts.empty()) throw InputError("atlas: no triangle of a region has an area");
    Packing packing(charts, options);
    AtlasPlacement out;
    out.texels_per_metre = density_of(packing, charts.size(), options);
    out.pages = packing.pages();
    out.corners.resize(3 * scene.triangles.size());
    out.triangle_chart.assign(scene.triangles.size(), no_chart);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const FlatChart& chart = charts[i];
        const PackBox& box = packing.boxes()[i];
        out.charts.push_back({box.page, box.column, box.row, box.width, box.height, chart.region});
        // In the middle of its box, and never beyond it by rounding.
        const glm::dvec2 first(box.column, box.row), size(box.width, box.height);
        const glm::dvec2 margin = 0.5 * (size - chart.extent * out.texels_per_metre);
        for (std::size_t j = 0; j < chart.triangles.size(); ++j) {
            const std::size_t t = chart.triangles[j];
            out.triangle_chart[t] = static_cast<std::uint32_t>(i);
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::dvec2 within = margin + chart.corners[3 * j + k] * out.texels_per_metre;
                out.corners[3 * t + k] =
                    (first + glm::clamp(within, glm::dvec2(0.0), size)) / double(options.size);
            }
        }
    }
    return out;
}

}  // namespace clgi
