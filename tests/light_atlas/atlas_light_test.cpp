// The light of an atlas on the host: finer texels, radiance of texels, and scenes that show it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <clgi/advanced/atlas_light.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <filesystem>
#include <limits>
#include <set>

#include "atlas_checks.hpp"
#include "microfacet.hpp"

namespace clgi {
namespace {

using Vectors = std::vector<glm::vec3>;

// By texel: a function of its place on the surface.
template <typename Function>
Vectors light_of(const Scene& scene, const AtlasLayout& atlas, Function at) {
    Vectors out;
    for (const AtlasTexel& texel : atlas.texels) out.emplace_back(at(test::place_of(scene, texel)));
    return out;
}

glm::dvec3 slanted(const glm::dvec3& p) {
    return {4.0 + 0.7 * p.x - 1.3 * p.y, 5.0 + p.z, 6.0 - 0.4 * p.x + 0.8 * p.z};
}

Scene box_of(const glm::vec3& albedo = glm::vec3(0.7f, 0.5f, 0.2f)) {
    Scene scene = test::plain_scene(albedo);
    test::add_box(scene, {-0.5, 0.1, -0.3}, {0.9, 0.8, 0.4}, 1);
    return scene;
}

// A texture of columns that are black and white in turn, once over a quad.
Scene striped_quad(int columns, int rows = 4) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
    for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
        scene.uvs.emplace_back(uv, 0, 0);
    Texture texture;
    texture.width = columns;
    texture.height = rows;
    for (int i = 0; i < columns * rows; ++i)
        for (int c = 0; c < 4; ++c)
            texture.rgba.push_back(c == 3 || i % columns % 2 == 0 ? 255 : 0);
    scene.textures.push_back(texture);
    scene.materials[0].base_texture.texture = 0;
    return scene;
}

// Whether a byte is the nearest to a linear value: so it lies between those half a byte around it.
bool is_nearest(std::uint8_t byte, double linear) {
    const auto half = [](double s) {
        s /= 255.0;
        return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    };
    const double v = std::min(1.0, std::max(0.0, linear));
    return v >= half(byte - 0.501) && v <= half(byte + 0.501);
}

TEST(FinerAtlas, HasTheSameChartsAndAllOfTheirArea) {
    const Scene scene = box_of();
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(40));
    const AtlasLayout finer = finer_atlas(scene, atlas, 3);
    EXPECT_EQ(finer.size, 120);
    EXPECT_EQ(finer.charts.size(), atlas.charts.size());
    EXPECT_DOUBLE_EQ(finer.texels_per_metre, 3.0 * atlas.texels_per_metre);
    test::expect_sound(scene, finer);
    EXPECT_GT(finer.texels.size(), 7 * atlas.texels.size());
    EXPECT_THROW(finer_atlas(scene, atlas, 0), Error);
    EXPECT_THROW(finer_atlas(scene, atlas, 410), Error);
    EXPECT_THROW(finer_atlas(striped_quad(4), atlas, 2), Error);
}

