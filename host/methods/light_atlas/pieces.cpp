// SPDX-License-Identifier: MIT
#include "methods/light_atlas/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

glm::dvec2 point_between(const glm::dvec2& a, double height_a, const glm::dvec2& b, double height_b,
                         double height) {
    return a + (height - height_a) / (height_b - height_a) * (b - a);
}

// A part of a piece, which rounding may make cross the plane more than twice.
struct Polygon {
    std::array<glm::dvec2, 2 * Piece::most> corners;
    std::uint32_t count = 0;
    void add(const glm::dvec2& corner) { corners[count++] = corner; }

    void append(std::uint32_t triangle, std::vector<Piece>& out) const {
        // A fan of pieces where there are too many corners, none of them full again at once.
        const std::uint32_t step = count <= Piece::most ? Piece::most - 2 : Piece::most - 4;
        for (std::uint32_t first = 1; first + 1 < count; first += step) {
            Piece piece{triangle, 1, {}};
            piece.corners[0] = corners[0];
            for (std::uint32_t i = first; i <= std::min(first + step, count - 1); ++i)
                piece.corners[piece.count++] = corners[i];
            out.push_back(piece);
        }
    }
};

}  // namespace

Piece whole_triangle(std::uint32_t triangle) {
    Piece out{triangle, 3, {}};
    out.corners[1] = glm::dvec2(1.0, 0.0);
    out.corners[2] = glm::dvec2(0.0, 1.0);
    return out;
}

double area_of(const std::vector<PieceTriangle>& triangles, const Piece& piece) {
    double sum = 0.0;
    for (std::uint32_t i = 2; i < piece.count; ++i)
        sum += cross(piece.corners[i - 1] - piece.corners[0], piece.corners[i] - piece.corners[0]);
    return 0.5 * sum * triangles[piece.triangle].twice_area;
}

Below part_below(const std::vector<PieceTriangle>& triangles, const Piece& piece,
                 const Slope& slope, double height) {
    Below out;
    glm::dvec2 first, last;
    glm::dvec2 crossings[2];
    int crossed = 0;
    bool any = false;
    double sum = 0.0;
    const auto corner = [&](const glm::dvec2& b) {
        if (!any) first = b;
        if (any) sum += cross(last - first, b - first);
        any = true;
        last = b;
    };
    glm::dvec2 a = piece.corners[piece.count - 1];
    double height_a = slope(a);
    for (std::uint32_t i = 0; i < piece.count; ++i) {
        const glm::dvec2 b = piece.corners[i];
        const double height_b = slope(b);
        if ((height_a <= height) != (height_b <= height)) {
            const glm::dvec2 between = point_between(a, height_a, b, height_b, height);
            corner(between);
            if (crossed < 2) crossings[crossed++] = between;
        }
        if (height_b <= height) corner(b);
        a = b;
        height_a = height_b;
    }
    const double twice_area = triangles[piece.triangle].twice_area;
    out.area = 0.5 * sum * twice_area;
    const double steepness = std::hypot(slope.along1, slope.along2);
    if (crossed == 2 && steepness > 0.0) {
        out.crossing.from = crossings[0];
        out.crossing.to = crossings[1];
        out.crossing.width = twice_area * glm::length(crossings[1] - crossings[0]) / steepness;
    }
    return out;
}

double height_with_area(const std::vector<PieceTriangle>& triangles, const Piece* pieces,
                        std::size_t count, const glm::dvec3& direction, double area) {
    struct Candidate {
        const Piece* piece;
        Slope slope;
        double low, high, area;
    };
    thread_local std::vector<Candidate> open;
    open.clear();
    double low = std::numeric_limits<double>::infinity(), high = -low, total = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Slope slope(triangles[pieces[i].triangle], direction);
        Candidate c{&pieces[i], slope, slope(pieces[i].corners[0]), 0.0,
                    area_of(triangles, pieces[i])};
        c.high = c.low;
        for (std::uint32_t k = 1; k < pieces[i].count; ++k) {
            const double h = slope(pieces[i].corners[k]);
            c.low = std::min(c.low, h);
            c.high = std::max(c.high, h);
        }
        low = std::min(low, c.low);
        high = std::max(high, c.high);
        total += c.area;
        open.push_back(c);
    }

    // Newton's method between bounds. What lies wholly on one side of the bounds is left behind.
    double settled = 0.0;  // area below `low`
    double height = low + area / total * (high - low);
    for (int step = 0; step < 200; ++step) {
        double below = settled, width = 0.0;
        for (const Candidate& c : open) {
            if (c.high <= height) {
                below += c.area;
            } else if (c.low < height) {
                const Below part = part_below(triangles, *c.piece, c.slope, height);
                below += part.area;
                width += part.crossing.width;
            }
        }
        const double error = below - area;
        if (std::abs(error) <= 1e-12 * total) return height;
        (error < 0.0 ? low : high) = height;
        std::size_t kept = 0;
        for (const Candidate& c : open) {
            if (c.high <= low)
                settled += c.area;
            else if (c.low < high)
                open[kept++] = c;
        }
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(kept), open.end());
        double next = width > 0.0 ? height - error / width : low;
        // Every third step halves, whatever Newton says.
        if (!(next > low && next < high) || step % 3 == 2) next = 0.5 * (low + high);
        if (next == height || !(next > low && next < high)) break;  // nothing lies between
        height = next;
    }
    return high;
}

void cut(const Piece& piece, const Slope& slope, double height, std::vector<Piece>& below,
         std::vector<Piece>& above) {
    Polygon parts[2];
    glm::dvec2 a = piece.corners[piece.count - 1];
    double height_a = slope(a);
    for (std::uint32_t i = 0; i < piece.count; ++i) {
        const glm::dvec2 b = piece.corners[i];
        const double height_b = slope(b);
        if ((height_a <= height) != (height_b <= height)) {
            const glm::dvec2 between = point_between(a, height_a, b, height_b, height);
            parts[0].add(between);
            parts[1].add(between);
        }
        parts[height_b <= height ? 0 : 1].add(b);
        a = b;
        height_a = height_b;
    }
    parts[0].append(piece.triangle, below);
    parts[1].append(piece.triangle, above);
}

}  // namespace clgi
