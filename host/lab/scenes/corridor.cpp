// A corridor with rooms on both sides, lit by a spot in the corridor alone: what arrives in a room
// has gone through its door.
//
// The corridor runs from z = 0 towards -Z with its floor at y = 0. Walls are 0.12 m thick; every
// wall, floor and ceiling is cut at the edges of the doors, so that neighbours share vertices.
// SPDX-License-Identifier: MIT
#include <clgi/procedural.hpp>
#include <cmath>

#include "lab/scenes/rooms.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace corridor_scene {
namespace {

constexpr double wall = 0.12;  // metres, all
constexpr double door_width = 0.9;
constexpr double door_height = 2.05;
constexpr double leaf_thickness = 0.04;
constexpr double leaf_gap = 0.01;  // between a leaf and what is around it

struct Materials {
    std::uint32_t plaster, floor, door;
    std::vector<std::uint32_t> rooms;
};

// One room: side is -1 (left, x < 0) or +1; z falls from near to far.
struct Room {
    int side;
    double near, far;            // ends along the corridor
    double door_near, door_far;  // edges of its door
};

std::vector<Room> plan_rooms(const CorridorOptions& options) {
    std::vector<Room> rooms;
    for (int i = 0; i < options.rooms; ++i) {
        const double near = -options.room_length * i, far = near - options.room_length;
        for (const int side : {-1, 1}) {
            // Doors do not face each other: through one is seen a wall, not the next room.
            // A door that opens further than the wall beyond it is long moves to the middle, and
            // the one on the left nearer to the end, or both doorways would overlap.
            const bool wide = options.door_angle > 2.6f;
            const double left = wide ? 0.19 : 0.3, right = wide ? 0.5 : 0.7;
            const double door = near - options.room_length * (side < 0 ? left : right);
            rooms.push_back({side, near - 0.5 * wall, far + 0.5 * wall, door + 0.5 * door_width,
                             door - 0.5 * door_width});
        }
    }
    return rooms;
}

void add_corridor(Scene& scene, const CorridorOptions& options, const std::vector<Room>& rooms,
                  const Materials& materials) {
    const double half = 0.5 * options.width, end = -options.room_length * options.rooms;
    const std::vector<double> x = {-half, half}, y = {0.0, door_height, options.height};
    std::vector<double> z = {end};
    for (auto room = rooms.rbegin(); room != rooms.rend(); ++room) {
        z.insert(z.end(), {room->door_far, room->door_near});
    }
    z.push_back(0.0);

    const auto door_on = [&](int side) {
        return [&rooms, side](const glm::dvec3& at) {
            for (const Room& room : rooms) {
                if (room.side == side && at.y < door_height && at.z < room.door_near &&
                    at.z > room.door_far) {
                    return true;
                }
            }
            return false;
        };
    };
    generated::add_panel(scene, {1, 0.0, +1, z, x}, materials.floor);
    generated::add_panel(scene, {1, options.height, -1, z, x}, materials.plaster);
    generated::add_panel(scene, {0, -half, +1, y, z}, materials.plaster, door_on(-1));
    generated::add_panel(scene, {0, half, -1, y, z}, materials.plaster, door_on(+1));
    generated::add_panel(scene, {2, 0.0, -1, x, y}, materials.plaster);
    generated::add_panel(scene, {2, end, +1, x, y}, materials.plaster);
    generated::end_part(scene, "corridor");
}

// The faces inside the doorway, between the corridor's side of the wall and the room's.
void add_jamb(Scene& scene, const Room& room, double inner, double outer,
              const Materials& materials) {
    const std::vector<double> x = {std::min(inner, outer), std::max(inner, outer)};
    const std::vector<double> y = {0.0, door_height}, z = {room.door_far, room.door_near};
    generated::add_panel(scene, {1, 0.0, +1, z, x}, materials.floor);
    generated::add_panel(scene, {1, door_height, -1, z, x}, materials.plaster);
    generated::add_panel(scene, {2, room.door_near, -1, x, y}, materials.plaster);
    generated::add_panel(scene, {2, room.door_far, +1, x, y}, materials.plaster);
}

void add_room(Scene& scene, const CorridorOptions& options, const Room& room,
              const Materials& materials, std::uint32_t color) {
    const double inner = room.side * 0.5 * options.width;
    const double outer = inner + room.side * wall;
    const double back = outer + room.side * options.room_depth;
    const std::vector<double> x = {std::min(outer, back), std::max(outer, back)};
    const std::vector<double> y = {0.0, door_height, options.height};
    const std::vector<double> z = {room.far, room.door_far, room.door_near, room.near};
    const auto in_doorway = [&](const glm::dvec3& at) {
        return at.y < door_height && at.z < room.door_near && at.z > room.door_far;
    };
    generated::add_panel(scene, {1, 0.0, +1, z, x}, materials.floor);
    generated::add_panel(scene, {1, options.height, -1, z, x}, materials.plaster);
    generated::add_panel(scene, {0, outer, room.side, y, z}, color, in_doorway);
    generated::add_panel(scene, {0, back, -room.side, y, z}, color);
    generated::add_panel(scene, {2, room.near, -1, x, y}, color);
    generated::add_panel(scene, {2, room.far, +1, x, y}, color);
    add_jamb(scene, room, inner, outer, materials);
    generated::end_part(scene, "room");
}

// Hinged at the far edge of the doorway on the room's side, opening into the room.
void add_door(Scene& scene, const CorridorOptions& options, const Room& room,
              std::uint32_t material) {
    const glm::dvec3 outward(room.side, 0.0, 0.0), along(0.0, 0.0, 1.0);
    const double x = room.side * (0.5 * options.width + wall + leaf_gap);
    const glm::dvec3 hinge(x, leaf_gap, room.door_far + leaf_gap);
    const double c = std::cos(options.door_angle), s = std::sin(options.door_angle);
    generated::add_solid(scene, hinge,
                         {(c * along + s * outward) * (door_width - 2.0 * leaf_gap),
                          (s * along - c * outward) * leaf_thickness,
                          glm::dvec3(0.0, door_height - 2.0 * leaf_gap, 0.0)},
                         material);
    generated::end_part(scene, "door");
}

Materials add_materials(Scene& scene) {
    using generated::add_material;
    Materials materials;
    materials.plaster = add_material(scene, "plaster", {0.76f, 0.74f, 0.70f});
    materials.floor = add_material(scene, "floor", {0.46f, 0.33f, 0.21f});
    materials.door = add_material(scene, "door", {0.58f, 0.42f, 0.28f});
    materials.rooms = {add_material(scene, "red room", {0.68f, 0.16f, 0.12f}),
                       add_material(scene, "green room", {0.20f, 0.52f, 0.20f}),
                       add_material(scene, "blue room", {0.16f, 0.28f, 0.62f}),
                       add_material(scene, "yellow room", {0.72f, 0.58f, 0.16f})};
    return materials;
}

void check(const CorridorOptions& options) {
    generated::check_range("corridor", "rooms", options.rooms, 1, 64);
    generated::check_range("corridor", "door_angle", options.door_angle, 0.0, 2.97);
    generated::check_range("corridor", "width", options.width, 0.5, 100.0);
    generated::check_range("corridor", "height", options.height, 2.2, 100.0);
    generated::check_range("corridor", "room_length", options.room_length, 3.0, 100.0);
    generated::check_range("corridor", "room_depth", options.room_depth, 1.5, 100.0);
    generated::check_range("corridor", "cone_angle", options.cone_angle, 1e-3, 1.57);
    generated::check_color("corridor", "intensity", options.intensity, 1e20);
}

}  // namespace
}  // namespace corridor_scene

Scene corridor(const CorridorOptions& options) {
    using namespace corridor_scene;
    check(options);
    Scene scene;
    scene.name = "corridor";
    const Materials materials = add_materials(scene);
    const std::vector<Room> rooms = plan_rooms(options);
    add_corridor(scene, options, rooms, materials);
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        add_room(scene, options, rooms[i], materials, materials.rooms[i % materials.rooms.size()]);
        add_door(scene, options, rooms[i], materials.door);
    }
    const double top = options.height - 0.1;
    scene.lights.push_back(generated::spot("spot", {-0.3, top, -0.5}, {0.2, 0.0, -5.5},
                                           options.intensity, options.cone_angle));
    scene.cameras.push_back(
        generated::look_at("camera", {0.0, 1.5, -0.2}, {0.0, 1.25, -6.0}, 1.0f));
    return scene;
}

}  // namespace clgi
