// Chess pieces that move on a board. [Kautz04, figure 4] shows such a scene.
//
// The board is a grid of 16 x 16 squares, 289 vertices and 512 triangles, a texel of its texture
// for each field. A piece of n rings of s vertices and two poles is closed: n s + 2 vertices and
// 2 n s triangles. Five pieces of 16 sides have 90 rings together, the last has 13 of 12 sides:
// 1,608 vertices and 3,192 triangles.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/deforming.hpp"

#include "lab/scenes/rigging.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace chess_scene {
namespace {

constexpr double field = 0.05;       // metres, a side of a field of the board
constexpr double clip_length = 4.0;  // seconds
constexpr int keys = 81;

// A ring of a profile; every second vertex, or every second pair of them, is lower.
struct Ring {
    double radius, height;  // in fields
    double tooth = 0.0;
    int run = 1;  // vertices of a tooth
};

struct Profile {
    int sides;
    std::vector<Ring> rings;
    double top;
};

const Profile king = {16,
                      {{0.40, 0.01}, {0.42, 0.06}, {0.42, 0.14},  {0.36, 0.20},  {0.34, 0.26},
                       {0.27, 0.34}, {0.20, 0.50}, {0.16, 0.72},  {0.145, 0.95}, {0.16, 1.10},
                       {0.25, 1.16}, {0.25, 1.21}, {0.17, 1.26},  {0.20, 1.34},  {0.25, 1.52},
                       {0.26, 1.58}, {0.18, 1.64}, {0.07, 1.675}, {0.09, 1.74},  {0.06, 1.81}},
                      1.835};
const Profile queen = {16,
                       {{0.40, 0.01},
                        {0.41, 0.06},
                        {0.41, 0.13},
                        {0.35, 0.19},
                        {0.33, 0.25},
                        {0.26, 0.32},
                        {0.19, 0.48},
                        {0.15, 0.70},
                        {0.14, 0.90},
                        {0.155, 1.02},
                        {0.23, 1.07},
                        {0.23, 1.12},
                        {0.16, 1.17},
                        {0.19, 1.28},
                        {0.26, 1.42},
                        {0.29, 1.54, 0.06},
                        {0.20, 1.455},
                        {0.10, 1.50},
                        {0.08, 1.57}},
                       1.61};
const Profile bishop = {16,
                        {{0.38, 0.01},
                         {0.39, 0.06},
                         {0.39, 0.12},
                         {0.33, 0.18},
                         {0.31, 0.23},
                         {0.23, 0.31},
                         {0.16, 0.47},
                         {0.13, 0.66},
                         {0.14, 0.80},
                         {0.22, 0.85},
                         {0.22, 0.89},
                         {0.14, 0.94},
                         {0.19, 1.03},
                         {0.21, 1.14},
                         {0.17, 1.28},
                         {0.07, 1.40},
                         {0.085, 1.45},
                         {0.06, 1.50}},
                        1.52};
const Profile rook = {16,
                      {{0.38, 0.01},
                       {0.39, 0.06},
                       {0.39, 0.13},
                       {0.33, 0.19},
                       {0.31, 0.25},
                       {0.25, 0.34},
                       {0.22, 0.50},
                       {0.21, 0.68},
                       {0.22, 0.80},
                       {0.29, 0.86},
                       {0.30, 0.91},
                       {0.30, 0.97},
                       {0.30, 1.10, 0.10, 2},
                       {0.21, 1.10, 0.09, 2},
                       {0.21, 0.96},
                       {0.20, 0.95},
                       {0.10, 0.945}},
                      0.945};
const Profile pawn = {16,
                      {{0.34, 0.01},
                       {0.35, 0.05},
                       {0.35, 0.11},
                       {0.29, 0.16},
                       {0.27, 0.21},
                       {0.19, 0.28},
                       {0.13, 0.40},
                       {0.11, 0.52},
                       {0.12, 0.58},
                       {0.20, 0.62},
                       {0.20, 0.66},
                       {0.11, 0.69},
                       {0.18, 0.76},
                       {0.20, 0.85},
                       {0.17, 0.94},
                       {0.09, 1.01}},
                      1.03};
const Profile small_pawn = {12,
                            {{0.34, 0.01},
                             {0.35, 0.06},
                             {0.34, 0.13},
                             {0.27, 0.20},
                             {0.18, 0.28},
                             {0.12, 0.44},
                             {0.12, 0.56},
                             {0.20, 0.63},
                             {0.11, 0.69},
                             {0.18, 0.76},
                             {0.20, 0.85},
                             {0.17, 0.94},
                             {0.09, 1.01}},
                            1.03};

void add_piece(Scene& scene, const Profile& profile, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const Ring& ring : profile.rings)
        for (int side = 0; side < profile.sides; ++side) {
            const double angle = 2.0 * glm::pi<double>() * side / profile.sides;
            const bool low = side / ring.run % 2 == 1;
            scene.positions.push_back(field * glm::dvec3(ring.radius * std::cos(angle),
                                                         ring.height - (low ? ring.tooth : 0.0),
                                                         ring.radius * std::sin(angle)));
        }
    scene.positions.emplace_back(0.0, field * profile.rings[0].height, 0.0);
    scene.positions.emplace_back(0.0, field * profile.top, 0.0);
    generated::close_rings(scene, first, static_cast<int>(profile.rings.size()), profile.sides,
                           material);
}

