// The tables of clgi bench: those of papers, run again, and what the library costs.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/error.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace clgi::lab {

using Json = nlohmann::ordered_json;

struct BenchSetup {
    std::string table;
    cl::CommandQueue queue;  // with profiling
    BuildOptions build;
    std::vector<std::pair<std::string, Scene>> scenes;  // of all but kautz and dachsbacher
    std::vector<std::string> only;   // kautz, dachsbacher: names of scenes; empty: all
    int repeats = 30;                // frames measured for each row
    std::uint32_t most_vpls = 1600;  // schaerfig1: of 100, 400, 1600, 6400, 25600
    std::size_t vertices = 1000;     // kautz1: whose error is measured; 0: none
    int samples = 0;                 // dachsbacher1: per pixel of references; 0: no errors
    Progress progress;               // false ends it with Error

    cl::Context context() const { return queue.getInfo<CL_QUEUE_CONTEXT>(); }
    cl::Device device() const { return queue.getInfo<CL_QUEUE_DEVICE>(); }
    void report(double done) const;  // throws Error where progress says false
};

// A column of the text.
struct BenchColumn {
    std::string title;
    int width;
    std::string text;  // of a cell, to be filled() from its row: "{fps:.1f} ({paper_fps:.1f})"
    double factor = 1.0;
};

struct BenchTable {
    Json json;                         // what --json prints: "table", "device", "rows" and others
    std::vector<BenchColumn> columns;  // the first one stands at the left
    std::string note;                  // below the table's name, to be filled() from json
    std::string after = "";            // below the rows
};

// The text with values of the item in place of keys in braces, formatted as by fmt; "-" where one
// is missing. Numbers are multiplied by `factor`.
std::string filled(const std::string& text, const Json& item, double factor = 1.0);

// The rows of a paper's table with these names; none: all. Throws Error for another name.
template <typename Row, std::size_t N>
std::vector<Row> chosen_rows(const Row (&table)[N], const std::vector<std::string>& names) {
    std::string known;
    for (const Row& row : table) known += (known.empty() ? "" : ", ") + std::string(row.name);
    std::vector<Row> out;
    for (const std::string& name : names)
        if (std::none_of(table, table + N, [&](const Row& row) { return name == row.name; }))
            throw Error("bench: " + name + " is not one of " + known);
    for (const Row& row : table)
        if (names.empty() || std::find(names.begin(), names.end(), row.name) != names.end())
            out.push_back(row);
    return out;
}

// Throws Error where the table needs scenes and has none, or was cancelled.
BenchTable run_bench(const BenchSetup& setup);
std::string text_of(const BenchTable& table);

// Tables 1 and 2 of [Cochran07]: frame rates for pairs of VPLs and negative VPLs, and the share of
// low-resolution pixels against error and frame rate.
BenchTable bench_cochran(const BenchSetup& setup);
// Table 1 of [Schaerfig16]: seconds of whole bakes. Scenes by the names "corridor", "cornell" and
// "sponza" have the paper's figures beside ours.
BenchTable bench_schaerfig(const BenchSetup& setup);
// Tables 1 and 2 of [Kautz04]: frames per second and errors of transfer vectors of scenes that
// deform, with as many vertices and triangles as the paper's, and where their time goes.
BenchTable bench_kautz1(const BenchSetup& setup);
BenchTable bench_kautz2(const BenchSetup& setup);
// Tables 1 and 2 of [Dachsbacher07]: frames per second and errors of antiradiance, in rooms with
// about as many triangles, elements and links as the paper's; times of passes and memory.
BenchTable bench_dachsbacher(const BenchSetup& setup);
// How fast hemicubes around surface points are drawn, in both forms that there are.
BenchTable bench_views(const BenchSetup& setup);
// What a step of an animated scene costs: curves on the host, vertices on the device.
BenchTable bench_animation(const BenchSetup& setup);
// What the library costs on top of OpenCL: passes against the same kernels enqueued by hand.
BenchTable bench_layer(const BenchSetup& setup);

}  // namespace clgi::lab
