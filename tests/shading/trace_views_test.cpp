// Views drawn by rays: every word against all triangles in double precision, masks against the
// rasteriser, and no gap between triangles that share an edge.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <clgi/procedural.hpp>
#include <limits>
#include <map>

#include "depth_words.hpp"
#include "lab/scenes/rooms.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

using test::Looking;

template <typename Word>
std::vector<Word> traced(const DeviceScene& scene, const std::vector<View>& views,
                         const GBufferPasses& passes = test::gbuffer_passes(), bool rays = true) {
    const cl::CommandQueue& queue = test::device().queue;
    const Pixels kind = sizeof(Word) == 4 ? Pixels::depth : Pixels::visibility;
    const ViewSpan span = span_of(views, 0, views.size());
    const cl::Buffer pixels = test::empty<Word>(span.pixels), placed = test::upload(views);
    queue.enqueueFillBuffer(pixels, cl_uchar{0x5a}, 0, span.pixels * sizeof(Word));
    if (rays)
        passes.trace_views(queue, span, placed, scene, pixels, kind);
    else
        passes.raster_views(queue, span, placed, scene, pixels, kind);
    return test::download<Word>(pixels, span.pixels);
}

struct Ray {
    glm::dvec3 origin, direction;
};

Ray through_pixel(const View& view, int x, int y) {
    const glm::dvec3 eye(view.eye), right(view.right), up(view.up), forward(view.forward);
    const double a = double{view.window.x} + view.right.w * (2.0 * (x + 0.5) / view.width - 1.0);
    const double b = double{view.window.y} + view.up.w * (1.0 - 2.0 * (y + 0.5) / view.height);
    const glm::dvec3 aside = a * right + b * up;
    if (view.eye.w != 0.0f) return {eye + aside, forward};
    return {eye, forward + aside};
}

// The least weight of a corner where the ray meets the plane, and the depth there, if it is ahead.
struct Met {
    double inside, depth;
    bool front;
};

Met meet(const View& view, const Ray& ray, const glm::dvec3 (&corner)[3]) {
    const glm::dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const glm::dvec3 normal = glm::cross(e1, e2);
    const double slope = glm::dot(ray.direction, normal);
    if (slope == 0.0) return {-1.0, 0.0, false};
    const double t = glm::dot(corner[0] - ray.origin, normal) / slope;
    const glm::dvec3 at = ray.origin + t * ray.direction - corner[0];
    const double square = glm::dot(normal, normal);
    const double b1 = glm::dot(glm::cross(at, e2), normal) / square,
                 b2 = glm::dot(glm::cross(e1, at), normal) / square;
    if (!(t > double{view.forward.w})) return {-1.0, t, false};
    return {std::min({b1, b2, 1.0 - b1 - b2}), t, slope < 0.0};
}

struct Judged {
    std::size_t seen = 0, backs = 0;
};

// edge: weights of corners from which on a ray is surely inside or outside.
void expect_nearest(const DeviceScene& scene, const std::vector<View>& views,
                    const std::vector<std::uint64_t>& words, const std::string& label,
                    Judged& judged) {
    constexpr double edge = 1e-3, same = 1e-4;
    const auto triangles =
        test::download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    const auto positions = test::download<glm::vec4>(scene.positions(), scene.info().vertex_count);
    const auto met = [&](const View& view, const Ray& ray, std::size_t t) {
        const glm::dvec3 corner[3] = {glm::dvec3(positions[triangles[t].x]),
                                      glm::dvec3(positions[triangles[t].y]),
                                      glm::dvec3(positions[triangles[t].z])};
        Met out = meet(view, ray, corner);
        const bool single = !(triangles[t].w & std::uint32_t(TRIANGLE_DOUBLE_SIDED));
        if ((view.flags & VIEW_CULL_BACK_FACES) && single && !out.front) out.inside = -1.0;
        return out;
    };
    for (const View& view : views)
        for (int y = 0; y < static_cast<int>(view.height); ++y)
            for (int x = 0; x < static_cast<int>(view.width); ++x) {
                const std::uint64_t word =
                    words[view.first_pixel + static_cast<std::size_t>(y) * view.width +
                          static_cast<std::size_t>(x)];
                const Ray ray = through_pixel(view, x, y);
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t t = 0; t < triangles.size(); ++t) {
                    const Met found = met(view, ray, t);
                    if (found.inside > edge) nearest = std::min(nearest, found.depth);
                }
                const std::string where =
                    label + ", " + std::to_string(x) + "," + std::to_string(y);
                if (word == test::no_triangle) {
                    EXPECT_EQ(nearest, std::numeric_limits<double>::infinity()) << where;
                    continue;
                }
                const auto shown = static_cast<std::uint32_t>(word);
                ASSERT_LT(shown, triangles.size()) << where;
                const Met found = met(view, ray, shown);
                EXPECT_GT(found.inside, -edge) << where;
                EXPECT_LE(found.depth, nearest * (1.0 + same)) << where;
                const std::uint32_t bits = ~static_cast<std::uint32_t>(word >> 32);
                float closeness;
                std::memcpy(&closeness, &bits, sizeof bits);
                const double wanted = view.eye.w == 0.0f
                                          ? 1.0 / found.depth
                                          : (double{view.window.z} - found.depth) /
                                                (double{view.window.z} - view.forward.w);
                EXPECT_NEAR(closeness, wanted, same * std::max(wanted, 1e-3)) << where;
                ++judged.seen;
                judged.backs += !found.front;
            }
}

