// Light between elements whose surfaces have lobes; one method per kernel. Structs and words:
// clgi/shared/antiradiance.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/antiradiance.hpp>
#include <clgi/passes/lights.hpp>

namespace clgi {

// Leaves with lobes, in an order of their own. Rows are [3][GLOSS_STRIDE(bins)] floats.
struct GlossBuffers {
    cl::Buffer leaves;    // [count] GlossyLeaf
    cl::Buffer albedos;   // [materials][ALBEDO_STEPS + 1] float, of lobe_albedos()
    cl::Buffer bins;      // of direction_planes()
    cl::Buffer factors;   // [count][bins] float, between bins
    cl::Buffer colors;    // [count] float4, of the lobes
    cl::Buffer sources;   // [count] rows: radiance that leaves and that no pass brings
    cl::Buffer arriving;  // [count] rows: radiance that arrived in front, in the last step
    // Where pictures show them.
    cl::Buffer rows;           // [vertices of LeafSurface] uint: in light; ELEMENT_NONE: no lobe
    cl::Buffer first_leaves;   // [vertex_count + 1] uint, in vertex_leaves
    cl::Buffer vertex_leaves;  // uint2: a glossy leaf, and the bits of its share of the vertex
    cl::Buffer light;          // [vertex_count] rows: radiance that arrives
    std::uint32_t count = 0, vertex_count = 0;
};

class CLGI_API AntiradianceGlossPasses {
public:
    // As for AntiradiancePasses.
    AntiradianceGlossPasses(const Programs& programs, int bins, const BuildOptions& options = {});

    void build(std::initializer_list<const char*> passes) const;

    int bins() const { return bins_; }
    std::size_t row_bytes() const;

    // Leaves and their normals, bins and albedos -> factors.
    cl::Event lobes(const cl::CommandQueue& queue, const LinkBuffers& links,
                    const GlossBuffers& gloss, const WaitList& wait = {}) const;

    // points: full storage, of all leaves. lights: with shadow maps -> gloss.sources, colors.
    // params.leaf_count is gloss.count.
    cl::Event sources(const cl::CommandQueue& queue, const GlossSourceParams& params,
                      const DeviceScene& scene, const GBuffer& points, const EmitterBuffers& lights,
                      const LinkBuffers& links, const GlossBuffers& gloss,
                      const WaitList& wait = {}) const;

    // What AntiradiancePasses::local does for other leaves. step: LOCAL_... flags.
    cl::Event gloss(const cl::CommandQueue& queue, std::uint32_t step, const LinkBuffers& links,
                    const ElementRows& rows, const cl::Buffer& directions,
                    const LeafBuffers& leaves, const GlossBuffers& gloss,
                    const WaitList& wait = {}) const;

    // gloss.arriving -> gloss.light.
    cl::Event vertices(const cl::CommandQueue& queue, const GlossBuffers& gloss,
                       const WaitList& wait = {}) const;

    // gloss.light -> added to radiance [3][params.pixel_stride]. seen: with materials.
    cl::Event show(const cl::CommandQueue& queue, const ShowGlossParams& params,
                   const DeviceScene& scene, const LinkBuffers& links, const LeafSurface& surface,
                   const GlossBuffers& gloss, const GBuffer& seen, const cl::Buffer& radiance,
                   const cl::Buffer& non_finite, const WaitList& wait = {}) const;

private:
    int bins_;
    bool grouped_ = false;  // whether a leaf has a group of work-items
    PassKernel lobes_, sources_, gloss_, vertices_, show_;
};

// [ALBEDO_STEPS + 1] what GGX reflects of the light that meets it at a cosine of
// (k / ALBEDO_STEPS)^2 with the normal, as a share of what it reflects in the mean over all
// directions by their cosine. alpha: [0.01, 1], else throws Error.
CLGI_API std::vector<float> lobe_albedos(double alpha);

// rows: of direction_rows(). [4][GLOSS_STRIDE(bins)]: x, y, z, sr; zero past the last bin.
CLGI_API std::vector<float> direction_planes(const std::vector<glm::vec4>& rows);

}  // namespace clgi
