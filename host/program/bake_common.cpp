// SPDX-License-Identifier: MIT
#include "program/bake_common.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>

#include "program/session.hpp"

namespace clgi::program {

void add_bake_flags(CLI::App& command, const std::string& prefix, LightAtlasOptions& bake,
                    AtlasOptions& atlas) {
    add_count(command, "--bounces", bake.bounces,
              prefix + "Reflections of light at most before it reaches a texel; 0: all that matter",
              0, 1000);
    add_count(command, "--hemicube-size", bake.hemicube_size,
              prefix + "Pixels of the face of a VPL's hemicube", 32, 1024);
    command
        .add_option("--refine", bake.refine,
                    prefix + "Texels between those that look up every VPL first; 1: all of them do")
        ->type_name("N")
        ->check(CLI::IsMember({1, 2, 4}));
    add_count(command, "--atlas-size", atlas.size, prefix + "Texels, side of a page of the atlas",
              1, 8192);
}

void add_emitter_flags(CLI::App& command, EmitterOptions& emitters) {
    const bool bakes = emitters.shadow_size == 0;
    const int lowest = bakes ? 0 : 1;
    const char* more = bakes ? "; 0: 2048, fewer if there are more than 4 such maps" : "";
    add_count(
        command, "--shadow-size", emitters.shadow_size,
        std::string("Pixels per side of the shadow map of a spot or directional light") + more,
        lowest, 8192);
    add_count(command, "--face-size", emitters.face_size,
              "Pixels per side of a cube or hemicube face, for point and area lights", 1, 4096);
    add_count(command, "--area-samples", emitters.area_samples,
              "Sample points on all emissive surfaces together", 0, 4096);
    add_count(command, "--environment-lights", emitters.environment_lights,
              "Directional lights that approximate the environment", 0, 4096);
}

void check_capacity(const std::string& command, const cl::Device& device,
                    const VplOptions& options) {
    const std::size_t samples = std::size_t{options.count} * options.samples_per_vpl;
    const std::size_t needed = light_atlas_least_bytes(options.count, samples);
    const std::size_t memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    if (needed <= memory) return;
    throw DeviceError(fmt::format(
        "{}: {} VPLs with {} samples each need {} MB at the least, the device has {} MB; lower "
        "--vpls or --samples-per-vpl",
        command, options.count, options.samples_per_vpl, needed / 1000000, memory / 1000000));
}

namespace {

void warn(Scene& scene, const std::string& warning, bool quiet) {
    notice(quiet, "warning: " + warning);
    scene.warnings.push_back(warning);
}

}  // namespace

BakeLayout lay_out(Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas, bool quiet) {
    const Stopwatch watch;
    BakeLayout out;
    static_cast<clgi::BakeLayout&>(out) = make_bake_layout(scene, vpls, atlas);
    out.seconds = watch.seconds();
    for (const std::string& warning : out.atlas.warnings) warn(scene, warning, quiet);
    return out;
}

StaticBake lay_out_static(Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas,
                          bool quiet) {
    const Stopwatch watch;
    StaticBake out;
    static_cast<clgi::StaticBake&>(out) = make_static_bake(scene, vpls, atlas);
    out.seconds = watch.seconds();
    for (const std::string& warning : out.whole.warnings) warn(scene, warning, quiet);
    if (out.static_scene.moving_emission)
        warn(scene, "what moves emits, but lights nothing indirectly", quiet);
    return out;
}

}  // namespace clgi::program
