// The transport between VPLs against the kernel in double precision, view factors and geometry.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "math_modes.hpp"
#include "vpl_crowd.hpp"

namespace clgi {
namespace {

using test::half_rounding;
using test::Hemicubes;
using test::SitePlace;
using test::Sites;

CLGI_IN_BOTH_MATHS(Exchange);

TEST_P(Exchange, IsTheMeanOfTheKernelOverTheReceiversSamples) {
    test::expect_means(test::vpl_passes(GetParam()), 1u << 20);
}

// Of up to 21: the others are not looked at.
TEST_P(Exchange, IsTheMeanOverTheFirstSamplesIfNoMoreAreAskedFor) {
    for (const std::size_t most : {1u, 2u, 4u, 5u, 9u, 16u})
        test::expect_means(test::vpl_passes(GetParam()), most);
}

// One site of one sample.
SitePlace dot(const glm::vec3& position, const glm::vec3& normal, float area) {
    return {position, normal, area, glm::vec3(1.0f), {{position, normal, normal}}};
}

// Inside a sphere every site sends the same to every other: A / (4 pi R^2).
TEST_P(Exchange, InsideASphereIsTheSameForAllPairs) {
    const double radius = 0.75;
    test::Random random(7);
    std::vector<SitePlace> places;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 out = test::direction(random);
        places.push_back(dot(static_cast<float>(radius) * out, -out, 1e-6f));
    }
    const Sites sites(places);
    const float scale = 1.3f;
    const auto rows = test::transport_rows(sites, test::hemicubes(sites, nullptr), true, scale,
                                           test::vpl_passes(GetParam()));
    const double wanted = scale / (4.0 * test::pi * radius * radius);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < places.size(); ++j) {
            const double apart = glm::distance(places[i].position, places[j].position);
            if (apart < 0.1 * radius) continue;
            // Cosines are apart / 2R, so what rounding of a position does to them grows near by.
            EXPECT_NEAR(glm::unpackHalf1x16(rows[i * sites.buffers.stride + j]), wanted,
                        wanted * (half_rounding + 4e-7 * radius / apart * radius / apart * 4));
        }
}

// A rectangle cut into k x k sites of m x m samples each.
void add_rectangle(std::vector<SitePlace>& out, const DeviceScene& scene, const glm::dvec3& corner,
                   const glm::dvec3& u, const glm::dvec3& v, int k, int m) {
    const glm::vec3 normal(glm::normalize(glm::cross(u, v)));
    const double scale = scene.frame().scale;
    const auto at = [&](double x, double y) {
        return scene.frame().to_local(corner + x * u + y * v);
    };
    for (int i = 0; i < k * k; ++i) {
        SitePlace site;
        const double x = i % k, y = i / k;
        site.position = at((x + 0.5) / k, (y + 0.5) / k);
        site.normal = normal;
        site.area = static_cast<float>(glm::length(glm::cross(u, v)) * scale * scale / (k * k));
        for (int s = 0; s < m * m; ++s)
            site.samples.push_back(
                {at((x + (s % m + 0.5) / m) / k, (y + (s / m + 0.5) / m) / k), normal, normal});
        out.push_back(site);
    }
}

CLGI_IN_BOTH_MATHS(ViewFactor);

struct Plate {
    glm::dvec3 corner, u, v;
};

// The share of the first plate's power that arrives at the second, seen in drawn hemicubes.
double view_factor(const Plate& a, const Plate& b, int k, int m) {
    Scene world = test::plain_scene();
    for (const Plate& p : {a, b})
        test::add_quad(world, {p.corner, p.corner + p.u, p.corner + p.u + p.v, p.corner + p.v});
    const DeviceScene scene = test::on_device(world);
    std::vector<SitePlace> places;
    add_rectangle(places, scene, a.corner, a.u, a.v, k, m);
    add_rectangle(places, scene, b.corner, b.u, b.v, k, m);
    const Sites sites(places);
    const auto shooters = static_cast<std::uint32_t>(k * k);
    const auto cubes = test::hemicubes(sites, &scene, {0, shooters, 64, 2e-5f});
    const float row_scale = places.back().area;
    const auto rows = test::transport_rows(sites, cubes, false, row_scale);
    double sum = 0.0;
    for (std::size_t i = 0; i < shooters; ++i)
        for (std::size_t j = shooters; j < places.size(); ++j)
            sum += glm::unpackHalf1x16(rows[i * sites.buffers.stride + j]);
    return sum / shooters;
}

