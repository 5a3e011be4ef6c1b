// clgi scene NAME -o s.glb: writes a procedural scene.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/procedural.hpp>
#include <map>
#include <memory>
#include <optional>
#include "lab/scenes/deforming.hpp"
#include "lab/scenes/drawn.hpp"
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/rooms.hpp"
#include "program/commands.hpp"
#include "program/session.hpp"

namespace clgi::program {
namespace {

// What was given on the command line; empty means the scene's own default.
struct GeneratedFlags {
    std::string name;
    std::string output;
    std::optional<std::string> mesh;
    std::optional<std::string> light;
    std::optional<float> albedo;
    std::optional<int> subdivisions;
    std::optional<float> cone;  // degrees
    std::optional<int> rooms;
    std::optional<float> door;  // degrees
    std::optional<float> roughness;
    std::optional<std::uint32_t> seed;
    std::optional<double> extent;  // m
    bool quiet = false;
};

struct SceneKind {
    std::string name;
    std::vector<std::string> flags;  // those it understands
    Scene (*make)(const GeneratedFlags& flags);
};

template <typename Value, typename Given>
void take(Value& value, const std::optional<Given>& given) {
    if (given) value = *given;
}

void take_angle(float& radians, const std::optional<float>& degrees) {
    if (degrees) radians = glm::radians(*degrees);
}

// The light and, for a spot, its cone.
template <typename Options>
void take_lamp(Options& options, const GeneratedFlags& flags) {
    static const std::map<std::string, LightSource> lamps = {
        {"spot", LightSource::spot}, {"area", LightSource::area}, {"point", LightSource::point}};
    if (flags.light) {
        const auto found = lamps.find(*flags.light);
        if (found == lamps.end()) {
            throw Error(
                fmt::format("scene: --light is '{}', spot, area or point needed", *flags.light));
        }
        options.light = found->second;
    }
    if (flags.cone && options.light != LightSource::spot)
        throw Error("scene: --cone needs --light spot");
    take_angle(options.cone_angle, flags.cone);
}

Scene make_box(const GeneratedFlags& flags) {
    BoxOptions options;
    take_lamp(options, flags);
    return flags.mesh ? box(io::load_gltf(*flags.mesh), options) : box(options);
}

Scene make_cornell(const GeneratedFlags& flags) {
    CornellOptions options;
    take_lamp(options, flags);
    return cornell(options);
}

Scene make_corridor(const GeneratedFlags& flags) {
    CorridorOptions options;
    take(options.rooms, flags.rooms);
    take_angle(options.door_angle, flags.door);
    take_angle(options.cone_angle, flags.cone);
    return corridor(options);
}

Scene make_furnace(const GeneratedFlags& flags) {
    FurnaceOptions options;
    take_lamp(options, flags);
    take(options.albedo, flags.albedo);
    take(options.subdivisions, flags.subdivisions);
    return furnace(options);
}

Scene make_hand(const GeneratedFlags& flags) {
    HandOptions options;
    take(options.roughness, flags.roughness);
    return hand_like(options);
}

template <Scene (*make)(const GlossyOptions&)>
Scene make_glossy(const GeneratedFlags& flags) {
    GlossyOptions options;
    take(options.roughness, flags.roughness);
    return make(options);
}

Scene make_drawn(const GeneratedFlags& flags) {
    DrawnOptions options;
    take(options.seed, flags.seed);
    take(options.extent, flags.extent);
    return drawn(flags.name, options);
}

std::vector<SceneKind> all_kinds() {
    std::vector<SceneKind> kinds = {
        {"box", {"--mesh", "--light", "--cone"}, make_box},
        {"character", {}, [](const GeneratedFlags&) { return character(); }},
        {"chess", {}, [](const GeneratedFlags&) { return chess(); }},
        {"cloth", {}, [](const GeneratedFlags&) { return cloth(); }},
        {"cornell", {"--light", "--cone"}, make_cornell},
        {"corridor", {"--rooms", "--door", "--cone"}, make_corridor},
        {"fight-like", {}, [](const GeneratedFlags&) { return fight_like(); }},
        {"furnace", {"--light", "--albedo", "--subdivisions", "--cone"}, make_furnace},
        {"glossy-box", {"--roughness"}, make_glossy<glossy_box>},
        {"glossy-bust-like", {"--roughness"}, make_glossy<glossy_bust_like>},
        {"hand-like", {"--roughness"}, make_hand},
        {"maze", {}, [](const GeneratedFlags&) { return maze(); }},
        {"office", {}, [](const GeneratedFlags&) { return office(); }},
        {"oriental-like", {}, [](const GeneratedFlags&) { return oriental_like(); }},
    };
    for (const DrawnKind& kind : drawn_kinds())
        kinds.push_back({kind.name, {"--seed", "--extent"}, make_drawn});
    return kinds;
}

const std::vector<SceneKind>& scene_kinds() {
    static const std::vector<SceneKind> kinds = all_kinds();
    return kinds;
}

std::string known_names() {
    std::string names;
    for (const SceneKind& kind : scene_kinds()) names += (names.empty() ? "" : ", ") + kind.name;
    return names;
}

const SceneKind& find_kind(const std::string& name) {
    for (const SceneKind& kind : scene_kinds()) {
        if (kind.name == name) return kind;
    }
    throw Error(fmt::format("scene: unknown scene '{}'; known scenes are {}", name, known_names()));
}

// A flag that would be ignored is probably a mistake.
void refuse_foreign_flags(const CLI::App& command, const SceneKind& kind) {
    static const std::vector<std::string> all = {"--mesh", "--light", "--albedo", "--subdivisions",
                                                 "--cone", "--rooms", "--door",   "--roughness",
                                                 "--seed", "--extent"};
    for (const std::string& flag : all) {
        const bool known =
            std::find(kind.flags.begin(), kind.flags.end(), flag) != kind.flags.end();
        if (!known && command.count(flag) > 0) {
            throw Error(fmt::format("scene: {} does not apply to the scene {}", flag, kind.name));
        }
    }
}

void run_scene(const CLI::App& command, const GeneratedFlags& flags) {
    const SceneKind& kind = find_kind(flags.name);
    refuse_foreign_flags(command, kind);
    const Scene scene = kind.make(flags);
    io::save_glb(scene, flags.output);
    if (!flags.quiet)
        fmt::print("{}: {}, {} triangles\n", flags.output, kind.name, scene.triangles.size());
}

std::string degrees(float radians) { return fmt::format("{:.4g}", glm::degrees(radians)); }

std::string cone_defaults() {
    return fmt::format("{}; corridor: {}, furnace: {}", degrees(BoxOptions().cone_angle),
                       degrees(CorridorOptions().cone_angle), degrees(FurnaceOptions().cone_angle));
}

}  // namespace

void add_scene(CLI::App& app) {
    CLI::App* command = app.add_subcommand("scene", "Write a generated scene");
    const auto flags = std::make_shared<GeneratedFlags>();
    command->add_option("name", flags->name, known_names())->required()->type_name("NAME");
    command->add_option("-o,--output", flags->output, "The .glb file")
        ->required()
        ->type_name("FILE");
    command->add_option("--mesh", flags->mesh, "box: .gltf or .glb file to put into the box")
        ->type_name("FILE")
        ->default_str("a generated solid");
    command->add_option("--light", flags->light, "spot, area or point; box: spot or point")
        ->type_name("KIND")
        ->default_str("spot; cornell: area");
    command->add_option("--albedo", flags->albedo, "furnace: reflectance of the wall, 0 to 0.999")
        ->type_name("X")
        ->default_str(fmt::format("{}", FurnaceOptions().albedo));
    command
        ->add_option("--subdivisions", flags->subdivisions, "furnace: 20 * 4^N triangles, 0 to 8")
        ->type_name("N")
        ->default_str(fmt::format("{}", FurnaceOptions().subdivisions));
    command
        ->add_option("--cone", flags->cone, "Angle from the axis of the spot to its edge, degrees")
        ->type_name("D")
        ->default_str(cone_defaults());
    command->add_option("--rooms", flags->rooms, "corridor: rooms on either side, 1 to 64")
        ->type_name("N")
        ->default_str(fmt::format("{}", CorridorOptions().rooms));
    command->add_option("--door", flags->door, "corridor: angle by which doors are open, degrees")
        ->type_name("D")
        ->default_str(degrees(CorridorOptions().door_angle));
    command
        ->add_option("--roughness", flags->roughness,
                     "hand-like, glossy-box, glossy-bust-like: of the object, 0.05 to 1; below 1 "
                     "it has gloss")
        ->type_name("X")
        ->default_str(
            fmt::format("{}; glossy-...: {}", HandOptions().roughness, GlossyOptions().roughness));
    std::string drawn_names;
    for (const DrawnKind& kind : drawn_kinds())
        drawn_names += (drawn_names.empty() ? "" : ", ") + kind.name;
    command->add_option("--seed", flags->seed, drawn_names + ": what they are drawn from")
        ->type_name("N")
        ->default_str("0");
    command
        ->add_option("--extent", flags->extent,
                     "Of the same: half the side of the ground around, metres, 0 to 1e5")
        ->type_name("M")
        ->default_str("none, or as the kind has it");
    add_quiet_flag(*command, flags->quiet);
    command->callback([command, flags] { run_scene(*command, *flags); });
}

}  // namespace clgi::program
