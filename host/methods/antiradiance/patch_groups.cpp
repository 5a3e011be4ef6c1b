// SPDX-License-Identifier: MIT
#include "methods/antiradiance/patch_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/on_threads.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

// What is no part of a group yet, with its place among the vertex patches of the tree.
struct VertexPatch {
    glm::dvec3 middle;
    std::uint32_t place;
};
using Iterator = std::vector<VertexPatch>::iterator;

constexpr std::ptrdiff_t few = 4;  // vertex patches that are a group without groups

// At the median of the longest axis of the box of middles.
Iterator split(Iterator first, Iterator last) {
    glm::dvec3 low = first->middle, high = low;
    for (Iterator one = first; one != last; ++one) {
        low = glm::min(low, one->middle);
        high = glm::max(high, one->middle);
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const Iterator middle = first + (last - first + 1) / 2;
    std::nth_element(first, middle, last, [&](const VertexPatch& a, const VertexPatch& b) {
        return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                : a.place < b.place;
    });
    return middle;
}

// Makes the groups of one leaf after the other.
class Grouping {
public:
    // order: [vertex patches of the tree] written for the leaves that are asked for.
    Grouping(const ElementTree& tree, std::vector<std::uint32_t>& order,
             std::vector<PatchGroup>& groups)
        : tree_(tree), order_(order), groups_(groups) {}

    void operator()(std::size_t leaf) {
        begin_ = groups_.size();
        place_ = tree_.first_patches[leaf];
        areas_.clear();
        vertex_patches_.clear();
        for (std::uint32_t k = place_; k < tree_.first_patches[leaf + 1]; ++k)
            vertex_patches_.push_back({centroid(tree_.vertex_patches[k]), k});
        if (!vertex_patches_.empty()) group(vertex_patches_.begin(), vertex_patches_.end());
    }

private:
    void group(Iterator first, Iterator last) {
        const std::size_t place = groups_.size();
        groups_.emplace_back();
        areas_.push_back(0.0);
        if (last - first <= few) {
            gather(first, last, place);
        } else {
            const Iterator middle = split(first, last);
            for (const auto& [from, to] : {std::pair(first, middle), std::pair(middle, last)}) {
                const Iterator quarter = split(from, to);
                group(from, quarter);
                group(quarter, to);
            }
            measure(place);
        }
        groups_[place].next = static_cast<std::uint32_t>(groups_.size() - begin_);
    }

    void gather(Iterator first, Iterator last, std::size_t place) {
        PatchGroup& out = groups_[place];
        double& area = areas_[place - begin_];
        out.first = place_;
        for (Iterator one = first; one != last; ++one) {
            const glm::dvec3 turned = vector_area(tree_.vertex_patches[one->place]);
            area += glm::length(turned);
            out.middle += glm::length(turned) * one->middle;
            out.vector_area += turned;
            order_[place_++] = one->place;
        }
        out.end = place_;
        out.middle /= area;
        for (Iterator one = first; one != last; ++one)
            out.square_radius = std::max(
                out.square_radius, square_reach(tree_.vertex_patches[one->place], out.middle));
    }

    // From its parts, which follow it.
    void measure(std::size_t place) {
        PatchGroup& out = groups_[place];
        double& area = areas_[place - begin_];
        const auto each = [&](const auto& visit) {
            for (std::size_t k = place + 1; k < groups_.size(); k = begin_ + groups_[k].next)
                visit(groups_[k], areas_[k - begin_]);
        };
        each([&](const PatchGroup& part, double part_area) {
            area += part_area;
            out.middle += part_area * part.middle;
            out.vector_area += part.vector_area;
        });
        out.middle /= area;
        double radius = 0.0;
        each([&](const PatchGroup& part, double) {
            radius = std::max(
                radius, glm::distance(part.middle, out.middle) + std::sqrt(part.square_radius));
        });
        out.square_radius = radius * radius;
    }

    const ElementTree& tree_;
    std::vector<std::uint32_t>& order_;
    std::vector<PatchGroup>& groups_;
    std::size_t begin_ = 0;      // of the present leaf
    std::uint32_t place_ = 0;    // in order_
    std::vector<double> areas_;  // m^2, of its groups
    std::vector<VertexPatch> vertex_patches_;
};

}  // namespace

PatchGroups::PatchGroups(const ElementTree& tree, int threads) {
    if (tree.first_patches.empty()) return;
    const int used = thread_count(threads);
    std::vector<std::vector<PatchGroup>> parts(static_cast<std::size_t>(used));
    std::vector<std::size_t> counts(tree.count());
    vertex_patches_.resize(tree.vertex_patches.size());
    // Elements from share to share of the vertex patches.
    const auto begin = [&](int thread) {
        const std::size_t vertex_patch =
            tree.vertex_patches.size() * static_cast<std::size_t>(thread) / parts.size();
        const auto found =
            std::lower_bound(tree.first_patches.begin(), tree.first_patches.end(), vertex_patch);
        return thread == used ? tree.count()
                              : static_cast<std::size_t>(found - tree.first_patches.begin());
    };
    on_threads(used, [&](int thread) {
        std::vector<PatchGroup>& groups = parts[static_cast<std::size_t>(thread)];
        Grouping make(tree, vertex_patches_, groups);
        for (std::size_t i = begin(thread); i < begin(thread + 1); ++i) {
            const std::size_t before = groups.size();
            make(i);
            counts[i] = groups.size() - before;
        }
    });
    std::size_t all = 0;
    for (const std::vector<PatchGroup>& part : parts) all += part.size();
    groups_.reserve(all);
    for (std::vector<PatchGroup>& part : parts) {
        groups_.insert(groups_.end(), part.begin(), part.end());
        part = {};
    }
    first_.push_back(0);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        first_.push_back(first_.back() + counts[i]);
        flatness_.push_back(
            counts[i] > 0 ? glm::length(groups_[first_[i]].vector_area) / tree.areas[i] : 1.0);
    }
}

}  // namespace clgi
