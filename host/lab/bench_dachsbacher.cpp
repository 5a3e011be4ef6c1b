// Tables 1 and 2 of [Dachsbacher07], run again: antiradiance in scenes whose light moves.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <clgi/renderer.hpp>
#include <clgi/scene_animator.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "lab/bench.hpp"
#include "lab/metrics.hpp"
#include "lab/preview.hpp"
#include "lab/reference_picture.hpp"
#include "lab/scenes/interiors.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// ---- scenes and settings ------------------------------------------------------------------------

// A scene, the settings that give about the paper's elements and links, and what the paper has, on
// a Xeon of 3 GHz with a GeForce 8800GTX.
struct DachsbacherScene {
    const char* name;
    double max_area;                    // m^2 of a leaf
    double bin_share;                   // LinkOptions::bin_share
    bool vertices;                      // ElementOptions::vertices
    int steps;                          // from here on the paper's:
    double triangles, elements, links;  // links: of pairs, for both directions
    double fps, fps_splatting;          // the second with splatting and 4x anti-aliasing
    double linking_s;
    double local_ms, global_ms, push_pull_ms;  // of all iterations
    double tables_mb, links_mb;
};

// Areas of leaves and shares of bins that give about the paper's elements and links, to a tenth;
// the character has 13 % fewer elements. Those of the bust are at its vertices, as in the paper. In
// the rooms without gloss links are 1.6 to 1.9 times as many however large the share is, because
// elements that overlap along a bin are refined (docs/papers.md): with shares of 4 and of 60 they
// differ by a twentieth.
constexpr DachsbacherScene dachsbacher_scenes[] = {
    {"office", 0.07, 4.0, false, 4, 5.6e3, 18.2e3, 632e3, 10.1, 9.0, 8.7, 7.1, 63.4, 14.0, 71.3,
     29.5},
    {"character", 0.1, 4.0, false, 4, 8.1e3, 19.7e3, 661e3, 8.3, 7.1, 13.1, 8.2, 72.0, 17.0, 77.0,
     31.1},
    {"oriental", 1.0, 4.0, false, 4, 11.9e3, 15.6e3, 776e3, 7.5, 6.8, 13.0, 10.8, 81.4, 18.9, 60.9,
     36.0},
    {"glossy-box", 1.0, 0.99, false, 3, 3.5e3, 4.6e3, 177e3, 14.9, 11.9, 2.4, 43.4, 2.4, 2.8, 17.8,
     3.8},
    {"glossy-bust", 1.0, 1.1, true, 3, 13.4e3, 11.5e3, 412e3, 6.4, 5.6, 13.0, 100.9, 5.6, 6.6, 44.9,
     8.8}};

Scene scene_of(const DachsbacherScene& row) {
    const std::string name = row.name;
    Scene scene = name == "office"       ? office()
                  : name == "character"  ? character()
                  : name == "oriental"   ? oriental_like()
                  : name == "glossy-box" ? glossy_box()
                                         : glossy_bust_like();
    if (scene.animation) scene.moving_bounds = motion_bounds(scene, 0);
    return scene;
}

RendererOptions options_of(const BenchSetup& setup, const DachsbacherScene& row,
                           const Scene& scene) {
    constexpr int paper_bins = 128, motion_poses = 16;
    RendererOptions out;
    out.method = Method::antiradiance;
    out.picture.width = 640;
    out.picture.height = 480;
    out.picture.build = setup.build;
    out.antiradiance.bins = paper_bins;
    out.antiradiance.elements.max_area = row.max_area;
    out.antiradiance.elements.vertices = row.vertices;
    out.antiradiance.links.bin_share = row.bin_share;
    out.antiradiance.iteration = Iteration::symmetric;
    out.antiradiance.steps = row.steps;
    if (scene.animation) out.antiradiance.poses = vertex_poses(scene, 0, motion_poses);
    return out;
}

// ---- frames -------------------------------------------------------------------------------------

constexpr int dachsbacher_rounds = 3;
constexpr int dachsbacher_warm_up = 3;

class DachsbacherRun {
public:
    DachsbacherRun(const BenchSetup& setup, const Programs& programs, const DachsbacherScene& row,
                   const Scene& scene)
        : setup_(setup),
          scene_(scene),
          device_(setup.context(), setup.device(), scene),
          renderer_(programs, setup.queue, scene, device_, options_of(setup, row, scene)) {
        renderer_.build();
        if (solver().moving_elements() == 0) return;
        animator_.emplace(programs, setup.queue, scene, device_, setup.build);
        duration_ = scene.animation->clips.at(0).duration;
    }

