// Frames of dynamic transfer: vectors stay good while geometry stands still, and what arrives is
// found anew.                                                                          [Kautz04]
// SPDX-License-Identifier: MIT
#include <clgi/advanced/dynamic_transfer_view.hpp>

#include "lab/picture_methods.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_settings.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

struct TransferPicture : SweepSetting {
    int mask = 32;
    int bounces = 1;
};

std::vector<TransferPicture> settings_of(bool quick) {
    std::vector<TransferPicture> out;
    const auto add = [&](TransferPicture one, const std::string& series) {
        one.method = dynamic_transfer_method;
        one.series = series + ", transfer";
        one.knobs = {{"mask", std::to_string(one.mask)},
                     {"interreflections", std::to_string(one.bounces)}};
        out.push_back(std::move(one));
    };
    using Values = std::vector<int>;
    vary(
        TransferPicture(), "mask", quick ? Values{16, 32} : Values{8, 16, 32, 64},
        [](TransferPicture& to, int n) { to.mask = n; }, add);
    vary(
        TransferPicture(), "interreflections", Values{0, 1},
        [](TransferPicture& to, int n) { to.bounces = n; }, add);
    return out;
}

Measured measure(const PictureTask& task, const TransferPicture& one, SweepPoint* result) {
    constexpr double slow = 1000.0;  // milliseconds
    const cl::CommandQueue& queue = task.setup.queue;
    DynamicTransferOptions options;
    options.masks.size = one.mask;
    options.bounces = one.bounces;
    options.build = task.setup.build;
    DynamicTransferSolver solver(task.programs, queue, task.setup.scene, task.scene, options);
    DynamicTransferViewOptions shown;
    shown.picture.width = task.width;
    shown.picture.height = task.height;
    shown.picture.emitters.shadow_size = task.shadow_size;
    shown.picture.build = task.setup.build;
    DynamicTransferView view(task.programs, queue, task.scene, solver, shown);
    const auto frame = [&] {
        solver.lights_changed();
        view.lights_changed();
        solver.light();
        view.render(task.camera);
    };
    solver.transfer();  // warms up
    frame();
    queue.finish();
    Measured out;
    out.once = time_frame(queue, [&] { solver.transfer(); });
    for (int k = 0; k < 2 && out.again; ++k) {
        out.milliseconds.push_back(time_frame(queue, frame));
        out.again = out.milliseconds.back() <= slow;
    }
    out.non_finite = solver.status().non_finite + view.picture().non_finite();
    if (result) {
        result->picture = radiance_picture(queue, view.picture());
        judge(*result, task.truths);
    }
    return out;
}

}  // namespace

PictureMethod dynamic_transfer_pictures(const PictureTask& task) {
    const std::vector<TransferPicture> settings = settings_of(task.setup.quick);
    PictureMethod out;
    out.knobs = {"mask", "interreflections"};
    out.settings = names_of(settings);
    out.measure = [&task, settings](std::size_t i, SweepPoint* result, const Progress&) {
        return measure(task, settings[i], result);
    };
    return out;
}

}  // namespace clgi::lab
