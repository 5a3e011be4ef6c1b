// The reflectance of glTF 2.0 in the path tracer: white furnaces, reciprocity, densities, grazing
// angles; and the means that stand for it in even light.
// SPDX-License-Identifier: MIT
#include "reference/bsdf.hpp"

#include <clgi/shared/microfacet.h>
#include <gtest/gtest.h>
#include <clgi/device_scene.hpp>

#include <cmath>
#include <numbers>

#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

reference::Surface surface_with(const Material& material, const glm::vec3& normal,
                                const glm::vec3& base) {
    const glm::vec4 of = surface_of(material);
    reference::Surface out{};
    out.normal = out.geometric = normal;
    out.base = base;
    out.albedo = base * reflectance(material).diffuse;
    out.metallic = of.x;
    out.alpha = of.y;
    out.f0 = of.z;
    out.f90 = of.w;
    return out;
}

glm::vec3 direction(double slant, double turn) {
    return glm::vec3(glm::dvec3(std::sin(slant) * std::cos(turn), std::sin(slant) * std::sin(turn),
                                std::cos(slant)));
}

struct Sums {
    double albedo = 0.0, grazing = 0.0, cosine = 0.0;
};

// Over half vectors by D's own measure: of D V F cosine with F 1 and (1 - v.h)^5, and the first
// with the cosine to the mirrored direction.
Sums sums(double alpha, double slant, int steps = 150, int turns = 64) {
    const glm::dvec3 viewer(std::sin(slant), 0.0, std::cos(slant));
    const glm::dvec3 mirror(-viewer.x, 0.0, viewer.z);
    const auto mask = [&](double cosine) {
        return 1.0 / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
    };
    Sums out;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < turns; ++j) {
            // Even steps of the cube root of what is steeper: light near the horizon needs it.
            const double step = (i + 0.5) / steps, steeper = step * step * step;
            const double round = 2 * pi * (j + 0.5) / turns;
            const double tangent = alpha * std::sqrt((1 - steeper) / steeper);
            const double cosine = 1 / std::sqrt(1 + tangent * tangent);
            const glm::dvec3 half(tangent * cosine * std::cos(round),
                                  tangent * cosine * std::sin(round), cosine);
            const double vh = glm::dot(viewer, half);
            const glm::dvec3 light = 2 * vh * half - viewer;
            if (vh <= 0 || light.z <= 0) continue;
            const double value = 3 * step * step * mask(light.z) * mask(viewer.z) * light.z * 4 *
                                 vh / cosine / (steps * turns);
            out.albedo += value;
            out.grazing += value * std::pow(1 - vh, 5);
            out.cosine += value * glm::dot(light, mirror);
        }
    return out;
}

// Over directions of the viewer by their cosine.
Sums means(double alpha) {
    Sums out;
    constexpr int slants = 200;
    for (int k = 0; k < slants; ++k) {
        const Sums at = sums(alpha, std::acos(std::sqrt((k + 0.5) / slants)));
        out.albedo += at.albedo / slants;
        out.grazing += at.grazing / slants;
        out.cosine += at.cosine / slants;
    }
    return out;
}

// Mean cosine of a Phong lobe to the mirrored direction, of light that leaves the surface.
double phong_cosine(double exponent) {
    double light = 0.0, along = 0.0;
    constexpr int slants = 24, steps = 100, turns = 64;
    for (int k = 0; k < slants; ++k) {
        const double up = std::sqrt((k + 0.5) / slants), flat = std::sqrt(1 - up * up);
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < turns; ++j) {
                const double cosine = std::pow((i + 0.5) / steps, 1 / (exponent + 1));
                const double sine = std::sqrt(1 - cosine * cosine);
                const double leaves =
                    std::max(up * cosine + flat * sine * std::cos(2 * pi * (j + 0.5) / turns), 0.0);
                light += leaves;
                along += leaves * cosine;
            }
    }
    return along / light;
}

TEST(MicrofacetMeans, AreTheIntegralsOverAllDirections) {
    for (const double alpha : {0.01, 0.03, 0.09, 0.17, 0.25, 0.36, 0.49, 0.64, 0.81, 1.0}) {
        const Sums wanted = means(alpha);
        const auto a = static_cast<float>(alpha);
        EXPECT_NEAR(microfacet_albedo(a), wanted.albedo, 8e-4) << alpha;
        EXPECT_NEAR(microfacet_grazing(a), wanted.grazing, 4e-4) << alpha;
        const float exponent = microfacet_means(1.0f, a, 0.0f, 0.0f).w;
        if (alpha > 0.62) {
            EXPECT_EQ(exponent, 0.0f) << alpha;
        } else {
            EXPECT_NEAR(phong_cosine(double{exponent}), wanted.cosine / wanted.albedo, 0.02)
                << alpha;
        }
    }
    double grazing = 0.0;
    test::Random random(3);
    constexpr int draws = 400000;
    for (int i = 0; i < draws; ++i) {
        const glm::vec3 v = direction(std::acos(std::sqrt(random(0, 1))), random(0, 2 * pi)),
                        l = direction(std::acos(std::sqrt(random(0, 1))), random(0, 2 * pi));
        grazing += std::pow(1.0 - glm::dot(glm::dvec3(v), glm::normalize(glm::dvec3(v + l))), 5);
    }
    EXPECT_NEAR(MICROFACET_DIFFUSE_GRAZING, grazing / draws, 1e-4);
}

