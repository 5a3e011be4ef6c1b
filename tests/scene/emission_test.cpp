// What triangles of textured emitters shine with: means over their own texels.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "device.hpp"
#include "scene/emission.hpp"
#include "scene/luminance.hpp"
#include "scene/texture_mean.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

Texture noise(int width, int height, std::uint64_t seed) {
    Texture out;
    out.width = width;
    out.height = height;
    test::Random random(seed);
    for (int i = 0; i < 4 * width * height; ++i)
        out.rgba.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
    return out;
}

double decoded(const Texture& texture, int byte) {
    const double s = byte / 255.0;
    if (!texture.srgb) return s;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

int folded(long i, int size, Wrap wrap) {
    if (wrap == Wrap::clamp_to_edge) return static_cast<int>(std::min(std::max(i, 0L), size - 1L));
    while (i < 0) i += 2 * size;
    i %= 2 * size;
    if (i >= size) i = wrap == Wrap::repeat ? i - size : 2 * size - 1 - i;
    return static_cast<int>(i);
}

// Looked up in the plainest way.
glm::dvec3 texel(const Texture& texture, long x, long y) {
    const int column = folded(x, texture.width, texture.wrap_s);
    const int row = folded(y, texture.height, texture.wrap_t);
    glm::dvec3 out;
    for (int c = 0; c < 3; ++c)
        out[c] = decoded(texture, texture.rgba[4 * (row * texture.width + column) + c]);
    return out;
}

glm::dvec3 look_up(const Texture& texture, const glm::dvec2& uv) {
    const double x = uv.x * texture.width, y = uv.y * texture.height;
    if (texture.nearest) return texel(texture, long(std::floor(x)), long(std::floor(y)));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const long i = long(left), j = long(top);
    return (1 - fy) * ((1 - fx) * texel(texture, i, j) + fx * texel(texture, i + 1, j)) +
           fy * ((1 - fx) * texel(texture, i, j + 1) + fx * texel(texture, i + 1, j + 1));
}

// By very many points.
glm::dvec3 numeric_mean(const Texture& texture, const UvTriangle& uv, int side) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            double b = (i + 0.5) / side, c = (j + 0.5) / side;
            if (b + c > 1.0) {  // a square folded over its diagonal
                b = 1.0 - b;
                c = 1.0 - c;
            }
            sum += look_up(texture, (1.0 - b - c) * uv[0] + b * uv[1] + c * uv[2]);
        }
    return sum / (double(side) * side);
}

void expect_near(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], wanted[c], tolerance) << "channel " << c;
}

TEST(TextureMeans, AreTheIntegralsOfLookups) {
    const Wrap wraps[] = {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge};
    test::Random random(11);
    for (const Wrap s : wraps)
        for (const Wrap t : wraps)
            for (const bool nearest : {false, true})
                for (const glm::ivec2& size : {glm::ivec2(1, 1), {5, 3}, {37, 20}}) {
                    Texture texture = noise(size.x, size.y, 3);
                    texture.wrap_s = s;
                    texture.wrap_t = t;
                    texture.nearest = nearest;
                    texture.srgb = size.x != 5;
                    const TextureMean mean(texture);
                    for (int i = 0; i < 3; ++i) {
                        const double reach = i == 0 ? 2.3 : 0.2;
                        const glm::dvec2 at(random(-5, 5), random(-1, 1));
                        UvTriangle uv;
                        for (glm::dvec2& corner : uv)
                            corner = at + reach * glm::dvec2(random(-1, 1), random(-1, 1));
                        SCOPED_TRACE(testing::Message()
                                     << int(s) << int(t) << nearest << " " << size.x << " " << i);
                        // Points of a side lie 1/300 of it apart; steps between texels that a
                        // grid of them meets unevenly leave about a hundredth of that.
                        expect_near(mean.over(uv), numeric_mean(texture, uv, 300),
                                    nearest ? 5e-3 : 1e-3);
                        std::swap(uv[0], uv[1]);
                        expect_near(mean.over(uv), mean.over({uv[1], uv[2], uv[0]}), 1e-9);
                    }
                }
}

