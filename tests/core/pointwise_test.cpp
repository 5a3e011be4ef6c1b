// Direct light point by point: the library, the path tracer and the formulas of glTF 2.0
// and KHR_lights_punctual, each written apart from the others, agree in every channel.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "frames.hpp"
#include "kernel_text.hpp"
#include "lighting.hpp"
#include "microfacet.hpp"
#include "reference/bsdf.hpp"
#include "reference/lights.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double u = 0x1p-24;

// Metallic and roughness of twelve materials, each of another colour; some reflect more, some less
// white.
constexpr float metals[] = {0.0f, 0.35f, 1.0f}, roughs[] = {0.12f, 0.3f, 0.6f, 1.0f};

// A tilted board of twelve fields, two metres across.
Scene board() {
    Scene scene = test::plain_scene();
    scene.materials.clear();
    const auto place = [](double x, double y) {
        return glm::dvec3(x - 1.0, 0.3 * x + 0.2 * y - 0.5, 1.0 - y);
    };
    for (int m = 0; m < 3; ++m)
        for (int r = 0; r < 4; ++r) {
            Material material;
            material.metallic = metals[m];
            material.roughness = roughs[r];
            material.specular = r == 2 ? 0.7f : 1.0f;
            material.ior = m == 1 ? 2.2f : 1.5f;
            material.base_color = {0.9f - 0.2f * static_cast<float>(m), 0.35f,
                                   0.15f + 0.2f * static_cast<float>(r), 1.0f};
            const std::uint32_t at = test::add_material(scene, material);
            const double x = 0.5 * r, y = 2.0 / 3.0 * m;
            test::add_quad(scene,
                           {place(x, y), place(x + 0.5, y), place(x + 0.5, y + 2.0 / 3.0),
                            place(x, y + 2.0 / 3.0)},
                           at);
        }
    return scene;
}

// Irradiance at normal incidence and the direction it comes from, as KHR_lights_punctual has it.
struct Incident {
    glm::dvec3 toward, lux;
    glm::dvec3 bare = lux;  // without cone and range
    double slack = 0.0;     // of the share that cone and range let through
    bool at_edge = false;   // of a cone or a range: rounding may decide
};

Incident arriving(const Light& light, const glm::dvec3& point) {
    if (light.kind == Light::Kind::directional)
        return {-glm::normalize(glm::dvec3(light.direction)), glm::dvec3(light.intensity)};
    const glm::dvec3 apart = light.position - point;
    const double distance = glm::length(apart);
    Incident out{apart / distance, glm::dvec3(light.intensity) / (distance * distance)};
    if (light.kind == Light::Kind::spot) {
        const double outer = std::cos(double{light.outer_angle});
        const double inner = std::cos(double{light.inner_angle});
        const double cosine = glm::dot(-out.toward, glm::normalize(glm::dvec3(light.direction)));
        const double width = std::max(inner - outer, 1e-9);
        const double linear = std::clamp((cosine - outer) / width, 0.0, 1.0);
        out.lux *= linear * linear;
        out.at_edge = std::abs(cosine - outer) < 1e-5;
        if (inner > outer) out.slack += 16 * u * 2 * linear / width;  // 16 roundings of a cosine
    }
    if (light.range > 0.0f) {
        out.lux *= std::max(1.0 - std::pow(distance / double{light.range}, 4), 0.0);
        out.at_edge = out.at_edge || std::abs(distance - light.range) < 1e-5;
        out.slack += 4 * 16 * u;  // of the fourth power of a distance
    }
    return out;
}

// Of light that arrives.
test::GltfReflected reflected(const Material& material, const glm::dvec3& normal,
                              const glm::dvec3& viewer, const Incident& light) {
    test::GltfReflected out = test::gltf_reflected(material, glm::dvec3(material.base_color),
                                                   normal, viewer, light.toward);
    const glm::dvec3 irradiance = light.lux * std::max(glm::dot(normal, light.toward), 0.0);
    out.diffuse *= irradiance;
    out.gloss *= irradiance;
    return out;
}

