// SPDX-License-Identifier: MIT
#include "lab/sweep_transfer.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <clgi/scene_mover.hpp>
#include <optional>

#include "lab/coarse_mesh.hpp"
#include "lab/metrics.hpp"
#include "lab/reference_picture.hpp"
#include "lab/sweep_run.hpp"
#include "lab/timing.hpp"
#include "lab/transfer_vectors.hpp"

namespace clgi::lab {
namespace {

constexpr const char* traced_effects = "emission,direct";
constexpr int smooth_bands = sh::default_bands, smooth_texels = 256;

// The environment alone lights it.
Scene without_lamps(const Scene& scene) {
    if (!scene.environment)
        throw InputError("sweep: --method transfer needs an environment; --environment adds one");
    if (scene.triangles.empty()) throw InputError("sweep: the scene has no triangles");
    Scene out = scene;
    out.lights.clear();
    for (Material& material : out.materials) {
        material.emission = glm::vec3(0.0f);
        material.emission_texture = {};
    }
    return out;
}

struct TransferLooks {
    VisibleSets sets;           // for DynamicTransferSolver::restrict, of this scene and options
    double milliseconds = 0.0;  // of looking, warm, and of making lists; without posing
};

class TransferRun {
public:
    TransferRun(const SweepSetup& setup, const TransferSweep& motion)
        : setup_(setup),
          motion_(motion),
          progress_(setup.progress),
          scene_(without_lamps(setup.scene)),
          smooth_(scene_),
          device_scene_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(),
                        setup.queue.getInfo<CL_QUEUE_DEVICE>(), scene_),
          programs_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(),
                    setup.queue.getInfo<CL_QUEUE_DEVICE>()) {}

    Sweep operator()() {
        const auto count = static_cast<int>(scene_.positions.size());
        out_ = sweep_of(SweepOf::vertices, setup_);
        out_.width = std::min(count, most_columns);
        out_.height = (count + most_columns - 1) / most_columns;
        out_.methods = {transfer_fine, transfer_levels, transfer_sets};
        out_.knobs = {"sh-order", "mask",  "mask-block", "cells", "table",
                      "coarse",   "rings", "looks",      "spp"};
        place();
        smooth_environment_of_scene();
        const reference::PathTracer full(scene_), smooth(smooth_);
        find_truth("full", full, scene_, 0.0);
        find_truth("smooth", smooth, smooth_, 0.2);
        leave_out_what_is_inside();
        if (setup_.path_tracer) {
            trace(full, full_environment, 0.4);
            trace(smooth, smooth_environment, 0.5);
        }
        progress_.part(0.6, 0.4);
        if (setup_.solver) transfer();
        mark_fronts(out_);
        return std::move(out_);
    }

private:
    // Vertices with triangles.
    void place() {
        counted_ = {
            out_.width, out_.height,
            std::vector<std::uint8_t>(
                static_cast<std::size_t>(out_.width) * static_cast<std::size_t>(out_.height), 0),
            0};
        for (const std::uint32_t v : device_scene_.vertex_order()) counted_.counts[v] = 1;
        for (std::size_t v = 0; v < scene_.positions.size(); ++v)
            if (counted_[v]) {
                vertices_.push_back(static_cast<std::uint32_t>(v));
                places_.push_back({scene_.positions[v], scene_.normals[v]});
            }
        counted_.pixels = vertices_.size();
    }

    void smooth_environment_of_scene() {
        DynamicTransferOptions options;
        options.masks.size = 8;  // only its light is read
        options.masks.bands = smooth_bands;
        options.build = setup_.build;
        DynamicTransferSolver solver(programs_, setup_.queue, scene_, device_scene_, options);
        solver.light().wait();
        std::vector<glm::vec4> light(static_cast<std::size_t>(sh::terms(smooth_bands)));
        setup_.queue.enqueueReadBuffer(solver.environment(), CL_TRUE, 0,
                                       light.size() * sizeof(glm::vec4), light.data());
        std::vector<glm::dvec3> coefficients;
        for (const glm::vec4& c : light)
            coefficients.push_back(device_scene_.frame().exposure * glm::dvec3(c));
        if (!(coefficients.front().x + coefficients.front().y + coefficients.front().z > 0.0))
            throw InputError("sweep: the environment is black");
        light_ = smoothed_light(std::move(coefficients));
        smooth_.environment = picture_of_light(light_, smooth_texels);
    }

    io::Image blank() const { return blank_irradiance(out_.width, out_.height, {"R", "G", "B"}); }

    io::Image image_of(const reference::Irradiance& found) const {
        return irradiance_image(
            blank_irradiance(out_.width, out_.height, {"R", "G", "B", "error.Y"}), vertices_, found,
            traced_effects);
    }

    void find_truth(const std::string& name, const reference::PathTracer& tracer,
                    const Scene& scene, double from) {
        progress_.part(from, 0.2);
        add_truth(out_, name, traced_effects,
                  kept_image(setup_.folder / ("reference-" + name + ".exr"),
                             fmt::format("vertices {} {} {}", tracer_version,
                                         setup_.reference_samples, scene_key(scene)),
                             [&] {
                                 const reference::Irradiance found = tracer.irradiance(
                                     places_, tracing(traced_effects, setup_.reference_samples),
                                     [&](double done) { return progress_.goes_on(done); });
                                 return found.cancelled ? io::Image() : image_of(found);
                             }));
    }

    void leave_out_what_is_inside() {
        const io::Image& truth = out_.truths[smooth_environment].picture;
        for (const std::uint32_t v : vertices_) {
            const glm::dvec3 found(truth.find("R")->values[v], truth.find("G")->values[v],
                                   truth.find("B")->values[v]);
            if (sees_sky(found, light_, scene_.normals[v])) continue;
            counted_.counts[v] = 0;
            --counted_.pixels;
        }
        if (counted_.pixels == 0) throw InputError("sweep: no vertex sees the environment");
    }

