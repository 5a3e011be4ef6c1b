// Transfer vectors by casting rays against the whole mesh, and how far others are from them.
//                                                                  [Kautz04, section 4, table 1]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi::lab {

// Of some vertices of a scene at some times of its first clip.
struct TransferTruth {
    std::vector<std::uint32_t> vertices;       // of the scene, ascending
    std::vector<double> seconds;               // of each frame
    std::vector<std::vector<double>> vectors;  // [frames][vertices][terms] sr
    double noise = 0.0;  // mean relative L2 error of the vectors of the first frame, estimated
};

// vertices: at most so many, drawn at random. 4,096 rays each, five bands, in the middle of eight
// equal parts of the clip. Throws Error for a scene without animation.
TransferTruth transfer_truth(const Scene& scene, std::size_t vertices);

// The mean over vertices and frames of |V - truth| / |truth|. Left out are vertices that receive
// almost nothing: |truth| is below a thousandth of what it is where nothing blocks.
struct TransferError {
    double mean = 0.0;
    double lit = 0.0;   // the same of vertices at which |truth| is at least a tenth of that
    double root = 0.0;  // sqrt(sum |V - truth|^2 / sum |truth|^2)
    std::size_t counted = 0;
    std::size_t counted_lit = 0;
    std::size_t left_out = 0;
};

class TransferErrors {
public:
    // vectors: [vertices of the truth][terms].
    void add(const std::vector<double>& vectors, const std::vector<double>& truth, int bands);
    TransferError error() const;

private:
    TransferError sums_;  // mean and lit: of the relative errors; root: of their squares
    double all_ = 0.0;
};

}  // namespace clgi::lab
