// clgi bench TABLE: repeats a table of a paper, or measures the cost of the library.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <clgi/io/gltf.hpp>
#include <clgi/procedural.hpp>
#include <filesystem>
#include <memory>

#include "lab/bench.hpp"
#include "lab/scenes/rooms.hpp"
#include "program/commands.hpp"
#include "program/count_flag.hpp"
#include "program/scene_flags.hpp"
#include "program/session.hpp"

namespace clgi::program {
namespace {

struct BenchFlags {
    lab::BenchSetup setup;
    DeviceFlags device;
    std::string mesh;
    std::vector<std::string> scenes;
    bool json = false;
};

// A file of the Sponza palace by its name, whatever its letters; else the name itself.
std::string scene_name(const std::string& file) {
    std::string name = std::filesystem::path(file).stem().string();
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.find("sponza") != std::string::npos ? "sponza" : name;
}

// The scenes of a table, by name: generated ones, and files.
std::vector<std::pair<std::string, Scene>> scenes_of(const BenchFlags& flags) {
    const std::string& table = flags.setup.table;
    std::vector<std::pair<std::string, Scene>> out;
    if (table == "schaerfig1" || table == "views")
        out = {{"corridor", corridor()}, {"cornell", cornell()}};
    if (table == "cochran1" || table == "cochran2" || table == "views")
        out.emplace_back("box", flags.mesh.empty() ? box() : box(io::load_gltf(flags.mesh)));
    for (const std::string& file : flags.scenes)
        if (table == "schaerfig1")
            out.emplace_back(scene_name(file), open_scene({file}, flags.device.quiet, true));
        else if (table == "views")
            out.emplace_back(file, io::load_gltf(file));
        else if (table == "animation")
            out.emplace_back(std::filesystem::path(file).stem().string(), io::load_gltf(file));
    return out;
}

void run_bench(BenchFlags& flags) {
    const Session session = open_session(flags.device);
    flags.setup.queue = session.queue;
    flags.setup.build = build_of(flags.device);
    flags.setup.scenes = scenes_of(flags);
    catch_interrupts();
    const auto bar = progress_bar(flags.setup.table, flags.device.quiet);
    flags.setup.progress = [&](double done) {
        if (!bar(done)) throw Interrupted();
        return true;
    };
    const lab::BenchTable table = lab::run_bench(flags.setup);
    bar(1.0);
    fmt::print("{}\n", flags.json ? table.json.dump(2) : lab::text_of(table));
}

}  // namespace

void add_bench(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("bench", "Repeat a table of a paper, or measure the library");
    const auto flags = std::make_shared<BenchFlags>();
    command
        ->add_option("table", flags->setup.table,
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
    add_count(*command, "--most-vpls", flags->setup.most_vpls,
              "schaerfig1: the rows of at most so many VPLs, of 100 to 25600", 100, 25600);
    command
        ->add_option("--only", flags->setup.only,
                     "kautz1, kautz2: this scene, of cloth, fight, chess and hand; dachsbacher1, "
                     "dachsbacher2: of office, character, oriental, glossy-box and glossy-bust; "
                     "may be repeated")
        ->type_name("NAME")
        ->default_str("all")
        ->check(CLI::IsMember({"cloth", "fight", "chess", "hand", "office", "character", "oriental",
                               "glossy-box", "glossy-bust"}));
    add_count(*command, "--spp", flags->setup.samples,
              "dachsbacher1: samples per pixel of what errors are measured against; 0: no "
              "errors",
              0, 1 << 24);
    add_count(*command, "--vertices", flags->setup.vertices,
              "kautz1: at most so many vertices of a scene are compared with cast rays; "
              "0: none",
              0, 1000000);
    add_count(*command, "--repeats", flags->setup.repeats, "Frames measured for each row", 1,
              10000);
    command->add_flag("--json", flags->json, "Print JSON");
    add_device_flags(*command, flags->device);
    command->callback([flags] { run_bench(*flags); });
}

}  // namespace clgi::program
