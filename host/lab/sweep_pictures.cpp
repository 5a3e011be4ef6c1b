// SPDX-License-Identifier: MIT
#include "lab/sweep_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <iterator>
#include <set>

#include "lab/metrics.hpp"
#include "lab/preview.hpp"
#include "lab/reference_picture.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// ---- a frame ------------------------------------------------------------------------------------

void prepare(Renderer& renderer, const Progress& part) {
    if (!renderer.prepare(part) && !renderer.status().given_up) throw_cancelled();
}

// Milliseconds before all frames: layout and bake, links, or transfer vectors. prepared: of the
// first prepare().
std::optional<double> once(const PictureTask& task, const Renderer& renderer, double prepared) {
    if (const auto bake = renderer.bake()) return bake->layout_ms + prepared;
    if (const AntiradianceSolver* solver = renderer.antiradiance())
        return 1e3 * solver->linking_seconds();
    if (DynamicTransferSolver* solver = renderer.dynamic_transfer())
        return time_frame(task.setup.queue, [&] { solver->transfer(); });
    return std::nullopt;
}

// The truths that have a picture of their own: all light, and what arrives over links and from the
// sky alone.
std::vector<std::string> answered(const PictureTask& task, Method method) {
    std::vector<std::string> out = {full_truth};
    for (const SweepTruth& truth : task.truths)
        if (method == Method::antiradiance && truth.name == indirect_truth)
            out.push_back(truth.name);
    return out;
}

// One for each truth that is answered, from the renderer's last picture on.
std::vector<io::Image> pictures(const PictureTask& task, Renderer& renderer) {
    std::vector<io::Image> out;
    PictureOptions picture = renderer.options().picture;
    for (const std::string& truth : answered(task, renderer.options().method)) {
        if (truth == indirect_truth) {
            picture.direct = false;
            renderer.reconfigure(picture);
            renderer.render(task.camera);
        }
        out.push_back(radiance_picture(renderer));
    }
    return out;
}

void judge_all(const PictureTask& task, const std::vector<std::string>& answers,
               const std::vector<io::Image>& found, SweepPoint& result) {
    result.picture = found.front();
    judge(result, task.truths);
    for (std::size_t k = 0; k < answers.size(); ++k)
        for (std::size_t t = 0; t < task.truths.size(); ++t)
            if (task.truths[t].name == answers[k])
                result.error[t] = relative_error(found[k], task.truths[t].picture);
}

// ---- the sweep ----------------------------------------------------------------------------------

bool admits(const Scene& scene, const std::string& method) {
    if (method == second_order_method) return true;
    return !scene.triangles.empty() &&
           (method != dynamic_transfer_method || scene.environment.has_value());
}

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
          progress_(setup.progress),
          out_(sweep_of(SweepOf::pictures, setup)) {
        out_.width = options_.width = pictures.width;
        out_.height = options_.height = pictures.height;
        for (const std::string& name : pictures.methods)
            if (admits(setup.scene, name)) out_.methods.push_back(name);
        if (out_.methods.empty()) throw InputError("sweep: the scene has no surfaces to light");
        truths_ = truths_of(out_.methods, setup.scene);
    }

    Sweep operator()() {
        const reference::PathTracer tracer(setup_.scene);
        progress_.part(0.0, 0.4);
        for (const Truth& truth : truths_) find_truth(tracer, truth);
        progress_.part(0.4, 0.15);
        if (setup_.path_tracer) trace(tracer);
        progress_.part(0.55, 0.45);
        if (setup_.solver) light();
        out_.knobs.emplace_back("spp");
        mark_fronts(out_);
        return std::move(out_);
    }

