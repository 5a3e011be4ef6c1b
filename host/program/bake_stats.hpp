// The JSON that a bake writes with --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <clgi/reference.hpp>
#include <filesystem>
#include <optional>

#include "program/bake_gltf.hpp"

namespace clgi::program {

struct BakeRecord {
    const Scene& scene;
    const BakeLayout& layout;
    const LightAtlasSolver& solver;
    AtlasSeams seams;
    std::optional<LitGltf> gltf;  // none: no such file
    std::optional<reference::Verification> verified;
    double layout_seconds = 0.0;  // patches, VPLs and texels
    double build_seconds = 0.0;   // kernels and buffers
    double bake_seconds = 0.0;
    std::uint32_t resumed_at = 0;  // VPLs that had lit the texels before
};

// Writes a temporary file and renames it. Throws InputError when it cannot be written.
void save_bake_stats(const BakeRecord& record, const std::filesystem::path& path);

}  // namespace clgi::program
