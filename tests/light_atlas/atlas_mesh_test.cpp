// The mesh M of the paper's filling: what its corners see, and its triangles in every chart.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "math_modes.hpp"
#include "one_batch.hpp"

namespace clgi {
namespace {

using test::HandVpl;
using test::OneBatch;

constexpr double u24 = 0x1p-24;

// A face's corner on the image plane, by its number within the hemicube.
struct Corner {
    int face;
    glm::dvec2 at;
};

std::vector<Corner> corners_of(std::uint32_t squares) {
    std::vector<Corner> out;
    for (int face = 0; face < 5; ++face)
        for (std::uint32_t line = 0; line <= (face == 0 ? squares : squares / 2); ++line)
            for (std::uint32_t column = 0; column <= squares; ++column)
                out.push_back({face, {-1.0 + 2.0 * column / squares, 1.0 - 2.0 * line / squares}});
    return out;
}

// The three corners of every triangle, by number.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::uint32_t squares) {
    std::vector<std::array<std::uint32_t, 3>> out;
    std::uint32_t first = 0;
    const std::uint32_t row = squares + 1;
    for (int face = 0; face < 5; ++face) {
        const std::uint32_t lines = face == 0 ? squares : squares / 2;
        for (std::uint32_t line = 0; line < lines; ++line)
            for (std::uint32_t column = 0; column < squares; ++column) {
                const std::uint32_t at = first + line * row + column;
                out.push_back({at, at + 1, at + row});
                out.push_back({at + row + 1, at + row, at + 1});
            }
        first += row * (lines + 1);
    }
    return out;
}

OneBatch turned_cube(int size) {
    const Scene scene = test::turned(test::inside_of_cube(), {3.0, -2.0, 1.0});
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(64));
    // Off the middle of two faces, above their planes.
    const glm::dvec3 a = geometry::corner(scene, 0, 0), b = geometry::corner(scene, 0, 1),
                     c = geometry::corner(scene, 0, 2);
    const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
    const glm::dvec3 middle(3.0, -2.0, 1.0);
    const HandVpl first{a + 0.3 * (b - a) + 0.4 * (c - a), n};
    const HandVpl second{middle + 0.1 * (b - a), glm::normalize(n + 0.5 * (b - a))};
    return OneBatch(scene, atlas, {first, second}, size);
}