private:
    void find_truth(const reference::PathTracer& tracer, const Truth& truth) {
        reference::Options options = options_;
        options.effects = reference::parse_effects(truth.effects);
        options.samples = setup_.reference_samples;
        const auto count = static_cast<double>(truths_.size()),
                   before = static_cast<double>(out_.truths.size());
        add_truth(out_, truth.name, truth.effects,
                  cached_reference(tracer, camera_, options, truth.effects,
                                   setup_.folder / fmt::format("reference-{}.exr", truth.name),
                                   scene_key(setup_.scene), [&](double done) {
                                       return progress_.goes_on((before + done) / count);
                                   }));
    }

    void trace(const reference::PathTracer& tracer) {
        const int most = setup_.quick ? 16 : 32;
        const double runs = static_cast<double>(truths_.size()) * (setup_.quick ? 3 : 6);
        int done = 0;
        for (const Truth& truth : truths_) {
            reference::Options options = options_;
            options.effects = reference::parse_effects(truth.effects);
            options.seed = baseline_seed;
            for (int samples = 1; samples <= most; samples *= setup_.quick ? 4 : 2) {
                options.samples = samples;
                const reference::Picture picture = tracer.render(
                    camera_, options, [&](double) { return progress_.goes_on(done / runs); });
                if (picture.cancelled) throw_cancelled();
                add_traced(out_, truth.name, samples, picture.seconds,
                           reference_image(picture, truth.effects));
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
        add_points(out_, settings, turns, progress_);
    }

    const SweepSetup& setup_;
    Camera camera_;
    reference::Options options_;
    SweepProgress progress_;
    std::vector<Truth> truths_;
    Sweep out_;
};

}  // namespace

PictureMethod picture_method(const std::string& name, const PictureTask& task) {
    const SweepSetup& setup = task.setup;
    PictureMethod out;
    if (name == second_order_method)
        out = {
            {"vpls", "negative-vpls", "low-res", "shadow-size", "area-samples", "math", "storage"},
            second_order_settings(setup.quick, setup.build,
                                  &second_order_front(main_light(task.scene)))};
    else if (name == antiradiance_method)
        out = {{"bins", "elements", "iteration", "steps", "spread", "bin-share", "storage"},
               antiradiance_settings(setup.quick, setup.build, task.alone)};
    else if (name == light_atlas_method)
        out = {{"vpls", "atlas-size"}, light_atlas_settings(setup.scene, setup.quick)};
    else
        out = {{"mask", "interreflections"}, dynamic_transfer_settings(setup.quick)};
    for (PictureSetting& one : out.settings) {
        PictureOptions& picture = one.options.picture;
        picture.width = task.width;
        picture.height = task.height;
        if (name != second_order_method) picture.emitters.shadow_size = task.shadow_size;
        if (name == light_atlas_method || name == dynamic_transfer_method)
            picture.build = setup.build;  // others vary it
    }
    return out;
}

Measured measure_picture(const PictureTask& task, const PictureSetting& setting, bool first,
                         SweepPoint* result, const Progress& part) {
    const cl::CommandQueue& queue = task.setup.queue;
    const Method method = setting.options.method;
    const bool second_order = method == Method::second_order;
    const double slow = second_order ? 150.0 : 1000.0;  // milliseconds
    const auto half = [&](double done) { return part(0.5 * done); };
    const auto make = [&](const RendererOptions& options) {
        return std::make_unique<Renderer>(task.programs, queue, task.setup.scene, task.scene,
                                          options);
    };
    Measured out;
    std::vector<io::Image> found;
    {
        // A bake is timed without the building of its kernels.
        if (first && method == Method::light_atlas) prepare(*make(setting.options), half);
        const auto renderer = make(setting.options);
        renderer->build();
        const double prepared = time_frame(queue, [&] { prepare(*renderer, half); });
        renderer->render(task.camera).wait();  // warms up
        out.once = once(task, *renderer, prepared);
        for (int k = 0; k < 2 && out.again; ++k) {
            out.milliseconds.push_back(time_frame(queue, [&] {
                if (!second_order) renderer->lights_changed();
                renderer->render(task.camera);
            }));
            out.again = out.milliseconds.back() <= slow;
        }
        const RendererStatus status = renderer->status();
        out.non_finite = status.non_finite;
        if (!result) return out;
        result->given_up = status.given_up;
        found = pictures(task, *renderer);
    }
    const std::vector<std::string> answers = answered(task, method);
    judge_all(task, answers, found, *result);
    if (!setting.estimate || !task.alone || result->given_up) return out;
    RendererOptions twice = setting.options;
    twice.antiradiance.bins *= 2;
    const auto finer = make(twice);
    prepare(*finer, [&](double done) { return part(0.5 + 0.5 * done); });
    if (finer->status().given_up) return out;
    finer->render(task.camera);
    const std::vector<io::Image> better = pictures(task, *finer);
    for (std::size_t k = 0; k < answers.size(); ++k)
        result->estimated_error[answers[k]] = relative_error(found[k], better[k]);
    return out;
}

Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures) {
    return PicturesRun(setup, pictures)();
}

}  // namespace clgi::lab
