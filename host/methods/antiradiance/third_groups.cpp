// SPDX-License-Identifier: MIT
#include "methods/antiradiance/third_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "methods/antiradiance/on_threads.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

// What is no part of a group yet, with its place among the thirds of the tree.
struct Third {
    glm::dvec3 middle;
    std::uint32_t place;
};
using Iterator = std::vector<Third>::iterator;

constexpr std::ptrdiff_t few = 4;  // thirds that are a group without groups

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
    std::nth_element(first, middle, last, [&](const Third& a, const Third& b) {
        return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                                : a.place < b.place;
    });
    return middle;
}

// Makes the groups of one leaf after the other.
class Grouping {
public:
    // order: [thirds of the tree] written for the leaves that are asked for.
    Grouping(const ElementTree& tree, std::vector<std::uint32_t>& order,
             std::vector<ThirdGroup>& groups)
        : tree_(tree), order_(order), groups_(groups) {}

    void operator()(std::size_t leaf) {
        begin_ = groups_.size();
        place_ = tree_.first_thirds[leaf];
        areas_.clear();
        thirds_.clear();
        for (std::uint32_t k = place_; k < tree_.first_thirds[leaf + 1]; ++k)
            thirds_.push_back({centroid(tree_.thirds[k]), k});
        if (!thirds_.empty()) group(thirds_.begin(), thirds_.end());
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
        ThirdGroup& out = groups_[place];
        double& area = areas_[place - begin_];
        out.first = place_;
        for (Iterator one = first; one != last; ++one) {
            const glm::dvec3 turned = vector_area(tree_.thirds[one->place]);
            area += glm::length(turned);
            out.middle += glm::length(turned) * one->middle;
            out.vector_area += turned;
            order_[place_++] = one->place;
        }
        out.end = place_;
        out.middle /= area;
        for (Iterator one = first; one != last; ++one)
            out.square_radius =
                std::max(out.square_radius, square_reach(tree_.thirds[one->place], out.middle));
    }

    // From its parts, which follow it.
    void measure(std::size_t place) {
        ThirdGroup& out = groups_[place];
        double& area = areas_[place - begin_];
        const auto each = [&](const auto& visit) {
            for (std::size_t k = place + 1; k < groups_.size(); k = begin_ + groups_[k].next)
                visit(groups_[k], areas_[k - begin_]);
        };
        each([&](const ThirdGroup& part, double part_area) {
            area += part_area;
            out.middle += part_area * part.middle;
            out.vector_area += part.vector_area;
        });
        out.middle /= area;
        double radius = 0.0;
        each([&](const ThirdGroup& part, double) {
            radius = std::max(
                radius, glm::distance(part.middle, out.middle) + std::sqrt(part.square_radius));
        });
        out.square_radius = radius * radius;
    }

    const ElementTree& tree_;
    std::vector<std::uint32_t>& order_;
    std::vector<ThirdGroup>& groups_;
    std::size_t begin_ = 0;      // of the present leaf
    std::uint32_t place_ = 0;    // in order_
    std::vector<double> areas_;  // m^2, of its groups
    std::vector<Third> thirds_;
};

}  // namespace

ThirdGroups::ThirdGroups(const ElementTree& tree, int threads) {
    if (tree.first_thirds.empty()) return;
    const int used = thread_count(threads);
    std::vector<std::vector<ThirdGroup>> parts(static_cast<std::size_t>(used));
    std::vector<std::size_t> counts(tree.count());
    thirds_.resize(tree.thirds.size());
    // Elements from share to share of the thirds.
    const auto begin = [&](int thread) {
        const std::size_t third =
            tree.thirds.size() * static_cast<std::size_t>(thread) / parts.size();
        const auto found =
            std::lower_bound(tree.first_thirds.begin(), tree.first_thirds.end(), third);
        return thread == used ? tree.count()
                              : static_cast<std::size_t>(found - tree.first_thirds.begin());
    };
    on_threads(used, [&](int thread) {
        std::vector<ThirdGroup>& groups = parts[static_cast<std::size_t>(thread)];
        Grouping make(tree, thirds_, groups);
        for (std::size_t i = begin(thread); i < begin(thread + 1); ++i) {
            const std::size_t before = groups.size();
            make(i);
            counts[i] = groups.size() - before;
        }
    });
    std::size_t all = 0;
    for (const std::vector<ThirdGroup>& part : parts) all += part.size();
    groups_.reserve(all);
    for (std::vector<ThirdGroup>& part : parts) {
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
