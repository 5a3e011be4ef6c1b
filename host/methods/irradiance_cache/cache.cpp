// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <numeric>
#include <string>

#include "core/kit/ranges.hpp"
#include "core/opencl/check.hpp"
#include "methods/irradiance_cache/state.hpp"
#include "shading/kit/without_sky.hpp"

namespace clgi {
namespace {

constexpr const char* cache_owner = "irradiance-cache";
constexpr std::size_t most_chosen = 8192;  // places of other hemicubes than those of records

// The sky's small bright parts light pixels as lamps do: hemicubes would see them from one record
// and miss them from the next. One that is no larger than a sun lights what hemicubes see in this
// way, too.
void light_brightly(IrradianceCacheOptions& options, const DeviceScene& scene) {
    constexpr double sun = 0.002;  // steradians
    constexpr int many = 16, map = 256;
    const BrightSky bright = scene.bright_sky();
    if (bright.share == 0.0 || !options.picture.direct) return;
    EmitterOptions& lights = options.picture.emitters;
    lights.sky_part = SkyPart::bright;
    lights.environment_lights = bright.solid_angle < sun ? 1 : many;
    if (lights.environment_lights > 1) lights.environment_size = std::min(lights.shadow_size, map);
    lights.shadows = true;
}

IrradianceCacheOptions checked(IrradianceCacheOptions options, const DeviceScene& scene) {
    need_range(cache_owner, "seen", options.seen, 1, 20000);
    need_range(cache_owner, "met", options.met, 0, 20000);
    need_range(cache_owner, "refined", options.refined, 0, 20000);
    need_range(cache_owner, "face", options.face, 8, 256);
    need_range(cache_owner, "bounces", options.bounces, 0, 1000);
    need_range(cache_owner, "sky_lights", options.sky_lights, 0, 4096);
    need_range(cache_owner, "spots", options.spots, 0, 1024);
    if (options.face % 8 != 0)
        throw Error(std::string(cache_owner) + ": face is " + std::to_string(options.face) +
                    ", a multiple of 8 needed");
    if (options.picture.build.storage != Storage::full)
        throw Error(std::string(cache_owner) +
                    ": storage is half, full needed: the host reads where pixels are");
    options.picture = without_sky(options.picture);
    options.picture.shadow_maps = true;  // records are lit by them
    light_brightly(options, scene);
    options.picture.build.textures = options.picture.build.textures && scene.needs_textures();
    if (options.emission) options.picture.emitters.area_samples = 0;
    options.picture.emitters.focused = true;
    EmitterOptions& lights = options.picture.emitters;
    if (lights.area_size == 0)
        lights.area_size = IrradianceCacheOptions::area_face(lights.face_size);
    return options;
}

int drawn_face(const IrradianceCacheOptions& options, const DeviceScene& scene) {
    return options.drawn_face(scene.environment().has_value(), scene.info().triangle_count);
}

// Records on what pixels see: a block of pixels has up to four.
std::size_t most_around(const IrradianceCacheOptions& options) {
    const auto pixels = static_cast<std::size_t>(options.picture.width) *
                        static_cast<std::size_t>(options.picture.height);
    return std::min(4 * static_cast<std::size_t>(options.seen), 4 * pixels) +
           static_cast<std::size_t>(options.refined);
}

std::size_t most_records(const IrradianceCacheOptions& options) {
    return most_around(options) + static_cast<std::size_t>(options.met);
}

std::size_t most_around_bytes(const DeviceScene& scene, const IrradianceCacheOptions& options) {
    if (!scene.has_lobes()) return 0;
    return around_bytes({0, 0, static_cast<std::uint32_t>(most_around(options)),
                         static_cast<std::uint32_t>(options.face)});
}

}  // namespace

Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                  const IrradianceCacheOptions& options) {
    const IrradianceCacheOptions o = checked(options, scene);
    const auto most = static_cast<double>(most_records(o)), face = static_cast<double>(o.face),
               drawn_side = static_cast<double>(drawn_face(o, scene));
    const double records = 1.6 * o.seen + o.met + o.refined;  // as many as a room has
    const double hemicube = 5.0 * sizeof(View) + 24.0 * drawn_side * drawn_side;
    // Of two trees and their lists, of some four leaves a record.
    constexpr double trees = 2.0 * 4.0 * 1.25 * 4.0 * int{CACHE_WAYS} * int{CACHE_LISTED};
    const double per_record = hemicube + 12.0 * (most - o.refined) + 36.0 +
                              (PICK_PLANES + 2) * 4.0 * picks_per_record + trees;
    const auto vpls = static_cast<double>(most_vpls(o));
    const double spots =
        vpls > 0.0 ? vpls * hemicube + sizeof(std::uint64_t) *
                                           static_cast<double>(spot_pixels(o.picture.emitters))
                   : 0.0;
    const auto around = static_cast<double>(most_around_bytes(scene, o));
    // Directions of the sky have a map each, or two, and pixels their corrections.
    double sky = 0.0;
    if (o.sky_lights > 0 && scene.environment()) {
        const double side = sky_options(o, 0).shadow_size;
        sky = o.sky_lights * side * side * sizeof(std::uint32_t) +
              8.0 * sizeof(float) * o.picture.width * o.picture.height;
    }
    constexpr double pairs = 32.0, drawn = 4e-9;  // a pixel; a triangle in a hemicube, seconds
    const double milliseconds = 1e3 * records *
                                (3.0 * face * face * pairs / pairs_per_second(device) +
                                 drawn * static_cast<double>(scene.info().triangle_count));
    return {static_cast<std::size_t>(most * per_record + spots + sky + around), milliseconds};
}

