// Second-order illumination: one diffuse bounce of every light, approximately shadowed by
// negative lights.                                                            [Cochran07]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/emitters.hpp>
#include <clgi/interval.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/passes/parallel.hpp>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace clgi {

struct SecondOrderOptions {
    int width = 640;  // pixels
    int height = 480;
    EmitterOptions sources;     // sources.lights is N, the number of indirect lights
    int negative_lights = 100;  // samples of the image that take light away; 0: none
    // Every n-th pixel of every n-th row is lit first, 2 or 4, and the others interpolated where
    // that suits. 1: every pixel is lit in full.
    int low_resolution_step = 4;
    // Differences from the interpolation points at which a pixel is lit in full: 1 is a right
    // angle between normals. 0: every pixel; infinity: none.
    float discontinuity_threshold = 0.02f;
    float footprint = 1.0f;  // scales the disc that bounds each indirect light; 0: bare 1/d^2
    bool direct = true;
    bool indirect = true;
    // Bytes that the solver's buffers may take together; 0: what the device has beside the scene.
    std::size_t memory_budget = 0;
    BuildOptions build;
};

// What a frame will take, before any of it is allocated.
struct Estimate {
    std::size_t bytes = 0;      // of all buffers, the scene left out: exact
    double milliseconds = 0.0;  // a rough guess from clock, units and lanes of the device
};

// What a frame found out.
struct FrameStatus {
    std::uint32_t non_finite = 0;       // packets of pixels that had to be mended, since the start
    std::uint32_t refined_pixels = 0;   // lit in full by the discontinuity test
    double low_resolution_share = 0.0;  // of all pixels, [0,1]
};

struct PassEvent {
    std::string name;   // "image.gather"
    std::size_t items;  // what it worked on: triangles, pixels, lights
    cl::Event event;
};

// Called between the parts of a frame with the share done, [0,1]; false cancels the frame.
using Progress = std::function<bool(double done)>;

// devices: how many share the work, the solver's own and its helpers'.
CLGI_API Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                           const SecondOrderOptions& options, std::size_t devices = 1);

struct Share;  // host/solvers/ranges.hpp

