// The lookup of irradiance volumes against closed forms and in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/atlas.hpp>
#include <cmath>
#include <limits>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// A colour that is a polynomial of degree 2 of the direction, and its part that changes in space.
glm::dvec3 light_at(const glm::dvec3& at, const glm::dvec3& n, double changes = 1.0) {
    const double along = 5.0 + changes * (0.4 * at.x - 0.3 * at.y + 0.2 * at.z);
    return {along * (1.0 + 0.2 * n.x - 0.1 * n.y), along + n.x * n.y + 0.5 * n.z * n.z - 0.7 * n.z,
            3.0 + (2.0 + changes * at.y) * n.y * n.z + n.x};
}

// Equal cubes in the open.
IrradianceVolume grid(const glm::dvec3& first, double spacing, const glm::ivec3& count) {
    const glm::dvec3 low = first - 0.5 * spacing;
    const IrradianceVolume out = make_irradiance_volume({low, low + spacing * glm::dvec3(count)},
                                                        count.x * count.y * count.z);
    EXPECT_EQ(out.count, count);
    return out;
}

// Surfaces that look a volume up: a triangle without a chart and one with one.
struct Looked {
    IrradianceVolume volume;
    std::vector<glm::dvec3> places;
    std::vector<glm::vec3> normals;
    std::vector<std::int32_t> triangles;
    std::vector<float> light;  // [3][stride]
    std::uint32_t first = 32, stride = 0;

    explicit Looked(const IrradianceVolume& of = grid({-1.0, 0.5, 2.0}, 0.75, {4, 3, 2}),
                    double changes = 1.0)
        : volume(of) {
        const std::vector<BakePoint> points = points_of(volume);
        stride = plane_stride(first + points.size());
        light.assign(3 * std::size_t{stride}, -77.0f);
        for (std::size_t i = 0; i < points.size(); ++i)
            set(i, light_at(points[i].position, points[i].normal, changes));
    }
    void set(std::size_t point, const glm::dvec3& value) {
        for (int c = 0; c < 3; ++c)
            light[static_cast<std::size_t>(c) * stride + first + point] =
                static_cast<float>(value[c]);
    }
    // The same in all directions.
    void set_all(std::size_t point, const glm::dvec3& value) {
        for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i)
            set(point * VOLUME_DIRECTIONS + i, value);
    }
    void look(const glm::dvec3& at, const glm::vec3& normal, std::int32_t triangle = 0) {
        places.push_back(at);
        normals.push_back(normal);
        triangles.push_back(triangle);
    }

    // What is there before is -5.
    std::vector<glm::vec3> operator()() const {
        SceneFrame frame;
        frame.origin = {0.3, 0.2, -0.1};
        frame.scale = 0.125;
        const auto count = static_cast<std::uint32_t>(places.size());
        const std::uint32_t pixels = plane_stride(count);
        std::vector<float> planes(GBUFFER_PLANES * pixels);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * pixels, -1);
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::vec3 at = frame.to_local(places[i]);
            for (int c = 0; c < 3; ++c) {
                planes[(GBUFFER_POSITION + static_cast<unsigned>(c)) * pixels + i] = at[c];
                planes[(GBUFFER_NORMAL + static_cast<unsigned>(c)) * pixels + i] = normals[i][c];
            }
            ids[GBUFFER_TRIANGLE * pixels + i] = triangles[i];
        }
        const glm::vec3 origin = frame.to_local(volume.first);
        const VolumeParams params{
            float4(origin, static_cast<float>(1.0 / (volume.spacing * frame.scale))),
            count,
            pixels,
            2,
            static_cast<std::uint32_t>(volume.count.x),
            static_cast<std::uint32_t>(volume.count.y),
            static_cast<std::uint32_t>(volume.count.z),
            first,
            stride,
            volume.open_count,
            {}};
        const GBuffer seen{test::upload(planes), test::upload(ids), pixels, Storage::full};
        const cl::Buffer charts =
            test::upload(std::vector<std::uint32_t>{ATLAS_NONE, ATLAS_NONE, 0, 3});
        // A buffer has a byte at least.
        std::vector<glm::vec2> distances = volume.distances;
        distances.resize(distances.size() + 1);
        const VolumeBuffers buffers{test::upload(volume.places), test::upload(distances)};
        const cl::Buffer out = test::upload(std::vector<float>(3 * std::size_t{pixels}, -5.0f));
        AtlasPasses(test::programs(), test::usual_build())
            .volume(test::device().queue, params, seen, charts, buffers, test::upload(light), out);
        return test::vectors(test::device().queue, out, pixels, count);
    }
};

