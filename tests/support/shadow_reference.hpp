// Shadow maps in double precision, after the comment of kernels/lights/shadow.clh:
//
//   lit = bilinear weight of those of the four texels around that do not block. A texel blocks if
//         what it shows is nearer than the receiver's own plane there and nearer than the receiver,
//         both less a bias. If some texel does not, the planes of the others count: one blocks if
//         the plane that it shows, followed to the receiver, is nearer than that, too. If all are
//         nearer than the receiver, and so are all planes, all block
//   bias = texel_bias texels at 45 degrees + 1/64 of the plane's slope in x and y + 1e-6
//
// Where edges count, texels that show what is behind the receiver's plane, by the same with a
// quarter of a texel, have no weight, unless none has.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/emitters.hpp>
#include <cmath>
#include <cstring>
#include <vector>

#include "drawing.hpp"

namespace clgi::test {

constexpr double steepest = 114.6;  // of a receiver: the tangent of 89.5 degrees
constexpr double followed = 32.0;   // of what blocks

// A receiver on a view of a source.
struct Shadowed {
    const View* view = nullptr;  // null: no view sees it
    double x = 0.0, y = 0.0;     // texels from the centre of the upper left one
    double closeness = 0.0, slope_x = 0.0, slope_y = 0.0, bias = 0.0;
    double fall_x = 0.0, fall_y = 0.0;  // of a plane that blocks, from texel to texel, at most
    double behind = 0.0, behind_by_slopes = 0.0;  // what is behind the plane lies so far from it
    bool doubtful = false;                        // which view it is in depends on rounding