TEST(AtlasGeometry, FollowsThePlanesOfTheTrianglesSeen) {
    for (const auto& [size, squares] : {std::pair{64, 16u}, {50, 8u}}) {
        OneBatch batch = turned_cube(size);
        batch.make_copies(squares);
        const auto places = corners_of(squares);
        ASSERT_EQ(places.size(), MESH_CORNERS(squares));
        const auto found =
            test::download<MeshCorner>(batch.mesh.corners, 2 * MESH_CORNERS(squares));
        const auto views = test::download<View>(batch.views, 10);
        const auto words = test::download<std::uint64_t>(batch.visibility,
                                                         std::size_t{6} * batch.size * batch.size);
        const auto triangles = test::download<glm::uvec4>(batch.device_scene.triangles(), 12);
        const auto positions = test::download<glm::vec4>(batch.device_scene.positions(),
                                                         batch.device_scene.info().vertex_count);
        const auto uvs = test::download<glm::vec2>(batch.mesh.uvs, 36);
        const auto charts = test::download<std::uint32_t>(batch.mesh.charts, 12);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const Corner& place = places[i % places.size()];
            const View& view = views[5 * (i / places.size()) + place.face];
            const int column = std::min(int((place.at.x + 1) * size / 2), int(view.width) - 1);
            const int line = std::min(int((1 - place.at.y) * size / 2), int(view.height) - 1);
            const auto triangle = static_cast<std::uint32_t>(
                words[view.first_pixel + static_cast<std::uint32_t>(line) * view.width +
                      static_cast<std::uint32_t>(column)]);
            const glm::uvec4 t = triangles[triangle];
            const glm::dvec3 a(positions[t.x]), e1 = glm::dvec3(positions[t.y]) - a,
                                                e2 = glm::dvec3(positions[t.z]) - a,
                                                n = glm::cross(e1, e2);
            const glm::dvec3 eye(view.eye), to = a - eye;
            // The plane met by the ray: 1/depth, and the atlas coordinates there.
            const auto exact = [&](const glm::dvec2& at, double& bound) {
                const glm::dvec3 r = glm::dvec3(view.forward) + at.x * glm::dvec3(view.right) +
                                     at.y * glm::dvec3(view.up);
                const double z = glm::dot(n, to) / glm::dot(n, r);
                const glm::dvec3 p = eye + z * r - a;
                const double b1 = glm::dot(glm::cross(e2, n), p) / glm::dot(n, n);
                const double b2 = glm::dot(glm::cross(n, e1), p) / glm::dot(n, n);
                const glm::dvec2 uv = glm::dvec2(uvs[3 * triangle]) * (1.0 - b1 - b2) +
                                      b1 * glm::dvec2(uvs[3 * triangle + 1]) +
                                      b2 * glm::dvec2(uvs[3 * triangle + 2]);
                // W is a quotient of dot products: each is off by a few u of its factors' lengths.
                bound = 16 * u24 * glm::length(n) * glm::length(r) / std::abs(glm::dot(n, to)) *
                        (1.0 + glm::length(to) * glm::length(n) / std::abs(glm::dot(n, to)));
                return glm::dvec3(uv / z, 1.0 / z);
            };
            double bound = 0.0;
            const glm::dvec3 own = exact(place.at, bound);
            const MeshCorner& got = found[i];
            if (got.chart == MESH_NO_CHART) {
                // Half a pixel beside what was seen the plane is met from behind.
                EXPECT_LT(own.z, 0.05) << "corner " << i;
                continue;
            }
            ASSERT_EQ(got.chart, charts[triangle]) << "corner " << i;
            const double texels = 64.0;  // the largest atlas coordinate
            EXPECT_NEAR(got.w, own.z, bound);
            EXPECT_NEAR(got.u, own.x, 4 * texels * bound);
            EXPECT_NEAR(got.v, own.y, 4 * texels * bound);
            // Eq. 11, on the same plane: exact however far away.
            const glm::dvec2 step(0.37, -0.21);
            const glm::dvec3 other = exact(place.at + step, bound);
            EXPECT_NEAR(got.w + step.x * got.w_right + step.y * got.w_up, other.z, 2 * bound);
            EXPECT_NEAR(got.u + step.x * got.u_right + step.y * got.u_up, other.x,
                        8 * texels * bound);
            EXPECT_NEAR(got.v + step.x * got.v_right + step.y * got.v_up, other.y,
                        8 * texels * bound);
        }
    }
}

TEST(AtlasGeometry, SeesNothingInTheBackgroundAndInTrianglesWithoutChart) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_floor(scene, 1.0, -1.0);
    const AtlasLayout atlas = make_atlas(scene, test::regions(scene, 2), test::made_charts(32));
    OneBatch batch(scene, atlas, {HandVpl{{0.0, 0.5, 0.0}, {0.0, -1.0, 0.0}}}, 32);
    const auto in_charts = [&] {
        batch.make_copies(8);
        const auto found = test::download<MeshCorner>(batch.mesh.corners, MESH_CORNERS(8));
        return std::count_if(found.begin(), found.end(),
                             [](const MeshCorner& c) { return c.chart != MESH_NO_CHART; });
    };
    // The floor fills the first face, and of the sides what is above 1/2: the corners at 1 and 3/4.
    // Those at 1/2 belong to the pixels below.
    EXPECT_EQ(in_charts(), 9 * 9 + 4 * 9 * 2);
    batch.mesh.charts = test::upload(std::vector<std::uint32_t>(4, MESH_NO_CHART));
    EXPECT_EQ(in_charts(), 0);
}

// Corners filled by hand; the copies of triangle 0 of the first face with 2 x 2 squares, whose
// corners lie at (-1, 1), (0, 1) and (-1, 0).
struct Copies {
    std::vector<MeshCorner> corners{MESH_CORNERS(2)};
    Copies() {
        for (MeshCorner& corner : corners) corner.chart = MESH_NO_CHART;
    }
    std::vector<MeshCopy> operator()() const {
        MeshBuffers mesh;
        mesh.corners = test::upload(corners);
        mesh.boxes = test::upload(
            std::vector<float4>{{-1e6, -1e6, 1e6, 1e6}, {10, 20, 30, 40}, {0, 0, 8, 8}});
        mesh.chart_count = 3;
        mesh.copies = test::empty<MeshCopy>(MESH_TRIANGLES(2) * MESH_COPIES);
        test::atlas_passes().replicate(test::device().queue, {1, 16, 2, 0}, mesh);
        return test::download<MeshCopy>(mesh.copies, MESH_TRIANGLES(2) * MESH_COPIES);
    }
};

