// What smooth lobes reflect by rays, against sums over directions and along paths of their own.
// SPDX-License-Identifier: MIT
#include <clgi/scene.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "mirrors.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

// A box around the origin, two metres wide, of which every wall sends light of its own; the sixth
// wall, above, may be open to the sky.
struct Box {
    explicit Box(bool open) : lit(scene_of(open)) {
        for (std::uint32_t way = 0; way < CACHE_WAYS; ++way) lit.set_light(way, irradiance(way));
    }

    static glm::vec3 base(std::uint32_t way) { return {0.1f * way, 0.5f, 0.8f - 0.1f * way}; }
    static glm::vec3 emission(std::uint32_t way) { return {1.0f + way, 6.0f - way, 0.5f * way}; }
    static glm::dvec3 irradiance(std::uint32_t way) { return {9.0 - way, 2.0 * way, 5.0}; }

    static Scene scene_of(bool open) {
        Scene out = test::plain_scene();
        out.materials.clear();
        for (std::uint32_t way = 0; way < CACHE_WAYS; ++way) {
            Material wall = test::finished(0.0f, 1.0f);
            wall.base_color = glm::vec4(base(way), 1.0f);
            wall.emission = emission(way);
            out.materials.push_back(wall);
            glm::dvec3 normal(0.0), u(0.0), v(0.0);
            const auto axis = static_cast<int>(way / 2);
            normal[axis] = way % 2 ? -1.0 : 1.0;
            u[(axis + 1) % 3] = 1.0;
            v[(axis + 2) % 3] = normal[axis];
            if (!open || way != 3) add_square(out, -normal, u, v, way);
        }
        for (const Material& finish : finishes_of_points()) out.materials.push_back(finish);
        return out;
    }

    static std::vector<Material> finishes_of_points() {
        return {test::finished(1.0f, 0.35f, 1.0f), test::finished(0.0f, 0.4f, 1.0f),
                test::finished(0.4f, 0.5f, 0.5f)};
    }

    // The way of the wall that a ray meets.
    static std::uint32_t wall(const glm::dvec3& from, const glm::dvec3& d) {
        std::uint32_t out = 0;
        double nearest = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double at = ((d[axis] > 0.0 ? 1.0 : -1.0) - from[axis]) / d[axis];
            if (at >= nearest) continue;
            nearest = at;
            out = static_cast<std::uint32_t>(2 * axis + (d[axis] > 0.0 ? 1 : 0));
        }
        return out;
    }

    glm::dvec3 radiance(std::uint32_t way) const {
        return glm::dvec3(emission(way)) / lit.scene.frame().exposure +
               glm::dvec3(base(way)) / std::numbers::pi * irradiance(way);
    }

    Mirrors lit;
};

