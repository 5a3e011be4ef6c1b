// The buffers of a solver as one table, a row per buffer. The estimate, the check of the budget,
// the allocation and the advice in errors all follow from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace clgi {

class Recorder;

// What a render will need, before any of it is allocated.
struct Estimate {
    std::size_t bytes = 0;      // of all buffers without the scene: exact, of antiradiance about
    double milliseconds = 0.0;  // a rough guess from clock, units and lanes of the device
};

class CLGI_API BufferTable {
public:
    // owner: the first words of error messages, such as "second-order".
    explicit BufferTable(std::string owner);

    // A buffer of this many bytes, at least 16. name: its plural, for messages; lower: the options
    // to lower if it does not fit.
    void add(cl::Buffer& buffer, const char* name, const char* lower, std::size_t bytes);

    // A buffer of four words, all with this value after allocate().
    void add_word(cl::Buffer& buffer, const char* name, std::uint32_t value);

    std::size_t bytes() const;

    // Throws DeviceError if a row is larger than the device allows for one buffer, or their sum
    // larger than the budget. budget 0: the device's memory less `taken` bytes.
    void check(const cl::Device& device, std::size_t budget, std::size_t taken) const;

    // Allocates every row that has no buffer of exactly this size yet, and enqueues the writes of
    // the words, without waiting. Throws DeviceError when the device has no room.
    void allocate(Recorder& record) const;

private:
    struct Row {
        cl::Buffer* buffer;
        const char* name;
        const char* lower;
        std::size_t bytes;
        bool is_word;
        std::uint32_t value;
    };
    std::string owner_;
    std::vector<Row> rows_;
};

}  // namespace clgi
