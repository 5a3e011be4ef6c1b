// clgi transfer SCENE -o transfer.exr: transfer vectors of all vertices, for other programs.
//                                                                                      [Kautz04]
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "lab/coarse_mesh.hpp"
#include "lab/timing.hpp"
#include "lab/transfer_vectors.hpp"
#include "program/animation.hpp"
#include "program/commands.hpp"
#include "program/count_flag.hpp"
#include "program/option_flags.hpp"
#include "program/session.hpp"
#include "program/stopwatch.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

using nlohmann::ordered_json;

struct ExportFlags {
    std::string scene;
    DeviceFlags device;
    AnimationFlags animation;
    RendererOptions options;
    int coarse = 0;  // triangles of the mesh that blocks far away; 0: the scene's own
    bool rings_given = false;
    std::string exr;
    std::string gltf;
    std::string stats;
    int scene_index = -1;
};

struct ExportRecord {
    const Scene& scene;
    const DynamicTransferSolver& solver;
    const lab::TransferVectors& vectors;
    double build_seconds, transfer_seconds;
};

// Where the vertices of each part are: what a reader needs to find its own primitives.
ordered_json parts_json(const Scene& scene) {
    ordered_json out = ordered_json::array();
    for (const Part& part : scene.parts) {
        std::uint32_t first = ~0u, last = 0;
        for (std::uint32_t t = 0; t < part.triangle_count; ++t)
            for (const std::uint32_t v : scene.triangles[part.first_triangle + t].vertex) {
                first = std::min(first, v);
                last = std::max(last, v);
            }
        const std::uint32_t count = part.triangle_count == 0 ? 0 : last - first + 1;
        out.push_back({{"name", part.name},
                       {"first_vertex", count == 0 ? 0 : first},
                       {"vertex_count", count}});
    }
    return out;
}

void save_export_stats(const ExportRecord& record, const std::filesystem::path& path) {
    const DynamicTransferSolver& solver = record.solver;
    const MaskOptions& masks = solver.options().masks;
    const TransferStatus status = solver.status();
    ordered_json passes = ordered_json::array();
    for (const lab::PassTime& pass : lab::pass_times(solver.events()))
        passes.push_back({{"name", pass.name}, {"seconds", 1e-3 * pass.milliseconds}});
    const ordered_json json = {
        {"clgi", CLGI_VERSION},
        {"method", "transfer"},
        {"scene",
         {{"triangles", record.scene.triangles.size()},
          {"vertices", record.scene.positions.size()}}},
        {"receivers", solver.receivers().count},
        {"order", masks.bands - 1},
        {"terms", sh::terms(masks.bands)},
        {"mask", masks.size},
        {"mask_block", masks.block},
        {"table", masks.planes == EdgePlanes::table ? masks.table_size : 0},
        {"coarse_triangles", solver.options().coarse.size()},
        {"triangles_per_receiver", solver.triangles_per_receiver()},
        {"parts", parts_json(record.scene)},
        {"seconds", {{"build", record.build_seconds}, {"transfer", record.transfer_seconds}}},
        {"passes", passes},
        {"memory_mb", static_cast<double>(solver.bytes()) / 1e6},
        {"bad_receivers", status.bad_receivers},
        {"bad_blockers", status.bad_blockers},
        {"non_finite", record.vectors.non_finite},
        {"warnings", record.scene.warnings}};
    io::AtomicFile file(path);
    const std::string text =
        json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
}

// Vectors know no light: the environment and what a scene without light would get are left out.
Scene open_geometry(const ExportFlags& flags) {
    io::GltfOptions options;
    options.scene = flags.scene_index;
    options.lightmaps = true;  // the copy of --gltf keeps all texture coordinates
    Scene scene = io::load_gltf(flags.scene, options);
    for (const std::string& warning : scene.warnings)
        notice(flags.device.quiet, "warning: " + warning);
    if (scene.triangles.empty()) throw InputError(flags.scene + ": the scene has no triangles");
    pose_scene("transfer", flags.animation, scene);
    return scene;
}

void save_vectors(const ExportFlags& flags, const Scene& scene, const lab::TransferVectors& vectors,
                  const DynamicTransferOptions& options) {
    const auto convention = lab::transfer_convention(vectors, options);
    if (!flags.exr.empty()) {
        io::Image image = lab::transfer_image(vectors);
        image.attributes = convention;
        io::save_exr(image, flags.exr, io::PixelType::full);
    }
    if (!flags.gltf.empty())
        io::save_glb(scene, flags.gltf, {lab::transfer_attributes(vectors), convention});
}

