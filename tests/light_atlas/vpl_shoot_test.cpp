// Power that is shot, and the factors that balance it, in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "vpl_tools.hpp"

namespace clgi {
namespace {

using test::nan;

// Sites with random factors of everything.
struct ShootInput {
    std::uint32_t n, stride;
    std::vector<Site> sites;
    std::vector<float> planes, light, balance, shot;
    std::vector<std::uint16_t> rows;  // [n][stride]
    std::vector<cl_uint> chosen;
    SiteBuffers buffers;
    float per_row_scale = 0.37f;
    // count 61: the last packet of every width is filled in part.
    explicit ShootInput(std::uint32_t count = 61) : n(count), stride(test::padded(count) + 16) {
        test::Random random(21);
        const auto fill = [&](std::vector<float>& values, std::size_t planes_of, double low,
                              double high) {
            values.assign(planes_of * stride, nan);
            for (std::size_t p = 0; p < planes_of; ++p)
                for (std::uint32_t i = 0; i < n; ++i)
                    values[p * stride + i] = static_cast<float>(random(low, high));
        };
        for (std::uint32_t i = 0; i < n; ++i)
            sites.push_back({i, 1, static_cast<float>(random(0.01, 2)), (i % 4) << SITE_ROW_SHIFT});
        fill(planes, SITE_PLANES, 0.1, 0.9);
        fill(light, SITE_LIGHT_PLANES, 0.0, 5.0);
        fill(balance, BALANCE_PLANES, 0.5, 2.0);
        fill(shot, 3, 0.0, 3.0);
        rows.assign(n * stride, 0x7e00);  // NaN beside the rows
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j)
                rows[i * stride + j] = glm::packHalf1x16(
                    std::ldexp(static_cast<float>(random(0, 1)), -static_cast<int>(i % 4)));
        for (std::uint32_t i = 0; i < n; ++i) chosen.push_back((i * 7 + 3) % n);
        upload();
    }
    void upload() {
        SiteBuffers& b = buffers;
        b.site_count = n;
        b.stride = stride;
        b.sample_count = n;
        b.sample_stride = test::padded(2 * n);
        b.sites = test::upload(sites);
        b.planes = test::upload(planes);
        b.light = test::upload(light);
        b.balance = test::upload(balance);
        b.shot = test::upload(shot);
        b.power = test::upload(std::vector<float>(stride, nan));
        b.samples = test::empty<float>(GBUFFER_PLANES * b.sample_stride);
        b.chosen = test::upload(chosen);
    }
    ShootParams params(std::uint32_t first, std::uint32_t count, bool kept) const {
        return {first, count, kept ? 1u : 0u, n, stride, per_row_scale, SHOOT_ALL, 0.0f};
    }
    // Of small sites rows are divided by a power of two.
    double row(std::uint32_t i, std::uint32_t j) const {
        return std::ldexp(glm::unpackHalf1x16(rows[i * stride + j]), int(i % 4));
    }
    // The rows of a batch, one after the other.
    cl::Buffer batch(std::uint32_t first, std::uint32_t count) const {
        std::vector<std::uint16_t> out;
        for (std::uint32_t s = first; s < first + count; ++s)
            out.insert(out.end(), rows.begin() + chosen[s] * stride,
                       rows.begin() + (chosen[s] + 1) * stride);
        return test::upload(out);
    }
    float factor(int plane, std::uint32_t i) const { return balance[plane * stride + i]; }
};

struct Shot {
    std::vector<float> light, power;
    cl_uint bad;
};

// All shooters in batches of so many.
Shot shoot(const ShootInput& of, std::uint32_t batch, bool kept,
           const VplPasses& passes = test::vpl_passes()) {
    ShootInput e = of;
    e.upload();
    const cl::Buffer bad = test::upload(std::vector<cl_uint>{0});
    for (std::uint32_t first = 0; first < e.n; first += batch) {
        const std::uint32_t count = std::min(batch, e.n - first);
        passes.shoot(test::device().queue, e.params(first, count, kept), e.buffers,
                     kept ? test::upload(e.rows) : e.batch(first, count), bad);
    }
    return {test::download<float>(e.buffers.light, e.light.size()),
            test::download<float>(e.buffers.power, e.stride), test::download<cl_uint>(bad, 1)[0]};
}

TEST(Shoot, AddsWhatEveryShooterSendsInEveryChannel) {
    const ShootInput e;
    for (const std::uint32_t batch : {61u, 16u, 1u})
        for (const bool kept : {true, false}) {
            const Shot found = shoot(e, batch, kept);
            EXPECT_EQ(found.bad, 0u);
            for (std::uint32_t j = 0; j < e.n; ++j) {
                double power = 0.0;
                for (int c = 0; c < 3; ++c) {
                    double gained = 0.0;
                    for (std::uint32_t i = 0; i < e.n; ++i)
                        gained +=
                            e.row(i, j) * e.factor(BALANCE_SHOOTER, i) * e.shot[c * e.stride + i];
                    gained *= double{e.per_row_scale} * e.factor(BALANCE_RECEIVER, j);
                    const double unshot = gained + e.light[(SITE_UNSHOT + c) * e.stride + j];
                    const double received = gained + e.light[(SITE_RECEIVED + c) * e.stride + j];
                    EXPECT_NEAR(found.light[(SITE_UNSHOT + c) * e.stride + j], unshot,
                                8e-6 * unshot);
                    EXPECT_NEAR(found.light[(SITE_RECEIVED + c) * e.stride + j], received,
                                8e-6 * received);
                    power += unshot * e.planes[(SITE_ALBEDO + c) * e.stride + j];
                }
                power *= e.sites[j].area;
                EXPECT_NEAR(found.power[j], power, 1e-5 * power) << "batch " << batch;
            }
        }
}

TEST(Shoot, IsTheSameForEveryWidthAndGroup) {
    const ShootInput e;
    const Shot usual = shoot(e, 16, true);
    for (const int width : test::widths()) {
        BuildOptions build;
        build.packet_width = width;
        build.local_size = width == 4 ? 1 : 0;
        const Shot other = shoot(e, 16, true, VplPasses(test::programs(), build));
        for (std::uint32_t j = 0; j < e.n; ++j) {
            for (int plane = 0; plane < SITE_LIGHT_PLANES; ++plane)
                EXPECT_EQ(other.light[plane * e.stride + j], usual.light[plane * e.stride + j]);
            EXPECT_EQ(other.power[j], usual.power[j]);
        }
        EXPECT_EQ(other.bad, 0u);
    }
}

// Of shooter, transport and receiver; in each channel; in the last packet too.
TEST(Shoot, CountsNumbersThatAreNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const int width : test::widths()) {
        const VplPasses passes(test::programs(), {.packet_width = width});
        const auto packets = static_cast<cl_uint>((61 + width - 1) / width);
        for (int c = 0; c < 3; ++c)
            for (const float value : {nan, infinity, -infinity}) {
                ShootInput e;
                e.light[(SITE_UNSHOT + c) * e.stride + 60] = value;
                EXPECT_EQ(shoot(e, 61, true, passes).bad, 1u) << width;
                ShootInput all;
                all.shot[c * all.stride + 5] = value;
                EXPECT_EQ(shoot(all, 61, true, passes).bad, packets) << width;
            }
        ShootInput row;
        row.rows[3 * row.stride + 17] = 0x7c00;
        EXPECT_EQ(shoot(row, 61, true, passes).bad, 1u);
        ShootInput factor;
        factor.balance[BALANCE_RECEIVER * factor.stride + 2] = nan;
        EXPECT_EQ(shoot(factor, 61, true, passes).bad, 1u);
    }
}

