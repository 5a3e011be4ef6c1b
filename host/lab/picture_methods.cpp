// SPDX-License-Identifier: MIT
#include "lab/picture_methods.hpp"

#include <clgi/advanced/bake_layout.hpp>
#include <clgi/error.hpp>

#include "lab/preview.hpp"
#include "lab/relative_error.hpp"
#include "lab/sweep_antiradiance.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_settings.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// ---- settings -----------------------------------------------------------------------------------

// The smallest pages that hold all charts, from the setting's on, up to `largest`; 0: none do.
int page_of(const Scene& scene, const RendererOptions& options, int largest) {
    AtlasOptions layout = options.layout;
    layout.largest_size = largest;
    try {
        return make_bake_layout(scene, options.vpls, layout).atlas.size;
    } catch (const InputError&) {  // charts that do not fit
        return 0;
    }
}

// The settings whose charts fit. Where those of the usual page do not, all pages are larger.
std::vector<PictureSetting> light_atlas_settings(const Scene& scene, bool quick) {
    constexpr int largest_page = 4096;
    PictureSetting base;
    base.options.method = Method::light_atlas;
    base.options.least_change = 0.0;  // a frame has a whole bake
    base.options.vpls.count = quick ? 400 : 1600;
    base.options.layout.size = quick ? 64 : 256;
    // Scenes of many small charts need larger pages than others.
    const int found = page_of(scene, base.options, largest_page);
    const int page = base.options.layout.size = found > 0 ? found : largest_page;
    std::vector<PictureSetting> out;
    const auto add = [&](PictureSetting one, const std::string& series) {
        const int size = one.options.layout.size;
        if (page_of(scene, one.options, size) == 0) return;
        one.method = light_atlas_method;
        one.series = series + ", atlas";
        one.knobs = {{"vpls", std::to_string(one.options.vpls.count)},
                     {"atlas-size", std::to_string(size)}};
        out.push_back(std::move(one));
    };
    vary(
        base, "vpls",
        quick ? std::vector<std::uint32_t>{50, 400} : std::vector<std::uint32_t>{100, 400, 1600},
        [](PictureSetting& to, std::uint32_t n) { to.options.vpls.count = n; }, add);
    vary(
        base, "atlas-size",
        quick ? std::vector<int>{page / 2, page}
              : std::vector<int>{page / 4, page / 2, page, 2 * page},
        [](PictureSetting& to, int n) { to.options.layout.size = n; }, add);
    return out;
}

std::vector<PictureSetting> dynamic_transfer_settings(bool quick) {
    PictureSetting base;
    base.options.method = Method::dynamic_transfer;
    base.options.transfer.masks.size = 32;
    base.options.transfer.bounces = 1;
    std::vector<PictureSetting> out;
    const auto add = [&](PictureSetting one, const std::string& series) {
        const DynamicTransferOptions& options = one.options.transfer;
        one.method = dynamic_transfer_method;
        one.series = series + ", transfer";
        one.knobs = {{"mask", std::to_string(options.masks.size)},
                     {"interreflections", std::to_string(options.bounces)}};
        out.push_back(std::move(one));
    };
    using Values = std::vector<int>;
    vary(
        base, "mask", quick ? Values{16, 32} : Values{8, 16, 32, 64},
        [](PictureSetting& to, int n) { to.options.transfer.masks.size = n; }, add);
    vary(
        base, "interreflections", Values{0, 1},
        [](PictureSetting& to, int n) { to.options.transfer.bounces = n; }, add);
    return out;
}

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

}  // namespace clgi::lab
