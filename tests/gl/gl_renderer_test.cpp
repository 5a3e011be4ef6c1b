// What OpenGL draws of a scene is what the OpenCL rasteriser draws of it, in every kind of view.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/io/gltf.hpp>
#include <cmath>
#include <filesystem>

#include "gl_drawing.hpp"
#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using GlRenderer = test::Gl;
using test::Drawing;

int triangle_at(const Drawing& drawing, std::size_t pixel) {
    return drawing.ids[GBUFFER_TRIANGLE * drawing.stride + pixel];
}

// A position is a ray met with a plane: roundings of numbers as large as the scene, the eye's
// distance and the depth, drawn out along the ray by a slant. Two of each such number, and twice:
// once for each API.
double position_bound(const Drawing& drawing, const SceneFrame& frame, std::size_t pixel) {
    const View& view = drawing.view;
    const glm::dvec3 eye(view.eye), forward(view.forward);
    const glm::dvec3 to = glm::dvec3(drawing.at(GBUFFER_POSITION, pixel)) - eye;
    const glm::dvec3 ray = view.eye.w == 0.0f ? glm::normalize(to) : forward;
    const double cosine = -glm::dot(ray, glm::dvec3(drawing.at(GBUFFER_GEOMETRIC, pixel)));
    const double reach = frame.radius + glm::length(eye) + drawing.depth(pixel);
    return 4.0 * 0x1p-24 * reach / std::max(cosine, 1e-3);
}

// A twentieth of the step of an 8-bit channel.
constexpr double close = 1.0 / 255.0 / 20.0;

void expect_alike(const DeviceScene& scene, const Drawing& cl, const Drawing& gl) {
    const std::size_t pixels = std::size_t{cl.view.width} * cl.view.height;
    std::size_t other = 0, apart = 0;
    double farthest = 0.0, normal = 0.0, albedo = 0.0;
    for (std::size_t p = 0; p < pixels; ++p) {
        if (triangle_at(cl, p) != triangle_at(gl, p)) {
            ++other;
            continue;
        }
        EXPECT_EQ(cl.ids[p], gl.ids[p]) << "material of pixel " << p;
        if (triangle_at(cl, p) < 0) {
            for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
                ASSERT_EQ(gl.planes[plane * gl.stride + p], 0.0f) << p;
            continue;
        }
        const auto distance = [&](int plane) {
            return double{glm::length(cl.at(plane, p) - gl.at(plane, p))};
        };
        const double bound = position_bound(cl, scene.frame(), p);
        farthest = std::max(farthest, distance(GBUFFER_POSITION) / bound);
        EXPECT_LE(std::abs(cl.depth(p) - gl.depth(p)), bound) << p;
        normal = std::max({normal, distance(GBUFFER_NORMAL), distance(GBUFFER_GEOMETRIC)});
        albedo = std::max(albedo, distance(GBUFFER_BASE));
        const double glow = glm::length(cl.at(GBUFFER_EMISSION, p));
        apart += distance(GBUFFER_BASE) > close ||
                 distance(GBUFFER_EMISSION) > close * std::max(glow, 1.0);
    }
    // All pixels count, those on silhouettes too: corners are rounded alike, so only pixels whose
    // centre lies on an edge, or that two surfaces at one depth share, may differ.
    EXPECT_LE(static_cast<double>(other), 0.005 * static_cast<double>(pixels));
    EXPECT_LE(farthest, 1.0) << "of what rounding explains";
    EXPECT_LE(normal, close);
    // A texture read without interpolation may jump to the next texel.
    EXPECT_LE(static_cast<double>(apart), 0.001 * static_cast<double>(pixels));
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    std::printf(
        "%s: %ux%u%s, ids alike %.3f %%, position %.2g of its bound, normal %.1e, albedo "
        "%.1e\n",
        test->name(), cl.view.width, cl.view.height, cl.view.eye.w == 0.0f ? "" : " orthographic",
        100.0 - 100.0 * static_cast<double>(other) / static_cast<double>(pixels), farthest, normal,
        albedo);
}

