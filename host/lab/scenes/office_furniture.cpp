// SPDX-License-Identifier: MIT
#include "lab/scenes/office_furniture.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/surfaces.hpp"

namespace clgi::generated {
namespace {

// Numbers that look drawn at random, the same everywhere: a low-discrepancy sequence, in [0,1).
double varied(int i, int which) {
    const double steps[] = {0.754877666246693, 0.569840290998053, 0.430159709001947};
    const double at = 0.5 + (i + 1) * steps[which];
    return at - std::floor(at);
}

// A leaf: a thin solid of eight triangles around its middle rib.
void add_leaf(Scene& scene, const Placement& at, double length, double width,
              std::uint32_t material) {
    const double thick = 0.004;
    const glm::dvec3 rim[] = {{-width, 0.5 * length, 0.0},
                              {0.0, 0.45 * length, thick},
                              {width, 0.5 * length, 0.0},
                              {0.0, 0.45 * length, -thick}};
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        const glm::vec3 normal(at.axes * glm::normalize(glm::cross(b - a, c - a)));
        for (const glm::dvec3& p : {a, b, c}) {
            scene.positions.push_back(at(p));
            scene.normals.push_back(normal);
        }
        scene.triangles.push_back({{first, first + 1, first + 2}, material});
    };
    for (int k = 0; k < 4; ++k) {
        const glm::dvec3 &here = rim[k], &next = rim[(k + 1) % 4];
        add(here, glm::dvec3(0.0), next);
        add(next, {0.0, length, -0.25 * length}, here);
    }
}

}  // namespace

void add_desk(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_block(scene, at, {-0.8, 0.72, -0.375}, {0.8, 0.755, 0.375}, materials.wood);
    for (const double x : {-0.77, 0.72})
        for (const double z : {-0.35, 0.30})
            add_block(scene, at, {x, 0.0, z}, {x + 0.05, 0.72, z + 0.05}, materials.metal);
    add_block(scene, at, {-0.72, 0.45, -0.345}, {0.27, 0.68, -0.325}, materials.pale_wood);
    add_block(scene, at, {0.28, 0.10, -0.33}, {0.70, 0.70, 0.30}, materials.pale_wood);
    for (int drawer = 0; drawer < 3; ++drawer) {
        const double y = 0.115 + 0.195 * drawer;
        add_block(scene, at, {0.295, y, 0.30}, {0.685, y + 0.18, 0.32}, materials.white);
        add_block(scene, at, {0.43, y + 0.11, 0.32}, {0.55, y + 0.125, 0.335}, materials.metal);
    }
}

void add_monitor(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_turned(scene, at, {{0.11, 0.0}, {0.11, 0.008}, {0.03, 0.016}}, 16, materials.black);
    add_block(scene, at, {-0.02, 0.018, -0.02}, {0.02, 0.20, -0.005}, materials.black);
    add_block(scene, at, {-0.29, 0.13, 0.0}, {0.29, 0.48, 0.025}, materials.black);
    add_block(scene, at, {-0.27, 0.15, 0.025}, {0.27, 0.46, 0.027}, materials.metal);
    add_block(scene, at, {-0.22, 0.0, 0.24}, {0.22, 0.02, 0.38}, materials.black);
    for (int row = 0; row < 3; ++row)
        add_block(scene, at, {-0.205, 0.02, 0.255 + 0.04 * row}, {0.205, 0.026, 0.285 + 0.04 * row},
                  materials.white);
}

void add_desk_lamp(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_turned(scene, at, {{0.085, 0.0}, {0.085, 0.015}, {0.02, 0.024}}, 12, materials.metal);
    const glm::dvec3 elbow(0.0, 0.34, -0.14), head(0.0, 0.46, 0.10);
    add_rod(scene, at, {0.0, 0.026, 0.0}, elbow, 0.009, 6, materials.metal);
    add_cushion(scene, at(placed(elbow + glm::dvec3(0.0, 0.016, 0.002))), glm::dvec3(0.016), 2.0, 8,
                4, materials.black);
    add_rod(scene, at, elbow + glm::dvec3(0.0, 0.034, 0.01), head, 0.009, 5, materials.metal);
    add_turned(scene, at(along(head + glm::dvec3(0.0, 0.012, 0.0), {0.0, -1.0, 0.35})),
               {{0.090, 0.16}, {0.085, 0.16}, {0.026, 0.012}, {0.030, 0.0}}, 12, materials.accent,
               Outline::loop);
}