// Lobes of metals, coats and both, on tilted and mapped normals, of what lies around off-centre
// points; above a sky by its texels.
TEST(Reflect, ShowsWhatRaysMeet) {
    for (const bool open : {false, true}) {
        Box box(open);
        Mirrors& lit = box.lit;
        constexpr int columns = 8, rows = 4;
        constexpr double turn = 0.3;
        const glm::dvec3 factor(2.0, 1.0, 0.5);
        std::vector<float> texels;
        for (int k = 0; k < 3 * columns * rows; ++k)
            texels.push_back(static_cast<float>(1 + k * 7 % 13));
        if (open) {
            lit.sky = test::upload(texels);
            lit.of_lobes.sky_width = columns;
            lit.of_lobes.sky_height = rows;
            lit.params.sky = {2.0f, 1.0f, 0.5f, 0.0f};
            lit.params.sky_turn = static_cast<float>(turn);
        }
        const auto sent = [&](const glm::dvec3& from, const glm::dvec3& d) {
            const std::uint32_t way = Box::wall(from, d);
            if (!open || way != 3) return box.radiance(way);
            double u = std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + 0.5 + turn;
            u -= std::floor(u);
            const int column = std::min(static_cast<int>(u * columns), columns - 1);
            const int row =
                std::min(static_cast<int>(std::acos(d.y) / std::numbers::pi * rows), rows - 1);
            const float* texel = texels.data() + 3 * (row * columns + column);
            return factor * glm::dvec3(texel[0], texel[1], texel[2]);
        };
        test::Random random(7);
        const auto any = [&] { return glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)); };
        for (int trial = 0; trial < 9; ++trial) {
            const glm::dvec3 side = glm::normalize(any()), eye = glm::normalize(side + 0.7 * any());
            if (glm::dot(side, eye) < 0.2) continue;
            lit.of_lobes.eye = glm::vec4(eye, 1.0f);
            Point point{0.5 * any(), side, {0.9, 0.6, 0.3}, 6 + trial % 3, -1};
            glm::dvec3 normal = side;
            while (trial % 2 && (point.mapped == -1 || glm::dot(normal, side) < 0.9)) {
                point.mapped =
                    random.integer(0, 65534) | (random.integer(0, 65534) - 32767) * 65536;
                normal = test::detail_normal(point.mapped);
            }
            const Material& finish = lit.world.materials[static_cast<std::size_t>(point.material)];
            const LobeLight light = lobe_light(finish, normal, eye, [&](const glm::dvec3& d) {
                return glm::dot(d, side) > 0.0 ? sent(point.place, d) : glm::dvec3(0.0);
            });
            const glm::dvec3 wanted = light.white + point.base * light.tint;
            const glm::dvec3 found = lit.reflected({point})[0];
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c], wanted[c], 0.02 * wanted[c]) << open << trial << c;
        }
    }
}

// What is rougher than asked for is left to look-ups, and so is what does not shine.
TEST(Reflect, FollowsSmoothLobesAlone) {
    Box box(false);
    const auto darkness = [&](int material) {
        return box.lit.reflected({{{0, 0, 0}, {0, 1, 0}, glm::dvec3(1.0), material, -1}})[0];
    };
    EXPECT_GT(darkness(6).y, 0.1);
    EXPECT_EQ(darkness(0), glm::dvec3(0.0));
    box.lit.of_lobes.smooth = 0.1f;
    EXPECT_EQ(darkness(6), glm::dvec3(0.0));
}

// Two wide plates one above the other, and a ray between them: E_i, e_i and finish of each.
struct Plates {
    glm::dvec3 base[2] = {{0.9, 0.6, 0.3}, {0.5, 0.8, 0.7}};
    glm::dvec3 emission[2] = {{1, 2, 4}, {3, 1, 2}}, irradiance[2] = {{5, 9, 2}, {4, 3, 8}};
    Material finish[2];
    bool textured = false;  // the plate above, tilted
    glm::dvec3 texel{0.0};

    // What the textures replace.
    static void be_in_the_mean(Material& material) {
        material.roughness = 0.9f;
        material.metallic = 0.0f;
    }

    Scene scene() const {
        Scene out = test::plain_scene();
        out.materials.clear();
        for (int k = 0; k < 2; ++k) {
            Material material = finish[k];
            material.base_color = glm::vec4(glm::vec3(base[k]), 1.0f);
            material.emission = glm::vec3(emission[k]);
            if (k == 1 && textured) {
                be_in_the_mean(material);
                material.metallic_roughness_factor = {1.0f, 1.0f};
                material.metallic_roughness_texture.texture = 0;
                material.normal_texture.texture = 1;
            }
            out.materials.push_back(material);
        }
        add_square(out, {0, 0, 0}, {0, 0, 50}, {50, 0, 0}, 0);
        add_square(out, {0, 1, 0}, {50, 0, 0}, {0, 0, 50}, 1);
        if (textured) {
            out.textures.resize(2);
            const glm::dvec3 texels[] = {{0.0, finish[1].roughness, finish[1].metallic},
                                         0.5 * texel + 0.5};
            for (std::size_t t = 0; t < 2; ++t) {
                Texture& texture = out.textures[t];
                texture.width = texture.height = 1;
                texture.srgb = false;
                for (int c = 0; c < 3; ++c)
                    texture.rgba.push_back(
                        static_cast<std::uint8_t>(std::lround(255.0 * texels[t][c])));
                texture.rgba.push_back(255);
            }
            for (const glm::dvec3& at : out.positions) out.uvs.emplace_back(at.x, at.z, 0.0f, 0.0f);
        }
        return out;
    }