TEST(Shoot, OfNothingAndOfOneSite) {
    const ShootInput one(1);
    const Shot found = shoot(one, 1, true);
    const double gained = one.row(0, 0) * one.factor(BALANCE_SHOOTER, 0) * one.shot[0] *
                          one.per_row_scale * one.factor(BALANCE_RECEIVER, 0);
    EXPECT_NEAR(found.light[0], one.light[0] + gained, 1e-5);
    ShootInput none(1);
    none.buffers.site_count = 0;
    const cl::Buffer any = test::upload(std::vector<float>(1024));
    ShootParams params = none.params(0, 0, true);
    params.site_count = 0;
    const VplPasses& passes = test::vpl_passes();
    const cl::CommandQueue& queue = test::device().queue;
    passes.shoot(queue, params, none.buffers, any, any).wait();
    passes.balance_receivers(queue, params, none.buffers, any).wait();
    passes.balance_shooters(queue, params, none.buffers, any).wait();
    passes.emit(queue, params, none.buffers, any).wait();
    EXPECT_EQ(test::download<float>(none.buffers.light, 1)[0], none.light[0]);
    // No shooter: nothing arrives, but powers are those of what is there.
    params = none.params(0, 0, true);
    none.buffers.site_count = 1;
    passes.shoot(queue, params, none.buffers, any, any).wait();
    EXPECT_EQ(test::download<float>(none.buffers.light, 1)[0], none.light[0]);
}

// ---- balance
// ---------------------------------------------------------------------------------------

double bounded(double reach, double sum) {
    return sum > 0.0 ? std::min(std::max(reach / sum, 0.5), 2.0) : 1.0;
}

// Rows whose sums lie around 1, some far off, some empty.
ShootInput uneven() {
    ShootInput e;
    test::Random random(22);
    for (std::uint32_t i = 0; i < e.n; ++i)
        for (std::uint32_t j = 0; j < e.n; ++j) {
            double value = random(0.0, 0.07);
            if (j % 10 == 3) value *= 20.0;  // clamped below
            if (j % 10 == 4) value *= 0.05;  // clamped above
            if (i % 10 == 5) value *= 10.0;
            if (i % 10 == 6) value *= 0.05;
            if (j % 10 == 7 || i % 10 == 8) value = 0.0;
            e.rows[i * e.stride + j] =
                glm::packHalf1x16(std::ldexp(static_cast<float>(value), -static_cast<int>(i % 4)));
        }
    e.upload();
    return e;
}

