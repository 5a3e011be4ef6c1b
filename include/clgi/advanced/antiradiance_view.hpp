// Pictures of a scene in the light that an AntiradianceSolver found. [Dachsbacher07, section 4.3]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/picture.hpp>
#include <clgi/antiradiance.hpp>
#include <memory>

namespace clgi {

// Owns its buffers, works on the solver's queue, never finishes it. Solver and scene must outlive
// this object. One thread at a time.
class CLGI_API AntiradianceView {
public:
    // options.emitters.environment_lights is not used: the environment is the solver's. Builds
    // kernels and allocates. Throws Error for options out of range, DeviceError when memory does
    // not suffice.
    AntiradianceView(const Programs& programs, const cl::CommandQueue& queue,
                     const DeviceScene& scene, const AntiradianceSolver& solver,
                     const PictureOptions& options = {});
    ~AntiradianceView();
    AntiradianceView(const AntiradianceView&) = delete;
    AntiradianceView& operator=(const AntiradianceView&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light, for shadow maps.
    void lights_changed();
    // Picture::sample().
    void sample(std::uint32_t index);

    // Enqueues a picture with the light of the solver's last run(); it begins after `wait`.
    cl::Event render(const Camera& camera, const WaitList& wait = {});

    // What was drawn last, with its buffers, passes and times.
    const Picture& picture() const;

    std::size_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
