// SPDX-License-Identifier: MIT
#include <clgi/solvers/second_order.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "lights/replicate.hpp"
#include "opencl/error_text.hpp"
#include "solvers/recorder.hpp"
#include "solvers/second_order_sizes.hpp"

namespace clgi {

using namespace second_order;

namespace {

// What is off a tangent plane by this share of the scene's radius weighs as much as a right angle.
constexpr float plane_distance = 0.1f;

cl::Context context_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_CONTEXT>(); }
cl::Device device_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_DEVICE>(); }

// What OpenCL throws becomes a DeviceError that says what was being done.
template <typename Work>
void on_device(const char* what, Work&& work) {
    try {
        work();
    } catch (const cl::Error& error) {
        throw DeviceError("second-order: " + std::string(what) + ": " + error_text(error.err()));
    }
}

// Kernels are built with textures only where the scene calls for them.
SecondOrderOptions checked(SecondOrderOptions options, const DeviceScene& scene) {
    check(options);
    options.build.textures = options.build.textures && scene.needs_textures();
    options.build.environment = options.build.environment && scene.environment().has_value();
    return options;
}

}  // namespace

SecondOrderSolver::SecondOrderSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                                     const SecondOrderOptions& options,
                                     const std::vector<cl::CommandQueue>& helpers)
    : queue_(queue),
      scene_(scene),
      options_(checked(options, scene)),
      gbuffer_(context_of(queue), device_of(queue), options_.build),
      light_passes_(context_of(queue), device_of(queue), options_.build),
      image_(context_of(queue), device_of(queue), options_.build),
      parallel_(context_of(queue), device_of(queue), options_.build, {false, false, false, false}) {
    for (const cl::CommandQueue& helper : helpers) {
        if (context_of(helper)() != context_of(queue)())
            throw Error("second-order: a helper's queue is of another context, the same needed");
        helpers_.push_back(
            {helper, ImagePasses(context_of(helper), device_of(helper), options_.build), {}});
    }
    allocate(options_, make_emitters(scene_, options_.sources));
}

void SecondOrderSolver::reconfigure(const SecondOrderOptions& options) {
    const SecondOrderOptions next = checked(options, scene_);
    if (next.build != options_.build)
        throw Error("second-order: other build options need another solver");
    allocate(next, make_emitters(scene_, next.sources));
}

// Waiting for what has failed would fail again.
void SecondOrderSolver::forget_failed_frame() {
    const auto failed = [](const cl::Event& event) {
        return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() < 0;
    };
    frame_end_.erase(std::remove_if(frame_end_.begin(), frame_end_.end(), failed),
                     frame_end_.end());
}

void SecondOrderSolver::lights_changed() {
    forget_failed_frame();
    EmitterSet next = make_emitters(scene_, options_.sources);
    const bool same_shape = usable_ && next.pixels == set_.pixels &&
                            next.light_count == set_.light_count &&
                            next.emitters.size() == set_.emitters.size() &&
                            next.candidates == set_.candidates;
    if (!same_shape) return allocate(options_, std::move(next));
    set_ = std::move(next);
    if (set_.emitters.empty()) return;
    on_device("the sources cannot be written", [&] {
        queue_.enqueueWriteBuffer(sources_.emitters, CL_TRUE, 0,
                                  set_.emitters.size() * sizeof(Emitter), set_.emitters.data(),
                                  &frame_end_);
        queue_.enqueueWriteBuffer(sources_.views, CL_TRUE, 0, set_.views.size() * sizeof(View),
                                  set_.views.data(), &frame_end_);
    });
}

void SecondOrderSolver::set_replicate(std::uint32_t replicate) {
    options_.sources.replicate = replicate;
    lights_changed();
}

