// SPDX-License-Identifier: MIT
#include <clgi/solvers/second_order.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "solvers/recorder.hpp"

namespace clgi {
namespace {

// What is off a tangent plane by this share of the scene's radius weighs as much as a right angle.
constexpr float plane_distance = 0.1f;

cl::Context context_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_CONTEXT>(); }
cl::Device device_of(const cl::CommandQueue& queue) { return queue.getInfo<CL_QUEUE_DEVICE>(); }

std::uint32_t padded(std::size_t count) {
    return static_cast<std::uint32_t>((count + 15) / 16 * 16);
}

std::size_t pixel_count(const SecondOrderOptions& options) {
    return static_cast<std::size_t>(options.width) * options.height;
}

std::size_t low_pixel_count(const SecondOrderOptions& options) {
    return static_cast<std::size_t>((options.width + 1) / 2) * ((options.height + 1) / 2);
}

void check(const SecondOrderOptions& options) {
    const auto in = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(std::string("second-order: ") + name + " is " + std::to_string(value) +
                        ", " + std::to_string(low) + " to " + std::to_string(high) + " needed");
    };
    in("width", options.width, 1, 16384);
    in("height", options.height, 1, 16384);
    in("negative_lights", options.negative_lights, 0, 1 << 20);
    in("footprint", options.footprint, 0, 1e6);
    if (!(options.discontinuity_threshold >= 0.0f))
        throw Error("second-order: discontinuity_threshold is negative or not a number");
}

// Kernels are built with textures only where the scene calls for them.
SecondOrderOptions checked(SecondOrderOptions options, const DeviceScene& scene) {
    check(options);
    options.build.textures = options.build.textures && scene.needs_textures();
    return options;
}

bool refines(const SecondOrderOptions& options) {
    return options.low_resolution && options.discontinuity_threshold > 0.0f;
}

// Sizes in bytes of every buffer that a frame works with; 0: not needed.
struct Sizes {
    std::size_t vertices, polygons, source_visibility, camera_visibility, planes, ids, mask,
        accepted, lights, negative, low_points, low_irradiance, flags, counts, listed,
        listed_points, listed_irradiance, irradiance, radiance;

    std::size_t sum() const {
        return vertices + polygons + source_visibility + camera_visibility + planes + ids + mask +
               accepted + lights + negative + low_points + low_irradiance + flags + counts +
               listed + listed_points + listed_irradiance + irradiance + radiance;
    }
};

Sizes sizes(const DeviceScene& scene, const SecondOrderOptions& options, const EmitterSet& set) {
    const std::size_t stride = padded(pixel_count(options));
    const std::size_t low_stride = padded(low_pixel_count(options));
    const bool lit = options.indirect && set.light_count > 0;
    const bool refine = lit && refines(options);
    const std::size_t negative = lit ? options.negative_lights : 0;
    std::uint32_t candidates = 0;
    for (const std::uint32_t count : set.candidates) candidates = std::max(candidates, count);
    Sizes out{};
    out.vertices = scene.info().vertex_count * sizeof(ScreenVertex);
    out.polygons = scene.info().triangle_count * sizeof(RasterPolygon);
    out.source_visibility = set.pixels * sizeof(std::uint64_t);
    out.camera_visibility = pixel_count(options) * sizeof(std::uint64_t);
    out.planes = GBUFFER_PLANES * stride * sizeof(float);
    out.ids = GBUFFER_ID_PLANES * stride * sizeof(std::int32_t);
    out.radiance = RADIANCE_PLANES * stride * sizeof(float);
    if (!lit) return out;
    out.mask = candidates / 8;
    out.accepted = set.light_count * sizeof(std::uint32_t);
    out.lights = set.light_count * sizeof(IndirectLight);
    out.negative = negative * sizeof(IndirectLight);
    out.irradiance = IRRADIANCE_PLANES * stride * sizeof(float);
    if (!refine) return out;
    out.low_points = POINT_PLANES * low_stride * sizeof(float);
    out.low_irradiance = IRRADIANCE_PLANES * low_stride * sizeof(float);
    out.flags = pixel_count(options);
    out.counts = (pixel_count(options) / COMPACT_BLOCK + 1) * sizeof(std::uint32_t);
    out.listed = stride * sizeof(std::uint32_t);
    out.listed_points = POINT_PLANES * stride * sizeof(float);
    out.listed_irradiance = IRRADIANCE_PLANES * stride * sizeof(float);
    return out;
}

}  // namespace