IrradianceCache::State::State(const Programs& programs, const cl::CommandQueue& queue,
                              const DeviceScene& of, const IrradianceCacheOptions& wanted)
    : scene(of),
      options(checked(wanted, of)),
      drawn(drawn_face(options, of)),
      picture(programs, queue, of, options.picture, cache_owner),
      passes(programs, options.picture.build),
      cubes(programs, options.picture.build),
      sky_lights(of, sky_options(options, 0), Pixels::depth),
      lights(programs, options.picture.build) {
    capacity = most_records(options);
    stride = plane_stride(capacity);
    row_stride =
        std::min(stride, plane_stride(capacity - static_cast<std::size_t>(options.refined)));
    read_sky();
    BufferTable all = picture.table();
    add_to(all);
    picture.allocate(all);
    std::vector<std::uint32_t> order(std::max<std::size_t>(capacity, most_chosen));
    std::iota(order.begin(), order.end(), 0u);
    picture.record().write(chosen, order.data(), order.size() * sizeof(std::uint32_t));
    passes.build({"list", "link", "bounce", "sharpen", "show"});
    if (options.met > 0) passes.build({"pick", "weigh"});
    if (casts_spots()) passes.build({"mark", "tally", "spots", "shine"});
    const auto side = static_cast<std::uint32_t>(drawn);
    if (!cubes.prefers_trace_views({0, 5, side, side}, of))
        cubes.build({"cubes", "raster_views"});
    else if (casts_spots())  // by finer hemicubes
        cubes.build({"cubes", "trace_views", "raster_views"});
    else
        cubes.build({"cubes", "trace_views"});
    if (scene.has_lobes()) passes.build({"around", "gloss"});
    if (follows_lobes()) passes.build({"reflect"});
    if (!corrects()) return;
    sky_lights.build(picture.passes());
    passes.build({"sight", "gauge", "correct", "settle"});
    lights.build({"direct"});
}

void IrradianceCache::State::read_sky() {
    constexpr int of_hemicubes = 128, of_mirrors = 1024;  // columns
    sky = coarse_sky(scene.environment_part(soft_sky(options)), of_hemicubes);
    if (options.picture.emitters.environment_lights > 1)
        sky.add(coarse_sky(scene.environment_part(SkyPart::bright), of_hemicubes));
    if (follows_lobes())
        mirrored = coarse_sky(scene.environment_part(soft_sky(options)), of_mirrors);
}

void IrradianceCache::State::add_to(BufferTable& table) {
    const char* lower = "seen, met, refined or face";
    const std::size_t word = sizeof(float), plane = stride * word;
    const auto face = static_cast<std::size_t>(drawn);
    const auto vpls = static_cast<std::size_t>(options.spots);  // whose picks are scattered
    pick_stride = plane_stride(std::max({capacity, vpls, scattered}) * picks_per_record);
    table.add(b.planes, "records", lower, RECORD_PLANES * plane);
    table.add(b.views, "hemicubes", lower, 5 * capacity * sizeof(View));
    table.add(b.visibility, "what hemicubes see", lower,
              3 * face * face * capacity * sizeof(std::uint64_t));
    table.add(b.rows, "transport", lower, 3 * row_stride * word * capacity);
    for (cl::Buffer* light : {&b.base, &b.reflected, &b.bright, &b.light, &b.next, &b.shown,
                              &sharp_light, &sharp_shown})
        table.add(*light, "light", lower, 3 * plane);
    table.add(chosen, "records", lower, std::max<std::size_t>(capacity, most_chosen) * word);
    table.add(doubt, "doubt", "width or height", word * picture.stride());
    table.add(places, "places", lower, PICK_PLANES * pick_stride * word);
    for (cl::Buffer* of : {&worth, &nearest}) table.add(*of, "places", lower, pick_stride * word);
    table.add(b.sky, "the sky", "the environment",
              std::max<std::size_t>(16, sky.texels.size() * word));
    add_spots(table);
    if (scene.has_lobes())
        table.add(around, "what records have around them", lower,
                  most_around_bytes(scene, options));
    if (follows_lobes())
        table.add(mirrored_sky, "the sky", "the environment",
                  std::max<std::size_t>(16, mirrored.texels.size() * word));
    if (!corrects()) return;
    sky_lights.add_to(table);
    const std::size_t of_picture = picture.stride() * word;
    const auto blocks = [](int pixels) {
        return std::size_t{cache_blocks(static_cast<std::uint32_t>(pixels))};
    };
    table.add(sight, "the sky", "the environment",
              static_cast<std::size_t>(sky.width * sky.height) * word);
    table.add(found_light, "corrections", "width or height", 3 * of_picture);
    table.add(corrections, "corrections", "width or height", 5 * of_picture);
    for (cl::Buffer* light : {&settled, &sharp_sky}) table.add(*light, "light", lower, 3 * plane);
    table.add(settled_sums, "light", lower, 4 * plane);
    table.add(shares, "corrections", "width or height",
              blocks(options.picture.width) * blocks(options.picture.height) * word);
}

