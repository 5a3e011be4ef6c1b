// Light from record to record, and from records to the picture.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/irradiance_cache/state.hpp"

namespace clgi {
namespace {

constexpr int most_steps = 256, steps_a_look = 8;
constexpr float rest = 1e-3f;

}  // namespace

void IrradianceCache::State::plant(CacheTree& of, cl::Buffer& nodes, cl::Buffer& lists) {
    planted = make_tree(records);
    of = {};
    for (int c = 0; c < 3; ++c) (&of.centre.x)[c] = planted.centre[c];
    of.centre.w = planted.half_side;
    of.node_count = static_cast<std::uint32_t>(planted.nodes.size());
    of.record_count = static_cast<std::uint32_t>(records.size());
    of.stride = stride;
    Recorder& record = picture.record();
    const auto put = [&](cl::Buffer& buffer, const auto& values) {
        const std::size_t size = values.size() * sizeof(values[0]);
        grow(buffer, size);
        record.write(buffer, values.data(), size);
    };
    put(nodes, planted.nodes);
    put(crowds.leaves, planted.leaves);
    put(crowds.records, planted.records);
    put(crowds.order, planted.order);
    put(crowds.boxes, planted.boxes);
    const std::size_t count = planted.leaves.size();
    grow(lists, count * CACHE_WAYS * CACHE_LISTED * sizeof(std::uint32_t));
    record("cache.list", count, [&](const WaitList& wait) {
        return passes.list(record.queue(), planted.params, crowds, lists, wait);
    });
}

void IrradianceCache::State::link(std::size_t first, std::uint32_t thin) {
    Recorder& record = picture.record();
    if (first == 0) {
        plant(tree, b.nodes, b.lists);
        // To the stride: rows are summed in whole packets.
        for (const cl::Buffer* buffer :
             {&b.base, &b.reflected, &b.bright, &b.light, &b.next, &b.shown, &sharp_light})
            record.fill(*buffer, 0);
        if (!sky.texels.empty())
            record.write(b.sky, sky.texels.data(), sky.texels.size() * sizeof(float));
    }
    const std::size_t count = records.size() - first;
    CacheParams of = params(first, count);
    of.thin = thin;
    take_turns(of, options.samples_at_once());
    record("cache.link", count, [&](const WaitList& wait) {
        return passes.link(record.queue(), of, tree, scene, picture.emitter_buffers(), b, wait);
    });
    if (spots.sample_count == 0) return;
    record("cache.shine", count * spots.sample_count, [&](const WaitList& wait) {
        return passes.shine(record.queue(), of, tree, spots, scene, b, spot, wait);
    });
}

void IrradianceCache::State::grow(cl::Buffer& buffer, std::size_t size) {
    const std::size_t held = buffer() ? buffer.getInfo<CL_MEM_SIZE>() : 0;
    if (held >= size) return;
    const std::size_t wanted = size + size / 4;
    buffer =
        cl::Buffer(picture.record().queue().getInfo<CL_QUEUE_CONTEXT>(), CL_MEM_READ_WRITE, wanted);
    grown += wanted - held;
}

void IrradianceCache::State::light(int limit) {
    Recorder& record = picture.record();
    const auto count = static_cast<std::uint32_t>(records.size());
    record("cache.begin", count, [&](const WaitList& wait) {
        cl::Event copied;
        record.queue().enqueueCopyBuffer(b.base, b.light, 0, 0,
                                         3 * std::size_t{stride} * sizeof(float), &wait, &copied);
        return copied;
    });
    const bool until_it_rests = limit == 0;
    if (until_it_rests) limit = most_steps;
    found.converged = false;
    int step = 0;
    while (step < limit && !found.converged) {
        const int last = std::min(limit, step + steps_a_look);
        for (; step < last; ++step) bounce(0);
        if (until_it_rests) found.converged = rests();
    }
    found.bounces = step;
    if (!until_it_rests) found.converged = true;
}

void IrradianceCache::State::bounce(std::size_t first) {
    Recorder& record = picture.record();
    const auto count = static_cast<std::uint32_t>(records.size() - first);
    const CacheBounceParams params{count, stride, static_cast<std::uint32_t>(first), row_stride};
    CacheBuffers lit = b;
    lit.light = sharp_light;
    record("cache.sharpen", tree.record_count, [&](const WaitList& wait) {
        const CachePasses::Sharpened light{b.light, sharp_light};
        return passes.sharpen(record.queue(), {CACHE_FEW, 0, 0, 0}, tree, b, light, light, wait);
    });
    record("cache.bounce", 3 * count,
           [&](const WaitList& wait) { return passes.bounce(record.queue(), params, lit, wait); });
    std::swap(b.light, b.next);
}

bool IrradianceCache::State::rests() {
    const std::size_t count = 3 * std::size_t{stride};
    std::vector<float> now(count), before(count);
    const cl::CommandQueue& queue = picture.record().queue();
    const WaitList pending = picture.record().waits();
    queue.enqueueReadBuffer(b.light, CL_TRUE, 0, count * sizeof(float), now.data(), &pending);
    queue.enqueueReadBuffer(b.next, CL_TRUE, 0, count * sizeof(float), before.data());
    float most = 0.0f, change = 0.0f;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < records.size(); ++i) {
            const std::size_t at = c * stride + i;
            most = std::max(most, now[at]);
            change = std::max(change, std::abs(now[at] - before[at]));
        }
    return change <= rest * most;
}

CacheBuffers IrradianceCache::State::shown_buffers() const {
    CacheBuffers out = b;
    out.light = sharp_shown;
    if (found.refined > 0) {
        out.nodes = all_nodes;
        out.lists = all_lists;
    }
    return out;
}

void IrradianceCache::State::show(bool sky) {
    Recorder& record = picture.record();
    const CacheBuffers of = shown_buffers();
    const std::uint32_t more = sky ? 1 : 0;
    record("cache.sharpen", records.size(), [&](const WaitList& wait) {
        return passes.sharpen(record.queue(), {CACHE_LISTED, 1, more, 0}, shown_tree(), of,
                              {settles() ? settled : b.shown, sharp_shown}, {b.next, sharp_sky},
                              wait);
    });
    const CacheShowParams params{static_cast<std::uint32_t>(picture.pixels()), picture.stride(),
                                 more, 0};
    record("cache.show", picture.pixels(), [&](const WaitList& wait) {
        return passes.show(record.queue(), params, shown_tree(), of, picture.gbuffer(),
                           picture.irradiance(), doubt, {sharp_sky, found_light}, wait);
    });
}

}  // namespace clgi