Estimate estimate(const DeviceScene& scene, const SecondOrderOptions& options) {
    check(options);
    const EmitterSet set = make_emitters(scene, options.sources);
    Estimate out;
    out.bytes = sizes(scene, options, set).sum();
    // A nominal device: one pair of light and point takes about 20 nanoseconds of one gigahertz
    // lane, a triangle drawn 100, a pixel resolved and combined 150.
    const double pixels = static_cast<double>(pixel_count(options));
    const double lit = refines(options) ? 0.25 + 0.15 : 1.0;
    const double lights = static_cast<double>(set.light_count) + options.negative_lights;
    const double triangles =
        static_cast<double>(scene.info().triangle_count) * static_cast<double>(set.views.size() + 1);
    out.milliseconds = 1e-6 * (pixels * lit * (options.indirect ? lights : 0.0) * 0.25 +
                               triangles * 30.0 + pixels * 20.0);
    return out;
}

SecondOrderSolver::SecondOrderSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                                     const SecondOrderOptions& options)
    : queue_(queue),
      scene_(scene),
      options_(checked(options, scene)),
      gbuffer_(context_of(queue), device_of(queue), options_.build),
      light_passes_(context_of(queue), device_of(queue), options_.build),
      image_(context_of(queue), device_of(queue), options_.build) {
    stride_ = padded(pixel_count(options_));
    low_stride_ = padded(low_pixel_count(options_));
    allocate();
}

void SecondOrderSolver::lights_changed() {
    const EmitterSet before = set_;
    set_ = make_emitters(scene_, options_.sources);
    const bool same_shape = set_.pixels == before.pixels && set_.light_count == before.light_count &&
                            set_.emitters.size() == before.emitters.size() &&
                            set_.candidates == before.candidates;
    if (!same_shape) return allocate();
    if (set_.emitters.empty()) return;
    queue_.enqueueWriteBuffer(sources_.emitters, CL_TRUE, 0, set_.emitters.size() * sizeof(Emitter),
                              set_.emitters.data());
    queue_.enqueueWriteBuffer(sources_.views, CL_TRUE, 0, set_.views.size() * sizeof(View),
                              set_.views.data());
}

void SecondOrderSolver::allocate() {
    set_ = make_emitters(scene_, options_.sources);
    indirect_ = options_.indirect && set_.light_count > 0;
    refine_ = indirect_ && refines(options_);
    const Sizes size = sizes(scene_, options_, set_);
    const cl::Context context = context_of(queue_);
    const std::size_t most = device_of(queue_).getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    bytes_ = 0;
    const auto buffer = [&](std::size_t bytes) {
        bytes = std::max<std::size_t>(bytes, 16);
        bytes_ += bytes;
        if (bytes > most)
            throw DeviceError("second-order: a buffer of " + std::to_string(bytes) +
                              " bytes is needed, the device allows " + std::to_string(most));
        try {
            return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: no room for a buffer of " + std::to_string(bytes) +
                              " bytes (OpenCL error " + std::to_string(error.err()) + ")");
        }
    };
    const auto filled = [&](const void* data, std::size_t bytes) {
        cl::Buffer out = buffer(bytes);
        if (bytes > 0) queue_.enqueueWriteBuffer(out, CL_TRUE, 0, bytes, data);
        return out;
    };
    const auto word = [&](std::size_t value) {
        const std::uint32_t number = static_cast<std::uint32_t>(value);
        return filled(&number, sizeof number);
    };
    raster_.vertices = buffer(size.vertices);
    raster_.polygons = buffer(size.polygons);
    raster_.polygon_count = word(0);
        camera_visibility_ = buffer(size.camera_visibility);
    sources_.visibility = buffer(size.source_visibility);
    sources_.emitters = filled(set_.emitters.data(), set_.emitters.size() * sizeof(Emitter));
    sources_.views = filled(set_.views.data(), set_.views.size() * sizeof(View));
    planes_ = buffer(size.planes);
    ids_ = buffer(size.ids);
    radiance_ = buffer(size.radiance);
    non_finite_ = word(0);
    irradiance_ = buffer(size.irradiance);
    mask_ = buffer(size.mask);
    accepted_ = buffer(size.accepted);
    lights_ = buffer(size.lights);
    negative_ = buffer(size.negative);
    all_count_ = word(pixel_count(options_));
    low_count_ = word(low_pixel_count(options_));
    listed_count_ = word(0);
    low_points_ = buffer(size.low_points);
    low_irradiance_ = buffer(size.low_irradiance);
    flags_ = buffer(size.flags);
    counts_ = buffer(size.counts);
    listed_ = buffer(size.listed);
    listed_points_ = buffer(size.listed_points);
    listed_irradiance_ = buffer(size.listed_irradiance);
}

