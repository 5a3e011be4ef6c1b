// clgi bake SCENE -o atlas.exr: multi-bounce light into a texture atlas. [Schaerfig16]
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/clgi.hpp>
#include <filesystem>
#include <memory>
#include <optional>

#include "lab/bake_state.hpp"
#include "lab/baked_atlas.hpp"
#include "lab/reference_picture.hpp"
#include "program/bake_gltf.hpp"
#include "program/bake_stats.hpp"
#include "program/commands.hpp"
#include "program/option_flags.hpp"
#include "program/picture.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"
#include "program/stopwatch.hpp"
#include "program/verify.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

struct BakeFlags {
    SceneFlags scene;
    DeviceFlags device;
    PictureFlags picture;
    VerifyFlags verify;
    RendererOptions options;  // vpls, layout and light_atlas of them
    bool progressive = false;
    bool dilate = false;
    bool stitch = false;
    BakeGltfFlags gltf;
    std::string stats;
    std::string resume;
};

// All that the bits of a bake depend on.
std::string key_of(const BakeFlags& flags, const Scene& scene, const cl::Device& device) {
    return fmt::format("{} {} {} {}", CLGI_VERSION, lab::scene_key(scene), describe(device),
                       option_text(flags.options, of_bakes));
}

// Bakes from the start, or from where the file says. Keeps in the file what Ctrl-C cut short, and
// deletes it once the bake is done. Returns how many VPLs were done before.
std::uint32_t run_to_the_end(const BakeFlags& flags, const std::string& key,
                             LightAtlasSolver& solver) {
    const auto done = [](const LightAtlasState& state) {
        return std::max(state.measured_vpls, state.filled_vpls);
    };
    std::uint32_t begin = 0;
    std::error_code ignored;
    if (!flags.resume.empty() && std::filesystem::exists(flags.resume, ignored)) {
        const LightAtlasState state = lab::load_bake_state(flags.resume, key);
        solver.restore(state);
        begin = done(state);
        notice(flags.device.quiet,
               fmt::format("the bake goes on after VPL {} of {}", begin, state.vpls));
    }
    if (solver.run(progress_bar("bake", flags.device.quiet))) return begin;
    if (flags.resume.empty()) throw Interrupted();
    if (const auto state = solver.state()) {
        lab::save_bake_state(*state, key, flags.resume);
        notice(flags.device.quiet, fmt::format("{} keeps the first {} of {} VPLs", flags.resume,
                                               done(*state), state->vpls));
    } else {
        notice(flags.device.quiet, "nothing to keep: no VPL was done yet");
    }
    throw Interrupted();
}

void check(const BakeFlags& flags) {
    check_formats("bake", flags.picture);
    if (flags.picture.exr.empty() && flags.picture.png.empty() && flags.gltf.lit.empty() &&
        flags.gltf.unwrapped.empty())
        throw Error(
            "bake: no output; -o FILE.exr, --png FILE.png, --gltf FILE.glb or --unwrapped FILE.glb "
            "needed");
    if (flags.gltf.lights && flags.options.light_atlas.direct)
        throw Error("bake: --gltf-lights with --direct would show direct light twice");
    if (flags.gltf.lit.empty() && (flags.gltf.lights || flags.gltf.detail > 0))
        throw Error("bake: --gltf-lights and --gltf-detail go only with --gltf");
    if (flags.progressive && flags.picture.exr.empty() && flags.picture.png.empty())
        throw Error("bake: --progressive goes only with -o or --png");
    check_verify("bake", flags.verify);
}

std::string effects_of(const BakeFlags& flags) {
    return flags.options.light_atlas.direct ? "direct,indirect" : "indirect";
}

// The atlas as a picture, in the files that are asked for.
void save_atlas(const BakeFlags& flags, const AtlasLayout& atlas,
                const std::vector<glm::vec3>& irradiance,
                const std::optional<reference::Verification>& verified = std::nullopt) {
    if (flags.picture.exr.empty() && flags.picture.png.empty()) return;
    io::Image image = lab::baked_image(atlas, irradiance, effects_of(flags), flags.dilate);
    if (verified) add_verified(image, *verified);
    save_picture(image, flags.picture);
}

// The error of the texels whose centre is covered, against all bounces. Nothing if it is not asked
// for or cancelled.
std::optional<reference::Verification> verify_atlas(const BakeFlags& flags, const Scene& scene,
                                                    const AtlasLayout& atlas,
                                                    const std::vector<glm::vec3>& irradiance,
                                                    double spent) {
    if (!flags.verify.on) return std::nullopt;
    std::vector<glm::vec3> found;
    for (std::size_t k = 0; k < atlas.texels.size(); ++k)
        if (atlas.texels[k].centre) found.push_back(irradiance[k]);
    const lab::AtlasPlaces places = lab::atlas_places(scene, atlas);
    return verify(scene, flags.verify, spent,
                  [&](const auto& tracer, reference::VerifyOptions options) {
                      options.effects = reference::parse_effects(effects_of(flags));
                      return tracer.verify(places.places, found, options,
                                           progress_bar("verify", flags.device.quiet));
                  });
}

