// What several commands do alike: choose a device, open a scene, react to Ctrl-C.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/device.hpp>
#include <clgi/pass.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/environment.hpp"

namespace clgi::cli {

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

// --scene and --camera of commands that read a glTF file.
void add_place_options(CLI::App& command, int& scene, int& camera);

struct Session {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;  // with profiling
};

// Opens the device and names it in one line, unless quiet. properties: what its context is made
// with besides the device, if anything.
using ContextProperties = std::function<std::vector<cl_context_properties>(const cl::Device&)>;
Session open_session(const DeviceFlags& flags, const ContextProperties& properties = nullptr);

// How the flags ask for kernels to be built.
BuildOptions build_of(const DeviceFlags& flags);

// "" where they ask for nothing special, else the flags again, with a space before each.
std::string build_flags(const DeviceFlags& flags);

// Loads a glTF file, prints its warnings, gives it the environment that was asked for, and a camera
// and a light where it has none, saying so. lightmaps: keeps texture coordinates without textures.
Scene open_scene(const std::string& path, int scene_index, const EnvironmentFlags& environment,
                 bool quiet, bool lightmaps = false);

// A line of notice on stderr, unless quiet.
void notice(bool quiet, const std::string& text);

// From here on Ctrl-C sets a flag instead of ending the process.
void catch_interrupts();
bool interrupted();

// Thrown to leave a command after Ctrl-C; main ends with exit code 130.
struct Interrupted {};

// Draws a bar on stderr when that is a terminal; false after Ctrl-C.
std::function<bool(double)> progress_bar(const std::string& what, bool quiet);

}  // namespace clgi::cli
