// What lobes reflect of indirect light and of the sky: rough ones by what the records have around
// them, smooth ones by rays.
// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/state.hpp"
#include "shading/kit/eye.hpp"

namespace clgi {
namespace {

// Of the lobe, a pixel: in the first sample, which may be the only one, and in those after it. Each
// stands for one of `level` parts of it.
struct Directions {
    std::uint32_t first, more, level;
};
constexpr Directions looked_up{8, 4, 4}, followed{4, 1, 8};
constexpr float smooth = 0.25f;  // alpha up to which rays pay

void take_directions(CacheGlossParams& params, const Directions& of, std::uint32_t sample) {
    params.directions = sample == 0 ? of.first : of.more;
    params.first_direction = sample == 0 ? 0 : of.first + (sample - 1) * of.more;
    params.shared = of.level;
}

}  // namespace

bool IrradianceCache::State::follows_lobes() const { return scene.least_alpha() <= smooth; }

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
    if (!mirrored.texels.empty())
        record.write(mirrored_sky, mirrored.texels.data(), mirrored.texels.size() * sizeof(float));
}

void IrradianceCache::State::add_gloss(const View& view) {
    if (!scene.has_lobes()) return;
    CacheGlossParams params{};
    params.eye = eye_of(view);
    params.pixel_count = static_cast<std::uint32_t>(picture.pixels());
    params.stride = picture.stride();
    take_directions(params, looked_up, sample);
    params.exposure = static_cast<float>(scene.frame().exposure);
    params.smooth = follows_lobes() ? smooth : 0.0f;
    params.sky_width = static_cast<std::uint32_t>(mirrored.width);
    params.sky_height = static_cast<std::uint32_t>(mirrored.height);
    Recorder& record = picture.record();
    record("cache.gloss", picture.pixels(), [&](const WaitList& wait) {
        return passes.gloss(record.queue(), params, surroundings, shown_tree(), scene,
                            shown_buffers(),
                            {around, picture.gbuffer(), picture.irradiance(), picture.radiance(),
                             picture.counter()},
                            wait);
    });
    if (!follows_lobes()) return;
    take_directions(params, followed, sample);
    CacheParams seen = this->params(0, records.size());
    seen.spots = 0;  // rays see what hemicubes leave to VPLs
    record("cache.reflect", picture.pixels(), [&](const WaitList& wait) {
        return passes.reflect(
            record.queue(), params, seen, tree, scene, picture.emitter_buffers(), b,
            {picture.gbuffer(), mirrored_sky, picture.radiance(), picture.counter()}, wait);
    });
}

}  // namespace clgi
