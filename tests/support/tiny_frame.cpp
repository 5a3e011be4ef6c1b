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
    scene.materials[0].specular = 1.0f;
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
    options.emitters = {.vpls = 8, .shadow_size = 16, .face_size = 8, .area_samples = 1};
    options.negative_vpls = 4;
    options.build = {
        .packet_width = 4, .local_size = 16, .atomics64 = atomics64, .parallel = false};
    const test::Frame frame =
        test::render(stamp(), test::camera_at({0, 0.1, 0.9}, {0, -0.2, -1}, 1.2f), options);
    double sum = 0.0;
    for (const glm::vec3& radiance : frame.radiance) sum += double{radiance.x};
    std::printf("%zu passes, mean radiance %g\n", frame.launches,
                sum / static_cast<double>(frame.pixels));
}

// Texels to planes, from buffers and images that hold not a byte more than is needed.
void import_texels() {
    const test::Device& on = test::device();
    const ImportPasses passes(on.context, on.device,
                              {.packet_width = 4, .local_size = 16, .parallel = false});
    const DeviceScene placed = test::on_device(stamp());
    constexpr std::size_t width = 7, height = 3, pixels = width * height, stride = 32;
    const View view =
        make_view(test::camera_at({0, 0.1, 0.9}, {0, 0, 0}), placed.frame(), width, height);
    const std::vector<float> ones(4 * pixels, 1.0f);
    const std::vector<cl_ushort> halves(4 * pixels, 0x3c00);
    const std::vector<cl_uchar> bytes(4 * pixels, 99);
    const std::vector<cl_int> labels(4 * pixels, 1);
    const ImportBuffers buffers = {test::upload(ones),
                                   test::upload(halves),
                                   test::upload(halves),
                                   test::upload(bytes),
                                   test::upload(halves),
                                   test::upload(std::vector<float>(pixels, 1.0f)),
                                   test::upload(std::vector<cl_int>(2 * pixels, 1))};
    const auto image = [&](cl_channel_type type, const void* texels) {
        return cl::Image2D(on.context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                           cl::ImageFormat(CL_RGBA, type), width, height, 0,
                           const_cast<void*>(texels));
    };
    const cl::Image2D whites = image(CL_FLOAT, ones.data());
    const ImportImages images = {
        whites, whites, whites, whites, whites, whites, image(CL_SIGNED_INT32, labels.data())};
    ImportParams params = import_params(placed, stride);
    params.flags = IMPORT_POSITION | IMPORT_GEOMETRIC | IMPORT_EMISSION | IMPORT_DEPTH |
                   IMPORT_MATERIAL | IMPORT_TRIANGLE;
    params.normal_format = params.geometric_format = params.emission_format = TEXEL_RGBA16F;
    params.albedo_format = TEXEL_RGBA8;
    const GBuffer out{test::empty<float>(GBUFFER_PLANES * stride),
                      test::empty<cl_int>(GBUFFER_ID_PLANES * stride), stride};
    const cl::Buffer count = test::upload(std::vector<cl_uint>{0});
    passes.buffers(on.queue, view, params, buffers, out, count);
    passes.images(on.queue, view, params, images, out, count);
    std::printf("imported, first position %g\n", double{test::download<float>(out.planes, 1)[0]});
}

}  // namespace

int main() {
    try {
        draw(true);
        draw(false);
        import_texels();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    // The tests' shared context would be released at exit, where oclgrind 21.10 corrupts its heap.
    std::fflush(stdout);
    std::_Exit(0);
}
