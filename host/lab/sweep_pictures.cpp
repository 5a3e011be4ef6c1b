// SPDX-License-Identifier: MIT
#include "lab/sweep_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <iterator>
#include <set>

#include "lab/reference_picture.hpp"
#include "lab/sweep_run.hpp"

namespace clgi::lab {
namespace {

struct Truth {
    const char *name, *effects;
};

// The library's lobe answers to direct light alone, so what it leaves out counts as its error
// against all light, but not against the paths that it is made for.
constexpr Truth of_one_bounce[picture_truths] = {
    {full_truth, "all"},
    {"one-bounce", "emission,direct,one-bounce,diffuse-indirect"},
    {unshadowed_truth, "emission,direct,unshadowed-indirect,diffuse-indirect"}};

std::vector<Truth> truths_of(const std::vector<std::string>& methods, const Scene& scene) {
    if (std::find(methods.begin(), methods.end(), second_order_method) != methods.end())
        return {std::begin(of_one_bounce), std::end(of_one_bounce)};
    std::vector<Truth> out = {{full_truth, "all"}};
    // What arrives from an environment is direct light to the path tracer, and no indirect light.
    if (!scene.environment) out.push_back({indirect_truth, "indirect"});
    return out;
}

class PicturesRun {
public:
    PicturesRun(const SweepSetup& setup, const PictureSweep& pictures)
        : setup_(setup),
          camera_(setup.scene.cameras.at(static_cast<std::size_t>(pictures.camera))),
          progress_(setup.progress) {
        options_.width = pictures.width;
        options_.height = pictures.height;
        for (const std::string& name : pictures.methods)
            if (admits(setup.scene, name)) out_.methods.push_back(name);
        if (out_.methods.empty()) throw InputError("sweep: the scene has no surfaces to light");
        truths_ = truths_of(out_.methods, setup.scene);
    }

    Sweep operator()() {
        out_.of = SweepOf::pictures;
        out_.scene = setup_.scene.name;
        out_.device = describe(setup_.queue.getInfo<CL_QUEUE_DEVICE>());
        out_.triangles = setup_.scene.triangles.size();
        out_.width = options_.width;
        out_.height = options_.height;
        const reference::PathTracer tracer(setup_.scene);
        progress_.part(0.0, 0.4);
        for (std::size_t t = 0; t < truths_.size(); ++t) find_truth(tracer, t);
        progress_.part(0.4, 0.15);
        if (setup_.path_tracer) trace(tracer);
        progress_.part(0.55, 0.45);
        if (setup_.solver) light();
        out_.knobs.emplace_back("spp");
        mark_fronts(out_);
        return std::move(out_);
    }

private:
    void find_truth(const reference::PathTracer& tracer, std::size_t t) {
        reference::Options options = options_;
        options.effects = reference::parse_effects(truths_[t].effects);
        options.samples = setup_.reference_samples;
        SweepTruth truth{truths_[t].name, truths_[t].effects, {}, 0.0};
        truth.picture =
            cached_reference(tracer, camera_, options, truth.effects,
                             setup_.folder / fmt::format("reference-{}.exr", truth.name),
                             scene_key(setup_.scene), [&](double done) {
                                 return progress_.goes_on((static_cast<double>(t) + done) /
                                                          static_cast<double>(truths_.size()));
                             });
        if (truth.picture.channels.empty()) throw_cancelled();
        truth.noise = stated_error(truth.picture);
        out_.truths.push_back(std::move(truth));
    }

    void trace(const reference::PathTracer& tracer) {
        const int most = setup_.quick ? 16 : 32;
        const double runs = static_cast<double>(truths_.size()) * (setup_.quick ? 3 : 6);
        int done = 0;
        for (const Truth& truth : truths_) {
            reference::Options options = options_;
            options.effects = reference::parse_effects(truth.effects);
            options.seed = 77;  // not the truth's
            for (int samples = 1; samples <= most; samples *= setup_.quick ? 4 : 2) {
                options.samples = samples;
                const reference::Picture picture = tracer.render(
                    camera_, options, [&](double) { return progress_.goes_on(done / runs); });
                if (picture.cancelled) throw_cancelled();
                SweepPoint point;
                point.method = path_tracer_name;
                point.series = truth.name;
                point.knobs = {{"spp", std::to_string(samples)}};
                point.milliseconds = 1e3 * picture.seconds;
                point.picture = reference_image(picture, truth.effects);
                judge(point, out_.truths);
                out_.points.push_back(std::move(point));
                progress_.report(++done / runs);
            }
        }
    }

    // In turn, so that other load on the machine meets all methods.
    void light() {
        const cl::Context context = setup_.queue.getInfo<CL_QUEUE_CONTEXT>();
        const cl::Device device = setup_.queue.getInfo<CL_QUEUE_DEVICE>();
        DeviceScene scene(context, device, setup_.scene);
        const Programs programs(context, device);
        // Beside each other systems should not differ in direct light. An environment has many
        // maps.
        const bool alone = out_.methods.size() == 1;
        const int shadow_size = alone || setup_.scene.environment ? 1024 : 2048;
        const PictureTask task{setup_,   camera_,     options_.width, options_.height, scene,
                               programs, out_.truths, alone,          shadow_size};
        std::vector<PictureSetting> settings;
        for (const std::string& name : out_.methods) {
            const PictureMethod made = picture_method(name, task);
            settings.insert(settings.end(), made.settings.begin(), made.settings.end());
            for (const std::string& knob : made.knobs)
                if (std::find(out_.knobs.begin(), out_.knobs.end(), knob) == out_.knobs.end())
                    out_.knobs.push_back(knob);
        }
        std::set<std::string> begun;  // methods
        Turns turns;
        turns.rounds = setup_.rounds;
        turns.measure = [&](std::size_t i, SweepPoint* result, const Progress& part) {
            const bool first = begun.insert(settings[i].method).second;
            return measure_picture(task, settings[i], first, result, part);
        };
        // Of second-order illumination, maps of point lights have a size of their own.
        turns.same = [&](std::size_t a, std::size_t b) {
            return settings[a].method != second_order_method &&
                   settings[a].method == settings[b].method &&
                   settings[a].knobs == settings[b].knobs;
        };
        for (SweepPoint& point :
             measure_in_turn(names_of(settings), turns, progress_, out_.non_finite))
            out_.points.push_back(std::move(point));
    }

    const SweepSetup& setup_;
    Camera camera_;
    reference::Options options_;
    SweepProgress progress_;
    std::vector<Truth> truths_;
    Sweep out_;
};

}  // namespace

bool admits(const Scene& scene, const std::string& method) {
    if (method == second_order_method) return true;
    return !scene.triangles.empty() &&
           (method != dynamic_transfer_method || scene.environment.has_value());
}

Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures) {
    return PicturesRun(setup, pictures)();
}

}  // namespace clgi::lab