    struct Frame {
        double light_ms = 0.0;          // the light moves, until the light of all leaves is there
        double picture_ms = 0.0;        // after that
        std::vector<PassEvent> passes;  // of the light
    };
    // One frame, waited for, on the host's clock. share: of the way of the light, which ends where
    // it begins; at 0 it is the scene's own.
    Frame frame(double share) {
        Frame out;
        const auto begin = Clock::now();
        move(share);
        renderer_.prepare();
        const auto lit = Clock::now();
        renderer_.render(scene_.cameras.at(0)).wait();
        out.light_ms = milliseconds(lit - begin);
        out.picture_ms = milliseconds(Clock::now() - lit);
        out.passes = solver().events();
        return out;
    }

    // Frames over the way of the light, in rounds that do not repeat each other: f(round, frame).
    template <typename F>
    void play(double begin, double part, F&& f) {
        for (int k = 0; k < dachsbacher_warm_up; ++k) frame(0.0);
        for (int round = 0; round < dachsbacher_rounds; ++round)
            for (int k = 0; k < setup_.repeats; ++k) {
                const double offset = static_cast<double>(round) / dachsbacher_rounds;
                f(round, frame((k + offset) / setup_.repeats));
                const double done = (round + (k + 1.0) / setup_.repeats) / dachsbacher_rounds;
                setup_.report(begin + part * done);
            }
    }

    // relative_error of a picture of the light of the last frame, without or with direct light.
    // Later frames are like it.
    double error(bool direct) {
        reference::Options options;
        options.width = 320;
        options.height = 240;
        options.samples = setup_.samples;
        const std::string effects = direct ? "all" : "indirect";
        options.effects = reference::parse_effects(effects);
        const reference::Picture truth = reference::PathTracer(scene_).render(
            scene_.cameras.at(0), options,
            [&](double) { return !setup_.progress || setup_.progress(0.0); });
        if (truth.cancelled) throw Error("bench: cancelled");
        PictureOptions picture = renderer_.options().picture;
        picture.width = options.width;
        picture.height = options.height;
        picture.direct = direct;
        renderer_.reconfigure(picture);
        renderer_.render(scene_.cameras.at(0));
        return relative_error(radiance_picture(renderer_), reference_image(truth, effects));
    }

    const AntiradianceSolver& solver() const { return *renderer_.antiradiance(); }

private:
    // What changes from frame to frame: lights, and geometry where the scene has a clip.
    void move(double share) {
        constexpr double most_turn = 0.08;  // radians, of the light to either side
        const double angle = most_turn * std::sin(2.0 * glm::pi<double>() * share);
        const glm::dquat turn = glm::angleAxis(angle, glm::dvec3(0.0, 1.0, 0.0));
        if (animator_) renderer_.geometry_changed({animator_->animate(0, share * duration_).done});
        for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
            Light light = scene_.lights[i];
            light.direction = glm::normalize(glm::vec3(turn * glm::dvec3(light.direction)));
            device_.set_light(i, light);
        }
        renderer_.lights_changed();
    }

    const BenchSetup& setup_;
    const Scene& scene_;
    DeviceScene device_;
    Renderer renderer_;
    std::optional<SceneAnimator> animator_;  // where geometry moves
    double duration_ = 0.0;                  // seconds, of its clip
};

// ---- rows ---------------------------------------------------------------------------------------

// A frame: a light moves, its shadow map and direct light in the leaves, the steps, and a picture
// with shadowed direct light. Of the median frame, in the quickest of three rounds.
Json dachsbacher_row1(const BenchSetup& setup, DachsbacherRun& run, const DachsbacherScene& row,
                      const Scene& scene, double begin, double part) {
    std::vector<double> frames[dachsbacher_rounds], lights[dachsbacher_rounds];
    run.play(begin, part, [&](int round, const DachsbacherRun::Frame& frame) {
        frames[round].push_back(frame.light_ms + frame.picture_ms);
        lights[round].push_back(frame.light_ms);
    });
    double fps = 0.0, light_fps = 0.0;
    for (int round = 0; round < dachsbacher_rounds; ++round) {
        fps = std::max(fps, 1e3 / spread(frames[round]).median);
        light_fps = std::max(light_fps, 1e3 / spread(lights[round]).median);
    }

    run.frame(0.0);
    const AntiradianceSolver& solver = run.solver();
    const AntiradianceStatus status = solver.status();
    if (status.non_finite > 0)
        throw Error(fmt::format("bench: {} has {} leaves with light that is not finite", row.name,
                                status.non_finite));
    if (status.given_up) throw Error(fmt::format("bench: the light of {} diverged", row.name));
    const bool errors = setup.samples > 0;
    return {{"scene", row.name},
            {"bins", solver.options().bins},
            {"steps", status.residuals.size()},
            {"triangles", scene.triangles.size()},
            {"elements", solver.elements().count()},
            {"leaves", solver.elements().leaves},
            {"pairs", solver.link_pairs()},  // of linked elements: the paper's links
            {"links", solver.link_count()},  // for one direction and one bin each
            {"fps", fps},
            {"light_fps", light_fps},  // without the picture
            {"paper_fps", row.fps},
            {"ratio", fps / row.fps},
            {"error", errors ? Json(run.error(true)) : Json()},
            {"indirect_error", errors ? Json(run.error(false)) : Json()},
            {"residual", status.residuals.empty() ? 0.0 : status.residuals.back()},
            {"paper_triangles", row.triangles},
            {"paper_elements", row.elements},
            {"paper_links", row.links},
            {"paper_fps_splatting", row.fps_splatting}};
}

