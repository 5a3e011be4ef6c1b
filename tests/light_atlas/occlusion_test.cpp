// Views that pass over what is hidden behind nearer surfaces show the same as views that draw all.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <functional>

#include "box_trees.hpp"
#include "depth_words.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

// The pixels of one view, behind some that belong to others.
template <typename Word>
std::vector<Word> words(const DeviceScene& scene, View view, bool whole,
                        const GBufferPasses& passes = test::gbuffer_passes()) {
    view.first_pixel = 3;
    const std::size_t pixels = view.first_pixel + std::size_t{view.width} * view.height;
    const Pixels kind = sizeof(Word) == 4 ? Pixels::depth : Pixels::visibility;
    const RasterBuffers buffers = test::raster_buffers(scene, pixels, kind);
    test::draw_visibility(passes, scene, view, buffers, whole);
    std::vector<Word> out = test::download<Word>(buffers.pixels, pixels);
    out.erase(out.begin(), out.begin() + view.first_pixel);
    return out;
}

// A wall across z, in squares; of so many one is missing, at random. 0: none is.
void add_wall(Scene& scene, test::Random& random, int squares, double z, int missing) {
    const double side = 2.4 / squares;
    for (int i = 0; i < squares * squares; ++i) {
        if (missing > 0 && random.integer(0, missing - 1) == 0) continue;
        const glm::dvec3 a(side * (i % squares) - 1.2, side * (i / squares) - 1.2, z);
        const glm::dvec3 x(side, 0, 0), y(0, side, 0);
        test::add_quad(scene, {a, a + x, a + x + y, a + y});
    }
}

// Triangles of all sizes before and behind walls with holes.
Scene walls_and_heap() {
    test::Random random(31);
    Scene scene = test::plain_scene();
    add_wall(scene, random, 48, 0.0, 12);
    add_wall(scene, random, 30, -0.5, 3);
    // Bars with slits between them that are narrower than most pixels.
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 from(-1.2 + 0.008 * i, -1.2, -0.02);
        test::add_quad(scene, {from, from + glm::dvec3(0.0065, 0, 0),
                               from + glm::dvec3(0.0065, 2.4, 0), from + glm::dvec3(0, 2.4, 0)});
    }
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 at(test::random_vec3(random, -1.1, 1.1));
        const double size = i % 40 ? 0.05 : 0.6;
        test::add_triangle(scene, at, at + glm::dvec3(test::random_vec3(random, -size, size)),
                           at + glm::dvec3(test::random_vec3(random, -size, size)), 0);
    }
    return scene;
}

std::vector<View> views_of(const DeviceScene& scene) {
    std::vector<View> out;
    test::Random random(8);
    const int sizes[][2] = {{97, 33}, {41, 77}, {300, 210}, {64, 64}};
    for (int i = 0; i < 48; ++i) {
        const glm::dvec3 eye(random(-0.9, 0.9), random(-0.9, 0.9), random(0.05, i % 2 ? 2.0 : 0.6));
        Camera camera = test::camera_at(eye, glm::dvec3(random(-0.5, 0.5), random(-0.5, 0.5), -0.6),
                                        static_cast<float>(random(0.5, 1.4)));
        camera.near = static_cast<float>(random(0.01, 0.2));
        if (i % 5 == 4) {
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = 0.7f;
        }
        View view = make_view(camera, scene.frame(), sizes[i % 4][0], sizes[i % 4][1]);
        view.flags = 0;
        if (i % 3 == 0) {
            view.window.x = static_cast<float>(random(-0.8, 0.8)) * view.right.w;
            view.window.y = static_cast<float>(random(-0.8, 0.8)) * view.up.w;
        }
        out.push_back(view);
    }
    return out;
}

TEST(Occlusion, ChangesNoWord) {
    const DeviceScene scene = test::on_device(walls_and_heap());
    ASSERT_GT(scene.info().cluster_count, 150u);
    const std::vector<View> views = views_of(scene);
    for (const int width : test::widths()) {
        BuildOptions build;
        build.packet_width = width;
        build.textures = false;
        const GBufferPasses passes(test::device().context, test::device().device, build);
        for (std::size_t v = 0; v < views.size(); ++v) {
            EXPECT_TRUE(words<std::uint32_t>(scene, views[v], true, passes) ==
                        words<std::uint32_t>(scene, views[v], false))
                << "depth of view " << v << ", packets of " << width;
            EXPECT_TRUE(words<std::uint64_t>(scene, views[v], true, passes) ==
                        words<std::uint64_t>(scene, views[v], false))
                << "view " << v << ", packets of " << width;
        }
    }
}

