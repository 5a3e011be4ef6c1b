// SPDX-License-Identifier: MIT
#include "methods/light_atlas/even_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi {
namespace {

// Steps of the additive sequence of lowest discrepancy in the plane: 1/g, 1/g^2 with g^3 = g + 1.
constexpr double step1 = 0.7548776662466927, step2 = 0.5698402909980532;

// A little off the axes, so that no face of a building lies in a plane of cutting.
glm::dvec3 direction(int axis) {
    glm::dvec3 out(0.0);
    out[axis] = 1.0;
    out[(axis + 1) % 3] = 1e-3;
    out[(axis + 2) % 3] = -0.7e-3;
    return out;
}

class Bisection {
public:
    Bisection(const std::vector<PieceTriangle>& triangles, double jitter)
        : triangles_(triangles), jitter_(jitter) {}

    std::vector<EvenPoint> operator()(std::uint32_t count) {
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) stack_.push_back(whole_triangle(t));
        if (!stack_.empty() && count > 0) divide(0, count);
        return std::move(out_);
    }

private:
    struct Axes {
        int longest, second;
    };

    Axes axes_of(std::size_t begin) const {
        constexpr double far = std::numeric_limits<double>::infinity();
        glm::dvec3 low(far), high(-far);
        for (std::size_t i = begin; i < stack_.size(); ++i) {
            const PieceTriangle& t = triangles_[stack_[i].triangle];
            for (std::uint32_t k = 0; k < stack_[i].count; ++k) {
                const glm::dvec2& b = stack_[i].corners[k];
                const glm::dvec3 p = t.first + b.x * t.edge1 + b.y * t.edge2;
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
        }
        const glm::dvec3 size = high - low;
        int order[3] = {0, 1, 2};
        std::stable_sort(order, order + 3, [&](int a, int b) { return size[a] > size[b]; });
        return {order[0], order[1]};
    }

    double area_from(std::size_t begin) const {
        double sum = 0.0;
        for (std::size_t i = begin; i < stack_.size(); ++i) sum += area_of(triangles_, stack_[i]);
        return sum;
    }

    // The pieces from `begin` on are the cell; they are taken off the stack.
    void divide(std::size_t begin, std::uint32_t count) {
        const Axes axes = axes_of(begin);
        const double area = area_from(begin);
        if (count == 1) {
            place(begin, axes, area, 0.0, 1.0);
            stack_.resize(begin);
            return;
        }
        const std::uint32_t lower = count / 2;
        const glm::dvec3 along = direction(axes.longest);
        const double height = height_with_area(triangles_, &stack_[begin], stack_.size() - begin,
                                               along, area * lower / count);
        std::vector<Piece>&below = below_, &above = above_;
        below.clear();
        above.clear();
        const std::size_t end = stack_.size();
        for (std::size_t i = begin; i < end; ++i) {
            const Slope slope(triangles_[stack_[i].triangle], along);
            cut(stack_[i], slope, height, below, above);
        }
        drop_dust(below, 1e-12 * area);
        drop_dust(above, 1e-12 * area);
        if (below.empty() || above.empty()) {
            // Not to be cut, as far as doubles go: strips side by side.
            for (std::uint32_t i = 0; i < count; ++i)
                place(begin, axes, area, double(i) / count, 1.0 / count);
            stack_.resize(begin);
            return;
        }
        stack_.resize(begin);
        stack_.insert(stack_.end(), above.begin(), above.end());
        const std::size_t middle = stack_.size();
        stack_.insert(stack_.end(), below.begin(), below.end());
        divide(middle, lower);
        divide(begin, count - lower);
    }

    void drop_dust(std::vector<Piece>& pieces, double area) const {
        pieces.erase(std::remove_if(
                         pieces.begin(), pieces.end(),
                         [&](const Piece& piece) { return !(area_of(triangles_, piece) > area); }),
                     pieces.end());
    }

    // One point with a part from + [0, share] of the cell's area below it along one axis, and a
    // part of the crossing before it along the other: never off the surface.
    void place(std::size_t begin, const Axes& axes, double area, double from, double share) {
        const double number = double(out_.size()) + 1.0;
        const double u = 0.5 + jitter_ * (std::fmod(step1 * number, 1.0) - 0.5);
        const double v = 0.5 + jitter_ * (std::fmod(step2 * number, 1.0) - 0.5);
        const glm::dvec3 along = direction(axes.longest), across = direction(axes.second);
        const double height = height_with_area(triangles_, &stack_[begin], stack_.size() - begin,
                                               along, area * (from + share * u));
        crossings_.clear();
        double width = 0.0;
        for (std::size_t i = begin; i < stack_.size(); ++i) {
            const PieceTriangle& t = triangles_[stack_[i].triangle];
            const Slope rise(t, across);
            Crossing c = part_below(triangles_, stack_[i], Slope(t, along), height).crossing;
            if (!(c.width > 0.0)) continue;
            if (rise(c.from) > rise(c.to)) std::swap(c.from, c.to);
            crossings_.push_back({rise(c.from) + rise(c.to), stack_[i].triangle, c});
            width += c.width;
        }
        if (crossings_.empty()) {  // the plane only touches a corner: the middle of a piece
            glm::dvec2 sum(0.0);
            const Piece& piece = stack_[begin];
            for (std::uint32_t k = 0; k < piece.count; ++k) sum += piece.corners[k];
            out_.push_back({piece.triangle, sum / double(piece.count)});
            return;
        }
        std::sort(crossings_.begin(), crossings_.end(), [](const Crossed& a, const Crossed& b) {
            return a.place != b.place ? a.place < b.place : a.triangle < b.triangle;
        });
        double left = v * width;
        std::size_t i = 0;
        while (i + 1 < crossings_.size() && left > crossings_[i].crossing.width)
            left -= crossings_[i++].crossing.width;
        const Crossing& c = crossings_[i].crossing;
        const double part = std::clamp(left / c.width, 0.0, 1.0);
        out_.push_back({crossings_[i].triangle, c.from + part * (c.to - c.from)});
    }

    struct Crossed {
        double place;  // along the other axis
        std::uint32_t triangle;
        Crossing crossing;
    };

    const std::vector<PieceTriangle>& triangles_;
    const double jitter_;
    std::vector<Piece> stack_, below_, above_;
    std::vector<Crossed> crossings_;
    std::vector<EvenPoint> out_;
};

}  // namespace

std::vector<EvenPoint> even_points(const std::vector<PieceTriangle>& triangles, std::uint32_t count,
                                   double jitter) {
    return Bisection(triangles, jitter)(count);
}

}  // namespace clgi
