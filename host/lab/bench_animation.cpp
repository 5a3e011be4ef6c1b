// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/scene_animator.hpp>

#include "lab/bench.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {

BenchTable bench_animation(const BenchSetup& setup) {
    if (setup.scenes.empty()) throw Error("bench: animation needs --scene");
    const auto microseconds = [](Clock::duration time) { return 1e3 * milliseconds(time); };
    constexpr int warm_up = 10;
    Json rows;
    for (const auto& [name, scene] : setup.scenes) {
        if (!scene.animation || scene.animation->clips.empty())
            throw Error("bench: " + name + " has no animation");
        DeviceScene on_device(setup.context(), setup.device(), scene);
        SceneAnimator animator(setup.queue, scene, on_device, setup.build);
        std::vector<double> curves, steps;
        for (int k = -warm_up; k < setup.repeats; ++k) {
            const double share = static_cast<double>(k + warm_up) / (setup.repeats + warm_up);
            setup.report((static_cast<double>(rows.size()) + share) / setup.scenes.size());
            const Clock::time_point begin = Clock::now();
            const Pose pose =
                pose_at(*scene.animation, 0, share * scene.animation->clips[0].duration);
            const Clock::time_point sampled = Clock::now();
            animator.show(pose).done.wait();
            const Clock::time_point end = Clock::now();
            if (k < 0) continue;
            curves.push_back(microseconds(sampled - begin));
            steps.push_back(microseconds(end - sampled));
        }
        const double step = spread(steps).median;
        rows.push_back(
            {{"scene", name},
             {"vertices", scene.positions.size()},
             {"curves_us", spread(curves).median},
             {"step_us", step},
             {"ns_per_vertex", 1e3 * step / static_cast<double>(scene.positions.size())}});
    }
    return {{{"rows", rows}},
            {{"scene", 24, "{scene}"},
             {"vertices", 10, "{vertices:.0f}"},
             {"curves us", 12, "{curves_us:.1f}"},
             {"step us", 10, "{step_us:.0f}"},
             {"ns a vertex", 14, "{ns_per_vertex:.1f}"}},
            ""};
}

}  // namespace clgi::lab