const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));

// The texel within a map that the one at column u and row v repeats, each from -1 to VOLUME_SIDE:
// beyond a side the map goes on where that side's other half is.
std::size_t texel_of(int u, int v) {
    int at[2] = {u, v};
    for (int axis = 0; axis < 2; ++axis)
        if (at[axis] < 0 || at[axis] >= VOLUME_SIDE) {
            at[axis] = at[axis] < 0 ? 0 : VOLUME_SIDE - 1;
            at[1 - axis] = VOLUME_SIDE - 1 - at[1 - axis];
        }
    return static_cast<std::size_t>((at[1] + 1) * VOLUME_ROW + at[0] + 1);
}

// Mean and mean square of a map in a direction.
glm::dvec2 distances_along(const glm::vec2* map, const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const glm::dvec3 d = direction / (size.x + size.y + size.z);
    glm::dvec2 at(d);
    if (d.z < 0.0)
        at = {std::copysign(1.0 - std::abs(d.y), d.x), std::copysign(1.0 - std::abs(d.x), d.y)};
    at = (at + 1.0) * 0.5 * double{VOLUME_SIDE} - 0.5;
    glm::dvec2 out(0.0);
    for (int k = 0; k < 4; ++k) {
        const glm::dvec2 corner = glm::floor(at) + glm::dvec2(k & 1, k >> 1);
        const glm::dvec2 share = 1.0 - glm::abs(at - corner);
        out += share.x * share.y *
               glm::dvec2(map[texel_of(static_cast<int>(corner.x), static_cast<int>(corner.y))]);
    }
    return out;
}

// Irradiance as the header of kernels/atlas/volume.cl has it.
glm::dvec3 reference(const Looked& looked, const glm::dvec3& at, const glm::dvec3& n) {
    const IrradianceVolume& v = looked.volume;
    const std::vector<BakePoint> points = points_of(v);
    const glm::dvec3 grid_at = (at - v.first) / v.spacing, from = grid_at + 0.05 * n;
    const glm::dvec3 place = glm::clamp(grid_at, glm::dvec3(0.0), glm::dvec3(v.count - 1));
    glm::dvec3 sum(0.0);
    double all = 0.0;
    for (std::size_t i = 0; i < v.places.size(); ++i) {
        if (v.places[i].w < 0.0f) continue;
        const glm::dvec3 cube(i % std::size_t(v.count.x),
                              i / std::size_t(v.count.x) % std::size_t(v.count.y),
                              i / std::size_t(v.count.x * v.count.y));
        const glm::dvec3 near = glm::max(1.0 - glm::abs(place - cube), 0.0);
        const auto point = static_cast<std::size_t>(v.places[i].w);
        const glm::dvec3 to = glm::dvec3(v.places[i]) - from;
        const double faces = 0.5 + 0.5 * glm::dot(glm::normalize(to), n);
        const glm::dvec2 surfaces =
            distances_along(&v.distances[point * VOLUME_TEXELS], -glm::normalize(to));
        const double beyond = std::min(glm::length(to), double{VOLUME_RANGE}) - surfaces.x;
        const double variance = std::max(surfaces.y - surfaces.x * surfaces.x, 1e-4);
        const double seen =
            beyond > 0.0 ? std::pow(variance / (variance + beyond * beyond), 3.0) : 1.0;
        const double counts = near.x * near.y * near.z * (faces * faces + 0.2) * seen;
        all += counts;
        glm::dvec3 lit(0.0);
        for (std::size_t k = 0; k < VOLUME_DIRECTIONS; ++k) {
            const double c = glm::dot(n, glm::dvec3(points[k].normal));
            for (int channel = 0; channel < 3; ++channel)
                lit[channel] +=
                    (1.0 + 3.0 * c + 2.5 * (3.0 * c * c - 1.0)) / 12.0 *
                    double{looked.light[static_cast<std::size_t>(channel) * looked.stride +
                                        looked.first + point * VOLUME_DIRECTIONS + k]};
        }
        sum += counts * glm::max(lit, 0.0);
    }
    return all > 0.0 ? sum / all : glm::dvec3(0.0);
}

