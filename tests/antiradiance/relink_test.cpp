// Elements and links that follow geometry on the device, against those that the host makes of the
// scene in the same pose.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "device.hpp"
#include "math_modes.hpp"
#include "methods/antiradiance/device_links.hpp"
#include "methods/antiradiance/element_places.hpp"
#include "methods/antiradiance/element_surface.hpp"
#include "moving_room.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(Relink);

// A solver in a pose, and what the host makes of it there.
struct Posed {
    test::MovingRoom room;
    DeviceScene scene;
    AntiradianceSolver solver;
    SceneMover mover;
    ElementTree tree, at;
    Links links;  // at that pose
    DeviceLinks on_device;

    Posed(Math math, double time, int bins = 128, std::size_t requested = 1500)
        : room(5),
          scene(test::on_device(room.scene)),
          solver(test::programs(), test::device().queue, room.scene, scene,
                 options(math, bins, requested)),
          mover(test::device().queue, scene) {
        room.move(mover, time);
        solver.geometry_changed();
        solver.run();
        tree = make_elements(room.scene, options(math, bins, requested).elements, room.poses(9));
        at = posed_elements(tree, room.scene, room.at(time));
        std::vector<ElementTree> poses;
        for (const auto& pose : room.poses(9))
            poses.push_back(posed_elements(tree, room.scene, pose));
        ElementTree reach = at;
        for (std::size_t i = 0; i < tree.count(); ++i)
            for (const ElementTree& pose : poses)
                reach.radii[i] = std::max(reach.radii[i], pose.radii[i]);
        links = make_links(reach, solver.bins(), options(math, bins, requested).links, poses);
        auto elements = make_element_surface(tree, solver.bins(), room.scene, scene).elements;
        on_device = device_links(tree, solver.bins(), links, scale(), {}, elements, false);
    }
    AntiradianceOptions options(Math math, int bins, std::size_t requested) const {
        AntiradianceOptions out;
        out.bins = bins;
        out.elements.requested = requested;
        out.poses = room.poses(9);
        out.build.math = math;
        out.steps = 1;
        return out;
    }
    double scale() const { return scene.frame().scale; }
};

std::vector<std::uint16_t> bins_of(const AntiradianceSolver& solver) {
    return test::download<std::uint16_t>(solver.links().bins, solver.link_count());
}
std::vector<float> factors_of(const AntiradianceSolver& solver) {
    return test::download<float>(solver.links().form_factors, solver.link_count());
}

// Floats round positions to 2^-24 of the scene, and so decide otherwise about what lies in a plane
// or half way between bins, and are off where a sender is seen edge on.
TEST_P(Relink, ChoosesTheBinsAndFormFactorsOfTheHost) {
    for (const int count : {128, 32})
        for (const double time : {0.0, 0.37, 0.81}) {
            const Posed posed(GetParam(), time, count);
            const Links& wanted = posed.links;
            ASSERT_GT(wanted.moving.size(), 10000u);
            ASSERT_EQ(posed.solver.link_count(), wanted.count());
            ASSERT_EQ(posed.solver.moving_links(), wanted.moving.size());
            const auto bins = bins_of(posed.solver);
            const auto factors = factors_of(posed.solver);
            const double area = posed.scale() * posed.scale();
            std::size_t other = 0, rough = 0, live = 0;
            for (const LinkOfMotion& of : wanted.moving) {
                const double factor = wanted.form_factors[of.link] / area;
                const std::uint32_t place = posed.on_device.places[of.link];
                if (bins[place] != wanted.bins[of.link] ||
                    (factor > 0.0) != (factors[place] > 0.0f)) {
                    ++other;
                    continue;
                }
                if (factor == 0.0) {
                    EXPECT_EQ(factors[place], 0.0f);
                    continue;
                }
                ++live;
                const double off = std::abs(factors[place] / factor - 1.0);
                EXPECT_LT(off, 1e-2);
                rough += off > 1e-4;
            }
            EXPECT_GT(live, wanted.moving.size() / 4);
            EXPECT_LT(other, wanted.moving.size() / 1000) << time;
            EXPECT_LT(rough, wanted.moving.size() / 1000) << time;
        }
}

