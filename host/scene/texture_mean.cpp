// SPDX-License-Identifier: MIT
#include "scene/texture_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/texture_pool.hpp"

namespace clgi {
namespace {

constexpr int block = 16;  // columns between stored sums
// Texels: below this area a triangle is a line or a point, and the quotient of two small numbers
// would be noise.
constexpr double least_area = 1e-6;
constexpr double most_crossings = 65536.0;             // of texels, by the edges of one triangle
constexpr int fewest_samples = 8, most_samples = 256;  // along a side of a lattice

int wrapped(long long i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp_to_edge) return static_cast<int>(std::clamp<long long>(i, 0, size - 1));
    const long long period = wrap == Wrap::repeat ? size : 2LL * size;
    const long long folded = ((i % period) + period) % period;
    return static_cast<int>(folded < size ? folded : period - 1 - folded);
}

// By how much a coordinate may be moved so that it is near 0 and finds the same texels.
double whole_periods(double lowest, Wrap wrap) {
    return wrap == Wrap::clamp_to_edge ? 0.0 : 2.0 * std::floor(0.5 * lowest);
}

// Towards the next line of texels. t: where it lies between the ends of an edge.
struct Walk {
    Walk(double from, double to) : from_(from), length_(to - from), step_(to >= from ? 1 : -1) {
        cell = static_cast<long long>(step_ > 0 ? std::floor(from) : std::ceil(from) - 1.0);
        find();
    }
    void advance() {
        cell += step_;
        find();
    }
    long long cell;
    double next;

private:
    void find() {
        const double line = static_cast<double>(step_ > 0 ? cell + 1 : cell);
        next = length_ == 0.0 ? std::numeric_limits<double>::infinity() : (line - from_) / length_;
    }
    double from_, length_;
    int step_;
};

}  // namespace

UvTriangle slot_uvs(const Scene& scene, const SceneTriangle& triangle, const TextureSlot& slot) {
    UvTriangle out;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec4& both = scene.uvs[triangle.vertex[k]];
        const glm::dvec2 uv(slot.uv_set == 0 ? glm::vec2(both.x, both.y)
                                             : glm::vec2(both.z, both.w));
        out[k] = glm::dvec2(glm::dmat3(slot.transform) * glm::dvec3(uv, 1.0));
    }
    return out;
}

TextureMean::TextureMean(const Texture& texture, bool sums) : texture_(&texture) {
    const std::vector<float> srgb = srgb_decode_table();
    for (std::size_t i = 0; i < 256; ++i)
        decode_[i] = texture.srgb ? srgb[i] : static_cast<float>(i) / 255.0f;
    if (!sums) return;
    blocks_ = static_cast<std::size_t>(texture.width) / block + 1;
    sums_.reserve(blocks_ * static_cast<std::size_t>(texture.height));
    for (int row = 0; row < texture.height; ++row) {
        Color sum(0.0);
        for (int column = 0; column < static_cast<int>(blocks_) * block; ++column) {
            if (column % block == 0) sums_.push_back(sum);
            if (column < texture.width) sum += texel(column, row);
        }
    }
}

TextureMean::Color TextureMean::texel(long long column, int row) const {
    const std::size_t x =
        static_cast<std::size_t>(wrapped(column, texture_->width, texture_->wrap_s));
    const std::uint8_t* rgba =
        &texture_->rgba[4 * (static_cast<std::size_t>(row) * texture_->width + x)];
    return {decode_[rgba[0]], decode_[rgba[1]], decode_[rgba[2]]};
}

int TextureMean::wrapped_row(long long row) const {
    return wrapped(row, texture_->height, texture_->wrap_t);
}

// Of the texels from column 0 up to this one, which may lie anywhere; less those before 0.
TextureMean::Color TextureMean::row_sum(long long column, int row) const {
    const long long width = texture_->width;
    const auto within = [&](long long i) {  // 0 <= i <= width
        const long long first = i / block * block;
        Color sum =
            sums_[static_cast<std::size_t>(row) * blocks_ + static_cast<std::size_t>(i / block)];
        for (long long k = first; k < i; ++k) sum += texel(k, row);
        return sum;
    };
    if (texture_->wrap_s == Wrap::clamp_to_edge) {
        if (column < 0) return static_cast<double>(column) * texel(0, row);
        if (column <= width) return within(column);
        return within(width) + static_cast<double>(column - width) * texel(width - 1, row);
    }
    const bool mirrored = texture_->wrap_s == Wrap::mirrored_repeat;
    const long long period = mirrored ? 2 * width : width;
    long long rest = column % period;
    if (rest < 0) rest += period;
    const Color once = within(width) * (mirrored ? 2.0 : 1.0);
    // The second half of a mirrored period is the first from its end.
    const Color sum = rest <= width ? within(rest) : once - within(period - rest);
    return sum + once * static_cast<double>((column - rest) / period);
}