void SecondOrderSolver::draw_view(Recorder& record, const View& view,
                                  const cl::Buffer& visibility) {
    RasterBuffers buffers = raster_;
    buffers.visibility = visibility;
    const std::size_t triangles = scene_.info().triangle_count;
    record("gbuffer.clear", view.width * view.height,
           [&](const WaitList& wait) { return gbuffer_.clear(queue_, view, buffers, wait); });
    record("gbuffer.transform", scene_.info().vertex_count, [&](const WaitList& wait) {
        return gbuffer_.transform(queue_, view, scene_, buffers, wait);
    });
    const auto raster = [&](std::uint32_t stage) {
        record("gbuffer.raster", triangles, [&](const WaitList& wait) {
            return gbuffer_.raster(queue_, view, scene_, stage, buffers, wait);
        });
    };
    if (gbuffer_.fused()) {
        raster(RASTER_FUSED);
    } else {
        raster(RASTER_DEPTH);
        raster(RASTER_IDENTITY);
    }
    record("gbuffer.raster_large", triangles, [&](const WaitList& wait) {
        return gbuffer_.raster_large(queue_, view, scene_, buffers, wait);
    });
}

// The scene as every source sees it, and the indirect lights on what they light. [section 3.1]
void SecondOrderSolver::place_lights(Recorder& record) {
    for (std::size_t v = 0; v < set_.views.size(); ++v) {
        draw_view(record, set_.views[v], sources_.visibility);
        record.report(0.2 * static_cast<double>(v + 1) / static_cast<double>(set_.views.size()));
    }
    if (!indirect_) return;
    for (std::size_t e = 0; e < set_.emitters.size(); ++e) {
        if (set_.candidates[e] == 0) continue;
        const AcceptParams params{static_cast<std::uint32_t>(e), set_.candidates[e],
                                  static_cast<std::uint32_t>(set_.light_count), 0};
        record("lights.accept_mask", params.candidate_count, [&](const WaitList& wait) {
            return light_passes_.accept_mask(queue_, params, sources_.emitters, mask_, wait);
        });
        record("lights.accept_list", params.candidate_count, [&](const WaitList& wait) {
            return light_passes_.accept_list(queue_, params, sources_.emitters, mask_, accepted_,
                                             wait);
        });
    }
    const FetchParams params{static_cast<std::uint32_t>(set_.light_count),
                             static_cast<std::uint32_t>(set_.emitters.size()), 1.0f,
                             options_.footprint};
    record("lights.fetch", params.light_count, [&](const WaitList& wait) {
        return light_passes_.fetch(queue_, params, scene_, sources_, accepted_, lights_, wait);
    });
}

void SecondOrderSolver::draw_camera(Recorder& record, const View& view) {
    draw_view(record, view, camera_visibility_);
    ResolveParams params{stride_, RESOLVE_GEOMETRIC, 0, 0};
    if (scene_.info().flags & SCENE_HAS_EMISSION) params.write |= RESOLVE_EMISSION;
    record("gbuffer.resolve", pixel_count(options_), [&](const WaitList& wait) {
        return gbuffer_.resolve(queue_, view, scene_, params, camera_visibility_, seen_.planes,
                                seen_.ids, wait);
    });
}

