// VPLs of random planes, whose places mean nothing.
// SPDX-License-Identifier: MIT
#pragma once

#include "vpl_tools.hpp"

namespace clgi::test {

// Sites of 1 to 30 samples with random planes of everything.
struct VplHeap {
    std::vector<Site> sites;
    std::vector<float> samples;  // [GBUFFER_PLANES][sample_stride]
    SiteBuffers buffers;
    explicit VplHeap(int count, std::uint64_t seed = 5) {
        Random random(seed);
        cl_uint first = 0;
        for (int i = 0; i < count; ++i) {
            const auto many = static_cast<cl_uint>(i == 3 ? 1 : random.integer(1, 30));
            sites.push_back({first, many, static_cast<float>(random(0.01, 2.0)),
                             i % 3 == 1 ? cl_uint{SITE_BACK} : 0});
            first += many;
        }
        SiteBuffers& b = buffers;
        b.site_count = static_cast<std::uint32_t>(count);
        b.stride = padded(sites.size());
        b.sample_count = first;
        b.sample_stride = padded(first + sites.size()) + 16;
        samples.resize(GBUFFER_PLANES * b.sample_stride);
        for (float& value : samples) value = static_cast<float>(random(0.01, 1.0));
        b.sites = upload(sites);
        b.samples = upload(samples);
        b.planes = upload(std::vector<float>(SITE_PLANES * b.stride, nan));
        b.light = upload(std::vector<float>(SITE_LIGHT_PLANES * b.stride, nan));
        b.sent = upload(std::vector<float>(3 * b.sample_stride, 0.0f));
        b.sample_power = upload(std::vector<float>(3 * b.sample_stride, nan));
        b.site_power = upload(std::vector<float>(3 * b.stride, nan));
        b.sends = upload(std::vector<cl_uchar>(b.stride, 7));
        b.power = upload(std::vector<float>(b.stride, 3.0f));
        b.shot = upload(std::vector<float>(3 * b.stride, nan));
        b.chosen = upload(std::vector<cl_uint>(sites.size() + 1, 77));
    }
};

}  // namespace clgi::test
