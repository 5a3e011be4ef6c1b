// What several commands share: choosing a device, notices, reacting to Ctrl-C.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device.hpp>
#include <clgi/programs.hpp>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace clgi::program {

// Flags that every command with a device has.
struct DeviceFlags {
    std::string device;
    std::string math = "strict";
    std::string storage = "full";
    bool quiet = false;
};
void add_device_flags(CLI::App& command, DeviceFlags& flags);
void add_device_option(CLI::App& command, std::string& choice);  // --device alone
void add_quiet_flag(CLI::App& command, bool& quiet);             // --quiet alone

// Those of the flags that the user gave.
std::vector<std::string> given(const CLI::App& command, std::initializer_list<const char*> names);

struct Session {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;  // with profiling
};

// Opens the device and prints its name, unless quiet. properties: further properties of its
// context, if any.
using ContextProperties = std::function<std::vector<cl_context_properties>(const cl::Device&)>;
Session open_session(const DeviceFlags& flags, const ContextProperties& properties = nullptr);

// Kernels of a session. Their binaries are kept in the folder of CLGI_CACHE, or in the user's cache
// where the platform keeps none itself.
Programs programs_of(const Session& session);

// The build options that the flags select.
BuildOptions build_of(const DeviceFlags& flags);

// Prints a line on stderr, unless quiet.
void notice(bool quiet, const std::string& text);

// From here on Ctrl-C sets a flag instead of ending the process.
void catch_interrupts();
bool interrupted();

// Thrown to leave a command after Ctrl-C; main ends with exit code 130.
struct Interrupted {};

// Draws a bar and the time left on stderr if that is a terminal. The result returns false after
// Ctrl-C.
std::function<bool(double)> progress_bar(const std::string& what, bool quiet);

// Of work that went from the share `from` to the share `done` in so many seconds: "12 s left",
// "3 min left"; empty while it is too early to tell.
std::string time_left(double from, double done, double seconds);

}  // namespace clgi::program