void expect_alike(const Scene& scene, const std::vector<View>& more = {}) {
    const DeviceScene placed = test::on_device(scene);
    gl::SceneRenderer renderer(test::device().queue, placed);
    std::vector<View> views = more;
    for (const Camera& camera : scene.cameras)
        views.push_back(make_view(camera, placed.frame(), 321, 241));
    EmitterOptions options;
    options.area_samples = 1;
    for (View view : make_emitters(placed, options).views) {
        view.first_pixel = 0;
        views.push_back(view);
    }
    for (const View& view : views)
        expect_alike(placed, test::draw(placed, view), test::draw_with_gl(placed, renderer, view));
}

TEST_F(GlRenderer, DrawsABoxForCameraAndSpotlight) { expect_alike(box()); }

TEST_F(GlRenderer, DrawsTheSixFacesOfACube) {
    BoxOptions options;
    options.light = LightSource::point;
    expect_alike(box(options));
}

TEST_F(GlRenderer, DrawsACornellBoxAndTheFacesOfAHemicube) { expect_alike(cornell()); }

TEST_F(GlRenderer, DrawsForADirectionalLight) {
    Scene scene = bumpy_mesh();
    scene.lights = {test::directional_light({0.3f, -1.0f, -0.2f})};
    scene.cameras = {test::camera_at({0.5, 1.0, 2.5}, {0, 0, 0})};
    Camera flat = scene.cameras[0];
    flat.kind = Camera::Kind::orthographic;
    flat.half_height = 1.5f;
    scene.cameras.push_back(flat);
    expect_alike(scene);
}

// Squares that between them use everything a surface can be.
Scene patchwork() {
    Scene scene = test::plain_scene();
    test::Random random(5);
    for (int t = 0; t < 4; ++t) {
        Texture texture;
        texture.width = 37 + 8 * t;
        texture.height = 64 - 9 * t;
        for (int i = 0; i < texture.width * texture.height * 4; ++i)
            texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
        texture.wrap_s = static_cast<Wrap>(t % 3);
        texture.wrap_t = static_cast<Wrap>((t + 1) % 3);
        texture.nearest = t == 2;
        texture.srgb = t != 3;
        scene.textures.push_back(texture);
    }
    for (int k = 0; k < 12; ++k) {
        Material material;
        material.base_color = {random(0.3, 1.0), random(0.3, 1.0), random(0.3, 1.0), 1.0};
        material.metallic = k % 4 == 1 ? 0.6f : 0.0f;
        material.roughness = k % 4 == 1 ? 0.4f : 1.0f;
        material.base_texture.texture = k % 4;
        material.base_texture.uv_set = k % 2;
        const float turn = 0.3f * static_cast<float>(k);
        material.base_texture.transform =
            glm::mat3(2.0f * std::cos(turn), std::sin(turn), 0.0f, -std::sin(turn),
                      1.5f * std::cos(turn), 0.0f, 0.2f * static_cast<float>(k), -0.7f, 1.0f);
        if (k % 3 == 0) material.alpha_mode = k % 2 ? AlphaMode::blend : AlphaMode::mask;
        material.alpha_cutoff = 0.45f;
        material.double_sided = k % 5 == 0;
        if (k % 4 == 2) {
            material.emission = glm::vec3(3.0f, 2.0f, 1.0f);
            material.emission_texture.texture = 1;
            material.emission_texture.uv_set = 1;
        }
        const std::uint32_t index = test::add_material(scene, material);
        const double x = -1.8 + 1.2 * (k % 4), y = -1.2 + 1.2 * (k / 4), z = random(-0.5, 0.5);
        std::array<glm::dvec3, 4> corners = {glm::dvec3(x - 0.7, y - 0.7, z),
                                             {x + 0.7, y - 0.7, z + 0.4},
                                             {x + 0.7, y + 0.7, z},
                                             {x - 0.7, y + 0.7, z - 0.3}};
        if (k % 5 < 2) std::swap(corners[1], corners[3]);  // seen from behind
        test::add_quad(scene, corners, index);
    }
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        const auto corner = static_cast<int>(v % 4);
        scene.uvs.emplace_back(corner == 1 || corner == 2, corner < 2, random(-2, 2),
                               random(-2, 2));
        scene.colors.emplace_back(random(0.5, 1.0), random(0.5, 1.0), random(0.5, 1.0), 1.0);
        scene.normals[v] =
            glm::normalize(scene.normals[v] + glm::vec3(random(-0.2, 0.2), random(-0.2, 0.2), 0));
    }
    scene.cameras = {test::camera_at({0.2, 0.4, 4.0}, {0, 0, 0}),
                     test::camera_at({0.5, 0.1, -4.0}, {0, 0, 0})};
    scene.lights = {test::point_light({0.1, 0.2, 1.5}, 5.0f)};
    return scene;
}

