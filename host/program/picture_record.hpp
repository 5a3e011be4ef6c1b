// What the methods of render have in common that bring irradiance to a Picture: its options from
// the flags, and what --stats says of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/picture.hpp>
#include <string>
#include <vector>

#include "program/render_flags.hpp"
#include "program/session.hpp"
#include "program/stats.hpp"

namespace clgi::program {

PictureOptions picture_options(const RenderFlags& flags);

// Device, scene and picture into the record. bytes: beside those of the scene.
void record_picture(RenderRecord& record, const Session& session, const Scene& scene,
                    const DeviceScene& device_scene, const Picture& picture, std::size_t bytes);

}  // namespace clgi::program
