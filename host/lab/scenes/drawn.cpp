// SPDX-License-Identifier: MIT
#include "lab/scenes/drawn.hpp"

#include <clgi/error.hpp>

#include "lab/scenes/drawn_parts.hpp"
#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace drawn_scene {
namespace {

using namespace generated;

Scene draw_room(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    add_chamber(scene, draws, chamber);
    add_furniture(scene, draws, chamber);
    add_lamp(scene, chamber, {draws.between(0.1, 0.9), draws.between(0.2, 0.9)},
             draws.between(0.3, 1.2), 50.0f);
    add_view(scene, draws, chamber);
    return scene;
}

Scene draw_gloss(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    add_chamber(scene, draws, chamber);
    add_furniture(scene, draws, chamber, 0.4f);
    scene.lights.push_back(point("lamp", chamber.low + chamber.size * glm::dvec3(0.5, 0.85, 0.4),
                                 glm::vec3(40.0f, 38.0f, 34.0f)));
    add_view(scene, draws, chamber);
    return scene;
}

Scene draw_windowed(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    add_chamber(scene, draws, chamber, draw_window(draws, chamber));
    add_furniture(scene, draws, chamber);
    add_view(scene, draws, chamber);
    if (options.extent > 0.0) add_ground(scene, draws, chamber, options.extent, 0.0);
    return scene;
}

void add_sun(Scene& scene, const glm::vec3& direction, const glm::vec3& lux) {
    Light& sun = scene.lights.emplace_back();
    sun.name = "sun";
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(direction);
    sun.intensity = lux;
}

// Through the window; what it lights is about ten times as bright as a sky of 1 cd/m^2.
Scene draw_sunlit(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    const Hole window = draw_window(draws, chamber);
    add_chamber(scene, draws, chamber, window);
    add_furniture(scene, draws, chamber);
    add_view(scene, draws, chamber);
    if (options.extent > 0.0) add_ground(scene, draws, chamber, options.extent, 0.0);
    const float inward = window.wall % 2 == 0 ? 1.0f : -1.0f;
    const auto aside = static_cast<float>(draws.between(-0.5, 0.5));
    const auto down = static_cast<float>(draws.between(-1.0, -0.4));
    add_sun(scene,
            window.wall < 2 ? glm::vec3(inward, down, aside) : glm::vec3(aside, down, inward),
            31.0f * glm::vec3(1.0f, 0.95f, 0.9f));
    return scene;
}

// A wall with a slit from floor to roof; the lamp is behind it.
Scene draw_slit(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    Chamber chamber = draw_chamber(draws);
    chamber.size.z += 3.0;
    add_chamber(scene, draws, chamber);
    const double z = 0.7 * chamber.size.z, slit = draws.between(0.15, 0.5),
                 x = draws.between(0.2, 0.8) * (chamber.size.x - slit);
    const std::uint32_t material = add_material(scene, "partition", draws.colour());
    add_block(scene, placed(chamber.low), {-0.01, -0.01, z}, {x, chamber.size.y + 0.01, z + 0.1},
              material);
    add_block(scene, placed(chamber.low), {x + slit, -0.01, z},
              {chamber.size.x + 0.01, chamber.size.y + 0.01, z + 0.1}, material);
    scene.lights.push_back(point("lamp", chamber.low + chamber.size * glm::dvec3(0.5, 0.7, 0.85),
                                 glm::vec3(60.0f, 56.0f, 48.0f)));
    Chamber before = chamber;
    before.size.z = z;
    add_furniture(scene, draws, before);
    add_view(scene, draws, before);
    return scene;
}

// A pit in the ground: the sky lights it.
Scene draw_courtyard(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    Chamber chamber = draw_chamber(draws);
    chamber.size = {draws.between(6.0, 12.0), draws.between(4.0, 10.0), draws.between(8.0, 14.0)};
    chamber.wall = 3.0;
    chamber.roof = false;
    add_chamber(scene, draws, chamber);
    add_furniture(scene, draws, chamber);
    add_view(scene, draws, chamber);
    add_ground(scene, draws, chamber, options.extent > 0.0 ? options.extent : 200.0, 0.0);
    return scene;
}

// A pit with nearly white walls: the sky's light takes many bounces.
Scene draw_pit(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    Chamber chamber;
    chamber.size = {draws.between(5.0, 12.0), 10.0, draws.between(6.0, 12.0)};
    chamber.wall = 3.0;
    chamber.roof = false;
    add_chamber(scene, draws, chamber);
    for (Material& material : scene.materials)
        material.base_color = glm::vec4(0.96f, 0.95f, 0.93f, 1.0f);
    add_view(scene, draws, chamber);
    add_ground(scene, draws, chamber, options.extent > 0.0 ? options.extent : 1000.0, 0.0);
    return scene;
}

Scene draw_terrain(const DrawnOptions& options) {
    Scene scene = draw_room(options);
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    const double extent = options.extent > 0.0 ? options.extent : 1e4;
    add_ground(scene, draws, chamber, extent, 0.03 * extent);
    return scene;
}

// Equal rooms in a row, a lamp in each; the camera is in one of them.
Scene draw_many(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    Chamber chamber = draw_chamber(draws);
    const int rooms = draws.whole(20, 200), where = draws.whole(0, rooms - 1);
    const double side = draws.between(0.4, 1.2);
    const glm::dvec2 place(draws.between(0.1, 0.9), draws.between(0.2, 0.9));
    for (int k = 0; k < rooms; ++k) {
        Draws same(options.seed + 1);
        chamber.low.x = k * (chamber.size.x + 1.0);
        add_chamber(scene, same, chamber);
        add_lamp(scene, chamber, place, side, 50.0f);
        if (k != where) continue;
        add_furniture(scene, same, chamber);
        add_view(scene, same, chamber);
    }
    return scene;
}

// A screen in one room, a dim panel in the camera's.
Scene draw_dim_room(const DrawnOptions& options) {
    Scene scene = draw_room(options);
    for (Material& material : scene.materials) material.emission *= 0.1f;
    Draws draws(options.seed + 1000);
    Chamber beside = draw_chamber(draws);
    beside.low.x = 20.0;
    add_chamber(scene, draws, beside);
    add_lamp(scene, beside, {0.5, 0.5}, 1.0, 1000.0f);
    return scene;
}

// A sealed room with a lamp of a thousandth of a candela, in a plain under the sky.
Scene draw_dim_plain(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    add_chamber(scene, draws, chamber);
    add_furniture(scene, draws, chamber);
    add_view(scene, draws, chamber);
    scene.lights.push_back(
        point("lamp", chamber.low + chamber.size * glm::dvec3(draws.between(0.3, 0.7), 0.85, 0.4),
              1e-3f * glm::vec3(1.0f, 0.9f, 0.7f)));
    add_ground(scene, draws, chamber, options.extent > 0.0 ? options.extent : 1000.0, 0.0);
    return scene;
}

// A bright spot on a wall that the camera does not see, a weak one on one that it does; what it
// sees is lit from the first wall by the ceiling. A plain around.
Scene draw_hidden_wall(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    const Chamber chamber = draw_chamber(draws);
    add_chamber(scene, draws, chamber);
    // A screen behind which the bright wall lies; it leaves a gap below the ceiling.
    const double z = 0.35 * chamber.size.z, gap = draws.between(0.3, 0.8);
    const std::uint32_t material = add_material(scene, "screen", draws.colour());
    add_block(scene, placed(chamber.low), {-0.01, -0.01, z},
              {chamber.size.x + 0.01, chamber.size.y - gap, z + 0.1}, material);
    const glm::dvec3 behind = chamber.low + chamber.size * glm::dvec3(0.5, 0.3, 0.3),
                     before = chamber.low + chamber.size * glm::dvec3(0.5, 0.6, 0.5);
    scene.lights.push_back(
        spot("hidden", behind, behind - glm::dvec3(0.0, 0.0, 1.0), glm::vec3(1e6f), 0.3f));
    scene.lights.push_back(
        spot("seen", before, before + glm::dvec3(0.2, 0.0, 1.0), glm::vec3(25.0f), 0.3f));
    Chamber seen = chamber;
    seen.low.z += z + 0.1;
    seen.size.z -= z + 0.1;
    add_view(scene, draws, seen);
    add_ground(scene, draws, chamber, options.extent > 0.0 ? options.extent : 1000.0, 0.0);
    return scene;
}

// The sun through a hole of 10 cm in the roof of a hall.
Scene draw_hole(const DrawnOptions& options) {
    Scene scene;
    Draws draws(options.seed);
    Chamber chamber = draw_chamber(draws);
    chamber.size = {draws.between(15.0, 30.0), draws.between(6.0, 10.0), 30.0};
    Hole hole;
    hole.wall = draws.whole(0, 1);
    hole.low = draws.between(0.4, 0.6) * chamber.size.z;
    hole.high = hole.low + 0.1;
    hole.sill = 0.8 * chamber.size.y;
    hole.lintel = hole.sill + 0.1;
    add_chamber(scene, draws, chamber, hole);
    add_view(scene, draws, chamber);
    const auto aside = static_cast<float>(draws.between(-0.3, 0.3));
    add_sun(scene, {hole.wall == 0 ? 1.0f : -1.0f, -0.4f, aside}, {1e5f, 0.95e5f, 0.9e5f});
    return scene;
}

}  // namespace
}  // namespace drawn_scene

