// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/spot_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr int across = SPOT_TILES;

struct Box {
    int left, top, right, bottom;  // tiles
};

}  // namespace

void choose_tiles(const std::uint32_t* count, const float* area, std::uint32_t texels_a_tile,
                  float side, std::uint32_t* chosen) {
    const double texels = std::accumulate(count, count + spot_tiles, 0.0);
    const double lit_area = std::accumulate(area, area + spot_tiles, 0.0);
    int block = 1;
    if (texels > 0.0) {
        const double tile_area = lit_area / texels * texels_a_tile;
        while (block < across && block * block * tile_area < double{side} * side) block *= 2;
    }
    for (int top = 0; top < across; top += block)
        for (int left = 0; left < across; left += block) {
            double lit = 0.0;
            for (int k = 0; k < block * block; ++k)
                lit += area[(top + k / block) * across + left + k % block];
            for (int k = 0; k < block * block; ++k)
                chosen[(top + k / block) * across + left + k % block] =
                    lit < 0.5 * double{side} * side ? 1 : 0;
        }
}

void LitPower::add(double texel_power, const std::uint32_t* count, const std::uint32_t* chosen) {
    for (std::size_t k = 0; k < spot_tiles; ++k) {
        all_ += texel_power * count[k];
        if (chosen[k]) chosen_ += texel_power * count[k];
    }
}

std::size_t LitPower::vpls(std::size_t most, std::size_t places) const {
    const std::size_t least = std::max(std::size_t{16}, 2 * places);
    if (!(chosen_ < all_)) return most;  // also of nothing, or what is not finite
    const double root = std::sqrt(chosen_ / all_);
    const auto out = static_cast<std::size_t>(std::ceil(root * static_cast<double>(most)));
    return std::clamp(out, std::min(least, most), most);
}

void leave_chosen(std::uint32_t* count, const std::uint32_t* chosen) {
    for (std::size_t k = 0; k < spot_tiles; ++k)
        if (!chosen[k]) count[k] = 0;
}

std::vector<View> zoomed(const View& whole, const std::uint32_t* count,
                         const std::uint32_t* chosen) {
    std::vector<Box> boxes;
    for (int row = 0; row < across; ++row)
        for (int column = 0; column < across; ++column) {
            const int tile = row * across + column;
            if (!chosen[tile] || count[tile] == 0) continue;
            Box box{std::max(column - 1, 0), std::max(row - 1, 0), std::min(column + 2, across),
                    std::min(row + 2, across)};
            const auto meets = [&](const Box& other) {
                return box.left < other.right && other.left < box.right && box.top < other.bottom &&
                       other.top < box.bottom;
            };
            for (auto met = boxes.begin();
                 (met = std::find_if(boxes.begin(), boxes.end(), meets)) != boxes.end();) {
                box = {std::min(box.left, met->left), std::min(box.top, met->top),
                       std::max(box.right, met->right), std::max(box.bottom, met->bottom)};
                boxes.erase(met);
            }
            boxes.push_back(box);
        }
    std::vector<View> out;
    const auto share = [](int tiles) { return static_cast<float>(tiles) / across; };
    for (const Box& box : boxes) {
        out.push_back(whole);
        View& part = out.back();
        part.window.x += whole.right.w * (share(box.left + box.right) - 1.0f);
        part.window.y += whole.up.w * (1.0f - share(box.top + box.bottom));
        part.right.w *= share(box.right - box.left);
        part.up.w *= share(box.bottom - box.top);
    }
    return out;
}

std::vector<SpotSample> spot_samples(const std::vector<double>& texel_power,
                                     const std::vector<std::uint32_t>& count, std::size_t most) {
    double total = 0.0;
    std::size_t texels = 0;
    for (std::size_t i = 0; i < count.size(); ++i) {
        total += texel_power[i / spot_tiles] * count[i];
        if (texel_power[i / spot_tiles] > 0.0) texels += count[i];
    }
    if (!std::isfinite(total)) return {};
    const std::size_t wanted = std::min(most, texels);
    std::vector<SpotSample> out;
    double before = 0.0;
    std::size_t k = 0;
    for (std::size_t i = 0; i < count.size(); ++i) {
        const double each = texel_power[i / spot_tiles], power = each * count[i];
        if (!(power > 0.0)) continue;
        for (; k < wanted; ++k) {
            const double at = (static_cast<double>(k) + 0.5) / static_cast<double>(wanted) * total;
            if (at >= before + power) break;
            const auto rank = static_cast<std::uint32_t>((at - before) / each);
            out.push_back({static_cast<std::uint32_t>(i / spot_tiles),
                           static_cast<std::uint32_t>(i % spot_tiles), std::min(rank, count[i] - 1),
                           static_cast<float>(total / (each * static_cast<double>(wanted)))});
        }
        before += power;
    }
    return out;
}

std::vector<Vpl> thinned(const std::vector<Vpl>& vpls, std::size_t most) {
    double total = 0.0, before = 0.0;
    for (const Vpl& one : vpls) total += luminance(glm::dvec3(one.flux));
    if (!(total > 0.0) || !std::isfinite(total)) return {};
    if (vpls.size() <= most) return vpls;
    const double each = total / static_cast<double>(most);
    std::vector<Vpl> out;
    for (const Vpl& one : vpls) {
        const double power = luminance(glm::dvec3(one.flux));
        while (out.size() < most) {
            const double at = (static_cast<double>(out.size()) + 0.5) * each;
            if (at >= before + power) break;
            const auto share = static_cast<float>(each / power);
            out.push_back(one);
            for (int c = 0; c < 3; ++c) (&out.back().flux.x)[c] *= share;
        }
        before += power;
    }
    return out;
}

}  // namespace clgi
