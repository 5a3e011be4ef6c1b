// SPDX-License-Identifier: MIT
#include "lab/bench_animation.hpp"

#include <clgi/error.hpp>
#include <clgi/scene_animator.hpp>

#include "lab/timing.hpp"

namespace clgi::lab {

std::vector<AnimationRow> bench_animation(
    const AnimationSetup& setup, const std::vector<std::pair<std::string, Scene>>& scenes) {
    const auto microseconds = [](Clock::duration time) { return 1e3 * milliseconds(time); };
    constexpr int warm_up = 10;
    const cl::Context context = setup.queue.getInfo<CL_QUEUE_CONTEXT>();
    const cl::Device device = setup.queue.getInfo<CL_QUEUE_DEVICE>();
    std::vector<AnimationRow> rows;
    for (const auto& [name, scene] : scenes) {
        if (!scene.animation || scene.animation->clips.empty())
            throw Error("bench: " + name + " has no animation");
        DeviceScene on_device(context, device, scene);
        SceneAnimator animator(setup.queue, scene, on_device, setup.build);
        std::vector<double> curves, steps;
        for (int k = -warm_up; k < setup.repeats; ++k) {
            const double share = static_cast<double>(k + warm_up) / (setup.repeats + warm_up);
            const double done = (static_cast<double>(rows.size()) + share) / scenes.size();
            if (setup.progress && !setup.progress(done)) throw Error("bench: cancelled");
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
        AnimationRow row{name, scene.positions.size(), spread(curves).median, spread(steps).median};
        row.ns_per_vertex = 1e3 * row.step_us / static_cast<double>(row.vertices);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace clgi::lab
