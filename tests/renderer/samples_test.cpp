// A picture's samples: where they look through, their mean, what they bring.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <cmath>
#include <utility>

#include "apart.hpp"
#include "device.hpp"
#include "renderer/samples.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

constexpr int width = 43, height = 29;  // no multiples of a packet's

RendererOptions options_of(Method method) {
    RendererOptions out;
    out.method = method;
    out.picture.width = width;
    out.picture.height = height;
    out.picture.emitters.shadow_size = out.picture.emitters.face_size = 64;
    out.picture.build = test::usual_build();
    out.light_atlas.emitters.shadow_size = 64;
    out.vpls.count = 40;
    out.layout.size = 64;
    out.antiradiance.bins = 32;
    out.antiradiance.elements.requested = 100;
    out.transfer.masks.size = 16;
    out.second_order.emitters.vpls = 20;
    out.second_order.negative_vpls = 8;
    out.cache.seen = 20;
    out.cache.met = 30;
    out.cache.refined = 10;
    out.cache.face = 8;
    return out;
}

using Radiance = std::vector<glm::vec3>;

Radiance read(const Renderer& renderer) {
    const auto planes = renderer.read_radiance();
    Radiance out;
    for (std::size_t i = 0; i < planes[0].size(); ++i)
        out.emplace_back(planes[0][i], planes[1][i], planes[2][i]);
    return out;
}

Radiance draw(Renderer& renderer, const Camera& camera) {
    renderer.render(camera);
    return read(renderer);
}

// Boxes and a leaning wall in colours, under a lamp, a sun and a panel.
Scene lit_scene() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_floor(scene, 2.0);
    test::add_box(scene, {-0.4, 0.0, -0.3}, {0.2, 0.5, 0.3}, 1);
    test::add_quad(scene,
                   {{{-1.2, 0.0, -0.8}, {0.9, 0.0, -1.1}, {0.8, 1.4, -1.5}, {-1.3, 1.2, -1.2}}});
    Material panel;
    panel.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    panel.emission = {2.0f, 3.0f, 5.0f};
    const std::uint32_t lamp = test::add_material(scene, panel);
    test::add_quad(scene, {{{-0.5, 1.6, 0.9}, {-0.5, 1.7, 0.3}, {0.2, 1.7, 0.3}, {0.2, 1.6, 0.9}}},
                   lamp);
    scene.lights = {test::point_light({0.6, 1.3, 0.7}, 1.0f),
                    test::directional_light({-0.3f, -1.0f, -0.4f}, 2.0f),
                    test::spot_light({-1.0, 1.5, 1.0}, {0.6f, -1.0f, -0.7f}, 0.4, 3.0f)};
    scene.lights[0].intensity = {3.0f, 1.0f, 0.5f};
    return scene;
}

Camera viewpoint() { return test::camera_at({1.4, 1.2, 1.6}, {0.0, 0.3, -0.2}); }

double difference(const Radiance& a, const Radiance& b) {
    double squares = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const glm::dvec3 off = glm::dvec3(a[i]) - glm::dvec3(b[i]);
        squares += glm::dot(off, off);
        sum += glm::dot(glm::dvec3(b[i]), glm::dvec3(b[i]));
    }
    return std::sqrt(squares / sum);
}

