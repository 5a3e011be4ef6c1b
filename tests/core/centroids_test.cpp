// A solver made of the kit alone: direct light at the centroids of a scene's triangles.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "device.hpp"
#include "patchwork.hpp"
#include "places.hpp"

namespace clgi {
namespace {

// Owns its buffers; memory, recording, shadow maps and direct light come from the kit.
class CentroidSolver {
public:
    CentroidSolver(const cl::CommandQueue& queue, const DeviceScene& scene,
                   const EmitterOptions& options)
        : queue_(queue),
          scene_(scene),
          count_(scene.info().triangle_count),
          stride_(plane_stride(count_)),
          gbuffer_(test::device().context, test::device().device),
          lights_(test::device().context, test::device().device),
          emitters_(scene, options, Pixels::depth),
          record_(queue, "centroids") {
        const std::size_t word = sizeof(std::uint32_t);
        BufferTable table("centroids");
        emitters_.add_to(table);
        add_raster_lists(table, lists_, scene, 6);
        table.add(samples_, "samples", "the scene's triangles", count_ * sizeof(SurfaceSample));
        table.add(points_.planes, "planes", "the scene's triangles",
                  gbuffer_bytes(Storage::full, stride_));
        table.add(points_.ids, "ids", "the scene's triangles", GBUFFER_ID_PLANES * stride_ * word);
        table.add(irradiance_, "irradiance", "the scene's triangles",
                  irradiance_bytes(Storage::full, stride_));
        table.add_word(non_finite_, "counters", 0);
        table.check(test::device().device, 0, scene.bytes());
        table.allocate(record_);
        emitters_.write(record_);
        std::vector<SurfaceSample> samples;
        for (std::uint32_t t = 0; t < count_; ++t)
            samples.push_back({t, 1.0f / 3.0f, 1.0f / 3.0f, 0.0f});
        record_.write(samples_, samples.data(), count_ * sizeof(SurfaceSample));
    }

    // Shadow maps, points of the surface, direct light at them.
    cl::Event render(const WaitList& wait = {}) {
        record_.begin(wait);
        emitters_.draw(record_, gbuffer_, lists_);
        record_("gbuffer.surface", count_, [&](const WaitList& before) {
            return gbuffer_.surface(queue_, scene_, {count_, stride_, 0, 0}, samples_, points_, {},
                                    before);
        });
        const auto emitters = static_cast<std::uint32_t>(emitters_.set().emitters.size());
        const DirectParams params{stride_, count_, emitters, 1.0f, 1, 0, 0, 0};
        record_("lights.direct", count_, [&](const WaitList& before) {
            return lights_.direct(queue_, params, emitters_.buffers(), points_.planes, irradiance_,
                                  non_finite_, before);
        });
        return record_.last();
    }

