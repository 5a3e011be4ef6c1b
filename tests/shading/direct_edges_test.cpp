// Texels of shadow maps past the edge of a receiver, where direct light is asked to leave them out:
// against double precision, and by hand.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <tuple>

#include "lighting.hpp"
#include "oblique.hpp"
#include "shadow_reference.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t places = 531, plane_stride_of_places = 544;

// Points of tilted surfaces before one light of a colour, and the map that it looks through.
struct Receivers {
    explicit Receivers(const Light& light) {
        Scene scene = test::oblique_room();
        scene.lights = {light};
        set =
            make_emitters(test::on_device(scene), {.vpls = 1, .shadow_size = 61, .face_size = 37});
        visibility.assign(set.pixels, ~std::uint64_t{0});  // nothing
        test::Random random(29);
        for (std::uint32_t i = 0; i < places; ++i) {
            position.emplace_back(random(-0.6, 0.6), random(-0.6, 0.6), random(-0.6, 0.6));
            normal.push_back(test::random_direction(random));
        }
    }

    test::Shadowed place(std::uint32_t i) const {
        return test::shadowed(set.emitters[0], set.views, glm::dvec3(position[i]),
                              glm::dvec3(normal[i]), double{texel_bias});
    }

    // [channel][place] lux, exposed.
    std::vector<float> light(std::uint32_t edges) const {
        const test::Device& on = test::device();
        std::vector<float> planes(GBUFFER_PLANES * plane_stride_of_places);
        for (std::uint32_t i = 0; i < places; ++i)
            for (int c = 0; c < 3; ++c) {
                const auto put = [&](int plane, float value) {
                    planes[(plane + c) * plane_stride_of_places + i] = value;
                };
                put(GBUFFER_POSITION, position[i][c]);
                put(GBUFFER_NORMAL, normal[i][c]);
                put(GBUFFER_GEOMETRIC, normal[i][c]);
            }
        const cl::Buffer irradiance =
            test::upload_irradiance(std::vector<float>(IRRADIANCE_PLANES * plane_stride_of_places));
        test::light_passes().direct(
            on.queue, {plane_stride_of_places, places, 1, texel_bias, 2, 0, 0, edges},
            {test::upload(set.emitters), test::upload(set.views), test::upload(visibility)},
            test::upload_planes(planes, plane_stride_of_places), irradiance,
            test::upload(std::vector<cl_uint>(1)));
        return test::read_irradiance(irradiance, plane_stride_of_places);
    }

    float texel_bias = 0.0f;
    EmitterSet set;
    std::vector<std::uint64_t> visibility;
    std::vector<glm::vec3> position, normal;
};

// Of a sun or a point light, and with how large a bias.
class DirectEdges : public testing::TestWithParam<std::tuple<bool, float>> {
protected:
    static bool parallel() { return std::get<0>(GetParam()); }
    static Receivers receivers() {
        Light light = parallel() ? test::oblique_sun() : test::oblique_point();
        light.range = 0.0f;
        Receivers out(light);
        out.texel_bias = std::get<1>(GetParam());
        return out;
    }
};

TEST_P(DirectEdges, AreLeftOutAsInDoublePrecision) {
    Receivers in = receivers();
    test::Random random(31);
    for (std::uint32_t i = 0; i < places; ++i) {
        const test::Shadowed at = in.place(i);
        if (at.view == nullptr) continue;
        for (int k = 0; k < 4; ++k) {
            const int kx = k & 1, ky = k >> 1;
            const double plane = at.closeness + at.along(at.column(kx), at.row(ky));
            if (std::isnan(plane)) continue;
            const double texel =
                at.behind - at.behind_by_slopes;  // a quarter of one, at 45 degrees
            // Of the receiver, a little or far behind it, before it.
            const double offsets[] = {0.0,
                                      -0.6 * at.behind,
                                      -at.behind - 2.0 * texel,
                                      -at.behind - 40.0 * texel,
                                      at.bias + 3.0 * texel,
                                      at.bias + 60.0 * texel};
            in.visibility[at.texel(kx, ky)] = test::word_of(
                static_cast<float>(std::max(plane + offsets[random.integer(0, 5)], 0.0)), 7);
        }
    }
    const std::vector<float> found = in.light(1), usual = in.light(0);
    int compared = 0, differ = 0, none_known = 0;
    for (std::uint32_t i = 0; i < places; ++i) {
        const test::Shadowed at = in.place(i);
        bool doubtful = at.doubtful;
        const double lit = test::lit_share(at, in.visibility, &doubtful, true);
        const Emitter& emitter = in.set.emitters[0];
        const glm::dvec3 away = glm::dvec3(emitter.position) - glm::dvec3(in.position[i]);
        const glm::dvec3 toward = parallel() ? -glm::dvec3(emitter.axis) : glm::normalize(away);
        const double cosine = glm::dot(toward, glm::dvec3(in.normal[i]));
        const double least = 0.02;  // of the weights: what is left over may be next to nothing
        const double known = test::known_share(at, in.visibility);
        if (doubtful || cosine < 0.05 || (known > 0.0 && known < least)) continue;
        none_known += known == 0.0;
        ++compared;
        const double strength = parallel() ? cosine : cosine / glm::dot(away, away);
        for (int c = 0; c < 3; ++c) {
            const double whole = double{emitter.intensity[c]} * strength;
            EXPECT_NEAR(found[c * plane_stride_of_places + i], whole * lit,
                        1e-3 * whole / (known > 0.0 ? known : 1.0))
                << i << ' ' << c;
        }
        if (std::abs(found[i] - usual[i]) > 0.1f * std::abs(usual[i])) ++differ;
    }
    EXPECT_GT(compared, 130);
    EXPECT_GT(differ, 40);
    EXPECT_GT(none_known, 2);
}

// A receiver of which no texel is known is lit as ever, and one that all texels show, too.
TEST_P(DirectEdges, ChangeNothingWhereNoTexelIsOfTheReceiverOrAllAre) {
    Receivers in = receivers();
    const std::vector<float> open = in.light(0);
    EXPECT_EQ(in.light(1), open);  // nothing is shown at all
    EXPECT_GT(std::count_if(open.begin(), open.end(), [](float e) { return e > 0.0f; }), 300);
    for (std::uint32_t i = 0; i < places; ++i) {
        const test::Shadowed at = in.place(i);
        for (int k = 0; at.view && k < 4; ++k) {
            const double limit = at.limit(at.column(k & 1), at.row(k >> 1));
            if (std::isnan(limit)) continue;
            in.visibility[at.texel(k & 1, k >> 1)] =
                test::word_of(static_cast<float>(limit + (k < 2 ? 0.3 : -0.3) * at.bias), 7);
        }
    }
    // Places share texels, so that some are seen past the edges of others.
    const std::vector<float> half = in.light(0), all = in.light(1);
    int same = 0, partly = 0;
    for (std::uint32_t i = 0; i < places; ++i) {
        const test::Shadowed at = in.place(i);
        if (at.doubtful || test::known_share(at, in.visibility) < 1.0 - 1e-6) continue;
        EXPECT_NEAR(all[i], half[i], 1e-5f * open[i]) << i;
        ++same;
        partly += half[i] < open[i] && half[i] > 0.0f;
    }
    EXPECT_GT(same, 150);
    EXPECT_GT(partly, 30);
}

INSTANTIATE_TEST_SUITE_P(Lights, DirectEdges,
                         testing::Combine(testing::Bool(), testing::Values(0.06f, 0.5f)));

}  // namespace
}  // namespace clgi
