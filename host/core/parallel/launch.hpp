// What passes over tiles check, and how they are launched.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/parallel.hpp>

#include "core/opencl/launch.hpp"

namespace clgi::parallel {

// Tile numbers times tile sizes stay within 32 bits.
constexpr std::uint32_t most_items = 1u << 31;

// The tiles of so many items, where the kernel can work on them.
inline std::size_t need_items(const PassKernel& pass, const Items& number) {
    if (number.most > most_items)
        throw Error(pass.name + ": " + std::to_string(number.most) + " items, at most " +
                    std::to_string(most_items) + " needed");
    if (number.count()) need(pass, "count", number.count, sizeof(std::uint32_t));
    return parallel_tiles(number.most);
}

template <typename T>
void need_of(const PassKernel& pass, const char* argument, const cl::Buffer& buffer,
             std::size_t count) {
    need(pass, argument, buffer, count * sizeof(T));
}

// A work-group for each tile.
inline Range groups(const PassKernel& pass, std::size_t tiles) { return tiles * group_size(pass); }

// Scratch of one T a work-item, and of `rows` of them.
template <typename T>
cl::LocalSpaceArg local_of(const PassKernel& pass, std::size_t rows = 1) {
    return cl::Local(rows * group_size(pass) * sizeof(T));
}

}  // namespace clgi::parallel
