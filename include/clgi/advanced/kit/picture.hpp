// Pictures to which a solver brings irradiance: the camera's G-buffer, then whatever the solver
// enqueues, then direct light and the environment behind it all.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/interval.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/programs.hpp>
#include <string>
#include <vector>

namespace clgi {

struct PictureOptions {
    int width = 640;  // pixels
    int height = 480;
    EmitterOptions emitters;  // for direct light; emitters.vpls is not used
    bool direct = true;       // with its gloss, emission and the environment; false: no shadow maps
    bool shadow_maps = false;  // without direct light too, for a solver that reads them
    // Bytes that the buffers may take together; 0: what the device has beside the scene.
    std::size_t memory_budget = 0;
    BuildOptions build;
};

// Owns the buffers of a picture, works on the given queue (in order or not), never finishes it. The
// scene must outlive this object. One thread at a time.
class CLGI_API Picture {
public:
    // Throws Error for options out of range. owner begins the messages of errors.
    Picture(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& scene,
            const PictureOptions& options, std::string owner);

    // A solver adds its own rows to this table, then calls allocate once. taken: bytes that it has
    // on the device beside the scene's.
    BufferTable table();
    void allocate(const BufferTable& table, std::size_t taken = 0);

    // Reads the scene's lights again, after DeviceScene::set_light.
    void lights_changed();

    // The next picture is sample `index` of one: from time to time by other points of emissive
    // surfaces, and by shadow maps that lie differently within their texels
    // (EmitterOptions::sample). In between it keeps the maps of the picture before, of geometry as
    // it was then: call lights_changed() after it has moved.
    void sample(std::uint32_t index);

    // Enqueues shadow maps and the G-buffer of a picture that begins after `wait`. The solver then
    // records what writes irradiance(), all of its pixels. lights: false: shadow maps are left to
    // draw_lights(), which the solver calls before what reads them.
    View begin(const Camera& camera, const WaitList& wait, bool lights = true);
    void draw_lights();
    // By which directions of the environment are drawn when lights are read again.
    void weigh_sky(std::shared_ptr<const SkyWeights> weights);
    // Direct light and irradiance to radiance().
    void combine(const View& view);
    // The environment where nothing is seen; the event of the whole picture. turned: about +Y,
    // radians, beside the environment's own rotation.
    cl::Event end(const View& view, double turned = 0.0);

    Recorder& record() { return record_; }
    const GBufferPasses& passes() const { return gbuffer_; }
    const RasterBuffers& lists() const { return raster_; }  // for draw()
    std::size_t pixels() const {
        return static_cast<std::size_t>(options_.width) * static_cast<std::size_t>(options_.height);
    }

    // Waits for the last picture. Packets of pixels with numbers that were not finite and were
    // replaced, since the start.
    std::uint32_t non_finite() const { return record_.read_word(bad_); }

    // Waits for the last picture, and reads the first word of a buffer.
    std::uint32_t read_word(const cl::Buffer& buffer) const { return record_.read_word(buffer); }

    // As SecondOrderSolver has them.
    const std::vector<PassEvent>& events() const { return record_.events(); }
    Interval interval() const { return record_.interval(); }
    const PictureOptions& options() const { return options_; }
    const EmitterSet& emitters() const { return emitters_.set(); }
    const EmitterBuffers& emitter_buffers() const {
        return emitters_.buffers();
    }  // with shadow maps
    std::size_t bytes() const { return bytes_; }
    std::uint32_t stride() const { return seen_.stride; }
    const cl::Buffer& radiance() const { return radiance_; }  // [RADIANCE_PLANES][stride()] cd/m^2
    const cl::Buffer& irradiance() const {
        return irradiance_;
    }                                                   // [IRRADIANCE_PLANES][stride()],
                                                        // exposed lux
    const cl::Buffer& counter() const { return bad_; }  // [1] uint, of non_finite()
    const GBuffer& gbuffer() const { return seen_; }

private:
    std::string owner_;
    const DeviceScene& scene_;
    PictureOptions options_;
    GBufferPasses gbuffer_;
    ImagePasses image_;
    Emitters emitters_;
    Recorder record_;
    RasterBuffers raster_;
    GBuffer seen_;
    cl::Buffer view_, irradiance_, radiance_, bad_;
    std::size_t bytes_ = 0;
    std::uint32_t lights_ = 0;  // replicates after the first
};

}  // namespace clgi
