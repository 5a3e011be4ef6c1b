// Second-order illumination: one diffuse bounce of every light, approximately shadowed by
// negative VPLs.                                                               [Cochran07]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/emitters.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/advanced/solver_status.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/passes/lights.hpp>
#include <clgi/programs.hpp>
#include <memory>
#include <vector>

namespace clgi {

struct SecondOrderOptions {
    int width = 640;  // pixels
    int height = 480;
    // emitters.vpls is N, the number of VPLs. They are placed through the views of emitters, so
    // indirect light needs emitters.shadows, unless there are no VPLs.
    EmitterOptions emitters;
    int negative_vpls = 100;  // samples of the image that take light away; 0: none
    // The first of every n-th pixel of every n-th row is lit first, n = 2 or 4; the others are
    // interpolated where the surface is smooth. 1: every pixel is lit in full.
    int low_resolution_step = 4;
    // Differences from the interpolation points at which a pixel is lit in full: 1 is a right
    // angle between normals. 0: every pixel; infinity: none.
    float discontinuity_threshold = 0.02f;
    float footprint = 1.0f;  // scales the disc that bounds each VPL; 0: bare 1/d^2
    bool direct = true;
    bool indirect = true;
    // Bytes that the solver's buffers may take together; 0: what the device has beside the scene.
    std::size_t memory_budget = 0;
    BuildOptions build;
};

// What a render found out.
struct RenderStatus : SolverStatus {
    std::uint32_t refined_pixels = 0;   // lit in full by the discontinuity test
    double low_resolution_share = 0.0;  // of all pixels, [0,1]
};

// devices: how many share the work, the solver's own and its helpers'.
CLGI_API Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                           const SecondOrderOptions& options, std::size_t devices = 1);

// Owns its buffers, works on the given queue (in order or not), never finishes it. The scene must
// outlive the solver. One solver is used by one thread at a time.
class CLGI_API SecondOrderSolver {
public:
    // Builds kernels, except those that only some pictures need, and allocates. helpers: queues of
    // other devices of the same context that take a share of the gather; the picture is the same,
    // bit for bit, if their arithmetic is. Throws Error for options out of range, DeviceError when
    // the device cannot; when memory does not suffice it says so before it allocates, and which
    // option to lower.
    SecondOrderSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                      const SecondOrderOptions& options = {},
                      const std::vector<cl::CommandQueue>& helpers = {});

    // The same with kernels that other solvers and passes share. programs: of the queue's context
    // and device.
    SecondOrderSolver(const Programs& programs, const cl::CommandQueue& queue,
                      const DeviceScene& scene, const SecondOrderOptions& options = {},
                      const std::vector<cl::CommandQueue>& helpers = {});

    ~SecondOrderSolver();
    SecondOrderSolver(const SecondOrderSolver&) = delete;
    SecondOrderSolver& operator=(const SecondOrderSolver&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light. Does not wait. Allocates only
    // if a light needs more views or pixels than before, such as a spot that widens past 60
    // degrees; otherwise all buffers, and status().non_finite, stay what they are.
    void lights_changed();

    // Other options with the same kernels. Throws Error for options out of range, and for build
    // options that are not those of the constructor; DeviceError as the constructor does. What is
    // refused before anything is allocated leaves the solver as it was.
    void reconfigure(const SecondOrderOptions& options);

    // Another randomised shift of all low-discrepancy points (EmitterOptions::replicate).
    void set_replicate(std::uint32_t replicate);
    // Another sample of a picture: other VPLs, and after two samples or sixteen or more other
    // points of emissive surfaces and shadow maps (EmitterOptions::sample,
    // Emitters::samples_a_map). Until then the next picture keeps the maps of the last one, of
    // geometry as it was then: call lights_changed() after it has moved.
    void set_sample(std::uint32_t sample);

    // Enqueues a whole picture that begins after `wait`; the event completes when all of it has.
    // For a scene without light and without a visible environment no kernel is enqueued.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // The same with a given G-buffer instead of a drawn one: planes of the solver's stride and
    // size, as defined in include/clgi/shared/gbuffer.h. Their material ids are the scene's, or -1;
    // emission counts. Lights and shadows are those of the scene; an empty one has none. The planes
    // are read until the returned event is complete. Give your own G-buffer, or gbuffer() after
    // filling it. Throws Error when it is too small.
    cl::Event render(const Camera& camera, const GBuffer& given, const WaitList& wait = {});

    // render(camera), waiting after each part to report. False when progress cancelled. Passes that
    // look at very many VPLs are dispatches of about 100 ms at most; drawing and combining are one
    // each.
    bool run(const Camera& camera, const Progress& progress);

    // Passes of the last render, for profiling.
    const std::vector<PassEvent>& events() const;

    // From the first command of the last render to its end; the event of render() has the times of
    // the last command alone. Throws Error before the render has ended, and without profiling.
    Interval interval() const;

    // Waits for the last render and reads a few words back.
    RenderStatus status() const;

    const SecondOrderOptions& options() const;
    const EmitterSet& emitters() const;
    std::size_t bytes() const;     // allocated
    std::uint32_t stride() const;  // floats between planes

    // Results, valid when the render's event is complete. Planes are `stride` floats apart.
    const cl::Buffer& radiance() const;       // [RADIANCE_PLANES][stride] cd/m^2
    const cl::Buffer& irradiance() const;     // [IRRADIANCE_PLANES][stride], exposed
    const cl::Buffer& planes() const;         // [GBUFFER_PLANES][stride]
    const cl::Buffer& ids() const;            // [GBUFFER_ID_PLANES][stride]
    const GBuffer& gbuffer() const;           // the solver's own, written by render(camera)
    const cl::Buffer& vpls() const;           // [N] Vpl
    const cl::Buffer& negative_vpls() const;  // [negative_vpls] Vpl
    const ImagePasses& image_passes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
