// The JSON that a bake writes with --stats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <filesystem>
#include <vector>

namespace clgi::cli {

struct BakeRecord {
    const Scene& scene;
    const Patches& patches;
    const VplLayout& vpls;
    const AtlasLayout& atlas;
    const LightAtlasSolver& solver;
    double layout_seconds = 0.0;  // patches, VPLs, charts, texels; on the host
    double build_seconds = 0.0;   // kernels and buffers
    double bake_seconds = 0.0;
    std::uint32_t resumed_at = 0;  // VPLs that had lit the texels before
};

// Writes a temporary file and renames it. Throws InputError when it cannot be written.
void save_bake_stats(const BakeRecord& record, const std::filesystem::path& path);

}  // namespace clgi::cli
