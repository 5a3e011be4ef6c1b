// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/error.hpp>
#include <cmath>

#include "methods/second_order/solver_state.hpp"

namespace clgi {

using namespace second_order;

namespace {

// A distance from a tangent plane of this share of the focus's radius weighs as much as a right
// angle between normals.
constexpr float plane_distance = 0.1f;

// Kernels are built with textures only for scenes that have some.
SecondOrderOptions checked(SecondOrderOptions options, const DeviceScene& scene) {
    check(options);
    options.build.textures = options.build.textures && scene.needs_textures();
    return options;
}

}  // namespace

SecondOrderSolver::State::State(const Programs& programs, const cl::CommandQueue& on,
                                const DeviceScene& of, const SecondOrderOptions& wanted,
                                const std::vector<cl::CommandQueue>& others)
    : queue(on),
      scene(of),
      options(checked(wanted, of)),
      gbuffer(programs, options.build),
      light_passes(programs, options.build),
      image(programs, options.build),
      parallel(programs, options.build),
      emitters(scene, options.emitters),
      record(queue, "second-order") {
    for (const cl::CommandQueue& helper : others) {
        const cl::Context context = helper.getInfo<CL_QUEUE_CONTEXT>();
        if (context() != programs.context()())
            throw Error("second-order: a helper's queue is of another context, the same needed");
        const Programs own(context, helper.getInfo<CL_QUEUE_DEVICE>());
        helpers.push_back({helper, ImagePasses(own, options.build)});
        helpers.back().image.build({"gather"});
    }
    build_draw_gbuffer(gbuffer, scene);
    image.build({"combine"});
    if (options.direct && scene.environment()) image.build({"environment"});
    // Also of lights that are dark now, as buffers are.
    if (options.indirect && options.emitters.vpls > 0 && emitters.set().capacity.emitters > 0) {
        const std::vector<Light>& lights = scene.lights();
        if (std::any_of(lights.begin(), lights.end(),
                        [](const Light& light) { return light.kind == Light::Kind::spot; }))
            light_passes.build({"accept_mask", "accept_list"});
        light_passes.build({"fetch"});
        if (options.negative_vpls > 0) light_passes.build({"negative"});
        image.build({"gather"});
        if (refines(options)) {
            gbuffer.build({"downsample"});
            image.build({"count", "compact", "upsample", "place"});
            parallel.build({"offsets"});
        }
    }
    allocate(options);
}

// What is refused leaves everything as it was.
void SecondOrderSolver::State::allocate(const SecondOrderOptions& next) {
    Emitters fresh(scene, next.emitters);
    Buffers planned;
    const BufferTable plan = table(planned, fresh, scene, next, helpers.size());
    plan.check(queue.getInfo<CL_QUEUE_DEVICE>(), next.memory_budget, scene.bytes());
    for (const Helper& helper : helpers)
        plan.check(helper.queue.getInfo<CL_QUEUE_DEVICE>(), next.memory_budget, scene.bytes());
    usable = false;
    options = next;
    emitters.adopt(std::move(fresh));
    emitters.build(gbuffer);
    const BufferTable all = table(buffers, emitters, scene, options, helpers.size());
    record.forget_failed();
    all.allocate(record);
    emitters.write(record);
    record.fill(buffers.drawn.planes, 0);  // emission is written where there is some
    bytes = all.bytes();
    buffers.drawn.stride = buffers.stride;
    buffers.drawn.storage = options.build.storage;
    buffers.seen = buffers.drawn;
    usable = true;
}

// The scene as every emitter sees it, and the VPLs on what they light. [section 3.1]
void SecondOrderSolver::State::place_lights() {
    emitters.draw(record, gbuffer, buffers.camera);
    if (!indirect()) return;
    emitters.accept(record, light_passes, buffers.mask, buffers.accepted);
    const auto count = static_cast<std::uint32_t>(emitters.set().vpl_count);
    const FetchParams params{count, static_cast<std::uint32_t>(emitters.set().emitters.size()),
                             1.0f, options.footprint};
    record("lights.fetch", count, [&](const WaitList& wait) {
        return light_passes.fetch(queue, params, scene, emitters.buffers(), buffers.accepted,
                                  buffers.lights, wait);
    });
}

// I_s and I_n at every pixel. [sections 3.2, 3.3, 3.5]
void SecondOrderSolver::State::light_points(const View& view) {
    Buffers& b = buffers;
    if (options.negative_vpls > 0) place_negative(view);
    const std::size_t pixels = pixel_count(options), low_pixels = low_pixel_count(options);
    if (!refine())
        return gather(
            {"image.gather", pixels, b.stride, b.all_count, b.seen.planes, b.irradiance, 0.4, 0.9});
    const auto step = static_cast<std::uint32_t>(options.low_resolution_step);
    const RefineParams params{view.width,
                              view.height,
                              b.stride,
                              b.low_stride,
                              options.discontinuity_threshold,
                              1.0f / (plane_distance * scene.frame().detail),
                              step,
                              0};
    record("gbuffer.downsample", low_pixels, [&](const WaitList& wait) {
        return gbuffer.downsample(queue,
                                  {view.width, view.height, b.stride, b.low_stride, step, 0, 0, 0},
                                  b.seen.planes, b.low_points, wait);
    });
    gather({"image.gather_low", low_pixels, b.low_stride, b.low_count, b.low_points,
            b.low_irradiance, 0.4, 0.6});
    record("image.upsample", pixels, [&](const WaitList& wait) {
        return image.upsample(queue, params, b.seen.planes, b.low_points, b.low_irradiance,
                              b.irradiance, b.flags, wait);
    });
    if (std::isinf(options.discontinuity_threshold)) return;
    record("image.count", pixels, [&](const WaitList& wait) {
        return image.count(queue, view.width * view.height, b.flags, b.counts, wait);
    });
    const auto blocks = static_cast<std::uint32_t>((pixels + COMPACT_BLOCK - 1) / COMPACT_BLOCK);
    record("parallel.offsets", blocks, [&](const WaitList& wait) {
        return parallel.offsets(queue, blocks, b.counts, cl::Buffer(), wait);
    });
    record("image.compact", pixels, [&](const WaitList& wait) {
        return image.compact(queue, params, b.flags, b.counts, b.seen.planes, b.listed,
                             b.listed_points, b.listed_count, wait);
    });
    gather({"image.gather", pixels, b.stride, b.listed_count, b.listed_points, b.listed_irradiance,
            0.6, 0.9});
    record("image.place", pixels, [&](const WaitList& wait) {
        return image.place(queue, params, b.listed_count, b.listed, b.listed_irradiance,
                           b.irradiance, wait);
    });
}

void SecondOrderSolver::State::combine(const View& view, bool emission) {
    CombineParams params = combine_params(scene, view, buffers.stride,
                                          emitters.set().emitters.size(), Pixels::visibility);
    if (options.direct) {
        params.effects |= COMBINE_DIRECT | (emission ? COMBINE_EMISSION : 0);
        if (scene.has_lobes()) params.effects |= COMBINE_SPECULAR;
    }
    if (indirect()) params.effects |= COMBINE_INDIRECT;
    record("image.combine", pixel_count(options), [&](const WaitList& wait) {
        return image.combine(queue, params, view, scene,
                             {emitters.buffers(), buffers.seen, buffers.irradiance,
                              buffers.radiance, buffers.non_finite},
                             wait);
    });
}

cl::Event SecondOrderSolver::State::render(const Camera& camera, const GBuffer* given,
                                           const WaitList& wait, const Progress& progress) {
    if (!usable)
        throw DeviceError(
            "second-order: the last change of options found no memory; reconfigure it first");
    if (given) check_gbuffer("second-order", *given, buffers.stride, options.build.storage);
    buffers.seen = given ? *given : buffers.drawn;
    const View view = make_view(camera, scene.frame(), options.width, options.height);
    record.begin(wait, progress);
    const bool emission = scene.info().flags & SCENE_HAS_EMISSION;
    const bool empty = scene.info().triangle_count == 0;
    const bool dark = emitters.set().emitters.empty() && !emission;
    const bool background = options.direct && scene.environment();
    if (!given && (empty || dark) && !background) {  // black, without a kernel
        for (const cl::Buffer* buffer :
             {&buffers.seen.planes, &buffers.irradiance, &buffers.radiance})
            record.fill_picture(*buffer, 0);
        record.fill_picture(buffers.seen.ids, 0xffffffffu);
    } else {
        record.report(0.0);
        place_lights();
        record.report(0.2);
        if (!given)
            draw_gbuffer(record, gbuffer, scene, view, buffers.camera_view, buffers.camera,
                         buffers.seen);
        record.report(0.4);
        if (indirect()) light_points(view);
        record.report(0.9);
        combine(view, given || emission);
        if (background)
            record("image.environment", pixel_count(options), [&](const WaitList& before) {
                return image.environment(queue, environment_params(scene, buffers.stride), view,
                                         scene.environment_texels(), buffers.seen.planes,
                                         buffers.radiance, before);
            });
    }
    record.report(1.0);
    return record.last();
}

SecondOrderSolver::SecondOrderSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                                     const SecondOrderOptions& options,
                                     const std::vector<cl::CommandQueue>& helpers)
    : SecondOrderSolver(
          Programs(queue.getInfo<CL_QUEUE_CONTEXT>(), queue.getInfo<CL_QUEUE_DEVICE>()), queue,
          scene, options, helpers) {}