void add_mug(Scene& scene, const Placement& at, std::uint32_t material) {
    add_turned(scene, at, {{0.036, 0.0}, {0.040, 0.09}, {0.036, 0.09}, {0.033, 0.008}}, 12,
               material);
}

void add_office_chair(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    for (int leg = 0; leg < 5; ++leg) {
        const double angle = 0.3 + 2.0 * glm::pi<double>() * leg / 5;
        const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
        add_bar(scene, at, 0.045 * out + glm::dvec3(0.0, 0.115, 0.0),
                0.29 * out + glm::dvec3(0.0, 0.085, 0.0), 0.03, materials.black);
        add_block(scene, at(placed(0.30 * out, -angle)), {-0.025, 0.0, -0.012},
                  {0.025, 0.06, 0.012}, materials.black);
    }
    add_turned(scene, at, {{0.035, 0.09}, {0.035, 0.2}, {0.02, 0.21}, {0.02, 0.42}}, 10,
               materials.metal);
    add_cushion(scene, at(placed({0.0, 0.47, 0.0})), {0.25, 0.045, 0.24}, 3.5, 12, 6,
                materials.fabric);
    add_bar(scene, at, {0.0, 0.415, -0.18}, {0.0, 0.70, -0.29}, 0.03, materials.black);
    add_cushion(scene, at(along({0.0, 0.80, -0.27}, {0.0, 1.0, -0.14})), {0.22, 0.26, 0.035}, 3.5,
                12, 6, materials.fabric);
    for (const double x : {-0.28, 0.28}) {
        add_block(scene, at, {x - 0.015, 0.48, -0.02}, {x + 0.015, 0.66, 0.02}, materials.metal);
        add_block(scene, at, {x - 0.03, 0.66, -0.13}, {x + 0.03, 0.685, 0.13}, materials.black);
    }
}

namespace {

// A row of books of three heights, one closed surface: faces of millimetres apart would be dozens
// of surfaces behind each other, through which light without visibility takes as many steps.
// Returns the number of the next book.
int add_books(Scene& scene, const Placement& at, double from, double to, int book,
              const OfficeMaterials& materials) {
    std::vector<double> x = {from};
    const int first = book;
    while (x.back() < to) x.push_back(x.back() + 0.046 + 0.044 * varied(book++, 0));
    const Wood wood = [&](int i, int j) { return j <= static_cast<int>(3 * varied(first + i, 1)); };
    const auto count = static_cast<int>(materials.books.size());
    const Grain cover = [&](int i, int) {
        return materials.books[static_cast<std::size_t>((first + i) % count)];
    };
    add_carved(scene, at, x, {0.0, 0.21, 0.255, 0.295}, wood, 0.20, cover);
    return book;
}

}  // namespace

void add_bookcase(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    const double half = 0.8, depth = 0.30, board = 0.025, gap = 0.395;
    add_block(scene, at, {-half - board, 0.0, 0.0}, {half + board, 2.03, 0.012},
              materials.pale_wood);
    for (const double x : {-half - board, half})
        add_block(scene, at, {x, 0.002, 0.012}, {x + board, 2.028, depth}, materials.pale_wood);
    int book = 0;
    for (int row = 0; row <= 5; ++row) {
        const double y = 0.03 + gap * row;
        add_block(scene, at, {-half, y - board, 0.012}, {half, y, depth - 0.002},
                  materials.pale_wood);
        if (row == 5) break;
        const double end = row == 1 ? half - 0.48 : row == 3 ? half - 0.34 : half - 0.08;
        book = add_books(scene, at(placed({0.0, y, 0.03})), -half + 0.012, end, book, materials);
        if (row == 1)
            add_turned(scene, at(placed({half - 0.25, y, 0.15})),
                       {{0.05, 0.0},
                        {0.09, 0.06},
                        {0.10, 0.12},
                        {0.07, 0.19},
                        {0.035, 0.23},
                        {0.045, 0.26},
                        {0.035, 0.26},
                        {0.025, 0.22},
                        {0.0, 0.20}},
                       12, materials.clay);
        if (row == 3) {
            add_turned(scene, at(placed({half - 0.16, y, 0.15})), {{0.06, 0.0}, {0.02, 0.02}}, 12,
                       materials.wood);
            add_cushion(scene, at(placed({half - 0.16, y + 0.14, 0.15})), glm::dvec3(0.115), 2.0,
                        12, 8, materials.books[1]);
        }
    }
}

