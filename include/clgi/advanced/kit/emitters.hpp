// The emitters of a scene on the device with their shadow maps: written, drawn and kept up to date.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/emitters.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/lights.hpp>

namespace clgi {

// A solver adds the buffers to its table, writes the emitters once the buffers are allocated, and
// draws the shadow maps for every picture. The scene must outlive this object.
class CLGI_API Emitters {
public:
    // kind: what the shadow maps hold. Placing VPLs needs visibility; depth is enough for direct
    // light.
    Emitters(const DeviceScene& scene, const EmitterOptions& options,
             Pixels kind = Pixels::visibility);

    // Rows for all buffers. They have room for every light of the scene, also for those that are
    // dark now. Only a light that needs more views or pixels than before exceeds it, such as a spot
    // that widens past 60 degrees.
    void add_to(BufferTable& table);

    // Reads the scene's lights again. False if the buffers are too small for them: then nothing has
    // changed, and the caller must allocate anew.
    bool update(const EmitterOptions& options);

    // The same with larger buffers where they are too small, and enqueues the writes. What was
    // enqueued before keeps the old ones. Returns by how many bytes they have grown. Throws
    // DeviceError where memory does not suffice: then nothing has changed.
    std::size_t follow(const EmitterOptions& options, Recorder& record,
                       const GBufferPasses& gbuffer);

    // Takes over the emitters of another object and keeps the buffers of this one. The rows must be
    // added to a table again, which allocates the buffers whose size has changed.
    void adopt(Emitters&& planned);

    // Enqueues the writes of emitters and views to their buffers, without waiting.
    void write(Recorder& record) const;

    // Builds the kernels that draw() takes, also when some of the lights are dark; none if there
    // are no shadow maps.
    void build(const GBufferPasses& gbuffer) const;

    // Draws the shadow maps; without EmitterOptions::shadows there are none. lists: as for draw();
    // pixels and kind of it are not used.
    void draw(Recorder& record, const GBufferPasses& gbuffer, RasterBuffers lists);

    // The next draw() leaves the maps as they are, unless the lights are read again before it or
    // views or buffers are others than those that were drawn: for samples of a picture, between
    // which nothing moves.
    void keep_maps(bool keep) { keeps_ = keep; }

    // Which Halton points of each spot's cone its VPLs are placed at. mask: of most_candidates
    // bits; accepted: [vpls] uint.
    void accept(Recorder& record, const LightPasses& passes, const cl::Buffer& mask,
                const cl::Buffer& accepted) const;

    // How many samples of a picture of so many pixels have the same shadow maps: two where these
    // stand for points of emissive surfaces or parts of the environment, which soft shadows need
    // many of, or hold the dither of blended surfaces, one where those of an environment take no
    // longer than the sample; otherwise so many that the maps take no longer than the samples.
    std::uint32_t samples_a_map(std::size_t pixels) const;

    // Whether some light of the scene has a shadow map, also one that is dark now.
    bool casts_shadows() const { return capacity_.views > 0; }

    const EmitterSet& set() const { return set_; }
    const EmitterBuffers& buffers() const { return buffers_; }

private:
    const DeviceScene* scene_;
    EmitterSet set_;
    EmitterCapacity capacity_;  // what the buffers have room for
    EmitterBuffers buffers_;
    std::vector<View> drawn_;  // whose maps are in the buffers
    bool keeps_ = false;
};

}  // namespace clgi
