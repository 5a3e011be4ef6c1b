// Lights a glTF scene, or the Cornell box where none is named, and writes a picture.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/io/image.hpp>
#include <cstdio>
#include <exception>

int main(int argc, char** argv) try {
    clgi::Scene scene = argc > 1 ? clgi::io::load_gltf(argv[1]) : clgi::cornell();
    clgi::add_defaults(scene);  // a camera and a light, where the file has none

    cl::Device device = clgi::choose_device();  // yours: device, context and queue
    cl::Context context(device);
    cl::CommandQueue queue(context, device);

    clgi::RendererOptions options;
    options.method = clgi::Method::second_order;  // or any other
    clgi::Renderer renderer(queue, scene, options);
    renderer.prepare();                   // nothing here; a bake, links or vectors of other methods
    renderer.render(scene.cameras[0]);    // returns at once
    const auto [width, height] = renderer.size();
    clgi::io::save_exr(clgi::io::radiance_image(width, height, renderer.read_radiance()),
                       "hello.exr", clgi::io::PixelType::half);
    std::printf("hello.exr, by %s\n", clgi::describe(device).c_str());
} catch (const std::exception& error) {
    return std::fprintf(stderr, "hello_clgi: %s\n", error.what()), 1;
}