// A linear function stays itself where four texels with covered centres are read, and between the
// least and the largest value everywhere.
TEST(FinerLight, IsBilinearWithinCharts) {
    const Scene scene = box_of();
    const AtlasLayout atlas =
        make_atlas(scene, test::regions(scene, 2), test::made_charts(40, 2, 3));
    ASSERT_GT(atlas.pages, 1);
    const AtlasLayout finer = finer_atlas(scene, atlas, 4);
    const Vectors coarse = light_of(scene, atlas, slanted);
    const Vectors fine = finer_light(atlas, coarse, finer);
    std::set<std::uint32_t> inside;
    for (const AtlasTexel& texel : atlas.texels)
        if (texel.centre) inside.insert(texel.texel);
    int exact = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const AtlasTexel& texel = finer.texels[i];
        const glm::dvec3 wanted = slanted(test::place_of(scene, texel));
        const glm::dvec2 at = test::corner_of(texel, finer.size) / 4.0 - 0.5;
        const auto column = static_cast<std::uint32_t>(std::max(0.0, at.x)),
                   row = static_cast<std::uint32_t>(std::max(0.0, at.y));
        const std::uint32_t first = (texel.texel / (160u * 160u) * 40u + row) * 40u + column;
        const bool within = at.x >= 0.0 && at.y >= 0.0 && at.x < 39.0 && at.y < 39.0 &&
                            inside.count(first) && inside.count(first + 1) &&
                            inside.count(first + 40) && inside.count(first + 41) && texel.centre;
        // Rounded to floats of up to 8; coordinates to 2^-17 of a texel of 3 cm.
        if (within) {
            ASSERT_LT(glm::distance(glm::dvec3(fine[i]), wanted), 4e-6) << i;
            ++exact;
        } else {
            // A texel of 1 / texels_per_metre with a gradient of 1.8 at the most.
            ASSERT_LT(glm::distance(glm::dvec3(fine[i]), wanted), 3.0 / atlas.texels_per_metre);
        }
    }
    EXPECT_GT(exact, 1000);
    EXPECT_THROW(finer_light(atlas, Vectors(3), finer), Error);
}

TEST(AtlasRadiance, IsReflectanceOverPiTimesIrradianceAndEmission) {
    Scene scene = box_of();
    Material& material = scene.materials[0];
    material.metallic = 0.4f;
    material.roughness = 0.6f;
    material.emission = {0.25f, 0.5f, 1.5f};
    for (std::size_t v = 0; v < scene.positions.size(); ++v)
        scene.colors.emplace_back(0.5f, 0.25f, 1.0f, 1.0f);
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(24));
    const Vectors irradiance = light_of(scene, atlas, slanted);
    const Vectors found = atlas_radiance(scene, atlas, irradiance);
    const double diffuse = double{reflectance(test::finished(0.4f, 0.6f)).diffuse};
    for (std::size_t i = 0; i < found.size(); ++i) {
        const glm::dvec3 wanted = glm::dvec3(0.7, 0.5, 0.2) * glm::dvec3(0.5, 0.25, 1.0) * diffuse /
                                      std::numbers::pi * glm::dvec3(irradiance[i]) +
                                  glm::dvec3(0.25, 0.5, 1.5);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[i][c], wanted[c], 1e-6 * wanted[c]);
    }
    EXPECT_THROW(atlas_radiance(scene, atlas, Vectors(1)), Error);
}

// Texels that are 16 stripes wide see their mean, of every level that is read; texels that are a
// quarter of a stripe wide see the stripes.
TEST(AtlasRadiance, TakesTheMeanOfATextureOverATexel) {
    const Scene scene = striped_quad(512);
    AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(32));
    const Vectors coarse =
        atlas_radiance(scene, atlas, Vectors(atlas.texels.size(), glm::vec3(2.0f)));
    for (const glm::vec3& value : coarse)
        // Levels are rounded to bytes: 0.5 is 188 of 255, within 0.4 %.
        ASSERT_NEAR(value.g, 0.5 * 2.0 / std::numbers::pi, 0.01);
    const Scene wide = striped_quad(8);
    atlas = make_atlas(wide, test::regions(wide, 2), test::made_charts(256));
    const Vectors fine = atlas_radiance(wide, atlas, Vectors(atlas.texels.size(), glm::vec3(2.0f)));
    int bright = 0, dark = 0;
    for (const glm::vec3& value : fine) {
        bright += value.g > 0.9 * 2.0 / std::numbers::pi;
        dark += value.g < 0.1 * 2.0 / std::numbers::pi;
    }
    EXPECT_GT(bright, static_cast<int>(fine.size()) / 20);
    EXPECT_GT(dark, static_cast<int>(fine.size()) / 20);
}