MeshCorner at_corner(std::uint32_t chart, float u, float v, float w) {
    MeshCorner out{};
    out.chart = chart;
    out.u = u * w;
    out.v = v * w;
    out.w = w;
    return out;
}

CLGI_IN_BOTH_MATHS(Extrapolation);

// The floor y = -1 seen from a side: W = -y. An extrapolation from W to `to` one unit below.
MeshCopy extrapolated(float w, float to) {
    Copies copies;
    copies.corners[0] = at_corner(0, 100.0f, 200.0f, w);
    copies.corners[0].w_up = w - to;
    copies.corners[0].u_up = 100.0f * (w - to);  // u stays what it is
    copies.corners[0].v_up = 0.25f;
    return copies()[0];
}

TEST_P(Extrapolation, ExtrapolatesDepthExactlyOnAPlane) {
    for (const auto& [from, to, depth] :
         {std::tuple{0.5f, 0.25f, 4.0}, {0.01f, 0.001f, 1000.0}, {0.5f, 0.125f, 8.0}}) {
        const MeshCopy copy = extrapolated(from, to);
        ASSERT_EQ(copy.chart, 0u);
        EXPECT_FLOAT_EQ(copy.depth.x, from);
        EXPECT_EQ(copy.depth.y, 0.0f);
        const double below = copy.depth.x - double{copy.depth.z};
        EXPECT_NEAR(1.0 / below, depth, 16 * u24 / to * depth);
        EXPECT_FLOAT_EQ(copy.depth.w, 1e-3f * from);
        // v: (200 from - 0.25) / to at the third corner, 200 at the others; u: 100 everywhere.
        const double v = (200.0 * from - 0.25) / to;
        const double margin = 1.0 + 0.25 * std::abs(v - 200.0);
        const double close = 64 * u24 * (std::abs(v) + 200.0) * from / to;
        EXPECT_NEAR(copy.box.x, 99.0, close);
        EXPECT_NEAR(copy.box.z, 101.0, close);
        EXPECT_NEAR(copy.box.y, std::min(200.0, v) - margin, close);
        EXPECT_NEAR(copy.box.w, std::max(200.0, v) + margin, close);
    }
}

TEST_P(Extrapolation, RejectsWhatReachesTheHorizon) {
    for (const float to : {0.0f, -0.02f, 0.00049f, -0.5f}) {
        const MeshCopy copy = extrapolated(0.5f, to);
        EXPECT_EQ(copy.chart, 0u);
        EXPECT_EQ(copy.box, float4(-1e6, -1e6, 1e6, 1e6)) << to;
        // The plane stays: it tells which texels lie before the horizon.
        EXPECT_NEAR(copy.depth.x - copy.depth.z, to, 4 * u24);
        EXPECT_FLOAT_EQ(copy.depth.w, 0.0005f);
    }
    EXPECT_NE(extrapolated(0.5f, 0.00051f).box, float4(-1e6, -1e6, 1e6, 1e6));
}

TEST(AtlasReplicate, MakesACopyForEveryChart) {
    const auto charts = [](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        Copies copies;
        copies.corners[0] = at_corner(a, 12.0f, 22.0f, 0.5f);
        copies.corners[1] = at_corner(b, 14.0f, 23.0f, 0.25f);
        copies.corners[3] = at_corner(c, 13.0f, 26.0f, 1.0f);
        std::vector<std::uint32_t> out;
        for (const MeshCopy& copy : copies())
            if (out.size() < MESH_COPIES) out.push_back(copy.chart);
        return out;
    };
    using List = std::vector<std::uint32_t>;
    constexpr std::uint32_t none = MESH_NO_CHART;
    EXPECT_EQ(charts(1, 1, 1), (List{1, none, none}));
    EXPECT_EQ(charts(1, 0, 1), (List{1, 0, none}));
    EXPECT_EQ(charts(0, 1, 1), (List{0, 1, none}));
    EXPECT_EQ(charts(0, 1, 2), (List{0, 1, 2}));
    EXPECT_EQ(charts(none, none, 2), (List{none, none, 2}));
    EXPECT_EQ(charts(none, none, none), (List{none, none, none}));
}

