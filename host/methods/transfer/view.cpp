// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/dynamic_transfer_view.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/parallel.hpp>
#include <clgi/passes/receivers.hpp>
#include <cmath>
#include <vector>

#include "core/opencl/check.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"
#include "shading/kit/eye.hpp"
#include "shading/kit/without_sky.hpp"

namespace clgi {
namespace {

constexpr const char* owner = "dynamic-transfer-view";

// Pixels that are receivers at a time.
constexpr std::uint32_t batch = 32768;

// From a surface to the receiver at a pixel, of the scene's radius: more than positions of pixels
// are rounded by, and less than anything that casts a shadow one can see.
constexpr float lift = 1.52587890625e-5f;  // 2^-16

// Direct light of everything but what is part of the solver's environment.
PictureOptions beside_environment(const PictureOptions& options,
                                  const DynamicTransferSolver& solver) {
    PictureOptions out = without_sky(options);
    out.emitters.directional = out.emitters.directional && !solver.options().directional;
    return out;
}

}  // namespace

struct DynamicTransferView::State {
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          DynamicTransferSolver& from, const DynamicTransferViewOptions& options)
        : scene(of),
          solver(from),
          picture(programs, queue, of, beside_environment(options.picture, from), owner),
          passes(programs, picture.options().build),
          open_pixels(programs, picture.options().build, from.options().masks.bands),
          open_receivers(programs, full(picture.options().build), from.options().masks.bands),
          parallel(programs, picture.options().build),
          threshold(options.threshold) {
        if (!(threshold >= 0.0f))
            throw Error("dynamic-transfer-view: threshold is " + std::to_string(threshold) +
                        ", at least 0 needed");
        need_range(owner, "probe_step", options.probe_step, 2, 64);
        probe(static_cast<std::uint32_t>(options.probe_step));
        BufferTable all = picture.table();
        add_to(all);
        picture.allocate(all, solver.bytes());
        if (shadowed() || solver.glossy()) passes.build({"show"});
        if (!shadowed()) open_pixels.build({"open"});
        if (solver.glossy()) passes.build({"add_gloss"});
        if (!shadowed() && some_pixels() && !all_pixels()) open_receivers.build({"open"});
        if (some_pixels()) passes.build({"pixels", "place", "compare_probes", "undersampled"});
        if (some_pixels() && solver.glossy()) passes.build({"compare_gloss"});
        write();
    }

    bool shadowed() const { return occludes(solver.options().occlusion); }
    // Without shadows and lobes every pixel has its own light anyway.
    bool some_pixels() const { return !std::isinf(threshold) && (shadowed() || solver.glossy()); }
    bool all_pixels() const { return threshold == 0.0f && some_pixels(); }
    std::uint32_t count() const { return static_cast<std::uint32_t>(picture.pixels()); }

    void probe(std::uint32_t step) {
        const auto width = static_cast<std::uint32_t>(picture.options().width);
        const auto height = static_cast<std::uint32_t>(picture.options().height);
        probing.width = width;
        probing.height = height;
        probing.threshold = threshold;
        // A picture that is smaller than a step has a probe all the same.
        probing.step = std::clamp(std::min(width, height), 2u, step);
        if (width < 2 || height < 2) return;
        const auto across = [&](std::uint32_t size) {
            return (size - probing.step / 2 + probing.step - 1) / probing.step;
        };
        probing.columns = across(width);
        probing.rows = across(height);
        for (std::uint32_t row = 0; row < probing.rows; ++row)
            for (std::uint32_t column = 0; column < probing.columns; ++column)
                probes.push_back((row * probing.step + probing.step / 2) * width +
                                 column * probing.step + probing.step / 2);
    }

    void add_to(BufferTable& t) {
        const char* size = "width and height";
        const std::size_t pixels = picture.pixels();
        probing.pixel_stride = plane_stride(pixels);
        if (solver.glossy())
            t.add(gloss, "gloss", size,
                  irradiance_bytes(picture.options().build.storage, probing.pixel_stride));
        if (!some_pixels()) return;
        const MaskOptions& masks = solver.options().masks;
        const auto terms = static_cast<std::size_t>(sh::terms(masks.bands));
        receivers.stride = plane_stride(
            std::max<std::size_t>(probes.size(), std::min<std::size_t>(batch, pixels)));
        probing.probe_stride = receivers.stride;
        const std::size_t stride = receivers.stride;
        t.add(receivers.planes, "receivers", size, RECEIVER_PLANES * stride * word);
        if (shadowed())
            t.add(receivers.masks, "masks", size,
                  static_cast<std::size_t>(MASK_WORDS(masks.size)) * stride * word);
        t.add(receivers.transfer, "transfer vectors", size, terms * stride * word);
        t.add(arriving, "irradiance of receivers", size, 4 * stride * word);
        if (solver.glossy()) t.add(shining, "gloss of receivers", size, 4 * stride * word);
        t.add(exponents, "exponents of lobes", size, stride * word);
        t.add(probe_list.pixels, "probes", size, probes.size() * word);
        t.add(probe_list.listed, "probes", size, word);
        t.add(states, "probes", size, probes.size() * word);
        // Runs of a list end at whole batches.
        t.add(list.pixels, "listed pixels", size, (pixels + batch) * word);
        t.add(list.listed, "listed pixels", size, word);
        t.add(flags, "flags of pixels", size, pixels);
        t.add(scratch, "listed pixels", size, scan_scratch_bytes(pixels));
    }

