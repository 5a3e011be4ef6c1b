// SPDX-License-Identifier: MIT
#include <clgi/advanced/visible_sets.hpp>

#include <clgi/error.hpp>
#include <string>

#include "methods/transfer/list_begins.hpp"

namespace clgi {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error("visible_sets: " + what); }

void check_rings(const VisibleSets& rings, std::uint32_t receivers, std::uint32_t triangle_count) {
    const auto& lists = rings.near_lists;
    if (lists.size() != receivers + std::size_t{1})
        refuse("rings have " + std::to_string(lists.size()) + " places, " +
               std::to_string(receivers + std::size_t{1}) + " needed");
    for (std::size_t r = 0; r < receivers; ++r)
        if (lists[r] > lists[r + 1])
            refuse("the ring of receiver " + std::to_string(r) + " ends before it begins");
    if (lists.back() > rings.near.size())
        refuse("rings end at " + std::to_string(lists.back()) + ", there are " +
               std::to_string(rings.near.size()) + " triangles in them");
    for (const std::uint32_t t : rings.near)
        if (t >= triangle_count)
            refuse("a ring names triangle " + std::to_string(t) + ", there are " +
                   std::to_string(triangle_count));
}

// f(receiver, triangle) for every bit, triangles ascending.
template <typename F>
void for_each_bit(const std::vector<std::uint32_t>& seen, std::uint32_t receivers,
                  std::uint32_t stride, std::size_t words, F&& f) {
    for (std::size_t word = 0; word < words; ++word)
        for (std::uint32_t r = 0; r < receivers; ++r) {
            const std::uint32_t bits = seen[word * stride + r];
            for (std::uint32_t bit = 0; bits >> bit; ++bit) {
                if (bits >> bit & 1) f(r, static_cast<std::uint32_t>(32 * word + bit));
                if (bit == 31) break;
            }
        }
}

}  // namespace

VisibleSets visible_sets(const std::vector<std::uint32_t>& seen, std::uint32_t receivers,
                         std::uint32_t stride, std::uint32_t triangle_count,
                         const VisibleSets& rings) {
    const std::size_t words = visible_words(triangle_count);
    if (stride < receivers)
        refuse("stride is " + std::to_string(stride) + ", at least " + std::to_string(receivers) +
               " needed");
    if (seen.size() != words * stride)
        refuse("seen holds " + std::to_string(seen.size()) + " words, " +
               std::to_string(words * stride) + " needed");
    std::vector<std::uint32_t> bits = seen;
    if (!rings.near_lists.empty() || !rings.near.empty()) {
        check_rings(rings, receivers, triangle_count);
        for (std::uint32_t r = 0; r < receivers; ++r)
            for (std::uint32_t i = rings.near_lists[r]; i < rings.near_lists[r + 1]; ++i)
                bits[rings.near[i] / 32 * std::size_t{stride} + r] |= 1u << (rings.near[i] % 32);
    }
    VisibleSets out;
    std::vector<std::uint32_t> counts(receivers);
    for_each_bit(bits, receivers, stride, words,
                 [&](std::uint32_t r, std::uint32_t) { ++counts[r]; });
    out.near_lists = list_begins("visible_sets", counts);
    out.near.resize(out.near_lists.back());
    std::vector<std::uint32_t> next = out.near_lists;
    for_each_bit(bits, receivers, stride, words,
                 [&](std::uint32_t r, std::uint32_t t) { out.near[next[r]++] = t; });
    return out;
}

}  // namespace clgi
