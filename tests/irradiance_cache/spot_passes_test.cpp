// The passes of small lit places.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "lit_floor.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using namespace test::lit_floor;

CLGI_IN_BOTH_MATHS(SpotPasses);

// From above the fronts of the floor's four vertices, from below their backs; nothing of the plate,
// which is behind the record or hidden.
TEST_P(SpotPasses, MarkTheSidesThatRecordsSee) {
    for (const bool above : {true, false}) {
        LitFloor of(sun(), above);
        int bits = 0;
        for (const std::uint32_t word : read<std::uint32_t>(of.spot.seen, of.words())) {
            bits += std::popcount(word);
            EXPECT_EQ(word & (above ? 0xaaaaaaaau : 0x55555555u), 0u);
        }
        EXPECT_EQ(bits, 4);
    }
}

TEST_P(SpotPasses, TallyWhatIsLitAndSeen) {
    LitFloor of(sun());
    EXPECT_NEAR(of.tallied(), lit_section(), 0.01 * lit_section());
    // Texels of the floor's two triangles, also in tiles that show the plate besides.
    const auto count = read<std::uint32_t>(of.spot.count, SPOT_TILES_A_VIEW);
    std::uint32_t shown = 0;
    for (const std::uint64_t word :
         read<std::uint64_t>(of.spot.visibility, spot_view_size * spot_view_size)) {
        const auto triangle = static_cast<std::uint32_t>(word);
        if (triangle != ~0u && of.scene->triangle_order()[triangle] < 2) ++shown;
    }
    EXPECT_GT(shown, 1000u);
    EXPECT_EQ(std::accumulate(count.begin(), count.end(), 0u), shown);
    // Every other tile alone, then the others.
    double sum = 0.0;
    for (const std::size_t odd : {0, 1}) {
        for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t) of.wanted[t] = t % 2 == odd ? 1 : 0;
        const double half = of.tallied();
        EXPECT_GT(half, 0.1);
        sum += half;
    }
    EXPECT_NEAR(sum, lit_section(), 0.01 * lit_section());
    std::fill(of.wanted.begin(), of.wanted.end(), 1u);
    of.spot.seen = test::upload(std::vector<std::uint32_t>(of.words(), 0xaaaaaaaau));  // the backs
    EXPECT_EQ(of.tallied(), 0.0);
    // One triangle of the floor: the other has an edge of it, the plate has none.
    auto one = std::vector<std::uint32_t>(of.words(), 0u);
    for (const std::uint32_t vertex : {0u, 1u, 2u}) one[vertex / 16] |= 1u << 2 * (vertex % 16);
    of.spot.seen = test::upload(one);
    EXPECT_NEAR(of.tallied(), lit_section(), 0.01 * lit_section());
    one.assign(of.words(), 0u);
    one[0] = 1u;  // a corner is none
    of.spot.seen = test::upload(one);
    EXPECT_EQ(of.tallied(), 0.0);
}

TEST_P(SpotPasses, PlaceVplsThatSendWhatIsLit) {
    LitFloor of(sun());
    of.tallied();
    const std::vector<Vpl> vpls = of.placed(500);
    ASSERT_EQ(vpls.size(), 500u);
    const glm::dvec3 wanted = floor_albedo * glm::dvec3(3, 4, 5) * lit_section();
    const glm::dvec3 found = of.flux(vpls);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.012 * wanted[c]) << c;
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, -1.0, 0.1)),
                     normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    double area = 0.0;
    for (const Vpl& one : vpls) {
        EXPECT_LT(glm::length(glm::dvec3(one.normal) - normal), 1e-5);
        const glm::dvec3 at = glm::dvec3(one.position) / of.scale + of.scene->frame().origin;
        EXPECT_NEAR(at.y, slope * at.x, 1e-5);
        area += double{one.position.w} * glm::pi<double>() / (of.scale * of.scale);
        EXPECT_NEAR(one.normal.w, one.position.w * one.position.w, 1e-6 * one.normal.w);
    }
    EXPECT_NEAR(area, lit_section() / -glm::dot(way, normal), 0.15);
}