TEST(MicrofacetMeans, ReflectNoMoreThanArrives) {
    for (int m = 0; m <= 20; ++m)
        for (int r = 0; r <= 100; ++r)
            for (const float ior : {0.0f, 1.0f, 1.5f, 3.0f})
                for (const float specular : {0.0f, 0.5f, 1.0f}) {
                    Material material = test::finished(static_cast<float>(m) / 20,
                                                       static_cast<float>(r) / 100, specular);
                    material.ior = ior;
                    const Reflectance shares = reflectance(material);
                    EXPECT_GE(std::min({shares.diffuse, shares.coat, shares.lobe}), 0.0f);
                    EXPECT_LE(shares.diffuse + shares.coat + shares.lobe, 1.0f + 1e-6f);
                    if (m == 0 && specular == 0.0f) {
                        EXPECT_EQ(shares.diffuse, 1.0f);
                        EXPECT_EQ(shares.coat + shares.lobe, 0.0f);
                    }
                }
}

// Light may go either way, and no direction of the hemisphere gives what is no number.
TEST(Bsdf, IsReciprocalAndFiniteUpToTheHorizon) {
    test::Random random(11);
    for (int i = 0; i < 4000; ++i) {
        Material material =
            test::finished(static_cast<float>(random(0, 1)), static_cast<float>(random(0, 1)),
                           static_cast<float>(random(0, 1)));
        material.ior = static_cast<float>(random(1, 3));
        const glm::vec3 base(random(0, 1), random(0, 1), random(0, 1));
        const bool grazing = i % 4 == 0;
        const glm::vec3 v = direction(random(grazing ? 1.5 : 0, 1.57), random(0, 2 * pi)),
                        l = direction(random(0, 1.57), random(0, 2 * pi));
        const reference::Surface surface = surface_with(material, {0, 0, 1}, base);
        const glm::vec3 there = reference::Bsdf(surface, v).reflected(l),
                        back = reference::Bsdf(surface, l).reflected(v);
        const test::GltfReflected wanted =
            test::gltf_reflected(material, glm::dvec3(base), {0, 0, 1},
                                 glm::normalize(glm::dvec3(v)), glm::normalize(glm::dvec3(l)));
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(there[c], 0.0f);
            EXPECT_TRUE(std::isfinite(there[c]));
            EXPECT_NEAR(there[c], back[c], 1e-4 * there[c]);
            const double both = wanted.diffuse[c] + wanted.gloss[c];
            EXPECT_NEAR(there[c], both, 2e-4 * both) << i;
        }
    }
}

// Drawn directions by their density: the integral of f cosine, and of 1 over the hemisphere.
TEST(Bsdf, DrawsDirectionsByItsDensity) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f)),
                    side = glm::normalize(glm::cross(normal, glm::vec3(0, 1, 0)));
    for (const float roughness : {0.2f, 0.5f, 1.0f})
        for (const double slant : {0.1, 0.9, 1.45}) {
            const glm::vec3 v = glm::normalize(normal * static_cast<float>(std::cos(slant)) +
                                               side * static_cast<float>(std::sin(slant)));
            const Material metal = test::finished(1.0f, roughness);
            const reference::Surface surface = surface_with(metal, normal, glm::vec3(1.0f));
            const reference::Bsdf bsdf(surface, v);
            reference::Random random(7, 1, static_cast<std::uint64_t>(100 * slant));
            double found = 0.0;
            constexpr int draws = 60000;
            for (int i = 0; i < draws; ++i) {
                const glm::vec3 light = bsdf.sample(random, true);
                const float density = bsdf.density(light, true), up = glm::dot(light, normal);
                if (up > 0.0f && density > 0.0f)
                    found += double{bsdf.reflected(light).y * up / density} / draws;
            }
            const double wanted =
                sums(std::max(double{roughness} * double{roughness}, 0.01), slant, 1500, 256)
                    .albedo;
            EXPECT_NEAR(found, wanted, 6e-3) << roughness << ' ' << slant;
            EXPECT_LT(found, 1.0 + 1e-3);
        }
}

}  // namespace
}  // namespace clgi
