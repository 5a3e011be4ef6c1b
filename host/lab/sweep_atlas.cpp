// SPDX-License-Identifier: MIT
#include "lab/sweep_atlas.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <iterator>

#include "lab/baked_atlas.hpp"
#include "lab/reference_picture.hpp"
#include "lab/sweep_run.hpp"

namespace clgi::lab {
namespace {

constexpr const char* baked_effects = "indirect";

// ---- the sweep ----------------------------------------------------------------------------------

class AtlasRun {
public:
    AtlasRun(const SweepSetup& setup, const AtlasSweep& atlas)
        : setup_(setup),
          atlas_(atlas),
          progress_(setup.progress),
          layout_(make_atlas(setup.scene, make_patches(setup.scene).triangle_patch, atlas.layout)),
          places_(atlas_places(setup.scene, layout_)) {}

    Sweep operator()() {
        out_ = sweep_of(SweepOf::atlas, setup_);
        out_.width = layout_.size;
        out_.height = layout_.size * layout_.pages;
        out_.methods = {atlas_gather, atlas_project};
        out_.knobs = {"vpls",
                      "bounces",
                      "samples-per-vpl",
                      "exchange-samples",
                      "filling",
                      "hemicube-size",
                      "mesh",
                      "kernel",
                      "spp"};
        const reference::PathTracer tracer(setup_.scene);
        progress_.part(0.0, 0.3);
        find_truth(tracer);
        progress_.part(0.3, 0.2);
        if (setup_.path_tracer)
            trace_irradiance(
                out_, setup_, out_.truths.front(), tracer, places_.places,
                [&](const auto& found) { return atlas_image(places_, found, baked_effects); },
                counted_, progress_);
        progress_.part(0.5, 0.5);
        if (setup_.solver) bake();
        mark_fronts(out_);
        return std::move(out_);
    }

private:
    io::Image given_reference() const {
        const std::string name = atlas_.reference.string();
        io::Image found = io::load_image(atlas_.reference);
        if (found.width != out_.width || found.height != out_.height)
            throw InputError(fmt::format("{}: has {}x{} texels, the atlas of the scene {}x{}", name,
                                         found.width, found.height, out_.width, out_.height));
        if (!found.find("A"))
            throw InputError(name + ": has no channel A, which says where texels are");
        return found;
    }

    // Counted are texels that both the truth and the bakes have.
    void find_truth(const reference::PathTracer& tracer) {
        add_truth(
            out_, "full", baked_effects,
            !atlas_.reference.empty()
                ? given_reference()
                : cached_atlas(tracer, places_, tracing(baked_effects, setup_.reference_samples),
                               baked_effects, setup_.folder / "reference-atlas.exr",
                               scene_key(setup_.scene),
                               [&](double done) { return progress_.goes_on(done); }));
        const auto& alpha = out_.truths.front().picture.find("A")->values;
        counted_ = {out_.width, out_.height, std::vector<std::uint8_t>(alpha.size(), 0), 0};
        for (const std::uint32_t texel : places_.texels) {
            counted_.counts[texel] = alpha[texel] > 0.0f ? 1 : 0;
            counted_.pixels += counted_.counts[texel];
        }
        if (10 * counted_.pixels < 9 * places_.texels.size())
            throw InputError(fmt::format(
                "{}: has {} of the {} texels that the atlas of the scene has, at least nine in ten "
                "needed",
                atlas_.reference.string(), counted_.pixels, places_.texels.size()));
    }

    // What one bake costs, about: lookups of texels, drawing, and soft shadows of projections.
    double work_of(const AtlasSettings& one) const {
        const double texels = static_cast<double>(layout_.texels.size());
        const double kernel = one.bake.filling == Filling::project ? 10.0 + one.bake.kernel : 1.0;
        return one.vpls.count *
               (2e5 + texels * kernel + 50.0 * static_cast<double>(setup_.scene.triangles.size()));
    }

    void bake() {
        const cl::Context context = setup_.queue.getInfo<CL_QUEUE_CONTEXT>();
        const cl::Device device = setup_.queue.getInfo<CL_QUEUE_DEVICE>();
        const DeviceScene scene(context, device, setup_.scene);
        const Programs programs(context, device);
        const std::vector<AtlasSettings> settings = atlas_settings(setup_.quick, setup_.build);
        const auto bake_one = [&](const AtlasSettings& one, const Progress& part) {
            const std::optional<TimedBake> made = timed_bake(
                {programs, setup_.queue, setup_.scene, scene, one.vpls, atlas_.layout, one.bake},
                part);
            if (!made) throw_cancelled();
            return *made;
        };
        for (const Filling filling : {Filling::gather, Filling::project}) {  // builds kernels
            AtlasSettings least;
            least.vpls.count = 16;
            least.bake.build = setup_.build;
            least.bake.filling = filling;
            bake_one(least, [&](double) { return progress_.goes_on(0.0); });
        }
        constexpr double slow = 3.0;  // seconds: noise is small beside these, one bake is enough
        Turns turns;
        turns.rounds = setup_.rounds;
        turns.work = [&](std::size_t i) { return work_of(settings[i]); };
        turns.measure = [&](std::size_t i, SweepPoint* result, const Progress& part) {
            const TimedBake made = bake_one(settings[i], part);
            if (result) {
                result->picture = baked_image(layout_, made.irradiance, baked_effects, false);
                judge(*result, out_.truths, &counted_);
            }
            return Measured{{1e3 * made.seconds}, {}, made.status.non_finite, made.seconds <= slow};
        };
        add_points(out_, settings, turns, progress_);
    }

