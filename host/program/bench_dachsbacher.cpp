// clgi bench dachsbacher1, dachsbacher2: tables 1 and 2 of [Dachsbacher07].
// SPDX-License-Identifier: MIT
#include "lab/bench_dachsbacher.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "program/bench.hpp"
#include "program/optional_json.hpp"

namespace clgi::program {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const std::optional<double>& value) {
    return value ? fmt::format("{:.1f} %", 100.0 * *value) : "-";
}

std::string both(double ours, double paper) { return fmt::format("{:.1f} ({:.1f})", ours, paper); }

std::string thousands(std::size_t ours, double paper) {
    return fmt::format("{:.1f}K ({:.1f}K)", 1e-3 * static_cast<double>(ours), 1e-3 * paper);
}

void print_table1(const lab::DachsbacherTable1& table, const BenchFlags& flags) {
    if (flags.json) {
        Json out = table_json(flags, table.device);
        for (const lab::DachsbacherRow1& row : table.rows)
            out["rows"].push_back({{"scene", row.scene},
                                   {"bins", row.bins},
                                   {"steps", row.steps},
                                   {"triangles", row.triangles},
                                   {"elements", row.elements},
                                   {"leaves", row.leaves},
                                   {"pairs", row.pairs},
                                   {"links", row.links},
                                   {"fps", row.fps},
                                   {"light_fps", row.light_fps},
                                   {"paper_fps", row.paper.fps},
                                   {"ratio", row.ratio},
                                   {"error", number(row.error)},
                                   {"indirect_error", number(row.indirect_error)},
                                   {"residual", row.residual},
                                   {"paper_triangles", row.paper.triangles},
                                   {"paper_elements", row.paper.elements},
                                   {"paper_links", row.paper.links},
                                   {"paper_fps_splatting", row.paper.fps_splatting}});
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("dachsbacher1 on {}\nin brackets the paper's; links of pairs, frames of 640x480\n\n",
               table.device);
    fmt::print("{:<12}{:>16}{:>18}{:>20}{:>7}{:>8}{:>10}{:>8}{:>7}{:>9}{:>10}\n", "scene",
               "triangles", "elements", "pairs", "steps", "fps", "no picture", "paper", "ratio",
               "error", "indirect");
    for (const lab::DachsbacherRow1& row : table.rows)
        fmt::print("{:<12}{:>16}{:>18}{:>20}{:>7}{:>8.1f}{:>10.1f}{:>8.1f}{:>7.1f}{:>9}{:>10}\n",
                   row.scene, thousands(row.triangles, row.paper.triangles),
                   thousands(row.elements, row.paper.elements),
                   thousands(row.pairs, row.paper.links), row.steps, row.fps, row.light_fps,
                   row.paper.fps, row.ratio, percent(row.error), percent(row.indirect_error));
}

void print_table2(const lab::DachsbacherTable2& table, const BenchFlags& flags) {
    if (flags.json) {
        Json out = table_json(flags, table.device);
        for (const lab::DachsbacherRow2& row : table.rows)
            out["rows"].push_back({{"scene", row.scene},
                                   {"linking_s", row.linking_s},
                                   {"local_ms", row.local_ms},
                                   {"global_ms", row.global_ms},
                                   {"push_pull_ms", row.push_pull_ms},
                                   {"other_ms", row.other_ms},
                                   {"tables_mb", row.tables_mb},
                                   {"links_mb", row.links_mb},
                                   {"paper_linking_s", row.paper.linking_s},
                                   {"paper_local_ms", row.paper.local_ms},
                                   {"paper_global_ms", row.paper.global_ms},
                                   {"paper_push_pull_ms", row.paper.push_pull_ms},
                                   {"paper_tables_mb", row.paper.tables_mb},
                                   {"paper_links_mb", row.paper.links_mb}});
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("dachsbacher2 on {}\nin brackets the paper's; times of all steps\n\n", table.device);
    fmt::print("{:<12}{:>16}{:>16}{:>16}{:>16}{:>10}{:>16}{:>16}\n", "scene", "linking s",
               "local ms", "global ms", "push, pull ms", "other ms", "tables MB", "links MB");
    for (const lab::DachsbacherRow2& row : table.rows)
        fmt::print("{:<12}{:>16}{:>16}{:>16}{:>16}{:>10.1f}{:>16}{:>16}\n", row.scene,
                   fmt::format("{:.2f} ({:.1f})", row.linking_s, row.paper.linking_s),
                   both(row.local_ms, row.paper.local_ms), both(row.global_ms, row.paper.global_ms),
                   both(row.push_pull_ms, row.paper.push_pull_ms), row.other_ms,
                   both(row.tables_mb, row.paper.tables_mb),
                   both(row.links_mb, row.paper.links_mb));
}

}  // namespace

void run_dachsbacher(const BenchFlags& flags, const Session& session) {
    const std::vector<lab::DachsbacherScene> scenes = lab::dachsbacher_scenes(flags.only);
    lab::DachsbacherSetup setup;
    setup.queue = session.queue;
    setup.build = build_of(flags.device);
    setup.repeats = flags.repeats;
    setup.samples = flags.samples;
    const auto run = [&](auto&& bench) {
        return measured(flags, [&](const Progress& progress) {
            setup.progress = progress;
            return bench(setup, scenes);
        });
    };
    if (flags.table == "dachsbacher1")
        print_table1(run(lab::bench_dachsbacher1), flags);
    else
        print_table2(run(lab::bench_dachsbacher2), flags);
}

}  // namespace clgi::program