// Times on the device of all steps, medians of frames.
Json dachsbacher_row2(DachsbacherRun& run, const DachsbacherScene& row, double begin, double part) {
    constexpr double megabyte = 1 << 20;
    enum Part { local, global, push_pull, other, parts };
    std::vector<double> times[parts];
    run.play(begin, part, [&](int, const DachsbacherRun::Frame& frame) {
        double sums[parts] = {};
        for (const PassTime& pass : pass_times(frame.passes)) {
            const Part of =
                pass.name == "antiradiance.local" || pass.name == "antiradiance.gloss" ? local
                : pass.name == "antiradiance.global"                                   ? global
                : pass.name == "antiradiance.pull" || pass.name == "antiradiance.push" ? push_pull
                                                                                       : other;
            sums[of] += pass.milliseconds;
        }
        for (int i = 0; i < parts; ++i) times[i].push_back(sums[i]);
    });
    const AntiradianceSolver& solver = run.solver();
    return {{"scene", row.name},
            {"linking_s", solver.linking_seconds()},  // elements and links
            {"local_ms", spread(times[local]).median},
            {"global_ms", spread(times[global]).median},
            {"push_pull_ms", spread(times[push_pull]).median},
            {"other_ms", spread(times[other]).median},  // shadow maps, direct light, sums
            {"tables_mb", static_cast<double>(solver.table_bytes()) / megabyte},
            {"links_mb", static_cast<double>(solver.link_bytes()) / megabyte},
            {"paper_linking_s", row.linking_s},
            {"paper_local_ms", row.local_ms},
            {"paper_global_ms", row.global_ms},
            {"paper_push_pull_ms", row.push_pull_ms},
            {"paper_tables_mb", row.tables_mb},
            {"paper_links_mb", row.links_mb}};
}

}  // namespace

BenchTable bench_dachsbacher(const BenchSetup& setup) {
    const std::vector<DachsbacherScene> rows = chosen_rows(dachsbacher_scenes, setup.only);
    const Programs programs(setup.context(), setup.device());
    const bool first = setup.table == "dachsbacher1";
    const double part = 1.0 / static_cast<double>(rows.size());
    BenchTable out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Scene scene = scene_of(rows[i]);
        DachsbacherRun run(setup, programs, rows[i], scene);
        const double begin = part * static_cast<double>(i);
        out.json["rows"].push_back(first ? dachsbacher_row1(setup, run, rows[i], scene, begin, part)
                                         : dachsbacher_row2(run, rows[i], begin, part));
    }
    if (first) {
        out.note = "in brackets the paper's; links of pairs, frames of 640x480\n";
        out.columns = {{"scene", 12, "{scene}"},
                       {"triangles", 16, "{triangles:.1f}K ({paper_triangles:.1f}K)", 1e-3},
                       {"elements", 18, "{elements:.1f}K ({paper_elements:.1f}K)", 1e-3},
                       {"pairs", 20, "{pairs:.1f}K ({paper_links:.1f}K)", 1e-3},
                       {"steps", 7, "{steps:.0f}"},
                       {"fps", 8, "{fps:.1f}"},
                       {"no picture", 12, "{light_fps:.1f}"},
                       {"paper", 8, "{paper_fps:.1f}"},
                       {"ratio", 7, "{ratio:.1f}"},
                       {"error", 9, "{error:.1f} %", 100.0},
                       {"indirect", 10, "{indirect_error:.1f} %", 100.0}};
    } else {
        out.note = "in brackets the paper's; times of all steps\n";
        out.columns = {{"scene", 12, "{scene}"},
                       {"linking s", 16, "{linking_s:.2f} ({paper_linking_s:.1f})"},
                       {"local ms", 16, "{local_ms:.1f} ({paper_local_ms:.1f})"},
                       {"global ms", 16, "{global_ms:.1f} ({paper_global_ms:.1f})"},
                       {"push, pull ms", 16, "{push_pull_ms:.1f} ({paper_push_pull_ms:.1f})"},
                       {"other ms", 10, "{other_ms:.1f}"},
                       {"tables MB", 16, "{tables_mb:.1f} ({paper_tables_mb:.1f})"},
                       {"links MB", 16, "{links_mb:.1f} ({paper_links_mb:.1f})"}};
    }
    return out;
}

}  // namespace clgi::lab
