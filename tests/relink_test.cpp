// Elements and links that follow geometry on the device, against those that the host makes of the
// scene in the same pose.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "device.hpp"
#include "math_modes.hpp"
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

    Posed(Math math, double time, int bins = 128, std::size_t wished = 700)
        : room(5),
          scene(test::on_device(room.scene)),
          solver(test::programs(), test::device().queue, room.scene, scene,
                 options(math, bins, wished)),
          mover(test::device().queue, scene) {
        room.move(mover, time);
        solver.geometry_changed();
        solver.run();
        tree = make_elements(room.scene, options(math, bins, wished).elements, room.poses(9));
        at = posed_elements(tree, room.scene, room.at(time));
        std::vector<ElementTree> poses;
        for (const auto& pose : room.poses(9))
            poses.push_back(posed_elements(tree, room.scene, pose));
        ElementTree reach = at;
        for (std::size_t i = 0; i < tree.count(); ++i)
            for (const ElementTree& pose : poses)
                reach.radii[i] = std::max(reach.radii[i], pose.radii[i]);
        links = make_links(reach, solver.bins(), options(math, bins, wished).links, poses);
    }
    AntiradianceOptions options(Math math, int bins, std::size_t wished) const {
        AntiradianceOptions out;
        out.bins = bins;
        out.elements.wished = wished;
        out.poses = room.poses(9);
        out.build.math = math;
        out.steps = 1;
        return out;
    }
    double scale() const { return scene.frame().scale; }
};

TEST_P(Relink, ChoosesTheBinsAndFormFactorsOfTheHost) {
    for (const double time : {0.0, 0.37, 0.81}) {
        const Posed posed(GetParam(), time);
        const Links& wanted = posed.links;
        ASSERT_GT(wanted.moving.size(), 10000u);
        ASSERT_EQ(posed.solver.link_count(), wanted.count());
        ASSERT_EQ(posed.solver.moving_links(), wanted.moving.size());
        const auto bins =
            test::download<std::uint16_t>(posed.solver.links().bins, wanted.count());
        const auto factors =
            test::download<float>(posed.solver.links().form_factors, wanted.count());
        const double area = posed.scale() * posed.scale();
        std::size_t other = 0, dead = 0, rough = 0, parts = 0, n=0;
        double worst = 0.0;
        for (const LinkOfMotion& of : wanted.moving) {
            const double factor = wanted.form_factors[of.link] / area;
            parts += of.part > 0;
            ++n;
            if ((factor > 0.0) != (factors[of.link] > 0.0f)) { ++dead; continue; }
            if (factor == 0.0) continue;
            if (bins[of.link] != wanted.bins[of.link]) { ++other; continue; }
            const double off = std::abs(factors[of.link] / factor - 1.0);
            worst = std::max(worst, off);
            rough += off > 1e-4;
        }
        printf("time %g links %zu moving %zu parts %zu other %zu dead %zu rough %zu worst %g\n", time,
               wanted.count(), n, parts, other, dead, rough, worst);
    }
}

}  // namespace
}  // namespace clgi
