// Masks of the directions in which triangles block the view of receivers, one method per kernel.
// Structs and the layout of masks: clgi/shared/masks.h. Rules for all methods:
// clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/masks.h>
#include <clgi/shared/receivers.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/advanced/sh.hpp>
#include <clgi/programs.hpp>
#include <glm/glm.hpp>
#include <initializer_list>
#include <vector>

namespace clgi {

// How the half-space inside a triangle's edge is found: at every pixel, or in a table of planes as
// in [Kautz04], which rounds each plane to one of 6 x table_size x table_size.
enum class EdgePlanes { exact, table };

struct MaskOptions {
    int size = 32;  // R, pixels: 8, 16, 32, 64 or 128
    EdgePlanes planes = EdgePlanes::exact;
    int table_size = 128;  // Q: 8 to 512
    int block = 2;         // B, pixels: width of the cells that are integrated: 1, 2, 4 or 8
    int bands = sh::default_bands;  // of transfer vectors: 1 to 9
};

// Points that light arrives at, with their frames.
struct ReceiverBuffers {
    cl::Buffer planes;    // [RECEIVER_PLANES][stride]
    cl::Buffer masks;     // [MASK_WORDS(size)][stride] uint, 1: blocked
    cl::Buffer transfer;  // [terms][stride] sr, in the world's frame: clgi/advanced/sh.hpp
    std::uint32_t count = 0;
    std::uint32_t stride = 0;  // plane_stride(count)
};

// Triangles that block, and for each list of receivers the clusters of them that it looks at. Every
// receiver may have a list of single triangles besides (clgi/advanced/blocker_levels.hpp).
struct BlockerBuffers {
    cl::Buffer corners;  // [BLOCKER_PLANES][stride], local frame
    cl::Buffer boxes;    // [stride / BLOCKER_CLUSTER] BlockerBox
    cl::Buffer lists;    // [lists + 1] uint: the first range of each list, and one behind the last
    cl::Buffer ranges;   // uint pairs: first cluster and number of clusters
    cl::Buffer near_lists;  // [count + 1] uint: where each receiver's singles begin in near, and
                            // the end of the last; none: no singles
    cl::Buffer near;        // uint: triangles; not empty, even if every list is
    std::uint32_t triangle_count = 0;
    std::uint32_t stride = 0;                // blocker_stride(triangle_count)
    std::uint32_t receivers_per_list = ~0u;  // ~0u: one list for all
};

// Whole clusters.
inline std::uint32_t blocker_stride(std::size_t triangles) {
    const std::size_t cluster = BLOCKER_CLUSTER;
    return static_cast<std::uint32_t>((triangles + cluster - 1) / cluster * cluster);
}

// Bytes of the table of planes; without one, of the heights of pixels.
CLGI_API std::size_t mask_table_bytes(const MaskOptions& options);

// [size][MASK_COLUMNS] z of every pixel's direction; 0 outside the disc.
CLGI_API std::vector<float> pixel_heights(int size);

class CLGI_API MaskPasses {
public:
    explicit MaskPasses(const Programs& programs, const MaskOptions& masks = {},
                        const BuildOptions& options = {});

    const MaskOptions& masks() const { return masks_; }

    // Planes of receivers from positions and normals [count] float4 -> planes. status:
    // [MASK_STATUS_WORDS] uint, counts.
    cl::Event receivers(const cl::CommandQueue& queue, const cl::Buffer& positions,
                        const cl::Buffer& normals, const ReceiverBuffers& receivers,
                        const cl::Buffer& status, const WaitList& wait = {}) const;

    // Corners and boxes from triangles [triangle_count] uint4 and positions float4, as a
    // DeviceScene has them -> corners, boxes. status: as above.
    cl::Event blockers(const cl::CommandQueue& queue, const cl::Buffer& triangles,
                       const cl::Buffer& positions, const BlockerBuffers& blockers,
                       const cl::Buffer& status, const WaitList& wait = {}) const;

