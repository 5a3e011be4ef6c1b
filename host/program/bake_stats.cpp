// SPDX-License-Identifier: MIT
#include "program/bake_stats.hpp"

#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "lab/timing.hpp"
#include "program/verify.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

using nlohmann::ordered_json;

// Seconds on the device by pass, in the order in which they first ran.
ordered_json passes_json(const std::vector<PassEvent>& events) {
    ordered_json out = ordered_json::array();
    for (const lab::PassTime& pass : lab::pass_times(events))
        out.push_back({{"name", pass.name}, {"seconds", 1e-3 * pass.milliseconds}});
    return out;
}

}  // namespace

void save_bake_stats(const BakeRecord& record, const std::filesystem::path& path) {
    const LightAtlasStatus status = record.solver.status();
    const BakeLayout& layout = record.layout;
    ordered_json json = {
        {"clgi", CLGI_VERSION},
        {"method", "atlas"},
        {"scene",
         {{"triangles", record.scene.triangles.size()}, {"lights", record.scene.lights.size()}}},
        {"vpls", layout.vpls.vpls.size()},
        {"sample_points", layout.vpls.samples.size()},
        {"patches", layout.patches.patches.size()},
        {"skipped_area", layout.patches.skipped_area},
        {"texels", layout.atlas.texels.size()},
        {"texels_skipped_area", layout.atlas.skipped_area},
        {"pages", layout.atlas.pages},
        {"charts", layout.atlas.charts.size()},
        {"seams",
         {{"length", record.seams.length},
          {"difference", record.seams.difference},
          {"worst", record.seams.worst}}},
        {"shots", status.shots},
        {"transport_kept", status.transport_kept},
        {"visibility_kept", status.visibility_kept},
        {"resumed_at", record.resumed_at},
        {"power",
         {{"direct", status.power_direct},
          {"shot", status.power_shot},
          {"received", status.power_received},
          {"lost", status.power_lost},
          {"left", status.power_left}}},
        {"seconds",
         {{"layout", record.layout_seconds},
          {"build", record.build_seconds},
          {"bake", record.bake_seconds}}},
        {"passes", passes_json(record.solver.events())},
        {"memory_mb", static_cast<double>(record.solver.bytes()) / 1e6},
        {"non_finite", status.non_finite},
        {"warnings", record.scene.warnings}};
    if (record.gltf)
        json["gltf"] = {{"exposure", record.gltf->stops}, {"detail", record.gltf->detail}};
    if (record.verified) json["measured_error"] = verify_json(*record.verified);
    io::AtomicFile file(path);
    const std::string text =
        json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace clgi::program