// A shining, leaning sheet before a wall that shines in other colours, blended by alpha in the mean
// of samples, with an error that falls with their number; and the shadow that it casts.
TEST(Samples, BlendByAlpha) {
    constexpr double alpha = 0.3;
    constexpr int samples = 64;
    const glm::dvec3 near(1.0, 2.0, 4.0), far(3.0, 0.5, 0.2);
    Scene scene = test::plain_scene(glm::vec3(0.0f));
    scene.materials[0].emission = glm::vec3(far);
    test::add_quad(scene, {{{-9, -9, -2}, {9, -9, -2}, {9, 9, -3}, {-9, 9, -3}}});
    Material sheet;
    sheet.base_color = {0.0f, 0.0f, 0.0f, static_cast<float>(alpha)};
    sheet.emission = glm::vec3(near);
    sheet.alpha_mode = AlphaMode::blend;
    test::add_quad(scene, {{{-9, -9, 0.5}, {9, -9, 0}, {9, 9, -1}, {-9, 9, -0.5}}},
                   test::add_material(scene, sheet));
    RendererOptions options = options_of(Method::direct);
    options.picture.emitters.area_samples = 0;
    options.samples = samples;
    Renderer renderer(test::programs(), test::device().queue, scene, options);
    const Radiance mean = draw(renderer, test::camera_at({0, 0, 3}, {0, 0, 0}));
    const double count = static_cast<double>(mean.size());
    for (int c = 0; c < 3; ++c) {
        const double wanted = alpha * near[c] + (1.0 - alpha) * far[c];
        const double deviation = std::sqrt(alpha * (1.0 - alpha)) * std::abs(near[c] - far[c]);
        double sum = 0.0, squares = 0.0;
        for (const glm::vec3& pixel : mean) {
            sum += pixel[c];
            squares += (pixel[c] - wanted) * (pixel[c] - wanted);
        }
        EXPECT_NEAR(sum / count, wanted, 5.0 * deviation / std::sqrt(count * samples)) << c;
        EXPECT_NEAR(std::sqrt(squares / count), deviation / std::sqrt(samples),
                    0.15 * deviation / std::sqrt(samples))
            << c;
    }
}

// Under a point light and a sun, each alone: the mean of one sample over the picture, and the noise
// of pixels, which falls with the number of shadow maps: one for four samples.
TEST(Samples, ShadowsOfBlendedSurfacesAreAsDarkAsTheirAlpha) {
    constexpr double alpha = 0.6;
    Scene scene = test::plain_scene({0.9f, 0.6f, 0.3f});
    test::add_floor(scene, 2.0);
    Material sheet;
    sheet.base_color = {0.0f, 0.0f, 0.0f, static_cast<float>(alpha)};
    sheet.alpha_mode = AlphaMode::blend;
    sheet.double_sided = true;
    test::add_quad(scene, {{{-9, 2.0, -9}, {-9, 2.5, 9}, {9, 2.8, 9}, {9, 2.3, -9}}},
                   test::add_material(scene, sheet));
    Light point = test::point_light({0.3, 5.0, -0.2}, 1.0f);
    point.intensity = {9.0f, 30.0f, 20.0f};
    const Light sun = test::directional_light({-0.2f, -1.0f, 0.1f}, 2.0f);
    constexpr double most = 0.45;  // of the noise of one: four maps
    for (const auto& [method, light] :
         {std::pair(Method::direct, point), std::pair(Method::direct, sun),
          std::pair(Method::irradiance_cache, point), std::pair(Method::irradiance_cache, sun)}) {
        RendererOptions options = options_of(method);
        options.picture.emitters.shadow_size = 1024;
        options.picture.emitters.face_size =
            256;  // a texel is about as wide as a pixel on the floor
        const Camera camera = test::camera_at({0.0, 1.0, 0.3}, {0.0, 0.0, 0.0}, 1.2f);
        scene.lights = {light};
        const auto drawn_with = [&](double a, std::uint32_t samples) {
            scene.materials.back().base_color.a = static_cast<float>(a);
            options.samples = samples;
            Renderer renderer(test::programs(), test::device().queue, scene, options);
            return draw(renderer, camera);
        };
        const Radiance open = drawn_with(0.0, 1);
        // Mean of pixels over those without the sheet, in each channel, and their deviation.
        const auto lit = [&](std::uint32_t samples) {
            const Radiance picture = drawn_with(alpha, samples);
            glm::dvec3 sum(0.0), squares(0.0);
            for (std::size_t i = 0; i < picture.size(); ++i) {
                const glm::dvec3 part = glm::dvec3(picture[i]) / glm::dvec3(open[i]);
                sum += part;
                squares += part * part;
            }
            const double count = static_cast<double>(picture.size());
            const glm::dvec3 mean = sum / count;
            return std::pair(mean, glm::sqrt(squares / count - mean * mean));
        };
        const auto [one, noise] = lit(1);
        const auto [many, less] = lit(16);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(one[c], 1.0 - alpha, 0.04) << c;
            EXPECT_NEAR(many[c], 1.0 - alpha, 0.01) << c;
            EXPECT_GT(noise[c], 0.1) << c;
            EXPECT_LT(less[c], most * noise[c]) << c;
        }
    }
}

