// Any bytes as a glTF file: they are refused in one line, or what they load to keeps the promises
// of Scene, also posed and written again.
// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace clgi::fuzz {

// A folder of this process in memory where there is one, and removed with it.
class Scratch {
public:
    Scratch() {
        std::error_code none;
        const std::filesystem::path memory = "/dev/shm";
        folder_ =
            (std::filesystem::is_directory(memory, none) ? memory
                                                         : std::filesystem::temp_directory_path()) /
            ("clgi_fuzz_" + std::to_string(::getpid()));
        std::filesystem::create_directory(folder_);
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

inline void demand_scene(const Scene& scene, const char* when) {
    try {
        validate(scene);
        const Bounds box = bounds(scene);
        const glm::dvec3 size = box.high - box.low;
        if (!std::isfinite(size.x + size.y + size.z)) throw InputError("bounds are not finite");
    } catch (const InputError& error) {
        throw std::logic_error(std::string(when) + ": " + error.what());
    }
    for (const std::string& line : scene.warnings)
        if (line.empty() || line.find('\n') != std::string::npos)
            throw std::logic_error(std::string(when) + ": a warning that is not one line");
}

// Whether the bytes are a scene. Throws std::logic_error for a promise that is not kept.
inline bool try_scene(const std::uint8_t* data, std::size_t size) {
    static const Scratch scratch;
    const std::filesystem::path file = scratch.folder() / "input.gltf";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));

    io::GltfOptions options;
    options.max_triangles = 1u << 14;
    options.max_texels = 1u << 20;
    Scene scene;
    try {
        scene = io::load_gltf(file, options);
    } catch (const InputError& error) {
        const std::string text = error.what();
        if (text.empty() || text.find('\n') != std::string::npos)
            throw std::logic_error("refused, though not in one line: " + text);
        return false;
    }
    demand_scene(scene, "loaded");
    if (scene.animation)
        for (std::size_t clip = 0; clip < scene.animation->clips.size() && clip < 4; ++clip) {
            // A pose may overflow where curves do; it says so, and a valid one is valid.
            try {
                demand_scene(posed(scene, pose_at(*scene.animation, clip, 0.37)), "posed");
            } catch (const InputError&) {
            }
        }

    const std::filesystem::path again = scratch.folder() / "again.glb";
    try {
        io::save_glb(scene, again);
    } catch (const InputError&) {
        return true;  // what cannot be written says so
    }
    try {
        const Scene copy = io::load_gltf(again);
        if (copy.triangles.size() != scene.triangles.size())
            throw std::logic_error("written: other triangles");
    } catch (const InputError& error) {
        throw std::logic_error(std::string("written, and not read again: ") + error.what());
    }
    return true;
}

}  // namespace clgi::fuzz
