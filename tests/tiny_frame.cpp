// One frame of every kernel at the size of a stamp, for tools that interpret kernels.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "frames.hpp"
#include "scenes.hpp"

namespace {

using namespace clgi;

// 36 triangles: a textured floor in a room with a block, a spot, a sun and a small glowing face.
Scene stamp() {
    Scene scene = test::plain_scene();
    scene.materials[0].roughness = 0.5f;
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    test::add_box(scene, {-0.4, -0.4, -0.4}, {0.4, -0.2, 0.3}, 1);
    Material masked;
    masked.alpha_mode = AlphaMode::mask;
    masked.base_texture.texture = 0;
    test::add_quad(
        scene, {glm::dvec3(-0.8, 0, -0.6), {-0.2, 0, -0.6}, {-0.2, 0.6, -0.6}, {-0.8, 0.6, -0.6}},
        test::add_material(scene, masked));
    Material glowing;
    glowing.emission = glm::vec3(1.0f);
    test::add_quad(
        scene,
        {glm::dvec3(-0.2, 0.99, -0.2), {0.2, 0.99, -0.2}, {0.2, 0.99, 0.2}, {-0.2, 0.99, 0.2}},
        test::add_material(scene, glowing));
    for (int k = 0; k < 8; ++k)  // and dust
        test::add_triangle(scene, {0.1 * k, 0.3, 0.1}, {0.1 * k + 0.05, 0.3, 0.1},
                           {0.1 * k, 0.35, 0.1});
    scene.uvs.assign(scene.positions.size(), glm::vec4(0, 0, 0.7f, 0.3f));
    for (std::size_t i = 0; i < scene.uvs.size(); ++i) scene.uvs[i].x = static_cast<float>(i % 2);
    scene.colors.assign(scene.positions.size(), glm::vec4(0.9f, 0.8f, 0.7f, 1.0f));
    Texture texture;
    texture.width = texture.height = 2;
    texture.rgba = {255, 255, 255, 255, 200, 100, 50, 0, 10, 20, 30, 255, 0, 0, 0, 128};
    scene.textures.push_back(texture);
    scene.lights = {test::spot_light({0.3, 0.9, 0.3}, {-0.3f, -1, -0.3f}, 0.6),
                    test::directional_light({0.1f, -1, 0})};
    return scene;
}

void draw(bool atomics64) {
    SecondOrderOptions options;
    options.width = 24;
    options.height = 16;
    options.sources = {.lights = 8, .shadow_size = 16, .face_size = 8, .area_samples = 1};
    options.negative_lights = 4;
    options.build = {.packet_width = 4, .local_size = 16, .atomics64 = atomics64, .parallel = false};
    const test::Frame frame =
        test::render(stamp(), test::camera_at({0, 0.1, 0.9}, {0, -0.2, -1}, 1.2f), options);
    double sum = 0.0;
    for (const glm::vec3& radiance : frame.radiance) sum += double{radiance.x};
    std::printf("%zu passes, mean radiance %g\n", frame.launches,
                sum / static_cast<double>(frame.pixels));
}

}  // namespace

int main() {
    try {
        draw(true);
        draw(false);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    // The tests' shared context would be released at exit, where oclgrind 21.10 corrupts its heap.
    std::fflush(stdout);
    std::_Exit(0);
}