void SecondOrderSolver::draw_view(Recorder& record, const View& view,
                                  const cl::Buffer& visibility) {
    RasterBuffers buffers = raster_;
    buffers.visibility = visibility;
    const std::size_t triangles = scene_.info().triangle_count;
    record("gbuffer.clear", view.width * view.height, [&](const WaitList& wait) {
        return gbuffer_.clear(queue_, view, buffers, wait);
    });
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
    for (const View& view : set_.views) draw_view(record, view, sources_.visibility);
    if (!indirect_) return;
    for (std::size_t e = 0; e < set_.emitters.size(); ++e) {
        if (set_.candidates[e] == 0) continue;
        const AcceptParams params{static_cast<std::uint32_t>(e), set_.candidates[e], 0, 0};
        record("lights.accept_mask", params.candidate_count, [&](const WaitList& wait) {
            return light_passes_.accept_mask(queue_, params, sources_.emitters, mask_, wait);
        });
        record("lights.accept_list", params.candidate_count, [&](const WaitList& wait) {
            return light_passes_.accept_list(queue_, params, sources_.emitters, mask_, accepted_,
                                             wait);
        });
    }
    const FetchParams params{static_cast<std::uint32_t>(set_.light_count),
                             static_cast<std::uint32_t>(set_.emitters.size()), 1.0f, 0};
    record("lights.fetch", params.light_count, [&](const WaitList& wait) {
        return light_passes_.fetch(queue_, params, scene_, sources_, accepted_, lights_, wait);
    });
}

void SecondOrderSolver::draw_camera(Recorder& record, const View& view) {
    draw_view(record, view, camera_visibility_);
    ResolveParams params{stride_, RESOLVE_GEOMETRIC, 0, 0};
    if (scene_.info().flags & SCENE_HAS_EMISSION) params.write |= RESOLVE_EMISSION;
    record("gbuffer.resolve", pixel_count(options_), [&](const WaitList& wait) {
        return gbuffer_.resolve(queue_, view, scene_, params, camera_visibility_, planes_, ids_,
                                wait);
    });
}

GatherParams SecondOrderSolver::gather_params(std::uint32_t stride) const {
    return {stride, static_cast<std::uint32_t>(set_.light_count),
            static_cast<std::uint32_t>(options_.negative_lights), options_.footprint};
}

