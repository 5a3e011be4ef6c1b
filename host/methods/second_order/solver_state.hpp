// What the second-order solver holds, and the parts of a render.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/passes/parallel.hpp>
#include <clgi/second_order.hpp>

namespace clgi {

namespace second_order {

// Throws Error naming the option that is out of range.
void check(const SecondOrderOptions& options);

// Whether a picture is lit at low resolution first.
bool refines(const SecondOrderOptions& options);

std::size_t pixel_count(const SecondOrderOptions& options);
std::size_t low_pixel_count(const SecondOrderOptions& options);

struct Buffers {
    RasterBuffers camera;
    cl::Buffer camera_view;
    GBuffer drawn, seen;  // the solver's own, and what the last picture was lit from
    cl::Buffer mask, accepted, lights, negative;
    cl::Buffer low_points, low_irradiance, low_count, all_count;
    cl::Buffer flags, counts, listed, listed_points, listed_irradiance, listed_count;
    cl::Buffer irradiance, radiance, non_finite;
    std::vector<cl::Buffer> helpers;  // irradiance that each has found, until it is collected
    std::uint32_t stride = 0, low_stride = 0;
};

// Every buffer of a render, a row each.
BufferTable table(Buffers& buffers, Emitters& emitters, const DeviceScene& scene,
                  const SecondOrderOptions& options, std::size_t helpers);

}  // namespace second_order

struct SecondOrderSolver::State {
    struct Helper {
        cl::CommandQueue queue;
        ImagePasses image;
    };
    struct GatherJob {
        const char* name;
        std::size_t most;  // points, of which the first *count are lit
        std::uint32_t stride;
        const cl::Buffer &count, &points, &irradiance;
        double from, to;  // share of the render done before and after
    };

    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& scene,
          const SecondOrderOptions& options, const std::vector<cl::CommandQueue>& helpers);
    void allocate(const SecondOrderOptions& options);
    bool indirect() const { return options.indirect && emitters.set().vpl_count > 0; }
    bool refine() const { return indirect() && second_order::refines(options); }
    std::vector<double> speeds() const;
    void place_lights();
    void light_points(const View& view);
    void place_negative(const View& view);
    void gather(const GatherJob& job);
    void gather_together(const GatherJob& job, const GatherParams& params);
    void combine(const View& view, bool emission);
    cl::Event render(const Camera& camera, const GBuffer* given, const WaitList& wait,
                     const Progress& progress);

    cl::CommandQueue queue;
    const DeviceScene& scene;
    SecondOrderOptions options;
    GBufferPasses gbuffer;
    LightPasses light_passes;
    ImagePasses image;
    ParallelPasses parallel;
    std::vector<Helper> helpers;
    Emitters emitters;
    second_order::Buffers buffers;
    mutable Recorder record;
    std::size_t bytes = 0;
    bool usable = false;  // all buffers are there
};

}  // namespace clgi