void IrradianceCache::State::take_turns(CacheParams& params, int at_once) {
    const std::uint32_t points = params.emitter_count - params.whole_emitters - params.skipped;
    params.emitter_step = std::max(1u, points / static_cast<std::uint32_t>(at_once));
}

CacheParams IrradianceCache::State::params(std::size_t first, std::size_t count) const {
    CacheParams out{};
    out.first = static_cast<std::uint32_t>(first);
    out.count = static_cast<std::uint32_t>(count);
    out.stride = stride;
    out.size = static_cast<std::uint32_t>(drawn);
    out.every = static_cast<std::uint32_t>(drawn / options.face);
    out.row_stride = row_stride;
    out.sky_width = static_cast<std::uint32_t>(sky.width);
    out.sky_height = static_cast<std::uint32_t>(sky.height);
    if (sky.width > 0) {
        const EnvironmentParams turned = environment_params(scene, stride);
        const float exposed = 1.0f / static_cast<float>(scene.frame().exposure);
        for (int c = 0; c < 4; ++c) (&out.sky.x)[c] = (&turned.factor.x)[c] * exposed;
        out.sky_turn = turned.turn;
    }
    out.emission = options.emission ? CACHE_EMISSION_ALL : CACHE_EMISSION_BEYOND;
    out.focus = scene.frame().detail * scene.frame().detail;
    out.picks = picks_per_record;
    out.thin = 1;
    out.pick_stride = static_cast<std::uint32_t>(pick_stride);
    const EmitterSet& set = picture.emitters();
    const auto directions = static_cast<std::uint32_t>(set.directions);
    out.emitter_count = static_cast<std::uint32_t>(set.emitters.size());
    out.bright = sky.parts > 1 ? 1 : 0;
    out.skipped = out.bright ? directions : 0;
    out.whole_emitters = static_cast<std::uint32_t>(set.lamps) + directions - out.skipped;
    out.spots = has_tiles ? 1 : 0;
    out.lobes = scene.has_lobes() ? 1 : 0;
    take_turns(out, IrradianceCacheOptions::most_at_once);
    return out;
}

IrradianceCache::IrradianceCache(const Programs& programs, const cl::CommandQueue& queue,
                                 const DeviceScene& scene, const IrradianceCacheOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, options)) {}

IrradianceCache::~IrradianceCache() = default;

void IrradianceCache::lights_changed() {
    state_->picture.weigh_sky(nullptr);  // until records see the sky anew
    state_->sky_set = 0;
    state_->picture.lights_changed();
    state_->read_sky();
}

cl::Event IrradianceCache::render(const Camera& camera, const WaitList& wait) {
    State& s = *state_;
    const View view = s.picture.begin(camera, wait, !s.aims());
    s.forget_corrections();
    s.choose(view);
    if (s.records.empty()) {
        s.picture.record().fill(s.picture.irradiance(), 0);
    } else {
        s.find_spots(true);
        s.link(0);
        s.light(s.options.bounces);
        s.show();
        s.refine(view);
        s.look_around();
    }
    s.picture.combine(view);
    if (!s.records.empty()) s.add_gloss(view);
    return s.picture.end(view);
}

cl::Event IrradianceCache::render_again(const Camera& camera, const WaitList& wait) {
    State& s = *state_;
    if (s.shown.empty()) throw Error("irradiance-cache: render_again(): there is no picture yet");
    const View view = s.picture.begin(camera, wait);
    if (!s.records.empty()) s.show_by_sky();
    s.picture.combine(view);
    if (!s.records.empty()) s.add_gloss(view);
    return s.picture.end(view);
}

void IrradianceCache::sample(std::uint32_t index) {
    State& s = *state_;
    if (index == 0) s.picture.weigh_sky(nullptr);  // by what this picture's records see, later
    s.picture.sample(index);
    s.sample = index;
}

IrradianceCacheStatus IrradianceCache::status() const {
    IrradianceCacheStatus out = state_->found;
    out.non_finite = state_->picture.non_finite();
    return out;
}

double IrradianceCache::doubt() const { return state_->doubted(); }

const Picture& IrradianceCache::picture() const { return state_->picture; }
const IrradianceCacheOptions& IrradianceCache::options() const { return state_->options; }
std::size_t IrradianceCache::bytes() const { return state_->picture.bytes() + state_->grown; }

}  // namespace clgi