// Quick bakes with fewer VPLs, each saved: something to look at early that becomes better. As each
// has four times the VPLs of the one before, all of them take less than half of the last one's
// time.
void bake_drafts(const BakeFlags& flags, const Session& session, const Programs& programs,
                 const Scene& scene, const DeviceScene& device_scene, const BakeLayout& layout) {
    constexpr std::uint32_t fewest = 50;
    std::vector<std::uint32_t> counts;
    for (std::uint32_t n = flags.options.vpls.count / 4; n >= fewest; n /= 4) counts.push_back(n);
    for (auto count = counts.rbegin(); count != counts.rend(); ++count) {
        const Stopwatch watch;
        VplOptions few = flags.options.vpls;
        few.count = *count;
        LightAtlasSolver solver(programs, session.queue, device_scene,
                                place_vpls(scene, layout.patches, few), layout.atlas,
                                flags.options.light_atlas);
        if (!solver.run(progress_bar(fmt::format("{} VPLs", few.count), flags.device.quiet)))
            throw Interrupted();
        save_atlas(flags, layout.atlas, solver.irradiance());
        notice(flags.device.quiet,
               fmt::format("saved with {} VPLs after {:.2f} s", few.count, watch.seconds()));
    }
}

void run_bake(BakeFlags flags) {
    check(flags);
    flags.picture.full = true;  // daylight, in lux, is beyond the range of half
    if (flags.device.storage == "half")
        throw Error(
            "bake: --storage half: a bake has full storage alone, because it sums the light of "
            "thousands of VPLs");
    LightAtlasOptions& options = flags.options.light_atlas;
    options.build = flags.options.picture.build = build_of(flags.device);
    Scene scene = open_scene(flags.scene, flags.device.quiet, true);
    pose_scene("bake", flags.scene.animation, scene);
    const Session session = open_session(flags.device);
    check_bake_fits(session.device, flags.options.vpls);

    const Stopwatch laying_out;
    const BakeLayout layout = make_bake_layout(scene, flags.options.vpls, flags.options.layout);
    const double layout_seconds = laying_out.seconds();
    for (const std::string& warning : layout.atlas.warnings) {
        notice(flags.device.quiet, "warning: " + warning);
        scene.warnings.push_back(warning);
    }
    const Stopwatch build;
    const DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs = programs_of(session);
    LightAtlasSolver solver(programs, session.queue, device_scene, layout.vpls, layout.atlas,
                            options);
    const double build_seconds = build.seconds();
    catch_interrupts();
    if (flags.progressive) bake_drafts(flags, session, programs, scene, device_scene, layout);
    const Stopwatch bake;
    const std::string key = flags.resume.empty() ? "" : key_of(flags, scene, session.device);
    const std::uint32_t resumed_at = run_to_the_end(flags, key, solver);
    const double bake_seconds = bake.seconds();

    std::vector<glm::vec3> irradiance = solver.irradiance();
    if (flags.stitch) irradiance = stitched_seams(scene, layout.atlas, irradiance);
    const auto verified = verify_atlas(flags, scene, layout.atlas, irradiance,
                                       layout_seconds + build_seconds + bake_seconds);
    save_atlas(flags, layout.atlas, irradiance, verified);
    const std::optional<LitGltf> gltf =
        save_bake_gltf(scene, layout.atlas, irradiance, flags.picture.exposure, flags.gltf);
    if (!flags.stats.empty())
        save_bake_stats({scene, layout, solver, atlas_seams(scene, layout.atlas, irradiance), gltf,
                         verified, layout_seconds, build_seconds, bake_seconds, resumed_at},
                        flags.stats);
    if (!flags.resume.empty()) {
        std::error_code ignored;
        std::filesystem::remove(flags.resume, ignored);
    }
    if (const std::uint32_t packets = solver.status().non_finite)
        notice(false, fmt::format("warning: {} packets held numbers that are not finite", packets));
    if (flags.device.quiet) return;
    std::string files;
    for (const std::string& file :
         {flags.picture.exr, flags.picture.png, flags.gltf.lit, flags.gltf.unwrapped})
        if (!file.empty()) files += (files.empty() ? "" : ", ") + file;
    fmt::print("{}: {} texels lit by {} VPLs, {:.2f} s{}\n", files, layout.atlas.texels.size(),
               layout.vpls.vpls.size(), layout_seconds + bake_seconds,
               verified ? ", " + verify_line(*verified) : "");
}

}  // namespace

void add_bake(CLI::App& app) {
    CLI::App* command = app.add_subcommand("bake", "Multi-bounce light into a texture atlas");
    const auto flags = std::make_shared<BakeFlags>();
    add_scene_flags(*command, flags->scene);
    command->add_option("-o,--output", flags->picture.exr, "EXR of irradiance, lux")
        ->type_name("FILE")
        ->default_str("none");
    command->add_option("--png", flags->picture.png, "PNG preview of the atlas")
        ->type_name("FILE")
        ->default_str("none");
    command
        ->add_option("--exposure", flags->picture.exposure,
                     "Exposure of --png and --gltf; at 0, 1 is white")
        ->type_name("STOPS")
        ->default_str("from the light");
    add_bake_gltf_flags(*command, flags->gltf);
    add_option_flags(*command, flags->options, of_bakes, {"math"});
    command->add_flag("--progressive", flags->progressive,
                      "Save -o and --png with fewer VPLs first, then with four times as many, and "
                      "so on");
    command->add_flag("--dilate", flags->dilate,
                      "Fill texels that are covered in part, and those around charts");
    command->add_flag("--stitch", flags->stitch,
                      "Make light agree where charts cut a smooth surface");
    add_verify_flag(*command, flags->verify, "atlas");
    add_device_flags(*command, flags->device);
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

}  // namespace clgi::program