    // Of a ray that leaves the plate below, in exposed units: a path in one direction, as a mirror
    // has it. followed: up to which alpha.
    glm::dvec3 sent(glm::dvec3 d, double exposure, double followed) const {
        glm::dvec3 out(0.0), factor(1.0);
        for (int hop = 0, k = 1; hop < 4; ++hop, k = 1 - k) {
            Material material = finish[k];
            material.base_color = glm::vec4(1.0f);
            const double alpha = std::max(std::pow(double{material.roughness}, 2), 0.01);
            const bool on = hop < 3 && alpha <= followed;
            if (k == 1 && textured && !on) be_in_the_mean(material);
            const Reflectance means = reflectance(material);
            glm::dvec3 share = double{means.diffuse} * base[k];
            if (!on) share += double{means.coat} + double{means.lobe} * base[k];
            out += factor * (emission[k] / exposure + share / std::numbers::pi * irradiance[k]);
            if (!on) break;
            glm::dvec3 normal(0, k ? -1 : 1, 0);
            if (k == 1 && textured) normal = glm::normalize(glm::dvec3(texel.x, -texel.z, texel.y));
            const double away = std::pow(1.0 + glm::dot(normal, d), 5);
            const double index{material.ior}, weight{material.specular}, metal{material.metallic};
            const double f0 = weight * std::pow((1.0 - index) / (1.0 + index), 2);
            factor *= (1.0 - metal) * (f0 + (weight - f0) * away) + metal * away +
                      metal * (1.0 - alpha * alpha) * (1.0 - away) * base[k];
            d = glm::reflect(d, normal);
        }
        return out;
    }
};

// From mirror to mirror, the last as if it were diffuse; a coat over what is diffuse; what is too
// rough to go on from; and where textures say how smooth, how metallic and how tilted it is.
TEST(Reflect, GoesOnFromWhatIsSmooth) {
    for (const int kind : {0, 1, 2, 3, 4, 5}) {
        Plates plates;
        plates.finish[0] = test::finished(1.0f, 0.1f, 1.0f);
        plates.finish[1] =
            test::finished(kind == 1 || kind == 4 ? 0.0f : 1.0f, kind == 2 ? 0.5f : 0.1f, 1.0f);
        if (kind == 5) plates.finish[1].roughness = 153.0f / 255.0f;
        plates.textured = kind > 2;
        if (plates.textured) {
            const glm::dvec3 wanted(kind == 4 ? 0.2 : 0.0, kind == 4 ? -0.1 : 0.0, 0.95);
            for (int c = 0; c < 3; ++c)  // as the texture rounds it
                plates.texel[c] = std::lround(127.5 * (wanted[c] + 1.0)) / 127.5 - 1.0;
        }
        Mirrors lit(plates.scene());
        lit.set_light(2, plates.irradiance[0]);
        lit.set_light(3, plates.irradiance[1]);
        // The last at a slant, where it matters how much is reflected, and how wide lobes are: 1 %.
        const glm::dvec3 eye = glm::normalize(glm::dvec3(0.6, kind == 4 ? 0.25 : 0.8, 0.2)),
                         up(0, 1, 0);
        lit.of_lobes.eye = glm::vec4(eye, 1.0f);
        const glm::dvec3 found = lit.reflected({{{0.2, 0, 0.1}, up, plates.base[0], 0, -1}})[0];
        const double away = std::pow(1.0 - eye.y, 5);
        const glm::dvec3 wanted =
            (away + (1.0 - away) * (1.0 - 1e-4) * plates.base[0]) *
            plates.sent(glm::reflect(-eye, up), lit.scene.frame().exposure, 0.2);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], wanted[c], (kind == 4 ? 0.02 : 0.01) * wanted[c]) << kind << c;
    }
}

