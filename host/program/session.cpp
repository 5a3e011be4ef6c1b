// SPDX-License-Identifier: MIT
#include "program/session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <clgi/error.hpp>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "core/opencl/error_text.hpp"

namespace clgi::program {
namespace {

std::atomic<bool> interrupt_flag{false};

// Of the user, by the rules of XDG; empty: none.
std::filesystem::path cache_folder() {
    const char* caches = std::getenv("XDG_CACHE_HOME");
    if (caches && std::filesystem::path(caches).is_absolute())
        return std::filesystem::path(caches) / "clgi";
    const char* home = std::getenv("HOME");
    return home && *home ? std::filesystem::path(home) / ".cache" / "clgi"
                         : std::filesystem::path();
}

bool keeps_programs(const cl::Device& device) {
    const std::string name =
        cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>();
    return name == "Portable Computing Language" || name == "NVIDIA CUDA" || name == "Oclgrind";
}

}  // namespace

void add_device_option(CLI::App& command, std::string& choice) {
    command.add_option("--device", choice, "platform:CPU|GPU:name-or-index")
        ->type_name("CHOICE")
        ->default_str("CLGI_DEVICE, else the first GPU, else the first CPU");
}

void add_quiet_flag(CLI::App& command, bool& quiet) {
    command.add_flag("--quiet", quiet, "Print no notices, no progress bar and no summary");
}

void add_device_flags(CLI::App& command, DeviceFlags& flags) {
    add_device_option(command, flags.device);
    command.add_option("--math", flags.math, "Math of the kernels; fast may reorder and round")
        ->type_name("MATH")
        ->check(CLI::IsMember({"strict", "fast"}));
    command
        .add_option("--storage", flags.storage,
                    "Number format of planes between passes: full is float")
        ->type_name("STORAGE")
        ->check(CLI::IsMember({"full", "half"}));
    add_quiet_flag(command, flags.quiet);
}

Session open_session(const DeviceFlags& flags, const ContextProperties& properties) {
    Session out;
    out.device = choose_device(flags.device);
    notice(flags.quiet, describe(out.device));
    const auto more = properties ? properties(out.device) : std::vector<cl_context_properties>();
    try {
        out.context = cl::Context(out.device, more.empty() ? nullptr : more.data());
        out.queue = cl::CommandQueue(out.context, out.device, CL_QUEUE_PROFILING_ENABLE);
    } catch (const cl::Error& error) {
        throw DeviceError(fmt::format("device: {} cannot be opened: {}", describe(out.device),
                                      error_text(error.err())));
    }
    return out;
}

Programs programs_of(const Session& session) {
    Programs out(session.context, session.device);
    const char* wanted = std::getenv("CLGI_CACHE");
    const std::string folder = wanted ? wanted : "";
    if (!folder.empty() && folder != "off")
        out.keep_binaries(folder);
    else if (folder.empty() && !keeps_programs(session.device))
        out.keep_binaries(cache_folder());
    return out;
}

BuildOptions build_of(const DeviceFlags& flags) {
    BuildOptions out;
    out.math = flags.math == "fast" ? Math::fast : Math::strict;
    out.storage = flags.storage == "half" ? Storage::half : Storage::full;
    return out;
}

void notice(bool quiet, const std::string& text) {
    if (!quiet) fmt::print(stderr, "clgi: {}\n", text);
}

void catch_interrupts() {
    std::signal(SIGINT, [](int) {
        interrupt_flag = true;
        std::signal(SIGINT, SIG_DFL);  // a second Ctrl-C ends the program at once
    });
}

bool interrupted() { return interrupt_flag; }

std::string time_left(double from, double done, double seconds) {
    if (!(done > from) || seconds < 1.0) return "";  // too early to tell
    const double left = seconds * (1.0 - done) / (done - from);
    if (left < 60.0) return fmt::format("{:.0f} s left", std::ceil(left));
    const auto minutes = static_cast<long>(std::ceil(left / 60.0));
    if (minutes < 60) return fmt::format("{} min left", minutes);
    return fmt::format("{} h {:02} min left", minutes / 60, minutes % 60);
}

std::vector<std::string> given(const CLI::App& command, std::initializer_list<const char*> names) {
    std::vector<std::string> out;
    for (const char* name : names)
        if (command.count(name) > 0) out.emplace_back(name);
    return out;
}

std::function<bool(double)> progress_bar(const std::string& what, bool quiet) {
    using Clock = std::chrono::steady_clock;
    struct Begin {
        double done = 0.0;
        Clock::time_point time;
    };
    const bool draw = !quiet && isatty(fileno(stderr)) == 1;
    return [what, draw, begin = std::optional<Begin>()](double done) mutable {
        if (!draw) return !interrupted();
        // Work that goes on from where it was cancelled begins with a share that took no time.
        if (!begin && done > 0.0) begin = Begin{done, Clock::now()};
        std::string left;
        if (begin && done < 1.0)
            left = time_left(begin->done, done,
                             std::chrono::duration<double>(Clock::now() - begin->time).count());
        fmt::print(stderr, "\r{} [{:<30}] {:3.0f} % {:<14}{}", what,
                   std::string(static_cast<std::size_t>(done * 30.0), '#'), 100.0 * done, left,
                   done >= 1.0 || interrupted() ? "\n" : "");
        std::fflush(stderr);
        return !interrupted();
    };
}

}  // namespace clgi::program
