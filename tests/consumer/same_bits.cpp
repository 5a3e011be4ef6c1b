// What samples/raw_kernels.c draws with kernels alone, drawn by the library's passes: run.cmake
// compares the two pictures byte by byte. Here kernels work on packets, with 64-bit atomics where
// the device has them, and triangles lie in the library's own order.
// SPDX-License-Identifier: MIT
#include <clgi/clgi.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t width = 160, height = 120, pixels = width * height, stride = pixels;

void add_box(clgi::Scene& scene, const glm::dvec3& low, const glm::dvec3& high, int facing) {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int side = face % 2, out = (side ? 1 : -1) * facing;
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (int k = 0; k < 4; ++k) {
            const int corner = out > 0 ? k : 3 - k;
            glm::dvec3 at(0.0);
            glm::vec3 normal(0.0f);
            at[axis] = side ? high[axis] : low[axis];
            at[u] = corner == 1 || corner == 2 ? high[u] : low[u];
            at[v] = corner >= 2 ? high[v] : low[v];
            normal[axis] = static_cast<float>(out);
            scene.positions.push_back(at);
            scene.normals.push_back(normal);
        }
        scene.triangles.push_back({{first, first + 1, first + 2}, 0});
        scene.triangles.push_back({{first, first + 2, first + 3}, 0});
    }
}

clgi::Scene room_with_a_block() {
    clgi::Scene scene;
    scene.materials.emplace_back();
    add_box(scene, glm::dvec3(-0.5), glm::dvec3(0.5), -1);
    add_box(scene, {-0.25, -0.5, -0.25}, {0.125, -0.0625, 0.0}, 1);
    return scene;
}

clgi::View view_into_the_room() {
    clgi::View view{};
    view.eye = {0, 0.125f, 0.46875f, 0};
    view.right = {1, 0, 0, 1};
    view.up = {0, 1, 0, 0.75f};
    view.forward = {0, 0, -1, 0.0009765625f};
    view.width = width;
    view.height = height;
    view.flags = clgi::VIEW_CULL_BACK_FACES;
    return view;
}

std::vector<clgi::Vpl> lights_on_the_floor() {
    std::vector<clgi::Vpl> lights(64);
    for (int l = 0; l < 64; ++l) {
        const float x = (static_cast<float>(l % 8) - 3.5f) / 8.0f;
        const float z = (static_cast<float>(l / 8) - 3.5f) / 8.0f;
        const float red = static_cast<float>(1 + l % 8) / 256.0f;
        lights[l] = {
            {x, -0.5f, z, 1.0f / 256}, {0, 1, 0, 1.0f / 65536}, {red, 4.0f / 256, 4.0f / 256, 1}};
    }
    return lights;
}

std::vector<float> irradiance(const cl::Device& device) {
    const cl::Context context(device);
    const cl::CommandQueue queue(context, device);
    const auto buffer = [&](std::size_t bytes) {
        return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    };
    const clgi::DeviceScene scene(context, device, room_with_a_block());
    const clgi::View view = view_into_the_room();
    const cl::Buffer visibility = buffer(pixels * sizeof(std::uint64_t));
    std::vector<clgi::View> view_list{view};
    const cl::Buffer views(context, view_list.begin(), view_list.end(), true);
    const cl::Buffer planes = buffer(sizeof(float) * clgi::GBUFFER_PLANES * stride);
    const cl::Buffer ids = buffer(sizeof(int) * clgi::GBUFFER_ID_PLANES * stride);
    const cl::Buffer result = buffer(sizeof(float) * clgi::IRRADIANCE_PLANES * stride);
    std::vector<clgi::Vpl> lights = lights_on_the_floor();
    const cl::Buffer light_buffer(context, lights.begin(), lights.end(), true);
    std::vector<cl_uint> count{pixels};
    const cl::Buffer point_count(context, count.begin(), count.end(), true);

    const clgi::GBufferPasses gbuffer(context, device);
    const clgi::ImagePasses image(context, device);
    gbuffer.raster_views(queue, clgi::span_of(view_list, 0, 1), views, scene, visibility,
                         clgi::Pixels::visibility);
    gbuffer.resolve(queue, view, scene, {stride, 0, 0, 0}, visibility, planes, ids);
    image.gather(queue, {stride, 64, 0, 0}, pixels, point_count, planes, light_buffer, light_buffer,
                 result);
    std::vector<float> values(clgi::IRRADIANCE_PLANES * stride);
    queue.enqueueReadBuffer(result, CL_TRUE, 0, values.size() * sizeof(float), values.data());
    return values;
}

// The place of a device among all, which is how raw_kernels is told.
std::size_t index_of(const cl::Device& device) {
    const std::vector<cl::Device> all = clgi::all_devices();
    std::size_t index = 0;
    while (index < all.size() && all[index]() != device()) ++index;
    return index;
}

int write_pfm(const char* path, const std::vector<float>& planes) {
    std::FILE* file = std::fopen(path, "wb");
    if (!file) return std::fprintf(stderr, "same_bits: %s cannot be written\n", path), 1;
    std::fprintf(file, "PF\n%u %u\n-1.0\n", width, height);
    for (std::size_t y = height; y-- > 0;)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < clgi::IRRADIANCE_PLANES; ++c)
                std::fwrite(&planes[c * stride + y * width + x], sizeof(float), 1, file);
    return std::fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: same_bits PICTURE.pfm\n"), 1;
    try {
        const cl::Device device = clgi::choose_device();
        const std::vector<float> planes = irradiance(device);
        double sum = 0.0;
        for (const float value : planes) sum += value;
        std::printf("mean irradiance %g on device %zu\n", sum / static_cast<double>(planes.size()),
                    index_of(device));
        return sum > 0.0 ? write_pfm(argv[1], planes) : 1;  // black would equal black
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "same_bits: %s\n", error.what()), 1;
    }
}
