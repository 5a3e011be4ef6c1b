// Filling a light atlas, one method per kernel. Structs: clgi/shared/atlas.h. Rules for all
// methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/atlas.h>
#include <clgi/shared/volume.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/vpl.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// Where triangles and texels lie in an atlas, for looking it up. Triangles in the device's order.
struct AtlasMap {
    cl::Buffer corners;   // [3 * triangles] float2: texels of its page
    cl::Buffer charts;    // [triangles] uint2: page and chart; ATLAS_NONE without one
    cl::Buffer map;       // [pages][size][size] uint: index of the texel listed; ATLAS_NONE
    cl::Buffer chart_of;  // [texels] uint
    std::uint32_t size = 0, pages = 0, texel_count = 0;
};

// What the projection of the mesh M into the atlas needs. Triangles are those of the device, texel
// coordinates those of a page.
struct MeshBuffers {
    cl::Buffer uvs;      // [3 * triangle_count] float2, of the corners, texels
    cl::Buffer charts;   // [triangle_count] uint; MESH_NO_CHART: in none
    cl::Buffer boxes;    // [chart_count] float4: least u, least v, largest u, largest v, texels
    cl::Buffer places;   // [PLACE_PLANES][stride] int, of the texels
    cl::Buffer corners;  // [shooter_count][MESH_CORNERS] MeshCorner
    cl::Buffer copies;   // [shooter_count][MESH_TRIANGLES][MESH_COPIES] MeshCopy
    std::uint32_t chart_count = 0;
};

// Texels that are looked up first, and blocks of the others (AtlasBlocks).
struct BlockBuffers {
    cl::Buffer planes;  // a G-buffer's planes of the listed texels, [listed_stride]
    cl::Buffer places;  // [unblocked] uint, texels that are in no block
    cl::Buffer seen;    // [rows of a batch][listed_stride] uchar
    cl::Buffer blocks;  // [block_count] AtlasBlock
};

// What an irradiance volume has beside its light (clgi/advanced/irradiance_volume.hpp).
struct VolumeBuffers {
    cl::Buffer places;     // [layers][rows][columns] float4: IrradianceVolume::places
    cl::Buffer distances;  // [open_count][VOLUME_TEXELS] float2: IrradianceVolume::distances
};

// Rows of bits for so many VPLs.
constexpr std::size_t seen_rows(std::size_t vpls) { return (vpls + SEEN_VPLS - 1) / SEEN_VPLS; }

