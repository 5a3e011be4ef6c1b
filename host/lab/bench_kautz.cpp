// Tables 1 and 2 of [Kautz04], run again: transfer vectors of scenes that deform.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <clgi/error.hpp>
#include <clgi/scene_animator.hpp>
#include <cmath>
#include <numeric>
#include <optional>

#include "lab/bench.hpp"
#include "lab/coarse_mesh.hpp"
#include "lab/scenes/deforming.hpp"
#include "lab/timing.hpp"
#include "lab/transfer_truth.hpp"
#include "lab/transfer_vectors.hpp"

namespace clgi::lab {
namespace {

// ---- scenes and settings ------------------------------------------------------------------------

// A scene and what the paper has of it.
struct KautzScene {
    const char* name;
    std::size_t coarse;  // low-resolution triangles
    double fps;          // on two Intel Xeon of 3.06 GHz
    double triangles;    // that a vertex looks at, on average
    double fps_sets;     // with potentially visible sets; 0: the paper has none
    double triangles_sets;
    double error;      // of transfer vectors: mean relative L2
    double shares[4];  // of the shadow loop, as kautz_parts
};
constexpr const char* kautz_parts[] = {"rasterization", "integration", "transform", "other"};

// [Kautz04, tables 1 and 2]
constexpr KautzScene kautz_scenes[] = {
    {"cloth", 160, 15.5, 236.4, 0.0, 0.0, 0.0247, {0.480, 0.235, 0.265, 0.020}},
    {"fight", 444, 4.9, 448.8, 9.5, 99.5, 0.0793, {0.544, 0.194, 0.244, 0.018}},
    {"chess", 382, 7.8, 378.8, 15.1, 73.9, 0.0289, {0.520, 0.238, 0.219, 0.023}},
    {"hand", 378, 2.6, 414.1, 6.1, 49.7, 0.0382, {0.423, 0.352, 0.194, 0.031}}};

// With the box of its motion; every vertex is one receiver, as in the paper.
Scene scene_of(const KautzScene& row) {
    const std::string name = row.name;
    Scene scene = name == "cloth"   ? cloth()
                  : name == "fight" ? fight_like()
                  : name == "chess" ? chess()
                                    : hand_like();
    scene.moving_bounds = motion_bounds(scene, 0);
    for (Material& material : scene.materials) material.double_sided = false;
    return scene;
}

// How transfer vectors are computed.
struct KautzSettings {
    const char* name;
    MaskOptions masks;
    CellIntegral cells = CellIntegral::exact;
    double coarse = 1.0;  // of the paper's low-resolution triangles; 0: all of the scene block
    int rings = 1;
    double pose = 0.0;  // that is simplified: at this part of the clip
    bool sets = false;  // potentially visible sets of frames spread over the clip
};

// The rows of table 1 for a scene, without and with visible sets.
std::vector<KautzSettings> kautz_settings(const KautzScene& row) {
    KautzSettings paper{"paper", {}};
    paper.masks.planes = EdgePlanes::table;
    paper.masks.block = 4;
    paper.cells = CellIntegral::centre;
    // A mesh simplified in the middle of the clip is closer to its poses than the one at rest. Half
    // as many triangles again take less time than exact edges or finer masks, and do more against
    // the error; with visible sets most of them are in no list.
    KautzSettings ours{"clgi", {}};
    ours.masks.planes = EdgePlanes::table;
    ours.coarse = 1.5;
    ours.rings = 2;
    ours.pose = 0.5;
    // All triangles block everywhere.
    KautzSettings fine{"fine", {}};
    fine.masks.size = 128;
    fine.coarse = 0.0;
    if (row.fps_sets == 0.0) return {paper, ours, fine};
    KautzSettings paper_sets = paper, our_sets = ours;
    paper_sets.sets = our_sets.sets = true;
    our_sets.coarse = 2.5;
    return {paper, paper_sets, ours, our_sets, fine};
}

// About `count` triangles for the far blockers. Parts of a few triangles stay whole: as solids of
// four they would no longer cover what is under them, such as the nails of the hand.
std::vector<glm::uvec3> far_mesh(Scene scene, std::size_t count) {
    constexpr std::uint32_t few = 32;
    std::vector<glm::uvec3> small;
    std::vector<SceneTriangle> rest;
    for (const Part& part : scene.parts)
        for (std::uint32_t i = 0; i < part.triangle_count; ++i) {
            const SceneTriangle& triangle = scene.triangles[part.first_triangle + i];
            if (part.triangle_count <= few)
                small.emplace_back(triangle.vertex[0], triangle.vertex[1], triangle.vertex[2]);
            else
                rest.push_back(triangle);
        }
    scene.triangles = std::move(rest);
    scene.parts.clear();
    std::vector<glm::uvec3> out = coarse_mesh(scene, count);
    out.insert(out.end(), small.begin(), small.end());
    return out;
}

DynamicTransferOptions options_of(const BenchSetup& setup, const Scene& scene, std::size_t coarse,
                                  const KautzSettings& settings) {
    DynamicTransferOptions out;
    out.masks = settings.masks;
    out.cells = settings.cells;
    out.rings = settings.rings;
    out.build = setup.build;
    if (settings.coarse > 0.0) {
        const double time = settings.pose * scene.animation->clips[0].duration;
        out.coarse =
            far_mesh(posed(scene, pose_at(*scene.animation, 0, time)),
                     static_cast<std::size_t>(std::lround(settings.coarse * double(coarse))));
    }
    return out;
}

// ---- frames -------------------------------------------------------------------------------------

constexpr int kautz_rounds = 3;
constexpr int kautz_warm_up = 5;

// Frames spread over the clip, in rounds: f(round, seconds).
template <typename F>
void play_clip(int frames, double duration, F&& f) {
    for (int round = 0; round < kautz_rounds; ++round)
        for (int k = 0; k < frames; ++k)
            f(round, duration * (k + static_cast<double>(round) / kautz_rounds) / frames);
}

class KautzRun {
public:
    KautzRun(const BenchSetup& setup, const Programs& programs, const Scene& scene,
             std::size_t paper_coarse, const KautzSettings& settings)
        : queue_(setup.queue),
          device_(setup.context(), setup.device(), scene),
          animator_(programs, setup.queue, scene, device_, setup.build),
          solver_(programs, setup.queue, scene, device_,
                  options_of(setup, scene, paper_coarse, settings)) {
        if (!settings.sets) return;
        constexpr int looks = 24;  // frames whose visible sets are taken
        for (int look = 0; look < looks; ++look) {
            const Animated at = animator_.animate(0, duration() * look / looks);
            solver_.look({at.done}).wait();
        }
        solver_.restrict(solver_.sets());
    }

