// clgi render SCENE -o out.exr [--png out.png]: from glTF to picture, by any method.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/advanced/static_scene.hpp>
#include <memory>
#include <optional>

#include "lab/coarse_mesh.hpp"
#include "lab/preview.hpp"
#include "lab/replicates.hpp"
#include "lab/timing.hpp"
#include "program/commands.hpp"
#include "program/count_flag.hpp"
#include "program/effects.hpp"
#include "program/gl_frames.hpp"
#include "program/motion.hpp"
#include "program/render_plan.hpp"
#include "program/stats.hpp"
#include "program/stopwatch.hpp"

namespace clgi::program {
namespace {

constexpr unsigned all_methods = of_direct | of_second_order | of_light_atlas | of_antiradiance |
                                 of_transfer | of_irradiance_cache;

// Options that a plan keeps where flags set them.
bool plan_keeps(const OptionRow& row) {
    for (const char* name : {"shadow-size", "face-size", "area-samples", "math", "storage"})
        if (row.name == name) return true;
    return false;
}

bool is_given(const RenderFlags& flags, const std::string& name) {
    return std::any_of(flags.given.begin(), flags.given.end(),
                       [&](const OptionRow* row) { return row->name == name; });
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

// Everything that a render is made of, from the flags to the last frame.
class Render {
public:
    explicit Render(RenderFlags& flags) : flags_(flags), options_(flags.options) {
        options_.picture.build = build_of(flags.device);
    }

    void run() {
        const bool quiet = flags_.device.quiet;
        const bool planned = plans(flags_);
        PictureOptions& picture = options_.picture;
        check_picture("render", flags_.picture, picture.width, picture.height);
        const TuningTarget target = planned ? TuningTarget() : request_of("render", flags_.ask);
        if (planned)
            plan_request(flags_);  // what is wrong with it is said before anything is loaded
        const bool tunes = target.frame_ms || target.error;
        scene_ = open_scene(flags_.scene, flags_.scene_index, flags_.environment, quiet,
                            planned || flags_.method == "atlas");
        check_camera("render", flags_.camera, scene_);
        prepare_motion(flags_, scene_);
        if (flags_.verify.on) truth_ = scene_;  // before a plan leaves something out
        if (flags_.gbuffer == "gl") gl_.emplace();
        session_ =
            gl_ ? open_session(flags_.device,
                               [&](const cl::Device& device) { return gl_->properties(device); })
                : open_session(flags_.device);
        const Programs programs(session_.context, session_.device);
        if (planned) {
            record_.planned = make_render_plan(flags_, session_, programs, scene_);
            options_ = record_.planned->plan;
        } else {
            options_.method = *method_of(flags_.method);
        }
        options_.animated = flags_.fps.has_value();
        if (flags_.fps) options_.clip = clip_of("render", scene_, flags_.animation);
        if (flags_.coarse > 0)
            options_.transfer.coarse =
                lab::coarse_mesh(scene_, static_cast<std::size_t>(flags_.coarse));
        camera_ = scene_.cameras[static_cast<std::size_t>(flags_.camera)];

        const Stopwatch build;
        DeviceScene device_scene(session_.context, session_.device, scene_);
        Renderer renderer(programs, session_.queue, scene_, device_scene, options_);
        renderer.build();
        renderer_ = &renderer;
        if (gl_) gl_->open(session_.queue, renderer);
        Motion motion(flags_, scene_, device_scene, session_.queue);
        moves_ = flags_.fps && moves(scene_);
        record_.build_ms = 1e3 * build.seconds();
        for (const std::string& warning : renderer.status().warnings)
            notice(quiet, "warning: " + warning);

        catch_interrupts();
        warm_up(motion);
        if (tunes) tune(target);
        for (int frame = 0; frame < flags_.frames; ++frame) render(frame, motion);
        if (flags_.replicates > 1)
            replicate();
        else if (!flags_.fps)
            check_and_save(lab::radiance_picture(*renderer_));
        motion.report();
        tell(motion);
    }

private:
    // The first picture is not timed: some drivers compile on the first launch.
    void warm_up(Motion& motion) {
        if (flags_.fps) follow(motion.at(0), true);  // builds its kernels; links are made for poses
        const Stopwatch watch;
        const auto bar = progress_bar(options_.method == Method::light_atlas ? "bake" : "render",
                                      flags_.device.quiet);
        if (gl_) {
            gl_->render(*renderer_, camera_).wait();
            if (!bar(1.0)) throw Interrupted();
            return;
        }
        prepare(bar);
        record_.prepare_ms = 1e3 * watch.seconds();
        if (!renderer_->run(camera_, bar) && !gave_up()) throw Interrupted();
    }

    bool gave_up() const { return renderer_->status().given_up; }

    void prepare(const Progress& progress) {
        if (!renderer_->prepare(progress) && !gave_up()) throw Interrupted();
    }

    void follow(const Motion::Step& step, bool vectors) {
        if (step.lights) renderer_->lights_changed();
        if (moves_ || (vectors && options_.method == Method::dynamic_transfer))
            renderer_->geometry_changed();
    }

    // A frame's time has all in it that follows from the lights and the pose: of a bake, only what
    // has changed.
    void render(int frame, Motion& motion) {
        const bool always = options_.method != Method::light_atlas;
        const auto go_on = [](double) { return !interrupted(); };
        record_.frame_ms.push_back(lab::time_frame(session_.queue, [&] {
            const Motion::Step step = motion.at(frame);
            last_camera_ = step.camera;
            follow(step, flags_.fps || frame == 0);
            if (always || step.lights) prepare(go_on);
            if (gl_)
                gl_->render(*renderer_, step.camera);
            else
                renderer_->render(step.camera);
        }));
        if (AntiradianceSolver* solver = renderer_->antiradiance())
            exchanges_.add(frame, solver->status(), solver->options());
        record_.passes.push_back(lab::pass_times(renderer_->times()));
        if (flags_.fps) save(numbered(flags_.picture, frame));
        if (interrupted()) throw Interrupted();
    }

    void tune(const TuningTarget& target) {
        SecondOrderSolver& solver = *renderer_->second_order();
        const auto go_on = [](double) { return !interrupted(); };
        const auto found =
            tune_second_order(session_.queue, renderer_->scene(), solver, camera_, target, go_on);
        if (!found || !solver.run(camera_, nullptr)) throw Interrupted();
        record_.ask = AskRecord{target, *found};
    }

    void replicate() {
        record_.replicates = lab::replicate(*renderer_, camera_, flags_.replicates,
                                            [](double) { return !interrupted(); });
        if (!record_.replicates) throw Interrupted();
        check_and_save(record_.replicates->mean);
    }

    // The picture of the last frame. --verify measures its error against all light. After Ctrl-C in
    // the check the picture is saved without it.
    void check_and_save(io::Image picture) {
        if (truth_) {
            const double spent = 1e-3 * (record_.build_ms + record_.prepare_ms +
                                         lab::spread(record_.frame_ms).median);
            record_.verified =
                verify(*truth_, flags_.verify, spent, [&](const auto& tracer, const auto& options) {
                    return tracer.verify(last_camera_, picture.width, picture.height,
                                         radiance_of(picture), options,
                                         progress_bar("verify", flags_.device.quiet));
                });
        }
        if (record_.verified) add_verified(picture, *record_.verified);
        save_picture(picture, flags_.picture);
        if (truth_ && interrupted()) throw Interrupted();
    }

    void save(const PictureFlags& files) { save_picture(lab::radiance_picture(*renderer_), files); }

    // Warnings, a line of the result, and --stats.
    void tell(const Motion& motion) {
        record_.device = session_.device;
        record_.bytes = renderer_->bytes_with_scene() + motion.bytes();
        record_.gbuffer = flags_.gbuffer;
        record_.exchanges = exchanges_;
        record_.warnings = scene_.warnings;
        if (record_.verified && record_.planned) {
            const std::string less = expected_less(record_.planned->plan.error, *record_.verified);
            if (!less.empty()) {
                record_.warnings.push_back(less);
                notice(false, "warning: " + less);
            }
        }
        fill(record_, *renderer_, scene_);
        for (const std::string& warning : troubles(*renderer_, exchanges_))
            notice(false, "warning: " + warning);
        if (gl_) {
            record_.gl_renderer = gl_->renderer();
            record_.gl_path = gl_->path();
            notice(flags_.device.quiet, fmt::format("OpenGL {}; {}", gl_->renderer(), gl_->path()));
            if (const std::uint32_t texels = gl_->non_finite())
                notice(false, fmt::format("warning: {} texels of the G-buffer were not finite and "
                                          "became background",
                                          texels));
        }
        if (record_.ask) {
            const std::string warning = ask_warning(*record_.ask);
            if (!warning.empty()) notice(false, warning);
        }
        if (!flags_.device.quiet)
            fmt::print("{}: {}\n", names_of(flags_.picture),
                       with_check(summary(record_, *renderer_)));
        if (!flags_.stats.empty()) save_stats(record_, flags_.stats);
    }

    // In the first line of the result.
    std::string with_check(std::string text) const {
        if (record_.verified)
            text.insert(std::min(text.find('\n'), text.size()),
                        ", " + verify_line(*record_.verified));
        return text;
    }

    RenderFlags& flags_;
    RendererOptions& options_;
    Scene scene_;
    Session session_;
    std::optional<GlFrames> gl_;
    Renderer* renderer_ = nullptr;
    Camera camera_;
    Camera last_camera_;          // of the last frame
    std::optional<Scene> truth_;  // with --verify
    bool moves_ = false;          // vertices do, between frames
    AntiradianceFrames exchanges_;
    RenderRecord record_;
};

void run_render(RenderFlags flags) {
    choose_method(flags);
    check(flags);
    Render(flags).run();
}

}  // namespace

void add_render(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a glTF scene");
    const auto flags = std::make_shared<RenderFlags>();
    command->add_option("scene", flags->scene, ".gltf or .glb file")
        ->required()
        ->type_name("SCENE");
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
    add_place_options(*command, flags->scene_index, flags->camera);
    add_environment_flags(*command, flags->environment);
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
    add_animation_flags(*command, flags->animation);
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