    // How much nearer than the receiver its plane is at a texel.
    double along(int column, int row) const { return slope_x * (column - x) + slope_y * (row - y); }
    // Closeness that a blocker at this texel must exceed.
    double limit(int column, int row) const {
        return closeness + bias + std::max(along(column, row), 0.0);
    }
    // k: 0 and 1 are the texels around the receiver, -1 and 2 those beyond.
    int column(int k) const {
        const int last = int(view->width) - 1;
        const int inner = std::clamp(int(std::floor(x)) + std::clamp(k, 0, 1), 0, last);
        return std::clamp(inner + (k < 0 ? -1 : k > 1 ? 1 : 0), 0, last);
    }
    int row(int k) const {
        const int last = int(view->height) - 1;
        const int inner = std::clamp(int(std::floor(y)) + std::clamp(k, 0, 1), 0, last);
        return std::clamp(inner + (k < 0 ? -1 : k > 1 ? 1 : 0), 0, last);
    }
    std::size_t texel(int kx, int ky) const {
        return view->first_pixel + std::size_t(row(ky)) * view->width + std::size_t(column(kx));
    }
};

inline Shadowed shadowed(const Emitter& emitter, const std::vector<View>& views,
                         const glm::dvec3& position, const glm::dvec3& geometric,
                         double texel_bias) {
    Shadowed out;
    for (std::uint32_t v = 0; v < emitter.view_count; ++v) {
        const View& view = views[emitter.first_view + v];
        const glm::dvec3 right(view.right), up(view.up), forward(view.forward);
        const glm::dvec3 d = position - glm::dvec3(view.eye);
        const double z = glm::dot(d, forward), near = double{view.forward.w};
        const bool parallel = view.eye.w != 0.0f;
        if (std::abs(z - near) < 1e-6) out.doubtful = true;
        if (!(z > near)) continue;
        const double per_z = parallel ? 1.0 : 1.0 / z;
        const double u =
            (glm::dot(d, right) * per_z - double{view.window.x}) / double{view.right.w};
        const double w = (glm::dot(d, up) * per_z - double{view.window.y}) / double{view.up.w};
        const double reach = std::max(std::abs(u), std::abs(w));
        if (std::abs(reach - 1.0) < 1e-4) out.doubtful = true;
        if (reach > 1.0) continue;
        const double texel_x = 2.0 * double{view.right.w} / view.width;
        const double texel_y = 2.0 * double{view.up.w} / view.height;
        // The receiver's plane, n.(eye + q - p) = 0, as closeness on the image plane.
        const double range = double{view.window.z} - near;
        const double steepness =
            parallel ? 1.0 / (glm::dot(geometric, forward) * range) : 1.0 / glm::dot(geometric, d);
        out.closeness = parallel ? (double{view.window.z} - z) / range : per_z;
        const double unit = parallel ? 1.0 / range : out.closeness;
        const auto capped = [&](double slope, double texel) {
            return std::clamp(slope * steepness, -steepest * unit, steepest * unit) * texel;
        };
        out.slope_x = capped(glm::dot(geometric, right), texel_x);
        out.slope_y = capped(-glm::dot(geometric, up), texel_y);  // rows run downwards
        out.behind_by_slopes =
            (std::abs(out.slope_x) + std::abs(out.slope_y)) / 64.0 + out.closeness * 1e-6;
        out.bias = unit * texel_bias * std::max(texel_x, texel_y) + out.behind_by_slopes;
        out.behind = unit * 0.25 * std::max(texel_x, texel_y) + out.behind_by_slopes;
        out.fall_x = followed * unit * texel_x;
        out.fall_y = followed * unit * texel_y;
        out.x = (u * 0.5 + 0.5) * view.width - 0.5;
        out.y = (0.5 - w * 0.5) * view.height - 0.5;
        out.view = &view;
        return out;
    }
    return out;
}

inline double closeness_of(std::uint64_t word) {
    const std::uint32_t bits = ~static_cast<std::uint32_t>(word >> 32);
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return double{value};
}

inline std::uint64_t word_of(float closeness, std::uint32_t triangle) {
    std::uint32_t bits;
    std::memcpy(&bits, &closeness, sizeof bits);
    return std::uint64_t{~bits} << 32 | triangle;
}

inline double weight_of(const Shadowed& at, int kx, int ky) {
    const double fx = at.x - std::floor(at.x), fy = at.y - std::floor(at.y);
    return (kx ? fx : 1.0 - fx) * (ky ? fy : 1.0 - fy);
}

inline bool is_past_edge(const Shadowed& at, int kx, int ky,
                         const std::vector<std::uint64_t>& visibility) {
    return closeness_of(visibility[at.texel(kx, ky)]) <
           at.closeness + at.along(at.column(kx), at.row(ky)) - at.behind;
}

// Weight of the texels that are not past the receiver's edge.
inline double known_share(const Shadowed& at, const std::vector<std::uint64_t>& visibility) {
    double out = 0.0;
    for (int k = 0; at.view && k < 4; ++k)
        if (!is_past_edge(at, k & 1, k >> 1, visibility)) out += weight_of(at, k & 1, k >> 1);
    return out;
}

// Share of light that arrives; sets doubtful where a comparison is within rounding.
inline double lit_share(const Shadowed& at, const std::vector<std::uint64_t>& visibility,
                        bool* doubtful, bool edges = false) {
    if (at.view == nullptr) return 1.0;
    const double known = edges ? known_share(at, visibility) : 0.0;
    double own = 0.0, all = 0.0;  // weights of texels that do not block, without and with planes
    bool some = false, within = false, follows = false;
    for (int ky = 0; ky < 2; ++ky)
        for (int kx = 0; kx < 2; ++kx) {
            const auto shown = [&](int x, int y) {
                return closeness_of(visibility[at.texel(x, y)]);
            };
            const double seen = shown(kx, ky);
            const double limit = at.limit(at.column(kx), at.row(ky));
            // 1e-6 of itself, as the bias has it, and what 16 roundings make of the slope.
            const double rounding = 8 * 0x1p-24 * (limit + 4 * (limit - at.closeness));
            if (std::abs(seen - limit) < rounding) *doubtful = true;
            const double past = at.closeness + at.along(at.column(kx), at.row(ky)) - at.behind;
            if (edges && std::abs(seen - past) < rounding) *doubtful = true;
            const bool counts = !(known > 0.0) || !is_past_edge(at, kx, ky, visibility);
            const double weight =
                counts ? weight_of(at, kx, ky) / (known > 0.0 ? known : 1.0) : 0.0;
            // What blocks, where the receiver is.
            const double rise_x = std::clamp(seen - shown(3 * kx - 1, ky), -at.fall_x, at.fall_x);
            const double rise_y = std::clamp(seen - shown(kx, 3 * ky - 1), -at.fall_y, at.fall_y);
            const double plane = seen + rise_x * std::abs(at.x - at.column(kx)) +
                                 rise_y * std::abs(at.y - at.row(ky));
            const double nearest = at.closeness + at.bias;
            // A place on the map is 8 spacings of its width off.
            const double moved =
                8 * 0x1p-24 *
                (std::abs(rise_x) * at.view->width + std::abs(rise_y) * at.view->height);
            if (std::abs(seen - nearest) < rounding) *doubtful = true;
            if (std::abs(plane - nearest) < 2.0 * rounding + moved) *doubtful = true;
            some |= seen <= limit;
            within |= seen <= nearest;
            follows |= plane <= nearest;
            if (seen <= limit) own += weight;
            if (seen <= limit || plane <= nearest) all += weight;
        }
    if (!within && !follows) return 0.0;
    return some ? all : own;
}

}  // namespace clgi::test
