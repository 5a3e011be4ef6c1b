// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/error.hpp>
#include <cstdio>
#include <map>

#include "core/opencl/error_text.hpp"

namespace clgi {
namespace {

constexpr std::size_t least = 16;  // bytes: no buffer is empty

std::string megabytes(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
    return text;
}

}  // namespace

BufferTable::BufferTable(std::string owner) : owner_(std::move(owner)) {}

void BufferTable::add(cl::Buffer& buffer, const char* name, const char* lower, std::size_t bytes) {
    rows_.push_back({&buffer, name, lower, std::max(bytes, least), false, 0});
}

void BufferTable::add_word(cl::Buffer& buffer, const char* name, std::uint32_t value) {
    rows_.push_back({&buffer, name, "nothing", least, true, value});
}

std::size_t BufferTable::bytes() const {
    std::size_t out = 0;
    for (const Row& row : rows_) out += row.bytes;
    return out;
}

void BufferTable::check(const cl::Device& device, std::size_t budget, std::size_t taken) const {
    const std::size_t most = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    std::map<std::string, std::size_t> by_option;
    for (const Row& row : rows_) {
        if (row.bytes > most)
            throw DeviceError(owner_ + ": " + row.name + " need " + megabytes(row.bytes) +
                              " in one buffer, the device allows " + megabytes(most) + "; lower " +
                              row.lower);
        by_option[row.lower] += row.bytes;
    }
    const std::size_t device_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    const std::size_t beside = device_bytes - std::min(taken, device_bytes);
    const std::size_t room = budget > 0 ? budget : beside;
    if (bytes() <= room) return;
    const auto largest =
        std::max_element(by_option.begin(), by_option.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    throw DeviceError(owner_ + ": " + megabytes(bytes()) + " are needed, " +
                      (budget > 0 ? "memory_budget allows " : "the device has beside the scene ") +
                      megabytes(room) + "; " + megabytes(largest->second) + " of it depend on " +
                      largest->first + ", to be lowered");
}

void BufferTable::allocate(Recorder& record) const {
    const cl::Context context = record.queue().getInfo<CL_QUEUE_CONTEXT>();
    for (const Row& row : rows_) {
        cl::Buffer& buffer = *row.buffer;
        try {
            if (!buffer() || buffer.getInfo<CL_MEM_SIZE>() != row.bytes)
                buffer = cl::Buffer(context, CL_MEM_READ_WRITE, row.bytes);
        } catch (const cl::Error& error) {
            throw DeviceError(owner_ + ": no room for a buffer of " + megabytes(row.bytes) +
                              ", of " + megabytes(bytes()) + " in all: " + error_text(error.err()));
        }
        if (row.is_word) record.fill(buffer, row.value);
    }
}

}  // namespace clgi