TEST(TextureMeans, OfWholePeriodsAreThoseOfAllTexels) {
    Texture texture = noise(19, 33, 8);
    glm::dvec3 all(0.0);
    for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 19; ++x) all += texel(texture, x, y) / (19.0 * 33.0);
    for (const bool nearest : {false, true})
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat}) {
            texture.wrap_s = texture.wrap_t = wrap;
            texture.nearest = nearest;
            const TextureMean mean(texture);
            // Mirrored, a period is twice as wide and high, and cut anywhere.
            const double low = 0.123, high = low + 6.0;
            const UvTriangle first{glm::dvec2(low, low), {high, low}, {high, high}};
            const UvTriangle second{glm::dvec2(low, low), {high, high}, {low, high}};
            expect_near(0.5 * (mean.over(first) + mean.over(second)), all, 1e-6);
        }
    // Very many periods: by points, and in no time.
    texture.wrap_s = texture.wrap_t = Wrap::repeat;
    const TextureMean mean(texture);
    for (int i = 0; i < 20; ++i)
        expect_near(mean.over({glm::dvec2(0, 0), {9000.123, 77.7}, {5000.3, 8000.0 + i}}), all,
                    0.02);
}

TEST(TextureMeans, OfTrianglesWithoutAreaAreThoseOfTheirPoints) {
    const Texture texture = noise(16, 16, 5);
    const TextureMean mean(texture);
    const glm::dvec2 point(0.3, 0.77);
    expect_near(mean.over({point, point, point}), look_up(texture, point), 1e-6);
    // A line, on which corner 1 lies in the middle: weights of a triangle seen edge on.
    const UvTriangle line{glm::dvec2(0.1, 0.2), {0.4, 0.3}, {0.7, 0.4}};
    expect_near(mean.over(line), numeric_mean(texture, line, 400), 0.01);
    // A sliver is the line that it nearly is.
    UvTriangle sliver = line;
    sliver[1].y += 1e-5;
    expect_near(mean.over(sliver), numeric_mean(texture, line, 400), 0.01);
}

// A floor of 8x8 squares, each over one tile of an atlas of 8x8 texels.
Scene tiles(Texture atlas) {
    Scene scene = test::plain_scene();
    Material material;
    material.emission = glm::vec3(10.0f, 20.0f, 30.0f);
    material.emission_texture.texture = 0;
    const std::uint32_t glowing = test::add_material(scene, material);
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            const double x = column - 4, z = row - 4;
            test::add_quad(scene,
                           {glm::dvec3(x, 0, z + 1), {x + 1, 0, z + 1}, {x + 1, 0, z}, {x, 0, z}},
                           glowing);
        }
    for (const glm::dvec3& p : scene.positions)
        scene.uvs.emplace_back((p.x + 4) / 8, (p.z + 4) / 8, 0.25f, 0.75f);
    scene.textures.push_back(std::move(atlas));
    return scene;
}

Texture one_bright_tile(int column, int row) {
    Texture atlas;
    atlas.width = atlas.height = 8;
    atlas.nearest = true;
    atlas.rgba.assign(4 * 64, 0);
    const std::uint8_t bright[] = {255, 128, 0, 255};
    std::copy(bright, bright + 4, atlas.rgba.begin() + 4 * (8 * row + column));
    return atlas;
}