std::vector<Light> lamps() {
    Light point = test::point_light({0.3, 1.1, -0.2});
    Light ranged = test::point_light({-0.6, 0.9, 0.5});
    ranged.range = 1.9f;
    Light spot = test::spot_light({0.2, 1.4, 0.1}, {0.1, -1, 0.2}, 0.65);
    spot.inner_angle = 0.25f;
    spot.range = 2.6f;
    Light hard = test::spot_light({-0.4, 1.3, 0.6}, {0.3, -1, -0.4}, 0.5);
    const Light sun = test::directional_light({-0.3, -1.0, 0.45});
    std::vector<Light> out{point, ranged, spot, hard, sun};
    for (Light& light : out) light.intensity = {3.0f, 11.0f, 5.0f};
    return out;
}

std::string lamp_name(const testing::TestParamInfo<std::size_t>& info) {
    const char* names[] = {"point", "range", "spot", "edge", "sun"};
    return names[info.param];
}

class Pointwise : public testing::TestWithParam<std::size_t> {};

TEST_P(Pointwise, LibraryAndPathTracerReflectWhatTheDocumentSays) {
    Scene scene = board();
    scene.lights = {lamps()[GetParam()]};
    const Light& light = scene.lights[0];
    const reference::Geometry geometry(scene);
    const reference::Lights reference_lights(scene, geometry);
    const glm::dvec3 normal(scene.normals[0]);
    std::size_t checked = 0, dark = 0, glossy = 0;
    double library = 0.0, tracer = 0.0;  // worst errors in units of the bound
    for (const bool orthographic : {false, true}) {
        Camera camera = test::camera_at({0.4, 2.2, 2.1}, {0.0, -0.1, 0.0}, 0.8f);
        camera.kind = orthographic ? Camera::Kind::orthographic : Camera::Kind::perspective;
        camera.half_height = 1.2f;
        SecondOrderOptions options;
        options.width = 121;
        options.height = 93;
        options.indirect = false;
        options.emitters.shadow_size = 512;
        const test::Frame frame = test::render(scene, camera, options);
        const test::Drawing drawing = test::draw(scene, camera, 121, 93);
        for (std::size_t p = 0; p < frame.pixels; ++p) {
            if (drawing.triangle(p) < 0) continue;
            const glm::dvec3 at = frame.world(p);
            const Incident incident = arriving(light, at);
            if (incident.at_edge) continue;
            const auto triangle = static_cast<std::uint32_t>(drawing.triangle(p));
            const Material& material = scene.materials[scene.triangles[triangle].material];
            const glm::dvec3 viewer = orthographic ? -glm::normalize(glm::dvec3(camera.forward))
                                                   : glm::normalize(camera.position - at);
            const test::GltfReflected wanted = reflected(material, normal, viewer, incident);
            ++checked;
            dark += wanted.diffuse == glm::dvec3(0.0);
            glossy += wanted.gloss.y > 0.2 * wanted.diffuse.y;

            Incident bare = incident;
            bare.lux = incident.bare;
            const test::GltfReflected open = reflected(material, normal, viewer, bare);

            // What the path tracer makes of the same point.
            reference::Surface surface =
                reference::surface_at(geometry, {triangle, 0.3f, 0.3f}, glm::vec3(-viewer));
            const reference::Bsdf bsdf(surface, glm::vec3(viewer));
            const auto arrival = reference_lights.from_lamp(0, geometry.to_local(at));
            glm::dvec3 traced(0.0);
            if (arrival) {
                traced = glm::dvec3(bsdf.reflected(arrival->direction)) *
                         glm::dvec3(arrival->irradiance) *
                         std::max(glm::dot(normal, glm::dvec3(arrival->direction)), 0.0);
            }
            for (int c = 0; c < 3; ++c) {
                // Some 40 roundings, in distances and cones a few times as large; a cosine's 8
                // count as often as the lobe enlarges it.
                const double bound = 160 * u * (wanted.diffuse[c] + wanted.gloss[c]) +
                                     16 * u * wanted.steep * wanted.gloss[c] +
                                     incident.slack * (open.diffuse[c] + open.gloss[c]) + 1e-9;
                library = std::max(
                    library,
                    std::abs(frame.radiance[p][c] - wanted.diffuse[c] - wanted.gloss[c]) / bound);
                tracer = std::max(
                    tracer, std::abs(traced[c] - wanted.diffuse[c] - wanted.gloss[c]) / bound);
            }
        }
    }
    EXPECT_LT(library, 1.0);
    EXPECT_LT(tracer, 1.0);
    EXPECT_GT(checked, 5000u);
    EXPECT_GT(glossy, 100u);
    if (light.range > 0.0f || light.kind == Light::Kind::spot) {
        EXPECT_GT(dark, 50u);
    }
    RecordProperty("library", std::to_string(library));
    RecordProperty("tracer", std::to_string(tracer));
}

