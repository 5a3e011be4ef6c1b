// SPDX-License-Identifier: MIT
#include "program/picture_record.hpp"

namespace clgi::program {

PictureOptions picture_options(const RenderFlags& flags) {
    PictureOptions out;
    out.width = flags.options.width;
    out.height = flags.options.height;
    out.emitters = flags.options.emitters;
    out.direct = !flags.no_direct;
    out.build = build_of(flags.device);
    return out;
}

void record_picture(RenderRecord& record, const Session& session, const Scene& scene,
                    const DeviceScene& device_scene, const Picture& picture, std::size_t bytes) {
    record.device = session.device;
    record.build = picture.options().build;
    record.triangles = scene.triangles.size();
    record.lights = picture.emitters().emitters.size();
    record.bytes = device_scene.bytes() + bytes;
    record.warnings = scene.warnings;
}

}  // namespace clgi::program