// In groups a lane has a triangle, also where packets are asked for.
TEST(Occlusion, IsNothingToGroups) {
    const DeviceScene scene = test::on_device(walls_and_heap());
    const std::vector<View> views = views_of(scene);
    for (const int width : test::widths()) {
        BuildOptions build;
        build.form = Form::groups;
        build.packet_width = width;
        build.textures = false;
        const GBufferPasses passes(test::device().context, test::device().device, build);
        for (std::size_t v = 0; v < 4; ++v)
            EXPECT_TRUE(words<std::uint64_t>(scene, views[v], true, passes) ==
                        words<std::uint64_t>(scene, views[v], false))
                << "view " << v << ", packets of " << width;
    }
}

// A sheet before a wall, whose clusters pretend to lie behind it.
TEST(Occlusion, PassesOverClustersBehindWhatIsSeen) {
    test::Random random(1);
    Scene world = test::plain_scene();
    add_wall(world, random, 160, 0.3, 0);
    const std::size_t sheet = world.triangles.size();
    add_wall(world, random, 120, 0.0, 0);
    DeviceScene scene = test::on_device(world);
    auto clusters = test::download<Cluster>(scene.clusters(), scene.info().cluster_count);
    std::vector<bool> moved(clusters.size(), true);
    for (std::size_t t = 0; t < world.triangles.size(); ++t)
        if (scene.triangle_order()[t] >= sheet) moved[t / CLUSTER_TRIANGLES] = false;
    ASSERT_GT(std::count(moved.begin(), moved.end(), true), 20);

    Camera camera = test::camera_at({0.1, 0.05, 1.0}, {0.05, 0.1, 0.0}, 1.0f);
    // Groups pass over none.
    const GBufferPasses packets(test::programs(), {.form = Form::packets});
    const auto shown = [&](const View& view) {  // of those that are moved
        std::size_t count = 0;
        for (const std::uint64_t word : words<std::uint64_t>(scene, view, true, packets))
            count += word != test::no_triangle &&
                     moved[static_cast<std::uint32_t>(word) / CLUSTER_TRIANGLES];
        return count;
    };
    const View view = make_view(camera, scene.frame(), 40, 28);
    camera = test::camera_at({0.1, 0.05, 1.0}, {0.1, 0.05, 0.0});
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 0.5f;
    const View flat = make_view(camera, scene.frame(), 40, 28);
    EXPECT_GT(shown(view), 500u);
    EXPECT_GT(shown(flat), 500u);
    const float back = scene.frame().to_local(glm::dvec3(0, 0, -0.6)).z;
    for (std::size_t c = 0; c < clusters.size(); ++c)
        if (moved[c]) clusters[c].low.z = clusters[c].high.z = back;
    test::device().queue.enqueueWriteBuffer(scene.clusters(), CL_TRUE, 0,
                                            clusters.size() * sizeof(Cluster), clusters.data());
    test::refit_boxes(scene, ScenePasses(test::programs()));
    // All but a few that hide behind what was drawn since the last look.
    EXPECT_LE(shown(view), 25u);
    EXPECT_LE(shown(flat), 25u);
}

TEST(Occlusion, GoesOnBeyondTheClustersThatAListHolds) {
    test::Random random(2);
    Scene world = test::plain_scene();
    add_wall(world, random, 200, 0.0, 5);
    add_wall(world, random, 60, -0.4, 0);
    const DeviceScene scene = test::on_device(world);
    ASSERT_GT(scene.info().cluster_count, 1024u);
    const View view =
        make_view(test::camera_at({0.1, 0.0, 2.5}, {0, 0, 0}, 1.1f), scene.frame(), 128, 100);
    const auto wanted = words<std::uint64_t>(scene, view, false);
    EXPECT_GT(std::count_if(wanted.begin(), wanted.end(),
                            [](std::uint64_t word) { return word != test::no_triangle; }),
              5000);
    EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted);
}

// The last cluster has a part that is not full, and comes first: others follow in the same packet.
TEST(Occlusion, DrawsAllThatFollowsAPartThatIsNotFull) {
    test::Random random(4);
    Scene world = test::plain_scene();
    add_wall(world, random, 8, 0.0, 0);
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 at(0.2 * i - 0.3, -0.1, 3.0);
        test::add_triangle(world, at, at + glm::dvec3(0.1, 0, 0), at + glm::dvec3(0, 0.1, 0));
    }
    const DeviceScene scene = test::on_device(world);
    ASSERT_EQ(scene.triangle_order().back(), 130u);
    const View view =
        make_view(test::camera_at({0.0, 0.0, 4.0}, {0, 0, 0}, 0.7f), scene.frame(), 64, 64);
    EXPECT_TRUE(words<std::uint64_t>(scene, view, true) ==
                words<std::uint64_t>(scene, view, false));
}

