// OpenGL textures to a G-buffer with an installed clgi::gl, in C++17: a Cornell box drawn by
// OpenGL, handed over and lit. Where there is no OpenGL without a window it says so and ends well.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <clgi/gl/context.hpp>
#include <clgi/gl/renderer.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <vector>

namespace {

int light(const clgi::gl::HeadlessContext& opengl) {
    const cl::Device device = clgi::choose_device();
    const auto properties = clgi::gl::sharing_properties(device);
    const cl::Context context(device, properties.empty() ? nullptr : properties.data());
    const cl::CommandQueue queue(context, device);
    const clgi::Scene scene = clgi::cornell();
    const clgi::DeviceScene device_scene(context, device, scene);
    clgi::SecondOrderOptions options;
    options.width = 64;
    options.height = 48;
    clgi::SecondOrderSolver solver(queue, device_scene, options);

    clgi::gl::SceneRenderer engine(queue, device_scene);
    clgi::gl::GBufferImport import(context, device);
    const clgi::View view = clgi::make_view(scene.cameras[0], device_scene.frame(), 64, 48);
    engine.draw(view);
    const cl::Event ready =
        import.convert(queue, view, device_scene, engine.textures(), solver.gbuffer());
    solver.render(scene.cameras[0], solver.gbuffer(), {ready}).wait();

    std::vector<float> red(64 * 48);
    queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, 0, red.size() * sizeof(float), red.data());
    double sum = 0.0;
    for (const float value : red) sum += value;
    std::printf("%s; %s; mean radiance %.4g\n", opengl.description().c_str(), import.path().c_str(),
                sum / static_cast<double>(red.size()));
    return sum > 0.0 ? 0 : 1;
}

}  // namespace

int main() {
    std::unique_ptr<clgi::gl::HeadlessContext> opengl;
    try {
        opengl = std::make_unique<clgi::gl::HeadlessContext>();
    } catch (const clgi::DeviceError& error) {
        return std::printf("nothing was tried: %s\n", error.what()), 0;
    }
    try {
        return light(*opengl);
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "textures: %s\n", error.what()), 1;
    }
}
