// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/planes.hpp>
#include <cstring>
#include <numeric>

#include "solvers/light_atlas_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr int balance_steps = 6;       // half-steps of both kinds; the factors differ by 1e-3 then
constexpr std::uint32_t chunk = 32;    // shots between two looks at what is left
constexpr std::uint32_t most_bounces = 10000;
constexpr std::uint32_t one_bits = 0x3f800000;  // 1.0f

LightAtlasOptions checked(LightAtlasOptions options, const DeviceScene& scene) {
    check(options);
    options.build.textures = options.build.textures && scene.needs_textures();
    options.build.storage = Storage::full;  // sums of thousands of VPLs
    return options;
}

// The device's number of each of the scene's triangles.
std::vector<std::uint32_t> inverse(const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> out(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) out[order[i]] = i;
    return out;
}

// The k-th of `count` neighbours in an order whose beginnings are spread over all of them: steps of
// the golden section, or of the next number that has no divisor in common with the count.
std::uint32_t spread_out(std::uint32_t k, std::uint32_t count) {
    auto step = std::max(static_cast<std::uint32_t>(0.618034 * count), 1u);
    while (std::gcd(step, count) != 1) ++step;
    return static_cast<std::uint32_t>(std::uint64_t{k} * step % count);
}

std::uint32_t device_triangle(const std::vector<std::uint32_t>& of, std::uint32_t triangle) {
    if (triangle >= of.size())
        throw Error("light-atlas: a layout names triangle " + std::to_string(triangle) +
                    ", the scene has " + std::to_string(of.size()));
    return of[triangle];
}

}  // namespace

LightAtlasSolver::State::State(const Programs& programs, const cl::CommandQueue& on,
                               const DeviceScene& of, const VplLayout& vpl_layout,
                               const AtlasLayout& atlas_layout, const LightAtlasOptions& wanted)
    : queue(on),
      scene(of),
      options(checked(wanted, of)),
      gbuffer(programs, options.build),
      lights(programs, options.build),
      vpl(programs, options.build),
      atlas(programs, options.build),
      parallel(programs, options.build),
      emitters(scene, options.emitters, Pixels::depth),
      record(queue, "light-atlas") {
    const cl::Device device = queue.getInfo<CL_QUEUE_DEVICE>();
    const std::size_t memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    const std::size_t room = memory - std::min(memory, scene.bytes());
    const std::size_t budget = options.memory_budget > 0 ? options.memory_budget : room / 2;
    if (vpl_layout.vpls.empty()) throw Error("light-atlas: there is no VPL");
    if (atlas_layout.texels.empty()) throw Error("light-atlas: there is no texel");
    const BufferTable all =
        table(b, emitters, scene, vpl_layout.samples.size(), vpl_layout.vpls.size(),
              atlas_layout, options, budget,
              device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>());
    all.check(device, options.memory_budget, scene.bytes());
    all.allocate(record);
    bytes = all.bytes();
    b.samples.planes = b.sites.samples;
    lift = 2e-5f * scene.frame().radius;
    gbuffer.build({"surface", "cubes", "raster_views"});
    gbuffer.build({"raster_views"}, Pixels::depth);
    lights.build({"direct"});
    vpl.build({"place", "receive", "transport", "reach", "balance_receivers", "balance_shooters",
               "emit", "shoot", "weigh"});
    atlas.build({"nearest", "complete"});
    if (options.filling == Filling::project)
        atlas.build({"geometry", "replicate", "project"});
    else
        atlas.build({"gather"});
    emitters.write(record);
    upload(vpl_layout, atlas_layout);
}

