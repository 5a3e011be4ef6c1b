// Costs of methods, predicted from the analysis and the settings: fits of times on two cores of a
// CPU with packets of 16 (docs/plan.md), scaled by clock, units and lanes of the device.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/static_bake.hpp>
#include <clgi/plan.hpp>
#include <cmath>

#include "core/kit/ranges.hpp"
#include "methods/light_atlas/estimate.hpp"
#include "plan/method.hpp"
#include "plan/presets.hpp"
#include "plan/reach.hpp"
#include "plan/sky.hpp"
#include "plan/static_part.hpp"

namespace clgi {
namespace {

struct Amount {
    double ms = 0.0;
    double bytes = 0.0;
};
void operator+=(Amount& a, const Amount& b) {
    a.ms += b.ms;
    a.bytes += b.bytes;
}

// ms that a new process takes to load the built kernels of a bake, as measured under PoCL. Those of
// other methods take less than their pictures.
constexpr double loading = 110.0;

constexpr double touch = 0.8;  // ms a megabyte

// Of a point of an irradiance volume: ms that rays around it take, and what it has beside its
// light.
constexpr double around_point = 0.35;
constexpr double point_bytes = 2.0 * sizeof(float) * int{VOLUME_TEXELS};

constexpr double scene_bytes = 240.0;  // of a triangle of the static part, which is there twice

double triangles(const Plan& plan) { return static_cast<double>(plan.analysis.surfaces.triangles); }

// Those that direct light comes from, and the views of their shadow maps.
struct Lamps {
    double emitters = 0.0, views = 0.0, pixels = 0.0;
};
Lamps lamps_of(const Plan& plan, const EmitterOptions& options, bool environment) {
    const LightAnalysis& lights = plan.analysis.lights;
    Lamps out;
    const auto add = [&](double count, double views, double side) {
        out.emitters += count;
        out.views += count * views;
        out.pixels += count * views * side * side;
    };
    // A bake with size 0 takes 2048 pixels for few lights.
    const double map = options.shadow_size > 0 ? options.shadow_size : 2048.0;
    if (plan.on(Effect::point_light))
        add(static_cast<double>(lights.points), 6.0, options.face_size);
    if (plan.on(Effect::spot_light)) add(static_cast<double>(lights.spots), 1.0, map);
    const double views = sun_maps(plan.reach.value_or(Reach())).count;
    if (plan.on(Effect::directional_light))
        add(static_cast<double>(lights.directional), views, map);
    // A whole face and four halves. What has no area here may have some on the device, rounded.
    const int face = plan.method == Method::irradiance_cache
                         ? IrradianceCacheOptions::area_face(options.face_size)
                         : options.face_size;
    if (plan.on(Effect::area_light)) add(options.area_samples, 3.0, face);
    if (environment) add(options.environment_lights, views, map);
    return out;
}

Amount shadow_maps(const Plan& plan, const Lamps& lamps, bool drawn) {
    if (!drawn) return {};
    // Fine triangles cover pixels several times.
    const double pixel = 1.2e-6 + 1e-11 * triangles(plan);
    return {lamps.views * (0.05 + 2e-5 * triangles(plan)) + pixel * lamps.pixels,
            4.0 * lamps.pixels};
}

// The camera's view, and direct light at each pixel.
Amount picture(const Plan& plan, bool environment) {
    const double pixels = static_cast<double>(plan.request.width) * plan.request.height;
    const EmitterOptions& options = plan.picture.emitters;
    const Lamps lamps = lamps_of(plan, options, environment);
    Amount out{0.3 + 2.5e-5 * triangles(plan) + pixels * (1.0e-5 + 6e-6 * lamps.emitters),
               pixels * 120.0};
    if (plan.on(Effect::textures) || plan.on(Effect::cutouts)) out.ms += 1.5e-5 * pixels;
    if (plan.on(Effect::gloss)) out.ms += 2e-6 * pixels * lamps.emitters;
    out += shadow_maps(plan, lamps, options.shadows);
    return out;
}

PlanCost second_order(const Plan& plan) {
    const SecondOrderOptions& options = plan.second_order;
    const double pixels = static_cast<double>(options.width) * options.height;
    Amount frame = picture(plan, has_sky(plan));
    if (options.indirect) {
        const double lights = options.emitters.vpls + 2.0 * options.negative_vpls;
        const double share = 1.0 / (options.low_resolution_step * options.low_resolution_step);
        frame += {pixels * (1e-5 + 2e-7 * lights * (share + 0.05)), pixels * 40.0};
    }
    return {0.0, frame.ms, 1e-6 * frame.bytes};
}

// Of what is done before the first picture: once, whenever things move, and for each picture.
PlanCost added(const Plan& plan, const Amount& once, const Amount& moved, const Amount& picture) {
    PlanCost out{once.ms, picture.ms, 1e-6 * (once.bytes + moved.bytes + picture.bytes)};
    (plan.request.animated ? out.frame_ms : out.once_ms) += moved.ms;
    return out;
}

PlanCost atlas(const Plan& plan) {
    const double vpls = plan.vpls.count;
    double texels = 0.75 * plan.layout.size * plan.layout.size;
    if (bakes_static_part(plan)) texels += most_volume_points * VOLUME_DIRECTIONS;
    const auto bake =
        light_atlas::bake_cost(vpls, texels, triangles(plan), occludes(plan.light_atlas.occlusion));
    const bool environment = has_sky(plan);
    const Amount maps = shadow_maps(plan, lamps_of(plan, plan.light_atlas.emitters, environment),
                                    plan.light_atlas.emitters.shadows);
    Amount before{bake.ms, bake.bytes}, moved = maps;
    if (bakes_static_part(plan) && !plan.on(Effect::moving_lights)) {  // baked once, whatever moves
        before += maps;
        moved = {};
    }
    Amount frame = picture(plan, environment);
    if (bakes_static_part(plan)) {
        before.bytes += scene_bytes * triangles(plan);
        before += {most_volume_points * around_point, most_volume_points * point_bytes};
        frame.ms += 2e-5 * plan.request.width * plan.request.height;
    }
    return added(plan, before, moved, frame);
}

PlanCost antiradiance(const Plan& plan) {
    const AntiradianceOptions& options = plan.antiradiance;
    const double requested = static_cast<double>(options.elements.requested);
    // Leaves of fine meshes are joined vertices, each of which is looked at from nearby; where they
    // move or are not shared, small triangles are leaves. Each has links of its own to what is
    // near.
    const bool fine = triangles(plan) > requested;
    const bool joined = !plan.on(Effect::moving_geometry) &&
                        plan.analysis.surfaces.vertices < plan.analysis.surfaces.triangles;
    const double leaves = fine && !joined ? requested + triangles(plan) : requested;
    const double links =
        leaves * options.bins * (fine ? 3.0 : 2.2 * std::pow(leaves / 1000.0, -0.2));
    const double steps = options.steps > 0 ? options.steps : 20.0;
    const Lamps lamps = lamps_of(plan, options.emitters, false);
    const double once = fine ? 7e-3 * triangles(plan) : 0.0;
    const Amount linking{(fine ? 2.2e-4 : 1.7e-4) * links + 2e-3 * leaves + once, 16.0 * links};
    // Rows, of antiradiance and of intensities, where something may lie between.
    const bool rows = plan.on(Effect::indirect_occlusion);
    const double beyond_cache = 1.0 + std::min(links / 5e6, 1.6);
    const double step = links * (rows ? 2.4e-6 : 1.6e-6) * beyond_cache;
    Amount exchange{steps * step + 1e-4 * leaves * lamps.emitters,
                    leaves * options.bins * 12.0 * (rows ? 2.0 : 1.0)};
    if (plan.on(Effect::gloss))
        exchange += {steps * plan.analysis.surfaces.glossy_area * leaves * options.bins *
                         options.bins * 1e-7,
                     plan.analysis.surfaces.glossy_area * leaves * options.bins * 24.0};
    exchange += shadow_maps(plan, lamps, options.emitters.shadows);
    if (plan.request.animated && plan.on(Effect::moving_geometry))
        exchange += {2.8e-5 * links, 8.0 * links};  // links follow
    return added(plan, linking, exchange, picture(plan, false));
}

PlanCost dynamic_transfer(const Plan& plan) {
    const double receivers = 0.6 * triangles(plan);
    const double terms = 25.0;
    Amount vectors{2.0, receivers * 40.0};
    if (occludes(plan.transfer.occlusion)) {
        const double masks = receivers * triangles(plan) * 2e-6 + receivers * 8e-3;
        vectors +=
            {masks * (1 + plan.transfer.interreflections), receivers * (terms * 4.0 + 128.0)};
    }
    return added(plan, {}, vectors, picture(plan, false));
}

// Each record has its hemicube drawn and looked up.
PlanCost irradiance_cache(const Plan& plan) {
    const IrradianceCacheOptions& options = plan.cache;
    // A block of pixels has more than one record where what it shows is finely modelled.
    const bool fine = is_fine(plan);
    const double planes = fine ? 3.3 : 1.5;
    const double shown = planes * options.seen + options.refined, records = shown + options.met,
                 pixels = 3.0 * options.face * options.face;
    // The sky is looked at in all pixels that are drawn.
    const double drawn = 3.0 * std::pow(options.drawn_face(has_sky(plan), triangles(plan)), 2.0),
                 above = has_sky(plan) ? 8e-6 * drawn : 0.0;
    // A pixel of a hemicube is lit by all lamps, but by few of the samples of emissive surfaces.
    // Some pixels are looked up again while records are weighed.
    constexpr double weighed = 1.3;
    const Lamps lamps = lamps_of(plan, plan.picture.emitters, false);
    const double samples =
        plan.on(Effect::area_light) ? static_cast<double>(plan.picture.emitters.area_samples) : 0.0;
    const double looked = lamps.emitters - samples +
                          std::min(samples, static_cast<double>(options.samples_at_once()));
    const double look = (4e-5 + 1e-5 * looked) * pixels;
    // Small places that lights light: records are drawn again to find them, lights' views of them
    // too, and VPLs on them have hemicubes of their own.
    const LightAnalysis& lights = plan.analysis.lights;
    const bool lit = lights.points + lights.spots + lights.directional > 0;
    const bool small = fine && lit && options.spots > 0;
    const double again = small ? 4.0 * options.spots : 0.0,
                 finer = 0.05 + 7e-4 * std::sqrt(triangles(plan)),
                 places = small ? 7e-4 * triangles(plan) : 0.0;
    // By rays where pixels are few, else by triangles (GBufferPasses::prefers_trace_views, on
    // CPUs).
    const bool traced = triangles(plan) >= 200.0 * drawn;
    const double drawing = traced ? 4e-4 * drawn : 0.05 + 1e-3 * std::sqrt(triangles(plan));
    Amount frame = picture(plan, false);
    // Of each record, pair and pixel, where surfaces are fine: lists, looks and reflections.
    const double own = fine ? 0.07 : 0.0, pair = fine ? 1.2e-5 : 2e-6, shows = fine ? 2.6e-4 : 0.0;
    frame += {records * (drawing + above + weighed * look + own) + again * finer + places +
                  pair * records * records + shows * plan.request.width * plan.request.height,
              records * (8.0 * drawn + 12.0 * records)};
    if (plan.on(Effect::gloss))  // what records have around them, and directions of lobes
        frame +=
            {shown * look + 8e-4 * plan.request.width * plan.request.height, 10.5 * shown * pixels};
    return {0.0, frame.ms, 1e-6 * frame.bytes};
}

}  // namespace

double shadow_pixels(const Plan& plan) {
    const bool sky = has_sky(plan) && has_sky_lights(plan.method);
    return lamps_of(plan, plan.picture.emitters, sky).pixels;
}

PlanCost cost_of(const cl::Device& device, const Plan& plan) {
    PlanCost out;
    switch (plan.method) {
        case Method::direct:
        case Method::second_order:
            out = second_order(plan);
            break;
        case Method::light_atlas:
            out = atlas(plan);
            break;
        case Method::antiradiance:
            out = antiradiance(plan);
            break;
        case Method::dynamic_transfer:
            out = dynamic_transfer(plan);
            break;
        case Method::irradiance_cache:
            out = irradiance_cache(plan);
            break;
    }
    const double slower = fitted_pairs / pairs_per_second(device);
    out.once_ms *= slower;
    out.frame_ms *= slower;
    if (plan.method == Method::light_atlas) out.once_ms += loading;
    // The first touch of memory, which a system hands out in pages.
    if (device.getInfo<CL_DEVICE_TYPE>() == CL_DEVICE_TYPE_CPU)
        out.once_ms += touch * out.megabytes;
    return out;
}

}  // namespace clgi
