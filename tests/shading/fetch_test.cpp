// Every indirect light of every kind of source, against rays in double precision: where it is, how
// it is turned, which disc it stands for and what it sends on, per channel.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "emitter_reference.hpp"
#include "oblique.hpp"

namespace clgi {
namespace {

using test::PlacedLights;

using std::numbers::pi;

struct LightTruth {
    bool sure = false;  // no edge near by: which triangle is met does not depend on a texel
    bool sends = false;
    glm::dvec3 position{0}, normal{0}, flux{0};
    double radius2 = 0.0;
    double cosine = 1.0;
    double steep = 1.0;  // by how much a cone's edge enlarges what its cosine is off
};

LightTruth light_truth(const Scene& world, const test::RayReference& rays,
                       const PlacedLights& placed, std::size_t light, float scale,
                       float footprint) {
    LightTruth out;
    const EmitterSet& set = placed.set;
    std::size_t e = 0;
    while (e + 1 < set.emitters.size() && light >= set.emitters[e + 1].first_vpl) ++e;
    const Emitter& emitter = set.emitters[e];
    const cl_uint index =
        emitter.kind == EMITTER_SPOT
            ? placed.accepted[light]
            : emitter.first_index + static_cast<cl_uint>(light) - emitter.first_vpl;
    const test::SampleTruth sample = test::sample_truth(emitter, index);
    const double near = double{set.views[emitter.first_view].forward.w};
    const test::Hit hit = rays.first_hit(sample.origin, sample.direction, near);
    // A texel or two beside the sample the same triangle is met.
    const View& view = set.views[emitter.first_view];
    const bool parallel = (emitter.kind & EMITTER_KIND) == EMITTER_DIRECTIONAL;
    const double texel = 4.0 * double{view.right.w} / view.width;
    out.sure = true;
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 aside = texel * test::on_sphere(0.125 * k, 0.5 + 0.11 * (k % 3 - 1));
        const test::Hit beside =
            parallel ? rays.first_hit(sample.origin + aside, sample.direction, near)
                     : rays.first_hit(sample.origin, sample.direction + aside, near);
        out.sure &= beside.triangle == hit.triangle;
    }
    if (hit.triangle < 0) return out;
    const SceneTriangle& triangle = world.triangles[static_cast<std::size_t>(hit.triangle)];
    const Material& material = world.materials[triangle.material];
    out.sends = hit.front || material.double_sided;
    if (!out.sends) return out;
    glm::dvec3 normal(0), colour(0);
    for (int k = 0; k < 3; ++k) {
        normal += hit.weights[k] * glm::dvec3(world.normals[triangle.vertex[k]]);
        colour += hit.weights[k] * glm::dvec3(world.colors[triangle.vertex[k]]);
    }
    out.normal = glm::normalize(hit.front ? normal : -normal);
    if (std::abs(glm::dot(out.normal, sample.direction)) < 0.02)
        out.sure = false;                                // which normal counts is within rounding
    if (glm::dot(out.normal, sample.direction) > 0.0) {  // faces away: the triangle's own
        const auto corner = [&](int k) { return world.positions[triangle.vertex[k]]; };
        const glm::dvec3 across =
            glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        out.normal = hit.front ? across : -across;
    }
    const double slant = -glm::dot(out.normal, sample.direction);
    out.position = sample.origin + hit.distance * sample.direction;
    out.cosine = std::max(slant, 0.01);
    const double falloff = parallel ? 1.0 : test::range_share(hit.distance, double{emitter.range});
    const double area = sample.spread * (parallel ? 1.0 : hit.distance * hit.distance) / out.cosine;
    out.radius2 = double{footprint} * area / pi;
    const Reflectance share = reflectance(material);
    out.flux = sample.flux * colour * glm::dvec3(material.base_color) * double{share.diffuse} *
               falloff * double{scale} * double{emitter.taken_over};
    const double inner = double{emitter.right.w}, outer = double{emitter.axis.w};
    if ((emitter.kind & EMITTER_KIND) == EMITTER_SPOT && sample.along < inner)
        out.steep += 1.0 / std::max(sample.along - outer, 1e-9);
    return out;
}

void expect_truth(const Scene& world, const EmitterOptions& options, float scale, float footprint) {
    const DeviceScene scene = test::on_device(world);
    const PlacedLights placed =
        test::place_lights(scene, options, test::light_passes(), test::gbuffer_passes(),
                           test::FetchScale{scale, footprint});
    const test::RayReference rays(world, scene.frame());
    std::size_t sure = 0, sent = 0;
    constexpr double u = 0x1p-24;
    for (std::size_t l = 0; l < placed.lights.size(); ++l) {
        const LightTruth truth = light_truth(world, rays, placed, l, scale, footprint);
        if (!truth.sure) continue;
        ++sure;
        const Vpl& light = placed.lights[l];
        if (!truth.sends) {
            EXPECT_EQ(light.flux, glm::vec4(0)) << l;
            continue;
        }
        ++sent;
        EXPECT_EQ(light.flux.w, 1.0f) << l;
        // Directions are some 8 spacings off; a slanted surface enlarges that, and barycentric
        // weights are relative to triangles a fifth of the scene's size.
        const double slanted = 64 * u / truth.cosine;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(light.position[c], truth.position[c], slanted) << l;
            EXPECT_NEAR(light.normal[c], truth.normal[c], 8 * slanted) << l;
            EXPECT_NEAR(light.flux[c], truth.flux[c],
                        truth.flux[c] * (16 * slanted + 64 * u * truth.steep))
                << l << " channel " << c;
        }
        const double off = 16 * slanted / truth.cosine;
        EXPECT_NEAR(light.position.w, truth.radius2, truth.radius2 * off) << l;
        EXPECT_NEAR(light.normal.w, truth.radius2 * truth.radius2,
                    truth.radius2 * truth.radius2 * 2 * off)
            << l;
    }
    EXPECT_GT(sure, placed.lights.size() * 3 / 4);
    EXPECT_GT(sent, placed.lights.size() / 5);
}

