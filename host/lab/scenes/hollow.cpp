// SPDX-License-Identifier: MIT
#include "lab/scenes/hollow.hpp"

#include "scene/surfaces.hpp"

namespace clgi::generated {
namespace {

struct Side {
    int axis, u, v;
    double inner, outer;
    int inward;  // +1 or -1 along the axis
};

// From the inner to the outer face, around the open cells.
void add_reveals(Scene& scene, const Hollow& room, Wall wall, const Side& side) {
    const std::vector<double>&first = room.cuts[side.u], &second = room.cuts[side.v];
    const auto place = [&](double across, double u, double v) {
        glm::dvec3 p(0.0);
        p[side.axis] = across;
        p[side.u] = u;
        p[side.v] = v;
        return p;
    };
    const auto is_open = [&](std::size_t i, std::size_t j) {
        if (i + 1 >= first.size() || j + 1 >= second.size()) return false;
        return room.open(wall, place(side.inner, 0.5 * (first[i] + first[i + 1]),
                                     0.5 * (second[j] + second[j + 1])));
    };
    const auto add = [&](const glm::dvec2& p, const glm::dvec2& q, const glm::dvec3& towards) {
        std::array<glm::dvec3, 4> quad = {place(side.inner, p.x, p.y), place(side.inner, q.x, q.y),
                                          place(side.outer, q.x, q.y), place(side.outer, p.x, p.y)};
        const glm::dvec3 normal = glm::cross(quad[1] - quad[0], quad[3] - quad[0]);
        if (glm::dot(normal, towards) < 0.0) std::swap(quad[1], quad[3]);
        add_quad(scene, quad, room.materials[wall]);
    };
    for (std::size_t i = 0; i + 1 < first.size(); ++i)
        for (std::size_t j = 0; j + 1 < second.size(); ++j) {
            if (!is_open(i, j)) continue;
            const glm::dvec2 low(first[i], second[j]), high(first[i + 1], second[j + 1]);
            const glm::dvec3 u = place(0.0, 1.0, 0.0), v = place(0.0, 0.0, 1.0);
            if (!is_open(i - 1, j)) add(low, {low.x, high.y}, u);
            if (!is_open(i + 1, j)) add({high.x, low.y}, high, -u);
            if (!is_open(i, j - 1)) add(low, {high.x, low.y}, v);
            if (!is_open(i, j + 1)) add({low.x, high.y}, high, -v);
        }
}

}  // namespace

void add_hollow(Scene& scene, const Hollow& room) {
    std::array<std::vector<double>, 3> wide = room.cuts;
    for (std::vector<double>& cuts : wide) {
        cuts.front() -= room.thickness;
        cuts.back() += room.thickness;
    }
    for (int w = 0; w < wall_count; ++w) {
        const Wall wall = static_cast<Wall>(w);
        const int axis = w / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const bool low = w % 2 == 0;
        const double inner = low ? room.cuts[axis].front() : room.cuts[axis].back();
        const double outer = low ? wide[axis].front() : wide[axis].back();
        const auto open = [&](const glm::dvec3& middle) {
            return room.open && room.open(wall, middle);
        };
        const Side side{axis, u, v, inner, outer, low ? 1 : -1};
        add_panel(scene, {axis, inner, side.inward, room.cuts[u], room.cuts[v]},
                  room.materials[wall], open);
        if (!room.open) continue;
        add_panel(scene, {axis, outer, -side.inward, wide[u], wide[v]}, room.outside, open);
        add_reveals(scene, room, wall, side);
    }
}

std::vector<double> even_cuts(double low, double high, int count) {
    std::vector<double> out;
    for (int i = 0; i <= count; ++i) out.push_back(low + (high - low) * i / count);
    return out;
}

}  // namespace clgi::generated