// I_s and I_n at every pixel. [sections 3.2, 3.3, 3.5]
void SecondOrderSolver::light_points(Recorder& record, const View& view) {
    if (options_.negative_lights > 0) {
        const std::uint32_t replicate = options_.sources.replicate;
        // Behind by less than the spacing of floats across the scene is not behind.
        const NegativeParams params{static_cast<std::uint32_t>(set_.light_count),
                                    static_cast<std::uint32_t>(options_.negative_lights),
                                    stride_,
                                    16.0f * 5.96e-8f * (2.0f * scene_.frame().radius),
                                    options_.footprint,
                                    replicate_shift(replicate, ShiftUse::image, 0),
                                    replicate_shift(replicate, ShiftUse::image, 1),
                                    0};
        place_negative(record, params, view);
    }
    const std::size_t pixels = pixel_count(options_);
    if (!refine_) {
        gather(record,
               {"image.gather", pixels, stride_, all_count_, seen_.planes, irradiance_, 0.4, 0.9});
        return;
    }

    const auto width = static_cast<std::uint32_t>(options_.width);
    const auto height = static_cast<std::uint32_t>(options_.height);
    const auto step = static_cast<std::uint32_t>(options_.low_resolution_step);
    const std::size_t low_pixels = low_pixel_count(options_);
    const RefineParams params{width,
                              height,
                              stride_,
                              low_stride_,
                              options_.discontinuity_threshold,
                              1.0f / (plane_distance * scene_.frame().radius),
                              step,
                              0};
    record("gbuffer.downsample", low_pixels, [&](const WaitList& wait) {
        return gbuffer_.downsample(queue_, {width, height, stride_, low_stride_, step, 0, 0, 0},
                                   seen_.planes, low_points_, wait);
    });
    gather(record, {"image.gather_low", low_pixels, low_stride_, low_count_, low_points_,
                    low_irradiance_, 0.4, 0.6});
    record("image.upsample", pixels, [&](const WaitList& wait) {
        return image_.upsample(queue_, params, seen_.planes, low_points_, low_irradiance_,
                               irradiance_, flags_, wait);
    });
    if (std::isinf(options_.discontinuity_threshold)) return;
    record("image.count", pixels, [&](const WaitList& wait) {
        return image_.count(queue_, width * height, flags_, counts_, wait);
    });
    const auto blocks = static_cast<std::uint32_t>((pixels + COMPACT_BLOCK - 1) / COMPACT_BLOCK);
    record("parallel.offsets", blocks, [&](const WaitList& wait) {
        return parallel_.offsets(queue_, blocks, counts_, cl::Buffer(), wait);
    });
    record("image.compact", pixels, [&](const WaitList& wait) {
        return image_.compact(queue_, params, flags_, counts_, seen_.planes, listed_,
                              listed_points_, listed_count_, wait);
    });
    gather(record, {"image.gather", pixels, stride_, listed_count_, listed_points_,
                    listed_irradiance_, 0.6, 0.9});
    record("image.place", pixels, [&](const WaitList& wait) {
        return image_.place(queue_, params, listed_count_, listed_, listed_irradiance_, irradiance_,
                            wait);
    });
}

void SecondOrderSolver::combine(Recorder& record, const View& view, bool emission) {
    CombineParams params{};
    params.width = view.width;
    params.height = view.height;
    params.stride = stride_;
    params.emitter_count = static_cast<std::uint32_t>(set_.emitters.size());
    params.exposure = static_cast<float>(scene_.frame().exposure);
    params.texel_bias = 1.0f;
    if (options_.direct) {
        params.effects |= COMBINE_DIRECT;
        if (scene_.has_lobes()) params.effects |= COMBINE_SPECULAR;
        if (emission) params.effects |= COMBINE_EMISSION;
    }
    if (indirect_) params.effects |= COMBINE_INDIRECT;
    record("image.combine", pixel_count(options_), [&](const WaitList& wait) {
        return image_.combine(queue_, params, view, scene_, sources_, seen_.planes, seen_.ids,
                              irradiance_, radiance_, non_finite_, wait);
    });
}

// What the environment sends where nothing stands before it.
void SecondOrderSolver::fill_background(Recorder& record, const View& view) {
    const Environment& environment = *scene_.environment();
    const double turns = double{environment.rotation} / glm::two_pi<double>();
    const EnvironmentParams params{glm::vec4(environment.factor, 0.0f),
                                   static_cast<std::uint32_t>(environment.width),
                                   static_cast<std::uint32_t>(environment.height), stride_,
                                   static_cast<float>(turns - std::floor(turns))};
    record("image.environment", pixel_count(options_), [&](const WaitList& wait) {
        return image_.environment(queue_, params, view, scene_.environment_texels(), seen_.planes,
                                  radiance_, wait);
    });
}

// Nothing to see, or nothing that shines: black, without a kernel.
void SecondOrderSolver::black_frame(const WaitList& wait) {
    frame_end_.insert(frame_end_.end(), wait.begin(), wait.end());
    const auto fill = [&](const cl::Buffer& buffer, auto value) {
        cl::Event event;
        const std::size_t bytes = buffer.getInfo<CL_MEM_SIZE>() / sizeof value * sizeof value;
        queue_.enqueueFillBuffer(buffer, value, 0, bytes, &frame_end_, &event);
        frame_end_.assign(1, event);
        fills_.push_back(event);
    };
    on_device("the black frame cannot be filled", [&] {
        for (const cl::Buffer* buffer : {&seen_.planes, &irradiance_, &radiance_})
            fill(*buffer, 0.0f);
        fill(seen_.ids, std::int32_t{-1});
    });
}

