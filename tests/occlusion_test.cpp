// Views that pass over what is hidden behind nearer surfaces show the same as views that draw all.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

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
    for (const int width : {1, 4, 8, 16}) {
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

// A sheet before a wall, whose clusters pretend to lie behind it.
TEST(Occlusion, PassesOverClustersBehindWhatIsSeen) {
    test::Random random(1);
    Scene world = test::plain_scene();
    add_wall(world, random, 60, 0.0, 0);
    const std::size_t wall = world.triangles.size();
    add_wall(world, random, 40, 0.3, 0);
    const DeviceScene scene = test::on_device(world);
    auto clusters = test::download<Cluster>(scene.clusters(), scene.info().cluster_count);
    std::vector<bool> moved(clusters.size(), true);
    for (std::size_t t = 0; t < world.triangles.size(); ++t)
        if (scene.triangle_order()[t] < wall) moved[t / CLUSTER_TRIANGLES] = false;
    ASSERT_GT(std::count(moved.begin(), moved.end(), true), 20);

    Camera camera = test::camera_at({0.1, 0.05, 1.0}, {0.05, 0.1, 0.0}, 1.0f);
    const auto shown = [&](const View& view) {  // of those that are moved
        std::size_t count = 0;
        for (const std::uint64_t word : words<std::uint64_t>(scene, view, true))
            count += word != test::no_triangle &&
                     moved[static_cast<std::uint32_t>(word) / CLUSTER_TRIANGLES];
        return count;
    };
    const View view = make_view(camera, scene.frame(), 80, 56);
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 0.5f;
    const View flat = make_view(camera, scene.frame(), 80, 56);
    EXPECT_GT(shown(view), 2000u);
    EXPECT_GT(shown(flat), 2000u);
    const float back = scene.frame().to_local(glm::dvec3(0, 0, -0.2)).z;
    for (std::size_t c = 0; c < clusters.size(); ++c)
        if (moved[c]) clusters[c].low.z = clusters[c].high.z = back;
    test::device().queue.enqueueWriteBuffer(scene.clusters(), CL_TRUE, 0,
                                            clusters.size() * sizeof(Cluster), clusters.data());
    // All but a few that hide behind what was drawn since the last look.
    EXPECT_LT(shown(view), 100u);
    EXPECT_GT(shown(flat), 2000u) << "only perspective views are judged";
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

}  // namespace
}  // namespace clgi
