// SPDX-License-Identifier: MIT
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/kit/picture.hpp>
#include <clgi/advanced/planes.hpp>

#include "core/opencl/check.hpp"

namespace clgi {
namespace {

PictureOptions checked(PictureOptions options, const DeviceScene& scene, const std::string& owner) {
    need_range<double>(owner.c_str(), "width", options.width, 1, 16384);
    need_range<double>(owner.c_str(), "height", options.height, 1, 16384);
    options.build.textures = options.build.textures && scene.needs_textures();
    return options;
}

// Shadow maps serve direct light, and solvers that ask for them.
EmitterOptions emitters_of(const PictureOptions& options, std::uint32_t sample = 0) {
    EmitterOptions out = options.emitters;
    out.sample = sample;
    out.shadows = out.shadows && (options.direct || options.shadow_maps);
    return out;
}

}  // namespace

Picture::Picture(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& scene,
                 const PictureOptions& options, std::string owner)
    : owner_(std::move(owner)),
      scene_(scene),
      options_(checked(options, scene, owner_)),
      gbuffer_(programs, options_.build),
      image_(programs, options_.build),
      emitters_(scene, emitters_of(options_), Pixels::depth),
      record_(queue, owner_) {}

BufferTable Picture::table() {
    const char* picture = "width and height";
    seen_.stride = plane_stride(pixels());
    seen_.storage = options_.build.storage;
    BufferTable t(owner_);
    emitters_.add_to(t);
    add_raster_lists(t, raster_, scene_);
    t.add(raster_.pixels, "the camera's visibility", picture, pixels() * sizeof(std::uint64_t));
    t.add(view_, "the camera's view", picture, sizeof(View));
    t.add(seen_.planes, "planes", picture, gbuffer_bytes(seen_.storage, seen_.stride));
    t.add(seen_.ids, "ids", picture, GBUFFER_ID_PLANES * seen_.stride * sizeof(std::uint32_t));
    t.add(irradiance_, "irradiance", picture, irradiance_bytes(seen_.storage, seen_.stride));
    t.add(radiance_, "radiance", picture, RADIANCE_PLANES * seen_.stride * sizeof(float));
    t.add_word(bad_, "counters", 0);
    return t;
}

void Picture::allocate(const BufferTable& table, std::size_t taken) {
    table.check(record_.queue().getInfo<CL_QUEUE_DEVICE>(), options_.memory_budget,
                scene_.bytes() + taken);
    table.allocate(record_);
    bytes_ = table.bytes();
    build_draw_gbuffer(gbuffer_, scene_);
    emitters_.build(gbuffer_);
    image_.build({"combine"});
    if (options_.direct && scene_.environment()) image_.build({"environment"});
    emitters_.write(record_);
    record_.fill(seen_.planes, 0);  // emission is written where there is some
}

void Picture::lights_changed() {
    bytes_ += emitters_.follow(emitters_of(options_, lights_), record_, gbuffer_);
}

void Picture::sample(std::uint32_t index) {
    const std::uint32_t lights = index / emitters_.samples_a_map(pixels());
    if (lights == lights_) return emitters_.keep_maps(index > 0);
    lights_ = lights;
    lights_changed();
}

View Picture::begin(const Camera& camera, const WaitList& wait, bool lights) {
    const View view = make_view(camera, scene_.frame(), options_.width, options_.height);
    record_.begin(wait);
    if (lights) draw_lights();
    draw_gbuffer(record_, gbuffer_, scene_, view, view_, raster_, seen_, RESOLVE_TRIANGLE);
    return view;
}

void Picture::draw_lights() { emitters_.draw(record_, gbuffer_, raster_); }

void Picture::weigh_sky(std::shared_ptr<const SkyWeights> weights) {
    options_.emitters.sky_weights = std::move(weights);
}

void Picture::combine(const View& view) {
    CombineParams params =
        combine_params(scene_, view, seen_.stride, emitters_.set().emitters.size(), Pixels::depth);
    params.effects |= COMBINE_INDIRECT;
    if (options_.direct) {
        params.effects |= COMBINE_DIRECT | COMBINE_EMISSION;
        if (scene_.has_lobes()) params.effects |= COMBINE_SPECULAR;
    }
    record_("image.combine", pixels(), [&](const WaitList& wait) {
        return image_.combine(record_.queue(), params, view, scene_,
                              {emitters_.buffers(), seen_, irradiance_, radiance_, bad_}, wait);
    });
}

cl::Event Picture::end(const View& view, double turned) {
    if (options_.direct && scene_.environment())
        record_("image.environment", pixels(), [&](const WaitList& wait) {
            return image_.environment(record_.queue(),
                                      environment_params(scene_, seen_.stride, turned), view,
                                      scene_.environment_texels(), seen_.planes, radiance_, wait);
        });
    return record_.last();
}

}  // namespace clgi
