// clgi sweep SCENE -o folder/ --convergence: how the iterations of antiradiance come to rest.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <clgi/error.hpp>

#include "lab/convergence.hpp"
#include "program/sweep_flags.hpp"
#include "program/version.hpp"

namespace clgi::program {

void run_convergence(const SweepFlags& flags) {
    const Scene scene = open_sweep_scene(flags);
    const Session session = open_session(flags.device);
    make_folder(flags.output);
    lab::ConvergenceSetup setup{session.queue, scene};
    setup.options.bins = flags.bins > 0 ? flags.bins : flags.quick ? 64 : 128;
    setup.options.elements.requested = static_cast<std::size_t>(flags.elements > 0 ? flags.elements
                                                                : flags.quick      ? 2000
                                                                                   : 8192);
    setup.options.build = build_of(flags.device);
    setup.steps = flags.steps > 0 ? flags.steps : flags.quick ? 40 : 100;
    catch_interrupts();
    setup.progress = progress_bar("sweep", flags.device.quiet);
    lab::Convergence found;
    try {
        found = lab::measure_convergence(setup);
    } catch (const Error&) {
        if (interrupted()) throw Interrupted();
        throw;
    }
    if (setup.progress) setup.progress(1.0);
    const std::string why =
        lab::save_convergence(found, {flags.command, CLGI_VERSION}, flags.output);
    if (!why.empty()) notice(flags.device.quiet, "no plot: " + why);
    if (flags.device.quiet) return;
    for (const std::string& line : lab::summary(found)) fmt::print("{}\n", line);
    fmt::print("{}: convergence.csv, convergence.json{}\n", flags.output,
               why.empty() ? ", convergence.svg" : "");
}

}  // namespace clgi::program