// Distances of no scene, means up to VOLUME_RANGE; one point in five lies in solid matter, and the
// others beside the middles of their cubes.
IrradianceVolume random_volume() {
    IrradianceVolume out = grid({-1.0, 0.5, 2.0}, 0.75, {4, 3, 2});
    test::Random random(17);
    out.open_count = 0;
    for (glm::vec4& place : out.places) {
        for (int k = 0; k < 3; ++k) place[k] += static_cast<float>(random(-0.3, 0.3));
        place.w = random(0, 1) < 0.2 ? -1.0f : static_cast<float>(out.open_count++);
    }
    out.distances.clear();
    for (std::size_t i = 0; i < std::size_t{out.open_count} * VOLUME_TEXELS; ++i) {
        const double mean = random(0.1, double{VOLUME_RANGE}), deviation = random(0.0, 0.5);
        out.distances.emplace_back(mean, mean * mean + deviation * deviation);
    }
    for (std::size_t map = 0; map < out.distances.size(); map += VOLUME_TEXELS)
        for (int v = -1; v <= VOLUME_SIDE; ++v)
            for (int u = -1; u <= VOLUME_SIDE; ++u)
                out.distances[map + static_cast<std::size_t>((v + 1) * VOLUME_ROW + u + 1)] =
                    out.distances[map + texel_of(u, v)];
    return out;
}

// Normals all around, places in and around the grid.
void look_around(Looked& looked, int count) {
    for (int k = 0; k < count; ++k) {
        const double u = std::fmod(0.618 * k, 1.0), v = std::fmod(0.414 * k, 1.0);
        const double z = 1.0 - 2.0 * (k + 0.5) / count, s = std::sqrt(1.0 - z * z);
        looked.look({-1.3 + 2.85 * u, 0.2 + 2.1 * v, 1.7 + 1.35 * u * v},
                    {s * std::cos(2.4 * k), z, s * std::sin(2.4 * k)});
    }
}

CLGI_IN_BOTH_MATHS(VolumeLookup);

// Light that is the same everywhere stays so, whatever walls there are.
TEST_P(VolumeLookup, BringsPolynomialsOfDegreeTwoBack) {
    for (const bool walls : {false, true}) {
        Looked looked = walls ? Looked(random_volume(), 0.0) : Looked(Looked().volume, 0.0);
        look_around(looked, 200);
        const auto found = looked();
        for (std::size_t i = 0; i < found.size(); ++i) {
            const bool solid =  // all around
                reference(looked, looked.places[i], looked.normals[i]) == glm::dvec3(0.0);
            EXPECT_TRUE(walls || !solid) << i;
            const glm::dvec3 wanted =
                solid ? glm::dvec3(0.0) : light_at({}, looked.normals[i], 0.0);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], wanted[c], 1e-4) << i << " " << c;
        }
    }
}

// Floats add up some thirty terms of at most 20, and squares of distances less those of means.
TEST_P(VolumeLookup, WeighsPointsAsInDoublePrecision) {
    for (const bool walls : {false, true}) {
        Looked looked = walls ? Looked(random_volume()) : Looked();
        look_around(looked, 300);
        const auto found = looked();
        for (std::size_t i = 0; i < found.size(); ++i) {
            const glm::dvec3 wanted = reference(looked, looked.places[i], looked.normals[i]);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], wanted[c], 1e-3) << i << " " << c;
        }
    }
}

