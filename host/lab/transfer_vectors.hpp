// Transfer vectors of a scene's vertices, for other programs: read from the solver, as an image and
// as attributes of vertices. docs/cli.md has the convention.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/dynamic_transfer.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <map>
#include <string>
#include <vector>

namespace clgi::lab {

using Plane = std::vector<float>;  // [vertices], in the order of the scene

struct TransferVectors {
    int bands = 0;
    std::size_t vertices = 0;  // of the scene; those without triangles have zeros
    std::vector<Plane> front;  // [terms] sr, in the world's frame
    std::vector<Plane> back;   // the same of the other sides of double-sided surfaces; empty: none
    std::size_t non_finite = 0;  // numbers that were not finite and are 0 now
};

// Waits for what was enqueued.
TransferVectors transfer_vectors(const cl::CommandQueue& queue, const DynamicTransferSolver& solver,
                                 const DeviceScene& scene);

// What the numbers mean, as name and text.
std::map<std::string, std::string> transfer_convention(const TransferVectors& vectors,
                                                       const DynamicTransferOptions& options);

// Vertex v is the pixel (v mod width, v / width); rows end at most_columns. Channels "T.l.m" and
// "back.T.l.m".
constexpr int most_columns = 4096;
io::Image transfer_image(const TransferVectors& vectors);

// _TRANSFER_0 ... and _TRANSFER_BACK_0 ..., four terms each, the last one filled up with zeros.
std::vector<io::VertexAttribute> transfer_attributes(const TransferVectors& vectors);

}  // namespace clgi::lab
