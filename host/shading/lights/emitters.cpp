// SPDX-License-Identifier: MIT
#include <clgi/advanced/emitters.hpp>

#include <clgi/shared/halton.h>
#include <algorithm>
#include <array>
#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <string>

#include "core/opencl/check.hpp"
#include "scene/local_frame.hpp"
#include "scene/luminance.hpp"
#include "shading/lights/emitter_views.hpp"
#include "shading/lights/lamp_powers.hpp"
#include "shading/lights/replicate.hpp"
#include "shading/lights/single_view.hpp"

namespace clgi {
namespace {

using namespace shadow_views;

constexpr std::size_t most_pixels = std::size_t{1} << 30;  // kernels count view pixels in ints
using std::numbers::pi;

// Sources that stand for one another: what one of them does not send, others of its group may.
enum Group : std::size_t { lamps, environment, surfaces, group_count };

struct Source {
    Emitter emitter{};
    std::vector<View> views;
    double power = 0.0;
    double acceptance = 0.0;  // share of the sphere in a spot's cone
    Group group = lamps;
};

Source spot_or_point(const Light& light, const SceneFrame& frame, const EmitterOptions& options) {
    Source out;
    const bool spot = light.kind == Light::Kind::spot;
    const glm::vec3 eye = frame.to_local(light.position);
    const float near = 1e-4f * frame.detail;
    // Candela keep their meaning when lengths are scaled: I / d^2 = (I s^2) / (d s)^2.
    const glm::vec3 intensity =
        glm::vec3(glm::dvec3(light.intensity) * (frame.scale * frame.scale / frame.exposure));
    Emitter& e = out.emitter;
    e.position = glm::vec4(eye, 0.0f);
    e.intensity = glm::vec4(intensity, 0.0f);
    e.range = static_cast<float>(light.range * frame.scale);
    e.kind = spot ? EMITTER_SPOT : EMITTER_POINT;
    const glm::vec3 axis = spot ? glm::normalize(light.direction) : glm::vec3(0, 0, -1);
    const glm::vec3 right = across(axis);
    const double outer = spot ? light.outer_angle : pi;
    const double inner = spot ? std::min<double>(light.inner_angle, outer) : pi;
    e.axis = glm::vec4(axis, static_cast<float>(std::cos(outer)));
    e.right = glm::vec4(right, static_cast<float>(std::cos(inner)));
    // sin^2 of half the angle keeps what 1 - cos loses for narrow cones.
    out.acceptance = std::pow(std::sin(0.5 * outer), 2);
    e.measure = static_cast<float>(4.0 * pi * out.acceptance);
    // Between inner and outer angle the intensity falls as the square of a linear function of the
    // cosine, whose mean is a third.
    const double full = std::pow(std::sin(0.5 * inner), 2);
    out.power = luminance(intensity) * 4.0 * pi * (full + (out.acceptance - full) / 3.0);
    if (has_single_view(light)) {
        const float extent = static_cast<float>(std::tan(outer));
        out.views = {window(eye, right, glm::cross(right, axis), axis, extent, extent, near,
                            options.shadow_size, options.shadow_size)};
        shift_texels(out.views.front(), options);
    } else {
        out.views = cube(eye, near, options);
    }
    return out;
}

Source directional(const Light& light, const SceneFrame& frame, const EmitterOptions& options) {
    Source out;
    const glm::vec3 axis = glm::normalize(light.direction);
    const glm::vec3 right = across(axis);
    const float radius = 1.001f * frame.radius;
    const glm::vec3 lux = glm::vec3(glm::dvec3(light.intensity) / frame.exposure);
    Emitter& e = out.emitter;
    e.position = glm::vec4(-axis * (1.01f * radius), 0.0f);  // the disc touches the bounds
    e.axis = glm::vec4(axis, 0.0f);
    e.right = glm::vec4(right, 0.0f);
    e.intensity = glm::vec4(lux, 0.0f);
    e.kind = EMITTER_DIRECTIONAL;
    e.measure = static_cast<float>(pi) * radius * radius;
    out.power = luminance(lux) * e.measure;
    // A little larger: of a box far smaller than the scene, by what rounding of the eye asks for.
    const LocalBox box = options.receivers.value_or(LocalBox{frame.low, frame.high});
    const float around = options.receivers
                             ? 5e-4f * glm::length(box.high - box.low) + 1e-6f * radius
                             : 1e-3f * frame.radius;
    const Outline all = outline(box, around, axis, right);
    const auto add_view = [&](const glm::vec2& low, const glm::vec2& high) {
        const glm::vec2 extent = 0.5f * (high - low), middle = 0.5f * (high + low);
        View view = window(glm::vec3(e.position), all.right, all.up, axis, extent.x, extent.y, 0.0f,
                           options.shadow_size, options.shadow_size);
        view.eye.w = 1.0f;
        view.window = glm::vec4(middle, 2.05f * radius, 0.0f);
        shift_texels(view, options);
        out.views.push_back(view);
    };
    // The origin lies in the middle of the focus, if there is one.
    const glm::vec2 sides = 0.5f * (all.high - all.low);
    const float reach = options.receivers ? std::max(sides.x, sides.y) : radius;
    if (frame.detail < static_cast<float>(small_focus) * reach) {
        const glm::vec2 most(frame.detail);
        const glm::vec2 low = glm::max(all.low, -most), high = glm::min(all.high, most);
        const bool some = low.x < high.x && low.y < high.y;
        if (some || !options.receivers) add_view(some ? low : -most, some ? high : most);
    }
    add_view(all.low, all.high);
    return out;
}

// Directional lights that stand for the environment: in later samples and replicates the next ones
// of a Halton sequence of places.
std::vector<Light> sky_lights(const DeviceScene& scene, const EmitterOptions& options) {
    if (seed_of(options) == 0 && !options.sky_weights)
        return scene.environment_lights(options.environment_lights, options.sky_part);
    const auto count = static_cast<std::uint32_t>(options.environment_lights);
    const auto place = [&](std::uint32_t index, std::uint32_t base, std::uint32_t dimension) {
        return double{shifted_radical_inverse(
            index, base, replicate_shift(options.replicate + 1, ShiftUse::environment, dimension))};
    };
    std::vector<glm::dvec2> places;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::uint32_t index = options.sample * count + k;
        places.emplace_back(place(index, 2, 0), place(index, 3, 1));
    }
    return scene.drawn_environment_lights(places, options.sky_weights, options.sky_part);
}

std::vector<Source> environment_lights(const DeviceScene& scene, const EmitterOptions& options) {
    std::vector<Source> out;
    EmitterOptions own = options;
    if (options.environment_size > 0) own.shadow_size = options.environment_size;
    for (const Light& light : sky_lights(scene, options)) {
        out.push_back(directional(light, scene.frame(), own));
        out.back().group = environment;
    }
    return out;
}

// Of a point on emissive surfaces: where within its stratum of their power, and on a triangle.
struct AreaPlace {
    double within;
    float u, v;
};

// The points of a picture run on from triangle to triangle, so that triangles picked often are
// covered evenly. In later samples each stratum has a Halton sequence of its own, so that its
// points of all samples together are even, too.
AreaPlace area_place(std::uint32_t stratum, const EmitterOptions& options) {
    const bool first = options.sample == 0;
    const std::uint32_t index = first ? stratum + 1 : options.sample;
    const std::uint32_t seed =
        first ? options.replicate : 0x9e3779b9u * options.replicate + stratum + 1;
    const float shift = replicate_shift(seed, ShiftUse::stratum, 0);
    const float within =
        first ? (seed == 0 ? 0.5f : shift) : shifted_radical_inverse(index, 5, shift);
    return {double{within},
            shifted_radical_inverse(index, 2, replicate_shift(seed, ShiftUse::area, 0)),
            shifted_radical_inverse(index, 3, replicate_shift(seed, ShiftUse::area, 1))};
}

// Points on the emissive triangles, each standing for a share of their power.
std::vector<Source> area_samples(const DeviceScene& scene, const EmitterOptions& options) {
    const std::vector<EmissiveTriangle>& triangles = scene.emissive();
    std::vector<Source> out;
    if (triangles.empty() || options.area_samples < 1 || options.environment_alone) return out;
    const SceneFrame& frame = scene.frame();
    const auto is_beyond = [&](const EmissiveTriangle& t) {
        const glm::vec3 middle = (t.corner[0] + t.corner[1] + t.corner[2]) * (1.0f / 3.0f);
        return options.focused && glm::dot(middle, middle) > frame.detail * frame.detail;
    };
    std::vector<double> powers;
    for (const EmissiveTriangle& t : triangles)
        powers.push_back(is_beyond(t) ? 0.0 : pi * t.area * luminance(t.radiance));
    const LampPowers lamps(triangles, powers);
    if (!(lamps.total() > 0.0)) return out;
    // What is lit by the first points alone has each lamp's power; those of later samples do
    // together.
    const bool first = options.sample == 0;
    const int count = first ? options.area_samples : std::max(options.area_samples / 4, 1);
    for (const PowerStretch& stretch : lamps.stretches(count, first)) {
        const AreaPlace place = area_place(static_cast<std::uint32_t>(out.size()), options);
        const double power = stretch.end - stretch.begin;
        const EmissiveTriangle& t = triangles[lamps.at(stretch.begin + place.within * power)];
        const float root = std::sqrt(place.u), v = place.v;  // uniform on the triangle
        const glm::vec3 on = t.corner[0] * (1.0f - root) + t.corner[1] * (root * (1.0f - v)) +
                             t.corner[2] * (root * v);
        const float lift = 1e-4f * frame.detail;
        const float lum = luminance(t.radiance);
        Source source;
        Emitter& e = source.emitter;
        e.position = glm::vec4(on + t.normal * lift, 0.0f);
        e.axis = glm::vec4(t.normal, 0.0f);
        e.right = glm::vec4(across(t.normal), 0.0f);
        e.intensity = glm::vec4(t.radiance * static_cast<float>(power / lum), 0.0f);
        e.area = static_cast<float>(power / (pi * lum));
        e.kind = EMITTER_AREA;
        source.power = power;
        source.group = surfaces;
        source.views = hemicube(glm::vec3(e.position), t.normal, 0.5f * lift,
                                options.area_size > 0 ? options.area_size : options.face_size);
        out.push_back(source);
    }
    return out;
}

// The samples of all surfaces, or all directions of the environment, go dark together; each lamp
// for itself.
void count_views(const std::vector<Source>& sources, EmitterCapacity& capacity) {
    std::map<std::uint32_t, EmitterCapacity::Together> by_width;
    std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t> of_one;
    for (std::size_t i = 0; i < sources.size(); ++i)
        for (const View& view : sources[i].views) {
            ++capacity.views;
            capacity.pixels += static_cast<std::size_t>(view.width) * view.height;
            EmitterCapacity::Together& all = by_width[view.width];
            all.width = view.width;
            all.height = std::max(all.height, view.height);
            ++all.most;
            const std::size_t one = sources[i].group == lamps ? group_count + i : sources[i].group;
            ++of_one[{view.width, one}];
        }
    for (auto& [width, all] : by_width) {
        all.least = all.most;
        for (const auto& [key, count] : of_one)
            if (key.first == width) all.least = std::min(all.least, count);
        capacity.together.push_back(all);
    }
}

// Of the VPLs, how many are shared evenly, whatever the power: a dim lamp may be all that lights
// what the camera sees, while most of the power goes by.
constexpr double even = 0.25;

// Shares of the sources, 1 in sum: by power, and a part of them evenly to each lamp, to all
// directions and to all samples together.
std::vector<double> wanted_shares(const std::vector<Source>& sources) {
    std::array<double, group_count> power{};
    double total = 0.0, units = 0.0;
    for (const Source& source : sources) {
        total += source.power;
        power[source.group] += source.power;
        units += source.group == lamps;
    }
    for (const Group together : {environment, surfaces}) units += power[together] > 0.0;
    std::vector<double> out;
    for (const Source& source : sources) {
        const double of_unit = source.group == lamps ? 1.0 : source.power / power[source.group];
        out.push_back((1.0 - even) * (source.power / total) + even * of_unit / units);
    }
    return out;
}

// Whole lights by largest remainders, their sum exactly `lights`.
std::vector<std::uint32_t> divide(const std::vector<Source>& sources, int lights) {
    const std::vector<double> wanted = wanted_shares(sources);
    std::vector<std::uint32_t> shares;
    std::vector<std::pair<double, std::size_t>> rests;
    std::uint32_t given = 0;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const double exact = lights * wanted[i];
        shares.push_back(static_cast<std::uint32_t>(exact));
        given += shares.back();
        rests.emplace_back(exact - shares.back(), i);
    }
    std::stable_sort(rests.begin(), rests.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (std::size_t i = 0; given < static_cast<std::uint32_t>(lights); ++i, ++given)
        ++shares[rests[i % rests.size()].second];
    return shares;
}

// By what each group multiplies its indirect light, so that sources too weak for a light of their
// own are not lost: the others of the group take over their power, and all other groups that of a
// group without lights.
std::array<double, group_count> taken_over(const std::vector<Source>& sources,
                                           const std::vector<std::uint32_t>& shares) {
    std::array<double, group_count> power{}, lit{}, out{};
    for (std::size_t i = 0; i < sources.size(); ++i) {
        power[sources[i].group] += sources[i].power;
        if (shares[i] > 0) lit[sources[i].group] += sources[i].power;
    }
    double all = 0.0, sending = 0.0;
    for (std::size_t g = 0; g < group_count; ++g) {
        all += power[g];
        if (lit[g] > 0.0) sending += power[g];
    }
    for (std::size_t g = 0; g < group_count; ++g)
        out[g] = lit[g] > 0.0 ? power[g] / lit[g] * (all / sending) : 1.0;
    return out;
}

// Halton candidates to try; 0 where nothing is rejected, or where too much would be.
std::uint32_t candidate_count(const Source& source, std::uint32_t share) {
    if (source.emitter.kind != EMITTER_SPOT || share == 0) return 0;
    // Twice what is expected, and some more for few lights: the sequence's discrepancy is far less.
    const double tried = 2.0 * share / std::max(source.acceptance, 1e-12) + 1024.0;
    if (tried > most_candidates) return 0;
    return (static_cast<std::uint32_t>(tried) + 31) / 32 * 32;
}

}  // namespace

