// Glossy leaves of scenes: what they make of direct light, where they meet, and what scenes without
// them cost.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "glossy_scenes.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"

namespace clgi {
namespace {

using test::antiradiance_options;
using test::GlossyPicture;
using test::lobe_albedo_at;
using test::metal;

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(GlossyLeaves);

// A tilted sheet of metal, glossy on both sides, and a shelf over a part of it.
Scene sheet(const Light* light) {
    Scene scene = test::plain_scene(glm::vec3(0.0f));
    Material both = metal({0.9f, 0.5f, 0.2f}, 0.4f);
    both.double_sided = true;
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0.3, 1}, {1, 0.3, -1}, {-1, 0, -1}},
                   test::add_material(scene, both));
    test::add_quad(
        scene,
        {glm::dvec3(-1.5, 0.5, 1.5), {-0.4, 0.5, 1.5}, {-0.4, 0.5, -1.5}, {-1.5, 0.5, -1.5}});
    if (light) {
        scene.lights = {*light};
        scene.lights[0].intensity = {3.0f, 5.0f, 7.0f};
    } else {
        Material lamp;
        lamp.emission = {30.0f, 50.0f, 70.0f};
        test::add_quad(
            scene, {glm::dvec3(0.9, 2.0, -0.1), {1.1, 2.0, -0.1}, {1.1, 2.0, 0.1}, {0.9, 2.0, 0.1}},
            test::add_material(scene, lamp));
    }
    scene.cameras = {test::camera_at({0, 2, 2}, {0, 0, 0})};
    return scene;
}

// Lights of every kind: the lobe reflects its colour and albedo of what arrives at the sample
// points, about the mirrored direction; nothing in the shadow and on the other side.
TEST_P(GlossyLeaves, ReflectDirectLight) {
    const Light point = test::point_light({1.0, 2.0, 0.0});
    const Light spot = test::spot_light({1.0, 2.0, 0.0}, {-0.3f, -1.0f, 0.0f}, 1.2);
    const Light sun = test::directional_light({-0.3f, -1.0f, 0.2f});
    const Light* none = nullptr;
    using std::pair;
    for (const auto& [light, form] :
         {pair(&point, Form::packets), pair(&spot, Form::packets), pair(&sun, Form::packets),
          pair(none, Form::packets), pair(&spot, Form::groups)}) {
        const Scene scene = sheet(light);
        AntiradianceOptions options = antiradiance_options(GetParam(), 128, 200);
        options.build.form = form;
        options.emitters.area_samples = 1;
        options.emitters.shadow_size = 1024;
        options.steps = 1;
        GlossyPicture shown(scene, options);
        ASSERT_TRUE(shown.solver.run());
        const AntiradianceSolver& solver = shown.solver;
        const ElementTree& tree = solver.elements();
        const std::size_t count = solver.gloss().count;
        ASSERT_GT(count, 100u);
        const auto leaves = test::download<GlossyLeaf>(solver.gloss().leaves, count);
        const auto rows = test::download<float>(solver.gloss().sources, count * 3 * 128);
        const auto colors = test::download<glm::vec4>(solver.gloss().colors, count);
        const auto sources = test::download<glm::vec4>(solver.leaves().sources, tree.leaves);
        const auto elements = test::download<Element>(solver.links().elements, tree.count());
        const Reflectance shares = reflectance(test::finished(1.0f, 0.4f));
        const std::vector<float> curve =
            lobe_albedos(double{surface_of(test::finished(1.0f, 0.4f)).y});
        const double exposure = shown.scene.frame().exposure;
        int lit = 0, dark = 0, exact = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint32_t i = leaves[k].element;
            const glm::dvec3 n = tree.normals[i], scaled(elements[i].normal);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(colors[k][c],
                            shares.lobe * (c == 0   ? 0.9
                                           : c == 1 ? 0.5
                                                    : 0.2) +
                                shares.coat,
                            1e-6);
            glm::dvec3 power(0.0), middle(0.0);
            for (std::size_t b = 0; b < 128; ++b) {
                const glm::dvec3 w = solver.bins().directions[b];
                const double projected = solver.bins().solid_angles[b] * glm::dot(scaled, w);
                for (std::size_t c = 0; c < 3; ++c) {
                    const double leaves_here = rows[(3 * k + c) * 128 + b];
                    if (projected <= 0.0) {
                        EXPECT_EQ(leaves_here, 0.0);
                    }
                    power[static_cast<int>(c)] += exposure * std::max(projected, 0.0) * leaves_here;
                }
                middle += double(rows[3 * k * 128 + b]) * w;
            }
            // What arrives, from what is reflected diffusely.
            const glm::dvec3 diffuse = exposure * pi * glm::dvec3(sources[leaves[k].row]) /
                                       (double{shares.diffuse} * glm::dvec3(0.9, 0.5, 0.2));
            if (diffuse.x == 0.0) {
                EXPECT_EQ(power, glm::dvec3(0.0));
                ++dark;
                continue;
            }
            const auto& [p, q, r] = tree.corners[i];
            double reflected = 0.0, arrives = 0.0;
            glm::dvec3 mirror(0.0);
            for (const glm::dvec3& at : {(p + q + r) / 3.0, (4.0 * p + q + r) / 6.0,
                                         (p + 4.0 * q + r) / 6.0, (p + q + 4.0 * r) / 6.0}) {
                const glm::dvec3 to = light == &sun ? glm::normalize(glm::dvec3(0.3, 1.0, -0.2))
                                                    : glm::dvec3(1, 2, 0) - at;
                const double cosine = glm::dot(n, glm::normalize(to));
                const double here = cosine / glm::dot(to, to);
                arrives += here;
                reflected += here * lobe_albedo_at(curve, cosine);
                mirror += here * (2.0 * cosine * n - glm::normalize(to));
            }
            // Leaves at the edge of the shadow, or of the spot's cone, are lit at some points.
            const double wanted = colors[k].x * reflected / arrives * diffuse.x;
            EXPECT_NEAR(power.x, wanted, 0.05 * wanted) << k;
            if (std::abs(power.x - wanted) < 1e-4 * wanted) ++exact;
            for (int c = 1; c < 3; ++c)
                EXPECT_NEAR(power[c] / power.x,
                            colors[k][c] * diffuse[c] / (double{colors[k].x} * diffuse.x), 1e-4);
            EXPECT_GT(glm::dot(glm::normalize(middle), glm::normalize(mirror)), 0.97) << k;
            ++lit;
        }
        EXPECT_GT(lit, 40);
        EXPECT_GT(dark, 50);
        // An emissive surface is a disc: its light falls off otherwise where it is near.
        EXPECT_GT(exact, light ? 40 : -1);
    }
}