    // The table of planes from the heights of pixels: [mask_table_bytes]. For EdgePlanes::table.
    cl::Event planes(const cl::CommandQueue& queue, const cl::Buffer& heights,
                     const cl::Buffer& table, const WaitList& wait = {}) const;

    // Masks of all receivers, from clusters, and singles if there are lists of them (a kernel of
    // its own: build names it mask_near). drawn: the table of planes, or with EdgePlanes::exact the
    // heights.
    cl::Event mask(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                   const BlockerBuffers& blockers, const cl::Buffer& drawn,
                   const WaitList& wait = {}) const;

    // The triangles of the receivers' clusters and singles (build: visible_near) that are the
    // nearest in some pixel of their masks -> bits of seen [visible_words(triangle_count)][stride]
    // uint (clgi/advanced/visible_sets.hpp). Bits that are set already stay. heights: pixel_heights
    // of the masks' size; planes are always exact.
    cl::Event visible(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                      const BlockerBuffers& blockers, const cl::Buffer& heights,
                      const cl::Buffer& seen, const WaitList& wait = {}) const;

    // What triangles [params.triangle_count] uint4 of the scene's vertices reflect diffusely ->
    // exitance [2][triangle_count] float4, exposed radiance: fronts, then backs. other_side:
    // ReceiverPasses::show; reflectance, irradiance: [3][params.receiver_stride].
    cl::Event exitance(const cl::CommandQueue& queue, const BounceParams& params,
                       const cl::Buffer& triangles, const cl::Buffer& other_side,
                       const cl::Buffer& reflectance, const cl::Buffer& irradiance,
                       const cl::Buffer& exitance, const WaitList& wait = {}) const;

    // Adds to irradiance [3][receivers.stride] what the triangles that receivers see reflect to
    // them. heights: as for visible. exitance: of blockers.triangle_count. non_finite: [1] uint,
    // counts receivers whose light becomes so.
    cl::Event bounce(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                     const BlockerBuffers& blockers, const cl::Buffer& heights,
                     const cl::Buffer& exitance, const cl::Buffer& irradiance,
                     const cl::Buffer& non_finite, const WaitList& wait = {}) const;

    // Transfer vectors from masks -> transfer. weights, directions: MaskWeights::values and
    // directions, of the same size, block and bands.
    cl::Event integrate(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                        const cl::Buffer& weights, const cl::Buffer& directions,
                        const WaitList& wait = {}) const;

    // The same for the receivers' Phong lobes seen from `eye`, local frame (docs/materials.md): the
    // inner product with light, times the lobe's share of reflectance, is radiance. eye: w 0: a
    // place; w 1: xyz is the direction to the eye, everywhere. exponents: [stride] float. lobes:
    // [terms][stride]. Receivers without masks: nothing blocks (a kernel of its own: build names it
    // integrate_open_gloss).
    cl::Event integrate_gloss(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                              const cl::Buffer& weights, const cl::Buffer& directions,
                              const cl::Buffer& exponents, const glm::vec4& eye,
                              const cl::Buffer& lobes, const WaitList& wait = {}) const;

    // What arrives: transfer [terms][stride] (diffuse or lobes) times light [terms] float4, as
    // TransferPasses::project makes it -> irradiance [3][stride]. flags: SHADE_... non_finite: [1]
    // uint, counts packets.
    cl::Event shade(const cl::CommandQueue& queue, const ReceiverBuffers& receivers,
                    const cl::Buffer& transfer, const cl::Buffer& light, std::uint32_t flags,
                    const cl::Buffer& irradiance, const cl::Buffer& non_finite,
                    const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    std::size_t need_integral(const PassKernel& pass, const ReceiverBuffers& receivers,
                              const cl::Buffer& weights, const cl::Buffer& directions,
                              const cl::Buffer& transfer) const;

    void need_masks(const PassKernel& pass, const ReceiverBuffers& receivers) const;

    MaskOptions masks_;
    PassKernel receivers_, blockers_, planes_, mask_, mask_near_, visible_, visible_near_,
        exitance_, bounce_, bounce_near_, integrate_, integrate_gloss_, integrate_open_gloss_,
        shade_;
};

}  // namespace clgi