    const SweepSetup& setup_;
    const AtlasSweep& atlas_;
    SweepProgress progress_;
    AtlasLayout layout_;
    AtlasPlaces places_;
    Mask counted_;
    Sweep out_;
};

// ---- settings -----------------------------------------------------------------------------------

void name_setting(AtlasSettings& one) {
    const LightAtlasOptions& bake = one.bake;
    const bool project = bake.filling == Filling::project;
    one.method = project ? atlas_project : atlas_gather;
    one.knobs = {{"vpls", std::to_string(one.vpls.count)},
                 {"bounces", bake.bounces == 0 ? "all" : std::to_string(bake.bounces)},
                 {"samples-per-vpl", std::to_string(one.vpls.samples_per_vpl)},
                 {"exchange-samples", std::to_string(bake.exchange_samples)},
                 {"filling", project ? "project" : "gather"},
                 {"hemicube-size", std::to_string(bake.hemicube_size)}};
    if (project) {
        one.knobs["mesh"] = std::to_string(bake.mesh);
        one.knobs["kernel"] = std::to_string(bake.kernel);
    }
}

}  // namespace

std::vector<AtlasSettings> atlas_settings(bool quick, const BuildOptions& build) {
    const auto vpls = [](AtlasSettings& to, int n) { to.vpls.count = n; };
    const auto samples = [](AtlasSettings& to, int n) { to.vpls.samples_per_vpl = n; };
    const auto bounces = [](AtlasSettings& to, int n) { to.bake.bounces = n; };
    const auto exchange = [](AtlasSettings& to, int n) { to.bake.exchange_samples = n; };
    const auto size = [](AtlasSettings& to, int n) { to.bake.hemicube_size = n; };
    const auto mesh = [](AtlasSettings& to, int n) { to.bake.mesh = n; };
    const auto kernel = [](AtlasSettings& to, int n) { to.bake.kernel = n; };
    AtlasSettings gather;
    gather.bake.bounces = 0;  // all, so that what is missing is the error of the other knobs
    gather.bake.build = build;
    vpls(gather, quick ? 400 : 1600);
    AtlasSettings project = gather;
    project.bake.filling = Filling::project;
    vpls(project, quick ? 100 : 400);  // it takes many times as long
    SettingList<AtlasSettings> list(quick, name_setting);
    list.vary("vpls", gather, {50, 400}, {100, 400, 1600, 6400}, vpls);
    list.vary("bounces", gather, {1, 2, 0}, {1, 2, 3, 5, 10, 0}, bounces);
    list.vary("samples-per-vpl", gather, {10, 48}, {6, 12, 24, 48, 96}, samples);
    list.vary("exchange-samples", gather, {2, 16}, {1, 2, 4, 8, 16, 48}, exchange);
    list.vary("hemicube-size", gather, {64, 256}, {32, 64, 128, 256, 512}, size);
    list.vary("vpls, project", project, {50, 100}, {100, 400, 1600}, vpls);
    list.vary("hemicube-size, project", project, {64, 256}, {64, 128, 256, 512}, size);
    list.vary("mesh", project, {128, 512}, {32, 128, 512, 2048, 8192, 32768}, mesh);
    list.vary("kernel", project, {0, 5}, {0, 1, 2, 5, 10}, kernel);
    if (quick) return list.settings;
    for (const int n : {100, 400, 1600, 6400})
        for (const int pixels : {128, 256})
            for (const int m : {24, 48}) {
                AtlasSettings one = gather;
                vpls(one, n);
                size(one, pixels);
                samples(one, m);
                list.add("grid", std::move(one));
            }
    for (const int n : {100, 400, 1600})
        for (const int m : {512, 2048, 8192}) {
            AtlasSettings one = project;
            vpls(one, n);
            mesh(one, m);
            kernel(one, 0);
            list.add("grid", std::move(one));
        }
    return list.settings;
}

Sweep sweep_atlas(const SweepSetup& setup, const AtlasSweep& atlas) {
    return AtlasRun(setup, atlas)();
}

}  // namespace clgi::lab
