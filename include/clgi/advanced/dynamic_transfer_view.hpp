// Pictures of a scene in the light of its environment, self-shadowed without precomputation.
//                                                                                      [Kautz04]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/picture.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <memory>

namespace clgi {

struct DynamicTransferViewOptions {
    // emitters.environment_lights is not used: the environment is the solver's. If directional
    // lights are part of it, they light nothing else.
    PictureOptions picture;
    // Pixels around probes that differ from what is interpolated between vertices by more than
    // this, of the larger of the two, become receivers themselves. 0: all; infinity: none. What
    // differs is irradiance, or where materials have lobes gloss, of all that they reflect. Where
    // the solver has no shadows every pixel has the irradiance of its own normal, and only gloss is
    // interpolated.
    float threshold = 0.1f;
    int probe_step = 8;  // pixels between probes: 2 to 64
};

// Owns its buffers, works on the solver's queue, never finishes it. Solver and scene must outlive
// this object. One thread at a time.
class CLGI_API DynamicTransferView {
public:
    // Builds kernels and allocates. Throws Error for options out of range, DeviceError when memory
    // does not suffice.
    DynamicTransferView(const Programs& programs, const cl::CommandQueue& queue,
                        const DeviceScene& scene, DynamicTransferSolver& solver,
                        const DynamicTransferViewOptions& options = {});
    ~DynamicTransferView();
    DynamicTransferView(const DynamicTransferView&) = delete;
    DynamicTransferView& operator=(const DynamicTransferView&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light, for shadow maps.
    void lights_changed();
    // Picture::sample().
    void sample(std::uint32_t index);

    // Enqueues a picture with the solver's last transfer() and light(); it begins after `wait`.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // What was drawn last, with its buffers, passes and times.
    const Picture& picture() const;

    // Waits for the last picture: how many of its pixels were receivers.
    std::uint32_t receiver_pixels() const;

    std::size_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
