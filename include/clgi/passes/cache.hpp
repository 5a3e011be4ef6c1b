// An irradiance cache, one method per kernel. Structs: clgi/shared/cache.h. Rules for all methods:
// clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/cache.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// Records, their hemicubes and their light.
struct CacheBuffers {
    cl::Buffer planes;           // [RECORD_PLANES][stride] float, local frame
    cl::Buffer views;            // [5 * records] View
    cl::Buffer visibility;       // [3 * size * size * records] ulong
    cl::Buffer nodes, lists;     // of the tree
    cl::Buffer sky;              // [1 or, with params.bright, 2][sky_height][sky_width][3] float
    cl::Buffer rows;             // [records][3][row_stride] float
    cl::Buffer base, reflected;  // [3][stride] float, exposed lux
    cl::Buffer light, next;      // the same; without direct light but that of the sky
    cl::Buffer bright, shown;    // the same: of base, what shown light lacks; light without it
    cl::Buffer by_spots;  // [light views][SPOT_TILES_A_VIEW] uint, read where params.spots is 1
};

// Small lit places and VPLs on them.
struct SpotBuffers {
    cl::Buffer seen;   // [(2 vertices + 31) / 32] uint, a bit for each side of the surface there
    cl::Buffer some;   // which records look more finely, uint
    cl::Buffer of;     // [view_count] SpotView
    cl::Buffer views;  // [view_count] View, drawn
    cl::Buffer visibility;   // their pixels, ulong
    cl::Buffer wanted;       // [light views][SPOT_TILES_A_VIEW] uint, 0: the tile does not count
    cl::Buffer count;        // [view_count][SPOT_TILES_A_VIEW] uint, texels
    cl::Buffer area;         // [view_count][SPOT_TILES_A_VIEW] float, local units squared
    cl::Buffer samples;      // [sample_count] SpotSample
    cl::Buffer spots;        // [sample_count] Vpl
    CacheBuffers hemicubes;  // views and visibility of these
};

// Of what CachePasses::around writes.
CLGI_API std::size_t around_bytes(const CacheAround& of);

class CLGI_API CachePasses {
public:
    explicit CachePasses(const Programs& programs, const BuildOptions& options = {});

    // Surfaces that the hemicubes of params.count records see -> places [PICK_PLANES]
    // [pick_stride], params.picks for each record.
    cl::Event pick(const cl::CommandQueue& queue, const CacheParams& params,
                   const DeviceScene& scene, const CacheBuffers& buffers, const cl::Buffer& places,
                   const WaitList& wait = {}) const;

    // The records nearest to each leaf -> lists [leaf_count][CACHE_WAYS][CACHE_LISTED] uint.
    struct Crowds {
        cl::Buffer leaves;   // [leaf_count] CacheLeaf
        cl::Buffer records;  // [6][stride] float, positions and normals; normals of 0 past the last
        cl::Buffer order;    // [stride] uint, which records these are
        cl::Buffer boxes;    // [6][crowd_stride] float, low and high corners around every 16
    };
    cl::Event list(const cl::CommandQueue& queue, const CacheListParams& params,
                   const Crowds& crowds, const cl::Buffer& lists, const WaitList& wait = {}) const;

    // Rows of the transport of params.count records, their base light, and direct light once
    // reflected: emitters have depth maps.
    cl::Event link(const cl::CommandQueue& queue, const CacheParams& params, const CacheTree& tree,
                   const DeviceScene& scene, const EmitterBuffers& emitters,
                   const CacheBuffers& buffers, const WaitList& wait = {}) const;

    // Vertices of triangles that the hemicubes of params.count records see: sets bits of
    // spots.seen, that of 2 v for the front, of 2 v + 1 for the back.
    cl::Event mark(const cl::CommandQueue& queue, const CacheParams& params,
                   const DeviceScene& scene, const CacheBuffers& buffers, const SpotBuffers& spots,
                   const WaitList& wait = {}) const;

    // How much of each tile of the views shows such sides: count and area. views: as they were
    // drawn, of `size` pixels a side.
    cl::Event tally(const cl::CommandQueue& queue, const SpotParams& params, std::uint32_t size,
                    const DeviceScene& scene, const EmitterBuffers& emitters,
                    const SpotBuffers& spots, const WaitList& wait = {}) const;

    // samples -> spots.
    cl::Event spots(const cl::CommandQueue& queue, const SpotParams& params, std::uint32_t size,
                    const DeviceScene& scene, const EmitterBuffers& emitters,
                    const SpotBuffers& spots, const WaitList& wait = {}) const;

    // spots -> added to buffers.reflected of params.count records.
    cl::Event shine(const cl::CommandQueue& queue, const CacheParams& params, const CacheTree& tree,
                    const SpotParams& of, const DeviceScene& scene, const CacheBuffers& buffers,
                    const SpotBuffers& spots, const WaitList& wait = {}) const;

    // light -> next and shown, of params.record_count records.
    cl::Event bounce(const cl::CommandQueue& queue, const CacheBounceParams& params,
                     const CacheBuffers& buffers, const WaitList& wait = {}) const;

    // buffers.light at places that were picked -> worth [pick_stride] float, how much of what each
    // sends is in doubt, and nearest [pick_stride] uint, the record that counts most there.
    cl::Event weigh(const cl::CommandQueue& queue, const CacheParams& params, const CacheTree& tree,
                    const CacheBuffers& buffers, const cl::Buffer& places, const cl::Buffer& worth,
                    const cl::Buffer& nearest, const WaitList& wait = {}) const;

