// Light between elements without visibility; one method per kernel. Structs and words:
// clgi/shared/antiradiance.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/antiradiance.h>
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>
#include <vector>

namespace clgi {

// Elements and the links that end at each.
struct LinkBuffers {
    cl::Buffer elements;  // [element_count] Element
    // [element_count][2] uint: where those begin that read powers, and those that read rows; and
    // where the last ones end.
    cl::Buffer first_links;
    // [link_count] uint: elements of links that read powers, rows of the others; one at least, like
    // the other two.
    cl::Buffer senders;
    cl::Buffer bins;  // [link_count] ushort
    // [link_count] float, 1 / (m^2 sr) [Dachsbacher07, Eq. 17]; of links that read powers times
    // the cosine of the sender's Element::normal with the direction of the bin; of the others times
    // 2^Element::row_exponent of the sender.
    cl::Buffer form_factors;
    std::uint32_t element_count = 0, inner_count = 0, leaf_count = 0, link_count = 0;
    std::uint32_t row_count = 0;  // of exitant intensities
};

// Rows of all elements.
struct ElementRows {
    cl::Buffer sky;       // [bins] float4: radiance that arrives from outside the scene
    cl::Buffer incident;  // [inner_count][bins] float4: radiance; one at least
    cl::Buffer exitant;   // [row_count][bins] intensities before a pass; one at least
    cl::Buffer next;      // [row_count][bins] those after it
    // [element_count] float4: area times radiance of the front, before a pass and after it.
    cl::Buffer powers, next_powers;
};

// rgb of each leaf, in [leaf_count] float4; exposed light.
struct LeafBuffers {
    cl::Buffer sources;       // cd/m^2 that leaves and that no pass brings
    cl::Buffer reflectances;  // diffuse, 0 to 1
    cl::Buffer radiances;     // cd/m^2 that leaves
    cl::Buffer irradiances;   // lux over links and from the sky
    // By how much they changed, times area; w: what arrived, of all channels, times area.
    cl::Buffer changes;
    cl::Buffer non_finite;  // [1] uint
};

// Leaves as the parts of triangles that pictures show.
struct LeafSurface {
    cl::Buffer roots;          // [triangles of the device] TrianglePatches
    cl::Buffer patches;        // [patch_count] PatchCorners: of elements, then of other triangles
    cl::Buffer first_leaves;   // [vertex_count + 1] uint, in vertex_leaves
    cl::Buffer vertex_leaves;  // uint2: row of a leaf, and the bits of its share of the vertex
    cl::Buffer light;          // [vertex_count] float4: rgb, exposed lux
    std::uint32_t vertex_count = 0, patch_count = 0;
};

class CLGI_API AntiradiancePasses {
public:
    // bins: DirectionBins::count(). Half storage is for intensities; all else is float.
    AntiradiancePasses(const Programs& programs, int bins, const BuildOptions& options = {});

    void build(std::initializer_list<const char*> passes) const;

    int bins() const { return bins_; }
    std::size_t intensity_bytes(std::size_t rows) const;

    // Inner elements of `list` [params.first + params.count] uint, whose parents are done.
    cl::Event global(const cl::CommandQueue& queue, const ElementParams& params,
                     const cl::Buffer& list, const LinkBuffers& links, const ElementRows& rows,
                     const WaitList& wait = {}) const;

    // Leaves of `list`; all inner elements are done. directions: of direction_rows().
    cl::Event local(const cl::CommandQueue& queue, const ElementParams& params,
                    const cl::Buffer& list, const LinkBuffers& links, const ElementRows& rows,
                    const cl::Buffer& directions, const LeafBuffers& leaves,
                    const WaitList& wait = {}) const;

    // Inner elements of `list` in rows.next, whose children are done.
    cl::Event pull(const cl::CommandQueue& queue, const ElementParams& params,
                   const cl::Buffer& list, const LinkBuffers& links, const ElementRows& rows,
                   const WaitList& wait = {}) const;

    // Points of leaves that face backwards, in planes of full storage.
    cl::Event turn(const cl::CommandQueue& queue, const LeafPointParams& params,
                   const cl::Buffer& planes, const WaitList& wait = {}) const;

    // points: full storage. irradiance [3][params.stride]: direct, exposed lux -> leaves.sources
    // and leaves.reflectances.
    cl::Event sources(const cl::CommandQueue& queue, const LeafPointParams& params,
                      const DeviceScene& scene, const GBuffer& points, const cl::Buffer& irradiance,
                      const LeafBuffers& leaves, const WaitList& wait = {}) const;

    // leaves.irradiances -> surface.light.
    cl::Event vertices(const cl::CommandQueue& queue, const LeafSurface& surface,
                       const LeafBuffers& leaves, const WaitList& wait = {}) const;

    // surface.light -> shown [IRRADIANCE_PLANES][params.pixel_stride]. seen has positions and
    // triangles.
    cl::Event show(const cl::CommandQueue& queue, const ShowElementsParams& params,
                   const DeviceScene& scene, const LinkBuffers& links, const LeafSurface& surface,
                   const GBuffer& seen, const cl::Buffer& shown, const WaitList& wait = {}) const;

private:
    int bins_;
    bool rows_in_groups_;  // a group an element in global and local, with its row in local memory
    std::size_t items_;    // work-items of an element in pull
    PassKernel global_, local_, pull_, turn_, sources_, vertices_, show_;
};

// [bins] xyz: unit; w: sr.
CLGI_API std::vector<glm::vec4> direction_rows(const DirectionBins& bins);

}  // namespace clgi
