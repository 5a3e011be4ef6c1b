// The size of what buffers are made of.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace clgi {

constexpr std::size_t word = sizeof(std::uint32_t);  // bytes of an index, and of a float

}  // namespace clgi
