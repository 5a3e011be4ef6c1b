// SPDX-License-Identifier: MIT
#include "methods/light_atlas/patches.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <tuple>

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double spacings = 2.0;  // within which vertices are welded (clgi/advanced/adjacency.hpp)

enum class Use : std::uint8_t {
    surface,
    thin,  // no normal; patches grow across it
    none,  // degenerate, or a copy
};

struct Shape {
    glm::dvec3 normal{};  // unit
    double area = 0.0;    // m^2
    double doubt = 0.0;   // radians that rounding of the corners may turn the normal by
    Use use = Use::surface;
    bool double_sided = false;
};

double largest(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

Shape shape_of(const Scene& scene, const SceneTriangle& triangle, const glm::dvec3& middle) {
    glm::dvec3 p[3];
    double size = 0.0;
    for (int k = 0; k < 3; ++k) {
        p[k] = scene.positions[triangle.vertex[k]];
        size = std::max(size, largest(p[k] - middle));
    }
    Shape out;
    const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double twice = glm::length(across);
    const double longest =
        std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
    const double height = longest > 0.0 ? twice / longest : 0.0;
    const double tolerance = size > 0.0 ? spacings * std::ldexp(1.0, std::ilogb(size) - 23) : 0.0;
    out.area = 0.5 * twice;
    out.double_sided = scene.materials[triangle.material].double_sided;
    if (!(height > tolerance)) {
        out.use = Use::thin;
        return out;
    }
    out.normal = across / twice;
    out.doubt = std::min(pi, std::atan(tolerance / height));
    return out;
}

// Copies reflect once.
void drop_copies(const Scene& scene, const Adjacency& mesh, std::vector<Shape>& shapes) {
    struct Corners {
        std::array<std::uint32_t, 3> sorted;
        std::uint32_t triangle;
        bool odd;  // an odd permutation of the sorted corners
    };
    std::vector<Corners> all;
    all.reserve(shapes.size());
    for (std::uint32_t t = 0; t < shapes.size(); ++t) {
        if (mesh.triangle_edges[t][0] == no_index) continue;
        Corners c{{}, t, false};
        for (int k = 0; k < 3; ++k) c.sorted[k] = mesh.welded[scene.triangles[t].vertex[k]];
        for (const int k : {0, 1, 0})
            if (c.sorted[k] > c.sorted[k + 1]) {
                std::swap(c.sorted[k], c.sorted[k + 1]);
                c.odd = !c.odd;
            }
        all.push_back(c);
    }
    std::sort(all.begin(), all.end(), [](const Corners& a, const Corners& b) {
        return std::tie(a.sorted, a.triangle) < std::tie(b.sorted, b.triangle);
    });
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
        while (last < all.size() && all[last].sorted == all[first].sorted) ++last;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = first; j < i; ++j) {
                const Shape& earlier = shapes[all[j].triangle];
                Shape& later = shapes[all[i].triangle];
                if (earlier.use == Use::none) continue;
                if (all[i].odd == all[j].odd || (earlier.double_sided && later.double_sided)) {
                    later.use = Use::none;
                    break;
                }
            }
    }
}

// Across edges of exactly two triangles that count, wound alike.
std::vector<std::array<std::uint32_t, 3>> links(const Adjacency& mesh,
                                                const std::vector<Shape>& shapes) {
    std::vector<std::array<std::uint32_t, 3>> out(shapes.size(), {no_index, no_index, no_index});
    for (const MeshEdge& edge : mesh.edges) {
        const EdgeUse* pair[2];
        int count = 0;
        for (std::uint32_t u = edge.first_use; u < edge.first_use + edge.use_count; ++u) {
            const EdgeUse& use = mesh.uses[u];
            if (shapes[use.triangle].use == Use::none) continue;
            if (count < 2) pair[count] = &use;
            ++count;
        }
        if (count != 2 || pair[0]->forward == pair[1]->forward) continue;
        out[pair[0]->triangle][pair[0]->side] = pair[1]->triangle;
        out[pair[1]->triangle][pair[1]->side] = pair[0]->triangle;
    }
    return out;
}

// Grows one patch after the other.
class Growth {
public:
    Growth(const Scene& scene, const std::vector<Shape>& shapes, const PatchOptions& options,
           double radius, Patches& out)
        : scene_(scene),
          shapes_(shapes),
          max_angle_(options.max_angle),
          max_offset_(options.max_offset * radius),
          out_(out),
          reached_(shapes.size(), no_index) {}

    void grow(std::uint32_t seed) {
        const auto number = static_cast<std::uint32_t>(out_.patches.size());
        Patch patch;
        patch.first = static_cast<std::uint32_t>(out_.triangles.size());
        patch.double_sided = shapes_[seed].double_sided;
        queue_.assign(1, seed);
        reached_[seed] = number;
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            const std::uint32_t t = queue_[i];
            if (shapes_[t].use == Use::surface) {
                out_.triangle_patch[t] = number;
                out_.triangles.push_back(t);
            }
            for (const std::uint32_t next : out_.neighbours[t]) {
                if (next == no_index || out_.triangle_patch[next] != no_index) continue;
                if (reached_[next] == number || !belongs(next, seed)) continue;
                reached_[next] = number;
                queue_.push_back(next);
            }
        }
        patch.count = static_cast<std::uint32_t>(out_.triangles.size()) - patch.first;
        measure(patch);
        out_.area += patch.area;
        out_.patches.push_back(patch);
    }

