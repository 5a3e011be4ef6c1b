// SPDX-License-Identifier: MIT
#include "lab/sweep_atlas.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <iterator>

#include "lab/baked_atlas.hpp"
#include "lab/reference_atlas.hpp"
#include "lab/reference_picture.hpp"
#include "lab/sweep_run.hpp"
#include "lab/sweep_turns.hpp"
#include "lab/timed_bake.hpp"

namespace clgi::lab {
namespace {

constexpr const char* baked_effects = "indirect";

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
        SweepTruth truth{"full", baked_effects, {}, 0.0};
        truth.picture =
            !atlas_.reference.empty()
                ? given_reference()
                : cached_atlas(tracer, places_, tracing(baked_effects, setup_.reference_samples),
                               baked_effects, setup_.folder / "reference-atlas.exr",
                               scene_key(setup_.scene),
                               [&](double done) { return progress_.goes_on(done); });
        if (truth.picture.channels.empty()) throw_cancelled();
        truth.noise = stated_error(truth.picture);
        const auto& alpha = truth.picture.find("A")->values;
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
        out_.truths.push_back(std::move(truth));
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
        for (SweepPoint& point :
             measure_in_turn(names_of(settings), turns, progress_, out_.non_finite))
            out_.points.push_back(std::move(point));
    }

    const SweepSetup& setup_;
    const AtlasSweep& atlas_;
    SweepProgress progress_;
    AtlasLayout layout_;
    AtlasPlaces places_;
    Mask counted_;
    Sweep out_;
};

}  // namespace

Sweep sweep_atlas(const SweepSetup& setup, const AtlasSweep& atlas) {
    return AtlasRun(setup, atlas)();
}

}  // namespace clgi::lab