    // One frame, waited for: pose, blockers, masks, integration and the inner product with the
    // light. Milliseconds on the host's clock.
    double frame(double seconds) {
        const Clock::time_point begin = Clock::now();
        const Animated at = animator_.animate(0, seconds);
        solver_.transfer({at.done});
        solver_.light();
        queue_.finish();
        return milliseconds(Clock::now() - begin);
    }

    // The same in steps, waited for each: what the pose takes, and the device's passes.
    struct Steps {
        double pose_ms = 0.0;
        std::vector<PassEvent> passes;
    };
    Steps steps(double seconds, const std::optional<glm::dvec3>& eye = {}) {
        Steps out;
        const Clock::time_point begin = Clock::now();
        animator_.animate(0, seconds).done.wait();
        out.pose_ms = milliseconds(Clock::now() - begin);
        const auto keep = [&] {
            queue_.finish();
            for (const PassEvent& pass : solver_.events()) out.passes.push_back(pass);
        };
        solver_.transfer();
        keep();
        if (eye) {
            solver_.reflect(device_.frame().to_local(*eye));
            keep();
        }
        solver_.light();
        keep();
        return out;
    }

    // The transfer vectors of some vertices of the scene after the last frame: [vertices][terms].
    std::vector<double> vectors(const std::vector<std::uint32_t>& vertices) const {
        const TransferVectors all = transfer_vectors(queue_, solver_, device_);
        std::vector<double> out;
        for (const std::uint32_t v : vertices)
            for (const Plane& term : all.front) out.push_back(term[v]);
        return out;
    }

