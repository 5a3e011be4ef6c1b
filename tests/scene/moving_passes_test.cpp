// The passes for geometry that moves: what they refuse, and rules that few links of a room ask for.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <functional>

#include "device.hpp"
#include "moving_room.hpp"

namespace clgi {
namespace {

// A small triangle close to a large one, above it and below it, off its middle: parts of the large
// one lie on all sides. Before it they all send; behind it what is let through goes on only along
// bins that lead away from its middle.
TEST(RelinkRules, LetNoLightGoBackAlongItsBin) {
    Scene scene = test::plain_scene();
    scene.materials[0].double_sided = true;
    test::add_triangle(scene, {0, 0, 0}, {0.3, 0.2, 4.0}, {4.2, 0.1, 0.4});
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    test::add_triangle(scene, {0.7, 0.3, 0.6}, {0.72, 0.33, 0.8}, {0.91, 0.31, 0.63});
    const auto at = [&](double height) {
        std::vector<glm::dvec3> out = scene.positions;
        for (std::uint32_t v = first; v < out.size(); ++v) out[v].y += height;
        return out;
    };
    AntiradianceOptions options;
    options.elements.max_area = 100.0;
    options.poses = {at(0.0), at(-0.5)};
    options.steps = 1;
    DeviceScene device = test::on_device(scene);
    AntiradianceSolver solver(test::programs(), test::device().queue, scene, device, options);
    SceneMover mover(test::programs(), test::device().queue, device);
    std::vector<ElementTree> poses;
    for (const auto& pose : options.poses)
        poses.push_back(posed_elements(solver.elements(), scene, pose));
    int ended = 0, sent = 0;
    for (const double height : {-0.01, -0.17, -0.33, -0.49}) {
        mover.move(0, at(height), scene.normals).wait();
        solver.geometry_changed();
        solver.run();
        const ElementTree here = posed_elements(solver.elements(), scene, at(height));
        const Links wanted = make_links(here, solver.bins(), options.links, poses);
        const auto bins = test::download<std::uint16_t>(solver.links().bins, wanted.count());
        const auto factors = test::download<float>(solver.links().form_factors, wanted.count());
        for (const LinkOfMotion& link : wanted.moving) {
            const std::uint32_t s = wanted.senders[link.link], r = link.receiver;
            EXPECT_EQ(bins[link.link], wanted.bins[link.link]) << height;
            EXPECT_EQ(factors[link.link] > 0.0f, wanted.form_factors[link.link] > 0.0f) << height;
            if (link.part == 0) continue;
            const glm::dvec3 way = here.positions[r] - here.positions[s];
            const glm::dvec3 w = solver.bins().directions[bins[link.link]];
            const bool before = glm::dot(here.normals[s], way) > 0.0;
            const bool faces = glm::dot(here.normals[r], way) < 0.0;
            if (!before && faces && factors[link.link] == 0.0f) ++ended;
            if (before && factors[link.link] > 0.0f && glm::dot(way, w) < 0.0) ++sent;
        }
    }
    EXPECT_GT(ended, 5);
    EXPECT_GT(sent, 2);
}

TEST(MovingElementPasses, RefuseWhatDoesNotFit) {
    for (const int bins : {0, 30, 33, 34, 4098})
        EXPECT_THROW(MovingElementPasses(test::programs(), bins), Error) << bins;
    const MovingElementPasses passes(test::programs(), 32);
    const cl::CommandQueue& queue = test::device().queue;
    const test::MovingRoom room;
    const DeviceScene scene = test::on_device(room.scene);
    const cl::Buffer tiny = test::empty<char>(1);
    const auto zeros = [](std::size_t bytes) { return test::upload(std::vector<char>(bytes, 0)); };
    const std::uint32_t count = 3;
    LinkBuffers links{
        zeros(count * sizeof(Element)), zeros(16), zeros(4), zeros(2), zeros(4), count, 1, 2, 1};
    MovingElements moving{zeros(count * sizeof(ElementPlace)),
                          zeros(count * sizeof(PatchCorners)),
                          zeros(4),
                          zeros(8),
                          zeros(4),
                          1};
    cl::Buffer directions = zeros(32 * 16);
    const ElementParams one{0, 1, 0, 0};
    const auto refit = [&] { passes.refit(queue, one, scene, moving, links, directions).wait(); };
    const auto clusters = [&] { passes.refit_clusters(queue, one, moving, links).wait(); };
    const auto relink = [&] { passes.relink(queue, scene, moving, links, directions).wait(); };
    EXPECT_NO_THROW(refit());
    EXPECT_NO_THROW(relink());
    const auto refuse = [&](cl::Buffer& buffer, std::initializer_list<std::function<void()>> who) {
        const cl::Buffer kept = buffer;
        const std::size_t bytes = kept.getInfo<CL_MEM_SIZE>();
        for (const cl::Buffer& small : {tiny, test::empty<char>(bytes - 1)}) {
            buffer = small;
            for (const auto& pass : who) EXPECT_THROW(pass(), Error);
        }
        buffer = kept;
    };
    refuse(moving.list, {refit, clusters});
    refuse(moving.places, {refit, clusters, relink});
    refuse(links.elements, {refit, clusters, relink});
    refuse(moving.patches, {refit, relink});
    refuse(directions, {refit, relink});
    refuse(moving.links, {relink});
    refuse(moving.senders, {relink});
    refuse(links.bins, {relink});
    refuse(links.form_factors, {relink});
    // Nothing to do.
    EXPECT_NO_THROW(passes.refit(queue, {0, 0, 0, 0}, scene, moving, links, directions).wait());
    EXPECT_NO_THROW(passes.refit_clusters(queue, {0, 0, 0, 0}, moving, links).wait());
    moving.link_count = 0;
    EXPECT_NO_THROW(relink());
}

}  // namespace
}  // namespace clgi