class Fetch : public testing::TestWithParam<int> {};

TEST_P(Fetch, FollowsEachSampleToItsSurface) {
    Scene world = test::oblique_room();
    const Light lights[] = {test::oblique_spot(), test::oblique_point(), test::oblique_sun(),
                            test::oblique_wide_spot(), test::oblique_thin_spot()};
    const bool area = GetParam() == 5;
    if (area)
        test::add_oblique_lamp(world);
    else
        world.lights = {lights[GetParam()]};
    EmitterOptions options{.vpls = 400, .shadow_size = 512, .face_size = 256, .area_samples = 3};
    expect_truth(world, options, 1.0f, 1.0f);
    options.replicate = 5;  // with shifts
    expect_truth(world, options, 1.7f, 0.6f);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Fetch, testing::Range(0, 6));

// Each source has a part of the list; directions of an environment and samples of an emissive
// surface share what one light stands for.
TEST(Fetch, KeepsSourcesApart) {
    Scene world = test::oblique_scene();
    world.lights.pop_back();  // the thin one lights a single place
    world.environment = Environment{};
    world.environment->factor = {0.2f, 0.4f, 0.3f};
    expect_truth(world,
                 {.vpls = 900, .shadow_size = 512, .area_samples = 4, .environment_lights = 5},
                 1.0f, 1.0f);
}

// Lamps too weak for a light leave their power to the others.
TEST(Fetch, HandsOverTheLightOfWeakSources) {
    Scene world = test::oblique_room();
    world.lights.assign(31, test::oblique_point());
    for (std::size_t l = 1; l < 31; ++l) world.lights[l].intensity *= 0.01f;
    const EmitterOptions options{.vpls = 40, .face_size = 128};
    EXPECT_GT(make_emitters(test::on_device(world), options).emitters[0].taken_over, 1.01f);
    expect_truth(world, options, 1.0f, 1.0f);
}

// Surfaces that light falls along: the disc they stand for is bounded at a cosine of 0.01.
TEST(Fetch, BoundsTheDiscOfGrazingLight) {
    Scene world = test::plain_scene({0.2f, 0.5f, 0.8f});
    test::add_floor(world, 5.0);
    for (glm::vec3& normal : world.normals) normal = glm::normalize(glm::vec3(0.02f, 1, 0.01f));
    world.colors.assign(world.positions.size(), glm::vec4(1.0f, 0.7f, 0.4f, 1.0f));
    for (const float rise : {0.004f, 0.03f}) {
        world.lights = {test::directional_light({0.9f, -rise, 0.4f}, 2.0f)};
        const DeviceScene scene = test::on_device(world);
        const PlacedLights placed = test::place_lights(scene, {.vpls = 3000, .shadow_size = 2048});
        const Emitter& sun = placed.set.emitters[0];
        std::size_t lit = 0;
        for (const Vpl& light : placed.lights) {
            if (light.flux.w == 0.0f) continue;
            ++lit;
            const double cosine =
                std::max(-glm::dot(glm::dvec3(light.normal), glm::dvec3(sun.axis)), 0.01);
            EXPECT_NEAR(light.position.w, double{sun.area} / cosine / pi,
                        1e-4 * double{light.position.w});
        }
        EXPECT_GT(lit, 5u) << rise;
    }
}