// A camera that looks through other points of its pixels by whole pixels sees its picture moved.
TEST(Samples, OffsetsMoveThePicture) {
    Camera parallel = test::pixel_camera(width, height);
    parallel.half_height = 1.5f;
    parallel.position = {0.1, 0.4, 5.0};
    Scene scene = lit_scene();
    scene.environment = test::picture_sky(16, 8, [](int row, int column) {
        return 0.2f + 0.05f * static_cast<float>((row + 3 * column) % 7);
    });
    RendererOptions options = options_of(Method::direct);
    options.picture.emitters.shadows = false;  // directions of the sky are the same either way
    Renderer renderer(test::programs(), test::device().queue, scene, options);
    for (Camera camera : {viewpoint(), parallel}) {
        const Radiance before = draw(renderer, camera);
        camera.offset = {3.0f, -2.0f};  // to the right and up
        const Radiance after = draw(renderer, camera);
        std::size_t same = 0, of = 0;
        for (int y = 2; y < height; ++y)
            for (int x = 0; x + 3 < width; ++x) {
                const glm::vec3 a = after[static_cast<std::size_t>(y * width + x)],
                                b = before[static_cast<std::size_t>((y - 2) * width + x + 3)];
                same += glm::length(a - b) <= 1e-4f * (0.1f + glm::length(b));
                ++of;
            }
        EXPECT_GT(same, of - of / 200);  // edges and texels of the sky may round to either side
    }
}

// Sums on the host over single views, with lights that are the same for all of them.
TEST(Samples, AreTheMeanOfShiftedViews) {
    Scene scene = lit_scene();
    scene.lights.resize(1);
    scene.materials[1].emission = glm::vec3(0.0f);
    for (const Method method : {Method::direct, Method::light_atlas, Method::antiradiance}) {
        RendererOptions options = options_of(method);
        Renderer one(test::programs(), test::device().queue, scene, options);
        std::vector<glm::dvec3> mean(std::size_t{width} * height, glm::dvec3(0.0));
        constexpr int samples = 5;
        for (std::uint32_t k = 0; k < samples; ++k) {
            Camera camera = viewpoint();
            camera.offset = renderer::sampled(camera, k).offset;  // sample_points_test.cpp
            const Radiance view = draw(one, camera);
            for (std::size_t i = 0; i < view.size(); ++i)
                mean[i] += glm::dvec3(view[i]) / double{samples};
        }
        options.samples = samples;
        Renderer all(test::programs(), test::device().queue, scene, options);
        const Radiance found = draw(all, viewpoint());
        EXPECT_EQ(all.samples(), 5u);
        double largest = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i)
            largest = std::max(largest, glm::length(glm::dvec3(found[i]) - mean[i]) /
                                            (1e-3 + glm::length(mean[i])));
        EXPECT_LT(largest, 1e-6) << name_of(method);
        // And by one after the other.
        for (int k = 1; k < samples; ++k) {
            if (k == 1) one.render(viewpoint());
            one.refine();
        }
        EXPECT_TRUE(read(one) == found) << name_of(method);
    }
}

// One sample is the picture itself, before and after one of several.
TEST(Samples, LeaveASinglePictureAsItIs) {
    const Scene scene = lit_scene();
    for (const Method method :
         {Method::direct, Method::second_order, Method::light_atlas, Method::antiradiance,
          Method::dynamic_transfer, Method::irradiance_cache}) {
        Renderer renderer(test::programs(), test::device().queue, scene, options_of(method));
        const Radiance before = draw(renderer, viewpoint());
        EXPECT_EQ(renderer.samples(), 1u);
        renderer.refine();
        renderer.refine();
        EXPECT_EQ(renderer.samples(), 3u);
        const Radiance refined = read(renderer);
        EXPECT_GT(difference(refined, before), 1e-3) << name_of(method);
        EXPECT_LT(difference(refined, before), 0.5) << name_of(method);
        EXPECT_TRUE(draw(renderer, viewpoint()) == before) << name_of(method);
        EXPECT_EQ(renderer.samples(), 1u);
    }
}

