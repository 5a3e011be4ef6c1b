// Texels of another renderer become planes as in double precision: tilted views of every kind, a
// scene away from the origin, and textures in which no channel is like another.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/import.hpp>
#include <cmath>

#include "patchwork.hpp"

namespace clgi {
namespace {

using test::Looking;

constexpr int width = 37, height = 23, pixels = width * height, materials = 4, triangles = 12;

// A box 3 m wide about (5, -2, 7).
const DeviceScene& hall() {
    static const DeviceScene placed = [] {
        Scene scene = test::plain_scene();
        for (int m = 1; m < materials; ++m) test::add_material(scene, Material());
        test::add_box(scene, {3.5, -3, 6}, {6.5, -1, 8}, -1);
        scene.materials[0].emission = glm::vec3(100.0f);
        return test::on_device(scene);
    }();
    return placed;
}

View view_of(Looking how) {
    Camera camera = test::camera_at({4.4, -1.6, 7.7}, {5.3, -2.2, 6.5}, 0.9f);
    if (how == Looking::orthographic || how == Looking::orthographic_aside) {
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = 0.8f;
    }
    View view = make_view(camera, hall().frame(), width, height);
    if (how == Looking::aside || how == Looking::orthographic_aside) {
        view.window.x = 0.3f * view.right.w;
        view.window.y = -0.2f * view.up.w;
    }
    return view;
}

// Row 0 at the bottom.
struct Texels {
    std::vector<glm::vec4> position, normal, geometric, albedo, emission;
    std::vector<float> depth;
    std::vector<glm::ivec2> labels;
};

Texels random_texels() {
    test::Random random(91);
    const auto vector = [&](double low, double high) {
        return glm::vec4(test::random_vec3(random, low, high), random(low, high));
    };
    Texels out;
    for (int i = 0; i < pixels; ++i) {
        out.position.push_back(glm::vec4(5, -2, 7, 0) + vector(-1, 1));
        out.normal.push_back(i % 11 == 3 ? glm::vec4(0.0f) : vector(-3, 3));
        out.geometric.push_back(i % 7 == 5 ? glm::vec4(0.0f) : vector(-2, 2));
        out.albedo.push_back(vector(-0.3, 1.4));
        out.emission.push_back(vector(-50, 500));
        out.depth.push_back(static_cast<float>(random(-0.3, 2.0)));
        out.labels.emplace_back(random.integer(-2, materials + 1),
                                random.integer(-2, triangles + 1));
    }
    return out;
}

struct Wanted {
    bool seen = true, close = false;  // close: rounding may decide which side is seen
    glm::dvec3 position, normal, geometric, albedo;
    glm::dvec3 emission = glm::dvec3(0.0);
    double depth = 0.0;
    int material = -1, triangle = -1;
};

Wanted wanted(const Texels& texels, const View& view, std::uint32_t flags, int column, int row) {
    const int i = (flags & IMPORT_TOP_FIRST ? row : height - 1 - row) * width + column;
    const SceneFrame& frame = hall().frame();
    const glm::dvec3 eye(view.eye), forward(view.forward);
    const bool parallel = view.eye.w != 0.0f;
    Wanted out;
    out.depth = texels.depth[i] * frame.scale;
    if (flags & IMPORT_POSITION) {
        out.position = (glm::dvec3(texels.position[i]) - frame.origin) * frame.scale;
    } else {
        const double x = (column + 0.5) * 2 / width - 1, y = 1 - (row + 0.5) * 2 / height;
        const glm::dvec3 aside =
            glm::dvec3(view.right) * (x * double{view.right.w} + double{view.window.x}) +
            glm::dvec3(view.up) * (y * double{view.up.w} + double{view.window.y});
        out.position = eye + forward * out.depth + aside * (parallel ? 1.0 : out.depth);
        out.seen = out.depth > 0.0;
    }
    if (!(flags & IMPORT_DEPTH)) out.depth = glm::dot(out.position - eye, forward);
    const glm::dvec3 along = parallel ? forward : glm::normalize(out.position - eye);
    const glm::dvec3 normal(texels.normal[i]), geometric(texels.geometric[i]);
    out.seen = out.seen && glm::length(normal) > 0.0;
    if (!out.seen) return out;
    out.normal = out.geometric = glm::normalize(normal);
    if ((flags & IMPORT_GEOMETRIC) && glm::length(geometric) > 0.0)
        out.geometric = glm::normalize(geometric);
    if (glm::dot(out.geometric, along) > 0.0) out.geometric = -out.geometric;
    out.close = std::abs(glm::dot(out.geometric, along)) < 1e-5 ||
                std::abs(glm::dot(out.normal, along)) < 1e-5;
    if (glm::dot(out.normal, along) >= 0.0) out.normal = out.geometric;
    out.albedo = glm::clamp(glm::dvec3(texels.albedo[i]), 0.0, 1.0);
    if (flags & IMPORT_EMISSION)
        out.emission = glm::max(glm::dvec3(texels.emission[i]), 0.0) / frame.exposure;
    const glm::ivec2 label = texels.labels[i];
    if ((flags & IMPORT_MATERIAL) && label.x >= 0 && label.x < materials) out.material = label.x;
    if ((flags & IMPORT_TRIANGLE) && label.y >= 0 && label.y < triangles) out.triangle = label.y;
    return out;
}

cl::Image2D image(cl_channel_type type, const void* texels) {
    return cl::Image2D(test::device().context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
                       cl::ImageFormat(CL_RGBA, type), width, height, 0, const_cast<void*>(texels));
}

ImportImages images_of(const Texels& t) {
    std::vector<glm::vec4> depth;
    std::vector<glm::ivec4> labels;
    for (const float d : t.depth) depth.emplace_back(d, 0.7f * d, 7.0f, 7.0f);
    for (const glm::ivec2& label : t.labels) labels.emplace_back(label, 7, 7);
    return {image(CL_FLOAT, t.position.data()),   image(CL_FLOAT, t.normal.data()),
            image(CL_FLOAT, t.geometric.data()),  image(CL_FLOAT, t.albedo.data()),
            image(CL_FLOAT, t.emission.data()),   image(CL_FLOAT, depth.data()),
            image(CL_SIGNED_INT32, labels.data())};
}

// Labels stand alone where there are no triangles among them.
ImportBuffers buffers_of(const Texels& t, std::uint32_t flags) {
    std::vector<cl_int> labels;
    for (const glm::ivec2& label : t.labels) {
        labels.push_back(label.x);
        if (flags & IMPORT_TRIANGLE) labels.push_back(label.y);
    }
    return {test::upload(t.position), test::upload(t.normal),   test::upload(t.geometric),
            test::upload(t.albedo),   test::upload(t.emission), test::upload(t.depth),
            test::upload(labels)};
}

test::Drawing imported(const Texels& texels, const View& view, std::uint32_t flags,
                       bool from_images, ImportParams params, const ImportBuffers& buffers) {
    static const ImportPasses passes(test::programs());
    test::Drawing out;
    out.stride = params.stride;
    const GBuffer target{test::empty<float>(GBUFFER_PLANES * out.stride),
                         test::empty<cl_int>(GBUFFER_ID_PLANES * out.stride), out.stride};
    const cl::Buffer count = test::upload(std::vector<cl_uint>{0});
    params.flags = flags;
    const cl::CommandQueue& queue = test::device().queue;
    if (from_images)
        passes.images(queue, view, params, images_of(texels), target, count);
    else
        passes.buffers(queue, view, params, buffers, target, count);
    out.planes = test::read_planes(target);
    out.ids = test::download<std::int32_t>(target.ids, GBUFFER_ID_PLANES * out.stride);
    EXPECT_EQ(test::download<cl_uint>(count, 1)[0], 0u);
    return out;
}

class ImportReference : public testing::TestWithParam<Looking> {};

TEST_P(ImportReference, HoldsForEveryChannelAndEverySetOfTextures) {
    const Texels texels = random_texels();
    const View view = view_of(GetParam());
    std::size_t seen = 0, close = 0;
    double worst = 0.0;
    const auto most = [&](const glm::dvec3& found, const glm::dvec3& wanted) {
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(found[c] - wanted[c]));
    };
    constexpr std::uint32_t labelled = IMPORT_MATERIAL | IMPORT_TRIANGLE;
    const std::uint32_t sets[] = {
        IMPORT_POSITION, IMPORT_DEPTH,
        IMPORT_DEPTH | IMPORT_GEOMETRIC | IMPORT_TOP_FIRST | IMPORT_MATERIAL,
        IMPORT_POSITION | IMPORT_GEOMETRIC | IMPORT_EMISSION | labelled,
        IMPORT_POSITION | IMPORT_DEPTH | IMPORT_EMISSION | IMPORT_TOP_FIRST | labelled};
    for (const std::uint32_t flags : sets)
        for (const bool from_images : {false, true}) {
            const auto found =
                imported(texels, view, flags, from_images,
                         import_params(hall(), test::padded(pixels)), buffers_of(texels, flags));
            for (int p = 0; p < pixels; ++p) {
                const Wanted want = wanted(texels, view, flags, p % width, p / width);
                if (want.close && ++close) continue;
                ASSERT_EQ(found.at(GBUFFER_NORMAL, p) != glm::vec3(0.0f), want.seen) << p;
                ASSERT_EQ(found.ids[p], want.material) << p;
                ASSERT_EQ(found.ids[found.stride + p], want.triangle) << p;
                if (!want.seen) continue;
                ++seen;
                most(found.at(GBUFFER_POSITION, p), want.position);
                most(found.at(GBUFFER_NORMAL, p), want.normal);
                most(found.at(GBUFFER_GEOMETRIC, p), want.geometric);
                most(found.at(GBUFFER_BASE, p), want.albedo);
                // Up to some units of light.
                most(0.1f * found.at(GBUFFER_EMISSION, p), 0.1 * want.emission);
                most(glm::vec3(found.depth(p)), glm::dvec3(want.depth));
            }
        }
    EXPECT_GT(seen, 5000u);
    EXPECT_LT(close, 5u);
    // A position of 10 m is moved by as many: an ulp of that, and some roundings of numbers to 2.
    EXPECT_LT(worst, 3e-6);
}

INSTANTIATE_TEST_SUITE_P(Views, ImportReference,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

// Every texture of the formats that it may have, each another one than its neighbours.
TEST(ImportFormats, AreThoseOfEachTexture) {
    Texels texels = random_texels();
    const View view = view_of(Looking::perspective);
    const std::uint32_t flags = IMPORT_POSITION | IMPORT_GEOMETRIC | IMPORT_EMISSION;
    for (glm::vec4& color : texels.albedo) color = glm::abs(color) / 2.0f;
    const auto packed = [&](std::vector<glm::vec4>& values, std::uint32_t format) {
        std::vector<std::uint8_t> bytes;
        for (glm::vec4& value : values)
            for (int c = 0; c < 4; ++c) {
                if (format == TEXEL_RGBA8) {
                    bytes.push_back(static_cast<std::uint8_t>(value[c] * 255.0f + 0.5f));
                    value[c] = static_cast<float>(bytes.back()) / 255.0f;
                    continue;
                }
                const std::uint16_t half = glm::packHalf1x16(value[c]);
                if (format == TEXEL_RGBA16F) value[c] = glm::unpackHalf1x16(half);
                const std::size_t size = format == TEXEL_RGBA16F ? 2 : 4;
                bytes.resize(bytes.size() + size);
                std::memcpy(&bytes[bytes.size() - size],
                            size == 2 ? static_cast<const void*>(&half) : &value[c], size);
            }
        return test::upload(bytes);
    };
    for (const int turn : {0, 1, 2}) {
        const auto format = [&](int k) { return static_cast<std::uint32_t>((turn + k) % 3); };
        // Bytes hold colours alone.
        const auto vectors = [&](int k) {
            return format(k) == TEXEL_RGBA8 ? std::uint32_t{TEXEL_RGBA16F} : format(k);
        };
        ImportParams params = import_params(hall(), test::padded(pixels));
        params.normal_format = vectors(0);
        params.geometric_format = vectors(1);
        params.albedo_format = format(2);
        params.emission_format = vectors(3);
        Texels read = texels;
        ImportBuffers buffers = buffers_of(read, flags);
        buffers.normal = packed(read.normal, params.normal_format);
        buffers.geometric = packed(read.geometric, params.geometric_format);
        buffers.albedo = packed(read.albedo, params.albedo_format);
        buffers.emission = packed(read.emission, params.emission_format);
        const auto found = imported(read, view, flags, false, params, buffers);
        double worst = 0.0;
        for (int p = 0; p < pixels; ++p) {
            const Wanted want = wanted(read, view, flags, p % width, p / width);
            if (!want.seen || want.close) continue;
            for (int c = 0; c < 3; ++c)
                for (const auto& [plane, value, share] :
                     {std::tuple(GBUFFER_NORMAL, want.normal[c], 1.0),
                      {GBUFFER_GEOMETRIC, want.geometric[c], 1.0},
                      {GBUFFER_BASE, want.albedo[c], 1.0},
                      {GBUFFER_EMISSION, want.emission[c], 0.1}})
                    worst = std::max(worst, share * std::abs(found.at(plane, p)[c] - value));
        }
        EXPECT_LT(worst, 3e-6) << turn;
    }
}

}  // namespace
}  // namespace clgi
