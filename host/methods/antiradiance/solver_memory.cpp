// What the antiradiance solver needs in memory and time: options in range, the table of buffers,
// and an estimate of both before elements are linked.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/moving_elements.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/parallel.hpp>
#include <cmath>

#include "core/kit/ranges.hpp"
#include "core/opencl/check.hpp"
#include "core/opencl/word.hpp"
#include "methods/antiradiance/device_links.hpp"
#include "methods/antiradiance/link_sample.hpp"
#include "methods/antiradiance/linked.hpp"
#include "methods/antiradiance/solver_buffers.hpp"
#include "methods/antiradiance/solver_motion.hpp"

namespace clgi {
namespace {

constexpr std::size_t color = sizeof(glm::vec4);

// Leaves whose links an estimate counts. With four times as many it is twice as close.
constexpr std::size_t sampled_leaves = 128;

// Until a residual of 1e-3: the symmetric iteration takes 14 in cornell and 27 in corridor.
constexpr double usual_steps = 20.0;

AntiradianceOptions checked(AntiradianceOptions options, const DeviceScene& scene) {
    need_range(antiradiance_owner, "steps", options.steps, 0, 10000);
    if (!occludes(options.occlusion))
        throw Error(
            "antiradiance: occlusion is none, automatic or always needed: implicit visibility is "
            "the "
            "method");
    need_range(antiradiance_owner, "through_steps", options.through_steps, 0, 1000);
    need_range(antiradiance_owner, "most_steps", options.most_steps, 1, 10000);
    need_range(antiradiance_owner, "least_gloss", options.least_gloss, 0.0, 1.0);
    need_range(antiradiance_owner, "residual", options.residual, 1e-6, 1.0);
    need_bins(options.bins);
    options.emitters.environment_lights = 0;
    options.emitters.vpls = 0;
    options.build.textures = options.build.textures && scene.needs_textures();
    return options;
}

}  // namespace

AntiradianceBuffers::AntiradianceBuffers(const Scene& file, const DeviceScene& of,
                                         const AntiradianceOptions& wanted)
    : scene(of),
      frame(of.frame()),
      options(checked(wanted, of)),
      bins(direction_bins(options.bins)),
      emitters(of, options.emitters, Pixels::depth) {
    const auto begin = std::chrono::steady_clock::now();
    tree = make_elements(file, options.elements, options.poses);
    if (tree.leaves == 0) throw Error("antiradiance: the scene has no surface");
    made = make_element_surface(tree, bins, file, scene);
    if (options.build.storage == Storage::half) set_row_exponents(made.elements);
    glossy = find_glossy_leaves(tree, made, file, options.least_gloss);
    gloss.count = glossy.count();
    gloss.vertex_count = glossy.vertices();
    linking = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<ElementTree> AntiradianceBuffers::posed(const Scene& file) const {
    std::vector<ElementTree> out;
    for (const std::vector<glm::dvec3>& pose : options.poses)
        if (!tree.moving.empty()) out.push_back(posed_elements(tree, file, pose));
    return out;
}

BufferTable AntiradianceBuffers::table(std::size_t link_count, std::uint32_t row_count) {
    const char* size = "elements.wished";
    const char* bin = "bins";
    const std::size_t count = made.elements.size(), leaf = made.leaves.size();
    const std::size_t inner = made.inner.size();
    const auto m = static_cast<std::size_t>(options.bins);
    links.element_count = static_cast<std::uint32_t>(count);
    links.leaf_count = static_cast<std::uint32_t>(leaf);
    links.inner_count = static_cast<std::uint32_t>(made.inner.size());
    links.link_count = static_cast<std::uint32_t>(link_count);
    links.row_count = row_count;
    surface.vertex_count = made.vertices();
    surface.patch_count = static_cast<std::uint32_t>(made.patches.size());
    const auto point_count = static_cast<std::uint32_t>(made.samples.size());
    points.stride = static_cast<std::uint32_t>(plane_stride(point_count));
    point_params = {links.leaf_count, leaf_samples, points.stride, made.first_back};
    const std::size_t intensities = bytes_of_rows(options.build.storage, options.bins, row_count);
    BufferTable t(antiradiance_owner);
    emitters.add_to(t);
    if (emitters.casts_shadows()) add_raster_lists(t, lists, scene);
    t.add(links.elements, "elements", size, count * sizeof(Element));
    t.add(links.first_links, "links", size, (2 * count + 1) * word);
    t.add(links.senders, "links", size, link_count * word);
    t.add(links.bins, "links", size, link_count * word / 2);
    t.add(links.form_factors, "links", size, link_count * word);
    t.add(rows.sky, "the sky's row", bin, m * color);
    t.add(rows.incident, "incident light", bin, std::max<std::size_t>(inner, 1) * m * color);
    t.add(rows.exitant, "intensities", bin, intensities);
    t.add(rows.next, "intensities", bin, intensities);
    t.add(rows.powers, "light of elements", size, count * color);
    t.add(rows.next_powers, "light of elements", size, count * color);
    for (cl::Buffer* buffer : {&leaves.sources, &leaves.reflectances, &leaves.radiances,
                               &leaves.irradiances, &leaves.changes})
        t.add(*buffer, "light of leaves", size, leaf * color);
    t.add_word(leaves.non_finite, "counters", 0);
    t.add_word(bad_points, "counters", 0);
    t.add(surface.roots, "patches of triangles", size, made.roots.size() * sizeof(TrianglePatches));
    t.add(surface.patches, "patches", size, made.patches.size() * sizeof(PatchCorners));
    t.add(surface.first_leaves, "vertices", size, made.first_leaves.size() * word);
    t.add(surface.vertex_leaves, "vertices", size, made.vertex_leaves.size() * 2 * word);
    t.add(surface.light, "vertices", size, surface.vertex_count * color);
    t.add(samples, "sample points", size, made.samples.size() * sizeof(SurfaceSample));
    t.add(points.planes, "sample points", size, gbuffer_bytes(Storage::full, points.stride));
    t.add(points.ids, "sample points", size, GBUFFER_ID_PLANES * word * points.stride);
    t.add(irradiance, "sample points", size, irradiance_bytes(Storage::full, points.stride));
    t.add(directions, "directions", bin, m * color);
    t.add(leaf_list, "elements", size, glossy.others.size() * word);
    t.add(inner_list, "elements", size, made.inner.size() * word);
    t.add(sum, "counters", size, color);
    t.add(scratch, "counters", size, sum_scratch_bytes(leaf));
    add_gloss(t);
    return t;
}

void AntiradianceBuffers::add_gloss(BufferTable& t) {
    if (gloss.count == 0) return;
    const char* size = "elements.wished";
    const char* bin = "bins";
    const auto m = static_cast<std::size_t>(options.bins);
    const std::size_t row = gloss_row_bytes(options.bins);
    t.add(gloss.leaves, "glossy leaves", size, gloss.count * sizeof(GlossyLeaf));
    t.add(gloss.albedos, "glossy leaves", size, glossy.albedos.size() * sizeof(float));
    t.add(gloss.bins, "directions", bin, row / 3 * 4);
    t.add(gloss.factors, "factors of lobes", bin, gloss.count * m * sizeof(float));
    t.add(gloss.colors, "glossy leaves", size, gloss.count * sizeof(glm::vec4));
    t.add(gloss.sources, "light of glossy leaves", bin, gloss.count * row);
    t.add(gloss.arriving, "light of glossy leaves", bin, gloss.count * row);
    t.add(gloss.rows, "glossy vertices", size, glossy.rows.size() * word);
    t.add(gloss.first_leaves, "glossy vertices", size, glossy.first.size() * word);
    t.add(gloss.vertex_leaves, "glossy vertices", size, glossy.vertex_leaves.size() * 2 * word);
    t.add(gloss.light, "light of glossy vertices", bin, gloss.vertex_count * row);
}

Estimate estimate(const cl::Device& device, const Scene& scene, const DeviceScene& device_scene,
                  const AntiradianceOptions& options) {
    AntiradianceBuffers buffers(scene, device_scene, options);
    const std::vector<ElementTree> poses = buffers.posed(scene);
    const LinkSample sample =
        sample_links(buffers.tree, buffers.bins, options.links, poses, sampled_leaves);
    // Other leaves read the same rows: clusters see most of the scene from each of them.
    const std::uint32_t rows =
        device_links(buffers.tree, buffers.bins, sample.links, device_scene.frame().scale,
                     buffers.glossy.leaves, buffers.made.elements,
                     options.occlusion == Occlusion::always)
            .rows;
    Estimate out;
    BufferTable table = buffers.table(static_cast<std::size_t>(std::llround(sample.total)), rows);
    MovingElements moving;
    if (!poses.empty())
        add_moving(table, moving, buffers.tree,
                   static_cast<std::size_t>(std::llround(sample.moving)));
    out.bytes = table.bytes();

    // In pairs of a point and a light, as measured on a CPU with packets of 16
    // (docs/results/benchmarks.md).
    const double bins = options.bins, elements = static_cast<double>(buffers.made.elements.size());
    const double step = 4.0 * sample.total + bins * (7.0 * elements + 3.0 * rows) +
                        0.36 * bins * bins * buffers.gloss.count;
    const double views = static_cast<double>(buffers.emitters.set().views.size());
    const double direct = 45.0 * views * static_cast<double>(device_scene.info().triangle_count) +
                          10.0 * static_cast<double>(buffers.made.samples.size()) *
                              static_cast<double>(buffers.emitters.set().emitters.size());
    const double steps = options.steps > 0 ? options.steps : usual_steps;
    out.milliseconds = 1e3 * (steps * step + direct) / pairs_per_second(device);
    return out;
}

}  // namespace clgi