// 0 before `from`, 1 after `to`, smooth between them. Seconds.
double eased(double time, double from, double to) {
    const double share = std::clamp((time - from) / (to - from), 0.0, 1.0);
    return share * share * share * (share * (6.0 * share - 15.0) + 10.0);
}

// There and back.
double visit(double time, double from, double there, double leave, double back) {
    return eased(time, from, there) - eased(time, leave, back);
}

// Where a piece stands, in fields, how far it leans, in radians, and how high it is drawn out.
struct Stance {
    glm::dvec3 place;
    glm::dvec3 lean = glm::dvec3(0.0);  // an axis times an angle
    double height = 1.0;
};

struct Piece {
    const char* name;
    const Profile* profile;
    bool white;
    Stance (*at)(double time);
};

// Slides lean back as they start and forward as they end.
Stance slide(const glm::dvec3& from, const glm::dvec3& way, double share, double pace) {
    return {from + way * share,
            glm::cross(glm::dvec3(0.0, 1.0, 0.0), glm::normalize(way)) * -0.22 * pace};
}

const Piece pieces[] = {
    // Bows to the queen.
    {"king", &king, true,
     [](double t) {
         const double bow = visit(t, 1.3, 1.9, 2.3, 2.9);
         return Stance{{-0.5, 0.0, 0.5}, {0.0, 0.0, -0.30 * bow}};
     }},
    {"queen", &queen, false,
     [](double t) {
         const double pace = visit(t, 0.2, 0.55, 0.75, 1.1) - visit(t, 2.9, 3.2, 3.4, 3.7);
         return slide({2.5, 0.0, -2.5}, {-2.0, 0.0, 2.0}, visit(t, 0.2, 1.1, 2.9, 3.7), pace);
     }},
    {"bishop", &bishop, true,
     [](double t) {
         const double pace = visit(t, 0.8, 1.2, 1.4, 1.8) - visit(t, 2.7, 3.1, 3.3, 3.7);
         return slide({-2.5, 0.0, -1.5}, {1.0, 0.0, -1.0}, visit(t, 0.8, 1.8, 2.7, 3.7), pace);
     }},
    {"rook", &rook, false,
     [](double t) {
         const double pace = visit(t, 0.4, 0.7, 1.0, 1.3) - visit(t, 2.2, 2.5, 2.8, 3.1);
         return slide({1.5, 0.0, 2.5}, {-3.0, 0.0, 0.0}, visit(t, 0.4, 1.3, 2.2, 3.1), pace);
     }},
    // Hops two fields and back, flat before a leap and long in it.
    {"pawn", &pawn, true,
     [](double t) {
         const double arc = 4.0 * eased(t, 0.5, 1.2) * (1.0 - eased(t, 0.5, 1.2)) +
                            4.0 * eased(t, 2.4, 3.1) * (1.0 - eased(t, 2.4, 3.1));
         const double crouch = visit(t, 0.3, 0.5, 0.5, 0.7) + visit(t, 1.1, 1.25, 1.25, 1.45) +
                               visit(t, 2.2, 2.4, 2.4, 2.6) + visit(t, 3.0, 3.15, 3.15, 3.35);
         return Stance{{-1.5 + 2.0 * visit(t, 0.5, 1.2, 2.4, 3.1), 0.9 * arc, 1.5},
                       {},
                       1.0 - 0.22 * crouch + 0.15 * arc};
     }},
    // Rocks as the others pass.
    {"small pawn", &small_pawn, false,
     [](double t) {
         const double swing = visit(t, 0.6, 1.4, 2.6, 3.4);
         const double rock = 0.16 * swing * std::sin(2.0 * glm::pi<double>() * t / 0.8);
         return Stance{{1.5, 0.0, 0.5}, {0.0, 0.0, rock}};
     }},
};

