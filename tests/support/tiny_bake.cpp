// One bake of every kernel of the light atlas at the size of a stamp, for tools that interpret
// kernels.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/light_atlas.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "device.hpp"
#include "scenes.hpp"

namespace {

using namespace clgi;

enum class Way { all_at_once, strongest_alone, projected };

void bake(DeviceScene& scene, const Scene& world, Way way) {
    const bool one_at_a_time = way == Way::strongest_alone;
    LightAtlasOptions options;
    options.emitters.shadow_size = options.emitters.face_size = 16;
    options.hemicube_size = 32;
    options.bounces = one_at_a_time ? 0 : 2;
    options.threshold = 0.3f;
    options.one_at_a_time = one_at_a_time;
    if (way == Way::projected) options.filling = Filling::project;
    options.mesh = 8;
    options.build = {.packet_width = 4, .local_size = 16, .parallel = false};
    VplOptions few;
    few.count = 7;
    few.samples_per_vpl = 3;
    AtlasOptions small;
    small.size = 24;
    const Patches patches = make_patches(world);
    const test::Device& on = test::device();
    LightAtlasSolver solver(Programs(on.context, on.device), on.queue, scene,
                            place_vpls(world, patches, few),
                            make_atlas(world, patches.triangle_patch, small), options);
    solver.run();
    Light dimmed = world.lights[0];
    dimmed.intensity *= glm::vec3(0.5f, 0.7f, 0.9f);
    scene.set_light(0, dimmed);
    solver.lights_changed();
    if (way == Way::projected)
        solver.run();
    else
        solver.update(0.0);
    const LightAtlasStatus status = solver.status();
    std::printf("%zu passes, %u shots, %g lm received\n", solver.events().size(), status.shots,
                status.power_received);
}

}  // namespace

int main() {
    try {
        Scene world = test::plain_scene();
        test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
        test::add_box(world, {-0.4, -0.9, -0.4}, {0.4, -0.2, 0.3}, 1);
        world.lights = {test::spot_light({0.3, 0.9, 0.3}, {-0.3f, -1, -0.3f}, 0.6)};
        DeviceScene scene = test::on_device(world);
        for (const Way way : {Way::all_at_once, Way::strongest_alone, Way::projected})
            bake(scene, world, way);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    // As in tiny_frame.cpp.
    std::fflush(stdout);
    std::_Exit(0);
}
