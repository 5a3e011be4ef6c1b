// SPDX-License-Identifier: MIT
#include "core/kit/ranges.hpp"

#include <algorithm>
#include <clgi/device.hpp>

namespace clgi {
namespace {

constexpr double dispatch_seconds = 0.1;
constexpr std::size_t grain = 256;  // items: groups of a part are powers of two, none too small

std::size_t whole_grains(double items) {
    const auto grains = static_cast<std::size_t>(std::min(items, 1e15)) / grain;
    return std::max<std::size_t>(grains, 1) * grain;
}

}  // namespace

double pairs_per_second(const cl::Device& device) {
    constexpr double cycles = 16.0;  // of one compute unit for a packet and a light
    const double lanes = packet_width(device) > 1 ? packet_width(device) : 32.0;
    return 1e6 * std::max<cl_uint>(device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>(), 100) *
           device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>() * lanes / cycles;
}

std::vector<Share> deal(std::size_t count, double pairs, const std::vector<double>& speeds) {
    const double slowest = *std::min_element(speeds.begin(), speeds.end());
    std::size_t block = whole_grains(dispatch_seconds * slowest / std::max(pairs, 1.0));
    if (speeds.size() == 1 && block >= count) return {{0, Range(count)}};
    // Which points are worth anything may be known to the device alone: blocks are dealt in turn,
    // several to a worker, so that each has a share of those at the front.
    if (speeds.size() > 1)
        block = std::min(block, whole_grains(static_cast<double>(count) / (16.0 * speeds.size())));
    std::vector<Share> out;
    std::vector<double> busy(speeds.size(), 0.0);
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t items = std::min(block, count - first);
        std::size_t worker = 0;
        for (std::size_t w = 1; w < speeds.size(); ++w)
            if (busy[w] + items / speeds[w] < busy[worker] + items / speeds[worker]) worker = w;
        busy[worker] += items / speeds[worker];
        out.push_back({worker, Range(first, items)});
    }
    return out;
}

}  // namespace clgi