// Eyes outside and within, straight windows and windows aside, both kinds.
std::vector<View> views_of(const DeviceScene& scene) {
    std::vector<View> out;
    std::uint32_t pixel = 3;
    const auto add = [&](View view, bool culls) {
        view.flags = culls ? view.flags | VIEW_CULL_BACK_FACES : 0;
        view.first_pixel = pixel;
        pixel += view.width * view.height;
        out.push_back(view);
    };
    for (const Looking how :
         {Looking::perspective, Looking::orthographic, Looking::aside, Looking::orthographic_aside})
        add(test::looking(how, scene, 13, 9), how != Looking::aside);
    test::Random random(12);
    for (int i = 0; i < 6; ++i) {
        Camera camera = test::camera_at(glm::dvec3(test::random_vec3(random, -0.5, 0.5)),
                                        glm::dvec3(test::random_vec3(random, -0.9, 0.9)), 1.2f);
        camera.near = i % 2 ? 0.2f : 0.01f;
        add(make_view(camera, scene.frame(), 8, i % 3 ? 8 : 4), i % 2 == 0);
    }
    return out;
}

TEST(TraceViews, ShowTheNearestOfAllTriangles) {
    Scene fine = bumpy_mesh();
    fine.triangles.resize(9000);
    fine.parts.clear();
    for (const Scene& world :
         {test::patchwork(700, 5, false), test::patchwork(30, 8, false), fine}) {
        const DeviceScene scene = test::on_device(world);
        const std::vector<View> views = views_of(scene);
        Judged judged;
        const std::string label = std::to_string(world.triangles.size()) + " triangles";
        const auto words = traced<std::uint64_t>(scene, views);
        for (int p = 0; p < 3; ++p)
            EXPECT_EQ(words[p], 0x5a5a5a5a5a5a5a5aull) << "before the views";
        expect_nearest(scene, views, words, label, judged);
        EXPECT_GT(judged.seen, 100u) << label;
        EXPECT_GT(judged.backs, 10u) << label;
    }
}

TEST(TraceViews, AreTheSameForEveryWidth) {
    const DeviceScene scene = test::on_device(test::patchwork(900, 31));
    const std::vector<View> views = views_of(scene);
    const auto wanted = traced<std::uint64_t>(scene, views);
    for (const int width : {1, 4, 8, 16}) {
        const GBufferPasses passes(test::programs(),
                                   {.packet_width = width, .form = Form::packets, .local_size = 2});
        EXPECT_TRUE(test::same_bits(traced<std::uint64_t>(scene, views, passes), wanted)) << width;
    }
    const auto depth = traced<std::uint32_t>(scene, views);
    test::expect_closeness(depth, wanted, "depth alone");
    test::Sides sides;
    for (const View& view : views) test::count_sides(scene, view, depth, wanted, sides);
    EXPECT_GT(sides.fronts, 100u);
    EXPECT_GT(sides.backs, 50u);
    EXPECT_EQ(sides.wrong, 0u);
}