void LightAtlasSolver::State::upload(const VplLayout& layout, const AtlasLayout& texels) {
    const auto device = inverse(scene.triangle_order());
    const double scale = scene.frame().scale;
    std::vector<SurfaceSample> list;
    const float spacing = static_cast<float>(layout.sample_area * scale * scale);
    for (const VplSite& site : layout.vpls)
        for (std::uint32_t k = 0; k < site.sample_count; ++k) {
            const SamplePoint& point =
                layout.samples[site.first_sample + spread_out(k, site.sample_count)];
            list.push_back({device_triangle(device, point.triangle), point.b1, point.b2, spacing});
        }
    std::vector<std::uint32_t> order(layout.vpls.size());
    std::iota(order.begin(), order.end(), 0u);
    row_scale = 0.0f;
    sites.clear();
    for (const VplSite& site : layout.vpls) {
        const auto area = static_cast<float>(site.area * scale * scale);
        list.push_back({device_triangle(device, site.triangle), site.b1, site.b2, area});
        sites.push_back({site.first_sample, site.sample_count, area,
                         site.back ? static_cast<std::uint32_t>(SITE_BACK) : 0});
        row_scale += area;
    }
    record.write(b.sample_list, list.data(), list.size() * sizeof(SurfaceSample));
    record.write(b.sites.sites, sites.data(), sites.size() * sizeof(Site));
    record.write(b.sites.chosen, order.data(), order.size() * sizeof(std::uint32_t));
    list.clear();
    for (const AtlasTexel& texel : texels.texels)
        list.push_back({device_triangle(device, texel.triangle), texel.b1, texel.b2, 0.0f});
    record.write(b.texel_list, list.data(), list.size() * sizeof(SurfaceSample));
    if (options.filling == Filling::project) upload_charts(texels, device);
}

// Where samples, VPLs and texels are, and what they reflect. [section 3.1]
void LightAtlasSolver::State::place() {
    const std::uint32_t samples = b.sites.sample_count + b.sites.site_count;
    record("gbuffer.surface", samples, [&](const WaitList& wait) {
        return gbuffer.surface(queue, scene, {samples, b.samples.stride, 0, 0}, b.sample_list,
                               b.samples, {}, wait);
    });
    record("vpl.place", b.sites.site_count, [&](const WaitList& wait) {
        return vpl.place(queue, scene, b.sites, b.samples.ids, wait);
    });
    record("gbuffer.surface", b.texel_count, [&](const WaitList& wait) {
        return gbuffer.surface(queue, scene, {b.texel_count, b.texels.stride, 0, 0}, b.texel_list,
                               b.texels, {}, wait);
    });
    placed = !record.cancelled();
}

void LightAtlasSolver::State::light_points(const GBuffer& points, std::uint32_t count,
                                           const cl::Buffer& irradiance, bool add) {
    const auto number = static_cast<std::uint32_t>(emitters.set().emitters.size());
    const DirectParams params{points.stride, count, number, 1.0f, 1, add ? 1u : 0u, 0, 0};
    record("lights.direct", count, [&](const WaitList& wait) {
        return lights.direct(queue, params, emitters.buffers(), points.planes, irradiance,
                             b.non_finite, wait);
    });
}

// Shadow-mapped direct light of every kind at the VPLs. [section 3.2]
void LightAtlasSolver::State::receive_direct() {
    emitters.draw(record, gbuffer, b.lists);
    light_points(b.samples, b.sites.sample_count, b.sample_irradiance, false);
    record("vpl.receive", b.sites.site_count, [&](const WaitList& wait) {
        return vpl.receive(queue, b.sites, b.sample_irradiance, wait);
    });
}

// The scene as a batch of VPLs sees it.
void LightAtlasSolver::State::hemicubes(std::uint32_t first, std::uint32_t count, int size,
                                        Pixels kind) {
    const auto side = static_cast<std::uint32_t>(size);
    const CubeParams params{count, 5, side, 0, 0, b.sites.stride, lift, 0.5f * lift, first, 0, 0, 0};
    record("gbuffer.cubes", count, [&](const WaitList& wait) {
        return gbuffer.cubes(queue, params, b.sites.planes, b.sites.chosen, b.views, wait);
    });
    const ViewSpan span{0, 5 * count, side, side, std::size_t{3} * count * side * side};
    record("gbuffer.raster_views", span.count, [&](const WaitList& wait) {
        return gbuffer.raster_views(queue, span, b.views, scene, b.pixels, kind, wait);
    });
}

