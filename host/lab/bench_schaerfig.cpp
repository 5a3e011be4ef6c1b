// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/light_atlas.hpp>

#include "lab/baked_atlas.hpp"
#include "lab/bench.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr int atlas_size = 512;  // texels, side
constexpr std::uint32_t vpl_counts[] = {100, 400, 1600, 6400, 25600};

// Seconds on a GeForce GTX 680, five bounces; 0: the paper has none. [Schaerfig16, table 1]
constexpr struct {
    const char* scene;
    double seconds[5];
} schaerfig_table[] = {{"corridor", {0.705, 1.546, 4.539, 16.986, 159.631}},
                       {"cornell", {0.495, 1.218, 4.571, 19.512, 128.697}},
                       {"sponza", {0.0, 0.0, 7.732, 29.159, 228.252}}};

Json paper_seconds(const std::string& scene, std::size_t which) {
    for (const auto& row : schaerfig_table)
        if (scene == row.scene && row.seconds[which] > 0.0) return row.seconds[which];
    return nullptr;
}

// One bake is from the scene's buffers to the filled atlas, the layout on the host included;
// kernels are built before. The ways to fill an atlas that are measured:
struct FillingWay {
    const char* name;
    std::uint32_t most_vpls;
    void (*choose)(LightAtlasOptions&);
};
constexpr FillingWay fillings[] = {
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

BenchTable bench_schaerfig(const BenchSetup& setup) {
    const Programs programs(setup.context(), setup.device());
    PeakMeter meter(setup.queue);
    std::vector<double> peaks;
    Json rows;
    double all = 0.0, done = 0.0;
    for (const auto& [name, scene] : setup.scenes)
        for (const std::uint32_t count : vpl_counts)
            for (const FillingWay& filling : fillings)
                if (count <= std::min(setup.most_vpls, filling.most_vpls))
                    all += work_of(scene, count);
    const auto bake = [&](const Scene& scene, const DeviceScene& on_device, int size,
                          std::uint32_t count, const FillingWay& filling, double share) {
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

    for (const auto& [name, scene] : setup.scenes) {
        const DeviceScene on_device(setup.context(), setup.device(), scene);
        const int size = fitting_size(scene, atlas_size);
        for (const FillingWay& filling : fillings) {
            bake(scene, on_device, size, vpl_counts[0], filling, 0.0);  // builds kernels
            for (std::size_t i = 0; i < std::size(vpl_counts); ++i) {
                if (vpl_counts[i] > std::min(setup.most_vpls, filling.most_vpls)) continue;
                std::vector<TimedBake> bakes;
                std::vector<double> seconds, layouts;
                do {  // short ones are repeated: other load on the machine shows in them most
                    bakes.push_back(bake(scene, on_device, size, vpl_counts[i], filling,
                                         bakes.empty() ? work_of(scene, vpl_counts[i]) : 0.0));
                    seconds.push_back(bakes.back().seconds);
                    layouts.push_back(bakes.back().layout_seconds);
                } while (bakes.size() < 3 && bakes.back().seconds < 3.0);
                done += work_of(scene, vpl_counts[i]);
                peaks.push_back(meter.gflops());
                const Json of_paper = paper_seconds(name, i);
                const double ours = spread(seconds).median;
                rows.push_back(
                    {{"name", fmt::format("{}, {} VPLs", name, vpl_counts[i])},
                     {"paper", of_paper},
                     {"clgi", ours},
                     {"ratio", of_paper.is_null() ? Json() : Json(of_paper.get<double>() / ours)},
                     {"error", nullptr},
                     {"unit", "s"},
                     {"filling", filling.name},
                     {"vpls", vpl_counts[i]},
                     {"texels", bakes.back().irradiance.size()},
                     {"layout", spread(layouts).median}});
            }
        }
    }
    return {{{"peak_gflops", spread(peaks).median}, {"rows", rows}},
            {{"row", 24, "{name}"},
             {"filling", 10, "{filling}"},
             {"paper s", 10, "{paper:.3f}"},
             {"clgi s", 10, "{clgi:.3f}"},
             {"ratio", 9, "{ratio:.2f}"},
             {"of it host", 12, "{layout:.3f}"}},
            "512x512 texels, five bounces, peak {peak_gflops:.0f} GFLOP/s\n"};
}

}  // namespace clgi::lab
