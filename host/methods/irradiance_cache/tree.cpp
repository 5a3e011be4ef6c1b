// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/tree.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "core/on_threads.hpp"

namespace clgi {
namespace {

constexpr std::size_t most_in_leaf = 2;
constexpr int deepest = 20;
// A record is listed where it can stand in for a surface that faces a way: cosine with the axis.
// A surface whose main axis that is has a cosine of 0.577 at least.
constexpr float least_cosine = 0.1f;
constexpr float off_within = 1.7f;  // of half a leaf's side: that far off the plane is on it

// Of the six ways that a surface can face.
using Candidates = std::array<std::vector<std::uint32_t>, CACHE_WAYS>;

struct Leaf {
    glm::vec3 centre;
    float half_side;
    std::shared_ptr<const Candidates> candidates;
};

// Of a place in a cube around a centre.
std::uint32_t octant(const glm::vec3& p, const glm::vec3& centre) {
    return (p.x > centre.x ? 1u : 0u) | (p.y > centre.y ? 2u : 0u) | (p.z > centre.z ? 4u : 0u);
}

// From the centre of a cube to that of its octant.
glm::vec3 toward(std::uint32_t octant, float half) {
    return {(octant & 1u) ? half : -half, (octant & 2u) ? half : -half,
            (octant & 4u) ? half : -half};
}

// As cache_way (kernels/cache/lookup.clh).
std::uint32_t way_of(const glm::vec3& n) {
    const glm::vec3 a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return static_cast<std::uint32_t>(2 * axis + (n[axis] < 0.0f ? 1 : 0));
}

class TreeMaker {
public:
    TreeMaker(const std::vector<CacheRecord>& records, RecordTree& out)
        : records_(records), out_(out) {}

    Candidates all() const {
        Candidates out;
        for (std::uint32_t i = 0; i < records_.size(); ++i)
            for (std::uint32_t way = 0; way < CACHE_WAYS; ++way)
                if (along(records_[i].normal, way) > least_cosine) out[way].push_back(i);
        return out;
    }

    // candidates: those that some leaf within may list.
    std::uint32_t node(const glm::vec3& centre, float half_side,
                       const std::vector<std::uint32_t>& inside,
                       const std::shared_ptr<const Candidates>& candidates, int depth) {
        if (inside.size() <= most_in_leaf || depth == deepest) {
            leaves_.push_back({centre, half_side, candidates});
            return CACHE_LEAF | static_cast<std::uint32_t>(leaves_.size() - 1);
        }
        const auto place = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes.resize(place + 8);
        const auto fewer = std::make_shared<Candidates>();
        for (std::size_t way = 0; way < CACHE_WAYS; ++way)
            (*fewer)[way] = nearest(centre, half_side, (*candidates)[way]);
        for (std::uint32_t child = 0; child < 8; ++child) {
            std::vector<std::uint32_t> part;
            for (const std::uint32_t i : inside)
                if (octant(records_[i].position, centre) == child) part.push_back(i);
            const float half = 0.5f * half_side;
            const std::uint32_t made =
                node(centre + toward(child, half), half, part, fewer, depth + 1);
            out_.nodes[place + child] = made;
        }
        return place;
    }

    void list_all() {
        out_.lists.resize(leaves_.size() * CACHE_WAYS * CACHE_LISTED);
        constexpr std::size_t at_once = 16;
        std::atomic<std::size_t> next = 0;
        on_threads(thread_count(0), [&](int) {
            while (true) {
                const std::size_t first = next.fetch_add(at_once);
                if (first >= leaves_.size()) return;
                for (std::size_t k = first; k < std::min(first + at_once, leaves_.size()); ++k)
                    list(k);
            }
        });
    }

private:
    static float along(const glm::vec3& normal, std::uint32_t way) {
        const float value = normal[static_cast<int>(way / 2)];
        return way % 2 == 0 ? value : -value;
    }

    // Squares of distances at which a record counts: farther off its own plane counts as farther
    // away.
    static float counted(float square, float off) { return square + 16.0f * off * off; }