// Tiles to the right of and above the middle of what is lit: VPLs lie in these, and what they send
// together with what pixels of the hemicube then still do is what pixels do alone.
TEST_P(SpotPasses, ShareTheLightWithPixels) {
    LitFloor of(sun());
    of.tallied();
    const auto count = read<std::uint32_t>(of.spot.count, SPOT_TILES_A_VIEW);
    double texels = 0.0, columns = 0.0, rows = 0.0;
    for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t) {
        texels += count[t];
        columns += static_cast<double>(t % SPOT_TILES) * count[t];
        rows += static_cast<double>(t / SPOT_TILES) * count[t];
    }
    const double column = std::round(columns / texels), row = std::round(rows / texels);
    for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t)
        of.wanted[t] = static_cast<double>(t % SPOT_TILES) >= column &&
                               static_cast<double>(t / SPOT_TILES) < row
                           ? 1
                           : 0;
    EXPECT_GT(of.tallied(), 0.1 * lit_section());
    EXPECT_LT(of.tallied(), 0.5 * lit_section());
    const std::vector<Vpl> vpls = of.placed(200);
    constexpr double half = SPOT_TILES / 2;
    for (const Vpl& one : vpls) {
        const glm::dvec3 way = glm::dvec3(one.position) - glm::dvec3(of.view.eye);
        EXPECT_GE(glm::dot(way, glm::dvec3(of.view.right)),
                  of.view.window.x + of.view.right.w * (column / half - 1.0) - 1e-4);
        EXPECT_GE(glm::dot(way, glm::dvec3(of.view.up)),
                  of.view.window.y + of.view.up.w * (1.0 - row / half) - 1e-4);
    }
    of.link_with(of.wanted, false);
    const std::vector<float> all = read<float>(of.records.reflected, 3 * places);
    of.link_with(of.wanted, true);
    const std::vector<float> rest = read<float>(of.records.reflected, 3 * places);
    of.hemicubes_of(vpls);
    const auto sent = static_cast<std::uint32_t>(vpls.size());
    of.passes.shine(of.queue, of.params, of.list(1), {1, sent, 0, 0}, *of.scene, of.records,
                    of.spot);
    const std::vector<float> both = read<float>(of.records.reflected, 3 * places);
    for (std::size_t c = 0; c < 3; ++c) {
        const float whole = all[c * places];
        EXPECT_LT(rest[c * places], 0.9f * whole) << c;
        EXPECT_GT(rest[c * places], 0.1f * whole) << c;
        EXPECT_NEAR(both[c * places], whole, 0.03f * whole) << c;
    }
}

// All of a spot's cone falls on the floor.
TEST_P(SpotPasses, PlaceVplsInACone) {
    Light light = test::spot_light({1.2, 1.6, 0.3}, {0.1f, -1.0f, 0.1f}, 0.3);
    light.intensity = {30.0f, 20.0f, 10.0f};
    LitFloor of(light);
    of.tallied();
    const double solid = 2.0 * glm::pi<double>() * (1.0 - std::cos(0.3));
    const std::vector<Vpl> vpls = of.placed(700);
    for (const Vpl& one : vpls) EXPECT_GT(one.flux.x, 0.0f);
    const glm::dvec3 found = of.flux(vpls), wanted = floor_albedo * glm::dvec3(30, 20, 10) * solid;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.006 * wanted[c]) << c;
}