// What a mask cuts out has no colour to show.
TEST(AtlasRadiance, LeavesOutWhatAMaskCutsOut) {
    Scene scene = striped_quad(512);
    for (std::size_t i = 0; i < scene.textures[0].rgba.size(); i += 4)
        scene.textures[0].rgba[i + 3] = scene.textures[0].rgba[i];
    scene.materials[0].alpha_mode = AlphaMode::mask;
    // A texel of the atlas is as wide as 8 columns of the texture.
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(64));
    for (const glm::vec3& value :
         atlas_radiance(scene, atlas, Vectors(atlas.texels.size(), glm::vec3(1.0f))))
        // Between columns the texture is interpolated, above the cutoff from 0.5 to 1.
        ASSERT_GT(value.r, 0.7 / std::numbers::pi);
}

// The mean of a blended texel is weighted by alpha: dark columns count a third as much.
TEST(AtlasRadiance, WeighsBlendedColoursByAlpha) {
    Scene scene = striped_quad(512);
    std::vector<std::uint8_t>& rgba = scene.textures[0].rgba;
    double weights = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        rgba[i + 3] = rgba[i] > 128 ? 180 : 60;
        weights += rgba[i + 3];
        sum += rgba[i + 3] * (rgba[i] / 255.0);
    }
    scene.textures[0].nearest = true;
    scene.materials[0].alpha_mode = AlphaMode::blend;
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(64));
    const auto found = atlas_radiance(scene, atlas, Vectors(atlas.texels.size(), glm::vec3(1.0f)));
    double mean = 0.0;
    for (const glm::vec3& value : found) mean += value.r / static_cast<double>(found.size());
    EXPECT_NEAR(mean * std::numbers::pi, sum / weights, 0.05 * sum / weights);
}

class LitScene : public ::testing::Test {
protected:
    LitScene()
        : scene(box_of()),
          file(std::filesystem::temp_directory_path() /
               ("clgi-lit-" + std::to_string(::getpid()) + "-" +
                ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".glb")) {
        Material red;
        red.name = "red";
        red.base_color = glm::vec4(0.9f, 0.1f, 0.05f, 1.0f);
        scene.materials.push_back(red);
        for (std::size_t t = 0; t < scene.triangles.size(); t += 4) scene.triangles[t].material = 1;
        Light light;
        light.intensity = glm::vec3(3.0f, 2.0f, 1.0f);
        scene.lights.push_back(light);
    }
    ~LitScene() override {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
    }
    void lay_out(int pages) {
        atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(40, 2, pages));
        radiance = atlas_radiance(scene, atlas, light_of(scene, atlas, slanted));
    }
    Scene reloaded(const LitSceneOptions& options) const {
        io::save_glb(with_atlas_light(scene, atlas, radiance, options), file);
        return io::load_gltf(file);
    }

    Scene scene;
    AtlasLayout atlas;
    Vectors radiance;
    std::filesystem::path file;
};

// Through the file: every texel, and every one around a chart, is the byte nearest to its radiance.
TEST_F(LitScene, HasTheRadianceOfEveryTexelInItsFile) {
    for (const int pages : {1, 3}) {
        lay_out(pages);
        ASSERT_EQ(atlas.pages > 1, pages > 1);
        LitSceneOptions options;
        options.exposure = 0.6f;
        const Scene found = reloaded(options);
        ASSERT_EQ(found.textures.size(), static_cast<std::size_t>(atlas.pages));
        EXPECT_TRUE(found.warnings.empty());
        const auto texel_of = [&](std::uint32_t texel) {
            const std::string name = "baked light " + std::to_string(texel / 1600u);
            const auto page = std::find_if(found.textures.begin(), found.textures.end(),
                                           [&](const Texture& t) { return t.name == name; });
            return &page->rgba[4 * std::size_t{texel % 1600u}];
        };
        int between = 0;
        const auto check = [&](std::uint32_t texel, std::size_t of) {
            for (int c = 0; c < 3; ++c) {
                const double wanted = 0.6 * double{radiance[of][c]};
                ASSERT_TRUE(is_nearest(texel_of(texel)[c], wanted))
                    << texel << " " << c << ": " << int{texel_of(texel)[c]} << " for " << wanted;
                between += wanted > 0.1 && wanted < 0.9;
            }
        };
        for (std::size_t i = 0; i < radiance.size(); ++i) check(atlas.texels[i].texel, i);
        for (const AtlasDilated& empty : atlas.dilated) check(empty.texel, empty.source);
        EXPECT_GT(between, 1000);
        EXPECT_GT(atlas.dilated.size(), 100u);
    }
}

