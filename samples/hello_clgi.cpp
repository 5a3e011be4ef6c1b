// Lights a glTF scene, or the Cornell box where none is named, and writes a picture.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
    try {
        clgi::Scene scene = argc > 1 ? clgi::io::load_gltf(argv[1]) : clgi::cornell();
        if (scene.cameras.empty()) scene.cameras.push_back(clgi::default_camera(scene));
        if (scene.lights.empty() && !clgi::has_emission(scene))
            scene.lights.push_back(clgi::default_light(scene));

        // Yours: device, context and queue.
        cl::Device device = clgi::choose_device();
        cl::Context context(device);
        cl::CommandQueue queue(context, device);

        clgi::SecondOrderOptions options;
        options.width = 320;
        options.height = 240;
        clgi::DeviceScene device_scene(context, device, scene);
        clgi::SecondOrderSolver solver(queue, device_scene, options);
        cl::Event done = solver.render(scene.cameras[0]);  // returns at once

        // Planes of R, G and B, cd/m^2, solver.stride() floats apart.
        std::vector<float> plane(options.width * options.height);
        clgi::io::Image image{options.width, options.height};
        for (int c = 0; c < 3; ++c) {
            const std::vector<cl::Event> wait{done};
            queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, c * solver.stride() * sizeof(float),
                                    plane.size() * sizeof(float), plane.data(), &wait);
            image.channels.push_back({std::string(1, "RGB"[c]), plane});
        }
        clgi::io::save_exr(image, "hello.exr", clgi::io::PixelType::half);
        std::printf("hello.exr, by %s\n", clgi::describe(device).c_str());
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "hello_clgi: %s\n", error.what()), 1;
    }
}
