// Numbers drawn from the bytes of an input: the same bytes give the same numbers everywhere, and
// where bytes end all further numbers are the first of their range.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace clgi::fuzz {

class Choices {
public:
    Choices(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

    int integer(int low, int high) {  // both included
        const auto span = static_cast<unsigned>(high - low) + 1u;
        const unsigned drawn = span <= 256u ? byte() : byte() << 8 | byte();
        return low + static_cast<int>(drawn % span);
    }
    bool coin() { return (byte() & 1u) != 0; }
    bool one_in(int count) { return integer(0, count - 1) == count - 1; }
    double between(double low, double high) {
        const unsigned drawn = byte() << 8 | byte();
        return low + (high - low) * drawn / 65535.0;
    }
    double power_of_two(int low, int high) { return std::ldexp(1.0, integer(low, high)); }
    template <typename T>
    T any_of(std::initializer_list<T> values) {
        return values.begin()[integer(0, static_cast<int>(values.size()) - 1)];
    }
    // An option: in its range, but for one draw in 32 that takes one of `odd`.
    template <typename T>
    T option(T usual, std::initializer_list<T> odd) {
        return one_in(32) ? any_of(odd) : usual;
    }

private:
    unsigned byte() { return next_ == end_ ? 0u : *next_++; }

    const std::uint8_t* next_;
    const std::uint8_t* end_;
};

}  // namespace clgi::fuzz