    void write() {
        if (!some_pixels()) return;
        const auto put = [&](const cl::Buffer& buffer, const std::vector<std::uint32_t>& values) {
            if (!values.empty())
                picture.record().write(buffer, values.data(), values.size() * word);
        };
        put(probe_list.pixels, probes);
        put(probe_list.listed, {static_cast<std::uint32_t>(probes.size())});
        if (!all_pixels()) return put(list.listed, {0});  // a picture without probes lists none
        std::vector<std::uint32_t> all(count());
        for (std::uint32_t i = 0; i < count(); ++i) all[i] = i;
        put(list.pixels, all);
        put(list.listed, {count()});
    }

    // Receivers at a run of pixels, and with shadows what arrives at them.
    void light_pixels(const PixelParams& run, const PixelList& of) {
        Recorder& record = picture.record();
        const cl::CommandQueue& queue = record.queue();
        receivers.count = run.count;
        record("transfer.pixels", run.count, [&](const WaitList& wait) {
            return passes.pixels(queue, run, of, scene, picture.gbuffer(), receivers, exponents,
                                 wait);
        });
        if (!shadowed()) return;
        record("transfer.mask", run.count, [&](const WaitList& wait) {
            return solver.passes().mask(queue, receivers, solver.blockers(), solver.drawn(), wait);
        });
        record("transfer.integrate", run.count, [&](const WaitList& wait) {
            return solver.passes().integrate(queue, receivers, solver.weights(),
                                             solver.directions(), wait);
        });
        shade(arriving);
        if (solver.options().interreflections == 0) return;
        record("transfer.bounce", run.count, [&](const WaitList& wait) {
            return solver.passes().bounce(queue, receivers, solver.blockers(), solver.heights(),
                                          solver.exitance(), arriving, picture.counter(), wait);
        });
    }

    // What arrives at receivers or pixels of which nothing blocks the light.
    void light_openly(const TransferPasses& open, std::uint32_t normal, std::uint32_t number,
                      std::uint32_t stride, const cl::Buffer& planes, const cl::Buffer& out) {
        const DynamicTransferOptions& of = solver.options();
        const OpenParams params = open_params(of.masks.bands, of.window, normal, number, stride);
        Recorder& record = picture.record();
        record("transfer.open", number, [&](const WaitList& wait) {
            return open.open(record.queue(), params, planes, solver.environment(), out,
                             picture.counter(), wait);
        });
    }

    void shade(const cl::Buffer& out) {
        Recorder& record = picture.record();
        record("transfer.shade", receivers.count, [&](const WaitList& wait) {
            return solver.passes().shade(record.queue(), receivers, receivers.transfer,
                                         solver.environment(), SHADE_CLAMP, out, picture.counter(),
                                         wait);
        });
    }

    // What the lobes of those receivers reflect; their transfer vectors are lost.
    void gloss_pixels(const View& view) {
        Recorder& record = picture.record();
        record("transfer.integrate_gloss", receivers.count, [&](const WaitList& wait) {
            return solver.passes().integrate_gloss(record.queue(), receivers, solver.weights(),
                                                   solver.directions(), exponents, eye_of(view),
                                                   receivers.transfer, wait);
        });
        shade(shining);
    }

    void place(const PixelParams& run, const cl::Buffer& light, const cl::Buffer& shown) {
        Recorder& record = picture.record();
        record("transfer.place", run.count, [&](const WaitList& wait) {
            return passes.place(record.queue(), run, list, light, shown, wait);
        });
    }

    PixelParams run_of(std::uint32_t first, std::uint32_t length) const {
        return {
            first, length, probing.pixel_stride, receivers.stride, lift * scene.frame().detail, 0,
            0,     0};
    }

    void show(const View& view, const cl::Buffer& light, const cl::Buffer& shown) {
        Recorder& record = picture.record();
        const ShowVerticesParams params{eye_of(view), count(), probing.pixel_stride,
                                        scene.info().triangle_count, solver.receivers().stride};
        record("transfer.show", count(), [&](const WaitList& wait) {
            return passes.show(record.queue(), params, scene, solver.other_side(),
                               picture.gbuffer(), light, shown, wait);
        });
    }