// Of neighbouring pixels each sees what it sees alone: a mirror, what is too rough to go on from,
// what does not shine, and nothing.
TEST(Reflect, KeepsPixelsApart) {
    Scene scene = test::plain_scene();
    scene.materials = {test::finished(1.0f, 0.1f, 1.0f), test::finished(1.0f, 0.2f, 1.0f),
                       test::finished(1.0f, 0.6f, 1.0f), test::finished(0.0f, 1.0f, 0.0f)};
    for (std::size_t k = 0; k < 4; ++k)
        scene.materials[k].emission = glm::vec3(1.0f + k, 5.0f - k, 2.0f * k);
    add_square(scene, {0, 0, 0}, {0, 0, 50}, {50, 0, 0}, 0);
    for (std::uint32_t k = 1; k < 4; ++k)
        add_square(scene, {2.0 * k, 1, 0}, {1, 0, 0}, {0, 0, 1}, k);
    Mirrors lit(scene);
    lit.set_light(2, {5, 9, 2});
    lit.set_light(3, {4, 3, 8});
    std::vector<Point> points;
    for (const int k : {3, 1, 2, 0, 2, 1, 3, 3, 0, 1, 2})
        points.push_back({{2.0 * k + 0.1, 0, 0.2}, {0, 1, 0}, {0.9, 0.6, 0.3}, 0, -1});
    const std::vector<glm::dvec3> together = lit.reflected(points);
    for (std::size_t p = 0; p < points.size(); ++p) {
        const glm::dvec3 alone = lit.reflected({points[p]})[0];
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(together[p][c], alone[c], 0.05 * alone[c]) << p << " " << c;
    }
}

// Backs of one-sided surfaces hide what lies behind them and send nothing; of surfaces with two
// sides both send.
TEST(Reflect, ShowsBacksAsTheyAre) {
    for (const bool two_sided : {false, true}) {
        Plates plates;
        plates.finish[0] = test::finished(1.0f, 0.1f, 1.0f);
        plates.finish[1] = test::finished(0.0f, 1.0f);
        Scene scene = plates.scene();
        Material screen = test::finished(0.0f, two_sided ? 1.0f : 0.1f, two_sided ? 0.0f : 1.0f);
        screen.base_color = glm::vec4(0.2f, 0.4f, 0.6f, 1.0f);
        screen.double_sided = two_sided;
        scene.materials.push_back(screen);
        add_square(scene, {0, 0.5, 0}, {0, 0, 5}, {5, 0, 0}, 2);  // looks up
        Mirrors lit(scene);
        lit.set_light(3, {4, 3, 8});
        const glm::dvec3 found = lit.reflected({{{0, 0, 0}, {0, 1, 0}, glm::dvec3(1.0), 0, -1}})[0];
        const glm::dvec3 wanted =
            two_sided ? glm::dvec3(0.2, 0.4, 0.6) / std::numbers::pi * glm::dvec3(4, 3, 8)
                      : glm::dvec3(0.0);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.01 * wanted[c]) << c;
    }
}

