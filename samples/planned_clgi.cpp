// Asks what a glTF scene calls for, renders it within the time of argument 2 (seconds), and writes
// planned.exr.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) try {
    clgi::Scene scene = argc > 1 ? clgi::io::load_gltf(argv[1]) : clgi::cornell();
    clgi::add_defaults(scene);

    cl::Device device = clgi::choose_device();
    cl::Context context(device);
    cl::CommandQueue queue(context, device);

    clgi::PlanRequest request;
    request.width = 320;
    request.height = 240;
    if (argc > 2) request.seconds = std::atof(argv[2]);
    const clgi::Camera camera = scene.cameras[0];
    const clgi::Plan plan =
        clgi::make_plan(queue, clgi::Programs(context, device), scene, camera, request);
    for (const clgi::EffectChoice& effect : plan.effects)
        std::printf("%-20s %s\n", name_of(effect.effect), effect.on ? "on" : "off");
    std::printf("method %s: %s\n", name_of(plan.method), plan.why.c_str());

    // A plan is the options of a renderer, for the scene without what it leaves out.
    clgi::Renderer renderer(queue, clgi::planned_scene(scene, plan), plan);
    renderer.prepare();
    renderer.render(camera);
    const auto [width, height] = renderer.size();
    clgi::io::save_exr(clgi::io::radiance_image(width, height, renderer.read_radiance()),
                       "planned.exr", clgi::io::PixelType::half);
} catch (const std::exception& error) {
    return std::fprintf(stderr, "planned_clgi: %s\n", error.what()), 1;
}
