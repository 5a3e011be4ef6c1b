// SPDX-License-Identifier: MIT
#include "report/sweep.hpp"

#include <fmt/format.h>

#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <memory>
#include <numeric>

#include "report/luminance.hpp"
#include "report/pareto.hpp"
#include "report/preview.hpp"
#include "report/reference_picture.hpp"
#include "report/relative_error.hpp"
#include "report/timing.hpp"

namespace clgi::report {

const char* const truth_names[truths] = {"full", "one-bounce", "unshadowed"};
// The library's lobe answers to direct light alone, so what it leaves out counts as its error
// against all light, but not against the paths that it is made for.
const char* const truth_effects[truths] = {"all", "emission,direct,one-bounce,diffuse-indirect",
                                           "emission,direct,unshadowed-indirect,diffuse-indirect"};

namespace {

double mean_luminance(const io::Image& picture) {
    const std::vector<double> values = luminance_of(picture);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class Run {
public:
    explicit Run(const SweepSetup& setup) : setup_(setup) {
        const Camera& camera = setup.scene.cameras.at(static_cast<std::size_t>(setup.camera));
        camera_ = camera;
        options_.width = setup.width;
        options_.height = setup.height;
    }

    Sweep operator()() {
        out_.scene = setup_.scene.name;
        out_.device = describe(setup_.queue.getInfo<CL_QUEUE_DEVICE>());
        out_.triangles = setup_.scene.triangles.size();
        out_.width = setup_.width;
        out_.height = setup_.height;
        const reference::PathTracer tracer(setup_.scene);
        step(0.0, 0.4);
        for (int t = 0; t < truths; ++t) find_truth(tracer, t);
        step(0.4, 0.15);
        if (setup_.path_tracer) trace(tracer);
        step(0.55, 0.45);
        if (setup_.second_order) light();
        mark_fronts();
        return std::move(out_);
    }

private:
    // Progress within a part of the whole.
    void step(double from, double span) {
        from_ = from;
        span_ = span;
        report(0.0);
    }
    void report(double share) const {
        if (setup_.progress && !setup_.progress(from_ + span_ * share))
            throw Error("sweep: cancelled");
    }

    void find_truth(const reference::PathTracer& tracer, int t) {
        reference::Options options = options_;
        options.effects = reference::parse_effects(truth_effects[t]);
        options.samples = setup_.reference_samples;
        out_.truth[t] =
            cached_reference(tracer, camera_, options, truth_effects[t],
                             setup_.folder / fmt::format("reference-{}.exr", truth_names[t]),
                             scene_key(setup_.scene), [&](double done) {
                                 if (!setup_.progress) return true;
                                 return setup_.progress(from_ + span_ * (t + done) / truths);
                             });
        if (out_.truth[t].channels.empty()) throw Error("sweep: cancelled");
        out_.truth_noise[t] = stated_error(out_.truth[t]);
    }

    // A point that was rendered for one set of paths is held against that truth alone, unless it
    // is an approximation of all.
    void judge(SweepPoint& point) const {
        for (int t = 0; t < truths; ++t)
            point.error[t] = relative_error(point.picture, out_.truth[t]);
        point.energy = mean_luminance(point.picture) / mean_luminance(out_.truth[all_light]);
    }

    void trace(const reference::PathTracer& tracer) {
        const int most = setup_.quick ? 16 : 32;
        int done = 0;
        for (int t = 0; t < truths; ++t) {
            reference::Options options = options_;
            options.effects = reference::parse_effects(truth_effects[t]);
            options.seed = 77;  // not the truth's
            for (int samples = 1; samples <= most; samples *= setup_.quick ? 4 : 2) {
                options.samples = samples;
                const reference::Picture picture = tracer.render(camera_, options, [&](double) {
                    return !setup_.progress || setup_.progress(from_ + span_ * done / 18.0);
                });
                if (picture.cancelled) throw Error("sweep: cancelled");
                SweepPoint point;
                point.method = "path tracer";
                point.series = truth_names[t];
                point.knobs = {{"spp", std::to_string(samples)}};
                point.milliseconds = 1e3 * picture.seconds;
                point.picture = reference_image(picture, truth_effects[t]);
                judge(point);
                out_.points.push_back(std::move(point));
                report(std::min(++done / 18.0, 1.0));
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
            second_order_settings(setup_.width, setup_.height, setup_.quick, setup_.build);
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
                report(static_cast<double>(round * settings.size() + i) /
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
                point.method = "second-order";
                point.series = settings[i].series;
                point.knobs = settings[i].knobs;
                point.picture = radiance_picture(setup_.queue, solver);
                judge(point);
                out_.points.push_back(std::move(point));
            }
        for (std::size_t i = 0; i < settings.size(); ++i)
            out_.points[before + i].milliseconds = spread(times[i]).median;
    }

    void mark_fronts() {
        for (int t = 0; t < truths; ++t)
            for (const char* method : {"second-order", "path tracer"}) {
                std::vector<Cost> costs;
                std::vector<SweepPoint*> points;
                for (SweepPoint& point : out_.points) {
                    if (point.method != method) continue;
                    if (point.method == "path tracer" && point.series != truth_names[t]) continue;
                    costs.push_back({point.milliseconds, point.error[t]});
                    points.push_back(&point);
                }
                for (const std::size_t i : pareto_front(costs)) points[i]->front[t] = true;
            }
    }

    const SweepSetup& setup_;
    Camera camera_;
    reference::Options options_;
    Sweep out_;
    double from_ = 0.0, span_ = 1.0;
};

}  // namespace

Sweep sweep(const SweepSetup& setup) { return Run(setup)(); }

}  // namespace clgi::report
