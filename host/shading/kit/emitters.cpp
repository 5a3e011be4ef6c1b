// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/kit/emitters.hpp>
#include <cstring>
#include <utility>

namespace clgi {
namespace {

bool same_views(const std::vector<View>& a, const std::vector<View>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(View)) == 0;
}

}  // namespace

Emitters::Emitters(const DeviceScene& scene, const EmitterOptions& options, Pixels kind)
    : scene_(&scene), set_(make_emitters(scene, options)), capacity_(set_.capacity) {
    buffers_.kind = kind;
    buffers_.view_count = set_.views.size();
    buffers_.pixels = set_.pixels;
}

void Emitters::add_to(BufferTable& table) {
    const char* lower = "emitters.shadow_size, face_size, area_size or area_samples";
    table.add(buffers_.emitters, "emitters", lower, capacity_.emitters * sizeof(Emitter));
    table.add(buffers_.views, "the emitters' views", lower, capacity_.views * sizeof(View));
    table.add(buffers_.visibility, "the emitters' shadow maps", lower,
              capacity_.pixels * pixel_bytes(buffers_.kind));
}

bool Emitters::update(const EmitterOptions& options) {
    keeps_ = false;
    EmitterSet next = make_emitters(*scene_, options);
    if (next.capacity.emitters > capacity_.emitters || next.capacity.views > capacity_.views ||
        next.capacity.pixels > capacity_.pixels)
        return false;
    set_ = std::move(next);
    buffers_.view_count = set_.views.size();
    buffers_.pixels = set_.pixels;
    return true;
}

std::size_t Emitters::follow(const EmitterOptions& options, Recorder& record,
                             const GBufferPasses& gbuffer) {
    std::size_t grown = 0;
    if (!update(options)) {
        Emitters larger(*scene_, options, buffers_.kind);
        BufferTable before("emitters"), table("emitters");
        add_to(before);
        larger.add_to(table);
        table.check(record.queue().getInfo<CL_QUEUE_DEVICE>(), 0, scene_->bytes());
        table.allocate(record);
        larger.build(gbuffer);
        grown = table.bytes() - std::min(before.bytes(), table.bytes());
        *this = std::move(larger);
    }
    record.forget_failed();
    write(record);
    return grown;
}

void Emitters::adopt(Emitters&& planned) {
    drawn_.clear();
    set_ = std::move(planned.set_);
    capacity_ = planned.capacity_;
    buffers_.view_count = set_.views.size();
    buffers_.pixels = set_.pixels;
}

std::uint32_t Emitters::samples_a_map(std::size_t pixels) const {
    constexpr std::size_t few = 2, many = 16;
    constexpr std::size_t cheaper = 16;  // a pixel of a map than one of a picture
    // A sample takes as long as so many pixels of maps for each of its own, and a triangle in a map
    // as so many of its pixels.
    constexpr std::size_t a_sample = 64, a_triangle = 6;
    const std::size_t drawn =
        set_.pixels + a_triangle * set_.views.size() * scene_->info().triangle_count;
    const bool soft = scene_->has_blended() || set_.soft();
    const std::size_t often = set_.directions > 0 && drawn < a_sample * pixels ? 1 : few;
    return static_cast<std::uint32_t>(
        soft ? often : std::max(many, set_.pixels / std::max<std::size_t>(cheaper * pixels, 1)));
}

void Emitters::write(Recorder& record) const {
    record.write(buffers_.emitters, set_.emitters.data(), set_.emitters.size() * sizeof(Emitter));
    record.write(buffers_.views, set_.views.data(), set_.views.size() * sizeof(View));
}

void Emitters::accept(Recorder& record, const LightPasses& passes, const cl::Buffer& mask,
                      const cl::Buffer& accepted) const {
    const cl::CommandQueue& queue = record.queue();
    const auto vpls = static_cast<std::uint32_t>(set_.vpl_count);
    for (std::size_t e = 0; e < set_.emitters.size(); ++e) {
        if (set_.candidates[e] == 0) continue;
        const AcceptParams params{static_cast<std::uint32_t>(e), set_.candidates[e], vpls, 0};
        record("lights.accept_mask", params.candidate_count, [&](const WaitList& wait) {
            return passes.accept_mask(queue, params, buffers_.emitters, mask, wait);
        });
        record("lights.accept_list", params.candidate_count, [&](const WaitList& wait) {
            return passes.accept_list(queue, params, buffers_.emitters, mask, accepted, wait);
        });
    }
}

void Emitters::build(const GBufferPasses& gbuffer) const {
    for (const EmitterCapacity::Together& views : capacity_.together)
        for (const std::uint32_t count : {views.least, views.most})
            build_draw(gbuffer, *scene_, {0, count, views.width, views.height, 0}, buffers_.kind);
}

void Emitters::draw(Recorder& record, const GBufferPasses& gbuffer, RasterBuffers lists) {
    if (std::exchange(keeps_, false) && same_views(drawn_, set_.views)) return;
    drawn_.clear();
    lists.pixels = buffers_.visibility;
    lists.kind = buffers_.kind;
    // Views of one size are drawn together.
    for (std::size_t first = 0, last; first < set_.views.size(); first = last) {
        last = first + 1;
        while (last < set_.views.size() && set_.views[last].width == set_.views[first].width)
            ++last;
        clgi::draw(record, gbuffer, *scene_, span_of(set_.views, first, last - first),
                   buffers_.views, lists);
    }
    if (!record.cancelled()) drawn_ = set_.views;
}

}  // namespace clgi