    void trace(const reference::PathTracer& tracer, IrradianceTruth truth, double from) {
        progress_.part(from, 0.1);
        trace_irradiance(
            out_, setup_, out_.truths[truth], tracer, places_,
            [&](const auto& found) { return image_of(found); }, counted_, progress_);
    }

    // What the solver says under the scene's own environment.
    io::Image lit(const DynamicTransferSolver& solver) const {
        const std::size_t stride = solver.receivers().stride;
        std::vector<float> found(3 * stride);
        setup_.queue.enqueueReadBuffer(solver.irradiance(), CL_TRUE, 0,
                                       found.size() * sizeof(float), found.data());
        io::Image out = blank();
        const std::vector<std::uint32_t>& order = device_scene_.vertex_order();
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t v = 0; v < order.size(); ++v)
                out.channels[c].values[order[v]] = static_cast<float>(
                    device_scene_.frame().exposure * double{found[c * stride + v]});
        return out;
    }

    // The same vectors under the smooth one.
    io::Image smoothly_lit(const TransferVectors& vectors) const {
        io::Image out = blank();
        const std::size_t terms = std::min(vectors.front.size(), light_.size());
        for (const std::uint32_t v : vertices_) {
            glm::dvec3 sum(0.0);
            for (std::size_t i = 0; i < terms; ++i) sum += double{vectors.front[i][v]} * light_[i];
            set_rgb(out, v, glm::vec3(glm::max(sum, 0.0)));
        }
        return out;
    }

    // Potentially visible sets of frames spread evenly over the clip, from its beginning on;
    // without motion of the scene as it is, however many frames. In a scene of its own on the
    // device: the other stays in the pose that is measured. Both have the same order of triangles,
    // as they are made of the same pose.                                             [Kautz04,
    // section 3.2]
    TransferLooks look_at_frames(const DynamicTransferOptions& options, int frames,
                                 const Progress& part) {
        DeviceScene device(programs_.context(), programs_.device(), scene_);
        DynamicTransferSolver solver(programs_, setup_.queue, scene_, device, options);
        solver.look().wait();  // builds the kernel
        solver.sets();
        std::optional<SceneMover> mover;
        if (motion_.animated) mover.emplace(programs_, setup_.queue, device, options.build);
        TransferLooks out;
        for (int frame = 0; frame < frames; ++frame) {
            if (!part(0.0)) throw_cancelled();
            if (mover) {
                const Animation& animation = *motion_.animated->animation;
                const double seconds = animation.clips.at(motion_.clip).duration * frame / frames;
                const Scene now =
                    posed(*motion_.animated, pose_at(animation, motion_.clip, seconds));
                mover->move(0, now.positions, now.normals).wait();
            }
            out.milliseconds += time_frame(setup_.queue, [&] { solver.look(); });
        }
        out.milliseconds += time_frame(setup_.queue, [&] { out.sets = solver.sets(); });
        return out;
    }

    // Times of masks and vectors, warm.
    Measured measure(const TransferSettings& one, SweepPoint* result, const Progress& part) {
        DynamicTransferOptions options = one.options;
        if (one.coarse > 0) options.coarse = coarse_mesh(scene_, one.coarse);
        DynamicTransferSolver solver(programs_, setup_.queue, scene_, device_scene_, options);
        Measured out;
        if (one.looks > 0) {
            TransferLooks& looks = looks_[one.knobs];
            if (result) looks = look_at_frames(options, one.looks, part);
            solver.restrict(looks.sets);
            out.once = looks.milliseconds;
        }
        solver.transfer();  // warms up
        solver.light().wait();
        constexpr double slow = 3000.0;  // milliseconds: noise is small beside these
        constexpr int runs = 3;
        for (int run = 0; run < runs && out.again; ++run) {
            out.milliseconds.push_back(time_frame(setup_.queue, [&] { solver.transfer(); }));
            out.again = out.milliseconds.back() <= slow;
        }
        if (!result) return out;
        result->picture = lit(solver);
        const TransferVectors vectors = transfer_vectors(setup_.queue, solver, device_scene_);
        judge(*result, out_.truths, &counted_);
        result->error[smooth_environment] = relative_error(
            smoothly_lit(vectors), out_.truths[smooth_environment].picture, &counted_);
        out.non_finite = solver.status().non_finite + vectors.non_finite;
        return out;
    }

    void transfer() {
        const std::vector<TransferSettings> settings =
            transfer_settings(setup_.quick, scene_.triangles.size(), can_simplify(),
                              motion_.animated != nullptr, setup_.build);
        Turns turns;
        turns.rounds = setup_.rounds;
        turns.measure = [&](std::size_t i, SweepPoint* result, const Progress& part) {
            return measure(settings[i], result, part);
        };
        add_points(out_, settings, turns, progress_);
    }

    const SweepSetup& setup_;
    TransferSweep motion_;
    SweepProgress progress_;
    Scene scene_, smooth_;
    DeviceScene device_scene_;
    Programs programs_;
    std::vector<std::uint32_t> vertices_;  // of the scene, those that count
    std::vector<reference::Place> places_;
    std::vector<glm::dvec3> light_;                                      // of smooth_, cd/m^2 sr
    std::map<std::map<std::string, std::string>, TransferLooks> looks_;  // by knobs
    Mask counted_;
    Sweep out_;
};

}  // namespace

Sweep sweep_transfer(const SweepSetup& setup, const TransferSweep& motion) {
    return TransferRun(setup, motion)();
}

}  // namespace clgi::lab
