// Passages that light from above reaches around corners. [Dachsbacher07, figure 12]
// SPDX-License-Identifier: MIT
#include <string>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace maze_scene {
namespace {

// From above, the camera's end at the bottom: '#' wall, '.' passage, 'o' passage open above.
const std::vector<std::string> plan = {"######",  //
                                       "#.oo.#",  //
                                       "#.##.#",  //
                                       "#....#",  //
                                       "##..##",  //
                                       "#....#",  //
                                       "######"};
// Widths of the plan's columns and rows, metres.
const std::vector<double> columns = {0.3, 1.1, 0.8, 0.8, 1.1, 0.3};
const std::vector<double> rows = {0.3, 1.1, 0.3, 1.4, 0.3, 2.6, 0.3};
constexpr double height = 2.4, roof = 0.25;

std::vector<double> sums(const std::vector<double>& widths) {
    std::vector<double> out = {0.0};
    for (const double width : widths) out.push_back(out.back() + width);
    return out;
}

struct Materials {
    std::uint32_t floor, ceiling, outside, left, right, across;
};

// A wall between a passage and what is beyond it, from the floor up. Its cuts are those of its
// neighbours: where a passage is open above, the wall goes on through the roof.
void add_wall(Scene& scene, const glm::dvec2& from, const glm::dvec2& to, double low, double high,
              std::uint32_t material) {
    generated::add_quad(scene,
                        {glm::dvec3(from.x, low, from.y), glm::dvec3(to.x, low, to.y),
                         glm::dvec3(to.x, high, to.y), glm::dvec3(from.x, high, from.y)},
                        material);
}

void add_passages(Scene& scene, const Materials& m) {
    const std::vector<double> x = sums(columns), z = sums(rows);
    const auto cell = [&](std::size_t i, std::size_t j) { return plan[j][i]; };
    for (std::size_t j = 0; j < rows.size(); ++j)
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const double x0 = x[i], x1 = x[i + 1], z0 = z[j], z1 = z[j + 1];
            const bool open = cell(i, j) == 'o';
            if (!open) {
                const double top = height + roof;
                generated::add_quad(
                    scene, {glm::dvec3(x0, top, z0), {x0, top, z1}, {x1, top, z1}, {x1, top, z0}},
                    m.outside);
            }
            generated::add_quad(
                scene,
                {glm::dvec3(x0, -roof, z0), {x1, -roof, z0}, {x1, -roof, z1}, {x0, -roof, z1}},
                m.outside);
            if (cell(i, j) == '#') continue;
            generated::add_quad(
                scene, {glm::dvec3(x0, 0.0, z0), {x0, 0.0, z1}, {x1, 0.0, z1}, {x1, 0.0, z0}},
                m.floor);
            if (!open)
                generated::add_quad(scene,
                                    {glm::dvec3(x0, height, z0),
                                     {x1, height, z0},
                                     {x1, height, z1},
                                     {x0, height, z1}},
                                    m.ceiling);
            // What is beyond each side, the side's ends from the right to the left, its colour.
            const struct {
                char beyond;
                glm::dvec2 from, to;
                std::uint32_t material;
            } sides[] = {{cell(i - 1, j), {x0, z1}, {x0, z0}, m.left},
                         {cell(i + 1, j), {x1, z0}, {x1, z1}, m.right},
                         {cell(i, j - 1), {x0, z0}, {x1, z0}, m.across},
                         {cell(i, j + 1), {x1, z1}, {x0, z1}, m.across}};
            for (const auto& side : sides) {
                if (side.beyond == '#')
                    add_wall(scene, side.from, side.to, 0.0, height, side.material);
                if (open && side.beyond != 'o')
                    add_wall(scene, side.from, side.to, height, height + roof, m.ceiling);
            }
        }
}

// Around it all, facing outward.
void add_outside(Scene& scene, const Materials& m) {
    const std::vector<double> x = sums(columns), y = {-roof, height + roof}, z = sums(rows);
    generated::add_panel(scene, {0, x.front(), -1, y, z}, m.outside);
    generated::add_panel(scene, {0, x.back(), +1, y, z}, m.outside);
    generated::add_panel(scene, {2, z.front(), -1, x, y}, m.outside);
    generated::add_panel(scene, {2, z.back(), +1, x, y}, m.outside);
}

}  // namespace
}  // namespace maze_scene

Scene maze(const MazeOptions& options) {
    using namespace maze_scene;
    generated::check_range("maze", "illuminance", options.illuminance, 0.0, 1e20);
    Scene scene;
    scene.name = "maze";
    using generated::add_material;
    Materials m;
    m.floor = add_material(scene, "floor", {0.52f, 0.50f, 0.46f});
    m.ceiling = add_material(scene, "ceiling", {0.80f, 0.79f, 0.76f});
    m.outside = add_material(scene, "outside", {0.45f, 0.44f, 0.42f});
    m.left = add_material(scene, "left", {0.72f, 0.30f, 0.18f});
    m.right = add_material(scene, "right", {0.20f, 0.42f, 0.60f});
    m.across = add_material(scene, "across", {0.78f, 0.75f, 0.68f});
    add_passages(scene, m);
    add_outside(scene, m);
    generated::end_part(scene, "maze");
    // What throws a shadow, though nothing shines on it.
    const double middle = 0.5 * sums(columns).back(), near = sums(rows).back() - rows.back();
    generated::add_blunt_block(scene, generated::placed({middle - 0.85, 0.0, near - 1.95}, 0.5),
                               {-0.26, 0.0, -0.26}, {0.26, 0.95, 0.26}, 0.02, m.left);
    generated::add_cushion(scene, generated::placed({middle + 0.80, 0.32, near - 1.85}),
                           glm::dvec3(0.32), 2.0, 20, 12, m.across);
    generated::end_part(scene, "objects");

    Light sun;
    sun.name = "sun";
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(glm::vec3(0.0f, -1.0f, 0.42f));
    sun.intensity = options.illuminance * glm::vec3(1.0f, 0.95f, 0.86f);
    scene.lights.push_back(sun);
    scene.cameras.push_back(generated::look_at("camera", {middle - 0.1, 1.5, near - 0.05},
                                               {middle + 0.05, 0.95, 0.0}, 1.12f));
    return scene;
}

}  // namespace clgi
