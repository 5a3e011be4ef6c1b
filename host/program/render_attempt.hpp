// A render by one set of settings: from the scene to the last frame, checked.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/renderer.hpp>
#include <functional>
#include <memory>
#include <optional>

#include "program/gl_frames.hpp"
#include "program/motion.hpp"
#include "program/render_flags.hpp"
#include "program/sampling.hpp"
#include "program/stats.hpp"
#include "program/stopwatch.hpp"

namespace clgi::program {

// Whether a picture is made once, without one before it that is not timed: where a time or an error
// is asked for all of it.
bool renders_once(const RenderFlags& flags);

// Whether one picture is asked for, and no animation or measurement.
bool is_still(const RenderFlags& flags);

class RenderAttempt {
public:
    // scene: what is left of it by the plan, which is null without one. gl: null, or what draws the
    // camera's view. What is handed over by reference is kept.
    RenderAttempt(const RenderFlags& flags, const Session& session, const Programs& programs,
                  GlFrames* gl, Scene scene, const RendererOptions& options,
                  std::shared_ptr<const Planned> planned);

    // All frames; with --fps they are saved, too. Throws Interrupted.
    void draw();
    // More samples for the only frame, until they differ from their mean by no more than `error`,
    // or as many as take so many seconds; at least `least` together with its own, whatever they
    // take, and at most `most`. None where their number was given.
    void refine(double seconds, std::uint32_t least, double error, std::uint32_t most = 1024);
    // each: seconds that samples of another picture of this scene take but the first.
    void expect_samples(double each) { known_ = each; }
    // Measures the error against all light of a scene. decide: as in VerifyOptions.
    void check(const Scene& truth, double decide) { check(truth, decide, std::nullopt); }
    // The same in all of its time, where a check has ended early because it was decided.
    void check_fully(const Scene& truth);
    // Saves the picture of the last frame; warnings, a line of the result and --stats. attempts:
    // all for an error or a time that was asked for; used: seconds of that time.
    void finish(const std::vector<RenderedAttempt>& attempts = {}, bool meets_target = true,
                std::optional<double> used = std::nullopt);

    const RenderRecord& record() const { return record_; }
    double seconds() const;  // that the first samples took, with all before them
    double refining() const { return 1e-3 * record_.refine_ms; }
    // What a plan needs to know of the first sample of its picture, which nothing checked.
    PlanOutcome outcome() const;
    // As refine() has found it; none where it added no sample.
    std::optional<Sampling> sampling() const;

private:
    void check(const Scene& truth, double decide, std::optional<double> seconds);
    double check_limit() const;  // seconds of tracing
    void warm_up();
    bool gave_up() const { return renderer_.status().given_up; }
    void prepare(const Progress& progress);
    // ms that a picture or a sample takes; compiling meanwhile counts as time of building.
    double time_apart(const std::function<void()>& draw);
    double back(std::size_t samples) const { return refine_ms_[(turn_ + 4 - samples) % 4]; }
    void follow(const Motion::Step& step, bool vectors);
    void render(int frame);
    void tune(const TuningTarget& target);
    std::optional<double> expected_error() const;
    void tell();
    void warn();

    const Stopwatch watch_;  // since the scene is uploaded
    const RenderFlags& flags_;
    const Session& session_;
    GlFrames* gl_;
    RendererOptions options_;
    Scene scene_;
    DeviceScene device_scene_;
    Renderer renderer_;
    Motion motion_;
    Camera camera_;
    Camera last_camera_;  // of the last frame
    bool moves_;          // vertices do, between frames
    AntiradianceFrames exchanges_;
    RenderRecord record_;
    // Of the last four samples, in turns: the first ones take longer, and every second or fourth
    // may draw shadow maps.
    std::array<double, 4> refine_ms_{};
    std::size_t turn_ = 0;         // of the next one
    std::size_t refined_ = 0;      // samples but the first
    double known_ = 0.0;           // seconds of one of another picture; 0: unknown
    std::optional<double> doubt_;  // of the first sample, by the irradiance cache
    double traced_ = 0.0;          // seconds of the last check's paths
    io::Image picture_;            // of the last frame
};

}  // namespace clgi::program
