// SPDX-License-Identifier: MIT
#include "program/vector_flags.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "lab/coarse_mesh.hpp"
#include "program/bake_common.hpp"
#include "program/session.hpp"

namespace clgi::program {

void add_vector_flags(CLI::App& command, const std::string& prefix, VectorFlags& flags) {
    add_count(command, "--sh-order", flags.order,
              prefix + "Highest degree of spherical harmonics; 4 has 25 terms", 0,
              sh::most_bands - 1);
    command
        .add_option("--mask", flags.solver.masks.size,
                    prefix + "Pixels, width of a visibility mask")
        ->type_name("N")
        ->check(CLI::IsMember({8, 16, 32, 64, 128}));
    command
        .add_option("--table", flags.table,
                    prefix + "Size of the table of half-planes; 0: none, planes are exact")
        ->type_name("N")
        ->check(CLI::IsMember({0, 16, 32, 64, 128, 256, 512}));
    command
        .add_option("--mask-block", flags.solver.masks.block,
                    prefix + "Pixels, width of the cells of a mask that are integrated")
        ->type_name("N")
        ->check(CLI::IsMember({1, 2, 4, 8}));
    command.add_option("--sh-window", flags.window, prefix + "Window against ringing")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"none", "hann", "lanczos"}));
    add_count(command, "--coarse", flags.coarse,
              prefix + "Triangles of a simplified mesh that blocks where it is far away; 0: none",
              0, 1 << 26);
    add_count(command, "--rings", flags.solver.rings,
              prefix + "With --coarse: edges from a vertex up to which the scene itself blocks", 0,
              2)
        ->each([&flags](const std::string&) { flags.rings_given = true; });
}

DynamicTransferOptions vector_options(const std::string& command, const VectorFlags& flags,
                                      const Scene& scene, const BuildOptions& build) {
    if (flags.rings_given && flags.coarse == 0)
        throw Error(command + ": --rings goes only with --coarse");
    DynamicTransferOptions out = flags.solver;
    out.masks.bands = flags.order + 1;
    out.masks.planes = flags.table > 0 ? EdgePlanes::table : EdgePlanes::exact;
    if (flags.table > 0) out.masks.table_size = flags.table;
    out.window = flags.window == "hann"      ? sh::Window::hann
                 : flags.window == "lanczos" ? sh::Window::lanczos
                                             : sh::Window::none;
    out.build = build;
    if (flags.coarse > 0)
        out.coarse = lab::coarse_mesh(scene, static_cast<std::size_t>(flags.coarse));
    return out;
}

void warn_of(const TransferStatus& status, std::uint32_t further) {
    const auto say = [](std::uint32_t count, const char* what) {
        if (count > 0) notice(false, fmt::format("warning: {} {}", count, what));
    };
    say(status.bad_receivers, "vertices had positions or normals that were not finite");
    say(status.bad_blockers, "triangles were not finite and cast no shadow");
    say(status.bad_texels, "numbers of the environment were not finite and were read as 0");
    say(status.non_finite + further,
        "packets of vertices or pixels had numbers that were not finite");
}

}  // namespace clgi::program
