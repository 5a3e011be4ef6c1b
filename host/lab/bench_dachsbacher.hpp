// Tables 1 and 2 of [Dachsbacher07], run again: frames per second, errors, times of passes and
// memory of antiradiance, in rooms with about as many triangles, elements and links as the paper's.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/antiradiance.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clgi::lab {

// [Dachsbacher07, tables 1 and 2], on a Xeon of 3 GHz with a GeForce 8800GTX.
struct DachsbacherPaper {
    double triangles, elements, links;  // links: of pairs, for both directions
    double fps, fps_splatting;          // the second with splatting and 4x anti-aliasing
    double linking_s;
    double local_ms, global_ms, push_pull_ms;  // of all iterations
    double tables_mb, links_mb;
};

// A scene, the settings that give about the paper's elements and links, and what the paper has.
struct DachsbacherScene {
    std::string name;  // "office", "character", "oriental", "glossy-box", "glossy-bust"
    double max_area;   // m^2 of a leaf
    double bin_share;  // LinkOptions::bin_share
    bool vertices;     // ElementOptions::vertices
    int steps;
    DachsbacherPaper paper;
    Scene scene;  // as its clip begins, with the box of its motion

    AntiradianceOptions options() const;
};

// names: of the five; empty: all. Throws Error for another name.
std::vector<DachsbacherScene> dachsbacher_scenes(const std::vector<std::string>& names = {});

struct DachsbacherRow1 {
    std::string scene;
    DachsbacherPaper paper{};
    int bins = 0, steps = 0;
    std::size_t triangles = 0, elements = 0, leaves = 0;
    std::size_t pairs = 0;  // of linked elements: the paper's links
    std::size_t links = 0;  // for one direction and one bin each
    // Of the median frame, in the quickest of three rounds. A frame: a light moves, its shadow map
    // and direct light in the leaves, the steps, and a picture with shadowed direct light.
    double fps = 0.0;
    double light_fps = 0.0;  // without the picture
    double ratio = 0.0;      // fps to the paper's: above 1, ours is that many times faster
    std::optional<double> error, indirect_error;  // relative_error of all light, of indirect light
    double residual = 0.0;                        // after the last step
};

struct DachsbacherRow2 {
    std::string scene;
    DachsbacherPaper paper{};
    double linking_s = 0.0;                                      // elements and links
    double local_ms = 0.0, global_ms = 0.0, push_pull_ms = 0.0;  // device, all steps, medians
    double other_ms = 0.0;                                       // shadow maps, direct light, sums
    double tables_mb = 0.0, links_mb = 0.0;                      // 2^20 bytes
};

struct DachsbacherTable1 {
    std::string device;
    std::vector<DachsbacherRow1> rows;
};

struct DachsbacherTable2 {
    std::string device;
    std::vector<DachsbacherRow2> rows;
};

struct DachsbacherSetup {
    cl::CommandQueue queue;  // with profiling
    BuildOptions build;
    int repeats = 30;                      // frames in a round
    int samples = 0;                       // per pixel of references; 0: no errors
    std::function<bool(double)> progress;  // share done; false ends it with Error
};

DachsbacherTable1 bench_dachsbacher1(const DachsbacherSetup& setup,
                                     const std::vector<DachsbacherScene>& scenes);
DachsbacherTable2 bench_dachsbacher2(const DachsbacherSetup& setup,
                                     const std::vector<DachsbacherScene>& scenes);

}  // namespace clgi::lab