TEST_F(GlRenderer, KnowsTexturesMasksColoursAndSides) { expect_alike(patchwork()); }

TEST_F(GlRenderer, DrawsOffCentreWindows) {
    const Scene scene = box();
    const DeviceScene placed = test::on_device(scene);
    View view = make_view(scene.cameras[0], placed.frame(), 200, 100);
    view.right.w *= 0.4f;
    view.up.w *= 0.7f;
    view.window.x = 0.21f;
    view.window.y = -0.13f;
    view.flags = 0;
    expect_alike(scene, {view});
}

TEST_F(GlRenderer, LosesNothingFarFromTheOrigin) {
    Scene scene = cornell();
    const glm::dvec3 away(148376.0, 1235.0, -223423.0);
    for (glm::dvec3& position : scene.positions) position += away;
    for (Light& light : scene.lights) light.position += away;
    for (Camera& camera : scene.cameras) camera.position += away;
    expect_alike(scene);
}

void expect_alike_in_file(const std::string& name) {
    const std::string path = std::string(CLGI_SCENES_DIR) + "/" + name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    Scene scene = io::load_gltf(path);
    if (scene.cameras.empty()) scene.cameras.push_back(default_camera(scene));
    if (scene.lights.empty()) scene.lights.push_back(default_light(scene));
    scene.lights.resize(1);
    expect_alike(scene);
}

TEST_F(GlRenderer, DrawsAlphaMaskedFoliage) { expect_alike_in_file("sponza/sponza.glb"); }

TEST_F(GlRenderer, DrawsAFurnishedHouse) { expect_alike_in_file("house/small-house.glb"); }

TEST_F(GlRenderer, TransformsTextures) {
    expect_alike_in_file("odd-valid/TextureTransformTest/TextureTransformTest.gltf");
}

TEST_F(GlRenderer, DrawsNothingOfAnEmptyScene) {
    Scene scene;
    const DeviceScene placed = test::on_device(scene);
    gl::SceneRenderer renderer(test::device().queue, placed);
    const View view = make_view(Camera(), placed.frame(), 17, 9);
    const Drawing drawing = test::draw_with_gl(placed, renderer, view);
    for (std::size_t p = 0; p < 17 * 9; ++p) EXPECT_EQ(triangle_at(drawing, p), -1);
    EXPECT_EQ(drawing.planes[0], 0.0f);
}

TEST_F(GlRenderer, ChangesSizeFromViewToView) {
    const Scene scene = cornell();
    const DeviceScene placed = test::on_device(scene);
    gl::SceneRenderer renderer(test::device().queue, placed);
    EXPECT_EQ(renderer.textures().position, 0u);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {640, 7}, {3, 500}, {1, 1}}) {
        const View view = make_view(scene.cameras[0], placed.frame(), size.x, size.y);
        expect_alike(placed, test::draw(placed, view), test::draw_with_gl(placed, renderer, view));
    }
    View none = make_view(scene.cameras[0], placed.frame(), 4, 4);
    none.width = 0;
    EXPECT_THROW(renderer.draw(none), Error);
}

// Names in use, of every kind of object.
std::size_t live_objects() {
    std::size_t count = 0;
    for (GLuint name = 1; name < 2000; ++name)
        count += glIsTexture(name) + glIsBuffer(name) + glIsFramebuffer(name) +
                 glIsVertexArray(name) + glIsProgram(name) + glIsShader(name);
    return count;
}

TEST_F(GlRenderer, LeavesNoObjectBehind) {
    const Scene scene = cornell();
    const DeviceScene placed = test::on_device(scene);
    const std::size_t before = live_objects();
    {
        gl::SceneRenderer renderer(test::device().queue, placed);
        gl::GBufferImport import(test::device().context, test::device().device);
        for (const int size : {16, 32}) {
            const View view = make_view(scene.cameras[0], placed.frame(), size, size);
            renderer.draw(view);
            import
                .convert(test::device().queue, view, placed, renderer.textures(),
                         test::marked_gbuffer(static_cast<std::size_t>(size * size)))
                .wait();
        }
        EXPECT_GT(live_objects(), before);
    }
    EXPECT_EQ(live_objects(), before);
}

}  // namespace
}  // namespace clgi