private:
    const glm::dvec3& corner(std::uint32_t triangle, int k) const {
        return scene_.positions[scene_.triangles[triangle].vertex[k]];
    }

    bool belongs(std::uint32_t t, std::uint32_t seed) const {
        const Shape &one = shapes_[t], &first = shapes_[seed];
        if (one.double_sided != first.double_sided) return false;
        if (one.use == Use::surface) {
            const double most = std::min(pi, max_angle_ + one.doubt + first.doubt);
            if (glm::dot(one.normal, first.normal) < std::cos(most)) return false;
        }
        for (int k = 0; k < 3; ++k)
            if (std::abs(glm::dot(corner(t, k) - corner(seed, 0), first.normal)) > max_offset_)
                return false;
        return true;
    }

    void measure(Patch& patch) const {
        const glm::dvec3 origin = corner(out_.triangles[patch.first], 0);
        glm::dvec3 normal(0.0), centre(0.0);
        for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i) {
            const std::uint32_t t = out_.triangles[i];
            const double area = shapes_[t].area;
            patch.area += area;
            normal += area * shapes_[t].normal;
            glm::dvec3 sum(0.0);
            for (int k = 0; k < 3; ++k) sum += corner(t, k) - origin;
            centre += area / 3.0 * sum;
        }
        patch.centre = origin + centre / patch.area;
        const double length = glm::length(normal);
        patch.normal = length > 0.0 ? normal / length : shapes_[out_.triangles[patch.first]].normal;
        for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i) {
            const Shape& shape = shapes_[out_.triangles[i]];
            const double cosine = std::clamp(glm::dot(shape.normal, patch.normal), -1.0, 1.0);
            patch.spread = std::max(patch.spread, std::acos(cosine) - shape.doubt);
        }
    }

    const Scene& scene_;
    const std::vector<Shape>& shapes_;
    const double max_angle_, max_offset_;  // radians, metres
    Patches& out_;
    std::vector<std::uint32_t> reached_;  // [triangles] the last patch that tried it
    std::vector<std::uint32_t> queue_;
};

}  // namespace

void check_patches(const Scene& scene, const PatchOptions& options) {
    const auto fail = [](const char* name, float got, const char* needs) {
        throw Error("make_patches: " + std::string(name) + " is " + std::to_string(got) +
                    ", needs " + needs);
    };
    if (!(options.max_angle >= 0.0f && options.max_angle <= 1.57f))
        fail("max_angle", options.max_angle, "0 to 1.57");
    if (!(options.max_offset >= 0.0f && std::isfinite(options.max_offset)))
        fail("max_offset", options.max_offset, "a number of at least 0");
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.triangles[t].material >= scene.materials.size())
            throw InputError("make_patches: triangle " + std::to_string(t) + " has material " +
                             std::to_string(scene.triangles[t].material) + ", there are " +
                             std::to_string(scene.materials.size()));
}

Patches make_patches(const Scene& scene, const PatchOptions& options) {
    check_patches(scene, options);
    return make_patches(scene, adjacency(scene), options);
}

Patches make_patches(const Scene& scene, const Adjacency& mesh, const PatchOptions& options) {
    const Bounds box = bounds(scene);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);
    const auto count = static_cast<std::uint32_t>(scene.triangles.size());

    std::vector<Shape> shapes(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        shapes[t] = shape_of(scene, scene.triangles[t], middle);
        if (mesh.triangle_edges[t][0] == no_index) shapes[t].use = Use::none;
    }
    drop_copies(scene, mesh, shapes);

    Patches out;
    out.triangle_patch.assign(count, no_index);
    out.neighbours = links(mesh, shapes);
    std::vector<std::uint32_t> seeds;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (shapes[t].use == Use::surface) {
            seeds.push_back(t);
        } else {
            ++out.skipped_triangles;
            out.skipped_area += shapes[t].area;
        }
    }
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
        return shapes[a].area > shapes[b].area;
    });
    out.triangles.reserve(seeds.size());
    Growth growth(scene, shapes, options, 0.5 * glm::length(box.high - box.low), out);
    for (const std::uint32_t seed : seeds)
        if (out.triangle_patch[seed] == no_index) growth.grow(seed);

    // What was only crossed is no neighbour.
    for (std::uint32_t t = 0; t < count; ++t)
        for (std::uint32_t& next : out.neighbours[t])
            if (next != no_index &&
                (out.triangle_patch[t] == no_index || out.triangle_patch[next] == no_index))
                next = no_index;
    return out;
}

}  // namespace clgi
