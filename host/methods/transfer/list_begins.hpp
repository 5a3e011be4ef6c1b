// Where lists that follow each other begin.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace clgi {

// [lists + 1], from the length of each. Throws Error for more than 2^32 - 1 numbers in all.
inline std::vector<std::uint32_t> list_begins(const char* owner,
                                              const std::vector<std::uint32_t>& lengths) {
    std::uint64_t all = 0;
    for (const std::uint32_t length : lengths) all += length;
    if (all > std::numeric_limits<std::uint32_t>::max())
        throw Error(std::string(owner) + ": the lists have " + std::to_string(all) +
                    " numbers, at most 4294967295 possible");
    std::vector<std::uint32_t> out{0};
    out.reserve(lengths.size() + 1);
    for (const std::uint32_t length : lengths) out.push_back(out.back() + length);
    return out;
}

}  // namespace clgi