void add_armchair(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    for (const double x : {-0.30, 0.30})
        for (const double z : {-0.28, 0.28})
            add_rod(scene, at, {x, 0.0, z}, {x, 0.139, z}, 0.022, 6, materials.wood);
    add_blunt_block(scene, at, {-0.36, 0.14, -0.34}, {0.36, 0.26, 0.34}, 0.03, materials.leather);
    add_cushion(scene, at(placed({0.0, 0.345, 0.03})), {0.27, 0.08, 0.32}, 4.0, 12, 6,
                materials.leather);
    add_cushion(scene, at(along({0.0, 0.56, -0.27}, {0.0, 1.0, -0.18})), {0.30, 0.30, 0.09}, 4.0,
                12, 6, materials.leather);
    for (const double x : {-0.36, 0.36})
        add_cushion(scene, at(placed({x, 0.42, 0.0})), {0.08, 0.15, 0.36}, 4.0, 12, 6,
                    materials.leather);
}

void add_plant(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_turned(scene, at, {{0.11, 0.0}, {0.16, 0.28}, {0.17, 0.30}, {0.145, 0.30}, {0.13, 0.25}},
               14, materials.clay);
    for (int leaf = 0; leaf < 24; ++leaf) {
        const double share = (leaf + 0.5) / 24;
        const double angle = 2.399963 * leaf, lean = 0.12 + 1.05 * share;
        const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
        const glm::dvec3 foot = (0.015 + 0.06 * share) * out + glm::dvec3(0.0, 0.255, 0.0);
        const glm::dvec3 y = std::cos(lean) * glm::dvec3(0.0, 1.0, 0.0) + std::sin(lean) * out;
        const glm::dvec3 x = glm::normalize(glm::cross(y, out));
        const Placement blade{foot, glm::dmat3(x, y, glm::cross(x, y))};
        add_leaf(scene, at(blade), 0.72 - 0.22 * share, 0.035 + 0.02 * varied(leaf, 0),
                 materials.leaf);
    }
}

void add_pendant(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_rod(scene, at, {0.0, -0.46, 0.0}, {0.0, 0.0, 0.0}, 0.006, 6, materials.black);
    add_turned(scene, at,
               {{0.215, -0.68},
                {0.16, -0.53},
                {0.04, -0.46},
                {0.03, -0.475},
                {0.15, -0.545},
                {0.205, -0.68}},
               14, materials.white, Outline::loop);
}

void add_floor_lamp(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_turned(scene, at, {{0.14, 0.0}, {0.14, 0.018}, {0.016, 0.03}, {0.013, 1.5}}, 12,
               materials.metal);
    add_turned(scene, at, {{0.20, 1.34}, {0.135, 1.66}, {0.13, 1.66}, {0.195, 1.34}}, 20,
               materials.white, Outline::loop);
}

void add_waste_bin(Scene& scene, const Placement& at, const OfficeMaterials& materials) {
    add_turned(scene, at, {{0.12, 0.0}, {0.15, 0.30}, {0.145, 0.30}, {0.116, 0.006}}, 14,
               materials.metal);
}

void add_picture(Scene& scene, const Placement& at, const glm::dvec2& half_size,
                 std::uint32_t frame, std::uint32_t canvas) {
    const double w = half_size.x, h = half_size.y, edge = 0.03, gap = 0.031;
    const Wood wood = [](int i, int j) { return i != 1 || j != 1; };
    add_carved(scene, at, {-w, edge - w, w - edge, w}, {-h, edge - h, h - edge, h}, wood, 0.03,
               [=](int, int) { return frame; });
    add_block(scene, at, {gap - w, gap - h, 0.0}, {w - gap, h - gap, 0.012}, canvas);
}

}  // namespace clgi::generated
