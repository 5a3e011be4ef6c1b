// Pictures of a scene whose indirect light is in an atlas: direct light anew for every picture,
// indirect light looked up.                                                   [Schaerfig16]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/kit/picture.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/programs.hpp>
#include <memory>
#include <optional>

namespace clgi {

using LightAtlasViewOptions = PictureOptions;

// Owns its buffers, works on the given queue (in order or not), never finishes it. The scene must
// outlive this object; the layout is not needed afterwards. One thread at a time.
//
// The atlas has one light for both sides of a surface, that of its front. Surfaces that the atlas
// has no place for (AtlasLayout::skipped_area), and triangles without a chart, such as those that
// move (atlas_of_whole), have the indirect light of an irradiance volume, outside of it that of its
// nearest points; without a volume they have none.
class CLGI_API LightAtlasView {
public:
    // Builds kernels and allocates. atlas: of the scene that was uploaded; volume: whose
    // points_of() were baked with it. Throws Error for options out of range and the layout of
    // another scene, DeviceError when memory does not suffice.
    LightAtlasView(const Programs& programs, const cl::CommandQueue& queue,
                   const DeviceScene& scene, const AtlasLayout& atlas,
                   const LightAtlasViewOptions& options = {},
                   const std::optional<IrradianceVolume>& volume = std::nullopt);
    ~LightAtlasView();
    LightAtlasView(const LightAtlasView&) = delete;
    LightAtlasView& operator=(const LightAtlasView&) = delete;

    // Reads the scene's lights again, after DeviceScene::set_light, for direct light.
    void lights_changed();
    // Picture::sample().
    void sample(std::uint32_t index);

    // Enqueues a picture that begins after `wait`; the event completes when all of it has. light:
    // by texel of the layout and point of the volume, [3][light_stride] float, exposed lux, as
    // LightAtlasSolver::irradiance_planes() and stride() have it.
    cl::Event render(const Camera& camera, const cl::Buffer& light, std::uint32_t light_stride,
                     const WaitList& wait = {});

    // What was drawn last, with its buffers, passes and times.
    const Picture& picture() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi
