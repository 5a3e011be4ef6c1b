// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <numeric>

#include "core/opencl/program.hpp"
#include "methods/light_atlas/row_unit.hpp"
#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr std::uint32_t one_bits = 0x3f800000;  // 1.0f

LightAtlasOptions checked(LightAtlasOptions options, const DeviceScene& scene) {
    check(options);
    options.build.textures = options.build.textures && scene.needs_textures();
    if (options.emitters.shadow_size == 0)
        options.emitters.shadow_size = usual_shadow_size(scene, options.emitters);
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
                               const AtlasLayout& atlas_layout, const LightAtlasOptions& wanted,
                               const std::vector<BakePoint>& beside)
    : queue(on),
      scene(of),
      options(checked(wanted, of)),
      gbuffer(programs, options.build),
      lights(programs, options.build),
      vpl(programs, options.build),
      atlas(programs, options.build),
      parallel(programs, options.build),
      emitters(scene, options.emitters, Pixels::depth),
      record(queue, "light-atlas"),
      bake_points(beside) {
    const cl::Device device = queue.getInfo<CL_QUEUE_DEVICE>();
    const std::size_t memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    const std::size_t room = memory - std::min(memory, scene.bytes());
    const std::size_t budget = options.memory_budget > 0 ? options.memory_budget : room / 2;
    if (vpl_layout.vpls.empty()) throw Error("light-atlas: there is no VPL");
    if (atlas_layout.texels.empty()) throw Error("light-atlas: there is no texel");
    check_points(bake_points, options);
    AtlasBlocks made;
    if (occludes(options.occlusion) && options.filling == Filling::gather && options.refine > 1)
        made = make_blocks(atlas_layout, options.refine);
    const BufferTable all = table(b, emitters, scene, vpl_layout, atlas_layout, bake_points.size(),
                                  made, options, in_groups(device, options.build), budget,
                                  device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>());
    all.check(device, options.memory_budget, scene.bytes());
    all.allocate(record);
    bytes = all.bytes();
    b.samples.planes = b.sites.samples;
    b.listed.planes = b.blocks.planes;
    lift = 2e-5f * scene.frame().detail;
    build();
    emitters.write(record);
    upload(vpl_layout, atlas_layout, made);
}

// The kernels that these options need.
void LightAtlasSolver::State::build() {
    gbuffer.build({"surface"});
    lights.build({"direct"});
    emitters.build(gbuffer);
    vpl.build({"place", "points", "receive", "balance_receivers", "balance_shooters", "emit",
               "shoot", "send"});
    atlas.build({"complete"});
    if (!occludes(options.occlusion)) {
        vpl.build({"transport_open", "reach_open"});
        atlas.build({"gather_open"});
        return;
    }
    gbuffer.build({"cubes"});
    gbuffer.build({"raster_views"}, Pixels::depth);
    vpl.build({"transport", "reach"});
    atlas.build({"nearest"});
    if (options.filling == Filling::project) {
        atlas.build({"geometry", "replicate", "project"});
        gbuffer.build({"raster_views"}, Pixels::visibility);
    } else {
        atlas.build({"gather"});
        if (b.block_count > 0) atlas.build({"flat", "see_listed", "see_blocks"});
        if (b.block_count == 0 || !bake_points.empty()) atlas.build({"see"});
    }
}

void LightAtlasSolver::State::upload(const VplLayout& layout, const AtlasLayout& texels,
                                     const AtlasBlocks& made) {
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
        // To all others it is as large as what it covers of what lies behind.
        sites.push_back({site.first_sample, site.sample_count, area * site.coverage,
                         site.back ? static_cast<std::uint32_t>(SITE_BACK) : 0});
        row_scale += sites.back().area;
    }
    for (Site& site : sites)
        site.flags |= row_exponent(double{site.area}, double{row_scale}) << SITE_ROW_SHIFT;
    record.write(b.sample_list, list.data(), list.size() * sizeof(SurfaceSample));
    record.write(b.sites.sites, sites.data(), sites.size() * sizeof(Site));
    record.write(b.sites.chosen, order.data(), order.size() * sizeof(std::uint32_t));
    list.clear();
    for (const AtlasTexel& texel : texels.texels)
        list.push_back({device_triangle(device, texel.triangle), texel.b1, texel.b2, 0.0f});
    record.write(b.texel_list, list.data(), list.size() * sizeof(SurfaceSample));
    if (b.block_count > 0) upload_blocks(made, list);
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
    record("vpl.points", b.sites.point_stride,
           [&](const WaitList& wait) { return vpl.points(queue, b.sites, wait); });
    record("gbuffer.surface", b.texel_count, [&](const WaitList& wait) {
        return gbuffer.surface(queue, scene, {b.texel_count, b.texels.stride, 0, 0}, b.texel_list,
                               b.texels, {}, wait);
    });
    if (!bake_points.empty()) place_points();
    if (b.block_count > 0) place_blocks();
    placed = !record.cancelled();
}

// least: below 0, all light is sent anew; else only VPLs whose power changed by more send the
// change.
bool LightAtlasSolver::State::run(const Progress& progress, double least) {
    record.begin({}, progress);
    record.fill(b.non_finite, 0);
    differences = least >= 0.0;
    ended = false;
    filled_vpls = 0;
    shots = 0;
    record.report(0.0);
    if (!placed) place();
    const bool exchanged = restored && restored->filled_vpls > 0;
    if (restored && !exchanged) put_back_measurement();
    // Factors begin with 1, also after a bake that was cancelled half-way.
    if (measured_vpls == 0) record.fill(b.sites.balance, one_bits);
    // Bounces of all VPLs make what is not kept anyway.
    const bool all_shoot = options.bounces == 0 ? !options.one_at_a_time : options.bounces > 1;
    if (!exchanged && !measured && (b.kept || !all_shoot)) measure();
    receive_direct();
    record.report(b.seen_kept ? 0.81 : 0.36);
    direct.resize(3 * std::size_t{b.sites.stride});
    record.wait();
    queue.enqueueReadBuffer(b.sites.light, CL_TRUE, 0, direct.size() * sizeof(float),
                            direct.data());
    power_direct = unshot_power();
    threshold = static_cast<float>(options.threshold * power_direct / b.sites.site_count);
    if (differences)
        note_brightest();
    else
        clear_texels();
    if (exchanged)
        put_back_light();
    else
        exchange();
    if (!record.cancelled()) {
        send(static_cast<float>(differences ? least * power_direct / b.sites.site_count : -1.0));
        fill();
    }
    if (differences && !record.cancelled() && residue_shows()) send_anew();
    ended = !record.cancelled();  // what is asked for from here on comes too late
    record.report(1.0);
    record.wait();
    return ended;
}

}  // namespace clgi
