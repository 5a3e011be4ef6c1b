// Sends the furnace through a file and path-traces it with an installed clgi::io and
// clgi::reference: one bounce of light, the closed form of furnace.cpp again.
// SPDX-License-Identifier: MIT
#include <clgi/io/gltf.hpp>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <cstdio>
#include <exception>

namespace {

int check(const char* glb) {
    const clgi::FurnaceOptions sphere;
    clgi::io::save_glb(clgi::furnace(sphere), glb);
    const clgi::Scene scene = clgi::io::load_gltf(glb);

    clgi::reference::Options options;
    options.width = 32;
    options.height = 24;
    options.samples = 64;
    options.effects = clgi::reference::parse_effects("one-bounce");
    const clgi::reference::PathTracer tracer(scene);
    const clgi::reference::Picture picture = tracer.render(scene.cameras.front(), options);
    double got = 0.0;
    for (const glm::vec3& radiance : picture.radiance) got += radiance.x;
    got /= static_cast<double>(picture.radiance.size());

    const double pi = 3.14159265358979;
    const double flux = 2.0 * pi * sphere.intensity * (1.0 - std::cos(sphere.cone_angle));
    const double irradiance = sphere.albedo * flux / (4.0 * pi * sphere.radius * sphere.radius);
    const double expected = sphere.albedo / pi * irradiance;
    std::printf("mean radiance %.6g, closed form %.6g\n", got, expected);
    // A per cent for the facets, and six of the mean's standard errors, which the tracer tells.
    double variance = 0.0;
    for (const float error : picture.error) variance += double(error) * error;
    const double noise = 6.0 * std::sqrt(variance) / static_cast<double>(picture.error.size());
    return std::abs(got - expected) < 0.01 * expected + noise ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: truth FILE.glb\n"), 1;
    try {
        return check(argv[1]);
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "truth: %s\n", error.what()), 1;
    }
}