const Plate low_plate{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, high_plate{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};

TEST_P(ViewFactor, OfParallelSquaresConverges) {
    const double wanted = 0.1998248957;  // unit squares a unit apart
    // Midpoint rule over the shooter's cells: h^2 / 24 times the mean of the kernel's Laplacian,
    // which is at most 8 / pi, that straight across. The receiver's cells are much smaller.
    const auto bound = [](int k) { return 8.0 / test::pi / (24.0 * k * k); };
    const double coarse = view_factor(low_plate, high_plate, 4, 6) - wanted;
    const double fine = view_factor(low_plate, high_plate, 8, 4) - wanted;
    EXPECT_LT(std::abs(coarse), bound(4) + bound(24));
    EXPECT_LT(std::abs(fine), bound(8) + bound(32));
    EXPECT_LT(std::abs(fine), 0.35 * std::abs(coarse));
}

TEST_P(ViewFactor, OfSquaresAtARightAngleConverges) {
    // No pair closer than a cell of samples is right: a strip of that width along the edge, of
    // whose power at most half can arrive at the other square.
    struct {
        Plate wall;
        double wanted;
    } cases[] = {{{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.2000437761},
                 {{{0, 0, 0}, {0, 1, 0}, {0, 0, 2}}, 0.2328526028},
                 {{{0, 0, 0}, {0, 1, 0}, {0, 0, 0.1}}, 0.0432513694}};
    for (const auto& c : cases) {
        const double coarse = std::abs(view_factor(low_plate, c.wall, 4, 2) - c.wanted);
        const double fine = std::abs(view_factor(low_plate, c.wall, 8, 4) - c.wanted);
        EXPECT_LT(fine, 0.5 / 32.0) << c.wanted;
        EXPECT_LT(fine, 0.5 * coarse) << c.wanted;
    }
}

// A blocker half way hides what lies behind it and nothing else.
TEST(Exchange, IsTheShareOfSamplesThatABlockerLeaves) {
    for (const double edge : {0.0, 0.0625, -0.125}) {
        Scene world = test::plain_scene();
        test::add_quad(world, {glm::dvec3(-1, -1, 0), {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}});
        test::add_quad(world, {glm::dvec3(-1, -1, 1), {-1, 2, 1}, {2, 2, 1}, {2, -1, 1}});
        const double x = 0.5 + edge;  // hides all to the left
        test::add_quad(world, {glm::dvec3(-1, -1, 0.5), {-1, 2, 0.5}, {x, 2, 0.5}, {x, -1, 0.5}});
        const DeviceScene scene = test::on_device(world);
        std::vector<SitePlace> places;
        add_rectangle(places, scene, low_plate.corner, low_plate.u, low_plate.v, 1, 1);
        add_rectangle(places, scene, high_plate.corner, high_plate.u, high_plate.v, 1, 16);
        const Sites sites(places);
        const auto cubes = test::hemicubes(sites, &scene, {0, 1, 256, 2e-5f});
        const auto rows = test::transport_rows(sites, cubes);
        double wanted = 0.0;
        // Twice as far as the blocker's edge; no sample is within four pixels of that.
        const float border = scene.frame().to_local(glm::dvec3(0.5 + 2.0 * edge, 0, 0)).x;
        for (const test::SurfacePlace& sample : places[1].samples) {
            if (sample.position.x < border) continue;
            wanted +=
                test::exchange(places[0], glm::dvec3(sample.position), glm::dvec3(sample.normal))
                    .factor /
                (256.0 * test::pi);
        }
        EXPECT_NEAR(glm::unpackHalf1x16(rows[1]), wanted, wanted * (half_rounding + 1e-5)) << edge;
    }
}

// ---- the same numbers whichever way they are asked for --------------------------------------

// A box with a block inside, and sites on all of it.
struct Cabin {
    Scene world = test::plain_scene();
    DeviceScene scene;
    std::vector<SitePlace> places;
    Cabin() : scene(make(world)) {
        const glm::dvec3 corner[] = {{-1, -1, -1}, {-1, -1, -1}, {-1, -1, -1},
                                     {1, 1, 1},    {1, 1, 1},    {1, 1, 1}};
        for (int f = 0; f < 6; ++f) {
            glm::dvec3 u(0), v(0);
            u[(f + 1) % 3] = v[(f + 2) % 3] = f < 3 ? 2 : -2;
            if (f >= 3) std::swap(u, v);
            add_rectangle(places, scene, corner[f], u, v, 2, f % 3 + 2);
        }
    }
    static DeviceScene make(Scene& world) {
        test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
        test::add_box(world, {-0.3, -0.9, -0.4}, {0.5, 0.1, 0.2}, 1);
        return test::on_device(world);
    }
};

TEST(Transport, IsTheSameForEveryWidthGroupAndBatch) {
    const Cabin cabin;
    const std::vector<cl_uint> order = {5,  23, 0,  17, 9,  1,  2,  3,  4,  6,  7,  8,
                                        10, 11, 12, 13, 14, 15, 16, 18, 19, 20, 21, 22};
    const Sites sites(cabin.places, order);
    const std::uint32_t n = sites.buffers.site_count, stride = sites.buffers.stride;
    ASSERT_EQ(order.size(), n);
    test::HemicubeOptions options;
    options.lift = 2e-5f;
    const auto usual =
        test::transport_rows(sites, test::hemicubes(sites, &cabin.scene, options), true);
    int partly = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            EXPECT_NE(usual[i * stride + j], 0x7e00);
            const auto& samples = cabin.places[j].samples;
            double whole = 0.0;
            for (const test::SurfacePlace& s : samples)
                whole +=
                    test::exchange(cabin.places[i], glm::dvec3(s.position), glm::dvec3(s.normal))
                        .factor /
                    test::pi / double(samples.size());
            const double found = glm::unpackHalf1x16(usual[i * stride + j]);
            partly += found > 0.01 * whole && found < 0.99 * whole;
        }
    EXPECT_GT(partly, 20);
    const auto expect_row = [&](const std::vector<std::uint16_t>& rows, std::size_t row,
                                std::size_t site, const std::string& label) {
        for (std::size_t j = 0; j < n; ++j)
            EXPECT_EQ(rows[row * stride + j], usual[site * stride + j])
                << label << ", site " << site;
    };
    for (const std::uint32_t batch : {1u, 7u, 16u})
        for (const bool kept : {false, true})
            for (std::uint32_t first = 0; first < n; first += batch) {
                options.first = first;
                options.count = std::min(batch, n - first);
                const auto rows = test::transport_rows(
                    sites, test::hemicubes(sites, &cabin.scene, options), kept);
                for (std::uint32_t s = 0; s < options.count; ++s)
                    expect_row(rows, kept ? order[first + s] : s, order[first + s],
                               kept ? "kept" : "not kept");
                for (std::uint32_t i = 0; i < n && kept; ++i) {  // others were not touched
                    const auto place = std::find(order.begin(), order.end(), i) - order.begin();
                    const bool drawn = place >= first && place < first + options.count;
                    EXPECT_TRUE(drawn || rows[i * stride] == 0x7e00) << i;
                }
            }
    options = {};
    options.lift = 2e-5f;
    const auto cubes = test::hemicubes(sites, &cabin.scene, options);
    for (const auto& [width, group] : {std::pair(1, 16u), {4, 1u}, {0, 16u}}) {
        BuildOptions build;
        build.packet_width = width;
        build.local_size = group;
        const VplPasses passes(test::programs(), build);
        const auto rows = test::transport_rows(sites, cubes, true, 1.0f, passes);
        for (std::size_t i = 0; i < n; ++i)
            expect_row(rows, i, i, "width " + std::to_string(width));
    }
    // A packet holds parts of a site, one, or several.
    for (const std::uint32_t most : {1u, 2u, 3u, 5u}) {
        BuildOptions build;
        build.packet_width = 1;
        const auto one = test::transport_rows(sites, cubes, true, 1.0f,
                                              VplPasses(test::programs(), build), most);
        for (const int width : test::widths()) {
            build.packet_width = width;
            EXPECT_EQ(test::transport_rows(sites, cubes, true, 1.0f,
                                           VplPasses(test::programs(), build), most),
                      one)
                << most << " samples, width " << width;
        }
    }
}

// ---- at the edges of its range ----------------------------------------------------------------

TEST(Transport, OfNothingAndOfOneSite) {
    const Sites one({dot({0, 0, 0}, {0, 0, 1}, 0.1f)});
    const auto rows = test::transport_rows(one, test::hemicubes(one, nullptr));
    EXPECT_EQ(rows[0], 0);
    SiteBuffers none = one.buffers;
    none.site_count = none.sample_count = 0;
    none.most_samples = none.per_site = 1;
    none.point_stride = 16;
    none.points = test::empty<float>(SITE_POINT_PLANES * 16);
    test::vpl_passes().points(test::device().queue, none).wait();
    test::vpl_passes()
        .transport(test::device().queue, {0, 0, 0, 0, 16, 16, 64, 1.0f, 0, 0, 0, 0}, none,
                   test::empty<View>(5), one.buffers.light, one.buffers.light)
        .wait();
}

TEST(Transport, OfASiteWithoutSurfaceIsZero) {
    const Sites sites({dot({0, 0, 0}, {0, 0, 0}, 0.1f), dot({0, 0, 0.5}, {0, 0, -1}, 0.1f)});
    const auto rows = test::transport_rows(sites, test::hemicubes(sites, nullptr), true);
    EXPECT_EQ(rows[1], 0);
    EXPECT_EQ(rows[sites.buffers.stride], 0);
}

// In the same plane, back to back, behind each other, at one point: exactly nothing.
TEST(Transport, BetweenSitesThatDoNotFaceEachOtherIsZero) {
    const Sites sites({dot({0, 0, 0}, {0, 0, 1}, 0.1f), dot({0.4, 0.1, 0}, {0, 0, 1}, 0.1f),
                       dot({0, 0, -0.5}, {0, 0, -1}, 0.1f), dot({0, 0, 0.5}, {0, 0, 1}, 0.1f),
                       dot({0, 0, 0}, {0, 0, -1}, 0.1f)});
    const auto rows = test::transport_rows(sites, test::hemicubes(sites, nullptr), true);
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j)
            EXPECT_EQ(rows[i * sites.buffers.stride + j], 0) << i << " to " << j;
}