INSTANTIATE_TEST_SUITE_P(Lamps, Pointwise, testing::Range<std::size_t>(0, 5), lamp_name);

// The functions that VPLs are placed with, over all angles and distances.
TEST(Falloff, IsThatOfTheStandardAndThePathTracer) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    std::vector<glm::vec4> cones;
    std::vector<float> ranges;
    std::vector<double> wanted_cone, wanted_range;
    test::Random random(71);
    for (int i = 0; i < 4000; ++i) {
        Light light = test::spot_light({0, 0, 0}, {0, 0, -1}, random(0.05, 1.5));
        light.inner_angle = light.outer_angle * static_cast<float>(random(0.0, 0.99));
        if (i % 7 == 0) light.inner_angle = light.outer_angle;
        light.range = i % 5 == 0 ? 0.0f : static_cast<float>(random(0.3, 3.0));
        const double angle = random(0.0, 1.2) * light.outer_angle, distance = random(0.05, 3.5);
        const double cosine = std::cos(angle), outer = std::cos(double{light.outer_angle}),
                     inner = std::cos(double{light.inner_angle});
        const bool ended = light.range > 0.0f && distance > light.range;
        if (std::abs(cosine - outer) < 1e-5 ||
            (light.range > 0.0f && std::abs(distance - light.range) < 1e-5))
            continue;
        cones.emplace_back(cosine, outer, inner, distance);
        ranges.push_back(light.range);
        const double linear = std::clamp((cosine - outer) / std::max(inner - outer, 1e-9), 0., 1.);
        wanted_cone.push_back(linear * linear);
        wanted_range.push_back(light.range == 0.0f ? 1.0
                               : ended             ? 0.0
                                                   : 1 - std::pow(distance / light.range, 4));
        scene.lights = {light};
        const reference::Geometry geometry(scene);
        const reference::Lights lights(scene, geometry);
        const glm::dvec3 at = distance * glm::dvec3(std::sin(angle), 0, -std::cos(angle));
        const auto arrival = lights.from_lamp(0, geometry.to_local(at));
        const double traced = arrival ? double{arrival->irradiance.x} * distance * distance : 0.0;
        // Positions of the path tracer are floats: their angles too.
        const double slope = 2 * linear / std::max(inner - outer, 1e-9);
        if (slope < 1e3) {
            EXPECT_NEAR(traced, wanted_cone.back() * wanted_range.back(), (64 + 8 * slope) * 4 * u)
                << i;
        }
    }
    const test::Device& on = test::device();
    cl::Program program(on.context, test::kernel_text("tests/support/falloff.cl"));
    program.build(on.device, "-cl-std=CL1.2");
    cl::Kernel kernel(program, "sample_falloffs");
    const cl::Buffer asked = test::upload(cones), held = test::upload(ranges);
    const cl::Buffer shares = test::empty<glm::vec2>(cones.size());
    kernel.setArg(0, asked);
    kernel.setArg(1, held);
    kernel.setArg(2, shares);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(cones.size()));
    const auto found = test::download<glm::vec2>(shares, cones.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        // Cosines are rounded once each, and their difference divides.
        const double width = std::max(double{cones[i].z} - double{cones[i].y}, 1e-6);
        EXPECT_NEAR(found[i].x, wanted_cone[i], 8 * u / width) << i;
        EXPECT_NEAR(found[i].y, wanted_range[i], 16 * u) << i;
    }
}

}  // namespace
}  // namespace clgi
