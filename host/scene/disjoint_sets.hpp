// Union-find over indices, whose sets are numbered as they first appear.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace clgi {

class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    // The smaller root stays.
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }

    // [count] the number of each index's set.
    std::vector<std::uint32_t> numbered() {
        std::vector<std::uint32_t> out(parent_.size());
        std::uint32_t next = 0;
        // A root is the smallest index of its set.
        for (std::uint32_t i = 0; i < parent_.size(); ++i)
            out[i] = parent_[i] == i ? next++ : out[find(i)];
        return out;
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace clgi
