// SPDX-License-Identifier: MIT
#include "report/sweep_pictures.hpp"

#include <fmt/format.h>

#include <clgi/device.hpp>
#include <clgi/reference.hpp>
#include <memory>

#include "report/preview.hpp"
#include "report/reference_picture.hpp"
#include "report/sweep_run.hpp"
#include "report/timing.hpp"

namespace clgi::report {
namespace {

constexpr const char* method = "second-order";

// The library's lobe answers to direct light alone, so what it leaves out counts as its error
// against all light, but not against the paths that it is made for.
constexpr struct {
    const char *name, *effects;
} truths[picture_truths] = {{"full", "all"},
                            {"one-bounce", "emission,direct,one-bounce,diffuse-indirect"},
                            {"unshadowed", "emission,direct,unshadowed-indirect,diffuse-indirect"}};

class Run {
public:
    Run(const SweepSetup& setup, const PictureSweep& pictures)
        : setup_(setup),
          camera_(setup.scene.cameras.at(static_cast<std::size_t>(pictures.camera))),
          progress_(setup.progress) {
        options_.width = pictures.width;
        options_.height = pictures.height;
    }

    Sweep operator()() {
        out_.of = SweepOf::pictures;
        out_.scene = setup_.scene.name;
        out_.device = describe(setup_.queue.getInfo<CL_QUEUE_DEVICE>());
        out_.triangles = setup_.scene.triangles.size();
        out_.width = options_.width;
        out_.height = options_.height;
        out_.methods = {method};
        out_.knobs = {"vpls",         "negative-vpls", "low-res", "shadow-size",
                      "area-samples", "math",          "storage", "spp"};
        const reference::PathTracer tracer(setup_.scene);
        progress_.part(0.0, 0.4);
        for (int t = 0; t < picture_truths; ++t) find_truth(tracer, t);
        progress_.part(0.4, 0.15);
        if (setup_.path_tracer) trace(tracer);
        progress_.part(0.55, 0.45);
        if (setup_.solver) light();
        mark_fronts(out_);
        return std::move(out_);
    }

private:
    void find_truth(const reference::PathTracer& tracer, int t) {
        reference::Options options = options_;
        options.effects = reference::parse_effects(truths[t].effects);
        options.samples = setup_.reference_samples;
        SweepTruth truth{truths[t].name, truths[t].effects, {}, 0.0};
        truth.picture = cached_reference(
            tracer, camera_, options, truth.effects,
            setup_.folder / fmt::format("reference-{}.exr", truth.name), scene_key(setup_.scene),
            [&](double done) { return progress_.goes_on((t + done) / picture_truths); });
        if (truth.picture.channels.empty()) throw_cancelled();
        truth.noise = stated_error(truth.picture);
        out_.truths.push_back(std::move(truth));
    }

    void trace(const reference::PathTracer& tracer) {
        const int most = setup_.quick ? 16 : 32;
        int done = 0;
        for (const auto& truth : truths) {
            reference::Options options = options_;
            options.effects = reference::parse_effects(truth.effects);
            options.seed = 77;  // not the truth's
            for (int samples = 1; samples <= most; samples *= setup_.quick ? 4 : 2) {
                options.samples = samples;
                const reference::Picture picture = tracer.render(
                    camera_, options, [&](double) { return progress_.goes_on(done / 18.0); });
                if (picture.cancelled) throw_cancelled();
                SweepPoint point;
                point.method = path_tracer_name;
                point.series = truth.name;
                point.knobs = {{"spp", std::to_string(samples)}};
                point.milliseconds = 1e3 * picture.seconds;
                point.picture = reference_image(picture, truth.effects);
                judge(point, out_.truths);
                out_.points.push_back(std::move(point));
                progress_.report(++done / 18.0);
            }
        }
    }

    struct Lit {
        BuildOptions build;
        std::unique_ptr<SecondOrderSolver> solver;
    };

    void light() {
        const cl::Context context = setup_.queue.getInfo<CL_QUEUE_CONTEXT>();
        const DeviceScene scene(context, setup_.queue.getInfo<CL_QUEUE_DEVICE>(), setup_.scene);
        const std::vector<Settings> settings =
            second_order_settings(options_.width, options_.height, setup_.quick, setup_.build);
        std::vector<Lit> solvers;  // one for every way to build the kernels
        const auto solver_of = [&](const SecondOrderOptions& options) -> SecondOrderSolver& {
            for (Lit& lit : solvers)
                if (lit.build == options.build) return *lit.solver;
            auto made = std::make_unique<SecondOrderSolver>(setup_.queue, scene, options);
            return *solvers.emplace_back(Lit{options.build, std::move(made)}).solver;
        };
        std::vector<std::vector<double>> times(settings.size());
        const std::size_t before = out_.points.size();
        constexpr double slow = 150.0;  // milliseconds
        for (int round = 0; round < setup_.rounds; ++round)
            for (std::size_t i = 0; i < settings.size(); ++i) {
                progress_.report(static_cast<double>(round * settings.size() + i) /
                                 static_cast<double>(setup_.rounds * settings.size()));
                // Noise is small beside a slow frame: it is timed in the first round alone.
                if (round > 0 && spread(times[i]).median > slow) continue;
                SecondOrderSolver& solver = solver_of(settings[i].options);
                solver.reconfigure(settings[i].options);
                const double first = time_frame(solver, setup_.queue, camera_);  // into the caches
                for (int k = 0; k < (first > slow ? 1 : 2); ++k)
                    times[i].push_back(time_frame(solver, setup_.queue, camera_));
                if (round > 0) continue;
                SweepPoint point;
                point.method = method;
                point.series = settings[i].series;
                point.knobs = settings[i].knobs;
                point.picture = radiance_picture(setup_.queue, solver);
                judge(point, out_.truths);
                out_.points.push_back(std::move(point));
            }
        for (std::size_t i = 0; i < settings.size(); ++i)
            out_.points[before + i].milliseconds = spread(times[i]).median;
    }

    const SweepSetup& setup_;
    Camera camera_;
    reference::Options options_;
    SweepProgress progress_;
    Sweep out_;
};

}  // namespace

Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures) {
    return Run(setup, pictures)();
}

}  // namespace clgi::report
