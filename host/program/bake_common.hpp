// What bakes have in common: flags, whether so many VPLs fit, patches, VPLs and texels of a scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <clgi/advanced/bake_layout.hpp>
#include <clgi/advanced/static_bake.hpp>
#include <clgi/light_atlas.hpp>
#include <clgi/opencl.hpp>
#include <string>

namespace clgi::program {

// Seconds from its making.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// --bounces, --hemicube-size, --refine and --atlas-size. prefix: of what each is for.
void add_bake_flags(CLI::App& command, const std::string& prefix, LightAtlasOptions& bake,
                    AtlasOptions& atlas);

// --shadow-size, --face-size, --area-samples and --environment-lights.
void add_emitter_flags(CLI::App& command, EmitterOptions& emitters);

// An option that takes whole numbers from `least` to `most`.
template <typename T>
CLI::Option* add_count(CLI::App& command, const std::string& name, T& value,
                       const std::string& text, int least, int most) {
    return command.add_option(name, value, text)->type_name("N")->check(CLI::Range(least, most));
}

// Whether so many VPLs can be baked at all, before they are placed: that takes long, and memory of
// its own. Throws DeviceError that begins with the command's name.
void check_capacity(const std::string& command, const cl::Device& device,
                    const VplOptions& options);

struct BakeLayout : clgi::BakeLayout {
    double seconds = 0.0;
};
struct StaticBake : clgi::StaticBake {
    double seconds = 0.0;
};

// Add the warnings of the atlas to the scene's, and print them unless quiet. The second is of a
// scene in which things move.
BakeLayout lay_out(Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas, bool quiet);
StaticBake lay_out_static(Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas,
                          bool quiet);

}  // namespace clgi::program
