// clgi bake SCENE -o atlas.exr: multi-bounce light into a texture atlas. [Schaerfig16]
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <filesystem>
#include <memory>

#include "cli/bake_room.hpp"
#include "cli/bake_stats.hpp"
#include "cli/commands.hpp"
#include "cli/percent.hpp"
#include "cli/picture.hpp"
#include "cli/session.hpp"
#include "cli/version.hpp"
#include "report/bake_state.hpp"
#include "report/baked_atlas.hpp"
#include "report/reference_picture.hpp"

namespace clgi::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct BakeFlags {
    std::string scene;
    DeviceFlags device;
    PictureFlags picture;
    EnvironmentFlags environment;
    VplOptions vpls;
    AtlasOptions atlas;
    std::string uvs = "auto";
    std::string threshold;
    std::string filling = "gather";
    LightAtlasOptions bake;
    bool dilate = false;
    std::string gltf;
    std::string stats;
    std::string resume;
    int scene_index = -1;
};

AtlasUvs uvs_of(const std::string& text) {
    if (text == "0") return AtlasUvs::set_0;
    if (text == "1") return AtlasUvs::set_1;
    return text == "charts" ? AtlasUvs::charts : AtlasUvs::automatic;
}

// All that the bits of a bake depend on.
std::string key_of(const BakeFlags& flags, const Scene& scene, const cl::Device& device) {
    const LightAtlasOptions& bake = flags.bake;
    const EmitterOptions& emitters = bake.emitters;
    return fmt::format(
               "{} {} {} | {} {} {} | {} {} {} {} {} | {} {} {} {} {} {} {} {} {} {} | {} {} {} {}",
               CLGI_VERSION, report::scene_key(scene), describe(device), flags.vpls.count,
               flags.vpls.samples_per_vpl, flags.vpls.gap_density, flags.atlas.size, flags.uvs,
               flags.atlas.padding, flags.atlas.texels_per_metre, flags.atlas.most_pages,
               bake.bounces, bake.threshold, bake.one_at_a_time, bake.exchange_samples,
               bake.exchange_size, bake.filling_size, flags.filling, bake.mesh, bake.kernel,
               bake.direct, emitters.shadow_size, emitters.face_size, emitters.area_samples,
               emitters.environment_lights) +
           build_flags(flags.device);
}

// Bakes from the start, or from where the file says. Keeps in the file what Ctrl-C cut short, and
// deletes it once the bake is done. Returns how many VPLs had lit the texels before.
std::uint32_t run_to_the_end(const BakeFlags& flags, const std::string& key,
                             LightAtlasSolver& solver) {
    std::uint32_t begin = 0;
    std::error_code ignored;
    if (!flags.resume.empty() && std::filesystem::exists(flags.resume, ignored)) {
        const LightAtlasState state = report::load_bake_state(flags.resume, key);
        solver.restore(state);
        begin = state.filled_vpls;
        notice(flags.device.quiet,
               fmt::format("the bake goes on after VPL {} of {}", state.filled_vpls, state.vpls));
    }
    catch_interrupts();
    if (solver.run(progress_bar("bake", flags.device.quiet))) return begin;
    if (flags.resume.empty()) throw Interrupted();
    if (const auto state = solver.state()) {
        report::save_bake_state(*state, key, flags.resume);
        notice(flags.device.quiet, fmt::format("{} keeps the first {} of {} VPLs", flags.resume,
                                               state->filled_vpls, state->vpls));
    } else {
        notice(flags.device.quiet, "nothing to keep: no texel was lit yet");
    }
    throw Interrupted();
}