TEST(AtlasReplicate, TakesCornersOfItsChartAsTheyAreAndKeepsToTheChart) {
    Copies copies;
    copies.corners[0] = at_corner(1, 12.0f, 22.0f, 0.5f);
    copies.corners[1] = at_corner(1, 14.0f, 23.0f, 0.25f);
    copies.corners[3] = at_corner(1, 29.0f, 26.0f, 1.0f);
    for (int k : {0, 1, 3}) copies.corners[k].w_right = copies.corners[k].u_up = 77.0f;
    const MeshCopy copy = copies()[0];
    EXPECT_EQ(copy.depth, float4(0.5f, -0.25f, -0.5f, 0.0f));
    // u: 12 .. 29 and a margin of 1 + 17/4; v: 22 .. 26 and 1 + 4/4. The chart: 10 .. 30, 20 .. 40.
    EXPECT_EQ(copy.box, float4(10.0f, 20.0f, 30.0f, 28.0f));
}

// Planes of three charts over the view, and every corner in one of them at random.
TEST(AtlasReplicate, ReproducesPlanesInAllTriangles) {
    constexpr std::uint32_t squares = 6, shooters = 2;
    struct Plane {
        double u[3], v[3], w[3];  // value = [0] + [1] x + [2] y
    };
    const Plane planes[3] = {{{3, 1, 0.5}, {2, -1, 0.25}, {1.0, 0.1, 0.2}},
                             {{1, 0.3, -0.5}, {4, 1, 1}, {0.9, -0.3, 0.1}},
                             {{-2, 0.7, 0.2}, {1, -0.5, 0.1}, {2.0, 0.2, -0.6}}};
    const auto at = [](const double* p, const glm::dvec2& place) {
        return p[0] + p[1] * place.x + p[2] * place.y;
    };
    const auto places = corners_of(squares);
    std::vector<MeshCorner> corners;
    test::Random random(5);
    for (std::uint32_t i = 0; i < shooters * places.size(); ++i) {
        const auto chart = static_cast<std::uint32_t>(random.integer(0, 2));
        const Plane& p = planes[chart];
        const glm::dvec2& place = places[i % places.size()].at;
        const auto f = [](double x) { return static_cast<float>(x); };
        corners.push_back({f(at(p.u, place)), f(at(p.v, place)), f(at(p.w, place)), chart,
                           f(p.u[1]), f(p.v[1]), f(p.w[1]), 0, f(p.u[2]), f(p.v[2]), f(p.w[2]), 0});
    }
    MeshBuffers mesh;
    mesh.corners = test::upload(corners);
    mesh.boxes = test::upload(std::vector<float4>(3, float4(-1e6, -1e6, 1e6, 1e6)));
    mesh.chart_count = 3;
    const auto triangles = triangles_of(squares);
    ASSERT_EQ(triangles.size(), MESH_TRIANGLES(squares));
    mesh.copies = test::empty<MeshCopy>(shooters * triangles.size() * MESH_COPIES);
    test::atlas_passes().replicate(test::device().queue, {shooters, 16, squares, 0}, mesh);
    const auto copies =
        test::download<MeshCopy>(mesh.copies, shooters * triangles.size() * MESH_COPIES);
    std::size_t used = 0;
    for (std::size_t i = 0; i < copies.size(); ++i) {
        const MeshCopy& copy = copies[i];
        const auto& corner = triangles[i / MESH_COPIES % triangles.size()];
        const std::size_t first = i / MESH_COPIES / triangles.size() * places.size();
        const std::uint32_t own = corners[first + corner[i % MESH_COPIES]].chart;
        if (copy.chart == MESH_NO_CHART) {  // an earlier corner has it
            EXPECT_GT(i % MESH_COPIES, 0u);
            continue;
        }
        ++used;
        ASSERT_EQ(copy.chart, own);
        const Plane& p = planes[own];
        glm::dvec2 low(1e9), high(-1e9);
        for (const std::uint32_t k : corner) {
            const glm::dvec2 d = places[k].at - places[corner[0]].at;
            const double w = at(p.w, places[k].at);
            EXPECT_NEAR(copy.depth.x + d.x * copy.depth.y + d.y * copy.depth.z, w, 16 * u24 / w);
            const glm::dvec2 q(at(p.u, places[k].at) / w, at(p.v, places[k].at) / w);
            low = glm::min(low, q);
            high = glm::max(high, q);
        }
        const glm::dvec2 margin = 1.0 + 0.25 * (high - low);
        for (int axis = 0; axis < 2; ++axis) {
            const double least = axis == 0 ? copy.box.x : copy.box.y;
            const double largest = axis == 0 ? copy.box.z : copy.box.w;
            EXPECT_NEAR(least, low[axis] - margin[axis], 1e-4);
            EXPECT_NEAR(largest, high[axis] + margin[axis], 1e-4);
        }
    }
    EXPECT_GT(used, copies.size() / 2);
}