// Where the cone holds fewer candidates than lights, the list ends in zeros: index 0 is no sample.
TEST(Fetch, LeavesOutCandidatesThatWereNotFound) {
    Scene world = test::oblique_room();
    world.lights = {test::spot_light({0.1, 0.1, 0.2}, {0.05f, -0.1f, -1}, 0.8)};
    const DeviceScene scene = test::on_device(world);
    const EmitterSet set = make_emitters(scene, {.vpls = 20, .shadow_size = 64});
    const RasterBuffers buffers = test::raster_buffers(scene, set.pixels);
    for (const View& view : set.views)
        test::draw_visibility(test::gbuffer_passes(), scene, view, buffers);
    const cl::Buffer lights = test::empty<Vpl>(20);
    test::light_passes().fetch(
        test::device().queue, {20, 1, 1.0f, 1.0f}, scene,
        {test::upload(set.emitters), test::upload(set.views), buffers.pixels},
        test::upload(std::vector<cl_uint>(20)), lights);
    const auto found = test::download<Vpl>(lights, 20);
    for (const Vpl& light : found) EXPECT_EQ(light.flux, glm::vec4(0));
}

std::vector<bool> in_cone(const Emitter& e, cl_uint candidates, std::vector<bool>* sure) {
    std::vector<bool> out;
    for (cl_uint index = 1; index <= candidates; ++index) {
        const glm::dvec3 s = test::on_sphere(test::halton(index, 2, double{e.shift.x}),
                                             test::halton(index, 3, double{e.shift.y}));
        const double over = glm::dot(s, glm::dvec3(e.axis)) - double{e.axis.w};
        out.push_back(over >= 0.0);
        sure->push_back(std::abs(over) > 8 * 0x1p-24);
    }
    return out;
}

// Mask and list of several spots, with shifts, each in its part of the list.
TEST(Accept, TakesTheFirstCandidatesInsideTheCone) {
    test::Random random(41);
    for (const cl_uint candidates : {32u, 96u, 4096u, 20000u}) {
        std::vector<Emitter> emitters(3);
        for (Emitter& e : emitters) {
            e.axis = glm::vec4(test::random_direction(random), std::cos(random(0.2, 1.2)));
            for (int d = 0; d < 4; ++d) e.shift[d] = static_cast<float>(random(0, 1));
            e.vpl_count = static_cast<cl_uint>(random.integer(1, 300));
        }
        emitters[1].first_vpl = emitters[0].vpl_count;
        emitters[2].first_vpl = emitters[1].first_vpl + emitters[1].vpl_count;
        const cl_uint all = emitters[2].first_vpl + emitters[2].vpl_count;
        const cl::Buffer device_emitters = test::upload(emitters);
        // Longer than needed, and filled from its end: what is written past a part would stay.
        std::vector<cl_uint> wanted(all + 64, 77u);
        const cl::Buffer accepted = test::upload(wanted);
        for (const cl_uint e : {2u, 1u, 0u}) {
            const AcceptParams params{e, candidates, all, 0};
            const cl::Buffer mask = test::empty<cl_uint>(candidates / 32);
            test::light_passes().accept_mask(test::device().queue, params, device_emitters, mask);
            test::light_passes().accept_list(test::device().queue, params, device_emitters, mask,
                                             accepted);
            const auto words = test::download<cl_uint>(mask, candidates / 32);
            std::vector<bool> sure;
            const std::vector<bool> inside = in_cone(emitters[e], candidates, &sure);
            for (cl_uint k = 0; k < candidates; ++k)
                EXPECT_TRUE(!sure[k] || (words[k / 32] >> k % 32 & 1) == inside[k]) << k;
            cl_uint* part = &wanted[emitters[e].first_vpl];
            cl_uint taken = 0;
            for (cl_uint k = 0; k < candidates && taken < emitters[e].vpl_count; ++k)
                if (words[k / 32] >> k % 32 & 1) part[taken++] = k + 1;
            std::fill(part + taken, part + emitters[e].vpl_count, 0u);
        }
        EXPECT_EQ(test::download<cl_uint>(accepted, all + 64), wanted) << candidates;
    }
}

}  // namespace
}  // namespace clgi
