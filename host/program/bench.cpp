// clgi bench TABLE: repeats a table of a paper, or measures the cost of the library.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/procedural.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "lab/bench.hpp"
#include "lab/bench_animation.hpp"
#include "lab/bench_layer.hpp"
#include "lab/bench_schaerfig.hpp"
#include "lab/bench_views.hpp"
#include "lab/scenes/rooms.hpp"
#include "program/bench.hpp"
#include "program/commands.hpp"

namespace clgi::program {
namespace {

void print_json(const lab::BenchTable& table) {
    nlohmann::ordered_json out = {{"table", table.table},
                                  {"device", table.device},
                                  {"scene", table.scene},
                                  {"peak_gflops", table.peak_gflops},
                                  {"gather_gflops", table.gather_gflops},
                                  {"gather_fraction", table.gather_fraction},
                                  {"rows", nlohmann::ordered_json::array()}};
    for (const lab::BenchRow& row : table.rows) {
        nlohmann::ordered_json item = {{"name", row.name}, {"paper", row.paper},
                                       {"clgi", row.clgi}, {"ratio", row.ratio},
                                       {"error", nullptr}, {"unit", row.unit}};
        if (row.error) item["error"] = *row.error;
        if (row.paper_error) item["paper_error"] = *row.paper_error;
        if (row.low_res_share) item["low_res_share"] = *row.low_res_share;
        if (row.threshold && *row.threshold < 1e30) item["threshold"] = *row.threshold;
        out["rows"].push_back(item);
    }
    fmt::print("{}\n", out.dump(2));
}

void print_text(const lab::BenchTable& table) {
    fmt::print("{} on {}\n{}, peak {:.0f} GFLOP/s; gather {:.0f} GFLOP/s, {:.0f} % of it\n\n",
               table.table, table.device, table.scene, table.peak_gflops, table.gather_gflops,
               100.0 * table.gather_fraction);
    fmt::print("{:<12}{:>12}{:>12}{:>9}{:>10}{:>12}{:>12}\n", "row", "paper fps", "clgi fps",
               "ratio", "low-res", "RMS %", "paper RMS %");
    for (const lab::BenchRow& row : table.rows)
        fmt::print("{:<12}{:>12.1f}{:>12.1f}{:>9.2f}{:>9.1f}%{:>12}{:>12}\n", row.name, row.paper,
                   row.clgi, row.ratio, 100.0 * row.low_res_share.value_or(0.0),
                   row.error ? fmt::format("{:.4f}", *row.error) : "-",
                   row.paper_error ? fmt::format("{:.4f}", *row.paper_error) : "-");
}

void run_layer(const BenchFlags& flags, const Session& session) {
    const auto rows = measured(flags, [&](const Progress& progress) {
        return lab::bench_layer(session.queue, flags.repeats, progress);
    });
    if (flags.json) {
        nlohmann::ordered_json out = table_json(flags, describe(session.device));
        for (const lab::LayerRow& row : rows)
            out["rows"].push_back({{"name", row.name},
                                   {"by_hand_ms", row.by_hand_ms},
                                   {"library_ms", row.library_ms},
                                   {"ratio", row.ratio}});
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("layer on {}\n\n{:<20}{:>14}{:>14}{:>9}\n", describe(session.device), "pass",
               "by hand ms", "library ms", "ratio");
    for (const lab::LayerRow& row : rows)
        fmt::print("{:<20}{:>14.4f}{:>14.4f}{:>9.3f}\n", row.name, row.by_hand_ms, row.library_ms,
                   row.ratio);
}

void run_animation(const BenchFlags& flags, const Session& session) {
    if (flags.scenes.empty()) throw Error("bench: animation needs --scene");
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const std::string& file : flags.scenes)
        scenes.emplace_back(std::filesystem::path(file).stem().string(), io::load_gltf(file));
    lab::AnimationSetup setup;
    setup.queue = session.queue;
    setup.build = build_of(flags.device);
    setup.repeats = flags.repeats;
    const auto rows = measured(flags, [&](const Progress& progress) {
        setup.progress = progress;
        return lab::bench_animation(setup, scenes);
    });
    if (flags.json) {
        nlohmann::ordered_json out = table_json(flags, describe(session.device));
        for (const lab::AnimationRow& row : rows)
            out["rows"].push_back({{"scene", row.scene},
                                   {"vertices", row.vertices},
                                   {"curves_us", row.curves_us},
                                   {"step_us", row.step_us},
                                   {"ns_per_vertex", row.ns_per_vertex}});
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("animation on {}\n\n{:<24}{:>10}{:>12}{:>10}{:>14}\n", describe(session.device),
               "scene", "vertices", "curves us", "step us", "ns a vertex");
    for (const lab::AnimationRow& row : rows)
        fmt::print("{:<24}{:>10}{:>12.1f}{:>10.0f}{:>14.1f}\n", row.scene, row.vertices,
                   row.curves_us, row.step_us, row.ns_per_vertex);
}

void run_views(const BenchFlags& flags, const Session& session) {
    std::vector<std::pair<std::string, Scene>> scenes = {
        {"corridor", corridor()},
        {"cornell", cornell()},
        {"box", flags.mesh.empty() ? box() : box(io::load_gltf(flags.mesh))}};
    for (const std::string& file : flags.scenes) scenes.emplace_back(file, io::load_gltf(file));
    lab::ViewsSetup setup;
    setup.queue = session.queue;
    setup.build = build_of(flags.device);
    setup.repeats = flags.repeats;
    const lab::ViewsTable table = measured(flags, [&](const Progress& progress) {
        setup.progress = progress;
        return lab::bench_views(setup, scenes);
    });
    if (flags.json) {
        nlohmann::ordered_json out = {
            {"table", "views"},
            {"device", describe(session.device)},
            {"copy_gigabytes_per_second", table.copy_gigabytes_per_second},
            {"rows", nlohmann::ordered_json::array()}};
        for (const lab::ViewsRow& row : table.rows)
            out["rows"].push_back({{"scene", row.scene},
                                   {"form", row.form},
                                   {"triangles", row.triangles},
                                   {"hemicube_ms", row.hemicube_ms},
                                   {"triangles_per_second", row.triangles_per_second},
                                   {"gigabytes_per_second", row.gigabytes_per_second},
                                   {"roof_share", row.roof_share},
                                   {"taken", row.taken}});
        fmt::print("{}\n", out.dump(2));
        return;
    }
    fmt::print("views on {}\nhemicubes of 256x256, copy {:.1f} GB/s\n\n", describe(session.device),
               table.copy_gigabytes_per_second);
    fmt::print("{:<20}{:>10}  {:<19}{:>8}{:>12}{:>9}{:>8}\n", "scene", "triangles", "form", "ms",
               "Mtri/s", "GB/s", "share");
    for (const lab::ViewsRow& row : table.rows)
        fmt::print("{:<20}{:>10}  {:<17}{:<2}{:>8.3f}{:>12.1f}{:>9.2f}{:>7.1f}%\n", row.scene,
                   row.triangles, row.form, row.taken ? " *" : "", row.hemicube_ms,
                   1e-6 * row.triangles_per_second, row.gigabytes_per_second,
                   100.0 * row.roof_share);
}

// A file of the Sponza palace by its name, whatever its letters; else the name itself.
std::string scene_name(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.find("sponza") != std::string::npos ? "sponza" : name;
}

nlohmann::ordered_json schaerfig_json(const lab::SchaerfigTable& table) {
    const auto number = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    nlohmann::ordered_json out = {{"table", "schaerfig1"},
                                  {"device", table.device},
                                  {"peak_gflops", table.peak_gflops},
                                  {"rows", nlohmann::ordered_json::array()}};
    for (const lab::SchaerfigRow& row : table.rows)
        out["rows"].push_back({{"name", row.name},
                               {"paper", number(row.paper)},
                               {"clgi", row.clgi},
                               {"ratio", number(row.ratio)},
                               {"error", nullptr},
                               {"unit", "s"},
                               {"filling", row.filling},
                               {"vpls", row.vpls},
                               {"texels", row.texels},
                               {"layout", row.layout}});
    return out;
}

void run_schaerfig(const BenchFlags& flags, const Session& session) {
    std::vector<std::pair<std::string, Scene>> scenes = {{"corridor", corridor()},
                                                         {"cornell", cornell()}};
    for (const std::string& file : flags.scenes)
        scenes.emplace_back(scene_name(file), open_scene(file, -1, {}, flags.device.quiet, true));
    lab::SchaerfigSetup setup;
    setup.queue = session.queue;
    setup.build = build_of(flags.device);
    setup.most_vpls = flags.most_vpls;
    const lab::SchaerfigTable table = measured(flags, [&](const Progress& progress) {
        setup.progress = progress;
        return lab::bench_schaerfig1(setup, scenes);
    });
    if (flags.json) {
        fmt::print("{}\n", schaerfig_json(table).dump(2));
        return;
    }
    fmt::print("schaerfig1 on {}\n{}x{} texels, five bounces, peak {:.0f} GFLOP/s\n\n",
               table.device, setup.atlas_size, setup.atlas_size, table.peak_gflops);
    fmt::print("{:<24}{:<10}{:>10}{:>10}{:>9}{:>12}\n", "row", "filling", "paper s", "clgi s",
               "ratio", "of it host");
    for (const lab::SchaerfigRow& row : table.rows)
        fmt::print("{:<24}{:<10}{:>10}{:>10.3f}{:>9}{:>12.3f}\n", row.name, row.filling,
                   row.paper ? fmt::format("{:.3f}", *row.paper) : "-", row.clgi,
                   row.ratio ? fmt::format("{:.2f}", *row.ratio) : "-", row.layout);
}

void run_bench(const BenchFlags& flags) {
    const Session session = open_session(flags.device);
    if (flags.table == "schaerfig1") return run_schaerfig(flags, session);
    if (flags.table == "kautz1" || flags.table == "kautz2") return run_kautz(flags, session);
    if (flags.table == "dachsbacher1" || flags.table == "dachsbacher2")
        return run_dachsbacher(flags, session);
    if (flags.table == "layer") return run_layer(flags, session);
    if (flags.table == "views") return run_views(flags, session);
    if (flags.table == "animation") return run_animation(flags, session);
    lab::BenchSetup setup;
    setup.queue = session.queue;
    setup.scene = flags.mesh.empty() ? box() : box(io::load_gltf(flags.mesh));
    setup.repeats = flags.repeats;
    setup.build = build_of(flags.device);
    const lab::BenchTable table = measured(flags, [&](const Progress& progress) {
        setup.progress = progress;
        return flags.table == "cochran1" ? lab::bench_cochran1(setup) : lab::bench_cochran2(setup);
    });
    flags.json ? print_json(table) : print_text(table);
}

}  // namespace

void add_bench(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("bench", "Repeat a table of a paper, or measure the library");
    const auto flags = std::make_shared<BenchFlags>();
    command
        ->add_option("table", flags->table,
                     "cochran1: frame rate against numbers of VPLs; "
                     "cochran2: share of low resolution against error and frame rate; "
                     "schaerfig1: seconds of bakes against numbers of VPLs; "
                     "kautz1: frame rate and error of self-shadowed scenes that deform; "
                     "kautz2: where their time goes; "
                     "dachsbacher1: frame rate of antiradiance in rooms whose light moves; "
                     "dachsbacher2: where its time goes, and memory; "
                     "views: hemicubes per second; "
                     "animation: time of a step of animated scenes; "
                     "layer: passes against the same kernels enqueued by hand")
        ->required()
        ->type_name("TABLE")
        ->check(CLI::IsMember({"cochran1", "cochran2", "schaerfig1", "kautz1", "kautz2",
                               "dachsbacher1", "dachsbacher2", "views", "animation", "layer"}));
    command->add_option("--mesh", flags->mesh, "Mesh in the box, such as the Stanford bunny")
        ->type_name("FILE")
        ->default_str("a generated solid");
    command
        ->add_option("--scene", flags->scenes,
                     "schaerfig1, views, animation: one more scene; may be repeated")
        ->type_name("FILE")
        ->default_str("none");
    command
        ->add_option("--most-vpls", flags->most_vpls,
                     "schaerfig1: the rows of at most so many VPLs, of 100 to 25600")
        ->type_name("N")
        ->check(CLI::Range(100, 25600));
    command
        ->add_option("--only", flags->only,
                     "kautz1, kautz2: this scene, of cloth, fight, chess and hand; dachsbacher1, "
                     "dachsbacher2: of office, character, oriental, glossy-box and glossy-bust; "
                     "may be repeated")
        ->type_name("NAME")
        ->default_str("all")
        ->check(CLI::IsMember({"cloth", "fight", "chess", "hand", "office", "character", "oriental",
                               "glossy-box", "glossy-bust"}));
    command
        ->add_option("--spp", flags->samples,
                     "dachsbacher1: samples per pixel of what errors are measured against; 0: no "
                     "errors")
        ->type_name("N")
        ->check(CLI::Range(0, 1 << 24));
    command
        ->add_option("--vertices", flags->vertices,
                     "kautz1: at most so many vertices of a scene are compared with cast rays; "
                     "0: none")
        ->type_name("N")
        ->check(CLI::Range(0, 1000000));
    command->add_option("--repeats", flags->repeats, "Frames measured for each row")
        ->type_name("N")
        ->check(CLI::Range(1, 10000));
    command->add_flag("--json", flags->json, "Print JSON");
    add_device_flags(*command, flags->device);
    command->callback([flags] { run_bench(*flags); });
}

}  // namespace clgi::program