// Rows of the transport of a batch, drawn with triangles, because where the fronts of surfaces are
// is found out beside it.
void LightAtlasSolver::State::transport(std::uint32_t first, std::uint32_t count) {
    hemicubes(first, count, options.exchange_size, Pixels::visibility);
    const TransportParams params{first, count, b.kept ? 1u : 0u, b.sites.site_count,
                                 b.sites.stride, b.sites.sample_stride,
                                 static_cast<std::uint32_t>(options.exchange_size), row_scale, 2,
                                 options.exchange_samples, 0, 0};
    record("vpl.transport", std::size_t{count} * b.sites.sample_count, [&](const WaitList& wait) {
        return vpl.transport(queue, params, b.sites, b.views, b.pixels, b.rows, wait);
    });
    record("vpl.reach", count, [&](const WaitList& wait) {
        return vpl.reach(queue, params, scene, b.sites, b.views, b.pixels, wait);
    });
}

ShootParams LightAtlasSolver::State::shoot_params(std::uint32_t first, std::uint32_t count) const {
    return {first,          count, b.kept ? 1u : 0u, b.sites.site_count, b.sites.stride,
            1.0f / row_scale, SHOOT_ALL, threshold};
}

// Transport of all VPLs, or, where it is not kept, what they reach and their factors alone.
void LightAtlasSolver::State::measure_transport() {
    const std::uint32_t n = b.sites.site_count;
    for (std::uint32_t first = 0; first < n && !record.cancelled(); first += b.exchange_batch) {
        transport(first, std::min(b.exchange_batch, n - first));
        if (!b.kept) balance_shooters(first, std::min(b.exchange_batch, n - first));
        if (first % (16 * b.exchange_batch) == 0) record.report(0.05 + 0.3 * first / n);
    }
    if (b.kept) balance();
    measured = !record.cancelled();
}

void LightAtlasSolver::State::balance() {
    const std::uint32_t n = b.sites.site_count;
    for (int step = 0; step < balance_steps; ++step) {
        record("vpl.balance_receivers", n, [&](const WaitList& wait) {
            return vpl.balance_receivers(queue, shoot_params(0, n), b.sites, b.rows, wait);
        });
        balance_shooters(0, n);
    }
}

void LightAtlasSolver::State::balance_shooters(std::uint32_t first, std::uint32_t count) {
    record("vpl.balance_shooters", count, [&](const WaitList& wait) {
        return vpl.balance_shooters(queue, shoot_params(first, count), b.sites, b.rows, wait);
    });
}

// Light of a batch of shooters arrives. Rows that are not kept are made, and balanced by their
// shooter alone: what it sends and loses is exact, what arrives where is not.
void LightAtlasSolver::State::shoot(std::uint32_t first, std::uint32_t count) {
    const ShootParams params = shoot_params(first, count);
    if (!b.kept) {
        transport(first, count);
        balance_shooters(first, count);
    }
    record("vpl.shoot", std::size_t{count} * b.sites.site_count, [&](const WaitList& wait) {
        return vpl.shoot(queue, params, b.sites, b.rows, b.non_finite, wait);
    });
    shots += count;
}

// All VPLs shoot what they have.
void LightAtlasSolver::State::bounce() {
    const std::uint32_t n = b.sites.site_count;
    record("vpl.emit", n, [&](const WaitList& wait) {
        return vpl.emit(queue, shoot_params(0, n), b.sites, b.strongest, wait);
    });
    const std::uint32_t batch = b.kept ? n : b.exchange_batch;
    for (std::uint32_t first = 0; first < n && !record.cancelled(); first += batch) {
        shoot(first, std::min(batch, n - first));
        if (!b.kept) record.report(0.35);
    }
}