// About the edge of the foot on the side that a piece leans to, so that it stays on the board.
glm::dvec3 tipped(const Stance& stance, double radius) {
    const double angle = glm::length(stance.lean);
    if (angle < 1e-9) return stance.place;
    const glm::dvec3 side = glm::cross(stance.lean / angle, glm::dvec3(0.0, 1.0, 0.0)) * radius;
    const glm::dquat turn = glm::angleAxis(angle, stance.lean / angle);
    return stance.place + side - turn * side;
}

void add_board(Scene& scene, std::uint32_t material) {
    generated::add_floor(scene, 16, 8.0 * field, material);
    scene.uvs.clear();
    for (const glm::dvec3& place : scene.positions) {
        const double u = place.x / (8.0 * field) + 0.5, v = place.z / (8.0 * field) + 0.5;
        scene.uvs.emplace_back(static_cast<float>(u), static_cast<float>(v), 0.0f, 0.0f);
    }
    Texture texture;
    texture.name = "board";
    texture.width = texture.height = 8;
    texture.nearest = true;
    texture.wrap_s = texture.wrap_t = Wrap::clamp_to_edge;
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            const bool light = (row + column) % 2 == 0;
            const std::array<std::uint8_t, 4> texel =
                light ? std::array<std::uint8_t, 4>{228, 214, 184, 255}
                      : std::array<std::uint8_t, 4>{118, 74, 48, 255};
            texture.rgba.insert(texture.rgba.end(), texel.begin(), texel.end());
        }
    scene.textures.push_back(texture);
    scene.materials[material].base_texture.texture = 0;
}

}  // namespace
}  // namespace chess_scene

Scene chess(const ChessOptions& options) {
    using namespace chess_scene;
    generated::check_color("chess", "white", options.white, 1.0);
    generated::check_color("chess", "black", options.black, 1.0);

    Scene scene;
    scene.name = "chess";
    const std::uint32_t board = generated::add_material(scene, "board", glm::vec3(1.0f));
    const std::uint32_t white = generated::add_material(scene, "white", options.white);
    const std::uint32_t black = generated::add_material(scene, "black", options.black);
    add_board(scene, board);

    generated::Rig rig(scene, "play", clip_length);
    for (const Piece& piece : pieces) {
        add_piece(scene, *piece.profile, piece.white ? white : black);
        generated::smooth_normals(scene);
        const std::uint32_t node = rig.add_node(piece.name, -1, field * piece.at(0.0).place);
        rig.end_moving_part(piece.name, node);
        std::vector<glm::dvec3> places;
        std::vector<glm::dquat> turns;
        std::vector<float> scales;
        for (int key = 0; key < keys; ++key) {
            const Stance stance = piece.at(clip_length * key / (keys - 1));
            const double angle = glm::length(stance.lean);
            places.push_back(field * tipped(stance, piece.profile->rings[0].radius));
            turns.push_back(angle > 0.0 ? glm::angleAxis(angle, stance.lean / angle)
                                        : glm::dquat(1.0, 0.0, 0.0, 0.0));
            // Of the same volume whatever its height.
            const auto wide = static_cast<float>(1.0 / std::sqrt(stance.height));
            scales.insert(scales.end(), {wide, static_cast<float>(stance.height), wide});
        }
        rig.shift(node, places);
        rig.turn(node, turns);
        if (piece.profile == &pawn)
            rig.drive(node, ChannelTarget::scale, Interpolation::linear, 3, scales, keys);
    }
    scene.uvs.resize(scene.positions.size(), glm::vec4(0.0f));

    generated::add_daylight(scene, {0.55f, -1.0f, -0.45f}, 2.2f);
    scene.cameras.push_back(
        generated::look_at("camera", {0.14, 0.20, 0.33}, {0.0, 0.022, 0.0}, 0.58f));
    rig.finish();
    return scene;
}

}  // namespace clgi
