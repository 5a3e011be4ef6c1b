// Environments projected to spherical harmonics on the device, and by a plain sum on the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <clgi/advanced/sh.hpp>
#include <numbers>

#include "device.hpp"
#include "sphere_rule.hpp"

namespace clgi::test {

struct ProjectedSky {
    std::vector<glm::vec3> light;
    std::uint32_t non_finite = 0;
};

struct SkyProjector {
    Math math = Math::strict;
    int bands = SH_DEFAULT_BANDS;
    int packet_width = 0;
    std::size_t local_size = 0;
    Form form = Form::automatic;
    std::vector<DirectionalLight> lights;

    TransferPasses passes() const {
        return TransferPasses(
            programs(),
            BuildOptions{
                .math = math, .packet_width = packet_width, .form = form, .local_size = local_size},
            bands);
    }

    // Buffers for a projection; texels: [height][width][3] float.
    ProjectionBuffers buffers(const EnvironmentProjection& projection, const cl::Buffer& texels,
                              double rotation) const {
        ProjectionBuffers out;
        out.texels = texels;
        out.row_weights = upload(projection.row_weights);
        out.column_weights = upload(projection.column_weights);
        out.waves = upload(projection.waves);
        out.rotation = upload(environment_rotation(rotation, bands));
        if (!lights.empty()) out.lights = upload(lights);
        out.sums = empty<char>(projection.sums_bytes());
        out.leaves = empty<char>(projection.leaves_bytes());
        out.light = empty<glm::vec4>(static_cast<std::size_t>(sh::terms(bands)));
        out.non_finite = upload(std::vector<std::uint32_t>{0});
        return out;
    }

    ProjectedSky operator()(int width, int height, const cl::Buffer& texels,
                            const glm::vec3& factor = glm::vec3(1.0f),
                            double rotation = 0.0) const {
        EnvironmentProjection projection(width, height, bands);
        projection.params.factor = glm::vec4(factor, 0.0f);
        projection.params.light_count = static_cast<std::uint32_t>(lights.size());
        const ProjectionBuffers on = buffers(projection, texels, rotation);
        const TransferPasses transfer = passes();
        transfer.project(device().queue, projection.params, on);
        ProjectedSky out;
        for (const glm::vec4& c :
             download<glm::vec4>(on.light, static_cast<std::size_t>(sh::terms(bands)))) {
            EXPECT_EQ(c.w, 0.0f);
            out.light.emplace_back(c);
        }
        out.non_finite = download<std::uint32_t>(on.non_finite, 1)[0];
        return out;
    }

    ProjectedSky operator()(const Environment& sky) const {
        std::vector<float> texels;
        for (const glm::vec3& texel : sky.texels)
            texels.insert(texels.end(), {texel.x, texel.y, texel.z});
        if (sky.texels.empty()) texels = {1, 1, 1};
        return (*this)(std::max(sky.width, 1), std::max(sky.height, 1), upload(texels), sky.factor,
                       sky.rotation);
    }
};

// Texel by texel, as clgi/scene.hpp says where they lie, each with a rule of nodes x nodes.
inline std::vector<glm::dvec3> projected_on_host(const Environment& sky, int bands, int nodes) {
    constexpr double pi = std::numbers::pi;
    std::vector<glm::dvec3> out(static_cast<std::size_t>(sh::terms(bands)), glm::dvec3(0.0));
    std::vector<double> y(out.size());
    for (int row = 0; row < sky.height; ++row)
        for (const Node& down : gauss(nodes, pi * row / sky.height, pi * (row + 1) / sky.height))
            for (int column = 0; column < sky.width; ++column) {
                const glm::dvec3 radiance(
                    sky.texels[static_cast<std::size_t>(row * sky.width + column)] * sky.factor);
                if (radiance == glm::dvec3(0.0)) continue;
                // From -Z, the middle, towards +X, which is clockwise seen from above.
                for (const Node& across : gauss(nodes, 2 * pi * column / sky.width - pi,
                                                2 * pi * (column + 1) / sky.width - pi)) {
                    const double ring = std::sin(down.at), turn = across.at - double{sky.rotation};
                    sh::evaluate(glm::dvec3(ring * std::sin(turn), std::cos(down.at),
                                            -ring * std::cos(turn)),
                                 bands, y.data());
                    const double weight = down.weight * across.weight * ring;
                    for (std::size_t i = 0; i < y.size(); ++i) out[i] += weight * y[i] * radiance;
                }
            }
    return out;
}

// The largest difference of a coefficient, relative to the light's own term 0, over channels.
inline double relative_difference(const std::vector<glm::vec3>& found,
                                  const std::vector<glm::dvec3>& wanted) {
    EXPECT_EQ(found.size(), wanted.size());
    double worst = 0.0;
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const double apart = std::abs(double{found[i][c]} - wanted[i][c]);
            worst = std::max(worst, apart / std::abs(wanted[0][c]));
            if (!(apart >= 0.0)) return HUGE_VAL;
        }
    return worst;
}

}  // namespace clgi::test