// Of the same triangle twice the first shows, and no width shows another one, with sheets that are
// there from the other side and from another corner on too.
TEST(TraceViews, ShowTheFirstOfTrianglesAtOneDepth) {
    Scene world = test::plain_scene();
    test::Random random(77);
    for (int i = 0; i < 150; ++i) {
        const glm::dvec3 at(test::random_vec3(random, -0.8, 0.8));
        const glm::dvec3 a = at + glm::dvec3(0.5, 0.1, 0.2), b = at + glm::dvec3(-0.1, 0.6, 0.1);
        test::add_triangle(world, at, a, b);
        if (i % 2) test::add_triangle(world, at, b, a);
        if (i % 3) test::add_triangle(world, a, b, at);
        test::add_triangle(world, at, a, b);
    }
    const DeviceScene scene = test::on_device(world);
    const auto positions = test::download<glm::vec4>(scene.positions(), scene.info().vertex_count);
    const auto triangles =
        test::download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    const auto corners = [&](std::uint32_t t) {
        std::vector<std::array<float, 3>> out;
        for (int k = 0; k < 3; ++k) {
            const glm::vec4& p = positions[triangles[t][k]];
            out.push_back({p.x, p.y, p.z});
        }
        return out;
    };
    std::map<std::vector<std::array<float, 3>>, std::uint32_t> first;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) first.emplace(corners(t), t);
    std::vector<View> views = views_of(scene);
    for (View& view : views) view.flags = 0;
    const auto wanted = traced<std::uint64_t>(scene, views);
    std::size_t seen = 0;
    for (std::size_t p = 3; p < wanted.size(); ++p) {
        if (wanted[p] == test::no_triangle) continue;
        const auto shown = static_cast<std::uint32_t>(wanted[p]);
        ++seen;
        EXPECT_EQ(shown, first.at(corners(shown))) << p;
    }
    EXPECT_GT(seen, 150u);
    for (const int width : {1, 4, 8, 16}) {
        const GBufferPasses passes(test::programs(),
                                   {.packet_width = width, .form = Form::packets});
        EXPECT_TRUE(test::same_bits(traced<std::uint64_t>(scene, views, passes), wanted)) << width;
    }
}

// Masks and blended surfaces are looked up as the rasteriser does: other words at edges alone.
TEST(TraceViews, SeeThroughMasks) {
    Scene world = test::patchwork(400, 72);
    for (std::size_t m = 0; m < world.materials.size(); ++m) {
        world.materials[m].alpha_cutoff = 0.6f;
        if (m % 2) world.materials[m].alpha_mode = AlphaMode::mask;
        if (m % 4 == 3) world.materials[m].alpha_mode = AlphaMode::blend;
    }
    const DeviceScene scene = test::on_device(world);
    std::vector<View> views = views_of(scene);
    const auto wanted = traced<std::uint64_t>(scene, views, test::gbuffer_passes(), false);
    const auto words = traced<std::uint64_t>(scene, views);
    Scene whole = world;
    for (Material& material : whole.materials) material.alpha_mode = AlphaMode::opaque;
    const auto opaque = traced<std::uint64_t>(test::on_device(whole), views);
    std::size_t other = 0, through = 0;
    for (std::size_t p = 3; p < words.size(); ++p) {
        other += static_cast<std::uint32_t>(words[p]) != static_cast<std::uint32_t>(wanted[p]);
        through += static_cast<std::uint32_t>(words[p]) != static_cast<std::uint32_t>(opaque[p]);
    }
    EXPECT_LE(other, words.size() / 100);
    EXPECT_GT(through, words.size() / 10);
}