struct Clamped {
    int low = 0, high = 0, between = 0, empty = 0;
    void count(double factor, bool nothing) {
        if (nothing)
            ++empty;
        else if (factor == 0.5)
            ++low;
        else if (factor == 2.0)
            ++high;
        else
            ++between;
    }
    void expect_all() const {
        EXPECT_GT(low, 2);
        EXPECT_GT(high, 2);
        EXPECT_GT(between, 20);
        EXPECT_GT(empty, 2);
    }
};

TEST(Balance, OfReceiversBringsTheirSumToTheirReach) {
    for (const int width : test::widths()) {
        ShootInput e = uneven();
        VplPasses(test::programs(), {.packet_width = width})
            .balance_receivers(test::device().queue, e.params(0, e.n, true), e.buffers,
                               test::upload(e.rows));
        const auto after = test::download<float>(e.buffers.balance, e.balance.size());
        Clamped clamped;
        for (std::uint32_t j = 0; j < e.n; ++j) {
            double sum = 0.0;
            for (std::uint32_t i = 0; i < e.n; ++i)
                sum += e.row(i, j) * e.factor(BALANCE_SHOOTER, i) * e.sites[i].area;
            const double wanted = bounded(e.factor(BALANCE_REACH, j), sum * e.per_row_scale);
            const float found = after[BALANCE_RECEIVER * e.stride + j];
            EXPECT_NEAR(found, wanted, 1e-5 * wanted) << j;
            clamped.count(found, sum == 0.0);
            EXPECT_EQ(after[BALANCE_SHOOTER * e.stride + j], e.factor(BALANCE_SHOOTER, j));
            EXPECT_EQ(after[BALANCE_REACH * e.stride + j], e.factor(BALANCE_REACH, j));
        }
        clamped.expect_all();
    }
}

TEST(Balance, OfShootersBringsTheirSumToTheirReach) {
    for (const int width : test::widths())
        for (const bool kept : {true, false}) {
            ShootInput e = uneven();
            const VplPasses passes(test::programs(), {.packet_width = width});
            for (std::uint32_t first = 0; first < e.n; first += 23) {
                const std::uint32_t count = std::min(23u, e.n - first);
                passes.balance_shooters(test::device().queue, e.params(first, count, kept),
                                        e.buffers,
                                        kept ? test::upload(e.rows) : e.batch(first, count));
            }
            const auto after = test::download<float>(e.buffers.balance, e.balance.size());
            Clamped clamped;
            for (std::uint32_t i = 0; i < e.n; ++i) {
                double sum = 0.0;
                for (std::uint32_t j = 0; j < e.n; ++j)
                    sum += e.row(i, j) * e.factor(BALANCE_RECEIVER, j) * e.sites[j].area;
                const double wanted = bounded(e.factor(BALANCE_REACH, i), sum * e.per_row_scale);
                const float found = after[BALANCE_SHOOTER * e.stride + i];
                EXPECT_NEAR(found, wanted, 1e-5 * wanted) << i;
                clamped.count(found, sum == 0.0);
                EXPECT_EQ(after[BALANCE_RECEIVER * e.stride + i], e.factor(BALANCE_RECEIVER, i));
                const bool bound = found <= 0.5f || found >= 2.0f || sum == 0.0;
                const double reach =
                    bound ? found * sum * e.per_row_scale : double{e.factor(BALANCE_REACH, i)};
                EXPECT_NEAR(after[BALANCE_REACH * e.stride + i], reach, 1e-5 * reach) << i;
            }
            clamped.expect_all();
        }
}

// Power shot is power received and lost, whatever the factors of the receivers are.
TEST(Balance, OfShootersKeepsEnergy) {
    ShootInput e;
    for (std::uint32_t i = 0; i < e.n; ++i)
        for (std::uint32_t j = 0; j < e.n; ++j)
            e.rows[i * e.stride + j] = glm::packHalf1x16(
                std::ldexp(static_cast<float>(e.row(i, j) * 0.028 / e.per_row_scale), -int(i % 4)));
    for (std::uint32_t i = 0; i < e.n; ++i)
        e.balance[BALANCE_REACH * e.stride + i] = 0.8f + 0.2f * static_cast<float>(i) / 61.0f;
    e.upload();
    const cl::Buffer rows = test::upload(e.rows), bad = test::upload(std::vector<cl_uint>{0});
    test::vpl_passes().balance_shooters(test::device().queue, e.params(0, e.n, true), e.buffers,
                                        rows);
    test::vpl_passes().shoot(test::device().queue, e.params(0, e.n, true), e.buffers, rows, bad);
    const auto light = test::download<float>(e.buffers.light, e.light.size());
    for (int c = 0; c < 3; ++c) {
        double sent = 0.0, arrived = 0.0;
        for (std::uint32_t i = 0; i < e.n; ++i) {
            sent += double{e.shot[c * e.stride + i]} * e.factor(BALANCE_REACH, i);
            const std::size_t at = (SITE_RECEIVED + c) * e.stride + i;
            arrived += (double{light[at]} - e.light[at]) * e.sites[i].area;
        }
        EXPECT_NEAR(arrived, sent, 1e-5 * sent);
    }
}

}  // namespace
}  // namespace clgi