// What a cluster's box may be on the device: anything that holds the cluster.
using Widen = std::function<void(Cluster&)>;

// Of all clusters whose triangles are, in the scene, numbers first .. last - 1. Returns how many.
int widen(const DeviceScene& scene, std::size_t first, std::size_t last, const Widen& change) {
    auto clusters = test::download<Cluster>(scene.clusters(), scene.info().cluster_count);
    std::vector<bool> other(clusters.size(), false);
    for (std::size_t t = 0; t < scene.triangle_order().size(); ++t) {
        const std::size_t triangle = scene.triangle_order()[t];
        if (triangle < first || triangle >= last) other[t / CLUSTER_TRIANGLES] = true;
    }
    int changed = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        if (other[c]) continue;
        change(clusters[c]);
        ++changed;
    }
    test::device().queue.enqueueWriteBuffer(scene.clusters(), CL_TRUE, 0,
                                            clusters.size() * sizeof(Cluster), clusters.data());
    return changed;
}

void add_square(Scene& scene, const glm::dvec3& low, double side) {
    const glm::dvec3 x(side, 0, 0), y(0, side, 0);
    test::add_quad(scene, {low, low + x, low + x + y, low + y});
}

// A sheet shows beside a wall that ends across the picture. On the side where the wall ends, one of
// the four corners of the sheet's box goes farthest: which one depends on how the camera is rolled.
TEST(Occlusion, KnowsTheCornerThatGoesFarthestInARolledView) {
    for (int turn = 0; turn < 4; ++turn) {
        const double angle = glm::radians(-45.0 + 90.0 * turn);
        const glm::dvec3 right(std::cos(angle), std::sin(angle), 0);
        Scene world = test::plain_scene();
        for (int i = 0; i < 60 * 60; ++i) {
            const glm::dvec3 low(0.04 * (i % 60) - 1.2, 0.04 * (i / 60) - 1.2, 0);
            if (glm::dot(low + glm::dvec3(0.02, 0.02, 0), right) > -0.2)
                add_square(world, low, 0.04);
        }
        const std::size_t wall = world.triangles.size();
        for (int i = 0; i < 120 * 120; ++i)
            add_square(world, {0.01 * (i % 120) - 0.6, 0.01 * (i / 120) - 0.6, -1}, 0.01);
        const DeviceScene scene = test::on_device(world);
        const int sheets = widen(scene, wall, world.triangles.size(), [&](Cluster& cluster) {
            cluster.low = glm::vec4(scene.frame().to_local({-0.6, -0.6, -1}), 0.0f);
            cluster.high = glm::vec4(scene.frame().to_local({0.6, 0.6, -1}), 0.0f);
        });
        ASSERT_GT(sheets, 100);
        Camera camera = test::camera_at({0, 0, 2}, {0, 0, 0}, 0.9f);
        camera.right = glm::vec3(right);
        camera.up = glm::vec3(-right.y, right.x, 0);
        View view = make_view(camera, scene.frame(), 128, 128);
        view.flags = 0;
        const auto wanted = words<std::uint64_t>(scene, view, false);
        const auto shows = [&](std::uint64_t word) {
            return word != test::no_triangle &&
                   scene.triangle_order()[static_cast<std::uint32_t>(word)] >= wall;
        };
        EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), shows), 350) << turn;
        EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted) << turn;
    }
}

// A sheet shows beside a half of a wall, in windows to that half's side: seen along the axis of the
// view, all that shows would be behind the wall.
TEST(Occlusion, KnowsWhereTheWindowIs) {
    for (int side = 0; side < 4; ++side) {
        const int axis = side / 2;
        const double sign = side % 2 ? -1.0 : 1.0;
        Scene world = test::plain_scene();
        for (int i = 0; i < 60 * 60; ++i) {
            const glm::dvec3 low(0.04 * (i % 60) - 1.2, 0.04 * (i / 60) - 1.2, 0);
            if (sign * (low[axis] + 0.02) > 0.0) add_square(world, low, 0.04);
        }
        const std::size_t wall = world.triangles.size();
        for (int i = 0; i < 120 * 120; ++i)
            add_square(world, {0.01 * (i % 120) - 0.6, 0.01 * (i / 120) - 0.6, -1}, 0.01);
        const DeviceScene scene = test::on_device(world);
        View view = make_view(test::camera_at({0, 0, 2}, {0, 0, 0}, 0.9f), scene.frame(), 128, 128);
        view.flags = 0;
        (axis ? view.window.y : view.window.x) = static_cast<float>(0.5 * sign) * view.up.w;
        const auto wanted = words<std::uint64_t>(scene, view, false);
        const auto shows = [&](std::uint64_t word) {
            return word != test::no_triangle &&
                   scene.triangle_order()[static_cast<std::uint32_t>(word)] >= wall;
        };
        EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), shows), 1000) << side;
        EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted) << side;
    }
}