// Integral of a row from its first texel's centre (nearest: left side) to `x` beyond a column's.
TextureMean::Color TextureMean::along_row(long long column, int row, double x) const {
    const Color sum = row_sum(column, row), here = texel(column, row);
    if (texture_->nearest) return sum + x * here;
    const Color next = texel(column + 1, row);
    return sum + 0.5 * (here - texel(0, row)) + x * here + 0.5 * x * x * (next - here);
}

glm::dvec2 TextureMean::to_texels(const glm::dvec2& uv) const {
    const glm::dvec2 size(texture_->width, texture_->height);
    return uv * size - (texture_->nearest ? 0.0 : 0.5);
}

// The integral of F dy along an edge, in texels.
TextureMean::Color TextureMean::edge(const glm::dvec2& from, const glm::dvec2& to) const {
    Color sum(0.0);
    const glm::dvec2 along = to - from;
    if (along.y == 0.0) return sum;
    Walk columns(from.x, to.x), rows(from.y, to.y);
    const double gauss = 0.5 / std::sqrt(3.0);
    for (double t = 0.0; t < 1.0;) {
        const double end = std::min({columns.next, rows.next, 1.0});
        const int upper = wrapped_row(rows.cell), lower = wrapped_row(rows.cell + 1);
        for (const double side : {-gauss, gauss}) {
            const double at = 0.5 * (t + end) + side * (end - t);
            const double x = from.x + at * along.x - static_cast<double>(columns.cell);
            const double y = from.y + at * along.y - static_cast<double>(rows.cell);
            Color here = along_row(columns.cell, upper, x);
            if (!texture_->nearest) here += y * (along_row(columns.cell, lower, x) - here);
            sum += 0.5 * (end - t) * along.y * here;
        }
        if (columns.next <= end) columns.advance();
        if (rows.next <= end) rows.advance();
        t = end;
    }
    return sum;
}

TextureMean::Color TextureMean::lattice(const UvTriangle& uv, int side) const {
    Color sum(0.0);
    for_lattice(side, [&](const glm::dvec3& weight) { sum += at(between(uv, weight)); });
    return sum / (static_cast<double>(side) * side);
}

double TextureMean::extent(const UvTriangle& uv) const {
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 side = glm::abs(to_texels(uv[(k + 1) % 3]) - to_texels(uv[k]));
        longest = std::max({longest, side.x, side.y});
    }
    return longest;
}

glm::dvec3 TextureMean::over(const UvTriangle& uv) const {
    const glm::dvec2 lowest = glm::min(uv[0], glm::min(uv[1], uv[2]));
    const glm::dvec2 back(whole_periods(lowest.x, texture_->wrap_s),
                          whole_periods(lowest.y, texture_->wrap_t));
    std::array<glm::dvec2, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) corner[k] = to_texels(uv[k] - back);
    const glm::dvec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double area = 0.5 * (a.x * b.y - a.y * b.x);
    const double texels = extent(uv);
    if (!(std::abs(area) > least_area) || !(texels < most_crossings))
        return lattice(uv, static_cast<int>(std::clamp(2.0 * texels, double{fewest_samples},
                                                       double{most_samples})));
    Color sum(0.0);
    for (std::size_t k = 0; k < 3; ++k) sum += edge(corner[k], corner[(k + 1) % 3]);
    // Rounding may leave a black one a little below 0.
    return glm::max(sum / area, glm::dvec3(0.0));
}

TextureMean::Point TextureMean::point_at(const glm::dvec2& uv) const {
    const glm::dvec2 back(whole_periods(uv.x, texture_->wrap_s),
                          whole_periods(uv.y, texture_->wrap_t));
    const glm::dvec2 most = glm::dvec2(texture_->width, texture_->height) * 4.0;
    const glm::dvec2 p = glm::clamp(to_texels(uv - back), -most, most);
    const glm::dvec2 whole = glm::floor(p);
    return {static_cast<long long>(whole.x), static_cast<long long>(whole.y), p.x - whole.x,
            p.y - whole.y};
}

glm::dvec3 TextureMean::at(const glm::dvec2& uv) const {
    const Point p = point_at(uv);
    const int upper = wrapped_row(p.row), lower = wrapped_row(p.row + 1);
    if (texture_->nearest) return texel(p.column, upper);
    return glm::mix(glm::mix(texel(p.column, upper), texel(p.column + 1, upper), p.x),
                    glm::mix(texel(p.column, lower), texel(p.column + 1, lower), p.x), p.y);
}

double TextureMean::alpha(const glm::dvec2& uv) const {
    const Point p = point_at(uv);
    const auto read = [&](long long column, long long row) {
        const auto x = static_cast<std::size_t>(wrapped(column, texture_->width, texture_->wrap_s));
        const auto y = static_cast<std::size_t>(wrapped_row(row));
        return texture_->rgba[4 * (y * static_cast<std::size_t>(texture_->width) + x) + 3] / 255.0;
    };
    if (texture_->nearest) return read(p.column, p.row);
    return glm::mix(glm::mix(read(p.column, p.row), read(p.column + 1, p.row), p.x),
                    glm::mix(read(p.column, p.row + 1), read(p.column + 1, p.row + 1), p.x), p.y);
}

}  // namespace clgi