void run_bake(BakeFlags flags) {
    if (flags.picture.exr.empty() && flags.picture.png.empty() && flags.gltf.empty())
        throw Error("bake: no output; -o FILE.exr, --png FILE.png or --gltf FILE.glb needed");
    flags.picture.full = true;  // daylight, in lux, is beyond the range of half
    if (!flags.threshold.empty())
        flags.bake.threshold =
            static_cast<float>(parse_percent("bake", "--threshold", flags.threshold));
    flags.bake.filling = flags.filling == "project" ? Filling::project : Filling::gather;
    flags.atlas.uvs = uvs_of(flags.uvs);
    flags.bake.build = build_of(flags.device);
    Scene scene =
        open_scene(flags.scene, flags.scene_index, flags.environment, flags.device.quiet, true);
    const Session session = open_session(flags.device);
    need_room("bake", session.device, flags.vpls);

    auto start = Clock::now();
    const Patches patches = make_patches(scene);
    const VplLayout vpls = place_vpls(scene, patches, flags.vpls);
    const AtlasLayout atlas = make_atlas(scene, patches.triangle_patch, flags.atlas);
    const double layout_seconds = seconds_since(start);
    for (const std::string& warning : atlas.warnings) {
        notice(flags.device.quiet, "warning: " + warning);
        scene.warnings.push_back(warning);
    }
    start = Clock::now();
    const DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    LightAtlasSolver solver(programs, session.queue, device_scene, vpls, atlas, flags.bake);
    const double build_seconds = seconds_since(start);
    start = Clock::now();
    const std::string key = flags.resume.empty() ? "" : key_of(flags, scene, session.device);
    const std::uint32_t resumed_at = run_to_the_end(flags, key, solver);
    const double bake_seconds = seconds_since(start);

    const std::string effects = flags.bake.direct ? "direct,indirect" : "indirect";
    if (!flags.picture.exr.empty() || !flags.picture.png.empty())
        save_picture(report::baked_image(atlas, solver.irradiance(), effects, flags.dilate),
                     flags.picture);
    if (!flags.gltf.empty()) io::save_glb(with_atlas_uvs(scene, atlas), flags.gltf);
    if (!flags.stats.empty())
        save_bake_stats({scene, patches, vpls, atlas, solver, layout_seconds, build_seconds,
                         bake_seconds, resumed_at},
                        flags.stats);
    if (!flags.resume.empty()) {
        std::error_code ignored;
        std::filesystem::remove(flags.resume, ignored);
    }
    if (const std::uint32_t packets = solver.status().non_finite)
        notice(false, fmt::format("warning: {} packets held numbers that are not finite", packets));
    if (flags.device.quiet) return;
    std::string files;
    for (const std::string& file : {flags.picture.exr, flags.picture.png, flags.gltf})
        if (!file.empty()) files += (files.empty() ? "" : ", ") + file;
    fmt::print("{}: {} texels lit by {} VPLs, {:.2f} s\n", files, atlas.texels.size(),
               vpls.vpls.size(), layout_seconds + bake_seconds);
}

void add_method_flags(CLI::App& command, BakeFlags& flags) {
    command.add_option("--vpls", flags.vpls.count, "Virtual point lights (VPLs)")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
    command
        .add_option("--samples-per-vpl", flags.vpls.samples_per_vpl,
                    "Sample points of a VPL that receive direct light and send it on near by")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command
        .add_option(
            "--gap-density", flags.vpls.gap_density,
            "VPLs on narrow surfaces, between which light passes through gaps: so many times "
            "as dense at most; 1: as elsewhere")
        ->type_name("X")
        ->check(CLI::Range(1.0, 1000.0));
    command
        .add_option("--exchange-samples", flags.bake.exchange_samples,
                    "Those of them that tell how much of a VPL another one sees")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--bounces", flags.bake.bounces,
                    "Reflections of light at most; 0: until --threshold")
        ->type_name("N")
        ->check(CLI::Range(0, 1000));
    command
        .add_option("--threshold", flags.threshold,
                    "With --bounces 0: largest unshot power of a VPL, of all direct power")
        ->type_name("X")
        ->default_str("0.001%");
    command.add_flag("--one-at-a-time", flags.bake.one_at_a_time,
                     "With --bounces 0: shoot the strongest VPL alone, as in the paper");
    command
        .add_option("--exchange-size", flags.bake.exchange_size,
                    "Pixels of a hemicube's face when VPLs exchange light")
        ->type_name("N")
        ->check(CLI::Range(32, 1024));
    command
        .add_option("--filling-size", flags.bake.filling_size,
                    "Pixels of a hemicube's face when the atlas is filled")
        ->type_name("N")
        ->check(CLI::Range(32, 1024));
    command
        .add_option("--filling", flags.filling,
                    "How texels get light: gather, or project as in the paper")
        ->type_name("HOW")
        ->check(CLI::IsMember({"gather", "project"}));
    command
        .add_option("--mesh", flags.bake.mesh,
                    "With --filling project: triangles of the mesh over a hemicube's face")
        ->type_name("N")
        ->check(CLI::Range(8, 131072));
    command
        .add_option("--kernel", flags.bake.kernel,
                    "With --filling project: pixels to each side for soft shadows; 0: hard ones")
        ->type_name("K")
        ->check(CLI::Range(0, 64));
    command.add_flag("--direct", flags.bake.direct, "Direct light in the atlas too");
}