// The light of several emitters adds up, each with its colour.
TEST_P(GlossyLeaves, AddUpTheLightOfEmitters) {
    const Light point = test::point_light({1.0, 2.0, 0.0}), other = test::point_light({-0.5, 1, 2});
    AntiradianceOptions options = antiradiance_options(GetParam(), 64, 100);
    options.steps = 1;
    const auto rows = [&](const Scene& scene) {
        GlossyPicture shown(scene, options);
        EXPECT_TRUE(shown.solver.run());
        auto out = test::download<float>(shown.solver.gloss().sources,
                                         shown.solver.gloss().count * std::size_t{3} * 64);
        for (float& radiance : out) radiance *= static_cast<float>(shown.scene.frame().exposure);
        return out;
    };
    Scene first = sheet(&point), second = sheet(&other), both = sheet(&point);
    second.lights[0].intensity = {11.0f, 1.0f, 2.0f};
    both.lights.push_back(second.lights[0]);
    const std::vector<float> one = rows(first), two = rows(second), sum = rows(both);
    ASSERT_EQ(sum.size(), one.size());
    int of_both = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        EXPECT_NEAR(sum[i], one[i] + two[i], 1e-6f + 1e-5f * sum[i]) << i;
        if (one[i] > 0.0f && two[i] > 0.0f) ++of_both;
    }
    EXPECT_GT(of_both, 100);
}

