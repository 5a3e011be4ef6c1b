// Frames of second-order illumination.
// SPDX-License-Identifier: MIT
#include <memory>

#include "lab/picture_methods.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// One solver for every way to build the kernels.
class Solvers {
public:
    explicit Solvers(const PictureTask& task) : task_(task) {}

    SecondOrderSolver& of(const SecondOrderOptions& options) {
        for (Lit& lit : made_)
            if (lit.build == options.build) return *lit.solver;
        auto made = std::make_unique<SecondOrderSolver>(task_.setup.queue, task_.scene, options);
        return *made_.emplace_back(Lit{options.build, std::move(made)}).solver;
    }

private:
    struct Lit {
        BuildOptions build;
        std::unique_ptr<SecondOrderSolver> solver;
    };
    const PictureTask& task_;
    std::vector<Lit> made_;
};

}  // namespace

PictureMethod second_order_pictures(const PictureTask& task) {
    const std::vector<Settings> settings =
        second_order_settings(task.width, task.height, task.setup.quick, task.setup.build,
                              &second_order_front(main_light(task.scene)));
    const auto solvers = std::make_shared<Solvers>(task);
    PictureMethod out;
    out.knobs = {"vpls",         "negative-vpls", "low-res", "shadow-size",
                 "area-samples", "math",          "storage"};
    out.settings = names_of(settings);
    out.distinct = true;  // maps of point lights have a size of their own
    out.measure = [&task, settings, solvers](std::size_t i, SweepPoint* result, const Progress&) {
        constexpr double slow = 150.0;  // milliseconds
        SecondOrderSolver& solver = solvers->of(settings[i].options);
        solver.reconfigure(settings[i].options);
        const cl::CommandQueue& queue = task.setup.queue;
        const double first = time_frame(solver, queue, task.camera);  // into the caches
        Measured found;
        for (int k = 0; k < (first > slow ? 1 : 2); ++k)
            found.milliseconds.push_back(time_frame(solver, queue, task.camera));
        found.again = spread(found.milliseconds).median <= slow;
        if (result) {
            result->picture = radiance_picture(queue, solver);
            judge(*result, task.truths);
        }
        return found;
    };
    return out;
}

}  // namespace clgi::lab