// From within a closed surface nothing else is seen, also where rays meet its corners and edges.
TEST(TraceViews, LeaveNoGapBetweenTriangles) {
    FurnaceOptions sphere;
    sphere.subdivisions = 3;
    for (const Math math : {Math::strict, Math::fast}) {
        const GBufferPasses passes(test::programs(), {.math = math});
        const DeviceScene scene = test::on_device(furnace(sphere));
        const auto triangles =
            test::download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
        const auto positions =
            test::download<glm::vec4>(scene.positions(), scene.info().vertex_count);
        std::vector<View> views;
        std::uint32_t pixel = 0;
        for (std::size_t t = 0; t < triangles.size(); t += 7) {
            const glm::vec3 a(positions[triangles[t].x]), b(positions[triangles[t].y]);
            // Towards a corner, and towards the middle of an edge, from a place off the centre.
            for (const glm::vec3 at : {a, 0.5f * (a + b)}) {
                View view = make_view(test::camera_at({0, 0, 0}, {0, 0, 1}), scene.frame(), 3, 3);
                view.eye = glm::vec4(0.125f, -0.25f, 0.0625f * static_cast<float>(t % 5), 0.0f);
                const glm::vec3 forward = glm::normalize(at - glm::vec3(view.eye));
                const glm::vec3 right = glm::normalize(
                    glm::cross(forward, glm::vec3(0.3f, 0.8f, 0.1f * static_cast<float>(t % 3))));
                view.forward = glm::vec4(forward, 1e-3f);
                view.right = glm::vec4(right, 1e-3f);
                view.up = glm::vec4(glm::cross(right, forward), 1e-3f);
                view.first_pixel = pixel;
                view.flags = 0;
                pixel += 9;
                views.push_back(view);
            }
        }
        const auto words = traced<std::uint64_t>(scene, views, passes);
        EXPECT_EQ(std::count(words.begin(), words.end(), test::no_triangle), 0);
        EXPECT_GT(words.size(), 2000u);
    }
}

// Whose borders lie in faces of boxes along the axes, and whose corners are far beside how near the
// eye is.
TEST(TraceViews, LeaveNoGapBetweenTilesSeenFromClose) {
    Scene floor = test::plain_scene();
    constexpr int tiles = 40;
    for (int i = 0; i < tiles; ++i)
        for (int k = 0; k < tiles; ++k) {
            const double x = i - 0.5 * tiles, z = k - 0.5 * tiles;
            test::add_quad(floor,
                           {glm::dvec3(x, 0, z + 1), {x + 1, 0, z + 1}, {x + 1, 0, z}, {x, 0, z}});
        }
    const DeviceScene scene = test::on_device(floor);
    test::Random random(41);
    std::vector<View> views;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const double border = random.integer(-10, 10), along = random(-10, 10);
        const glm::dvec3 at = i % 2 ? glm::dvec3(border, 0, along) : glm::dvec3(along, 0, border);
        const double apart = std::pow(10.0, random(-3, 0)), turn = random(0, 6.28);
        const glm::dvec3 eye =
            at + apart * glm::dvec3(std::cos(turn), random(0.01, 1), std::sin(turn));
        View view = make_view(test::camera_at(eye, at, 1e-3), scene.frame(), 3, 3);
        view.forward.w = 0.0f;
        view.first_pixel = 9 * i;
        views.push_back(view);
    }
    const auto words = traced<std::uint64_t>(scene, views, GBufferPasses(test::programs()));
    EXPECT_EQ(std::count(words.begin(), words.end(), test::no_triangle), 0);
    EXPECT_EQ(words.size(), 27000u);
}

TEST(TraceViews, OfNothingShowNothing) {
    const DeviceScene scene = test::on_device(Scene());
    View view = make_view(test::camera_at({0, 0, 0}, {0, 0, 1}), scene.frame(), 4, 4);
    for (const std::uint64_t word : traced<std::uint64_t>(scene, {view}))
        EXPECT_EQ(word, test::no_triangle);
}

// Rays are for few pixels of many triangles, and never for groups.
TEST(TraceViews, ArePreferredForFineMeshes) {
    const DeviceScene fine = test::on_device(bumpy_mesh()), plain = test::on_device(cornell());
    const GBufferPasses packets(test::programs(), {.form = Form::packets}),
        groups(test::programs(), {.form = Form::groups});
    EXPECT_TRUE(packets.prefers_trace_views({0, 5, 8, 8}, fine));
    EXPECT_FALSE(packets.prefers_trace_views({0, 5, 64, 64}, fine));
    EXPECT_FALSE(packets.prefers_trace_views({0, 5, 8, 8}, plain));
    EXPECT_FALSE(groups.prefers_trace_views({0, 5, 8, 8}, fine));
}

}  // namespace
}  // namespace clgi