void SecondOrderSolver::check_given(const GBuffer& given) const {
    if (given.stride != stride_)
        throw Error("second-order: the G-buffer's stride is " + std::to_string(given.stride) +
                    ", " + std::to_string(stride_) + " needed");
    if (given.storage != options_.build.storage)
        throw Error(std::string("second-order: the G-buffer's planes are ") +
                    (given.storage == Storage::half ? "half" : "full") +
                    " storage, the solver's own (BuildOptions::storage) needed");
    const auto holds = [](const char* what, const cl::Buffer& buffer, std::size_t needed) {
        const std::size_t held = buffer() ? buffer.getInfo<CL_MEM_SIZE>() : 0;
        if (held < needed)
            throw Error(std::string("second-order: the G-buffer's ") + what + " hold " +
                        std::to_string(held) + " bytes, " + std::to_string(needed) + " needed");
    };
    holds("planes", given.planes, gbuffer_bytes(options_.build.storage, stride_));
    holds("ids", given.ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * stride_);
}

cl::Event SecondOrderSolver::frame(const Camera& camera, const GBuffer* given,
                                   const WaitList& wait, const Progress& progress,
                                   bool& cancelled) {
    if (!usable_)
        throw DeviceError(
            "second-order: the last change of options found no memory; reconfigure it first");
    if (given) check_given(*given);
    seen_ = given ? *given : drawn_;
    const View view = make_view(camera, scene_.frame(), options_.width, options_.height);
    forget_failed_frame();
    fills_.clear();
    Recorder record(wait, frame_end_, events_, progress);
    const bool empty = scene_.info().triangle_count == 0;
    const bool dark = set_.emitters.empty() && !(scene_.info().flags & SCENE_HAS_EMISSION);
    const bool background = options_.direct && scene_.environment();
    if (!given && (empty || dark) && !background) {
        black_frame(wait);
    } else {
        record.report(0.0);
        place_lights(record);
        record.report(0.2);
        if (!given) draw_camera(record, view);
        record.report(0.4);
        if (indirect_) light_points(record, view);
        record.report(0.9);
        combine(record, view, given || (scene_.info().flags & SCENE_HAS_EMISSION));
        if (background) fill_background(record, view);
    }
    record.report(1.0);
    cancelled = record.cancelled();
    return record.last();
}

cl::Event SecondOrderSolver::render(const Camera& camera, const WaitList& wait) {
    bool cancelled = false;
    return frame(camera, nullptr, wait, nullptr, cancelled);
}

cl::Event SecondOrderSolver::render(const Camera& camera, const GBuffer& given,
                                    const WaitList& wait) {
    bool cancelled = false;
    return frame(camera, &given, wait, nullptr, cancelled);
}

bool SecondOrderSolver::run(const Camera& camera, const Progress& progress) {
    bool cancelled = false;
    const cl::Event event = frame(camera, nullptr, {}, progress, cancelled);
    if (event()) on_device("the frame failed on the device", [&] { event.wait(); });
    return !cancelled;
}

Interval SecondOrderSolver::interval() const {
    WaitList all = fills_;
    // Helpers' clocks are their own; what they did lies between two of this queue's commands.
    for (const PassEvent& pass : events_)
        if (pass.event.getInfo<CL_EVENT_COMMAND_QUEUE>()() == queue_()) all.push_back(pass.event);
    return clgi::interval(all);
}

FrameStatus SecondOrderSolver::status() const {
    FrameStatus out;
    if (!usable_) return out;
    const auto read = [&](const cl::Buffer& buffer) {
        std::uint32_t word = 0;
        on_device("the frame's status cannot be read", [&] {
            queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, sizeof word, &word, &frame_end_);
        });
        return word;
    };
    out.non_finite = read(non_finite_);
    if (!indirect_) return out;
    const auto pixels = static_cast<std::uint32_t>(pixel_count(options_));
    out.refined_pixels = refine_ ? 0 : pixels;
    if (refine_ && !std::isinf(options_.discontinuity_threshold))
        out.refined_pixels = read(listed_count_);
    out.low_resolution_share = 1.0 - static_cast<double>(out.refined_pixels) / pixels;
    return out;
}

}  // namespace clgi
