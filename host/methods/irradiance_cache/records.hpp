// Where records stand: on what a picture shows, and on what other records see.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "methods/irradiance_cache/tree.hpp"

namespace clgi {

// Pixels of a picture, normals of 0 where nothing is: one for each part of a block of pixels that
// lies in one plane, at most four a block.
std::vector<CacheRecord> seen_records(const std::vector<CacheRecord>& pixels, int width, int height,
                                      int count);

// Side of these blocks, pixels.
int block_side(int width, int height, int count);

// Of `doubt` about what arrives at pixels, exposed lux squared, what the pixels reflect of it:
// times the square of the luminance of their base colour, at least what glTF's dielectrics reflect.
// base: three rows of `stride`.
void keep_what_is_reflected(std::vector<float>& doubt, const std::vector<float>& base,
                            std::size_t stride);

// What of a picture such doubt is: root of its mean, as radiance, over the mean luminance.
// radiance: three rows of `stride`, cd/m^2. 0 for a black picture.
double relative_doubt(const std::vector<float>& doubt, const std::vector<float>& radiance,
                      std::size_t stride, double exposure);

// A record in each of the `count` blocks of side x side pixels in which the sum of `doubt` is
// largest, at the pixel where most of it is; none where there is no doubt.
std::vector<CacheRecord> doubtful_records(const std::vector<CacheRecord>& pixels,
                                          const std::vector<float>& doubt, int width, int height,
                                          int side, std::size_t count);

// Adds up to `count` of the candidates to the records, as far from each other and from what is
// there, in distances from those that see them, as it takes. viewers: record that sees each
// candidate; a candidate without normal is left out.
void add_records(std::vector<CacheRecord>& records, const std::vector<CacheRecord>& candidates,
                 const std::vector<std::size_t>& viewers, std::size_t count);

// Surfaces that records see, by directions of a cosine lobe, the same number for each.
struct WeighedPicks {
    std::size_t by_each = 1;
    std::vector<CacheRecord> places;  // a normal of 0: nothing
    std::vector<float> reflectance;
    std::vector<float> worth;            // doubt about what is sent, exposed lux
    std::vector<std::uint32_t> nearest;  // record that counts most there
};

// How much of the picture the light of each record reaches, by way of others too, of which the
// first `seen` light it directly.          [Smits92, importance; by particles, as in Veach's
// thesis, 4.5]
std::vector<double> importance_of(std::size_t records, std::size_t seen, const WeighedPicks& picks);

// Adds up to `count` of the picks to the records. A pick is worth its doubt times the importance of
// the record that sees it, and lies in the cell of the record that counts most there, or, where
// none counts, in one cell that all such picks share. The cell that is worth most is split first,
// at the pick that is worth most times the square of its distance to the cell's records (in the
// shared one at first to the record that sees it); that leaves half of its worth.
void split_cells(std::vector<CacheRecord>& records, std::size_t seen, const WeighedPicks& picks,
                 std::size_t count);

}  // namespace clgi