void add_light_flags(CLI::App& command, EmitterOptions& emitters) {
    command
        .add_option("--shadow-size", emitters.shadow_size,
                    "Pixels per side of the shadow map of a spot or directional light")
        ->type_name("N")
        ->check(CLI::Range(1, 8192));
    command
        .add_option("--face-size", emitters.face_size,
                    "Pixels per side of a cube or hemicube face, for point and area lights")
        ->type_name("N")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--area-samples", emitters.area_samples,
                    "Sample points on all emissive surfaces together")
        ->type_name("N")
        ->check(CLI::Range(0, 4096));
    command
        .add_option("--environment-lights", emitters.environment_lights,
                    "Directional lights that approximate the environment")
        ->type_name("N")
        ->check(CLI::Range(0, 4096));
}

void add_atlas_flags(CLI::App& command, BakeFlags& flags) {
    command.add_option("--atlas-size", flags.atlas.size, "Texels, side of a page of the atlas")
        ->type_name("N")
        ->check(CLI::Range(1, 8192));
    command.add_option("--uvs", flags.uvs, "Where texels are: auto, 0, 1 (UV sets) or charts")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"auto", "0", "1", "charts"}));
    command
        .add_option("--texels-per-metre", flags.atlas.texels_per_metre,
                    "Density of charts; 0: what fills the pages")
        ->type_name("X")
        ->check(CLI::Range(0.0, 1e6));
    command.add_option("--pages", flags.atlas.most_pages, "Pages at most, for charts")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command.add_option("--padding", flags.atlas.padding, "Empty texels around a chart")
        ->type_name("N")
        ->check(CLI::Range(1, 64));
    command.add_flag("--dilate", flags.dilate,
                     "Fill texels that are covered in part, and those around charts");
}

}  // namespace

void add_bake(CLI::App& app) {
    CLI::App* command = app.add_subcommand("bake", "Multi-bounce light into a texture atlas");
    const auto flags = std::make_shared<BakeFlags>();
    command->add_option("scene", flags->scene, ".gltf or .glb file")
        ->required()
        ->type_name("SCENE");
    command->add_option("-o,--output", flags->picture.exr, "EXR of irradiance, lux")
        ->type_name("FILE")
        ->default_str("none");
    command->add_option("--png", flags->picture.png, "PNG preview of the atlas")
        ->type_name("FILE")
        ->default_str("none");
    command->add_option("--gltf", flags->gltf, "GLB of the scene with the atlas's UVs as set 1")
        ->type_name("FILE")
        ->default_str("none");
    add_method_flags(*command, *flags);
    add_atlas_flags(*command, *flags);
    add_light_flags(*command, flags->bake.emitters);
    add_environment_flags(*command, flags->environment);
    add_device_flags(*command, flags->device);
    command->add_option("--scene", flags->scene_index, "Index of the glTF scene")
        ->type_name("N")
        ->default_str("the file's");
    command->add_option("--stats", flags->stats, "JSON file with VPLs, power and time")
        ->type_name("FILE")
        ->default_str("none");
    command
        ->add_option("--resume", flags->resume,
                     "File that keeps a bake cut short by Ctrl-C; if it exists, the bake goes on "
                     "from there")
        ->type_name("FILE")
        ->default_str("none");
    command->callback([flags] { run_bake(*flags); });
}

}  // namespace clgi::cli