    // [triangle_count] lux, by the scene's triangles.
    std::vector<glm::vec3> irradiance() {
        render().wait();
        const auto planes = test::download<float>(irradiance_, IRRADIANCE_PLANES * stride_);
        std::vector<glm::vec3> out(count_);
        const float exposure = static_cast<float>(scene_.frame().exposure);
        for (std::size_t t = 0; t < count_; ++t)
            for (int c = 0; c < 3; ++c)
                out[scene_.triangle_order()[t]][c] = planes[c * stride_ + t] * exposure;
        return out;
    }
    // Of the emitters before a number, and of those from it on, added to that.
    std::vector<float> in_two(std::uint32_t parted) {
        render().wait();
        const auto emitters = static_cast<std::uint32_t>(emitters_.set().emitters.size());
        for (const std::uint32_t first : {0u, parted}) {
            const DirectParams params{stride_, count_, first == 0 ? parted : emitters - parted,
                                      1.0f,    1,      first == 0 ? 0u : std::uint32_t{DIRECT_ADD},
                                      first,   0};
            lights_.direct(queue_, params, emitters_.buffers(), points_.planes, irradiance_,
                           non_finite_);
        }
        const DirectParams past{stride_, count_, emitters, 1.0f, 1, 0, parted, 0};
        EXPECT_THROW(lights_.direct(queue_, past, emitters_.buffers(), points_.planes, irradiance_,
                                    non_finite_),
                     Error);
        return test::download<float>(irradiance_, IRRADIANCE_PLANES * stride_);
    }
    // What is left of the light if twice of it is put there and once of it taken away.
    std::vector<float> twice_less_once() {
        render().wait();
        const auto emitters = static_cast<std::uint32_t>(emitters_.set().emitters.size());
        for (const std::uint32_t add : {DIRECT_ADD, DIRECT_TAKE}) {
            const DirectParams params{stride_, count_, emitters, 1.0f, 1, add, 0, 0};
            lights_.direct(queue_, params, emitters_.buffers(), points_.planes, irradiance_,
                           non_finite_);
        }
        return test::download<float>(irradiance_, IRRADIANCE_PLANES * stride_);
    }
    std::uint32_t non_finite() const { return record_.read_word(non_finite_); }
    const Recorder& record() const { return record_; }

private:
    cl::CommandQueue queue_;
    const DeviceScene& scene_;
    std::uint32_t count_, stride_;
    GBufferPasses gbuffer_;
    LightPasses lights_;
    Emitters emitters_;
    Recorder record_;
    RasterBuffers lists_;
    GBuffer points_{{}, {}, stride_, Storage::full};
    cl::Buffer samples_, irradiance_, non_finite_;
};

TEST(Centroids, CanBeLitByAFewOfTheEmitters) {
    Scene world = test::patchwork(20, 92, false);
    const glm::vec3 places[] = {{-0.4f, 0.3f, 0.5f}, {0.6f, 0.2f, -0.3f}, {0.1f, -0.5f, 0.2f}};
    for (int i = 0; i < 3; ++i) {
        world.lights.push_back(test::point_light(glm::dvec3(places[i]), 6.0f));
        world.lights.back().intensity *= glm::vec3(0.1f + 0.4f * i, 0.7f, 1.0f - 0.3f * i);
    }
    const DeviceScene scene = test::on_device(world);
    CentroidSolver lit(test::device().queue, scene, {});
    const std::vector<glm::vec3> all = lit.irradiance();
    const float exposure = static_cast<float>(scene.frame().exposure);
    for (const std::uint32_t parted : {1u, 2u}) {
        const std::vector<float> two = lit.in_two(parted);
        const std::size_t stride = two.size() / IRRADIANCE_PLANES;
        for (std::size_t t = 0; t < all.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const float wanted = all[scene.triangle_order()[t]][k];
                EXPECT_NEAR(two[static_cast<std::size_t>(k) * stride + t] * exposure, wanted,
                            1e-5f * wanted)
                    << parted << " " << t;
            }
    }
}

TEST(Centroids, CanBePutAndTaken) {
    Scene world = test::patchwork(20, 91, false);
    world.lights = {test::point_light({-0.4, 0.3, 0.5}, 6.0f)};
    world.lights[0].intensity *= glm::vec3(0.1f, 0.7f, 1.0f);
    const DeviceScene scene = test::on_device(world);
    CentroidSolver lit(test::device().queue, scene, {});
    const std::vector<glm::vec3> once = lit.irradiance();
    const std::vector<float> left = lit.twice_less_once();
    const std::size_t stride = left.size() / IRRADIANCE_PLANES;
    float most = 0.0f;
    for (std::size_t t = 0; t < once.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const float wanted = once[scene.triangle_order()[t]][static_cast<int>(c)];
            const float found = left[c * stride + t] * static_cast<float>(scene.frame().exposure);
            EXPECT_NEAR(found, wanted, 1e-5f * wanted);
            most = std::max(most, wanted);
        }
    EXPECT_GT(most, 0.0f);
}

// The path tracer has the same light at the same places, in every channel; but for places on the
// edge of a shadow, where a shadow map's texel decides.
TEST(Centroids, AreLitLikeThePathTracersPlaces) {
    Scene world = test::patchwork(120, 91, false);
    for (Material& material : world.materials) material.emission = glm::vec3(0.0f);
    world.lights = {test::spot_light({0.2, 0.5, 0.1}, {-0.3f, -1, 0.2f}, 0.9, 40.0f),
                    test::point_light({-0.4, 0.3, 0.5}, 6.0f),
                    test::directional_light({0.3f, -1, -0.4f})};
    world.lights[0].intensity *= glm::vec3(1.0f, 0.6f, 0.2f);
    world.lights[1].intensity *= glm::vec3(0.1f, 0.7f, 1.0f);
    world.lights[1].range = 2.5f;
    world.lights[2].intensity *= glm::vec3(0.5f, 1.0f, 0.7f);
    const DeviceScene scene = test::on_device(world);
    CentroidSolver solver(test::device().queue, scene, {.shadow_size = 1024, .face_size = 512});
    const std::vector<glm::vec3> found = solver.irradiance();
    EXPECT_EQ(solver.non_finite(), 0u);
    EXPECT_GT(solver.record().interval().milliseconds(), 0.0);
    reference::Options options;
    options.effects = reference::parse_effects("direct");
    const auto truth = reference::PathTracer(world).irradiance(test::centroids(world), options);
    std::size_t lit = 0, off = 0;
    for (std::size_t t = 0; t < found.size(); ++t) {
        lit += truth.values[t] != glm::vec3(0.0f);
        const glm::vec3 apart = glm::abs(found[t] - truth.values[t]);
        off += glm::any(glm::greaterThan(apart, 1e-4f * truth.values[t] + 1e-4f));
    }
    EXPECT_GT(lit, found.size() / 4);
    EXPECT_LE(off, found.size() / 20) << "of " << found.size();
}

}  // namespace
}  // namespace clgi
