// Tables 1 and 2 of [Kautz04], run again: frames per second and errors of transfer vectors of
// scenes that deform, with as many vertices and triangles as the paper's.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/transfer_truth.hpp"

namespace clgi::lab {

// A scene and what the paper has of it.
struct KautzScene {
    std::string name;  // "cloth", "fight", "chess", "hand"
    Scene scene;       // with the box of its motion; every vertex is one receiver, as in the paper
    std::size_t coarse = 0;  // low-resolution triangles
    double fps = 0.0;        // on two Intel Xeon of 3.06 GHz
    double triangles = 0.0;  // that a vertex looks at, on average
    double fps_sets = 0.0;   // with potentially visible sets; 0: the paper has none
    double triangles_sets = 0.0;
    double error = 0.0;     // of transfer vectors: mean relative L2
    double shares[4] = {};  // of the shadow loop: rasterization, integration, transform, other
};

// names: of the four; empty: all. Throws Error for another name.
std::vector<KautzScene> kautz_scenes(const std::vector<std::string>& names = {});

// How transfer vectors are computed.
struct KautzSettings {
    std::string name;
    MaskOptions masks;
    CellIntegral cells = CellIntegral::exact;
    double coarse = 1.0;  // of the paper's low-resolution triangles; 0: all of the scene block
    int rings = 1;
    double pose = 0.0;  // that is simplified: at this part of the clip
    bool sets = false;  // potentially visible sets of frames spread over the clip
};

struct KautzRow {
    std::string scene;
    KautzSettings settings;
    std::size_t vertices = 0, triangles = 0, coarse = 0;
    double listed = 0.0;                 // triangles that masks look at, a vertex
    std::optional<double> paper_listed;  // none: the paper has no such row
    double fps = 0.0;                    // of the median frame, in the quickest of three rounds
    double mean_fps = 0.0;               // of all frames
    std::optional<double> paper_fps;
    std::optional<double> ratio;  // above 1: ours is that many times faster
    std::optional<TransferError> error;
    double paper_error = 0.0;
    double noise = 0.0;  // of what the error is measured against
};

struct KautzShares {
    std::string scene;
    double frame_ms = 0.0;  // median, of its steps together
    double shares[4] = {};  // of all frames' time, as KautzScene::shares
    double paper_shares[4] = {};
};

// What gloss costs beside diffuse light: the hand with a lobe, device times.
struct KautzGloss {
    double mask_ms = 0.0, integrate_ms = 0.0, gloss_ms = 0.0;
    // masks and integrate_gloss against masks and integrate: one BRDF a vertex, as in the paper
    double instead = 0.0;
    double besides = 0.0;  // both integrals against the diffuse one
};

struct KautzTable1 {
    std::string device;
    std::vector<KautzRow> rows;
};

struct KautzTable2 {
    std::string device;
    std::vector<KautzShares> rows;
    std::optional<KautzGloss> gloss;  // where the hand is among the scenes
};

struct KautzSetup {
    cl::CommandQueue queue;  // with profiling
    BuildOptions build;
    int repeats = 30;  // frames of the clip in a round; where all triangles block a tenth
    std::size_t vertices = 1000;           // whose error is measured; 0: none
    std::function<bool(double)> progress;  // share done; false ends it with Error
};

// The rows of table 1 for a scene, without and with visible sets.
std::vector<KautzSettings> kautz_settings(const KautzScene& scene);

// One row; truth: of this scene, or none.
KautzRow kautz_row(const KautzSetup& setup, const Programs& programs, const KautzScene& scene,
                   const KautzSettings& settings, const TransferTruth* truth);

KautzTable1 bench_kautz1(const KautzSetup& setup, const std::vector<KautzScene>& scenes);
KautzTable2 bench_kautz2(const KautzSetup& setup, const std::vector<KautzScene>& scenes);

}  // namespace clgi::lab
