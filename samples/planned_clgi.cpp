// Asks what a glTF scene calls for, renders it within the time of argument 2 (seconds), and writes
// planned.exr.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
    try {
        clgi::Scene scene = argc > 1 ? clgi::io::load_gltf(argv[1]) : clgi::cornell();
        if (scene.cameras.empty()) scene.cameras.push_back(clgi::default_camera(scene));
        if (scene.lights.empty() && !clgi::has_emission(scene))
            scene.lights.push_back(clgi::default_light(scene));

        cl::Device device = clgi::choose_device();
        cl::Context context(device);
        cl::CommandQueue queue(context, device);
        clgi::Programs programs(context, device);

        clgi::PlanRequest request;
        request.width = 320;
        request.height = 240;
        if (argc > 2) request.seconds = std::atof(argv[2]);
        const clgi::Camera camera = scene.cameras[0];
        const clgi::Plan plan = clgi::make_plan(queue, programs, scene, camera, request);
        for (const clgi::EffectChoice& effect : plan.effects)
            std::printf("%-20s %s\n", name_of(effect.effect), effect.on ? "on" : "off");
        std::printf("method %s: %s\n", name_of(plan.method), plan.why.c_str());

        scene = clgi::planned_scene(scene, plan);
        clgi::DeviceScene uploaded(context, device, scene);
        clgi::PlannedRenderer renderer(programs, queue, scene, uploaded, plan);
        renderer.prepare();
        const std::vector<cl::Event> wait{renderer.render(camera)};

        std::vector<float> plane(request.width * request.height);
        clgi::io::Image image{request.width, request.height};
        for (int c = 0; c < 3; ++c) {
            queue.enqueueReadBuffer(renderer.radiance(), CL_TRUE,
                                    c * renderer.stride() * sizeof(float),
                                    plane.size() * sizeof(float), plane.data(), &wait);
            image.channels.push_back({std::string(1, "RGB"[c]), plane});
        }
        clgi::io::save_exr(image, "planned.exr", clgi::io::PixelType::half);
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "planned_clgi: %s\n", error.what()), 1;
    }
}