// Shadows of a sun, a spot and a panel against the path tracer: each sample has its own maps and
// points, so edges that one of them has rough or doubled come out right.
TEST(Samples, SmoothShadows) {
    const Scene scene = lit_scene();
    reference::Options truth;
    truth.width = width;
    truth.height = height;
    truth.samples = 1024;
    truth.effects = reference::parse_effects("emission,direct");
    truth.filter = reference::Filter::box;
    const test::Twice traced = test::render_twice(scene, viewpoint(), truth);
    // Without an environment transfer has direct light alone, by a Picture.
    for (const Method method : {Method::direct, Method::dynamic_transfer}) {
        Renderer renderer(test::programs(), test::device().queue, scene, options_of(method));
        const test::Apart one = test::apart(draw(renderer, viewpoint()), traced);
        for (int k = 1; k < 32; ++k) renderer.refine();
        const test::Apart many = test::apart(read(renderer), traced);
        EXPECT_GT(one.error, 0.08) << name_of(method);
        EXPECT_LT(many.high, 0.25 * one.error) << name_of(method);
        EXPECT_NEAR(many.energy, 1.0, 0.01) << name_of(method);
    }
}

// Texels smaller than pixels, on a floor that is seen at a slant: one picture blurs what lies
// beyond a pixel's width too, many look closely.
TEST(Samples, LookTexturesUpMoreClosely) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    test::add_floor(scene, 6.0);
    for (const glm::vec2 uv : {glm::vec2(0, 4), {4, 4}, {4, 0}, {0, 0}})
        scene.uvs.push_back(glm::vec4(uv, uv));
    test::Random random(5);
    Texture texture{"noise", 64, 64, {}};
    for (int i = 0; i < 64 * 64; ++i)
        for (int c = 0; c < 4; ++c)
            texture.rgba.push_back(
                static_cast<std::uint8_t>(c == 3 ? 255 : random.integer(0, 1) * 255));
    scene.textures.push_back(texture);
    scene.materials[0].base_texture.texture = 0;
    scene.lights = {test::directional_light({0.1f, -1.0f, 0.2f}, 3.0f)};
    scene.cameras = {test::camera_at({0.2, 1.4, 5.5}, {0.0, 0.0, 1.0}, 0.5f)};
    reference::Options truth;
    truth.width = width;
    truth.height = height;
    truth.samples = 1024;
    truth.filter = reference::Filter::box;
    const test::Twice traced = test::render_twice(scene, scene.cameras[0], truth);
    Renderer renderer(test::programs(), test::device().queue, scene, options_of(Method::direct));
    const test::Apart one = test::apart(draw(renderer, scene.cameras[0]), traced);
    for (int k = 1; k < 64; ++k) renderer.refine();
    const test::Apart many = test::apart(read(renderer), traced);
    EXPECT_GT(one.error, 0.08);
    EXPECT_LT(many.high, 0.4 * one.error);
    EXPECT_NEAR(many.energy, 1.0, 0.01);
    scene.cameras[0].footprint = 0.0f;
    EXPECT_THROW(validate(scene), InputError);
}

TEST(Samples, SayWhatIsWrong) {
    const Scene scene = lit_scene();
    RendererOptions options = options_of(Method::direct);
    options.samples = 0;
    EXPECT_THROW(Renderer(test::programs(), test::device().queue, scene, options), Error);
    options.samples = 2;
    Renderer renderer(test::programs(), test::device().queue, scene, options);
    EXPECT_THROW(renderer.refine(), Error);
    renderer.render(viewpoint());
    EXPECT_NO_THROW(renderer.refine());
    EXPECT_EQ(renderer.samples(), 3u);
    renderer.lights_changed();  // samples before it have other lights
    EXPECT_THROW(renderer.refine(), Error);
    renderer.render(viewpoint());
    PictureOptions smaller = options.picture;
    smaller.width = 16;
    renderer.reconfigure(smaller);
    EXPECT_THROW(renderer.refine(), Error);
    renderer.render(viewpoint());
    EXPECT_EQ(renderer.samples(), 2u);
    EXPECT_EQ(renderer.read_radiance()[0].size(), 16u * height);
    Scene wrong = scene;
    wrong.cameras = {viewpoint()};
    wrong.cameras[0].offset.x = std::nanf("");
    EXPECT_THROW(Renderer(test::programs(), test::device().queue, wrong, options), InputError);
}

}  // namespace
}  // namespace clgi
