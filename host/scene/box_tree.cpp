// SPDX-License-Identifier: MIT
#include "scene/box_tree.hpp"

#include <algorithm>

namespace clgi {
namespace {

// Runs are halved below so many levels: a tree by areas may be as deep as it has clusters, and
// walks keep lists of what they have not looked at (NODE_STACK).
constexpr std::size_t levels_by_area = 12;
constexpr std::size_t levels_by_halves = 7;  // of 2^26 clusters, of 2^32 triangles
static_assert(std::size_t{NODE_STACK} >=
              (levels_by_area + levels_by_halves) * (NODE_BOXES - 1) + 1);

struct Extent {
    glm::vec3 low, high;
};

Extent around(const Extent& a, const Extent& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

float half_area(const Extent& of) {
    const glm::vec3 d = of.high - of.low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Clusters first .. last - 1.
struct ClusterRun {
    std::size_t first, last;
    Extent extent;
    std::size_t size() const { return last - first; }
};

class BoxTreeMaker {
public:
    explicit BoxTreeMaker(const std::vector<Cluster>& clusters) : cost_(clusters.size()) {
        for (const Cluster& cluster : clusters)
            extents_.push_back({glm::vec3(cluster.low), glm::vec3(cluster.high)});
    }

    BoxTree make() {
        out_.levels.push_back(0);
        std::vector<ClusterRun> level;
        if (!extents_.empty()) level.push_back(run(0, extents_.size()));
        while (!level.empty()) {
            std::vector<ClusterRun> below;
            const std::size_t after = out_.nodes.size() + level.size();
            for (const ClusterRun& of : level) add_node(of, after, below);
            out_.levels.push_back(static_cast<std::uint32_t>(after));
            level = std::move(below);
        }
        return std::move(out_);
    }

private:
    ClusterRun run(std::size_t first, std::size_t last) const {
        ClusterRun out{first, last, extents_[first]};
        for (std::size_t k = first + 1; k < last; ++k) out.extent = around(out.extent, extents_[k]);
        return out;
    }

    bool by_area() const { return out_.levels.size() <= levels_by_area; }

    // Where to cut a run of at least two, so that areas times clusters are least.
    std::size_t cut(const ClusterRun& of) {
        if (!by_area()) return of.first + of.size() / 2;
        Extent extent = extents_[of.last - 1];
        for (std::size_t k = of.last - 1; k > of.first; --k) {
            extent = around(extent, extents_[k]);
            cost_[k] = half_area(extent) * static_cast<float>(of.last - k);
        }
        std::size_t best = of.first + 1;
        extent = extents_[of.first];
        for (std::size_t k = of.first + 1; k < of.last; ++k) {
            cost_[k] += half_area(extent) * static_cast<float>(k - of.first);
            if (cost_[k] < cost_[best]) best = k;
            extent = around(extent, extents_[k]);
        }
        return best;
    }

    std::vector<ClusterRun> divided(const ClusterRun& of) {
        std::vector<ClusterRun> out{of};
        const auto larger = [&](const ClusterRun& a, const ClusterRun& b) {
            if ((a.size() > 1) != (b.size() > 1)) return a.size() > 1;
            return by_area() ? half_area(a.extent) > half_area(b.extent) : a.size() > b.size();
        };
        while (out.size() < NODE_BOXES) {
            const auto largest = std::min_element(out.begin(), out.end(), larger);
            if (largest->size() == 1) break;
            const std::size_t at = cut(*largest), last = largest->last;
            *largest = run(largest->first, at);
            out.push_back(run(at, last));
        }
        return out;
    }

    // after: where the nodes of `below` will be.
    void add_node(const ClusterRun& of, std::size_t after, std::vector<ClusterRun>& below) {
        constexpr float nowhere = 1e30f;
        BoxNode& node = out_.nodes.emplace_back();
        std::fill_n(node.low[0], 3 * NODE_BOXES, nowhere);
        std::fill_n(node.high[0], 3 * NODE_BOXES, -nowhere);
        std::fill_n(node.child, std::size_t{NODE_BOXES}, NODE_NONE);
        std::size_t place = 0;
        for (const ClusterRun& part : divided(of)) {
            for (int axis = 0; axis < 3; ++axis) {
                node.low[axis][place] = part.extent.low[axis];
                node.high[axis][place] = part.extent.high[axis];
            }
            if (part.size() == 1) {
                node.child[place] = NODE_CLUSTER | static_cast<std::uint32_t>(part.first);
            } else {
                node.child[place] = static_cast<std::uint32_t>(after + below.size());
                below.push_back(part);
            }
            ++place;
        }
    }

    std::vector<Extent> extents_;
    std::vector<float> cost_;  // of a cut before each cluster
    BoxTree out_;
};

}  // namespace

BoxTree make_box_tree(const std::vector<Cluster>& clusters) {
    return BoxTreeMaker(clusters).make();
}

}  // namespace clgi