// By a second implementation, in double precision; the plate hides some of them, and one lies
// beneath the record's surface, though its shading normal faces it. Other records beside it, in
// whatever order and facing its way, spread their light over what it stands for.
TEST_P(SpotPasses, LightRecordsThatTheySee) {
    LitFloor of(sun());
    std::vector<float> planes(RECORD_PLANES * places, 0.0f);
    const auto put = [&](std::uint32_t first, std::uint32_t record, const glm::dvec3& value) {
        for (std::uint32_t c = 0; c < 3; ++c)
            planes[(first + c) * places + record] = static_cast<float>(value[static_cast<int>(c)]);
    };
    const auto local = [&](glm::dvec3 at) { return of.scale * (at - of.scene->frame().origin); };
    const glm::dvec3 at(0.3, 3.0, 0.2), facing = glm::normalize(glm::dvec3(0.2, -1.0, 0.1));
    put(RECORD_POSITION, 0, local(at));
    put(RECORD_NORMAL, 0, facing);
    const glm::dvec3 ground = glm::normalize(glm::dvec3(-0.9, -0.3, 0.0));
    put(RECORD_GEOMETRIC, 0, ground);
    const glm::dvec3 beside[] = {{0.5, 0.1, 0.0}, {-0.2, 0.0, 0.9}, {0.3, 0.0, 0.4}};
    for (std::uint32_t k = 0; k < 3; ++k) {
        put(RECORD_POSITION, k + 1, local(at + beside[k]));
        put(RECORD_NORMAL, k + 1, k < 2 ? facing : -facing);
    }
    of.records.planes = test::upload(planes);

    std::vector<Vpl> vpls;
    // Alone; with one other that faces its way; with two.
    const double wide[] = {0.0, 0.26, 0.85 / 2.0};
    glm::dvec3 wanted[3] = {};
    int hidden = 0, beneath = 0;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    for (std::uint32_t k = 0; k < 12; ++k) {
        const double x = k < 4 ? -1.9 + 0.2 * k : -0.1 + 0.2 * (k - 4);
        const glm::dvec3 from(x, slope * x, 0.1 * k - 0.5);
        const double radius2 = 0.02 * (k + 1) * of.scale * of.scale;
        const glm::dvec3 flux(1.0 + k, 2.0, 3.0 + 0.1 * k);
        vpls.push_back(
            {float4(local(from), radius2), float4(normal, radius2 * radius2), float4(flux, 1.0)});
        // Where the way crosses the plate's underside.
        const double share = (2.0 - from.y) / (at.y - from.y);
        const double crossing = from.x + share * (at.x - from.x);
        ASSERT_GT(std::abs(crossing), 0.13);  // a pixel of their hemicubes
        hidden += crossing < 0.0;
        if (crossing < 0.0) continue;
        const bool below = glm::dot(from - at, ground) < 0.0;
        beneath += below;
        if (below) continue;
        for (int others = 0; others < 3; ++others) {
            glm::dvec3 to = local(from) - local(at);
            const double height = glm::dot(to, facing);
            to += (std::hypot(height, std::sqrt(wide[others]) * of.scale) - height) * facing;
            const double square = glm::dot(to, to),
                         cosines = glm::dot(to, facing) * -glm::dot(to, normal) / square;
            wanted[others] +=
                flux * cosines * (square + radius2) /
                (glm::pi<double>() * (square * (square + radius2) + radius2 * radius2));
        }
    }
    ASSERT_TRUE(hidden > 2 && hidden < 10);
    ASSERT_EQ(beneath, 1);
    vpls.push_back(vpls.back());  // one that faces away
    for (int c = 0; c < 3; ++c) vpls.back().normal[c] *= -1.0f;
    of.hemicubes_of(vpls);
    std::vector<float> before(3 * places, 0.0f);
    before[0] = before[places] = 2.0f;
    // The fourth faces the other way and is none of them.
    for (const std::uint32_t records : {1u, 2u, 3u, 4u}) {
        of.records.reflected = test::upload(before);
        of.passes.shine(of.queue, of.params, of.list(records), {1, 13, 0, 0}, *of.scene, of.records,
                        of.spot);
        const auto found = read<float>(of.records.reflected, 3 * places);
        for (std::size_t c = 0; c < 3; ++c) {
            const double more = wanted[std::min(records, 3u) - 1][static_cast<int>(c)];
            EXPECT_NEAR(found[c * places], before[c * places] + more, 1e-4 * more) << c;
        }
        EXPECT_EQ(found[1], 0.0f);
    }
}

}  // namespace
}  // namespace clgi