    double duration() const { return animator_.animation().clips[0].duration; }
    const DynamicTransferSolver& solver() const { return solver_; }

private:
    cl::CommandQueue queue_;
    DeviceScene device_;
    SceneAnimator animator_;
    DynamicTransferSolver solver_;
};

// ---- rows ---------------------------------------------------------------------------------------

// truth: of this scene, or null.
Json kautz_row(const BenchSetup& setup, const Programs& programs, const KautzScene& row,
               const Scene& scene, const KautzSettings& settings, const TransferTruth* truth) {
    KautzRun run(setup, programs, scene, row.coarse, settings);
    for (int k = 0; k < kautz_warm_up; ++k) run.frame(0.0);
    const int frames = settings.coarse > 0.0 ? setup.repeats : std::max(setup.repeats / 10, 1);
    std::vector<double> times[kautz_rounds];
    play_clip(frames, run.duration(),
              [&](int round, double seconds) { times[round].push_back(run.frame(seconds)); });
    double fps = 0.0, all = 0.0;  // fps: of the median frame, in the quickest round
    for (const std::vector<double>& round : times) {
        fps = std::max(fps, 1e3 / spread(round).median);
        all += std::accumulate(round.begin(), round.end(), 0.0);
    }
    const MaskOptions& masks = settings.masks;
    const double paper_fps = settings.sets ? row.fps_sets : row.fps;
    Json out = {{"scene", row.name},
                {"settings", settings.name},
                {"pvs", settings.sets},
                {"vertices", scene.positions.size()},
                {"triangles", scene.triangles.size()},
                {"low_res_triangles", run.solver().options().coarse.size()},
                {"listed", run.solver().triangles_per_receiver()},
                {"paper_listed", settings.sets ? row.triangles_sets : row.triangles},
                {"fps", fps},
                {"mean_fps", 1e3 * kautz_rounds * frames / all},
                {"paper_fps", paper_fps},
                {"ratio", fps / paper_fps},
                {"error", nullptr},
                {"paper_error", row.error},
                {"mask", masks.size},
                {"table", masks.planes == EdgePlanes::table ? Json(masks.table_size) : Json()},
                {"block", masks.block},
                {"cells", settings.cells == CellIntegral::exact ? "exact" : "centre"},
                {"rings", settings.rings}};
    if (!truth) return out;

    TransferErrors errors;
    for (std::size_t frame = 0; frame < truth->seconds.size(); ++frame) {
        run.frame(truth->seconds[frame]);
        errors.add(run.vectors(truth->vertices), truth->vectors[frame], settings.masks.bands);
    }
    const TransferError error = errors.error();
    out["error"] = error.mean;
    out["error_lit"] = error.lit;
    out["error_rms"] = error.root;
    out["noise"] = truth->noise;
    out["vertices_counted"] = error.counted;
    out["vertices_lit"] = error.counted_lit;
    out["vertices_left_out"] = error.left_out;
    return out;
}

// Shares of all frames' time, and the median of a frame's steps together.
Json shares_of(const BenchSetup& setup, const KautzScene& row, KautzRun& run) {
    std::vector<double> whole;
    double sums[4] = {}, all = 0.0;
    for (int k = 0; k < kautz_warm_up; ++k) run.steps(0.0);
    play_clip(setup.repeats, run.duration(), [&](int, double seconds) {
        const KautzRun::Steps steps = run.steps(seconds);
        double of[4] = {0.0, 0.0, steps.pose_ms, 0.0};
        for (const PassTime& pass : pass_times(steps.passes)) {
            const int which =
                pass.name == "transfer.mask"                                            ? 0
                : pass.name == "transfer.integrate"                                     ? 1
                : pass.name == "transfer.receivers" || pass.name == "transfer.blockers" ? 2
                                                                                        : 3;
            of[which] += pass.milliseconds;
        }
        whole.push_back(std::accumulate(of, of + 4, 0.0));
        all += whole.back();
        for (int i = 0; i < 4; ++i) sums[i] += of[i];
    });
    Json out = {{"scene", row.name}, {"frame_ms", spread(whole).median}};
    for (int i = 0; i < 4; ++i) {
        out[kautz_parts[i]] = sums[i] / all;
        out[std::string("paper_") + kautz_parts[i]] = row.shares[i];
    }
    return out;
}

// What gloss costs beside diffuse light: the hand with a lobe, medians of device times.
Json gloss_of(const BenchSetup& setup, const Programs& programs, const KautzScene& hand,
              const Scene& matt, const KautzSettings& settings) {
    HandOptions options;
    options.roughness = 0.5f;
    Scene scene = hand_like(options);
    scene.moving_bounds = matt.moving_bounds;
    KautzRun run(setup, programs, scene, hand.coarse, settings);
    const glm::dvec3 eye = scene.cameras.at(0).position;
    std::vector<double> mask, diffuse, gloss;
    for (int k = 0; k < kautz_warm_up; ++k) run.steps(0.0, eye);
    play_clip(setup.repeats, run.duration(), [&](int, double seconds) {
        for (const PassTime& pass : pass_times(run.steps(seconds, eye).passes)) {
            if (pass.name == "transfer.mask") mask.push_back(pass.milliseconds);
            if (pass.name == "transfer.integrate") diffuse.push_back(pass.milliseconds);
            if (pass.name == "transfer.integrate_gloss") gloss.push_back(pass.milliseconds);
        }
    });
    const double mask_ms = spread(mask).median, integrate_ms = spread(diffuse).median,
                 gloss_ms = spread(gloss).median, plain = mask_ms + integrate_ms;
    // instead: one BRDF a vertex, as in the paper; besides: both integrals against the diffuse one.
    return {{"mask_ms", mask_ms},
            {"integrate_ms", integrate_ms},
            {"integrate_gloss_ms", gloss_ms},
            {"instead", (mask_ms + gloss_ms) / plain},
            {"besides", (plain + gloss_ms) / plain}};
}

}  // namespace

BenchTable bench_kautz1(const BenchSetup& setup) {
    const std::vector<KautzScene> rows = chosen_rows(kautz_scenes, setup.only);
    const Programs programs(setup.context(), setup.device());
    BenchTable out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Scene scene = scene_of(rows[i]);
        const std::vector<KautzSettings> all = kautz_settings(rows[i]);
        std::optional<TransferTruth> truth;
        if (setup.vertices > 0) truth = transfer_truth(scene, setup.vertices);
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double part = static_cast<double>(k + 1) / static_cast<double>(all.size() + 1);
            setup.report((static_cast<double>(i) + part) / static_cast<double>(rows.size()));
            out.json["rows"].push_back(
                kautz_row(setup, programs, rows[i], scene, all[k], truth ? &*truth : nullptr));
        }
    }
    out.note =
        "errors in per cent: of all vertices, of those that are lit, root of the mean square\n";
    out.columns = {{"scene", 6, "{scene}"},
                   {"PVS", 4, "{pvs}"},
                   {"vertices", 9, "{vertices:.0f}"},
                   {"triangles", 10, "{triangles:.0f}"},
                   {"low-res", 8, "{low_res_triangles:.0f}"},
                   {"listed", 8, "{listed:.1f}"},
                   {"paper", 7, "{paper_listed:.1f}"},
                   {"fps", 8, "{fps:.1f}"},
                   {"paper", 7, "{paper_fps:.1f}"},
                   {"ratio", 7, "{ratio:.1f}"},
                   {"error", 7, "{error:.2f}", 100.0},
                   {"lit", 6, "{error_lit:.2f}", 100.0},
                   {"root", 6, "{error_rms:.2f}", 100.0},
                   {"paper", 7, "{paper_error:.2f}", 100.0},
                   {"mask", 5, "{mask:.0f}"},
                   {"table", 6, "{table:.0f}"},
                   {"block", 6, "{block:.0f}"},
                   {"cells", 7, "{cells}"},
                   {"rings", 6, "{rings:.0f}"},
                   {"settings", 9, "{settings}"}};
    return out;
}