// Its light holds for the smooth surface and the mean finish, with lights and without.
TEST_F(LitScene, HasNoNormalsAndNoFinishOfTextures) {
    if (scene.uvs.empty()) scene.uvs.assign(scene.positions.size(), glm::vec4(0.0f));
    for (const char* name : {"normals", "finish"})
        scene.textures.push_back({name, 2, 1, {128, 99, 255, 255, 90, 128, 220, 255}});
    for (Material& material : scene.materials) {
        material.normal_texture.texture = static_cast<int>(scene.textures.size()) - 2;
        material.metallic_roughness_texture.texture = static_cast<int>(scene.textures.size()) - 1;
        material.metallic = 0.25f;
    }
    lay_out(1);
    for (const bool lights : {false, true}) {
        LitSceneOptions options;
        options.lights = lights;
        const Scene found = with_atlas_light(scene, atlas, radiance, options);
        for (const Material& material : found.materials) {
            EXPECT_EQ(material.normal_texture.texture, -1);
            EXPECT_EQ(material.metallic_roughness_texture.texture, -1);
            EXPECT_EQ(material.metallic, lights ? 0.25f : 1.0f);
        }
        for (const Texture& texture : found.textures)
            EXPECT_EQ(texture.name.find("finish"), std::string::npos);
    }
}

// Each corner of each triangle has its place in its page as UV set 1, and the material of the page
// emits and reflects nothing.
TEST_F(LitScene, ShowsEveryTriangleItsOwnPage) {
    lay_out(3);
    const Scene found = reloaded({});
    ASSERT_EQ(found.triangles.size(), scene.triangles.size());
    EXPECT_TRUE(found.lights.empty());
    const auto key = [](const Scene& of, std::size_t t) {
        glm::dvec3 centre(0.0);
        for (const std::uint32_t v : of.triangles[t].vertex) centre += of.positions[v] / 3.0;
        return centre;
    };
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        // The file has the triangles of one material together.
        std::size_t there = 0;
        while (there < found.triangles.size() &&
               glm::distance(key(found, there), key(scene, t)) > 1e-6)
            ++there;
        ASSERT_LT(there, found.triangles.size());
        const Material& material = found.materials[found.triangles[there].material];
        EXPECT_EQ(material.base_color, glm::vec4(0, 0, 0, 1));
        EXPECT_EQ(material.metallic, 1.0f);
        EXPECT_EQ(material.roughness, 1.0f);
        EXPECT_EQ(material.emission, glm::vec3(1.0f));
        EXPECT_EQ(material.emission_texture.uv_set, 1);
        const std::string& page =
            found.textures[static_cast<std::size_t>(material.emission_texture.texture)].name;
        EXPECT_EQ(page, "baked light " + std::to_string(atlas.triangle_page[t]));
        EXPECT_EQ(material.name.substr(0, 3) == "red", scene.triangles[t].material == 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec4& uv = found.uvs[found.triangles[there].vertex[k]];
            const glm::vec2 wanted = atlas.uvs[3 * t + k] / 40.0f;
            // The file begins a triangle at the corner at which the scene does.
            EXPECT_LT(glm::distance(glm::vec2(uv.z, uv.w), wanted), 1e-6f);
            EXPECT_LT(glm::distance(glm::vec2(uv.x, uv.y), wanted), 1e-6f) << "for one-set viewers";
        }
    }
    EXPECT_LT(found.positions.size(), 3 * scene.triangles.size()) << "corners are shared";
}