// Far from the origin, with surfaces a millimetre apart, no ray meets the surface it leaves.
TEST(Reflect, LeavesItsSurface) {
    Scene scene = test::plain_scene();
    scene.materials[0] = test::finished(1.0f, 0.5f, 1.0f);
    Material lamp = test::finished(0.0f, 1.0f);
    lamp.emission = glm::vec3(5.0f);
    test::add_material(scene, lamp);
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.3, 0.8, -0.5)),
                     u = glm::normalize(glm::cross(up, glm::dvec3(0, 0, 1))), v = glm::cross(up, u),
                     place(40.0, -20.0, 30.0);
    add_square(scene, place, 40.0 * u, 40.0 * v, 0);
    add_square(scene, place + 1e-3 * up, 40.0 * v, 40.0 * u, 1);
    Mirrors lit(scene);
    lit.of_lobes.eye = glm::vec4(up, 1.0f);
    lit.of_lobes.directions = 2048;
    std::vector<Point> points;
    test::Random random(11);
    for (int k = 0; k < 300; ++k)
        points.push_back(
            {place + random(-9, 9) * u + random(-9, 9) * v, up, glm::dvec3(1.0), 0, -1});
    const LobeAlbedo albedo = lobe_albedo(scene.materials[0], up, up);
    const double wanted = (albedo.white + albedo.tint) * 5.0 / lit.scene.frame().exposure;
    for (const glm::dvec3& found : lit.reflected(points))
        EXPECT_NEAR(found.y, wanted, 0.02 * wanted);
}

// What a ray meets is lit by one of two lights, taken twice; the next sample's ray has the other
// one.
TEST(Reflect, ShowsLightsInTurns) {
    Box box(false);
    Mirrors& lit = box.lit;
    std::vector<Emitter> two(2, Emitter{});
    for (Emitter& one : two) {
        one.kind = EMITTER_DIRECTIONAL;
        one.axis = glm::vec4(0.0f, 1.0f, 0.0f, 0.0f);  // on the wall above
    }
    two[0].intensity = glm::vec4(3.0f, 0.0f, 1.0f, 0.0f);
    two[1].intensity = glm::vec4(0.0f, 2.0f, 4.0f, 0.0f);
    lit.emitters.emitters = test::upload(two);
    lit.of_lobes.directions = 1;
    lit.of_lobes.shared = 8;
    const Point point{{0, -0.5, 0}, {0, 1, 0}, glm::dvec3(0.9, 0.6, 0.3), 6, -1};
    const auto found = [&](std::uint32_t lights, std::uint32_t step) {
        lit.params.emitter_count = lights;
        lit.params.emitter_step = step;
        glm::dvec3 sum(0.0);
        for (lit.of_lobes.first_direction = 0; lit.of_lobes.first_direction < 64;
             ++lit.of_lobes.first_direction)
            sum += lit.reflected({point})[0];
        return sum;
    };
    const glm::dvec3 without = found(0, 1), wanted = found(2, 1) - without,
                     in_turns = found(2, 2) - without;
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(wanted[c], 0.0) << c;
        EXPECT_NEAR(in_turns[c], wanted[c], 0.1 * wanted[c]) << c;
    }
}

TEST(Reflect, CountsWhatIsNotFinite) {
    Box box(false);
    box.lit.set_light(3, glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
    const glm::dvec3 found = box.lit.reflected({{{0, 0, 0}, {0, 1, 0}, glm::dvec3(1.0), 6, -1}})[0];
    EXPECT_EQ(found, glm::dvec3(0.0));
    EXPECT_EQ(box.lit.non_finite, 3u);
}

TEST(Reflect, RefusesWhatDoesNotFit) {
    Box box(false);
    const std::vector<Point> one(1, Point{});
    const CacheGlossParams usual = box.lit.of_lobes;
    EXPECT_NO_THROW(box.lit.reflected(one));
    for (const auto& change : std::vector<void (*)(CacheGlossParams&)>{
             [](CacheGlossParams& p) { p.directions = 0; },
             [](CacheGlossParams& p) { p.shared = 0; },
             [](CacheGlossParams& p) { p.sky_width = p.sky_height = 64; }}) {
        box.lit.of_lobes = usual;
        change(box.lit.of_lobes);
        EXPECT_THROW(box.lit.reflected(one), Error);
    }
    box.lit.of_lobes = usual;
    box.lit.params.emitter_step = 0;
    EXPECT_THROW(box.lit.reflected(one), Error);
}

}  // namespace
}  // namespace clgi