BenchTable bench_kautz2(const BenchSetup& setup) {
    const std::vector<KautzScene> rows = chosen_rows(kautz_scenes, setup.only);
    const Programs programs(setup.context(), setup.device());
    BenchTable out;
    Json table, gloss;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        setup.report(static_cast<double>(i) / static_cast<double>(rows.size()));
        const Scene scene = scene_of(rows[i]);
        const KautzSettings settings = kautz_settings(rows[i]).front();
        KautzRun run(setup, programs, scene, rows[i].coarse, settings);
        table.push_back(shares_of(setup, rows[i], run));
        if (rows[i].name == std::string("hand"))
            gloss = gloss_of(setup, programs, rows[i], scene, settings);
    }
    out.json = {{"rows", table}, {"gloss", gloss}};
    if (!gloss.is_null())
        out.after = filled(
            "\n\nhand with gloss: masks {mask_ms:.2f} ms, integrate {integrate_ms:.2f} ms, "
            "integrate_gloss {integrate_gloss_ms:.2f} ms\n"
            "masks and gloss take {instead:.3f} of masks and diffuse; all three {besides:.3f}",
            gloss);
    out.note = "per cent of the time, in brackets the paper's\n";
    out.columns = {{"scene", 8, "{scene}"}, {"frame ms", 9, "{frame_ms:.2f}"}};
    for (const std::string part : kautz_parts)
        out.columns.push_back({part, 18, "{" + part + ":.1f} ({paper_" + part + ":.1f})", 100.0});
    return out;
}

}  // namespace clgi::lab
