// SPDX-License-Identifier: MIT
#include <clgi/advanced/elements.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <numeric>
#include <string>

#include "methods/antiradiance/faces.hpp"
#include "methods/antiradiance/halve.hpp"
#include "methods/antiradiance/leaf_area.hpp"
#include "methods/antiradiance/moving_triangles.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

using Corners = std::array<glm::dvec3, 3>;

constexpr double most_leaves = 67108864.0;  // 2^26
constexpr double flatness = 1e-3;           // radians, and of a cluster's radius

void check(const ElementOptions& options) {
    const auto fail = [](const char* name, double got) {
        throw Error("make_elements: " + std::string(name) + " is " + std::to_string(got) +
                    ", needs a number of at least 0");
    };
    if (!(options.max_area >= 0.0 && std::isfinite(options.max_area)))
        fail("max_area", options.max_area);
    if (!(options.min_area >= 0.0 && std::isfinite(options.min_area)))
        fail("min_area", options.min_area);
    if (options.requested == 0) throw Error("make_elements: wished is 0, needs at least 1");
}

// Writes elements in depth-first order; what depends on children comes after.
class Builder {
public:
    // moves: [triangles of the scene]; empty: none does, else there are faces alone.
    Builder(const VertexCells& leaves, const Scene& scene, const VertexPoses& poses,
            const std::vector<std::uint8_t>& moves, ElementTree& out)
        : out_(out), leaves_(leaves), faces_(leaves.faces), moves_(moves), centres_(1) {
        for (const Face& face : faces_) centres_[0].push_back(centroid(face.corners));
        for (const VertexCell& cell : leaves.cells) centres_[0].push_back(cell.position);
        if (!moves.empty())
            for (const std::vector<glm::dvec3>& pose : poses)
                centres_.push_back(centroids(faces_, scene, pose));
        order_.resize(centres_[0].size());
        std::iota(order_.begin(), order_.end(), 0u);
    }

    // Backs under a child of the root of their own: sides of one sheet in one cluster would hide
    // that it is flat.
    void build() {
        if (order_.empty()) return;
        std::uint32_t *const first = order_.data(), *const last = first + order_.size();
        std::uint32_t* const backs =
            std::stable_partition(first, last, [&](std::uint32_t f) { return !is_back(f); });
        if (backs == last) {
            part(first, last, no_index);
            return;
        }
        const std::uint32_t root = open(no_index);
        part(first, backs, root);
        part(backs, last, root);
        close(root);
    }

private:
    using Iterator = std::uint32_t*;

    bool is_cell(std::uint32_t f) const { return f >= faces_.size(); }
    const VertexCell& cell(std::uint32_t f) const { return leaves_.cells[f - faces_.size()]; }
    bool is_back(std::uint32_t f) const { return is_cell(f) ? cell(f).back : faces_[f].back; }