TEST_F(LitScene, KeepsLightsAndBaseColoursOnDemand) {
    lay_out(1);
    LitSceneOptions options;
    options.exposure = 0.25f;
    options.lights = true;
    const Scene found = reloaded(options);
    ASSERT_EQ(found.lights.size(), 1u);
    EXPECT_LT(glm::distance(found.lights[0].intensity, glm::vec3(0.75f, 0.5f, 0.25f)), 1e-6f);
    std::set<float> greens;
    for (const Material& material : found.materials) {
        greens.insert(material.base_color.g);
        EXPECT_EQ(material.metallic, 0.0f);
    }
    EXPECT_EQ(greens, (std::set<float>{0.5f, 0.1f}));
}

// What cuts or blends stays what it was, from whichever set it is read, and the atlas has set 1.
TEST_F(LitScene, KeepsMasks) {
    for (const int set : {0, 1}) {
        scene = striped_quad(8);
        if (set == 1)
            for (glm::vec4& uv : scene.uvs) uv = {0.25f, 0.75f, uv.x, uv.y};
        scene.materials[0].alpha_mode = set == 1 ? AlphaMode::blend : AlphaMode::mask;
        scene.materials[0].alpha_cutoff = 0.3f;
        scene.materials[0].base_texture.uv_set = set;
        scene.textures[0].rgba[3] = 17;
        lay_out(1);
        const Scene found = reloaded({});
        ASSERT_EQ(found.materials.size(), 1u);
        const Material& material = found.materials[0];
        EXPECT_EQ(material.alpha_mode, scene.materials[0].alpha_mode);
        EXPECT_EQ(material.alpha_cutoff, set == 1 ? 0.5f : 0.3f);
        EXPECT_EQ(material.base_color, glm::vec4(0, 0, 0, 1));
        EXPECT_EQ(material.base_texture.uv_set, 0);
        EXPECT_EQ(found.textures[static_cast<std::size_t>(material.base_texture.texture)].rgba,
                  scene.textures[0].rgba);
        std::set<std::pair<float, float>> corners;
        for (const glm::vec4& uv : found.uvs) corners.insert({uv.x, uv.y});
        EXPECT_EQ(corners.size(), 4u);
        EXPECT_TRUE(corners.count({0.0f, 1.0f}) && corners.count({1.0f, 0.0f}));
    }
}

TEST_F(LitScene, MakesWhatIsNotFiniteMagenta) {
    lay_out(1);
    const std::size_t bad = radiance.size() / 2;
    radiance[bad].g = std::numeric_limits<float>::quiet_NaN();
    radiance[bad + 1].r = std::numeric_limits<float>::infinity();
    const Scene found = with_atlas_light(scene, atlas, radiance);
    for (const std::size_t i : {bad, bad + 1}) {
        const std::uint8_t* rgba = &found.textures[0].rgba[4 * std::size_t{atlas.texels[i].texel}];
        EXPECT_EQ(std::vector<int>(rgba, rgba + 4), (std::vector<int>{255, 0, 255, 255}));
    }
    // The rest of the page has the mean of what is finite.
    std::set<std::uint32_t> known;
    for (const AtlasTexel& texel : atlas.texels) known.insert(texel.texel);
    for (const AtlasDilated& empty : atlas.dilated) known.insert(empty.texel);
    for (std::uint32_t i = 0; i < 1600u; ++i)
        EXPECT_TRUE(known.count(i) || found.textures[0].rgba[4 * i + 1] > 20) << i;
}

TEST_F(LitScene, RefusesWhatDoesNotFit) {
    lay_out(1);
    for (const float exposure : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity()}) {
        LitSceneOptions options;
        options.exposure = exposure;
        EXPECT_THROW(with_atlas_light(scene, atlas, radiance, options), Error);
    }
    EXPECT_THROW(with_atlas_light(scene, atlas, Vectors(2)), Error);
    EXPECT_THROW(with_atlas_light(striped_quad(2), atlas, radiance), Error);
}

}  // namespace
}  // namespace clgi
