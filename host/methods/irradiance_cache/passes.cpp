// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/cache.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"
#include "shading/lights/emitter_buffers.hpp"

namespace clgi {
namespace {

void need_records(const PassKernel& pass, const CacheParams& params, const CacheBuffers& b) {
    const std::size_t end = std::size_t{params.first} + params.count;
    if (params.size < 8 || params.size % 8 != 0)
        throw Error(pass.name + ": size is " + std::to_string(params.size) +
                    ", a multiple of 8 needed");
    need_stride(pass, "stride", params.stride, end);
    need_countable(pass.name, "visibility", 3 * std::size_t{params.size} * params.size, end);
    need(pass, "planes", b.planes, RECORD_PLANES * word * params.stride);
    need(pass, "views", b.views, 5 * end * sizeof(View));
    need(pass, "visibility", b.visibility,
         3 * sizeof(std::uint64_t) * params.size * params.size * end);
}

void need_tree(const PassKernel& pass, const CacheTree& tree, const CacheBuffers& b) {
    need_stride(pass, "tree.stride", tree.stride, tree.record_count);
    need(pass, "nodes", b.nodes, tree.node_count * word);
    need(pass, "planes", b.planes, RECORD_PLANES * word * tree.stride);
}

// What hemicubes see and how it is lit.
void need_link(const PassKernel& pass, const CacheParams& params, const CacheTree& tree,
               const EmitterBuffers& emitters, const CacheBuffers& b) {
    need_tree(pass, tree, b);
    need(pass, "sky", b.sky,
         3 * word *
             std::max<std::size_t>(
                 1, std::size_t{params.sky_width} * params.sky_height * (params.bright ? 2 : 1)));
    need_range(pass.name.c_str(), "thin", params.thin, 1u, 1u << 20);
    need_range(pass.name.c_str(), "every", params.every, 1u, params.size / 8);
    if (params.size % (8 * params.every) != 0)
        throw Error(pass.name + ": every is " + std::to_string(params.every) + ", size " +
                    std::to_string(params.size) + " a multiple of 8 every needed");
    need_range(pass.name.c_str(), "emitter_step", params.emitter_step, 1u, 1u << 20);
    need_range(pass.name.c_str(), "whole_emitters", params.whole_emitters, 0u,
               params.emitter_count);
    need_range(pass.name.c_str(), "skipped", params.skipped, 0u,
               params.emitter_count - params.whole_emitters);
    need_depth_words(pass, 1, emitters.kind);
    need_emitters(pass, emitters, params.emitter_count);
    if (params.spots)
        need(pass, "by_spots", b.by_spots, SPOT_TILES_A_VIEW * word * emitters.view_count);
}

// records: how many there are.
void need_around(const PassKernel& pass, const CacheAround& of, std::size_t records,
                 const cl::Buffer& around) {
    const std::size_t slots = records - std::min<std::size_t>(records, of.met);
    if (of.slots != slots || of.seen > slots || of.size % 8 != 0)
        throw Error(pass.name + ": slots are " + std::to_string(of.slots) + " of size " +
                    std::to_string(of.size) + ", " + std::to_string(slots) +
                    " of a multiple of 8 needed");
    need_countable(pass.name, "around", 4 * std::size_t{of.size} * of.size, of.slots);
    need(pass, "around", around, around_bytes(of));
}

std::size_t seen_bytes(const DeviceScene& scene) {
    return (2 * std::size_t{scene.info().vertex_count} + 31) / 32 * word;
}

// size: pixels a side of every view.
void need_spots(const PassKernel& pass, const SpotParams& params, std::uint32_t size,
                const DeviceScene& scene, const EmitterBuffers& emitters, const SpotBuffers& b) {
    if (size == 0 || size % SPOT_TILES != 0)
        throw Error(pass.name + ": size is " + std::to_string(size) + ", a multiple of " +
                    std::to_string(SPOT_TILES) + " needed");
    need(pass, "seen", b.seen, seen_bytes(scene));
    need(pass, "emitters.views", emitters.views, sizeof(View) * emitters.view_count);
    need(pass, "of", b.of, params.view_count * sizeof(SpotView));
    need(pass, "views", b.views, params.view_count * sizeof(View));
    need(pass, "visibility", b.visibility, sizeof(std::uint64_t) * params.view_count * size * size);
    need(pass, "wanted", b.wanted, SPOT_TILES_A_VIEW * word * emitters.view_count);
}

}  // namespace

CachePasses::CachePasses(const Programs& programs, const BuildOptions& options) {
    const BuildOptions whole = full(options);
    const auto light = [&](const char* pass) {
        return programs.kernel(
            "cache", pass, whole, "",
            {"pick", "list", "link", "bounce", "weigh", "show", "sharpen", "mark", "tally", "spots",
             "shine", "sight", "gauge", "correct", "settle"});
    };
    const auto lobes = [&](const char* pass) {
        return programs.kernel("cache", pass, whole, "", {"around", "gloss", "reflect"});
    };
    const auto few = [&](const PassKernel& kernel) {
        return in_small_groups(kernel, programs.device(), options);
    };
    pick_ = few(light("pick"));
    list_ = few(light("list"));
    groups_ = in_groups(programs.device(), options);
    // A lane a pixel.
    link_ = groups_ ? group_form(programs, "cache", "link", scalar(whole), "", 32, 64)
                    : few(light("link"));
    bounce_ = few(light("bounce"));
    weigh_ = few(light("weigh"));
    sharpen_ = few(light("sharpen"));
    show_ = options.storage == Storage::full ? light("show")
                                             : programs.kernel("cache", "show", options);
    mark_ = few(light("mark"));
    tally_ = few(light("tally"));
    spots_ = few(light("spots"));
    shine_ = few(light("shine"));
    sight_ = few(light("sight"));
    gauge_ = few(light("gauge"));
    correct_ = light("correct");
    settle_ = few(light("settle"));
    around_ = few(lobes("around"));
    gloss_ = lobes("gloss");
    reflect_ = few(lobes("reflect"));
}

void CachePasses::build(std::initializer_list<const char*> passes) const {
    build_named({pick_, list_, link_, bounce_, weigh_, sharpen_, show_, mark_, tally_, spots_,
                 shine_, sight_, gauge_, correct_, settle_, around_, gloss_, reflect_},
                passes);
}

cl::Event CachePasses::pick(const cl::CommandQueue& queue, const CacheParams& params,
                            const DeviceScene& scene, const CacheBuffers& b,
                            const cl::Buffer& places, const WaitList& wait) const {
    need_records(pick_, params, b);
    const std::size_t picks = std::size_t{params.count} * params.picks;
    need_stride(pick_, "pick_stride", params.pick_stride, picks);
    need(pick_, "places", places, PICK_PLANES * word * params.pick_stride);
    return launch(pick_, queue, packets(pick_, picks), wait, params, scene.info(), b.views,
                  b.visibility, scene, places);
}

cl::Event CachePasses::list(const cl::CommandQueue& queue, const CacheListParams& params,
                            const Crowds& crowds, const cl::Buffer& lists,
                            const WaitList& wait) const {
    need_range(list_.name.c_str(), "record_count", params.record_count, 1u, 1u << 30);
    need_stride(list_, "stride", params.stride, params.record_count);
    need_stride(list_, "crowd_stride", params.crowd_stride,
                (params.record_count + CACHE_CROWD - 1) / CACHE_CROWD);
    need_countable(list_.name, "lists", CACHE_WAYS * CACHE_LISTED, params.leaf_count);
    need(list_, "leaves", crowds.leaves, params.leaf_count * sizeof(CacheLeaf));
    need(list_, "records", crowds.records, 6 * word * params.stride);
    need(list_, "order", crowds.order, word * params.stride);
    need(list_, "boxes", crowds.boxes, 6 * word * params.crowd_stride);
    need(list_, "lists", lists, std::size_t{params.leaf_count} * CACHE_WAYS * CACHE_LISTED * word);
    return launch(list_, queue, params.leaf_count, wait, params, crowds.leaves, crowds.records,
                  crowds.order, crowds.boxes, lists);
}

cl::Event CachePasses::link(const cl::CommandQueue& queue, const CacheParams& params,
                            const CacheTree& tree, const DeviceScene& scene,
                            const EmitterBuffers& emitters, const CacheBuffers& b,
                            const WaitList& wait) const {
    need_records(link_, params, b);
    need_link(link_, params, tree, emitters, b);
    need_stride(link_, "row_stride", params.row_stride, tree.record_count);
    need(link_, "rows", b.rows,
         3 * word * params.row_stride * (std::size_t{params.first} + params.count));
    for (const cl::Buffer* light : {&b.base, &b.bright, &b.reflected})
        need(link_, "light", *light, 3 * word * params.stride);
    return launch(link_, queue, params.count * items_each(link_, groups_), wait, params, tree,
                  scene.info(), b.views, b.visibility, b.nodes, b.lists, b.planes, b.sky, scene,
                  emitters.emitters, emitters.views, emitters.visibility, b.by_spots, b.rows,
                  b.base, b.bright, b.reflected);
}

cl::Event CachePasses::mark(const cl::CommandQueue& queue, const CacheParams& params,
                            const DeviceScene& scene, const CacheBuffers& b,
                            const SpotBuffers& spots, const WaitList& wait) const {
    need_records(mark_, params, b);
    need(mark_, "seen", spots.seen, seen_bytes(scene));
    return launch(mark_, queue, std::size_t{5} * params.count, wait, params, b.views, b.visibility,
                  scene, spots.seen);
}

cl::Event CachePasses::tally(const cl::CommandQueue& queue, const SpotParams& params,
                             std::uint32_t size, const DeviceScene& scene,
                             const EmitterBuffers& emitters, const SpotBuffers& spots,
                             const WaitList& wait) const {
    need_spots(tally_, params, size, scene, emitters, spots);
    const std::size_t tiles = std::size_t{params.view_count} * SPOT_TILES_A_VIEW;
    need(tally_, "count", spots.count, tiles * word);
    need(tally_, "area", spots.area, tiles * word);
    return launch(tally_, queue, tiles, wait, params, spots.of, spots.views, spots.visibility,
                  emitters.views, emitters.emitters, spots.seen, spots.wanted, scene, spots.count,
                  spots.area);
}

cl::Event CachePasses::spots(const cl::CommandQueue& queue, const SpotParams& params,
                             std::uint32_t size, const DeviceScene& scene,
                             const EmitterBuffers& emitters, const SpotBuffers& spots,
                             const WaitList& wait) const {
    need_spots(spots_, params, size, scene, emitters, spots);
    need(spots_, "samples", spots.samples, params.sample_count * sizeof(SpotSample));
    need(spots_, "spots", spots.spots, params.sample_count * sizeof(Vpl));
    return launch(spots_, queue, params.sample_count, wait, params, scene.info(), spots.of,
                  spots.views, spots.visibility, emitters.views, spots.seen, spots.wanted, scene,
                  emitters.emitters, spots.samples, spots.spots);
}

cl::Event CachePasses::shine(const cl::CommandQueue& queue, const CacheParams& params,
                             const CacheTree& tree, const SpotParams& of, const DeviceScene& scene,
                             const CacheBuffers& b, const SpotBuffers& spots,
                             const WaitList& wait) const {
    need_records(shine_, params, b);
    need_tree(shine_, tree, b);
    need(shine_, "spots", spots.spots, of.sample_count * sizeof(Vpl));
    need(shine_, "reflected", b.reflected, 3 * word * params.stride);
    need(shine_, "hemicubes.views", spots.hemicubes.views, 5 * sizeof(View) * of.sample_count);
    need(shine_, "hemicubes.visibility", spots.hemicubes.visibility,
         3 * sizeof(std::uint64_t) * params.size * params.size * of.sample_count);
    return launch(shine_, queue, params.count, wait, params, tree, of, spots.hemicubes.views,
                  spots.hemicubes.visibility, b.nodes, b.lists, b.planes, scene, spots.spots,
                  b.reflected);
}

cl::Event CachePasses::bounce(const cl::CommandQueue& queue, const CacheBounceParams& params,
                              const CacheBuffers& b, const WaitList& wait) const {
    const std::size_t end = std::size_t{params.first} + params.record_count;
    need_stride(bounce_, "stride", params.stride, end);
    const std::size_t plane = word * params.stride;
    need_stride(bounce_, "row_stride", params.row_stride, 1);
    need_range("cache.bounce", "row_stride", params.row_stride, 1u, params.stride);
    need(bounce_, "rows", b.rows, 3 * word * params.row_stride * end);
    for (const cl::Buffer* light : {&b.base, &b.reflected, &b.bright, &b.light, &b.next, &b.shown})
        need(bounce_, "light", *light, 3 * plane);
    return launch(bounce_, queue, std::size_t{3} * params.record_count, wait, params, b.rows,
                  b.base, b.reflected, b.bright, b.light, b.next, b.shown);
}

cl::Event CachePasses::weigh(const cl::CommandQueue& queue, const CacheParams& params,
                             const CacheTree& tree, const CacheBuffers& b, const cl::Buffer& places,
                             const cl::Buffer& worth, const cl::Buffer& nearest,
                             const WaitList& wait) const {
    need_tree(weigh_, tree, b);
    const std::size_t picks = std::size_t{params.count} * params.picks;
    need_stride(weigh_, "pick_stride", params.pick_stride, picks);
    need(weigh_, "light", b.light, 3 * word * tree.stride);
    need(weigh_, "places", places, PICK_PLANES * word * params.pick_stride);
    need(weigh_, "worth", worth, word * params.pick_stride);
    need(weigh_, "nearest", nearest, word * params.pick_stride);
    return launch(weigh_, queue, packets(weigh_, picks), wait, params, tree, b.nodes, b.lists,
                  b.planes, b.light, places, worth, nearest);
}

cl::Event CachePasses::sharpen(const cl::CommandQueue& queue, const CacheSharpenParams& params,
                               const CacheTree& tree, const CacheBuffers& b, const Sharpened& light,
                               const Sharpened& more, const WaitList& wait) const {
    need_tree(sharpen_, tree, b);
    need_range(sharpen_.name.c_str(), "most", params.most, 1u, unsigned{CACHE_LISTED});
    const Sharpened second = params.more ? more : light;  // else not read or written
    const std::size_t size = 3 * word * tree.stride;
    need(sharpen_, "light.from", light.from, size);
    need(sharpen_, "light.to", light.to, size);
    need(sharpen_, "more.from", second.from, size);
    need(sharpen_, "more.to", second.to, size);
    return launch(sharpen_, queue, packets(sharpen_, tree.record_count), wait, params, tree,
                  b.nodes, b.lists, b.planes, light.from, light.to, second.from, second.to);
}

cl::Event CachePasses::show(const cl::CommandQueue& queue, const CacheShowParams& params,
                            const CacheTree& tree, const CacheBuffers& b, const GBuffer& points,
                            const cl::Buffer& irradiance, const cl::Buffer& doubt,
                            const WaitList& wait) const {
    CacheShowParams alone = params;
    alone.more = 0;
    return show(queue, alone, tree, b, points, irradiance, doubt, More(), wait);
}

cl::Event CachePasses::show(const cl::CommandQueue& queue, const CacheShowParams& params,
                            const CacheTree& tree, const CacheBuffers& b, const GBuffer& points,
                            const cl::Buffer& irradiance, const cl::Buffer& doubt, const More& more,
                            const WaitList& wait) const {
    need_tree(show_, tree, b);
    need_stride(show_, "stride", params.stride, params.point_count);
    need(show_, "light", b.light, 3 * word * tree.stride);
    need(show_, "points", points.planes, point_bytes(show_.storage, params.stride));
    need(show_, "irradiance", irradiance, irradiance_bytes(show_.storage, params.stride));
    need(show_, "doubt", doubt, word * params.stride);
    const More shown = params.more ? more : More{b.light, irradiance};  // else not read or written
    need(show_, "more.light", shown.light, 3 * word * tree.stride);
    need(show_, "more.irradiance", shown.irradiance,
         irradiance_bytes(show_.storage, params.stride));
    return launch(show_, queue, packets(show_, params.point_count), wait, params, tree, b.nodes,
                  b.lists, b.planes, b.light, points.planes, shown.light, irradiance, doubt,
                  shown.irradiance);
}

cl::Event CachePasses::sight(const cl::CommandQueue& queue, const CacheParams& params,
                             const CacheBuffers& b, const cl::Buffer& sight,
                             const WaitList& wait) const {
    need_records(sight_, params, b);
    need(sight_, "sight", sight,
         word * std::max<std::size_t>(1, std::size_t{params.sky_width} * params.sky_height));
    return launch(sight_, queue, std::size_t{5} * (params.sky_width > 0 ? params.count : 0), wait,
                  params, b.views, b.visibility, sight);
}

cl::Event CachePasses::around(const cl::CommandQueue& queue, const CacheParams& params,
                              const CacheAround& of, const CacheTree& tree,
                              const DeviceScene& scene, const EmitterBuffers& emitters,
                              const CacheBuffers& b, const cl::Buffer& around,
                              const WaitList& wait) const {
    need_records(around_, params, b);
    need_link(around_, params, tree, emitters, b);
    need_around(around_, of, params.first + params.count, around);
    if (of.size != params.size / params.every)
        throw Error("cache.around: size is " + std::to_string(of.size) + ", " +
                    std::to_string(params.size / params.every) + " needed");
    need(around_, "light", b.light, 3 * word * tree.stride);
    return launch(around_, queue, std::size_t{5} * of.slots, wait, params, tree, scene.info(),
                  b.views, b.visibility, b.nodes, b.lists, b.planes, b.sky, scene,
                  emitters.emitters, emitters.views, emitters.visibility, b.by_spots, of, b.light,
                  around);
}

cl::Event CachePasses::gloss(const cl::CommandQueue& queue, const CacheGlossParams& params,
                             const CacheAround& of, const CacheTree& tree, const DeviceScene& scene,
                             const CacheBuffers& b, const Glossy& picture,
                             const WaitList& wait) const {
    need_tree(gloss_, tree, b);
    need_stride(gloss_, "stride", params.stride, params.pixel_count);
    need_range("cache.gloss", "directions", params.directions, 1u, 1u << 16);
    need_range("cache.gloss", "shared", params.shared, 1u, 1u << 24);
    need_around(gloss_, of, tree.record_count, picture.around);
    need(gloss_, "light", b.light, 3 * word * tree.stride);
    need(gloss_, "views", b.views, 5 * sizeof(View) * tree.record_count);
    need(gloss_, "planes", picture.points.planes, gbuffer_bytes(gloss_.storage, params.stride));
    need(gloss_, "ids", picture.points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(gloss_, "irradiance", picture.irradiance, irradiance_bytes(gloss_.storage, params.stride));
    need(gloss_, "radiance", picture.radiance, RADIANCE_PLANES * word * params.stride);
    need(gloss_, "non_finite", picture.non_finite, word);
    return launch(gloss_, queue, packets(gloss_, params.pixel_count), wait, params, of, tree,
                  b.nodes, b.lists, b.planes, b.light, b.views, picture.around, scene.materials(),
                  picture.points.planes, picture.points.ids, picture.irradiance, picture.radiance,
                  picture.non_finite);
}

cl::Event CachePasses::reflect(const cl::CommandQueue& queue, const CacheGlossParams& params,
                               const CacheParams& of, const CacheTree& tree,
                               const DeviceScene& scene, const EmitterBuffers& emitters,
                               const CacheBuffers& b, const Smooth& picture,
                               const WaitList& wait) const {
    need_link(reflect_, of, tree, emitters, b);
    need_stride(reflect_, "stride", params.stride, params.pixel_count);
    need_range("cache.reflect", "directions", params.directions, 1u, 1u << 16);
    need_range("cache.reflect", "shared", params.shared, 1u, 1u << 24);
    need(reflect_, "light", b.light, 3 * word * tree.stride);
    need(reflect_, "sky", picture.sky,
         3 * word * std::max<std::size_t>(1, std::size_t{params.sky_width} * params.sky_height));
    need(reflect_, "planes", picture.points.planes, gbuffer_bytes(reflect_.storage, params.stride));
    need(reflect_, "ids", picture.points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(reflect_, "radiance", picture.radiance, RADIANCE_PLANES * word * params.stride);
    need(reflect_, "non_finite", picture.non_finite, word);
    return launch(reflect_, queue, packets(reflect_, params.pixel_count), wait, params, of, tree,
                  scene.info(), b.views, b.visibility, b.nodes, b.lists, b.planes, b.sky, scene,
                  emitters.emitters, emitters.views, emitters.visibility, b.by_spots, b.light,
                  scene.nodes(), scene.clusters(), scene.parts(), picture.sky,
                  picture.points.planes, picture.points.ids, picture.radiance, picture.non_finite);
}

std::size_t around_bytes(const CacheAround& of) {
    std::size_t sum = 0, level = std::size_t{3} * of.slots * of.size * of.size;
    for (int k = 0; k < AROUND_LEVELS; ++k, level /= 4) sum += level;
    return sum * sizeof(std::uint64_t);
}

}  // namespace clgi
