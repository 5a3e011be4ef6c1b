// What VPLs send to texels, and what of it is left to another time, in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "math_modes.hpp"
#include "vpl_heap.hpp"

namespace clgi {
namespace {

using test::VplHeap;

using test::nan;
constexpr float infinity = std::numeric_limits<float>::infinity();

// A heap of VPLs in random light, of which some was sent before.
struct Sender {
    Sender(Math in, int count, std::uint64_t seed = 9) : math(in), heap(count) {
        const SiteBuffers& b = heap.buffers;
        test::Random random(seed);
        planes.resize(SITE_PLANES * b.stride);
        irradiance.resize(3 * b.sample_stride);
        light.assign(SITE_LIGHT_PLANES * b.stride, nan);  // none of it unshot
        sent.resize(3 * b.sample_stride);
        for (float& value : planes) value = static_cast<float>(random(0.1, 1));
        for (float& value : irradiance) value = static_cast<float>(random(0, 9));
        for (float& value : sent) value = static_cast<float>(random(0, 0.3));
        // Reflected light between none and twice the direct.
        for (std::size_t i = 0; i < heap.sites.size(); ++i)
            for (int c = 0; c < 3; ++c)
                received(i, c) = static_cast<float>(mean(i, c) * random(1.0, 3.0));
    }
    float& received(std::size_t i, int c) {
        return light[(SITE_RECEIVED + c) * heap.buffers.stride + i];
    }
    float& direct(std::size_t i, int c, std::uint32_t k) {
        return irradiance[c * heap.buffers.sample_stride + heap.sites[i].first_sample + k];
    }
    double mean(std::size_t i, int c) {
        double out = 0.0;
        for (std::uint32_t k = 0; k < heap.sites[i].sample_count; ++k) out += direct(i, c, k);
        return out / heap.sites[i].sample_count;
    }
    float before(std::size_t i, int c, std::uint32_t k) const {
        return sent[c * heap.buffers.sample_stride + heap.sites[i].first_sample + k];
    }
    double power(std::size_t i, int c) {
        return double{planes[(SITE_ALBEDO + c) * heap.buffers.stride + i]} * heap.sites[i].area *
               received(i, c);
    }
    // Powers of a site's samples.
    std::vector<double> powers(std::size_t i, int c) {
        const SiteBuffers& b = heap.buffers;
        const Site& site = heap.sites[i];
        std::vector<double> out;
        double sum = 0.0;
        for (std::uint32_t k = 0; k < site.sample_count; ++k) {
            const double albedo =
                heap.samples[(GBUFFER_BASE + c) * b.sample_stride + site.first_sample + k];
            out.push_back(albedo *
                          std::max(double{direct(i, c, k)} + received(i, c) - mean(i, c), 0.0));
            sum += out.back();
        }
        for (double& value : out)
            value = sum > 0.0 ? value / sum * power(i, c) : power(i, c) / site.sample_count;
        return out;
    }
    // How much the powers of a site's samples differ from what they sent.
    double change(std::size_t i) {
        double out = 0.0;
        for (int c = 0; c < 3; ++c) {
            const std::vector<double> now = powers(i, c);
            for (std::uint32_t k = 0; k < now.size(); ++k)
                out += std::abs(now[k] - before(i, c, k));
        }
        return out;
    }
    struct Sent {
        std::vector<float> sent, samples, sites;
        std::vector<cl_uchar> sends;
    };
    Sent run(float least) const {
        SiteBuffers b = heap.buffers;
        b.planes = test::upload(planes);
        b.light = test::upload(light);
        b.sent = test::upload(sent);
        test::vpl_passes(math).send(test::device().queue, b, test::upload(irradiance), least);
        return {test::download<float>(b.sent, sent.size()),
                test::download<float>(b.sample_power, sent.size()),
                test::download<float>(b.site_power, 3 * b.stride),
                test::download<cl_uchar>(b.sends, heap.sites.size())};
    }
    void expect_sent(const Sent& found, std::size_t i) {
        const SiteBuffers& b = heap.buffers;
        const Site& site = heap.sites[i];
        EXPECT_EQ(found.sends[i], 1) << i;
        for (int c = 0; c < 3; ++c) {
            const std::vector<double> wanted = powers(i, c);
            double sum = 0.0, condition = 0.0;
            for (std::uint32_t k = 0; k < site.sample_count; ++k) {
                const std::size_t at = c * b.sample_stride + site.first_sample + k;
                // Of what the direct light leaves of the reflected: sums of up to 30.
                const double error = 2e-5 * std::max(wanted[k], power(i, c) / site.sample_count);
                EXPECT_NEAR(found.sent[at], wanted[k], error) << "site " << i;
                EXPECT_NEAR(found.samples[at], wanted[k] - sent[at], error + 1e-7 * sent[at]) << i;
                sum += found.samples[at];
                condition += std::abs(found.samples[at]);
            }
            EXPECT_NEAR(found.sites[c * b.stride + i], sum, 31 * 0x1p-24 * condition) << i;
        }
    }
    void expect_kept(const Sent& found, std::size_t i) {
        const SiteBuffers& b = heap.buffers;
        EXPECT_EQ(found.sends[i], 0) << i;
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(found.sites[c * b.stride + i], 0.0f) << i;
            for (std::uint32_t k = 0; k < heap.sites[i].sample_count; ++k) {
                const std::size_t at = c * b.sample_stride + heap.sites[i].first_sample + k;
                EXPECT_EQ(found.sent[at], sent[at]) << i;
                EXPECT_EQ(found.samples[at], 0.0f) << i;
            }
        }
    }
    Math math;
    VplHeap heap;
    std::vector<float> planes, irradiance, light, sent;
};

CLGI_IN_BOTH_MATHS(Send);

// rho_k (E_k + I - E) over its sum, of each channel, less what was sent.
TEST_P(Send, SharesPowerByLightAndColourOfTheSamples) {
    Sender all(GetParam(), 60);
    for (int c = 0; c < 3; ++c) {
        for (std::uint32_t k = 0; k < all.heap.sites[6].sample_count; ++k)
            all.direct(6, c, k) = 2.0f;                                     // even light
        all.received(7, c) = static_cast<float>(0.6 * all.mean(7, c));      // less than direct
        for (std::uint32_t k = 0; k < all.heap.sites[5].sample_count; ++k)  // no light at all
            all.direct(5, c, k) = 0.0f;
        all.received(5, c) = 0.0f;
    }
    const Sender::Sent found = all.run(-1.0f);
    int none = 0;
    for (std::size_t i = 0; i < all.heap.sites.size(); ++i) {
        all.expect_sent(found, i);
        for (int c = 0; c < 3; ++c) {
            // Samples send all that their site has.
            double sum = 0.0;
            for (std::uint32_t k = 0; k < all.heap.sites[i].sample_count; ++k) {
                const float value = found.sent[c * all.heap.buffers.sample_stride +
                                               all.heap.sites[i].first_sample + k];
                sum += value;
                none += i == 7 && value == 0.0f;
                EXPECT_TRUE(i != 5 || value == 0.0f);
            }
            EXPECT_NEAR(sum, all.power(i, c), 1e-5 * all.power(i, c)) << i;
        }
    }
    EXPECT_GT(none, 3);
}

TEST_P(Send, LeavesSmallChangesToAnotherTime) {
    Sender all(GetParam(), 60);
    all.sent = all.run(-1.0f).sent;
    // The same again: nothing.
    const Sender::Sent again = all.run(0.0f);
    for (std::size_t i = 0; i < all.heap.sites.size(); ++i) all.expect_kept(again, i);

    test::Random random(12);
    std::vector<double> changes;
    for (std::size_t i = 0; i < all.heap.sites.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            all.received(i, c) *= static_cast<float>(i % 4 ? random(0.8, 1.2) : 1.0);
        changes.push_back(all.change(i));
    }
    std::vector<double> sorted = changes;
    std::sort(sorted.begin(), sorted.end());
    for (const double least : {0.0, sorted[30], sorted[50], 2.0 * sorted[59]})
        for (const double off : {1.0 - 1e-3, 1.0 + 1e-3}) {
            const Sender::Sent found = all.run(static_cast<float>(least * off));
            for (std::size_t i = 0; i < changes.size(); ++i)
                if (changes[i] > least * off && i % 4)
                    all.expect_sent(found, i);
                else
                    all.expect_kept(found, i);
        }
    // Every channel alone counts.
    for (int c = 0; c < 3; ++c) {
        Sender one(GetParam(), 20);
        one.sent = one.run(-1.0f).sent;
        one.received(11, c) *= 1.25f;
        const Sender::Sent found = one.run(static_cast<float>(0.9 * one.change(11)));
        for (std::size_t i = 0; i < 20; ++i)
            i == 11 ? one.expect_sent(found, i) : one.expect_kept(found, i);
    }
}

// Direct light that moves from one half of a site to the other changes what texels near by receive,
// though not the power of the site.
TEST_P(Send, CountsLightThatMovesWithinASite) {
    Sender all(GetParam(), 20);
    all.sent = all.run(-1.0f).sent;
    std::size_t site = 0;
    while (all.heap.sites[site].sample_count < 8) ++site;
    const std::uint32_t count = all.heap.sites[site].sample_count;
    for (int c = 0; c < 3; ++c)
        for (std::uint32_t k = 0; k < count / 2; ++k)
            std::swap(all.direct(site, c, k), all.direct(site, c, count - 1 - k));
    const double change = all.change(site);
    EXPECT_GT(change, 0.05 * all.power(site, 1));
    const Sender::Sent found = all.run(static_cast<float>(0.99 * change));
    all.expect_sent(found, site);
    all.expect_kept(found, site + 1);
    all.expect_kept(all.run(static_cast<float>(1.01 * change)), site);
}

// Numbers that are not finite are sent whatever else is too little, and spoil no other site.
TEST_P(Send, LosesNoNumberThatIsNotFinite) {
    for (int c = 0; c < 3; ++c)
        for (const float value : {nan, infinity}) {
            Sender all(GetParam(), 12);
            all.sent = all.run(-1.0f).sent;
            all.received(4, c) = value;
            all.sent[c * all.heap.buffers.sample_stride + all.heap.sites[9].first_sample] = value;
            const Sender::Sent found = all.run(1e30f);
            for (std::size_t i = 0; i < 12; ++i) {
                if (i != 4 && i != 9) {
                    all.expect_kept(found, i);
                    continue;
                }
                EXPECT_EQ(found.sends[i], 1);
                EXPECT_FALSE(std::isfinite(found.sites[c * all.heap.buffers.stride + i]));
                const std::size_t at =
                    c * all.heap.buffers.sample_stride + all.heap.sites[i].first_sample;
                EXPECT_FALSE(std::isfinite(found.samples[at]));
            }
            // Once it is there, no difference takes it away: the sum stays no number.
            all.sent = found.sent;
            all.received(4, c) = 1.0f;
            EXPECT_EQ(all.run(1e30f).sends[4], 1);
        }
}

// Powers add up to that of the site whatever the light is: too dark or too bright to be summed.
TEST_P(Send, SharesAnyLight) {
    for (const float value :
         {1e-39f, 1e-30f, 1e-20f, 2e-13f, 1e-11f, 1e11f, 2e12f, 1e20f, 1e30f, 3e37f}) {
        Sender all(GetParam(), 6);
        std::fill(all.irradiance.begin(), all.irradiance.end(), value);
        std::fill(all.light.begin(), all.light.end(), value);
        std::fill(all.sent.begin(), all.sent.end(), 0.0f);
        const Sender::Sent found = all.run(-1.0f);
        for (std::size_t i = 0; i < 6; ++i)
            for (int c = 0; c < 3; ++c) {
                double sum = 0.0;
                for (std::uint32_t k = 0; k < all.heap.sites[i].sample_count; ++k)
                    sum += found.samples[c * all.heap.buffers.sample_stride +
                                         all.heap.sites[i].first_sample + k];
                // What is no normal number may become 0.
                EXPECT_NEAR(sum, all.power(i, c), 1e-5 * all.power(i, c) + 30 * 0x1p-126) << value;
            }
    }
}

}  // namespace
}  // namespace clgi