    std::uint32_t open(std::uint32_t parent) {
        const auto i = static_cast<std::uint32_t>(out_.ends.size());
        out_.positions.emplace_back(0.0);
        out_.normals.emplace_back(0.0);
        out_.areas.push_back(0.0);
        out_.radii.push_back(0.0);
        out_.corners.push_back({glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)});
        out_.parents.push_back(parent);
        out_.ends.push_back(i + 1);
        out_.levels.push_back(parent == no_index ? 0 : out_.levels[parent] + 1);
        out_.triangles.push_back(no_index);
        out_.backs.push_back(0);
        if (!leaves_.cells.empty())
            out_.first_patches.push_back(static_cast<std::uint32_t>(out_.vertex_patches.size()));
        return i;
    }

    void close(std::uint32_t i) { out_.ends[i] = static_cast<std::uint32_t>(out_.ends.size()); }

    void leaf(const VertexCell& cell, std::uint32_t parent) {
        const std::uint32_t i = open(parent);
        out_.positions[i] = cell.position;
        out_.normals[i] = cell.normal;
        out_.areas[i] = cell.area;
        out_.triangles[i] = leaves_.vertex_patches[cell.first_patch].triangle;
        out_.backs[i] = cell.back ? 1 : 0;
        out_.vertex_patches.insert(out_.vertex_patches.end(),
                                   leaves_.vertex_patches.begin() + cell.first_patch,
                                   leaves_.vertex_patches.begin() + cell.end_patch);
        ++out_.leaves;
    }

    // Two children of one halving, or four of two.
    void patch(const Face& face, const Corners& corners, double area, int halvings_left,
               std::uint32_t parent) {
        const std::uint32_t i = open(parent);
        out_.corners[i] = corners;
        out_.positions[i] = centroid(corners);
        out_.normals[i] = face.normal;
        out_.areas[i] = area;
        out_.triangles[i] = face.triangle;
        out_.backs[i] = face.back ? 1 : 0;
        if (halvings_left == 0) {
            ++out_.leaves;
        } else {
            for (const Corners& half : halve(corners)) {
                if (halvings_left % 2 == 1) {
                    patch(face, half, area / 2, halvings_left - 1, i);
                    continue;
                }
                for (const Corners& quarter : halve(half))
                    patch(face, quarter, area / 4, halvings_left - 2, i);
            }
        }
        close(i);
    }

    bool moves(std::uint32_t face) const {
        return !moves_.empty() && moves_[faces_[face].triangle] != 0;
    }

    // At the median of the longest axis of the box of centroids, of those of all poses if they
    // move; by number where they are equal, so halves are halves for identical ones too.
    Iterator split(Iterator first, Iterator last) {
        const std::vector<glm::dvec3>* centres = nullptr;
        int axis = 0;
        double longest = -1.0;
        for (std::size_t pose = 0; pose < (moves(*first) ? centres_.size() : 1); ++pose) {
            const std::vector<glm::dvec3>& at = centres_[pose];
            glm::dvec3 low = at[*first], high = low;
            for (Iterator f = first; f != last; ++f) {
                low = glm::min(low, at[*f]);
                high = glm::max(high, at[*f]);
            }
            const glm::dvec3 size = high - low;
            const int k =
                size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
            if (size[k] <= longest) continue;
            longest = size[k];
            axis = k;
            centres = &at;
        }
        const Iterator middle = first + (last - first + 1) / 2;
        std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
            const double at_a = (*centres)[a][axis], at_b = (*centres)[b][axis];
            return at_a != at_b ? at_a < at_b : a < b;
        });
        return middle;
    }

    // What stands still before what moves: a cluster of both would have to be linked anew whenever
    // one of its triangles moves.
    void part(Iterator first, Iterator last, std::uint32_t parent) {
        const Iterator moving =
            std::stable_partition(first, last, [&](std::uint32_t f) { return !moves(f); });
        if (moving == first || moving == last) return tree(first, last, parent);
        const std::uint32_t i = open(parent);
        tree(first, moving, i);
        tree(moving, last, i);
        close(i);
    }

    void tree(Iterator first, Iterator last, std::uint32_t parent) {
        if (last - first == 1) {
            if (is_cell(*first)) return leaf(cell(*first), parent);
            const Face& face = faces_[*first];
            patch(face, face.corners, face.area, halvings(face.area, out_.max_area), parent);
            return;
        }
        const std::uint32_t i = open(parent);
        const Iterator middle = split(first, last);
        for (const auto& half : {std::pair(first, middle), std::pair(middle, last)}) {
            if (half.second - half.first == 1) {
                tree(half.first, half.second, i);
                continue;
            }
            const Iterator quarter = split(half.first, half.second);
            tree(half.first, quarter, i);
            tree(quarter, half.second, i);
        }
        close(i);
    }

    ElementTree& out_;
    const VertexCells& leaves_;
    const std::vector<Face>& faces_;
    const std::vector<std::uint8_t>& moves_;        // [triangles]; empty: none does
    std::vector<std::vector<glm::dvec3>> centres_;  // [1 + poses][faces, then cells]; the scene's
                                                    // own first
    std::vector<std::uint32_t> order_;              // of faces and cells
};

// From a position to the farthest point of a leaf or a patch.
double reach(const ElementTree& tree, std::size_t i, const glm::dvec3& position) {
    double square = 0.0;
    if (tree.is_patch(i))
        for (const glm::dvec3& corner : tree.corners[i]) {
            const glm::dvec3 way = corner - position;
            square = std::max(square, glm::dot(way, way));
        }
    if (tree.is_vertex(i))
        for (std::uint32_t k = tree.first_patches[i]; k < tree.first_patches[i + 1]; ++k)
            square = std::max(square, square_reach(tree.vertex_patches[k], position));
    return std::sqrt(square);
}

// Area and position of clusters: children come after their parents.
void gather(ElementTree& tree) {
    for (std::size_t i = tree.count(); i-- > 0;) {
        const std::uint32_t parent = tree.parents[i];
        if (!tree.is_leaf(i) && !tree.is_patch(i)) tree.positions[i] /= tree.areas[i];
        if (parent == no_index || tree.is_patch(parent)) continue;
        tree.areas[parent] += tree.areas[i];
        tree.positions[parent] += tree.areas[i] * tree.positions[i];
    }
}