    // Light of all records of the tree -> light that interpolation between them blurs less:
    // [3][tree.stride] float each, in different buffers; buffers.light is not read. `more`, where
    // params.more is 1, as `light` is.
    struct Sharpened {
        cl::Buffer from, to;
    };
    cl::Event sharpen(const cl::CommandQueue& queue, const CacheSharpenParams& params,
                      const CacheTree& tree, const CacheBuffers& buffers, const Sharpened& light,
                      const Sharpened& more, const WaitList& wait = {}) const;

    // buffers.light -> irradiance [IRRADIANCE_PLANES][params.stride] of the points of a G-buffer,
    // in the storage of these passes, and how much the records of each differ, doubt
    // [params.stride] float. With params.more also more.light -> more.irradiance, by the same
    // shares.
    struct More {
        cl::Buffer light, irradiance;
    };
    cl::Event show(const cl::CommandQueue& queue, const CacheShowParams& params,
                   const CacheTree& tree, const CacheBuffers& buffers, const GBuffer& points,
                   const cl::Buffer& irradiance, const cl::Buffer& doubt, const More& more,
                   const WaitList& wait = {}) const;
    cl::Event show(const cl::CommandQueue& queue, const CacheShowParams& params,
                   const CacheTree& tree, const CacheBuffers& buffers, const GBuffer& points,
                   const cl::Buffer& irradiance, const cl::Buffer& doubt,
                   const WaitList& wait = {}) const;

    // Adds to sight [sky_height][sky_width] uint how much of the sky's texels the hemicubes of
    // params.count records see: 2^30 where these see nothing but sky.
    cl::Event sight(const cl::CommandQueue& queue, const CacheParams& params,
                    const CacheBuffers& buffers, const cl::Buffer& sight,
                    const WaitList& wait = {}) const;

    // Adds corrections, found [IRRADIANCE_PLANES][stride] float, to sums [5][stride] float, which
    // are 0 before the first, and finds the share of each block of CACHE_BLOCK x CACHE_BLOCK
    // pixels, row by row. points: what the sample's pixels show.
    cl::Event gauge(const cl::CommandQueue& queue, const CacheCorrectParams& params,
                    const GBuffer& points, const cl::Buffer& found, const cl::Buffer& sums,
                    const cl::Buffer& shares, const WaitList& wait = {}) const;

    // Adds what directions of the sky bring to params.count records, next (less than 0, as
    // DIRECT_TAKE leaves it), to sums [4][stride] float, and corrects buffers.shown by them ->
    // settled [3][stride] float. No lamps are in buffers.base.
    cl::Event settle(const cl::CommandQueue& queue, const CacheSettleParams& params,
                     const CacheBuffers& buffers, const cl::Buffer& sums, const cl::Buffer& settled,
                     const WaitList& wait = {}) const;

    // By sums and shares corrects irradiance [IRRADIANCE_PLANES][stride] of all pixels.
    cl::Event correct(const cl::CommandQueue& queue, const CacheCorrectParams& params,
                      const cl::Buffer& sums, const cl::Buffer& shares,
                      const cl::Buffer& irradiance, const WaitList& wait = {}) const;

    // Radiance around records: buffers.light -> around [around_bytes(of) / 8] ulong, of all records
    // but those that were met. params: of all records, as for link.
    cl::Event around(const cl::CommandQueue& queue, const CacheParams& params,
                     const CacheAround& of, const CacheTree& tree, const DeviceScene& scene,
                     const EmitterBuffers& emitters, const CacheBuffers& buffers,
                     const cl::Buffer& around, const WaitList& wait = {}) const;

    // Adds what lobes reflect of that to the radiance of a picture. irradiance: as show left it,
    // corrected or not.
    struct Glossy {
        cl::Buffer around;
        GBuffer points;
        cl::Buffer irradiance;  // [IRRADIANCE_PLANES][params.stride] exposed lux
        cl::Buffer radiance;    // [RADIANCE_PLANES][params.stride] cd/m^2
        cl::Buffer non_finite;  // [1] uint, only added to
    };
    cl::Event gloss(const cl::CommandQueue& queue, const CacheGlossParams& params,
                    const CacheAround& of, const CacheTree& tree, const DeviceScene& scene,
                    const CacheBuffers& buffers, const Glossy& picture,
                    const WaitList& wait = {}) const;

    // Adds what lobes of alpha up to params.smooth reflect, by a ray a direction: buffers.light at
    // what it meets, or the sky. of: as for link.
    struct Smooth {
        GBuffer points;
        cl::Buffer sky;         // [params.sky_height][params.sky_width][3] float
        cl::Buffer radiance;    // [RADIANCE_PLANES][params.stride] cd/m^2
        cl::Buffer non_finite;  // [1] uint, only added to
    };
    cl::Event reflect(const cl::CommandQueue& queue, const CacheGlossParams& params,
                      const CacheParams& of, const CacheTree& tree, const DeviceScene& scene,
                      const EmitterBuffers& emitters, const CacheBuffers& buffers,
                      const Smooth& picture, const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel pick_, list_, link_, bounce_, weigh_, sharpen_, show_, mark_, tally_, spots_, shine_,
        sight_, gauge_, correct_, settle_, around_, gloss_, reflect_;
    bool groups_;  // a record by a group of work-items
};

}  // namespace clgi
