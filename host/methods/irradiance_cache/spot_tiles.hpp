// Which tiles of a light's view light by VPLs, and where in them VPLs lie.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/cache.h>
#include <clgi/shared/gbuffer.h>
#include <clgi/shared/lights.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi {

constexpr std::size_t spot_tiles = SPOT_TILES_A_VIEW;

// Marks the tiles of a view in which less is lit than half a square of this side, which is what the
// pixels of hemicubes resolve, or nothing. Tiles that are smaller than the square are judged by
// blocks of them. count, area: of cache_tally; chosen: 0 or 1; all [SPOT_TILES_A_VIEW].
void choose_tiles(const std::uint32_t* count, const float* area, std::uint32_t texels_a_tile,
                  float side, std::uint32_t* chosen);

// What views of lights light, by the power that one texel of each sends, about.
class LitPower {
public:
    // count, chosen: [SPOT_TILES_A_VIEW] of a view.
    void add(double texel_power, const std::uint32_t* count, const std::uint32_t* chosen);
    // How many of `most` VPLs stand for what is lit in chosen tiles, which is so many places: all
    // where these have all of the power, and else by the root of their share of it, but two for
    // each place, and 16, where `most` allows. Each of the fewer VPLs then stands for less of all
    // light than each of all of them would.
    std::size_t vpls(std::size_t most, std::size_t places) const;

private:
    double all_ = 0.0, chosen_ = 0.0;
};

// Leaves of the texels of a view those in chosen tiles.
void leave_chosen(std::uint32_t* count, const std::uint32_t* chosen);

// Parts of the view that hold the chosen tiles in which something is lit, and those beside them:
// what is lit may go on there between texels. None overlap.
std::vector<View> zoomed(const View& whole, const std::uint32_t* count,
                         const std::uint32_t* chosen);

// Where VPLs lie, spread by what one texel of each view sends, about: texel_power and count of each
// view and [view][SPOT_TILES_A_VIEW]. At most as many as there are texels that count.
std::vector<SpotSample> spot_samples(const std::vector<double>& texel_power,
                                     const std::vector<std::uint32_t>& count, std::size_t most);

// At most as many VPLs, of equal flux, that stand for all of these.
std::vector<Vpl> thinned(const std::vector<Vpl>& vpls, std::size_t most);

}  // namespace clgi