float LightAtlasSolver::State::strongest_power() {
    record("parallel.arg_max", b.sites.site_count, [&](const WaitList& wait) {
        return parallel.arg_max(queue, b.sites.site_count, b.sites.power, b.strongest,
                                b.arg_max_scratch, wait);
    });
    const std::uint32_t bits = record.read_word(b.strongest);
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

void LightAtlasSolver::State::bounce_to_threshold() {
    for (std::uint32_t k = 0; k < most_bounces && !record.cancelled(); ++k) {
        bounce();
        record.report(0.4);
        if (!(strongest_power() > threshold)) return;
    }
}

// The strongest VPL shoots, again and again; the device chooses it. [section 3.3]
void LightAtlasSolver::State::shoot_strongest() {
    const std::uint32_t n = b.sites.site_count;
    ShootParams params = shoot_params(n, 1);
    params.mode = SHOOT_STRONGEST;
    // Powers are known after the first shot, which is of nobody then.
    record.fill(b.sites.power, 0);
    for (std::uint32_t k = 0; k < most_bounces * 8 && !record.cancelled(); ++k) {
        for (std::uint32_t i = 0; i < chunk; ++i) {
            record("parallel.arg_max", n, [&](const WaitList& wait) {
                return parallel.arg_max(queue, n, b.sites.power, b.strongest, b.arg_max_scratch,
                                        wait);
            });
            record("vpl.emit", 1, [&](const WaitList& wait) {
                return vpl.emit(queue, params, b.sites, b.strongest, wait);
            });
            shoot(n, 1);
        }
        record.report(0.4);
        if (!(strongest_power() > threshold)) return;
    }
}

FillParams LightAtlasSolver::State::fill_params(std::uint32_t first, std::uint32_t count) const {
    return {first, count, b.sites.stride, b.sites.sample_stride, b.texel_count, b.texel_stride, 0,
            1};
}

void LightAtlasSolver::State::gather(std::uint32_t first, std::uint32_t count) {
    record("atlas.gather", std::size_t{count} * b.texel_count, [&](const WaitList& wait) {
        return atlas.gather(queue, fill_params(first, count), b.sites, b.views, b.pixels,
                            b.texels.planes, b.irradiance, b.filled, wait);
    });
}

// What the VPLs received, sent on to the texels. [section 4]
void LightAtlasSolver::State::fill() {
    const std::uint32_t n = b.sites.site_count;
    const FillParams all = fill_params(0, n);
    record("atlas.nearest", b.texel_count, [&](const WaitList& wait) {
        return atlas.nearest(queue, all, b.sites, b.texels.planes, b.reach, wait);
    });
    record("vpl.weigh", n, [&](const WaitList& wait) {
        return vpl.weigh(queue, b.sites, b.sample_irradiance, wait);
    });
    while (filled_vpls < n && !record.cancelled()) {
        const std::uint32_t first = filled_vpls;
        const std::uint32_t count = std::min(b.filling_batch, n - first);
        hemicubes(first, count, options.filling_size, filling_pixels(options));
        if (options.filling == Filling::project)
            project(first, count);
        else
            gather(first, count);
        filled_vpls += count;
        if (first % 64 == 0) record.report(0.45 + 0.54 * filled_vpls / n);
    }
    record("atlas.complete", b.texel_count, [&](const WaitList& wait) {
        return atlas.complete(queue, all, b.reach, b.filled, b.irradiance, b.non_finite, wait);
    });
    if (options.direct) light_points(b.texels, b.texel_count, b.irradiance, true);
}

// Light goes from VPL to VPL. [section 3.3]
void LightAtlasSolver::State::exchange() {
    if (options.bounces > 0)
        for (std::uint32_t k = 1; k < options.bounces && !record.cancelled(); ++k) bounce();
    else if (options.one_at_a_time)
        shoot_strongest();
    else
        bounce_to_threshold();
}

bool LightAtlasSolver::State::run(const Progress& progress) {
    record.begin({}, progress);
    record.fill(b.non_finite, 0);
    ended = false;
    filled_vpls = 0;
    shots = 0;
    record.report(0.0);
    if (!placed) place();
    receive_direct();
    // Factors begin with 1, also after a bake that was cancelled half-way or went on from a state.
    if (!measured) record.fill(b.sites.balance, one_bits);
    // Bounces of all VPLs make what is not kept anyway.
    const bool all_shoot = options.bounces == 0 ? !options.one_at_a_time : options.bounces > 1;
    if (!restored && !measured && (b.kept || !all_shoot)) measure_transport();
    direct.resize(3 * std::size_t{b.sites.stride});
    record.wait();
    queue.enqueueReadBuffer(b.sites.light, CL_TRUE, 0, direct.size() * sizeof(float),
                            direct.data());
    power_direct = unshot_power();
    threshold = static_cast<float>(options.threshold * power_direct);
    record.fill(b.irradiance, 0);
    record.fill(b.filled, 0);
    if (restored)
        put_back();
    else
        exchange();
    if (!record.cancelled()) fill();
    ended = !record.cancelled();  // what is asked for from here on comes too late
    record.report(1.0);
    record.wait();
    return ended;
}

}  // namespace clgi