TEST(AtlasMesh, PassesRefuseBuffersThatAreTooSmallAndMeshesThatAreNone) {
    OneBatch batch = turned_cube(32);
    batch.make_copies(4);
    const AtlasPasses& passes = test::atlas_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const auto refuses = [](const char* text, auto call) {
        try {
            call();
            ADD_FAILURE() << text << ": taken";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
        }
    };
    for (const std::uint32_t squares : {0u, 1u, 3u, 258u})
        refuses("squares is", [&] { passes.replicate(queue, {2, 32, squares, 0}, batch.mesh); });
    const auto with_less = [&](const char* text, cl::Buffer MeshBuffers::*which, auto call) {
        MeshBuffers less = batch.mesh;
        const std::size_t bytes = (less.*which).getInfo<CL_MEM_SIZE>();
        less.*which = cl::Buffer(test::device().context, CL_MEM_READ_WRITE, bytes - 1);
        refuses(text, [&] { call(less); });
    };
    const auto geometry = [&](const MeshBuffers& mesh) {
        passes.geometry(queue, {2, 32, 4, 0}, batch.device_scene, batch.views, batch.visibility,
                        mesh);
    };
    const auto replicate = [&](const MeshBuffers& mesh) {
        passes.replicate(queue, {2, 32, 4, 0}, mesh);
    };
    const cl::Buffer light = test::empty<float>(3 * batch.stride);
    const auto project = [&](const MeshBuffers& mesh) {
        passes.project(queue, batch.fill_params(0, 2), {2, 32, 4, 0}, batch.sites, batch.views,
                       batch.visibility, mesh, batch.planes, light, light);
    };
    with_less("uvs holds", &MeshBuffers::uvs, geometry);
    with_less("charts holds", &MeshBuffers::charts, geometry);
    with_less("corners holds", &MeshBuffers::corners, geometry);
    with_less("corners holds", &MeshBuffers::corners, replicate);
    with_less("boxes holds", &MeshBuffers::boxes, replicate);
    with_less("copies holds", &MeshBuffers::copies, replicate);
    with_less("copies holds", &MeshBuffers::copies, project);
    with_less("places holds", &MeshBuffers::places, project);
    refuses("the mesh has 1 hemicubes", [&] {
        passes.project(queue, batch.fill_params(0, 2), {1, 32, 4, 0}, batch.sites, batch.views,
                       batch.visibility, batch.mesh, batch.planes, light, light);
    });
    refuses("reach is -1", [&] {
        passes.project(queue, batch.fill_params(0, 2), {2, 32, 4, -1}, batch.sites, batch.views,
                       batch.visibility, batch.mesh, batch.planes, light, light);
    });
    refuses("visibility holds", [&] {
        passes.geometry(queue, {2, 33, 4, 0}, batch.device_scene, batch.views, light, batch.mesh);
    });
    passes.geometry(queue, {0, 32, 4, 0}, batch.device_scene, batch.views, batch.visibility,
                    batch.mesh);
    passes.replicate(queue, {0, 32, 4, 0}, batch.mesh);
    queue.finish();
}

}  // namespace
}  // namespace clgi
