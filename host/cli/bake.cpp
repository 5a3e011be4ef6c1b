// clgi bake SCENE -o atlas.exr: multi-bounce light into a texture atlas. [Schaerfig16]
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/percent.hpp"
#include "cli/picture.hpp"
#include "cli/session.hpp"
#include "cli/version.hpp"
#include "io/atomic_file.hpp"
#include "report/baked_atlas.hpp"
#include "report/timing.hpp"

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
    int scene_index = -1;
};

// Seconds of the stages of a bake.
struct BakeTimes {
    double layout = 0.0;  // patches, VPLs, charts, texels; on the host
    double build = 0.0;   // kernels and buffers
    double bake = 0.0;
};

AtlasUvs uvs_of(const std::string& text) {
    if (text == "0") return AtlasUvs::set_0;
    if (text == "1") return AtlasUvs::set_1;
    return text == "charts" ? AtlasUvs::charts : AtlasUvs::automatic;
}

// Seconds on the device by pass, in the order in which they first ran.
nlohmann::ordered_json passes_json(const std::vector<PassEvent>& events) {
    std::vector<std::pair<std::string, double>> sums;
    for (const PassEvent& pass : events) {
        auto at = std::find_if(sums.begin(), sums.end(),
                               [&](const auto& sum) { return sum.first == pass.name; });
        if (at == sums.end()) at = sums.insert(sums.end(), {pass.name, 0.0});
        at->second += 1e-3 * interval({pass.event}).milliseconds();
    }
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const auto& [name, seconds] : sums) out.push_back({{"name", name}, {"seconds", seconds}});
    return out;
}

void save_bake_stats(const BakeFlags& flags, const Scene& scene, const Patches& patches,
                     const VplLayout& vpls, const AtlasLayout& atlas,
                     const LightAtlasSolver& solver, const BakeTimes& times) {
    const LightAtlasStatus status = solver.status();
    const nlohmann::ordered_json json = {
        {"clgi", CLGI_VERSION},
        {"method", "atlas"},
        {"scene", {{"triangles", scene.triangles.size()}, {"lights", scene.lights.size()}}},
        {"vpls", vpls.vpls.size()},
        {"sample_points", vpls.samples.size()},
        {"patches", patches.patches.size()},
        {"skipped_area", patches.skipped_area},
        {"texels", atlas.texels.size()},
        {"texels_skipped_area", atlas.skipped_area},
        {"pages", atlas.pages},
        {"charts", atlas.charts.size()},
        {"shots", status.shots},
        {"transport_kept", status.transport_kept},
        {"power",
         {{"direct", status.power_direct},
          {"shot", status.power_shot},
          {"received", status.power_received},
          {"lost", status.power_lost},
          {"left", status.power_left}}},
        {"seconds",
         {{"layout", times.layout}, {"build", times.build}, {"bake", times.bake}}},
        {"passes", passes_json(solver.events())},
        {"memory_mb", static_cast<double>(solver.bytes()) / 1e6},
        {"non_finite", status.non_finite},
        {"warnings", scene.warnings}};
    io::AtomicFile file(flags.stats);
    const std::string text =
        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
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
    Scene scene = open_scene(flags.scene, flags.scene_index, flags.environment, flags.device.quiet,
                             true);
    BakeTimes times;
    auto start = Clock::now();
    const Patches patches = make_patches(scene);
    const VplLayout vpls = place_vpls(scene, patches, flags.vpls);
    const AtlasLayout atlas = make_atlas(scene, patches.triangle_patch, flags.atlas);
    times.layout = seconds_since(start);
    for (const std::string& warning : atlas.warnings) {
        notice(flags.device.quiet, "warning: " + warning);
        scene.warnings.push_back(warning);
    }
    const Session session = open_session(flags.device);
    start = Clock::now();
    flags.bake.build = build_of(flags.device);
    const DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs(session.context, session.device);
    LightAtlasSolver solver(programs, session.queue, device_scene, vpls, atlas, flags.bake);
    times.build = seconds_since(start);
    catch_interrupts();
    const auto bar = progress_bar("bake", flags.device.quiet);
    start = Clock::now();
    if (!solver.run(bar)) throw Interrupted();
    times.bake = seconds_since(start);
    const std::vector<glm::vec3> irradiance = solver.irradiance();
    const LightAtlasStatus status = solver.status();
    const std::string effects = flags.bake.direct ? "direct,indirect" : "indirect";
    if (!flags.picture.exr.empty() || !flags.picture.png.empty())
        save_picture(report::baked_image(atlas, irradiance, effects, flags.dilate), flags.picture);
    if (!flags.gltf.empty()) io::save_glb(with_atlas_uvs(scene, atlas), flags.gltf);
    if (status.non_finite > 0)
        notice(false, fmt::format("warning: {} packets held numbers that are not finite",
                                  status.non_finite));
    if (!flags.device.quiet)
        fmt::print("{}: {} texels lit by {} VPLs, {:.2f} s\n",
                   flags.picture.exr.empty() ? flags.picture.png : flags.picture.exr,
                   atlas.texels.size(), vpls.vpls.size(), times.layout + times.bake);
    if (!flags.stats.empty())
        save_bake_stats(flags, scene, patches, vpls, atlas, solver, times);
}

void add_method_flags(CLI::App& command, BakeFlags& flags) {
    command.add_option("--vpls", flags.vpls.count, "Virtual point lights (VPLs)")
        ->type_name("N")
        ->check(CLI::Range(1, 1 << 20));
    command
        .add_option("--samples-per-vpl", flags.vpls.samples_per_vpl,
                    "Sample points that tell how much of a VPL's surface is lit, on average")
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
    command->callback([flags] { run_bake(*flags); });
}

}  // namespace clgi::cli