TEST(Emission, IsThatOfATrianglesOwnTexels) {
    const Scene scene = tiles(one_bright_tile(5, 2));
    const DeviceScene placed = test::on_device(scene);
    ASSERT_EQ(placed.emissive().size(), 2u);
    for (const EmissiveTriangle& triangle : placed.emissive()) {
        const double bright = decoded(scene.textures[0], 128);
        expect_near(glm::dvec3(triangle.radiance) * placed.frame().exposure,
                    {10.0, 20.0 * bright, 0.0}, 1e-5);
        for (const glm::vec3& corner : triangle.corner) {
            const glm::dvec3 at = glm::dvec3(corner) / placed.frame().scale + placed.frame().origin;
            EXPECT_NEAR(at.x, 1.5, 0.5 + 1e-6);
            EXPECT_NEAR(at.z, -1.5, 0.5 + 1e-6);
        }
    }
    // Between texels the tile's neighbours shine as well, and all together as much.
    Texture smooth = one_bright_tile(5, 2);
    smooth.nearest = false;
    const DeviceScene blurred = test::on_device(tiles(smooth));
    EXPECT_EQ(blurred.emissive().size(), 16u);  // 9 squares less 2 halves that it does not reach
    double sharp_sum = 0.0, smooth_sum = 0.0;
    for (const EmissiveTriangle& t : placed.emissive()) sharp_sum += double{t.area * t.radiance.x};
    for (const EmissiveTriangle& t : blurred.emissive())
        smooth_sum += double{t.area * t.radiance.x};
    EXPECT_NEAR(smooth_sum, sharp_sum, 1e-5 * sharp_sum);
}

TEST(Emission, HonoursTransformAndSet) {
    Scene scene = tiles(one_bright_tile(5, 2));
    TextureSlot& slot = scene.materials[1].emission_texture;
    // u' = v, v' = u: the tile of column 2, row 5 shines.
    slot.transform = glm::mat3(0, 1, 0, 1, 0, 0, 0, 0, 1);
    const DeviceScene turned = test::on_device(scene);
    ASSERT_EQ(turned.emissive().size(), 2u);
    const glm::dvec3 at =
        glm::dvec3(turned.emissive()[0].corner[0]) / turned.frame().scale + turned.frame().origin;
    EXPECT_NEAR(at.x, -1.5, 0.5 + 1e-6);
    EXPECT_NEAR(at.z, 1.5, 0.5 + 1e-6);
    // The second set is one point of the atlas for all: nothing there, or the tile.
    slot.transform = glm::mat3(1.0f);
    slot.uv_set = 1;
    EXPECT_TRUE(test::on_device(scene).emissive().empty());
    slot.transform[2] = glm::vec3(0.43f, -0.43f, 1.0f);
    EXPECT_EQ(test::on_device(scene).emissive().size(), 128u);
}

// Lumen of all emissive triangles against points on every triangle, in double precision.
TEST(Emission, HasThePowerOfItsTexture) {
    for (const bool nearest : {false, true}) {
        Texture texture = noise(23, 41, 17);
        texture.nearest = nearest;
        Scene scene = tiles(texture);
        for (glm::vec4& uv : scene.uvs) uv = glm::vec4(1.7f * uv.x - uv.y, 0.6f * uv.y, 0, 0);
        const DeviceScene placed = test::on_device(scene);
        glm::dvec3 got(0.0), wanted(0.0);
        for (const EmissiveTriangle& t : placed.emissive())
            got += pi * double{t.area} / std::pow(placed.frame().scale, 2) *
                   glm::dvec3(t.radiance) * placed.frame().exposure;
        for (const SceneTriangle& t : scene.triangles) {
            UvTriangle uv;
            for (int k = 0; k < 3; ++k) uv[k] = glm::dvec2(scene.uvs[t.vertex[k]]);
            wanted +=
                pi * 0.5 * glm::dvec3(scene.materials[1].emission) * numeric_mean(texture, uv, 60);
        }
        expect_near(got / wanted, glm::dvec3(1.0), 2e-3);
    }
}