// Vertices have the mean of their glossy leaves alone, by area.
TEST_P(GlossyLeaves, ShareTheirVerticesAmongThemselves) {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}},
                   test::add_material(scene, metal({0.9f, 0.5f, 0.2f}, 0.4f)));
    test::add_quad(scene, {glm::dvec3(1, 0, 1), {3, 0, 1}, {3, 0, -1}, {1, 0, -1}});
    scene.environment = Environment();
    scene.environment->factor = {2.0f, 3.0f, 5.0f};
    scene.cameras = {test::camera_at({0, 2, 2}, {0, 0, 0})};
    GlossyPicture shown(scene, antiradiance_options(GetParam(), 64, 40));
    ASSERT_TRUE(shown.solver.run());
    const GlossBuffers& gloss = shown.solver.gloss();
    ASSERT_GT(gloss.count, 5u);
    ASSERT_LT(gloss.count, shown.solver.elements().leaves / 2);
    std::vector<float> arriving(gloss.count * std::size_t{3} * 64);
    for (std::size_t i = 0; i < arriving.size(); ++i) arriving[i] = std::sin(1.0f + float(i));
    test::device().queue.enqueueWriteBuffer(gloss.arriving, CL_TRUE, 0,
                                            arriving.size() * sizeof(float), arriving.data());
    AntiradianceGlossPasses(test::programs(), 64, {.math = GetParam()})
        .vertices(test::device().queue, gloss)
        .wait();
    const auto light = test::download<float>(gloss.light, gloss.vertex_count * std::size_t{3} * 64);
    const ElementTree& tree = shown.solver.elements();
    const auto leaves = test::download<GlossyLeaf>(gloss.leaves, gloss.count);
    const auto patches = test::download<PatchCorners>(shown.solver.surface().patches, tree.count());
    const auto of_vertex =
        test::download<std::uint32_t>(gloss.rows, shown.solver.surface().vertex_count);
    std::size_t without = 0;
    for (std::uint32_t vertex = 0; vertex < of_vertex.size(); ++vertex) {
        if (of_vertex[vertex] == ELEMENT_NONE) {
            ++without;
            continue;
        }
        for (std::size_t b = 0; b < 3 * 64; b += 17) {
            double sum = 0.0, area = 0.0;
            for (std::size_t k = 0; k < leaves.size(); ++k)
                for (const std::uint32_t corner : patches[leaves[k].element].vertex)
                    if (corner == vertex) {
                        sum += tree.areas[leaves[k].element] * arriving[k * 3 * 64 + b];
                        area += tree.areas[leaves[k].element];
                    }
            EXPECT_NEAR(light[of_vertex[vertex] * std::size_t{3} * 64 + b], sum / area, 1e-6);
        }
    }
    EXPECT_GT(without, 5u);
}

// Scenes without lobes run no pass and hold no buffer for them; nor do those whose lobes are too
// weak for the option.
CLGI_IN_ALL_MODES(ScenesOfLobes);

TEST_P(ScenesOfLobes, CostNothingWhereThereAreNone) {
    const Scene scene = test::furnished_room(5);
    AntiradianceOptions options = antiradiance_options(GetParam(), 32, 300);
    const Programs programs(test::device().context, test::device().device);
    const DeviceScene device = test::on_device(scene);
    AntiradianceSolver plain(programs, test::device().queue, scene, device, options);
    EXPECT_EQ(plain.gloss().count, 0u);
    EXPECT_EQ(plain.gloss().leaves(), nullptr);
    const std::size_t kernels = programs.built();
    Scene metals = scene;
    metals.materials[1] = metal({0.5f, 0.5f, 0.5f}, 0.5f);
    const DeviceScene metal_device = test::on_device(metals);
    options.least_gloss = 1.0;
    AntiradianceSolver off(programs, test::device().queue, metals, metal_device, options);
    EXPECT_EQ(off.bytes(), plain.bytes());
    EXPECT_EQ(programs.built(), kernels);
    options.least_gloss = 1e-4;
    AntiradianceSolver on(programs, test::device().queue, metals, metal_device, options);
    EXPECT_GT(on.gloss().count, 5u);
    EXPECT_LT(on.gloss().count, on.elements().leaves);
    EXPECT_GT(on.bytes(), plain.bytes());
    EXPECT_EQ(programs.built(), kernels + 4);
    GlossyPicture shown(scene, options), glossy(metals, options);
    for (GlossyPicture* of : {&shown, &glossy}) {
        of->solver.run();
        of->picture(test::camera_at({0.2, 1.2, 0.2}, {2, 1, 1.5}));
    }
    std::set<std::string> more;
    for (const std::string& pass : glossy.passes())
        if (shown.passes().count(pass) == 0) more.insert(pass);
    EXPECT_EQ(more,
              (std::set<std::string>{"antiradiance.gloss_sources", "antiradiance.gloss",
                                     "antiradiance.gloss_vertices", "antiradiance.show_gloss"}));
}

}  // namespace
}  // namespace clgi