    // Lists the pixels at which probes differ from what is shown.
    void list_undersampled(const View& view) {
        Recorder& record = picture.record();
        const auto number = static_cast<std::uint32_t>(probes.size());
        light_pixels(run_of(0, number), probe_list);
        if (!shadowed())
            light_openly(open_receivers, RECEIVER_NORMAL, number, receivers.stride,
                         receivers.planes, arriving);
        record("transfer.compare_probes", number, [&](const WaitList& wait) {
            return passes.compare_probes(record.queue(), probing, picture.gbuffer(),
                                         picture.irradiance(), arriving, states, wait);
        });
        if (solver.glossy()) {
            gloss_pixels(view);
            record("transfer.compare_gloss", number, [&](const WaitList& wait) {
                return passes.compare_gloss(record.queue(), probing, scene, picture.gbuffer(),
                                            picture.irradiance(), gloss, shining, states, wait);
            });
        }
        if (shadowed()) mend(arriving, picture.irradiance());
        if (solver.glossy()) mend(shining, gloss);
        record("parallel.list", count(), [&](const WaitList& wait) {
            return parallel.list(record.queue(), count(), flags, list.pixels, list.listed, scratch,
                                 wait);
        });
    }

    // Flags are the same for whatever is shown.
    void mend(const cl::Buffer& missing, const cl::Buffer& shown) {
        Recorder& record = picture.record();
        record("transfer.undersampled", count(), [&](const WaitList& wait) {
            return passes.undersampled(record.queue(), probing, picture.gbuffer(), missing, states,
                                       shown, flags, wait);
        });
    }

    void light_listed(const View& view) {
        for (std::uint32_t first = 0; first < count(); first += batch) {
            const PixelParams run = run_of(first, std::min(batch, count() - first));
            light_pixels(run, list);
            if (shadowed()) place(run, arriving, picture.irradiance());
            if (!solver.glossy()) continue;
            gloss_pixels(view);
            place(run, shining, gloss);
        }
    }

    cl::Event render(const Camera& camera, const WaitList& wait) {
        WaitList ready = wait;
        if (solver.glossy())
            solver.reflect(eye_of(make_view(camera, scene.frame(), picture.options().width,
                                            picture.options().height)),
                           wait);
        // Also of a queue out of order, where nothing else orders two recorders.
        if (const cl::Event lit = solver.last(); lit()) ready.push_back(lit);
        const View view = picture.begin(camera, ready);
        if (!shadowed())
            light_openly(open_pixels, GBUFFER_NORMAL, count(), picture.stride(),
                         picture.gbuffer().planes, picture.irradiance());
        else if (!all_pixels())
            show(view, solver.irradiance(), picture.irradiance());
        if (!all_pixels() && solver.glossy()) show(view, solver.gloss(), gloss);
        const bool probed = some_pixels() && !all_pixels() && !probes.empty();
        if (probed) list_undersampled(view);
        if (probed || all_pixels()) light_listed(view);
        picture.combine(view);
        if (solver.glossy()) {
            Recorder& record = picture.record();
            const AddGlossParams params{count(), probing.pixel_stride,
                                        static_cast<float>(scene.frame().exposure), 0};
            record("transfer.add_gloss", count(), [&](const WaitList& before) {
                return passes.add_gloss(record.queue(), params, scene, picture.gbuffer(), gloss,
                                        picture.radiance(), picture.counter(), before);
            });
        }
        return picture.end(view, solver.environment_turn());
    }

    const DeviceScene& scene;
    DynamicTransferSolver& solver;
    Picture picture;
    ReceiverPasses passes;
    TransferPasses open_pixels, open_receivers;  // storage of pictures, and of receivers
    ParallelPasses parallel;
    float threshold;
    ProbeParams probing{};
    std::vector<std::uint32_t> probes;  // pixels
    ReceiverBuffers receivers;          // at pixels
    PixelList probe_list, list;
    cl::Buffer gloss, arriving, shining, exponents, states, flags, scratch;
};

DynamicTransferView::DynamicTransferView(const Programs& programs, const cl::CommandQueue& queue,
                                         const DeviceScene& scene, DynamicTransferSolver& solver,
                                         const DynamicTransferViewOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, solver, options)) {}

DynamicTransferView::~DynamicTransferView() = default;

void DynamicTransferView::lights_changed() { state_->picture.lights_changed(); }
void DynamicTransferView::sample(std::uint32_t index) { state_->picture.sample(index); }

cl::Event DynamicTransferView::render(const Camera& camera, const WaitList& wait) {
    return state_->render(camera, wait);
}

const Picture& DynamicTransferView::picture() const { return state_->picture; }

std::uint32_t DynamicTransferView::receiver_pixels() const {
    const State& s = *state_;
    return s.some_pixels() ? s.picture.read_word(s.list.listed) : 0;
}

std::size_t DynamicTransferView::bytes() const { return state_->picture.bytes(); }

}  // namespace clgi