EmitterSet make_emitters(const DeviceScene& scene, const EmitterOptions& options) {
    need_range("emitters", "vpls", options.vpls, 0, 1 << 20);
    need_range("emitters", "shadow_size", options.shadow_size, 1, 8192);
    need_range("emitters", "face_size", options.face_size, 1, 4096);
    need_range("emitters", "area_size", options.area_size, 0, 4096);
    need_range("emitters", "area_samples", options.area_samples, 0, 4096);
    need_range("emitters", "environment_lights", options.environment_lights, 0, 4096);
    need_range("emitters", "environment_size", options.environment_size, 0, 8192);

    const int vpls = options.shadows ? options.vpls : 0;
    std::vector<Source> sources;
    if (scene.info().triangle_count > 0) {
        for (const Light& light : scene.lights()) {
            if (options.environment_alone) break;
            if (light.kind != Light::Kind::directional)
                sources.push_back(spot_or_point(light, scene.frame(), options));
            else if (options.directional)
                sources.push_back(directional(light, scene.frame(), options));
        }
        for (const auto& more : {environment_lights(scene, options), area_samples(scene, options)})
            sources.insert(sources.end(), more.begin(), more.end());
    }
    for (Source& source : sources) {
        if (!options.shadows) source.views.clear();
        for (View& view : source.views) view.flags |= seed_of(options) << VIEW_DITHER_SHIFT;
    }
    EmitterSet out;
    out.capacity.emitters = sources.size();
    count_views(sources, out.capacity);
    if (out.capacity.pixels > most_pixels)
        throw Error(
            "emitters: the sources' views have more than 2^30 pixels; fewer "
            "area_samples or environment_lights, or smaller shadow_size, face_size and area_size "
            "needed");
    std::erase_if(sources, [](const Source& source) { return !(source.power > 0.0); });
    if (sources.empty()) return out;
    const auto of_group = [&](Group group) {
        return static_cast<std::size_t>(
            std::count_if(sources.begin(), sources.end(),
                          [&](const Source& source) { return source.group == group; }));
    };
    out.lamps = of_group(lamps);
    out.directions = of_group(environment);
    const std::vector<std::uint32_t> shares = divide(sources, vpls);
    const std::array<double, group_count> factor = taken_over(sources, shares);
    // All directions of the environment spread their lights over one disc together, and all samples
    // of the emissive surfaces theirs over what they light: points of one sequence, as each alone
    // has too few.
    std::array<std::uint32_t, group_count> lights_of{}, given{};
    const std::uint32_t vpl_seed = seed_of(options) + 0x85ebca6bu * options.vpl_sample;
    for (std::size_t i = 0; i < sources.size(); ++i) lights_of[sources[i].group] += shares[i];
    for (std::size_t i = 0; i < sources.size(); ++i) {
        Source& source = sources[i];
        const bool alone = source.group == lamps;
        const std::uint32_t sharing = alone ? shares[i] : lights_of[source.group];
        if (source.emitter.kind == EMITTER_DIRECTIONAL)
            source.emitter.area =
                source.emitter.measure * (1.0f / static_cast<float>(std::max(sharing, 1u)));
        if (source.emitter.kind == EMITTER_AREA)
            source.emitter.measure =
                static_cast<float>(pi * shares[i] / static_cast<double>(std::max(sharing, 1u)));
        source.emitter.first_index = 1 + (alone ? 0 : given[source.group]);
        given[source.group] += shares[i];
        source.emitter.taken_over = static_cast<float>(factor[source.group]);
        source.emitter.first_view = static_cast<std::uint32_t>(out.views.size());
        source.emitter.view_count = static_cast<std::uint32_t>(source.views.size());
        source.emitter.first_vpl = static_cast<std::uint32_t>(out.vpl_count);
        source.emitter.vpl_count = shares[i];
        for (int d = 0; d < 4; ++d)
            source.emitter.shift[d] = replicate_shift(vpl_seed, ShiftUse::light, d);
        out.vpl_count += shares[i];
        out.candidates.push_back(candidate_count(source, shares[i]));
        if (source.emitter.kind == EMITTER_SPOT && out.candidates.back() == 0)
            source.emitter.kind |= EMITTER_MAPPED;
        out.emitters.push_back(source.emitter);
        for (View& view : source.views) {
            view.first_pixel = static_cast<std::uint32_t>(out.pixels);
            out.pixels += static_cast<std::size_t>(view.width) * view.height;
            out.views.push_back(view);
        }
    }
    return out;
}

}  // namespace clgi