// Links between elements that stand still keep their bits.
TEST_P(Relink, LeavesStillLinksAlone) {
    const Posed posed(GetParam(), 0.37);
    const auto bins = bins_of(posed.solver);
    const auto factors = factors_of(posed.solver);
    std::size_t next = 0, still = 0;
    for (std::uint32_t k = 0; k < posed.links.count(); ++k) {
        if (next < posed.links.moving.size() && posed.links.moving[next].link == k) {
            ++next;
            continue;
        }
        ++still;
        const std::uint32_t place = posed.on_device.places[k];
        ASSERT_EQ(bins[place], posed.links.bins[k]);
        ASSERT_EQ(factors[place], posed.on_device.form_factors[place]);
    }
    EXPECT_GT(still, 10000u);
}

TEST_P(Relink, PutsLeavesWhereTheHostDoes) {
    const Posed posed(GetParam(), 0.37);
    const auto elements = test::download<Element>(posed.solver.links().elements, posed.at.count());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < posed.at.count(); ++i) {
        if (!posed.at.is_leaf(i)) continue;
        const glm::dvec3& normal = posed.at.normals[i];
        const glm::dvec3 wanted = normal * posed.solver.bins().hemisphere_scale(normal);
        EXPECT_LT(glm::distance(glm::dvec3(elements[i].normal), wanted), 1e-5) << i;
        const double area = posed.at.areas[i] * posed.scale() * posed.scale();
        EXPECT_NEAR(elements[i].normal.w, area, 1e-5 * area) << i;
        moved += posed.at.moves(i) && normal != posed.tree.normals[i];
    }
    EXPECT_GT(moved, 50u);
}

// The passes alone, on a scene in a pose.
struct Followed {
    Posed posed{Math::strict, 0.37};
    LinkBuffers links = posed.solver.links();
    MovingElements moving;
    std::vector<ElementTree> poses;
    std::vector<std::uint32_t> list;
    std::uint32_t patches = 0;
    cl::Buffer directions = test::upload(direction_rows(posed.solver.bins()));

    Followed() {
        for (const auto& pose : posed.room.poses(9))
            poses.push_back(posed_elements(posed.tree, posed.room.scene, pose));
        for (const bool patch : {true, false}) {
            for (std::size_t i = posed.tree.count(); i-- > 0;)
                if (posed.tree.moves(i) && posed.tree.is_patch(i) == patch)
                    list.push_back(static_cast<std::uint32_t>(i));
            if (patch) patches = static_cast<std::uint32_t>(list.size());
        }
        moving.patches = posed.solver.surface().patches;
        moving.list = test::upload(list);
        moving.links = test::upload(posed.on_device.moving);
        moving.senders = test::upload(posed.on_device.moving_senders);
        moving.link_count = static_cast<std::uint32_t>(posed.links.moving.size());
    }
    // From the scene's own pose on.
    void follow(const BuildOptions& options) {
        const cl::CommandQueue& queue = test::device().queue;
        const MovingElementPasses passes(test::programs(), 128, options);
        moving.places = test::upload(
            element_places(posed.tree, poses, posed.solver.bins(), posed.room.scene, posed.scene));
        links.bins = test::upload(std::vector<std::uint16_t>(links.link_count, 999));
        links.form_factors = test::upload(std::vector<float>(links.link_count, -1.0f));
        passes.refit(queue, {0, patches, 0, 0}, posed.scene, moving, links, directions);
        // One by one, children first.
        for (auto k = patches; k < list.size(); ++k)
            passes.refit_clusters(queue, {k, 1, 0, 0}, moving, links);
        passes.relink(queue, posed.scene, moving, links, directions).wait();
    }
    std::vector<ElementPlace> places() const {
        return test::download<ElementPlace>(moving.places, posed.tree.count());
    }
};

TEST(RelinkBits, AreTheSameInEveryPacketAndGroup) {
    Followed of;
    const auto found = [&](int width, std::size_t local) {
        of.follow({.packet_width = width, .local_size = local});
        return std::pair(test::download<std::uint16_t>(of.links.bins, of.links.link_count),
                         test::download<float>(of.links.form_factors, of.links.link_count));
    };
    const auto wanted = found(1, 1);
    for (const glm::uvec2& link : of.posed.on_device.moving) ASSERT_GE(wanted.second[link.x], 0.0f);
    // Links of what stands still are not written.
    EXPECT_EQ(std::count(wanted.second.begin(), wanted.second.end(), -1.0f),
              static_cast<std::ptrdiff_t>(of.posed.links.count() - of.posed.links.moving.size()));
    EXPECT_EQ(found(4, 3), wanted);
    EXPECT_EQ(found(8, 16), wanted);
    EXPECT_EQ(found(16, 7), wanted);
}