TEST_P(VolumeLookup, TakesTheNearestPointsOutsideOfTheGrid) {
    Looked looked;
    looked.look({-9.0, 1.25, 2.0}, tilted);
    looked.look({0.5, 40.0, 2.0}, tilted);
    looked.look({0.5, 1.25, 1e6}, tilted);
    const auto found = looked();
    const glm::dvec3 nearest[3] = {{-1.0, 1.25, 2.0}, {0.5, 2.0, 2.0}, {0.5, 1.25, 2.75}};
    for (std::size_t i = 0; i < 3; ++i)
        for (int c = 0; c < 2; ++c)
            EXPECT_NEAR(found[i][c], light_at(nearest[i], tilted)[c], 2e-4) << i;
}

// In the middle between a point in front and one behind, these count 1.2 and 0.2.
TEST_P(VolumeLookup, PrefersPointsInFrontOfTheSurface) {
    Looked looked(grid({0.0, 0.0, 0.0}, 1.0, {2, 1, 1}));
    looked.set_all(0, {1.0, 2.0, 4.0});
    looked.set_all(1, {3.0, 1.0, 0.5});
    looked.look({0.5, 0.0, 0.0}, {1.0f, 0.0f, 0.0f});
    looked.look({0.25, 0.0, 0.0}, {-1.0f, 0.0f, 0.0f});
    looked.look({0.5, 0.0, 0.0}, {0.0f, 1.0f, 0.0f});
    const auto found = looked();
    const glm::dvec3 a(1.0, 2.0, 4.0), b(3.0, 1.0, 0.5);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[0][c], (0.2 * a[c] + 1.2 * b[c]) / 1.4, 1e-5);
        EXPECT_NEAR(found[1][c], (0.75 * 1.2 * a[c] + 0.25 * 0.2 * b[c]) / 0.95, 1e-5);
        EXPECT_NEAR(found[2][c], 0.5 * (a[c] + b[c]), 1e-5);
    }
}

// A wall between two points, a tenth of the spacing thick: each lights its own side, right up to
// the wall, and less than a fiftieth of its light comes through.
TEST_P(VolumeLookup, LightsNothingBeyondAWall) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {0.45, -3.0, -3.0}, {0.55, 3.0, 3.0}, 1);
    Looked looked(make_irradiance_volume({glm::dvec3(-0.5), {1.5, 0.5, 0.5}}, 2, scene));
    ASSERT_EQ(looked.volume.count, glm::ivec3(2, 1, 1));
    const glm::dvec3 a(1.0, 2.0, 4.0), b(3.0, 1.0, 0.5);
    looked.set_all(0, a);
    looked.set_all(1, b);
    for (const double x : {0.1, 0.3, 0.44, 0.56, 0.7, 0.9})
        for (const double aside : {0.0, 0.2, -0.4})
            for (const glm::vec3& n : {tilted, -tilted}) looked.look({x, aside, 0.5 * aside}, n);
    const auto found = looked();
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[i][c], (i < found.size() / 2 ? a : b)[c],
                        0.02 * std::abs(a[c] - b[c]))
                << i << " " << c;
}

// Distances 0.5 around each of two points, of no variance. A surface that faces away from a point
// at just this distance is lifted off it, to where 1e-4 of variance leaves it 1 / 26^3.
TEST_P(VolumeLookup, LiftsPlacesOffTheirSurface) {
    Looked looked(grid({0.0, 0.0, 0.0}, 1.0, {2, 1, 1}));
    looked.volume.distances.assign(looked.volume.distances.size(), glm::vec2(0.5f, 0.25f));
    looked.set_all(0, glm::dvec3(0.0));
    looked.set_all(1, {1.0, 2.0, 4.0});
    looked.look({0.5, 0.0, 0.0}, {1.0f, 0.0f, 0.0f});
    const auto found = looked();
    const double behind = 0.2 / (26.0 * 26.0 * 26.0);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[0][c] / (1 << c), 1.2 / (1.2 + behind), 1e-6) << c;
}