TEST(Transport, IsNeverMoreThanAHalfHolds) {
    const Sites sites({dot({0, 0, 0}, {0, 0, 1}, 1e-4f), dot({0, 0, 0.02}, {0, 0, -1}, 1e-4f)});
    const auto cubes = test::hemicubes(sites, nullptr);
    const auto value = [&](float scale) {
        return glm::unpackHalf1x16(test::transport_rows(sites, cubes, true, scale)[1]);
    };
    const double wanted = test::disc_kernel(4e-4, 4e-4, 1e-4 / test::pi) / test::pi;
    EXPECT_NEAR(value(1.0f), wanted, wanted * (half_rounding + 1e-5));
    EXPECT_EQ(value(1000.0f), 65504.0f);
    EXPECT_TRUE(std::isnan(value(std::numeric_limits<float>::quiet_NaN())));
}

// Room for what small sites send: the same number, divided by a power of two.
TEST(Transport, OfASmallSiteIsDividedByItsPowerOfTwo) {
    std::vector<SitePlace> places = {dot({0, 0, 0}, {0, 0, 1}, 1e-4f),
                                     dot({0, 0, 0.02}, {0, 0, -1}, 1e-4f)};
    places[0].row_exponent = 5;
    const Sites sites(places);
    const auto cubes = test::hemicubes(sites, nullptr);
    const double kernel = test::disc_kernel(4e-4, 4e-4, 1e-4 / test::pi) / test::pi;
    for (const float scale : {1.0f, 1000.0f}) {
        const auto rows = test::transport_rows(sites, cubes, true, scale);
        for (const std::size_t from : {0u, 1u}) {
            const float found = glm::unpackHalf1x16(rows[from * sites.buffers.stride + (1 - from)]);
            // That of the other one has no such room.
            const double wanted =
                from == 0 ? scale * kernel / 32 : std::min(scale * kernel, 65504.0);
            EXPECT_NEAR(found, wanted, wanted * (half_rounding + 1e-5)) << scale << ", " << from;
        }
    }
}

}  // namespace
}  // namespace clgi
