// clgi render SCENE -o out.exr [--png out.png]: from glTF to picture, by any method.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "lab/coarse_mesh.hpp"
#include "program/commands.hpp"
#include "program/count_flag.hpp"
#include "program/gl_frames.hpp"
#include "program/render_attempt.hpp"
#include "program/render_plan.hpp"

namespace clgi::program {
namespace {

constexpr unsigned all_methods = of_direct | of_second_order | of_light_atlas | of_antiradiance |
                                 of_transfer | of_irradiance_cache;

// Options that a plan keeps where flags set them.
bool plan_keeps(const OptionRow& row) {
    for (const char* name :
         {"shadow-size", "face-size", "area-samples", "samples", "math", "storage"})
        if (row.name == name) return true;
    return false;
}

// Options of second-order illumination choose it, and so do a G-buffer by OpenGL and the time of a
// frame where nothing moves.
void choose_method(RenderFlags& flags) {
    const bool second_order = std::any_of(
        flags.given.begin(), flags.given.end(),
        [](const OptionRow* row) { return row->of(of_second_order) && !plan_keeps(*row); });
    const bool frame_time = !flags.ask.frame_time.empty() && !flags.fps;
    if (flags.method == "auto" &&
        (second_order || flags.gbuffer != "cl" || flags.replicates > 1 || frame_time))
        flags.method = "second-order";
}

// A plan finds the settings: always of the method auto, of others where a time for all is asked
// for.
bool plans(const RenderFlags& flags) {
    return flags.method == "auto" || !flags.ask.time_budget.empty();
}

void check(const RenderFlags& flags) {
    const std::string& method = flags.method;
    const auto refuse = [](bool wrong, const std::string& why) {
        if (wrong) throw Error("render: " + why);
    };
    const AskFlags& ask = flags.ask;
    const bool tunes = !plans(flags) && !(ask.target_error.empty() && ask.frame_time.empty());
    const bool second_order = method == "second-order" || method == "direct";
    check_methods("render", flags.given, method);
    refuse(flags.plan_given && !plans(flags),
           "--tolerance, --with and --without go only with --method auto or --time-budget");
    if (!ask.time_budget.empty())
        for (const OptionRow* row : flags.given)
            refuse(!plan_keeps(*row), "--" + row->name +
                                          " goes not with --time-budget, which finds "
                                          "the settings");
    refuse(!ask.time_budget.empty() && flags.fps.has_value(),
           "--time-budget is of one picture; with --fps --frame-time needed");
    refuse(!second_order && flags.replicates > 1, "--replicates goes not with --method " + method);
    refuse(!second_order && tunes,
           "--target-error and --frame-time go not with --method " + method);
    refuse(flags.gbuffer != "cl" && !second_order, "--gbuffer gl goes not with --method " + method);
    refuse(method == "direct" && tunes,
           "--method direct has no settings to find; it excludes --target-error and --frame-time");
    refuse(is_given(flags, "samples") && (flags.gbuffer == "gl" || flags.replicates > 1),
           "--samples goes not with --gbuffer gl or --replicates");
    const bool asks = tunes || !ask.time_budget.empty();
    refuse(flags.gbuffer == "gl" && (asks || flags.replicates > 1),
           "--gbuffer gl excludes --replicates, --target-error, --time-budget and --frame-time");
    refuse(method == "cache" && flags.device.storage == "half",
           "--storage half goes not with --method cache");
    refuse(flags.coarse > 0 && method != "transfer", "--coarse goes only with --method transfer");
    refuse(is_given(flags, "rings") && flags.coarse == 0, "--rings goes only with --coarse");
    refuse(method == "atlas" && flags.options.vpls.count < 1,
           "--vpls is 0, at least 1 needed with --method atlas");
    if (!flags.verify.on) return;
    check_verify("render", flags.verify);
    refuse(flags.fps.has_value(), "--verify is of one picture; with --time instead of --fps");
    refuse(flags.spin_light && flags.frames > 1,
           "--verify goes not with --spin-light, under whose lights the last picture is");
    refuse(is_given(flags, "no-direct"), "--verify is against all light; it excludes --no-direct");
}

void run_render(RenderFlags flags) {
    choose_method(flags);
    check(flags);
    const bool planned = plans(flags), quiet = flags.device.quiet;
    PictureOptions& picture = flags.options.picture;
    picture.build = build_of(flags.device);
    check_picture("render", flags.picture, picture.width, picture.height);
    // What is wrong with a request is said before anything is loaded.
    if (planned)
        plan_request(flags);
    else
        request_of("render", flags.ask);
    Scene scene = open_scene(flags.scene, quiet, planned || flags.method == "atlas");
    prepare_motion(flags, scene);
    std::optional<GlFrames> gl;
    if (flags.gbuffer == "gl") gl.emplace();
    const Session session =
        gl ? open_session(flags.device,
                          [&](const cl::Device& device) { return gl->properties(device); })
           : open_session(flags.device);
    const Programs programs = programs_of(session);
    flags.options.animated = flags.fps.has_value();
    if (flags.fps) flags.options.clip = clip_of("render", scene, flags.scene.animation);
    if (flags.coarse > 0)
        flags.options.transfer.coarse =
            lab::coarse_mesh(scene, static_cast<std::size_t>(flags.coarse));
    if (planned) {
        render_planned(flags, session, programs, scene);
        return;
    }
    flags.options.method = *method_of(flags.method);
    if (!flags.fps && !flags.orbit)
        scene.focus = focus_of(scene, camera_of(flags.scene, scene), picture.width, picture.height);
    catch_interrupts();
    RenderAttempt attempt(flags, session, programs, gl ? &*gl : nullptr, scene, flags.options,
                          nullptr);
    attempt.draw();
    if (flags.verify.on) attempt.check(scene, 0.0);
    attempt.finish();
    if (flags.verify.on && interrupted()) throw Interrupted();
}

}  // namespace

void add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a glTF scene");
    const auto flags = std::make_shared<RenderFlags>();
    add_scene_flags(*command, flags->scene);
    add_picture_flags(*command, flags->picture, flags->options.picture.width,
                      flags->options.picture.height);
    command
        ->add_option(
            "--method", flags->method,
            "auto: what the scene calls for (clgi plan), second-order where flags of it are given; "
            "atlas: many bounces, baked first; transfer: light of the "
            "environment with its shadows; antiradiance: many bounces, no visibility; "
            "cache: many bounces, gathered where the picture needs them; direct: no indirect light")
        ->type_name("METHOD")
        ->check(CLI::IsMember(
            {"auto", "second-order", "atlas", "transfer", "antiradiance", "cache", "direct"}));
    add_camera_flags(*command, flags->scene);
    add_option_flags(*command, flags->options, all_methods, {"math", "storage"});
    add_count(*command, "--coarse", flags->coarse,
              "transfer: Triangles of a simplified mesh that blocks where it is far away; 0: none",
              0, 1 << 26);
    command->add_option("--gbuffer", flags->gbuffer, "What rasterises the camera's view")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"cl", "gl"}));
    add_ask_flags(*command, flags->ask);
    add_plan_flags(*command, flags->plan);
    add_verify_flag(*command, flags->verify, "picture");
    command->add_option("--frames", flags->frames, "Pictures to render and time; the last is kept")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
    command
        ->add_option("--fps", flags->fps,
                     "Play the animation at F frames a second from --time on; every frame is kept, "
                     "FILE.0000.exr and so on")
        ->type_name("F")
        ->default_str("none");
    command
        ->add_option("--replicates", flags->replicates,
                     "Render N randomised replicates, keep the mean and its standard error")
        ->type_name("N")
        ->default_str("none")
        ->check(CLI::Range(2, 100000));
    command->add_flag("--orbit", flags->orbit, "Turn the camera around the scene over the frames");
    command->add_flag("--spin-light", flags->spin_light, "Turn the lights over the frames");
    command->add_option("--stats", flags->stats, "JSON file with times and settings")
        ->type_name("FILE")
        ->default_str("none");
    add_device_flags(*command, flags->device);
    command->callback([flags, command] {
        flags->given = given_options(*command, all_methods);
        flags->plan_given = !given(*command, {"--tolerance", "--with", "--without"}).empty();
        run_render(*flags);
    });
}

}  // namespace clgi::program
