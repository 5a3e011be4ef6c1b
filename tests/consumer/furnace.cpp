// Renders the inside of a sphere with an installed clgi and checks it against the closed form
//
//   L = rho/pi E,  E = rho Phi / (4 pi R^2),  Phi = 2 pi I (1 - cos a)
//
// which holds at every pixel: any two points of a sphere exchange the same share of light.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

// The mean of the red plane.
double mean_radiance(const clgi::SecondOrderSolver& solver, const cl::CommandQueue& queue) {
    const std::size_t pixels =
        static_cast<std::size_t>(solver.options().width) * solver.options().height;
    std::vector<float> red(pixels);
    queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, 0, pixels * sizeof(float), red.data());
    double sum = 0.0;
    for (const float value : red) sum += value;
    return sum / static_cast<double>(pixels);
}

int check() {
    const clgi::FurnaceOptions sphere;
    const clgi::Scene scene = clgi::furnace(sphere);

    const cl::Device device = clgi::choose_device();
    std::printf("%s\n", clgi::describe(device).c_str());
    const cl::Context context(device);
    const cl::CommandQueue queue(context, device);
    const clgi::DeviceScene device_scene(context, device, scene);

    clgi::SecondOrderOptions options;
    options.width = 64;
    options.height = 48;
    options.negative_vpls = 0;
    options.direct = false;
    clgi::SecondOrderSolver solver(queue, device_scene, options);
    solver.render(scene.cameras.front()).wait();

    const double pi = 3.14159265358979;
    const double flux = 2.0 * pi * sphere.intensity * (1.0 - std::cos(sphere.cone_angle));
    const double irradiance = sphere.albedo * flux / (4.0 * pi * sphere.radius * sphere.radius);
    const double expected = sphere.albedo / pi * irradiance;
    const double got = mean_radiance(solver, queue);
    std::printf("mean radiance %.6g, closed form %.6g\n", got, expected);
    // The sphere is a polyhedron of 5120 faces: its area is 0.3 % less.
    return std::abs(got / expected - 1.0) < 0.01 ? 0 : 1;
}

}  // namespace

int main() {
    try {
        return check();
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "furnace: %s\n", error.what()), 1;
    }
}