TEST(Emission, EndsWhereAMaskCutsIt) {
    // Every other column of the base colour's texture is cut out, nothing of the last row of tiles.
    Scene scene = tiles(one_bright_tile(5, 2));
    scene.textures[0].rgba.assign(4 * 64, 255);
    Texture mask = noise(32, 32, 1);
    mask.nearest = true;
    for (int i = 0; i < 32 * 32; ++i) mask.rgba[4 * i + 3] = i / 32 >= 28 || i % 2 == 0 ? 255 : 100;
    scene.textures.push_back(mask);
    Material& material = scene.materials[1];
    material.base_texture.texture = 1;
    const auto sum = [](const Scene& world) {
        const DeviceScene placed = test::on_device(world);
        double out = 0.0;
        for (const EmissiveTriangle& t : placed.emissive())
            out += double{t.area} / std::pow(placed.frame().scale, 2) * double{t.radiance.x} *
                   placed.frame().exposure;
        return out;
    };
    EXPECT_NEAR(sum(scene), 640.0, 1e-3);  // no mask yet
    material.alpha_mode = AlphaMode::mask;
    EXPECT_NEAR(sum(scene), 10.0 * (56 * 0.5 + 8), 0.02 * 640);
    material.alpha_cutoff = 0.3f;
    EXPECT_NEAR(sum(scene), 640.0, 1e-3);
    material.base_color.a = 0.5f;
    EXPECT_NEAR(sum(scene), 10.0 * (56 * 0.5 + 8), 0.02 * 640);
    scene.colors.assign(scene.positions.size(), glm::vec4(1, 1, 1, 0.5f));
    EXPECT_TRUE(test::on_device(scene).emissive().empty());
    material.alpha_mode = AlphaMode::opaque;
    EXPECT_NEAR(sum(scene), 640.0, 1e-3);
}

// A blended surface shines as much as its alpha covers: factor, corners and texture together.
TEST(Emission, OfBlendedSurfacesIsWeightedByAlpha) {
    Scene scene = test::plain_scene(glm::vec3(0.0f));
    Material& material = scene.materials[0];
    material.alpha_mode = AlphaMode::blend;
    material.base_color.a = 0.6f;
    material.emission = {3.0f, 2.0f, 1.0f};
    test::add_quad(scene, {{{0, 0, 0}, {2, 0, 1}, {2, 3, 1}, {0, 3, 0}}});
    for (const glm::dvec3& position : scene.positions)
        scene.colors.emplace_back(1.0f, 1.0f, 1.0f, 0.5 * position.x);
    const DeviceScene placed = test::on_device(scene);
    glm::dvec3 sum(0.0);
    for (const EmissiveTriangle& t : placed.emissive())
        sum += glm::dvec3(t.radiance) *
               (double{t.area} / std::pow(placed.frame().scale, 2) * placed.frame().exposure);
    const double area = 3.0 * std::sqrt(5.0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], area * 0.6 * 0.5 * material.emission[c], 1e-3 * area) << c;
}

// Irradiance above the floor, from its emissive triangles and from the path tracer, which looks the
// texture up at every point.
TEST(Emission, LightsPlacesAsTheReferenceSees) {
    Texture atlas = noise(8, 8, 23);
    atlas.nearest = true;
    const Scene scene = tiles(atlas);
    const DeviceScene placed = test::on_device(scene);
    std::vector<reference::Place> places;
    for (const glm::dvec3& at : {glm::dvec3(-3, 1, -3), {2.5, 0.7, 1.5}, {0, 3, 0}})
        places.push_back({at, {0, -1, 0}});
    reference::Options options;
    options.samples = 20000;
    const auto truth = reference::PathTracer(scene).irradiance(places, options);
    for (std::size_t p = 0; p < places.size(); ++p) {
        glm::dvec3 sum(0.0);
        for (const EmissiveTriangle& t : placed.emissive())
            for_lattice(16, [&](const glm::dvec3& weight) {
                glm::dvec3 on(0.0);
                for (int k = 0; k < 3; ++k) on += weight[k] * glm::dvec3(t.corner[k]);
                const glm::dvec3 away =
                    on / placed.frame().scale + placed.frame().origin - places[p].position;
                const double square = glm::dot(away, away);
                const double area = double{t.area} / std::pow(placed.frame().scale, 2) / 256.0;
                sum += glm::dvec3(t.radiance) * placed.frame().exposure * area *
                       (away.y * away.y / (square * square));
            });
        const double error =
            5.0 * double{truth.error[p]} + 2e-3 * double{luminance(truth.values[p])};
        EXPECT_NEAR(double{luminance(glm::vec3(sum))}, double{luminance(truth.values[p])}, error);
        // Channels have shares of the luminance's error; the green one most of it.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum[c], double{truth.values[p][c]}, 3.0 * error) << p << ", " << c;
    }
}

}  // namespace
}  // namespace clgi