SecondOrderSolver::SecondOrderSolver(const Programs& programs, const cl::CommandQueue& queue,
                                     const DeviceScene& scene, const SecondOrderOptions& options,
                                     const std::vector<cl::CommandQueue>& helpers)
    : state_(std::make_unique<State>(programs, queue, scene, options, helpers)) {}

SecondOrderSolver::~SecondOrderSolver() = default;

void SecondOrderSolver::reconfigure(const SecondOrderOptions& options) {
    const SecondOrderOptions next = checked(options, state_->scene);
    if (next.build != state_->options.build)
        throw Error("second-order: other build options need another solver");
    state_->allocate(next);
}

void SecondOrderSolver::lights_changed() {
    if (!state_->usable || !state_->emitters.update(state_->options.emitters))
        return state_->allocate(state_->options);
    state_->record.forget_failed();
    state_->emitters.write(state_->record);
}

void SecondOrderSolver::set_replicate(std::uint32_t replicate) {
    state_->options.emitters.replicate = replicate;
    lights_changed();
}

void SecondOrderSolver::set_sample(std::uint32_t sample) {
    State& s = *state_;
    EmitterOptions& wanted = s.options.emitters;
    const std::uint32_t maps = sample / s.emitters.samples_a_map(pixel_count(s.options));
    if (wanted.vpl_sample == sample && wanted.sample == maps) return;
    wanted.vpl_sample = sample;
    wanted.sample = maps;
    lights_changed();
    s.emitters.keep_maps(sample > 0);
}