// I_s and I_n at every pixel. [sections 3.2, 3.3, 3.5]
void SecondOrderSolver::light_points(Recorder& record, const View& view) {
    if (options_.negative_lights > 0) {
        // Behind by less than the spacing of floats across the scene is not behind.
        const NegativeParams params{static_cast<std::uint32_t>(set_.light_count),
                                    static_cast<std::uint32_t>(options_.negative_lights), stride_,
                                    16.0f * 5.96e-8f * (2.0f * scene_.frame().radius)};
        record("lights.negative", params.negative_count, [&](const WaitList& wait) {
            return light_passes_.negative(queue_, params, view, planes_, lights_, negative_, wait);
        });
    }
    const std::size_t pixels = pixel_count(options_);
    if (!refine_) {
        record("image.gather", pixels, [&](const WaitList& wait) {
            return image_.gather(queue_, gather_params(stride_), pixels, all_count_, planes_,
                                 lights_, negative_, irradiance_, wait);
        });
        return;
    }

    const auto width = static_cast<std::uint32_t>(options_.width);
    const auto height = static_cast<std::uint32_t>(options_.height);
    const std::size_t low_pixels = low_pixel_count(options_);
    const RefineParams params{width,
                              height,
                              stride_,
                              low_stride_,
                              options_.discontinuity_threshold,
                              1.0f / (plane_distance * scene_.frame().radius),
                              0,
                              0};
    record("gbuffer.downsample", low_pixels, [&](const WaitList& wait) {
        return gbuffer_.downsample(queue_, {width, height, stride_, low_stride_}, planes_,
                                   low_points_, wait);
    });
    record("image.gather_low", low_pixels, [&](const WaitList& wait) {
        return image_.gather(queue_, gather_params(low_stride_), low_pixels, low_count_,
                             low_points_, lights_, negative_, low_irradiance_, wait);
    });
    record("image.upsample", pixels, [&](const WaitList& wait) {
        return image_.upsample(queue_, params, planes_, low_points_, low_irradiance_, irradiance_,
                               flags_, wait);
    });
    if (std::isinf(options_.discontinuity_threshold)) return;
    record("image.count", pixels, [&](const WaitList& wait) {
        return image_.count(queue_, width * height, flags_, counts_, wait);
    });
    record("image.compact", pixels, [&](const WaitList& wait) {
        return image_.compact(queue_, params, flags_, counts_, planes_, listed_, listed_points_,
                              listed_count_, wait);
    });
    record("image.gather", pixels, [&](const WaitList& wait) {
        return image_.gather(queue_, gather_params(stride_), pixels, listed_count_, listed_points_,
                             lights_, negative_, listed_irradiance_, wait);
    });
    record("image.place", pixels, [&](const WaitList& wait) {
        return image_.place(queue_, params, listed_count_, listed_, listed_irradiance_,
                            irradiance_, wait);
    });
}

void SecondOrderSolver::combine(Recorder& record, const View& view) {
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
        if (scene_.info().flags & SCENE_HAS_EMISSION) params.effects |= COMBINE_EMISSION;
    }
    if (indirect_) params.effects |= COMBINE_INDIRECT;
    record("image.combine", pixel_count(options_), [&](const WaitList& wait) {
        return image_.combine(queue_, params, view, scene_, sources_, planes_, ids_, irradiance_,
                              radiance_, non_finite_, wait);
    });
}

cl::Event SecondOrderSolver::frame(const Camera& camera, const Progress& progress,
                                   bool& cancelled) {
    Recorder record(queue_, events_);
    const View view = make_view(camera, scene_.frame(), options_.width, options_.height);
    cancelled = false;
    const auto go_on = [&](double done) {
        if (!progress || cancelled) return !cancelled;
        if (record.last()()) record.last().wait();
        cancelled = !progress(done);
        return !cancelled;
    };
    const bool empty = scene_.info().triangle_count == 0;
    const bool dark = set_.emitters.empty() && !(scene_.info().flags & SCENE_HAS_EMISSION);
    if (empty || dark) {
        // Nothing to see, or nothing that shines: black, without a kernel.
        cl::Event event;
        queue_.enqueueFillBuffer(radiance_, 0.0f, 0, RADIANCE_PLANES * stride_ * sizeof(float),
                                 nullptr, &event);
        go_on(1.0);
        return event;
    }
    if (go_on(0.0)) place_lights(record);
    if (go_on(0.2)) draw_camera(record, view);
    if (go_on(0.4) && indirect_) light_points(record, view);
    if (go_on(0.9)) combine(record, view);
    go_on(1.0);
    return record.last();
}

cl::Event SecondOrderSolver::render(const Camera& camera) {
    bool cancelled = false;
    return frame(camera, nullptr, cancelled);
}

bool SecondOrderSolver::run(const Camera& camera, const Progress& progress) {
    bool cancelled = false;
    cl::Event event = frame(camera, progress, cancelled);
    if (event()) event.wait();
    return !cancelled;
}

FrameStatus SecondOrderSolver::status() const {
    FrameStatus out;
    queue_.enqueueReadBuffer(non_finite_, CL_TRUE, 0, sizeof out.non_finite, &out.non_finite);
    if (!indirect_) return out;
    const auto pixels = static_cast<std::uint32_t>(pixel_count(options_));
    out.refined_pixels = refine_ ? 0 : pixels;
    if (refine_ && !std::isinf(options_.discontinuity_threshold))
        queue_.enqueueReadBuffer(listed_count_, CL_TRUE, 0, sizeof out.refined_pixels,
                                 &out.refined_pixels);
    out.low_resolution_share = 1.0 - static_cast<double>(out.refined_pixels) / pixels;
    return out;
}

}  // namespace clgi