void warn_of(const TransferStatus& status) {
    const auto say = [](std::uint32_t count, const char* what) {
        if (count > 0) notice(false, fmt::format("warning: {} {}", count, what));
    };
    say(status.bad_receivers, "vertices had positions or normals that were not finite");
    say(status.bad_blockers, "triangles were not finite and cast no shadow");
    say(status.bad_texels, "numbers of the environment were not finite and were read as 0");
    say(status.non_finite, "packets of vertices had numbers that were not finite");
}

// A name that says another format is a slip.
void need_format(const std::string& file, const char* flag, const std::string& wanted) {
    std::string found = std::filesystem::path(file).extension().string();
    std::transform(found.begin(), found.end(), found.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* other : {".exr", ".glb", ".gltf", ".png", ".hdr", ".json"})
        if (found == other && found != wanted)
            throw Error(fmt::format("transfer: {} is '{}', a name that ends in {} needed", flag,
                                    file, wanted));
}

void run_export(const ExportFlags& flags) {
    need_format(flags.exr, "-o", ".exr");
    need_format(flags.gltf, "--gltf", ".glb");
    if (flags.exr.empty() && flags.gltf.empty())
        throw Error("transfer: no output; -o FILE.exr or --gltf FILE.glb needed");
    const Scene scene = open_geometry(flags);
    if (flags.rings_given && flags.coarse == 0)
        throw Error("transfer: --rings goes only with --coarse");
    DynamicTransferOptions options = flags.options.transfer;
    options.build = build_of(flags.device);
    if (flags.coarse > 0)
        options.coarse = lab::coarse_mesh(scene, static_cast<std::size_t>(flags.coarse));
    const Session session = open_session(flags.device);

    const Stopwatch build;
    const DeviceScene device_scene(session.context, session.device, scene);
    const Programs programs = programs_of(session);
    DynamicTransferSolver solver(programs, session.queue, scene, device_scene, options);
    const double build_seconds = build.seconds();
    catch_interrupts();
    const Stopwatch watch;
    if (!solver.run(progress_bar("transfer", flags.device.quiet))) throw Interrupted();
    const double transfer_seconds = watch.seconds();
    const lab::TransferVectors vectors = lab::transfer_vectors(session.queue, solver, device_scene);
    if (interrupted()) throw Interrupted();

    save_vectors(flags, scene, vectors, options);
    if (!flags.stats.empty())
        save_export_stats({scene, solver, vectors, build_seconds, transfer_seconds}, flags.stats);
    warn_of(solver.status());
    if (vectors.non_finite > 0)
        notice(false,
               fmt::format("warning: {} numbers of transfer vectors were not finite and were "
                           "written as 0",
                           vectors.non_finite));
    if (flags.device.quiet) return;
    const bool both = !flags.exr.empty() && !flags.gltf.empty();
    fmt::print("{}{}{}: {} terms at {} vertices{}, {:.2f} s\n", flags.exr, both ? ", " : "",
               flags.gltf, sh::terms(vectors.bands), vectors.vertices,
               vectors.back.empty()
                   ? ""
                   : fmt::format(" and {} other sides",
                                 solver.receivers().count - device_scene.vertex_order().size()),
               transfer_seconds);
}

}  // namespace

void add_transfer(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("transfer", "Transfer vectors of vertices, in spherical harmonics");
    const auto flags = std::make_shared<ExportFlags>();
    command->add_option("scene", flags->scene, ".gltf or .glb file")
        ->required()
        ->type_name("SCENE");
    command->add_option("-o,--output", flags->exr, "EXR of vectors, a channel a term")
        ->type_name("FILE")
        ->default_str("none");
    command->add_option("--gltf", flags->gltf, "GLB of the scene with vectors as vertex attributes")
        ->type_name("FILE")
        ->default_str("none");
    add_option_flags(*command, flags->options, of_vectors);
    add_count(*command, "--coarse", flags->coarse,
              "Triangles of a simplified mesh that blocks where it is far away; 0: none", 0,
              1 << 26);
    add_animation_flags(*command, flags->animation);
    command->add_option("--scene", flags->scene_index, "Index of the glTF scene")
        ->type_name("N")
        ->default_str("the file's");
    command->add_option("--stats", flags->stats, "JSON file with parts, settings and time")
        ->type_name("FILE")
        ->default_str("none");
    add_device_flags(*command, flags->device);
    command->callback([flags, command] {
        flags->rings_given = command->count("--rings") > 0;
        run_export(*flags);
    });
}

}  // namespace clgi::program
