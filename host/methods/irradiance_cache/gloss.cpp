// What lobes reflect of indirect light and of the sky, by what the records have around them.
// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/state.hpp"
#include "shading/kit/eye.hpp"

namespace clgi {
namespace {

// Of the lobe, a pixel: in the first sample, which may be the only one, and in those after it.
constexpr std::uint32_t first_directions = 8, more_directions = 4;

}  // namespace

void IrradianceCache::State::look_around() {
    if (!scene.has_lobes()) return;
    const auto met = static_cast<std::uint32_t>(found.met);
    surroundings = {static_cast<std::uint32_t>(found.seen), met,
                    static_cast<std::uint32_t>(records.size()) - met,
                    static_cast<std::uint32_t>(options.face)};
    Recorder& record = picture.record();
    record("cache.around", surroundings.slots, [&](const WaitList& wait) {
        return passes.around(record.queue(), params(0, records.size()), surroundings, tree, scene,
                             picture.emitter_buffers(), b, around, wait);
    });
}

void IrradianceCache::State::add_gloss(const View& view) {
    if (!scene.has_lobes()) return;
    CacheGlossParams params{};
    params.eye = eye_of(view);
    params.pixel_count = static_cast<std::uint32_t>(picture.pixels());
    params.stride = picture.stride();
    params.directions = sample == 0 ? first_directions : more_directions;
    params.first_direction = sample == 0 ? 0 : first_directions + (sample - 1) * more_directions;
    params.exposure = static_cast<float>(scene.frame().exposure);
    Recorder& record = picture.record();
    record("cache.gloss", picture.pixels(), [&](const WaitList& wait) {
        return passes.gloss(record.queue(), params, surroundings, shown_tree(), scene,
                            shown_buffers(),
                            {around, picture.gbuffer(), picture.irradiance(), picture.radiance(),
                             picture.counter()},
                            wait);
    });
}

}  // namespace clgi