// A sheet shows on both sides of a band across a view that is four times as long as the band is
// wide. Divided by the other extent, it would lie nearer to the middle, behind the band.
TEST(Occlusion, KnowsBothExtentsOfTheWindow) {
    for (const int axis : {0, 1}) {
        Scene world = test::plain_scene();
        for (int i = 0; i < 60 * 60; ++i) {
            const glm::dvec3 low(0.04 * (i % 60) - 1.2, 0.04 * (i / 60) - 1.2, 0);
            if (std::abs(low[axis] + 0.02) < 0.4) add_square(world, low, 0.04);
        }
        const std::size_t wall = world.triangles.size();
        for (int i = 0; i < 120 * 120; ++i)
            add_square(world, {0.02 * (i % 120) - 1.2, 0.02 * (i / 120) - 1.2, -1}, 0.02);
        const DeviceScene scene = test::on_device(world);
        const float short_side = 0.48f,
                    angle = 2.0f * std::atan(axis ? short_side : 4 * short_side);
        View view = make_view(test::camera_at({0, 0, 2}, {0, 0, 0}, angle), scene.frame(),
                              axis ? 192 : 48, axis ? 48 : 192);
        view.flags = 0;
        const auto wanted = words<std::uint64_t>(scene, view, false);
        const auto shows = [&](std::uint64_t word) {
            return word != test::no_triangle &&
                   scene.triangle_order()[static_cast<std::uint32_t>(word)] >= wall;
        };
        EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), shows), 500) << axis;
        EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted) << axis;
    }
}

// A patch 2^-13 before the eye, all of whose coordinates but these are exact: the middle of its box
// is rounded away from the eye by 2^-25, and strips that slant through it end in between.
TEST(Occlusion, AllowsForTheRoundingOfTheMiddleOfABox) {
    constexpr double near = 0x1p-24, apart = 0x1p-13, wide = 1.5e-4;
    Scene world = test::plain_scene();
    add_square(world, {-0.1, -0.1, -0.8}, 1e-3);  // the frame: origin 0, scale 1
    add_square(world, {0.1 - 1e-3, 0.1 - 1e-3, 0.8}, 1e-3);
    const std::size_t strips = world.triangles.size();
    for (int i = 0; i < 3000; ++i) {
        const double y = wide * (i / 1500.0 - 1.0), next = wide * ((i + 1) / 1500.0 - 1.0);
        test::add_quad(world, {glm::dvec3(-wide, y, 0.75 + 2 * near),
                               {wide, y, 0.75},
                               {wide, next, 0.75},
                               {-wide, next, 0.75 + 2 * near}});
    }
    const std::size_t patch = world.triangles.size();
    for (int i = 0; i < 20 * 20; ++i)
        add_square(world, {2.7e-5 + 1e-6 * (i % 20), 1e-6 * (i / 20) - 1e-5, 0.75 + near}, 1e-6);
    const DeviceScene scene = test::on_device(world);
    ASSERT_EQ(scene.frame().scale, 1.0);
    ASSERT_EQ(scene.frame().origin, glm::dvec3(0.0));
    // Strips come first, as if they began half-way to the eye.
    EXPECT_GT(widen(scene, strips, patch,
                    [&](Cluster& c) { c.high.z = static_cast<float>(0.75 + 0.5 * apart); }),
              80);
    EXPECT_GT(widen(scene, patch, world.triangles.size(), [&](Cluster& c) { c.low.z = 0.75f; }),
              10);
    Camera camera = test::camera_at({0, 0, 0.75 + apart}, {0, 0, 0.75}, 1.5707964f);
    View view = make_view(camera, scene.frame(), 64, 64);
    view.forward.w = 1e-6f;
    view.flags = 0;
    const auto wanted = words<std::uint64_t>(scene, view, false);
    const auto shows = [&](std::uint64_t word) {
        return word != test::no_triangle &&
               scene.triangle_order()[static_cast<std::uint32_t>(word)] >= patch;
    };
    EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), shows), 15);
    EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted);
}

}  // namespace
}  // namespace clgi
