// The JSON of --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/reference.hpp>
#include <clgi/renderer.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/replicates.hpp"
#include "lab/timing.hpp"
#include "program/antiradiance_frames.hpp"
#include "program/ask.hpp"
#include "program/render_plan.hpp"

namespace clgi::program {

// What --method transfer works on.
struct TransferSummary {
    std::uint32_t receivers = 0;  // vertices and their other sides
    std::uint32_t triangles = 0;  // that block
    int terms = 0;
    std::uint32_t receiver_pixels = 0;  // of the last picture
};

// What --method antiradiance works on.
struct AntiradianceSummary {
    std::size_t elements = 0;
    std::size_t leaves = 0;
    std::size_t links = 0;
    std::size_t moving_links = 0;  // of these
    int bins = 0;
    std::string iteration;
    bool diverged = false;      // the symmetric iteration did, in some frame
    int given_up_frames = 0;    // in which the one that was used did: no result
    bool converged = false;     // in all frames
    bool lets_through = false;  // something may lie between
    std::size_t steps = 0;
    double residual = 0.0;
    double linking_ms = 0.0;  // on the host
};

// One of several renders for an error that was asked for.
struct RenderedAttempt {
    std::string settings;            // in words, with the method
    std::optional<double> expected;  // error, without what samples leave
    std::optional<reference::Verification> verified;
    double seconds = 0.0;    // of the first sample, with all before it
    double refine_ms = 0.0;  // of later ones
};

struct RenderRecord {
    cl::Device device;
    BuildOptions build;
    std::string method;
    std::size_t triangles = 0;
    std::size_t lights = 0;
    std::vector<std::string> effects;
    std::vector<double> frame_ms;
    std::vector<std::vector<lab::PassTime>> passes;  // of every frame
    std::size_t bytes = 0;                           // of scene and solver
    double build_ms = 0.0;                           // kernels and buffers
    RenderStatus status;
    std::string gbuffer = "cl";  // what drew the camera's view: cl or gl
    std::string gl_renderer;     // of gl: "surfaceless: llvmpipe ..."
    std::string gl_path;         // of gl: "copied: ..."
    std::optional<lab::Replicates> replicates;
    std::optional<AskRecord> ask;  // where a result was asked for
    std::optional<reference::Verification> verified;
    std::uint32_t samples = 1;  // of the last picture
    double refine_ms = 0.0;     // of those beyond the first frame's own
    double prepare_ms = 0.0;    // what precedes the first picture, such as a bake
    std::optional<BakeSummary> bake;
    std::optional<TransferSummary> transfer;
    std::optional<IrradianceCacheStatus> cache;
    std::optional<AntiradianceSummary> antiradiance;
    std::shared_ptr<const Planned> planned;  // of --method auto
    std::vector<RenderedAttempt> attempts;   // for an error or a time that was asked for: all
    std::optional<double> expected_error;    // of the last picture, by a plan and its samples
    std::optional<double> budget_used;       // seconds of a time that was asked for
    bool meets_target = true;                // the last check's upper bound does
    std::vector<std::string> warnings;
    AntiradianceFrames exchanges;  // of antiradiance
};

// What the record tells of the renderer and its scene after the last frame.
void fill(RenderRecord& record, const Renderer& renderer, const Scene& scene);

// What went wrong, a sentence each: numbers that were not finite, iterations without a result.
std::vector<std::string> troubles(const Renderer& renderer, const AntiradianceFrames& exchanges);

// "4.2 ms a frame (20 frames, 300 VPLs ...)".
std::string summary(const RenderRecord& record, const Renderer& renderer);

// Writes a temporary file and renames it. Throws InputError when it cannot be written.
void save_stats(const RenderRecord& record, const std::filesystem::path& path);

}  // namespace clgi::program
