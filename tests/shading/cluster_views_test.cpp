// Clusters that are passed over hold nothing that is seen: pictures are the same with clusters
// that are never passed over.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/procedural.hpp>
#include <limits>

#include "depth_words.hpp"
#include "lab/scenes/rooms.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

using test::Looking;

// whole: by raster_views, else by lists.
template <typename Word>
std::vector<Word> words(const DeviceScene& scene, const View& view, bool whole) {
    const std::size_t pixels = std::size_t{view.width} * view.height;
    const Pixels kind = sizeof(Word) == 4 ? Pixels::depth : Pixels::visibility;
    const RasterBuffers buffers = test::raster_buffers(scene, pixels, kind);
    test::draw_visibility(test::gbuffer_passes(), scene, view, buffers, whole);
    return test::download<Word>(buffers.pixels, pixels);
}

// Everything lies in every cluster, facing all ways.
void open_clusters(const DeviceScene& scene) {
    const float far = std::numeric_limits<float>::max() / 16;
    const std::vector<Cluster> all(
        scene.info().cluster_count,
        {glm::vec4(glm::vec3(-far), 0), glm::vec4(glm::vec3(far), 0), {0, 0, 0, 2}});
    test::device().queue.enqueueWriteBuffer(scene.clusters(), CL_TRUE, 0,
                                            all.size() * sizeof(Cluster), all.data());
    auto nodes = test::download<BoxNode>(scene.nodes(), scene.node_levels().back());
    for (BoxNode& node : nodes)
        for (int k = 0; k < NODE_BOXES; ++k)
            for (int axis = 0; axis < 3 && node.child[k] != NODE_NONE; ++axis) {
                node.low[axis][k] = -far;
                node.high[axis][k] = far;
            }
    test::device().queue.enqueueWriteBuffer(scene.nodes(), CL_TRUE, 0,
                                            nodes.size() * sizeof(BoxNode), nodes.data());
}

glm::dvec3 on_sheet(double u, double v) {
    return {u, 0.4 * std::cos(3.0 * u) * std::cos(2.0 * v), v};
}

// Facets of one size on a bent sheet, seen from one side or from both: clusters with narrow cones,
// and sizes of the same order as their distance from the eye.
Scene sheet(bool double_sided) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = double_sided;
    const auto at = [](int column, int row) {
        return on_sheet(column / 12.0 - 1.0, row / 12.0 - 1.0);
    };
    for (int row = 0; row < 24; ++row)
        for (int column = 0; column < 24; ++column) {
            test::add_triangle(scene, at(column, row), at(column, row + 1), at(column + 1, row), 0);
            test::add_triangle(scene, at(column + 1, row), at(column, row + 1),
                               at(column + 1, row + 1), 0);
        }
    return scene;
}

// Dense layers close to each other, of which each nearer one comes later, as seen from above.
Scene layers() {
    Scene scene = test::plain_scene();
    constexpr int side = 40;
    for (int layer = 0; layer < 4; ++layer) {
        const auto at = [&](int column, int row) {
            const double u = 2.0 * column / side - 1.0, v = 2.0 * row / side - 1.0;
            return glm::dvec3(u, 0.01 * layer + 0.2 * u, -v);
        };
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                test::add_triangle(scene, at(column, row), at(column + 1, row),
                                   at(column, row + 1));
                test::add_triangle(scene, at(column + 1, row), at(column + 1, row + 1),
                                   at(column, row + 1));
            }
    }
    return scene;
}

// Eyes before, behind, beside, within and close above what is seen; straight windows and windows
// aside.
std::vector<View> views_of(const DeviceScene& scene, std::uint64_t seed) {
    std::vector<View> out;
    test::Random random(seed);
    for (int i = 0; i < 24; ++i) {
        glm::vec3 eye = test::random_vec3(random, i % 3 ? -1.2 : -0.5, i % 3 ? 1.2 : 0.5);
        if (i % 6 == 2)  // close above the sheet
            eye = on_sheet(random(-0.6, 0.6), random(-0.6, 0.6)) +
                  glm::dvec3(0, random(0.01, 0.06), 0);
        Camera camera =
            test::camera_at(glm::dvec3(eye), glm::dvec3(test::random_vec3(random, -0.6, 0.6)),
                            static_cast<float>(random(0.3, 1.2)));
        camera.near = static_cast<float>(random(0.02, 0.5));
        if (i % 4 == 1) {
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = static_cast<float>(random(0.1, 0.6));
        }
        View view = make_view(camera, scene.frame(), i % 2 ? 97 : 41, i % 2 ? 33 : 77);
        if (i % 5 < 2) {
            view.window.x = static_cast<float>(random(-1.5, 1.5)) * view.right.w;
            view.window.y = static_cast<float>(random(-1.5, 1.5)) * view.up.w;
        }
        out.push_back(view);
    }
    return out;
}

// A cluster is hidden by what is nearer alone, not by what is nearly as near and was drawn before.
TEST(ClusterViews, LoseNothingOfTheNearestLayer) {
    const DeviceScene scene = test::on_device(layers());
    test::Random random(5);
    for (int i = 0; i < 12; ++i) {
        // Also from so far that the closeness of an orthographic view is more than 1 / z.
        const double away = i % 4 == 2 ? 60.0 : 1.2;
        Camera camera = test::camera_at({random(-0.2, 0.2), away, random(-0.2, 0.2)},
                                        {random(-0.1, 0.1), 0.0, random(-0.1, 0.1)}, 0.9f);
        camera.near = static_cast<float>(random(0.1, 0.7));
        if (i % 2 == 0) {
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = 0.6f;
        }
        const View view = make_view(camera, scene.frame(), 97, 73);
        const auto wanted = words<std::uint64_t>(scene, view, false);
        EXPECT_TRUE(words<std::uint64_t>(scene, view, true) == wanted) << i;
        EXPECT_TRUE(words<std::uint32_t>(scene, view, true) ==
                    words<std::uint32_t>(scene, view, false))
            << i;
        EXPECT_GT(std::count_if(wanted.begin(), wanted.end(),
                                [](std::uint64_t word) { return word != ~std::uint64_t{0}; }),
                  5000);
    }
}

TEST(ClusterViews, LoseNothing) {
    Scene dense = bumpy_mesh();
    for (const Scene& world :
         {sheet(false), sheet(true), test::patchwork(900, 111, false), std::move(dense)}) {
        const DeviceScene scene = test::on_device(world), open = test::on_device(world);
        ASSERT_GT(scene.info().cluster_count, 1u);
        open_clusters(open);
        std::size_t seen = 0;
        const std::vector<View> views = views_of(scene, world.triangles.size());
        for (std::size_t v = 0; v < views.size(); ++v) {
            const auto wanted = words<std::uint64_t>(open, views[v], false);
            seen += std::count_if(wanted.begin(), wanted.end(),
                                  [](std::uint64_t word) { return word != ~std::uint64_t{0}; });
            const auto depth = words<std::uint32_t>(open, views[v], false);
            test::expect_closeness(depth, wanted, "depth alone");
            for (const bool whole : {false, true}) {
                const char* form = whole ? "raster_views" : "lists";
                EXPECT_TRUE(words<std::uint64_t>(scene, views[v], whole) == wanted)
                    << world.triangles.size() << " triangles, view " << v << ", " << form;
                EXPECT_TRUE(words<std::uint32_t>(scene, views[v], whole) == depth)
                    << world.triangles.size() << " triangles, depth of view " << v << ", " << form;
            }
        }
        EXPECT_GT(seen, 5000u);
    }
}

}  // namespace
}  // namespace clgi
