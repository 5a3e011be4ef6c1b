// The scenes of [Kautz04, tables 1 and 2], what the paper has of them, and settings.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/error.hpp>
#include "lab/scenes/deforming.hpp"

#include "lab/bench_kautz.hpp"

namespace clgi::lab {
namespace {

Scene deforming(const std::string& name) {
    if (name == "cloth") return cloth();
    if (name == "fight") return fight_like();
    if (name == "chess") return chess();
    if (name == "hand") return hand_like();
    throw Error("bench: " + name + " is not one of cloth, fight, chess and hand");
}

// [Kautz04, tables 1 and 2]
const KautzScene paper[] = {
    {"cloth", {}, 160, 15.5, 236.4, 0.0, 0.0, 0.0247, {0.480, 0.235, 0.265, 0.020}},
    {"fight", {}, 444, 4.9, 448.8, 9.5, 99.5, 0.0793, {0.544, 0.194, 0.244, 0.018}},
    {"chess", {}, 382, 7.8, 378.8, 15.1, 73.9, 0.0289, {0.520, 0.238, 0.219, 0.023}},
    {"hand", {}, 378, 2.6, 414.1, 6.1, 49.7, 0.0382, {0.423, 0.352, 0.194, 0.031}}};

}  // namespace

std::vector<KautzScene> kautz_scenes(const std::vector<std::string>& names) {
    for (const std::string& name : names) deforming(name);
    std::vector<KautzScene> out;
    for (const KautzScene& row : paper) {
        if (!names.empty() && std::find(names.begin(), names.end(), row.name) == names.end())
            continue;
        out.push_back(row);
        Scene& scene = out.back().scene;
        scene = deforming(row.name);
        scene.moving_bounds = motion_bounds(scene, 0);
        for (Material& material : scene.materials) material.double_sided = false;
    }
    return out;
}

std::vector<KautzSettings> kautz_settings(const KautzScene& scene) {
    KautzSettings paper;
    paper.name = "paper";
    paper.masks.planes = EdgePlanes::table;
    paper.masks.block = 4;
    paper.cells = CellIntegral::centre;
    // A mesh simplified in the middle of the clip is closer to its poses than the one at rest. Half
    // as many triangles again take less time than exact edges or finer masks, and do more against
    // the error; with visible sets most of them are in no list.
    KautzSettings ours;
    ours.name = "clgi";
    ours.masks.planes = EdgePlanes::table;
    ours.coarse = 1.5;
    ours.rings = 2;
    ours.pose = 0.5;
    // All triangles block everywhere.
    KautzSettings fine;
    fine.name = "fine";
    fine.masks.size = 128;
    fine.coarse = 0.0;
    std::vector<KautzSettings> out;
    for (const KautzSettings& settings : {paper, ours, fine})
        for (const bool sets : {false, true}) {
            if (sets && (scene.fps_sets == 0.0 || settings.coarse == 0.0)) continue;
            out.push_back(settings);
            out.back().sets = sets;
            if (sets && settings.name == "clgi") out.back().coarse = 2.5;
        }
    return out;
}

}  // namespace clgi::lab
