// Texture lookups against a lookup in double precision: every pair of wrap modes, all mip levels
// and the blends between them per channel, and the finest level for the alpha of masks.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "kernel_text.hpp"
#include "scenes.hpp"
#include "texture_reference.hpp"

namespace clgi {
namespace {

struct Size {
    int width, height;
};

// One texture for every size and pair of wrap modes, random in all four channels.
Scene textured_scene(const std::vector<Size>& sizes, bool nearest) {
    test::Random random(nearest ? 41 : 42);
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    for (const Size& size : sizes)
        for (int pair = 0; pair < 9; ++pair) {
            Texture texture;
            texture.width = size.width;
            texture.height = size.height;
            texture.wrap_s = static_cast<Wrap>(pair % 3);
            texture.wrap_t = static_cast<Wrap>(pair / 3);
            texture.nearest = nearest;
            for (int i = 0; i < 4 * size.width * size.height; ++i)
                texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
            scene.textures.push_back(texture);
        }
    return scene;
}

struct Lookups {
    std::vector<glm::vec4> colors;
    std::vector<float> alphas;  // of the finest level
};

// places: u, v, area of UV space, texture.
Lookups lookups(const DeviceScene& scene, const std::vector<glm::vec4>& places) {
    const test::Device& on = test::device();
    cl::Program program(on.context, test::kernel_text("tests/support/texture.cl"));
    program.build(on.device, "-cl-std=CL1.2");
    cl::Kernel kernel(program, "sample_textures");
    const cl::Buffer asked = test::upload(places);
    const cl::Buffer colors = test::empty<glm::vec4>(places.size());
    for (int i = 0; i < 3; ++i) kernel.setArg(i, *scene.kernel_arguments()[6 + i]);
    kernel.setArg(3, asked);
    kernel.setArg(4, colors);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(places.size()));
    cl::Kernel alone(program, "sample_alphas");
    const cl::Buffer alphas = test::empty<float>(places.size());
    for (int i = 0; i < 2; ++i) alone.setArg(i, *scene.kernel_arguments()[6 + i]);
    alone.setArg(2, asked);
    alone.setArg(3, alphas);
    on.queue.enqueueNDRangeKernel(alone, cl::NullRange, cl::NDRange(places.size()));
    return {test::download<glm::vec4>(colors, places.size()),
            test::download<float>(alphas, places.size())};
}

std::string filter_name(const testing::TestParamInfo<bool>& info) {
    return info.param ? "nearest" : "linear";
}

class TextureLookup : public testing::TestWithParam<bool> {};

TEST_P(TextureLookup, IsTrilinearAndOfTheFinestLevelForMasksInEveryWrapMode) {
    constexpr double u = 0x1p-24;
    const std::vector<Size> sizes = {{1, 1}, {2, 3}, {5, 4}, {16, 8}, {7, 31}, {64, 1}};
    const Scene scene = textured_scene(sizes, GetParam());
    const DeviceScene placed = test::on_device(scene);
    const test::Textures textures = test::read_textures(placed);
    test::Random random(43);
    std::vector<glm::vec4> places(1 << 15);
    for (glm::vec4& at : places) {
        const int texture = random.integer(0, static_cast<int>(scene.textures.size()) - 1);
        // From magnified to a pixel that covers the texture several times.
        at = {random(-2.5, 3.5), random(-2.5, 3.5), std::exp2(random(-14, 4)), texture};
    }
    const Lookups found = lookups(placed, places);
    std::size_t checked = 0, wrong = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::vec4& at = places[i];
        const auto& record = textures.records[static_cast<std::size_t>(at.w)];
        // A coordinate is rounded three times at up to 3.5 times the size, its parts once more; a
        // level is at most 16 and a logarithm right to 3 units, as OpenCL has it.
        const double sides = record.width + record.height;
        const double slack = 4 * u * 3.5 * sides, level = 16 * 4 * u;
        const auto wanted =
            test::sampled_texture(textures, static_cast<int>(at.w), {at.x, at.y}, at.z, slack);
        if (wanted.near_border) continue;
        ++checked;
        for (int c = 0; c < 4; ++c)
            wrong += !(std::abs(found.colors[i][c] - wanted.color[c]) <= slack + level + 8 * u);
        const auto finest =
            test::sampled_texture(textures, static_cast<int>(at.w), {at.x, at.y}, 0.0, slack);
        if (!finest.near_border)
            wrong += !(std::abs(found.alphas[i] - finest.color.w) <= slack + 8 * u);
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(checked, places.size() * 99 / 100);
}

INSTANTIATE_TEST_SUITE_P(Filter, TextureLookup, testing::Bool(), filter_name);

}  // namespace
}  // namespace clgi