// Owns its buffers, works on the given queue (in order or not), never finishes it. The scene must
// outlive the solver. One solver is used by one thread at a time.
class CLGI_API SecondOrderSolver {
public:
    // Builds kernels and allocates. helpers: queues of other devices of the same context that take
    // a share of the gather; the picture is the same, bit for bit, where their arithmetic is.
    // Throws Error for options out of range, DeviceError when the device cannot; when memory does
    // not suffice it says so before it allocates, and which option to lower.
    SecondOrderSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                      const SecondOrderOptions& options = {},
                      const std::vector<cl::CommandQueue>& helpers = {});

    SecondOrderSolver(const SecondOrderSolver&) = delete;
    SecondOrderSolver& operator=(const SecondOrderSolver&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light.
    void lights_changed();

    // Other options with the same kernels. Throws Error for options out of range, and for build
    // options that are not those of the constructor; DeviceError as the constructor does. What is
    // refused before anything is allocated leaves the solver as it was.
    void reconfigure(const SecondOrderOptions& options);

    // Another randomised shift of all low-discrepancy points (EmitterOptions::replicate).
    void set_replicate(std::uint32_t replicate);

    // Enqueues a whole frame that begins after `wait`; the event completes when all of it has.
    // Where nothing can be lit, and no environment seen, no kernel runs.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // The same, with what the camera sees given instead of drawn: planes of the solver's stride and
    // size, as include/clgi/shared/gbuffer.h states them. Their material ids are the scene's, or
    // -1; emission counts. Sources and shadows are those of the scene; an empty one has none. The
    // planes are read until the returned event is complete. A G-buffer of one's own may be given,
    // or gbuffer(), filled from outside. Throws Error when it is too small.
    cl::Event render(const Camera& camera, const GBuffer& given, const WaitList& wait = {});

    // render(camera), waiting after each part to report. False when progress cancelled. Parts that look
    // at very many lights are dispatches of about 100 ms at most; drawing and combining are one each.
    bool run(const Camera& camera, const Progress& progress);

    // Passes of the last frame, for profiling.
    const std::vector<PassEvent>& events() const { return events_; }

    // From the first command of the last frame to its end; the event of render() has the times of
    // the last command alone. Throws Error before the frame has ended, and without profiling.
    Interval interval() const;

    // Waits for the queue and reads a few words back.
    FrameStatus status() const;

    const SecondOrderOptions& options() const { return options_; }
    const EmitterSet& sources() const { return set_; }
    std::size_t bytes() const { return bytes_; }      // allocated
    std::uint32_t stride() const { return stride_; }  // floats between planes

    // Results, valid when the frame's event is complete. Planes are `stride` floats apart.
    const cl::Buffer& radiance() const { return radiance_; }  // [RADIANCE_PLANES][stride] cd/m^2
    const cl::Buffer& irradiance() const {
        return irradiance_;
    }                                                     // [IRRADIANCE_PLANES][stride], exposed
    const cl::Buffer& planes() const { return seen_.planes; }  // [GBUFFER_PLANES][stride]
    const cl::Buffer& ids() const { return seen_.ids; }        // [GBUFFER_ID_PLANES][stride]
    const GBuffer& gbuffer() const { return drawn_; }  // the solver's own, written by render(camera)
    const cl::Buffer& indirect_lights() const { return lights_; }  // [N] IndirectLight
    const cl::Buffer& negative_lights() const { return negative_; }
    const ImagePasses& image_passes() const { return image_; }

private:
    class Recorder;
    struct Helper {
        cl::CommandQueue queue;
        ImagePasses image;
        cl::Buffer irradiance;  // what this device found, until it is collected
    };
    struct GatherJob {
        const char* name;
        std::size_t most;  // points, of which the first *count are lit
        std::uint32_t stride;
        const cl::Buffer &count, &points, &irradiance;
        double from, to;  // share of the frame done before and after
    };
    void allocate(const SecondOrderOptions& options, EmitterSet set);
    void forget_failed_frame();
    std::vector<double> speeds() const;
    void draw_view(Recorder& record, const View& view, const cl::Buffer& visibility);
    void place_lights(Recorder& record);
    void draw_camera(Recorder& record, const View& view);
    void light_points(Recorder& record, const View& view);
    void place_negative(Recorder& record, const NegativeParams& params, const View& view);
    void gather(Recorder& record, const GatherJob& job);
    void gather_together(Recorder& record, const GatherJob& job, const GatherParams& params,
                         const std::vector<Share>& shares);
    void combine(Recorder& record, const View& view, bool emission);
    void fill_background(Recorder& record, const View& view);
    void check_given(const GBuffer& given) const;
    void black_frame(const WaitList& wait);
    cl::Event frame(const Camera& camera, const GBuffer* given, const WaitList& wait,
                    const Progress& progress, bool& cancelled);

    cl::CommandQueue queue_;
    const DeviceScene& scene_;
    SecondOrderOptions options_;
    GBufferPasses gbuffer_;
    LightPasses light_passes_;
    ImagePasses image_;
    ParallelPasses parallel_;  // offsets alone
    std::vector<Helper> helpers_;
    EmitterSet set_;
    std::vector<PassEvent> events_;
    WaitList fills_;      // of a black frame, which has no passes
    WaitList frame_end_;  // of the last frame; empty before the first
    std::size_t bytes_ = 0;
    std::uint32_t stride_ = 0;
    std::uint32_t low_stride_ = 0;
    bool usable_ = false;    // all buffers are there
    bool refine_ = false;    // low resolution and discontinuity test
    bool indirect_ = false;  // there is a source and something to light

    RasterBuffers raster_;  // shared by all views, each with its own visibility
    cl::Buffer camera_visibility_;
    SourceBuffers sources_;
    GBuffer drawn_, seen_;  // the solver's own, and what the last frame was lit from
    cl::Buffer mask_, accepted_, lights_, negative_;
    cl::Buffer low_points_, low_irradiance_, low_count_, all_count_;
    cl::Buffer flags_, counts_, listed_, listed_points_, listed_irradiance_, listed_count_;
    cl::Buffer irradiance_, radiance_, non_finite_;
};

}  // namespace clgi