void measure_radii(ElementTree& tree) {
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i) && !tree.is_patch(i)) continue;
        tree.radii[i] = reach(tree, i, tree.positions[i]);
        // Parts of a triangle lie within it, so clusters ask whole triangles alone.
        std::uint32_t above = tree.parents[i];
        if (above != no_index && tree.is_patch(above)) continue;
        for (; above != no_index; above = tree.parents[above])
            tree.radii[above] = std::max(tree.radii[above], reach(tree, i, tree.positions[above]));
    }
}

void find_flat_clusters(ElementTree& tree) {
    const double least = std::cos(flatness);
    for (std::size_t i = tree.count(); i-- > 0;) {
        if (tree.is_leaf(i) || tree.is_patch(i) || tree.moves(i)) continue;
        glm::dvec3 sum(0.0);
        for (std::size_t c = i + 1; c < tree.ends[i]; c = tree.ends[c])
            sum += tree.areas[c] * tree.normals[c];
        if (!(glm::length(sum) > 0.0)) continue;
        const glm::dvec3 normal = glm::normalize(sum);
        bool flat = true;
        for (std::size_t c = i + 1; c < tree.ends[i]; c = tree.ends[c]) {
            const double height = glm::dot(normal, tree.positions[c] - tree.positions[i]);
            flat = flat && glm::dot(normal, tree.normals[c]) >= least &&
                   std::abs(height) <= flatness * tree.radii[i];
        }
        if (flat) tree.normals[i] = normal;
    }
}

// Joined cells have about this share of the area that they may have.
constexpr double joined_share = 0.7;
constexpr double enough = 0.6;  // leaves, of the requested ones
constexpr int most_tries = 3;

// Faces, and leaves at vertices unless there would be fewer leaves than requested; joined ones
// where there would be more.
VertexCells mixed_leaves(const Scene& scene, const Faces& faces, double max_area,
                         const ElementOptions& options) {
    if (!options.vertices) return {{}, {}, faces.faces};
    const VertexCellMaker maker(scene, faces);
    CellPlan plan = maker.plan(max_area);
    if (options.max_area > 0.0) return maker(plan);
    const auto requested = static_cast<double>(options.requested);
    if (plan.leaves < requested) return {{}, {}, faces.faces};
    if (plan.leaves == requested) return maker(plan);
    double area = plan.area;
    if (plan.count == 0.0)  // pieces that have none may have joined ones
        for (const Face& face : faces.faces) area += face.area <= max_area ? face.area : 0.0;
    const double coarse = plan.leaves - plan.count;
    double joined = area / (joined_share * std::max(requested - coarse, 0.25 * requested));
    for (int tries = 0; tries < most_tries; ++tries) {
        plan = maker.plan(max_area, std::min(joined, max_area));
        if (plan.leaves >= enough * requested) break;
        joined *= plan.leaves / requested;  // more pieces have cells than had some before
    }
    return maker(plan);
}

void mark_moving(const std::vector<std::uint8_t>& moves, ElementTree& tree) {
    if (moves.empty()) return;
    tree.moving.assign(tree.count(), 0);
    for (std::size_t i = tree.count(); i-- > 0;) {
        if (tree.is_patch(i)) tree.moving[i] = moves[tree.triangles[i]];
        if (tree.parents[i] != no_index) tree.moving[tree.parents[i]] |= tree.moving[i];
    }
}

}  // namespace

ElementTree make_elements(const Scene& scene, const ElementOptions& options,
                          const VertexPoses& poses) {
    check(options);
    const Faces faces = make_faces(scene, options.backs);
    const std::vector<std::uint8_t> moves = moving_triangles(scene, poses);
    ElementTree out;
    out.skipped_triangles = faces.skipped;
    out.skipped_area = faces.skipped_area;
    out.max_area = leaf_area(faces.faces, options);
    const double leaves = count_leaves(faces.faces, out.max_area);
    if (!(leaves <= most_leaves))
        throw Error("make_elements: leaves of " + std::to_string(out.max_area) + " m^2 are " +
                    std::to_string(leaves) +
                    ", at most 67108864 are possible; max_area, min_area "
                    "or wished must be coarser");
    ElementOptions cells = options;
    cells.vertices = options.vertices && moves.empty();
    const VertexCells mixed = mixed_leaves(scene, faces, out.max_area, cells);
    Builder(mixed, scene, poses, moves, out).build();
    if (!mixed.cells.empty())
        out.first_patches.push_back(static_cast<std::uint32_t>(out.vertex_patches.size()));
    mark_moving(moves, out);
    gather(out);
    measure_radii(out);
    find_flat_clusters(out);
    return out;
}

}  // namespace clgi