const std::vector<DrawnKind>& drawn_kinds() {
    using namespace drawn_scene;
    static const std::vector<DrawnKind> kinds = {
        {"room", "furnished, with a panel lamp", false, draw_room},
        {"window", "a furnished room with a window", true, draw_windowed},
        {"sunlit", "the sun through the window of a furnished room", true, draw_sunlit},
        {"slit", "a room whose light comes through a slit", false, draw_slit},
        {"courtyard", "a court that is open above", true, draw_courtyard},
        {"pit", "a pit with nearly white walls", true, draw_pit},
        {"terrain", "a room in a terrain", false, draw_terrain},
        {"many-rooms", "20 to 200 rooms with a lamp each", false, draw_many},
        {"dim-room", "a dim lamp, and a bright one in another room", false, draw_dim_room},
        {"dim-plain", "a dark room in a plain under the sky", true, draw_dim_plain},
        {"hidden-wall", "light by way of a bright wall that is not seen", false, draw_hidden_wall},
        {"hole", "the sun through a hole of 10 cm", false, draw_hole},
        {"gloss", "a room with shining furniture", false, draw_gloss},
    };
    return kinds;
}

Scene drawn(const std::string& kind, const DrawnOptions& options) {
    using namespace drawn_scene;
    check_range("drawn scene", "extent", options.extent, 0.0, 1e5);
    for (const DrawnKind& one : drawn_kinds()) {
        if (one.name != kind) continue;
        Scene out = one.draw(options);
        end_part(out, kind);
        out.name = kind;
        return out;
    }
    throw Error("drawn scene: there is no kind '" + kind + "'");
}

}  // namespace clgi
