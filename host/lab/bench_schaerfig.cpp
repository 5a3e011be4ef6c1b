// SPDX-License-Identifier: MIT
#include "lab/bench_schaerfig.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/light_atlas.hpp>

#include "lab/peak.hpp"
#include "lab/timed_bake.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr std::uint32_t counts[] = {100, 400, 1600, 6400, 25600};

// Seconds on a GeForce GTX 680, five bounces; 0: the paper has none. [Schaerfig16, table 1]
constexpr struct {
    const char* scene;
    double seconds[5];
} paper[] = {{"corridor", {0.705, 1.546, 4.539, 16.986, 159.631}},
             {"cornell", {0.495, 1.218, 4.571, 19.512, 128.697}},
             {"sponza", {0.0, 0.0, 7.732, 29.159, 228.252}}};

std::optional<double> paper_seconds(const std::string& scene, std::size_t which) {
    for (const auto& row : paper)
        if (scene == row.scene && row.seconds[which] > 0.0) return row.seconds[which];
    return {};
}

// The ways to fill an atlas that are measured.
struct Filling {
    const char* name;
    std::uint32_t most_vpls;
    void (*choose)(LightAtlasOptions&);
};
constexpr Filling fillings[] = {
    {"gather", 25600, [](LightAtlasOptions&) {}},
    {"project", 1600, [](LightAtlasOptions& o) { o.filling = clgi::Filling::project; }}};

// About so many units of work, for progress alone: filling a texel by a VPL, drawing a triangle.
double work_of(const Scene& scene, double vpls) {
    return vpls * (2e5 + 50.0 * static_cast<double>(scene.triangles.size())) + 100.0 * vpls * vpls;
}

// The size wanted, doubled until the scene's charts fit.
int fitting_size(const Scene& scene, int size) {
    const Patches patches = make_patches(scene);
    for (;; size *= 2) {
        AtlasOptions options;
        options.size = size;
        try {
            make_atlas(scene, patches.triangle_patch, options);
            return size;
        } catch (const InputError&) {
            if (size > 4096) throw;
        }
    }
}

}  // namespace

SchaerfigTable bench_schaerfig1(const SchaerfigSetup& setup,
                                const std::vector<std::pair<std::string, Scene>>& scenes) {
    const cl::Context context = setup.queue.getInfo<CL_QUEUE_CONTEXT>();
    const cl::Device device = setup.queue.getInfo<CL_QUEUE_DEVICE>();
    const Programs programs(context, device);
    PeakMeter meter(setup.queue);
    std::vector<double> peaks;
    SchaerfigTable out;
    out.device = describe(device);

    double all = 0.0, done = 0.0;
    for (const auto& [name, scene] : scenes)
        for (const std::uint32_t count : counts)
            for (const Filling& filling : fillings)
                if (count <= std::min(setup.most_vpls, filling.most_vpls))
                    all += work_of(scene, count);
    const auto bake = [&](const Scene& scene, const DeviceScene& on_device, int size,
                          std::uint32_t count, const Filling& filling, double share) {
        BakeJob job{programs, setup.queue, scene, on_device, {}, {}, {}};
        job.vpls.count = count;
        job.atlas.size = size;
        job.options.build = setup.build;
        job.options.bounces = 5;
        filling.choose(job.options);
        const std::optional<TimedBake> made = timed_bake(job, [&](double part) {
            return !setup.progress || setup.progress((done + part * share) / all);
        });
        if (!made) throw Error("bench: cancelled");
        return *made;
    };

    for (const auto& [name, scene] : scenes) {
        const DeviceScene on_device(context, device, scene);
        const int size = fitting_size(scene, setup.atlas_size);
        for (const Filling& filling : fillings) {
            bake(scene, on_device, size, counts[0], filling, 0.0);  // builds kernels
            for (std::size_t i = 0; i < std::size(counts); ++i) {
                if (counts[i] > std::min(setup.most_vpls, filling.most_vpls)) continue;
                std::vector<TimedBake> bakes;
                std::vector<double> seconds, layouts;
                do {  // short ones are repeated: other load on the machine shows in them most
                    bakes.push_back(bake(scene, on_device, size, counts[i], filling,
                                         bakes.empty() ? work_of(scene, counts[i]) : 0.0));
                    seconds.push_back(bakes.back().seconds);
                    layouts.push_back(bakes.back().layout_seconds);
                } while (bakes.size() < 3 && bakes.back().seconds < 3.0);
                done += work_of(scene, counts[i]);
                peaks.push_back(meter.gflops());
                SchaerfigRow row;
                row.name = name + ", " + std::to_string(counts[i]) + " VPLs";
                row.filling = filling.name;
                row.paper = paper_seconds(name, i);
                row.clgi = spread(seconds).median;
                if (row.paper) row.ratio = *row.paper / row.clgi;
                row.layout = spread(layouts).median;
                row.vpls = counts[i];
                row.texels = bakes.back().irradiance.size();
                out.rows.push_back(row);
            }
        }
    }
    out.peak_gflops = spread(peaks).median;
    return out;
}

}  // namespace clgi::lab