TEST(Refit, PutsElementsWhereTheHostDoes) {
    Followed of;
    of.follow({});
    const ElementTree& at = of.posed.at;
    const SceneFrame& frame = of.posed.scene.frame();
    const auto places = of.places();
    const auto before = element_places(of.posed.tree, of.poses, of.posed.solver.bins(),
                                       of.posed.room.scene, of.posed.scene);
    for (std::size_t i = 0; i < at.count(); ++i) {
        const double area = at.areas[i] * frame.scale * frame.scale;
        EXPECT_LT(glm::distance(glm::vec3(places[i].position), frame.to_local(at.positions[i])),
                  2e-6f)
            << i;
        EXPECT_NEAR(places[i].area, area, 1e-5 * area) << i;
        EXPECT_LT(glm::distance(glm::dvec3(places[i].normal), at.normals[i]), 1e-5) << i;
        EXPECT_EQ(places[i].position.w, before[i].position.w) << i;
        EXPECT_EQ(places[i].triangle, before[i].triangle) << i;
        if (at.is_flat(i)) {
            EXPECT_NEAR(places[i].normal.w, of.posed.solver.bins().hemisphere_scale(at.normals[i]),
                        1e-5);
        }
        if (!at.is_leaf(i)) {
            EXPECT_GE(places[i].position.w, 0.999999 * at.radii[i] * frame.scale) << i;
        } else {
            EXPECT_EQ(places[i].position.w, 0.0f);
        }
    }
}

// A box that shrinks to a point: its clusters are there, and those above are where the rest is.
TEST(Refit, FollowsTrianglesThatCollapse) {
    Followed of;
    std::vector<glm::dvec3> pose = of.posed.room.at(0.37);
    for (std::uint32_t v = 0; v < 24; ++v) pose[of.posed.room.first + v] = {1.0, 1.2, 0.9};
    of.posed.mover.move(0, pose, of.posed.room.scene.normals).wait();
    of.follow({});
    const ElementTree at = posed_elements(of.posed.tree, of.posed.room.scene, pose);
    const auto places = of.places();
    std::size_t collapsed = 0;
    for (std::size_t i = 0; i < at.count(); ++i) {
        const glm::vec3 wanted = of.posed.scene.frame().to_local(at.positions[i]);
        EXPECT_LT(glm::distance(glm::vec3(places[i].position), wanted), 2e-6f) << i;
        collapsed += at.areas[i] == 0.0;
        if (at.areas[i] == 0.0) {
            EXPECT_EQ(places[i].area, 0.0f) << i;
            EXPECT_EQ(places[i].normal, glm::vec4(0.0f)) << i;
        }
    }
    EXPECT_GT(collapsed, 12u);
}

// A room of millimetres and one of a kilometre: powers of two change no bit.
TEST(RelinkBits, AreTheSameAtEveryScale) {
    const test::MovingRoom room;
    const auto solved = [&](double scale) {
        Scene file = room.scene;
        AntiradianceOptions options;
        options.bins = 64;
        options.steps = 1;
        options.elements.requested = 300;
        options.poses = room.poses(4);
        Scene there = room.posed(0.37);
        for (auto* positions : {&file.positions, &there.positions, &options.poses[0],
                                &options.poses[1], &options.poses[2], &options.poses[3]})
            for (glm::dvec3& p : *positions) p *= scale;
        file.lights[0].position *= scale;
        DeviceScene scene = test::on_device(file);
        AntiradianceSolver solver(test::programs(), test::device().queue, file, scene, options);
        SceneMover mover(test::programs(), test::device().queue, scene);
        mover.move(0, there.positions, there.normals).wait();
        solver.geometry_changed();
        solver.run();
        return std::pair(bins_of(solver), factors_of(solver));
    };
    const auto wanted = solved(1.0);
    EXPECT_EQ(solved(0x1p-8), wanted);
    EXPECT_EQ(solved(0x1p8), wanted);
}