    // Without those that enough others are nearer than, wherever in the cube a leaf lies.
    std::vector<std::uint32_t> nearest(const glm::vec3& centre, float half_side,
                                       const std::vector<std::uint32_t>& candidates) {
        if (candidates.size() <= CACHE_LISTED) return candidates;
        most_.clear();
        least_.clear();
        for (const std::uint32_t i : candidates) {
            float off = 0.0f, reach = 0.0f, near = 0.0f, far = 0.0f;
            for (int axis = 0; axis < 3; ++axis) {
                const float d = centre[axis] - records_[i].position[axis],
                            n = records_[i].normal[axis], away = std::abs(d),
                            nearer = std::max(away - half_side, 0.0f), farther = away + half_side;
                off += d * n;
                reach += half_side * std::abs(n);
                near += nearer * nearer;
                far += farther * farther;
            }
            off = std::abs(off);
            most_.push_back(counted(far, off + reach));
            least_.push_back(counted(near, std::max(off - reach - off_within * half_side, 0.0f)));
        }
        std::nth_element(most_.begin(), most_.begin() + CACHE_LISTED - 1, most_.end());
        const float enough = most_[CACHE_LISTED - 1];
        std::vector<std::uint32_t> out;
        for (std::size_t k = 0; k < candidates.size(); ++k)
            if (least_[k] <= enough) out.push_back(candidates[k]);
        return out;
    }

    // Of one leaf: the nearest, each put in its place among those before.
    void list(std::size_t number) {
        const Leaf& leaf = leaves_[number];
        std::uint32_t* to = &out_.lists[number * CACHE_WAYS * CACHE_LISTED];
        const float within = off_within * leaf.half_side;
        for (const std::vector<std::uint32_t>& some : *leaf.candidates) {
            float near[CACHE_LISTED];
            std::fill(to, to + CACHE_LISTED, static_cast<std::uint32_t>(CACHE_NONE));
            std::fill(near, near + CACHE_LISTED, std::numeric_limits<float>::infinity());
            for (const std::uint32_t i : some) {
                const glm::vec3 d = leaf.centre - records_[i].position;
                const float off = std::abs(glm::dot(d, records_[i].normal));
                const float found = counted(glm::dot(d, d), std::max(off - within, 0.0f));
                if (!(found < near[CACHE_LISTED - 1])) continue;
                int place = CACHE_LISTED - 1;
                for (; place > 0 && found < near[place - 1]; --place) {
                    near[place] = near[place - 1];
                    to[place] = to[place - 1];
                }
                near[place] = found;
                to[place] = i;
            }
            to += CACHE_LISTED;
        }
    }

    const std::vector<CacheRecord>& records_;
    RecordTree& out_;
    std::vector<Leaf> leaves_;
    std::vector<float> most_, least_;  // of the candidates of a node
};

}  // namespace

RecordTree make_tree(const std::vector<CacheRecord>& records) {
    RecordTree out;
    std::vector<std::uint32_t> all;
    glm::vec3 low(0.0f), high(0.0f);
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        const glm::vec3& p = records[i].position;
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
        all.push_back(i);
    }
    out.centre = 0.5f * (low + high);
    const glm::vec3 half = 0.5f * (high - low);
    out.half_side = std::max({half.x, half.y, half.z, 1e-6f});
    out.nodes.push_back(0);
    TreeMaker maker(records, out);
    const std::uint32_t root =
        maker.node(out.centre, out.half_side, all, std::make_shared<Candidates>(maker.all()), 0);
    out.nodes[0] = root;
    maker.list_all();
    return out;
}

const std::uint32_t* listed(const RecordTree& tree, const CacheRecord& place) {
    glm::vec3 centre = tree.centre;
    float half = tree.half_side;
    std::uint32_t node = tree.nodes[0];
    while (!(node & CACHE_LEAF)) {
        const std::uint32_t child = octant(place.position, centre);
        half *= 0.5f;
        centre += toward(child, half);
        node = tree.nodes[node + child];
    }
    const std::size_t list = std::size_t{node & ~CACHE_LEAF} * CACHE_WAYS + way_of(place.normal);
    return &tree.lists[list * CACHE_LISTED];
}

}  // namespace clgi
