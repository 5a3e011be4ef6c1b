// clgi bench kautz1, kautz2: tables 1 and 2 of [Kautz04].
// SPDX-License-Identifier: MIT
#include "lab/bench_kautz.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "program/bench.hpp"
#include "program/optional_json.hpp"

namespace clgi::program {
namespace {

using Json = nlohmann::ordered_json;

std::string text(const std::optional<double>& value) {
    return value ? fmt::format("{:.1f}", *value) : "-";
}

std::string settings_text(const lab::KautzSettings& settings) {
    const MaskOptions& masks = settings.masks;
    std::string out = fmt::format(
        "R {}, {}, B {} {}", masks.size,
        masks.planes == EdgePlanes::table ? fmt::format("table {}", masks.table_size) : "exact",
        masks.block, settings.cells == CellIntegral::exact ? "integrals" : "centres");
    if (settings.coarse > 0.0) out += fmt::format(", rings {}", settings.rings);
    return out;
}

Json row_json(const lab::KautzRow& row) {
    const lab::KautzSettings& settings = row.settings;
    const MaskOptions& masks = settings.masks;
    const bool table = masks.planes == EdgePlanes::table;
    Json out = {{"scene", row.scene},
                {"settings", settings.name},
                {"pvs", settings.sets},
                {"vertices", row.vertices},
                {"triangles", row.triangles},
                {"low_res_triangles", row.coarse},
                {"listed", row.listed},
                {"paper_listed", number(row.paper_listed)},
                {"fps", row.fps},
                {"mean_fps", row.mean_fps},
                {"paper_fps", number(row.paper_fps)},
                {"ratio", number(row.ratio)},
                {"error", nullptr},
                {"paper_error", row.paper_error},
                {"mask", masks.size},
                {"table", table ? Json(masks.table_size) : Json()},
                {"block", masks.block},
                {"cells", settings.cells == CellIntegral::exact ? "exact" : "centre"},
                {"rings", settings.rings}};
    if (!row.error) return out;
    out["error"] = row.error->mean;
    out["error_lit"] = row.error->lit;
    out["error_rms"] = row.error->root;
    out["noise"] = row.noise;
    out["vertices_counted"] = row.error->counted;
    out["vertices_lit"] = row.error->counted_lit;
    out["vertices_left_out"] = row.error->left_out;
    return out;
}

void print_table1(const lab::KautzTable1& table, const BenchFlags& flags) {
    if (flags.json) {
        Json out = table_json(flags, table.device);
        for (const lab::KautzRow& row : table.rows) out["rows"].push_back(row_json(row));
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print(
        "kautz1 on {}\nerrors in per cent: of all vertices, of those that are lit, root of "
        "the mean square\n\n",
        table.device);
    fmt::print("{:<6}{:<4}{:>9}{:>10}{:>8}{:>8}{:>7}{:>8}{:>7}{:>7}{:>7}{:>6}{:>6}{:>7}  {}\n",
               "scene", "PVS", "vertices", "triangles", "low-res", "listed", "paper", "fps",
               "paper", "ratio", "error", "lit", "root", "paper", "settings");
    for (const lab::KautzRow& row : table.rows) {
        const auto error = [&](double lab::TransferError::*which) {
            return row.error ? fmt::format("{:.2f}", 100.0 * ((*row.error).*which)) : "-";
        };
        fmt::print(
            "{:<6}{:<4}{:>9}{:>10}{:>8}{:>8.1f}{:>7}{:>8.1f}{:>7}{:>7}{:>7}{:>6}{:>6}{:>7.2f}"
            "  {}: {}\n",
            row.scene, row.settings.sets ? "yes" : "no", row.vertices, row.triangles, row.coarse,
            row.listed, text(row.paper_listed), row.fps, text(row.paper_fps), text(row.ratio),
            error(&lab::TransferError::mean), error(&lab::TransferError::lit),
            error(&lab::TransferError::root), 100.0 * row.paper_error, row.settings.name,
            settings_text(row.settings));
    }
}

void print_table2(const lab::KautzTable2& table, const BenchFlags& flags) {
    constexpr const char* parts[] = {"rasterization", "integration", "transform", "other"};
    if (flags.json) {
        Json out = table_json(flags, table.device);
        out["gloss"] = nullptr;
        for (const lab::KautzShares& row : table.rows) {
            Json item = {{"scene", row.scene}, {"frame_ms", row.frame_ms}};
            for (int i = 0; i < 4; ++i) {
                item[parts[i]] = row.shares[i];
                item[fmt::format("paper_{}", parts[i])] = row.paper_shares[i];
            }
            out["rows"].push_back(item);
        }
        if (table.gloss)
            out["gloss"] = {{"mask_ms", table.gloss->mask_ms},
                            {"integrate_ms", table.gloss->integrate_ms},
                            {"integrate_gloss_ms", table.gloss->gloss_ms},
                            {"instead", table.gloss->instead},
                            {"besides", table.gloss->besides}};
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("kautz2 on {}\nper cent of the time, in brackets the paper's\n\n{:<8}{:>9}",
               table.device, "scene", "frame ms");
    for (const char* part : parts) fmt::print("{:>18}", part);
    fmt::print("\n");
    for (const lab::KautzShares& row : table.rows) {
        fmt::print("{:<8}{:>9.2f}", row.scene, row.frame_ms);
        for (int i = 0; i < 4; ++i)
            fmt::print("{:>18}", fmt::format("{:.1f} ({:.1f})", 100.0 * row.shares[i],
                                             100.0 * row.paper_shares[i]));
        fmt::print("\n");
    }
    if (!table.gloss) return;
    fmt::print(
        "\nhand with gloss: masks {:.2f} ms, integrate {:.2f} ms, integrate_gloss {:.2f} ms\n"
        "masks and gloss take {:.3f} of masks and diffuse; all three {:.3f}\n",
        table.gloss->mask_ms, table.gloss->integrate_ms, table.gloss->gloss_ms,
        table.gloss->instead, table.gloss->besides);
}

}  // namespace

void run_kautz(const BenchFlags& flags, const Session& session) {
    const std::vector<lab::KautzScene> scenes = lab::kautz_scenes(flags.only);
    lab::KautzSetup setup;
    setup.queue = session.queue;
    setup.build = build_of(flags.device);
    setup.repeats = flags.repeats;
    setup.vertices = static_cast<std::size_t>(flags.vertices);
    const auto run = [&](auto&& bench) {
        return measured(flags, [&](const Progress& progress) {
            setup.progress = progress;
            return bench(setup, scenes);
        });
    };
    if (flags.table == "kautz1")
        print_table1(run(lab::bench_kautz1), flags);
    else
        print_table2(run(lab::bench_kautz2), flags);
}

}  // namespace clgi::program