// What collapses to a point or a line sends nothing; what lies within or upon another surface
// gives finite numbers.
TEST_P(Relink, StaysFiniteWhereSurfacesMeet) {
    Scene scene = test::furnished_room(5);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    test::add_box(scene, {1.0, 1.0, 1.0}, {1.5, 1.5, 1.5}, 1);  // stands
    const auto second = static_cast<std::uint32_t>(scene.positions.size());
    test::add_box(scene, {2.0, 1.0, 1.0}, {2.5, 1.5, 1.5}, 1);
    const auto at = [&](const glm::dvec3& by, double size) {
        std::vector<glm::dvec3> out = scene.positions;
        for (std::uint32_t v = second; v < out.size(); ++v)
            out[v] = out[second] + size * (out[v] - out[second]) + by;
        return out;
    };
    AntiradianceOptions options;
    options.elements.requested = 500;
    options.build.math = GetParam();
    options.poses = {at({0, 0, 0}, 1.0), at({-1, 0, 0}, 1.0), at({-2, 0, 0}, 1.0),
                     at({-2, 0, 0}, 0.0)};
    DeviceScene device = test::on_device(scene);
    AntiradianceSolver solver(test::programs(), test::device().queue, scene, device, options);
    SceneMover mover(test::programs(), test::device().queue, device);
    std::vector<std::vector<glm::dvec3>> places = {
        at({-1, 0, 0}, 1.0),                                // one within the other, bit by bit
        at({-1, 0.5, 0}, 1.0),                              // upon it
        at({-1, 0.5 + 1e-7, 0}, 1.0), at({-1, 0, 0}, 0.0),  // a point in a corner of it
        at({-2.6, 0, 0}, 1.0)};                             // through the wall
    places.push_back(places[0]);                            // a line
    for (std::uint32_t v = second; v < scene.positions.size(); ++v)
        places.back()[v] = scene.positions[first] + 0.01 * (v - second) * glm::dvec3(1, 1, 0);
    std::size_t in_plane = 0;
    for (const auto& place : places) {
        mover.move(0, place, scene.normals).wait();
        solver.geometry_changed();
        ASSERT_TRUE(solver.run());
        EXPECT_EQ(solver.status().non_finite, 0u);
        for (const float factor : factors_of(solver)) {
            ASSERT_TRUE(std::isfinite(factor));
            ASSERT_GE(factor, 0.0f);
        }
        for (const std::uint16_t bin : bins_of(solver)) ASSERT_LT(bin, 128);
        // What lies in a sender's plane sees nothing of it, and what collapsed sends nothing.
        const ElementTree here = posed_elements(solver.elements(), scene, place);
        const auto firsts =
            test::download<std::uint32_t>(solver.links().first_links, 2 * here.count() + 1);
        const auto senders =
            test::download<std::uint32_t>(solver.links().senders, solver.link_count());
        const auto factors = factors_of(solver);
        const auto elements = test::download<Element>(solver.links().elements, here.count());
        std::vector<std::uint32_t> of_row(solver.links().row_count);
        for (std::uint32_t i = 0; i < elements.size(); ++i)
            if (elements[i].sends != ELEMENT_NONE) of_row[elements[i].sends] = i;
        for (std::size_t r = 0; r < here.count(); ++r)
            for (std::uint32_t k = firsts[2 * r + 1]; k < firsts[2 * r + 2]; ++k) {
                const std::uint32_t s = of_row[senders[k]];
                if (!here.is_patch(s) || !(here.moves(s) || here.moves(r))) continue;
                const glm::dvec3 way = here.positions[r] - here.positions[s];
                if (std::abs(glm::dot(here.normals[s], way)) > 1e-9) continue;
                ++in_plane;
                ASSERT_EQ(factors[k], 0.0f);
            }
        for (const glm::vec4& e :
             test::download<glm::vec4>(solver.leaves().irradiances, solver.elements().leaves))
            ASSERT_TRUE(std::isfinite(e.x + e.y + e.z));
    }
    EXPECT_GT(in_plane, 1000u);
}

}  // namespace
}  // namespace clgi
