// A hash of any data, to tell inputs apart.
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace clgi::lab {

// FNV-1a, 64 bits.
class Hash {
public:
    // Numbers and what is made of them alone, texts, and vectors with their length.
    template <typename... T>
    void add(const T&... values) {
        (put(values), ...);
    }
    std::string text() const { return fmt::format("{:016x}", state_); }

private:
    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes(&value, sizeof value);
    }
    template <typename T>
    void put(const std::vector<T>& values) {
        put(values.size());
        for (const T& value : values) put(value);
    }
    void put(const std::string& text) { bytes(text.data(), text.size()); }
    void bytes(const void* data, std::size_t size) {
        const auto* byte = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) state_ = (state_ ^ byte[i]) * 0x100000001b3u;
    }
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace clgi::lab