TEST_P(VolumeLookup, LeavesSurfacesOfTheAtlasAndTheBackground) {
    Looked looked;
    looked.look({0.0, 1.0, 2.2}, tilted, 1);
    looked.look({0.0, 1.0, 2.2}, tilted, -1);
    looked.look({0.0, 1.0, 2.2}, tilted, 2);  // of no scene
    looked.look({0.0, 1.0, 2.2}, tilted, 0);
    const auto found = looked();
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(found[static_cast<std::size_t>(i)], glm::vec3(-5.0f)) << i;
    EXPECT_GT(found[3].x, 0.0f);
}

// Points in solid matter have no light, their neighbours count alone, and none is left between
// nothing but such points.
TEST_P(VolumeLookup, LeavesSolidMatterOut) {
    Looked looked(grid({0.0, 0.0, 0.0}, 1.0, {3, 1, 1}));
    looked.volume.places[1].w = looked.volume.places[2].w = -1.0f;
    looked.volume.open_count = 1;
    looked.set_all(0, {1.0, 2.0, 4.0});
    looked.look({0.9, 0.1, -0.2}, tilted);
    looked.look({1.5, 0.1, -0.2}, tilted);
    const auto found = looked();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[0][c], 1 << c, 1e-5);
    EXPECT_EQ(found[1], glm::vec3(0.0f));
}

// Darkness is light like any other: a dark point in the open counts as much as a lit one.
TEST_P(VolumeLookup, CountsDarkPoints) {
    Looked looked(grid({0.0, 0.0, 0.0}, 1.0, {2, 1, 1}));
    looked.set_all(0, {1.0, 2.0, 4.0});
    looked.set_all(1, glm::dvec3(0.0));
    looked.look({0.5, 0.0, 0.0}, {0.0f, 1.0f, 0.0f});
    looked.look({1.0, 0.0, 0.0}, {0.0f, 1.0f, 0.0f});
    const auto found = looked();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[0][c], 0.5 * (1 << c), 1e-5);
    EXPECT_EQ(found[1], glm::vec3(0.0f));
}

TEST_P(VolumeLookup, HasNoLightBelowZero) {
    Looked looked;
    // All light comes from one direction; seen from behind, the bands swing below zero.
    for (std::size_t point = 0; point < 24; ++point)
        for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i)
            looked.set(point * VOLUME_DIRECTIONS + i, glm::dvec3(i == 0 ? 1.0 : 0.0));
    const glm::vec3 from = points_of(looked.volume)[0].normal;
    const glm::vec3 aside = glm::normalize(glm::cross(from, glm::vec3(1.0f, 0.2f, 0.1f)));
    looked.look({0.0, 1.0, 2.2}, glm::normalize(aside - 0.4f * from));
    looked.look({0.0, 1.0, 2.2}, from);
    const auto found = looked();
    EXPECT_EQ(found[0], glm::vec3(0.0f));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[1][c], 9.0 / 12.0, 1e-5);
}

TEST_P(VolumeLookup, SaysWhatIsNotFinite) {
    Looked looked;
    looked.look({std::numeric_limits<double>::quiet_NaN(), 1.0, 2.2}, tilted);
    looked.look({0.0, 1.0, 2.2}, tilted);
    looked.look({0.0, 1.0, 2.2}, {0.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f});
    looked.look({3e38, 1.0, 2.2}, tilted);  // farther than the grid's unit can count
    const auto found = looked();
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isnan(found[0][c]));
        EXPECT_TRUE(std::isfinite(found[1][c]));
        EXPECT_TRUE(std::isnan(found[2][c]));
        EXPECT_FALSE(std::isfinite(found[3][c]));
    }
    // Light that is none reaches the surfaces around it.
    for (const float none :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        looked.set(0, glm::dvec3(none));
        looked.look({-0.9, 0.6, 2.1}, tilted);
        EXPECT_FALSE(std::isfinite(looked().back().x));
        EXPECT_TRUE(std::isfinite(looked()[1].x));
    }
}

}  // namespace
}  // namespace clgi