cl::Event SecondOrderSolver::render(const Camera& camera, const WaitList& wait) {
    return state_->render(camera, nullptr, wait, nullptr);
}

cl::Event SecondOrderSolver::render(const Camera& camera, const GBuffer& given,
                                    const WaitList& wait) {
    return state_->render(camera, &given, wait, nullptr);
}

bool SecondOrderSolver::run(const Camera& camera, const Progress& progress) {
    state_->render(camera, nullptr, {}, progress);
    state_->record.wait();
    return !state_->record.cancelled();
}

RenderStatus SecondOrderSolver::status() const {
    RenderStatus out;
    const State& s = *state_;
    if (!s.usable) return out;
    out.non_finite = s.record.read_word(s.buffers.non_finite);
    if (!s.indirect()) return out;
    const auto pixels = static_cast<std::uint32_t>(pixel_count(s.options));
    out.refined_pixels = s.refine() ? 0 : pixels;
    if (s.refine() && !std::isinf(s.options.discontinuity_threshold))
        out.refined_pixels = s.record.read_word(s.buffers.listed_count);
    out.low_resolution_share = 1.0 - static_cast<double>(out.refined_pixels) / pixels;
    return out;
}

const std::vector<PassEvent>& SecondOrderSolver::events() const { return state_->record.events(); }
Interval SecondOrderSolver::interval() const { return state_->record.interval(); }
const SecondOrderOptions& SecondOrderSolver::options() const { return state_->options; }
const EmitterSet& SecondOrderSolver::emitters() const { return state_->emitters.set(); }
std::size_t SecondOrderSolver::bytes() const { return state_->bytes; }
std::uint32_t SecondOrderSolver::stride() const { return state_->buffers.stride; }
const cl::Buffer& SecondOrderSolver::radiance() const { return state_->buffers.radiance; }
const cl::Buffer& SecondOrderSolver::irradiance() const { return state_->buffers.irradiance; }
const cl::Buffer& SecondOrderSolver::planes() const { return state_->buffers.seen.planes; }
const cl::Buffer& SecondOrderSolver::ids() const { return state_->buffers.seen.ids; }
const GBuffer& SecondOrderSolver::gbuffer() const { return state_->buffers.drawn; }
const cl::Buffer& SecondOrderSolver::vpls() const { return state_->buffers.lights; }
const cl::Buffer& SecondOrderSolver::negative_vpls() const { return state_->buffers.negative; }
const ImagePasses& SecondOrderSolver::image_passes() const { return state_->image; }

}  // namespace clgi