class CLGI_API AtlasPasses {
public:
    explicit AtlasPasses(const Programs& programs, const BuildOptions& options = {});
    AtlasPasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {})
        : AtlasPasses(Programs(context, device), options) {}

    // Which texels a batch of VPLs sees -> seen [rows][stride] uchar, a bit for each VPL. views,
    // depth: their hemicubes.
    cl::Event see(const cl::CommandQueue& queue, const SeeParams& params, const cl::Buffer& views,
                  const cl::Buffer& depth, const cl::Buffer& texels, const cl::Buffer& seen,
                  const WaitList& wait = {}) const;

    // Which blocks are flat -> AtlasBlock::flat. To be done once, before see_blocks.
    cl::Event flat(const cl::CommandQueue& queue, const BlockParams& params,
                   const cl::Buffer& texels, const BlockBuffers& blocks,
                   const WaitList& wait = {}) const;

    // see for the listed texels alone -> blocks.seen, and seen of those that are in no block.
    cl::Event see_listed(const cl::CommandQueue& queue, const BlockParams& params,
                         const cl::Buffer& views, const cl::Buffer& depth,
                         const BlockBuffers& blocks, const cl::Buffer& seen,
                         const WaitList& wait = {}) const;

    // blocks.seen -> seen of all texels in blocks: what the corners of a block agree about; they
    // are looked up as by see where corners do not agree.
    cl::Event see_blocks(const cl::CommandQueue& queue, const BlockParams& params,
                         const cl::Buffer& views, const cl::Buffer& depth, const cl::Buffer& texels,
                         const BlockBuffers& blocks, const cl::Buffer& seen,
                         const WaitList& wait = {}) const;

    // Adds what sites of buffers.list send to the texels that they see. texels: a G-buffer's
    // planes, float; gathered: [3][stride] float, exposed lux; filled: [stride] float, the sum of
    // the form factors, with FILL_FORM_FACTORS.
    cl::Event gather(const cl::CommandQueue& queue, const FillParams& params,
                     const SiteBuffers& buffers, const cl::Buffer& texels, const cl::Buffer& seen,
                     const cl::Buffer& gathered, const cl::Buffer& filled,
                     const WaitList& wait = {}) const;

    // The same where nothing lies between surfaces: to all texels that they face and that face
    // them.
    cl::Event gather_open(const cl::CommandQueue& queue, const FillParams& params,
                          const SiteBuffers& buffers, const cl::Buffer& texels,
                          const cl::Buffer& gathered, const cl::Buffer& filled,
                          const WaitList& wait = {}) const;

    // What a batch of VPLs sees at the corners of M -> mesh.corners. visibility: their hemicubes
    // with triangles.
    cl::Event geometry(const cl::CommandQueue& queue, const MeshParams& params,
                       const DeviceScene& scene, const cl::Buffer& views,
                       const cl::Buffer& visibility, const MeshBuffers& mesh,
                       const WaitList& wait = {}) const;

    // mesh.corners -> mesh.copies: the triangles of M in every chart that they touch.
    cl::Event replicate(const cl::CommandQueue& queue, const MeshParams& params,
                        const MeshBuffers& mesh, const WaitList& wait = {}) const;

    // In place of see and gather: adds what a batch of VPLs, of buffers.chosen, sends to the texels
    // that mesh.copies cover, with soft shadows.
    cl::Event project(const cl::CommandQueue& queue, const FillParams& params,
                      const MeshParams& mesh_params, const SiteBuffers& buffers,
                      const cl::Buffer& views, const cl::Buffer& visibility,
                      const MeshBuffers& mesh, const cl::Buffer& texels, const cl::Buffer& gathered,
                      const cl::Buffer& filled, const WaitList& wait = {}) const;

    // The reach of the VPL nearest to each texel, of those that face the same way -> reach [stride]
    // float. params.shooter_count: all VPLs.
    cl::Event nearest(const cl::CommandQueue& queue, const FillParams& params,
                      const SiteBuffers& buffers, const cl::Buffer& texels, const cl::Buffer& reach,
                      const WaitList& wait = {}) const;

    // gathered -> irradiance, both [3][stride] float: raised where VPLs fill the hemisphere of a
    // texel less than surfaces do, lowered where they fill more than there is. non_finite: [1]
    // uint, counts packets with numbers that are not finite.
    cl::Event complete(const cl::CommandQueue& queue, const FillParams& params,
                       const cl::Buffer& reach, const cl::Buffer& filled,
                       const cl::Buffer& gathered, const cl::Buffer& irradiance,
                       const cl::Buffer& non_finite, const WaitList& wait = {}) const;

    // The light of an atlas at points of a G-buffer, whose triangles must be there
    // (RESOLVE_TRIANGLE), in the storage of these passes. light: [3][params.texel_stride] float,
    // exposed lux -> irradiance [IRRADIANCE_PLANES][stride].
    cl::Event show(const cl::CommandQueue& queue, const ShowParams& params,
                   const DeviceScene& scene, const GBuffer& points, const AtlasMap& map,
                   const cl::Buffer& light, const cl::Buffer& irradiance,
                   const WaitList& wait = {}) const;

    // The light of a volume at points of a G-buffer whose triangles have no chart; writes nothing
    // elsewhere. charts: AtlasMap::charts; light: [3][params.light_stride] float, exposed lux.
    cl::Event volume(const cl::CommandQueue& queue, const VolumeParams& params,
                     const GBuffer& points, const cl::Buffer& charts, const VolumeBuffers& grid,
                     const cl::Buffer& light, const cl::Buffer& irradiance,
                     const WaitList& wait = {}) const;

    // Builds these kernels now, by the names of the methods (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

private:
    PassKernel see_, flat_, see_listed_, see_blocks_, gather_, gather_open_, geometry_, replicate_,
        project_, nearest_, complete_, show_, volume_;
    Storage storage_;  // of what show and volume read and write
};

}  // namespace clgi
