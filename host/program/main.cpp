// The program: one command a run, one line on stderr when it fails.
//
// Exit code 0 done, 1 wrong use, 2 bad input, 3 device or memory, 130 cancelled by Ctrl-C.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/error.hpp>
#include <clgi/opencl.hpp>
#include <cstdio>
#include <new>
#include <string>

#include "core/opencl/error_text.hpp"
#include "program/commands.hpp"
#include "program/help.hpp"
#include "program/session.hpp"
#include "program/version.hpp"

namespace {

enum Exit { done = 0, wrong_use = 1, bad_input = 2, device_or_memory = 3, cancelled = 130 };

// One line whatever the text holds: file names and build logs may contain line breaks.
int fail(Exit code, std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    std::fflush(stdout);
    fmt::print(stderr, "clgi: error: {}\n", text);
    return code;
}

// CLI11 would only say that a subcommand is missing.
void check_command(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-') return;
    std::string known;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (command->get_name() == argv[1]) return;
        known += (known.empty() ? "" : ", ") + command->get_name();
    }
    throw clgi::Error(fmt::format("unknown command '{}'; known commands are {}", argv[1], known));
}

int parse_and_run(CLI::App& app, int argc, char** argv) {
    check_command(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        return app.exit(asked);  // --help, --version
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
        return fail(bad_input, "standard output cannot be written");
    }
    return done;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        CLI::App app("Global illumination on any OpenCL device.", "clgi");
        app.set_version_flag("--version", "clgi " CLGI_VERSION);
        app.require_subcommand(1);
        clgi::program::set_help(app);
        clgi::program::add_devices(app);
        clgi::program::add_scene(app);
        clgi::program::add_plan(app);
        clgi::program::add_render(app);
#ifdef CLGI_HAS_VIEW
        clgi::program::add_view(app);
#endif
        clgi::program::add_bake(app);
        clgi::program::add_transfer(app);
        clgi::program::add_reference(app);
        clgi::program::add_verify(app);
        clgi::program::add_compare(app);
        clgi::program::add_sweep(app);
        clgi::program::add_bench(app);
        return parse_and_run(app, argc, argv);
    } catch (const clgi::program::Interrupted&) {
        std::fputs("clgi: cancelled\n", stderr);
        return cancelled;
    } catch (const CLI::Error& error) {
        return fail(wrong_use, error.what());
    } catch (const clgi::InputError& error) {
        return fail(bad_input, error.what());
    } catch (const clgi::DeviceError& error) {
        return fail(device_or_memory, error.what());
    } catch (const clgi::Error& error) {
        return fail(wrong_use, error.what());
    } catch (const cl::Error& error) {
        return fail(device_or_memory,
                    fmt::format("{}: {}", error.what(), clgi::error_text(error.err())));
    } catch (const std::bad_alloc&) {
        return fail(device_or_memory, "out of memory");
    } catch (const std::exception& error) {
        return fail(device_or_memory, error.what());
    }
}
