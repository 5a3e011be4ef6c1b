// Masks and transfer vectors that must not differ: of other widths, groups, scales, boxes and
// lists; inputs that are no numbers, and none at all.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "mask_tools.hpp"
#include "math_modes.hpp"
#include "refusals.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Drawn;
using test::expect_same_masks;
using test::Eyes;
using test::MaskHeap;
using test::Triangle;

using test::nan;
constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(TransferSameness, OfEveryWidthAndGroup) {
    const MaskHeap heap;
    for (const int size : {8, 32, 64})
        for (const EdgePlanes planes : {EdgePlanes::exact, EdgePlanes::table}) {
            MaskOptions masks;
            masks.size = size;
            masks.planes = planes;
            masks.table_size = 32;
            masks.block = size == 64 ? 2 : 4;
            const Drawn first = test::draw_masks(heap.blockers, heap.eyes, masks, {});
            const auto vectors = test::transfer_vectors(first, CellIntegral::exact, {});
            int blocked = 0;
            for (std::uint32_t i = 0; i < 37; ++i) blocked += first.count(i);
            EXPECT_GT(blocked, 37);
            for (const int width : test::widths())
                for (const std::size_t group : {1u, 7u, 64u}) {
                    // Masks of 32 pixels at every width, and by packets in groups of any size.
                    // Others by single lanes.
                    const bool widest = width == test::widths().back();
                    if (size == 32 ? group != 7u && !widest : group != 7u || width != 1) continue;
                    const BuildOptions how{.packet_width = width, .local_size = group};
                    const Drawn other = test::draw_masks(heap.blockers, heap.eyes, masks, how);
                    expect_same_masks(first, other, std::to_string(width) + " lanes");
                    EXPECT_EQ(test::transfer_vectors(other, CellIntegral::exact, how), vectors);
                }
        }
}

CLGI_IN_BOTH_MATHS(TransferScales);

TEST_P(TransferScales, OfScalesByPowersOfTwo) {
    const MaskHeap one;
    const Drawn first = test::draw_masks(one.blockers, one.eyes);
    for (const int power : {-40, -13, 7, 40}) {
        const MaskHeap other(5, std::ldexp(1.0, power));
        expect_same_masks(first, test::draw_masks(other.blockers, other.eyes),
                          "2^" + std::to_string(power));
    }
}

// A cluster each, small and apart, around receivers that look anywhere.
Blockers separate_heaps(int count) {
    test::Random random(23);
    Blockers out;
    for (int i = 0; i < count; ++i) {
        const double x = random(-3, 3), y = random(-3, 3), z = random(-3, 3);
        for (int t = 0; t < BLOCKER_CLUSTER; ++t) {
            Triangle small = test::random_triangle(random);
            for (glm::dvec3& p : small) p = 0.1 * p + glm::dvec3(x, y, z);
            out.add(small);
        }
    }
    return out;
}

// Of pairs of a receiver and a cluster, those whose box lies below the receiver's horizon.
int below(const Drawn& drawn, const Eyes& eyes) {
    const auto boxes =
        test::download<BlockerBox>(drawn.blockers.boxes, drawn.blockers.stride / BLOCKER_CLUSTER);
    int out = 0;
    for (std::size_t i = 0; i < eyes.positions.size(); ++i)
        for (const BlockerBox& box : boxes) {
            double highest = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                const double n = eyes.normals[i][axis], from = eyes.positions[i][axis];
                highest += std::max(n * (box.low[axis] - from), n * (box.high[axis] - from));
            }
            out += highest < 0.0;
        }
    return out;
}

// Clusters that are skipped hold nothing that is seen: the same with boxes that are everywhere.
TEST(TransferSameness, WithAndWithoutBoxes) {
    constexpr int heaps = 24;
    const Eyes eyes = MaskHeap().eyes;
    const Drawn all = test::draw_masks(separate_heaps(heaps), eyes);
    const int pairs = heaps * 37;
    EXPECT_GT(below(all, eyes), pairs / 4);
    EXPECT_LT(below(all, eyes), pairs * 3 / 4);
    BlockerBuffers wide = all.blockers;
    wide.boxes = test::upload(std::vector<BlockerBox>(
        heaps, {glm::vec4(-1e3f, -1e3f, -1e3f, 0), glm::vec4(1e3f, 1e3f, 1e3f, 0)}));
    test::mask_passes().mask(test::device().queue, all.receivers, wide, test::mask_table({}));
    Drawn again = all;
    again.words = test::download<cl_uint>(all.receivers.masks, all.words.size());
    expect_same_masks(all, again, "boxes");
    int blocked = 0;
    for (std::uint32_t i = 0; i < 37; ++i) blocked += all.count(i);
    EXPECT_GT(blocked, 37);
}

// Ten receivers a list; each list has other clusters, in other orders.
TEST(TransferSameness, OfListsIsThatOfTheirClusters) {
    const MaskHeap heap;
    Blockers listed = heap.blockers;
    listed.receivers_per_list = 10;
    listed.lists = {0, 1, 3, 3, 6};
    listed.ranges = {1, 2, 3, 1, 0, 1, 2, 2, 1, 1, 0, 1};
    const Drawn some = test::draw_masks(listed, heap.eyes);
    const std::vector<std::vector<std::size_t>> wanted = {{1, 2}, {0, 3}, {}, {0, 1, 2, 3}};
    for (std::size_t list = 0; list < 4; ++list) {
        Blockers part;
        for (const std::size_t cluster : wanted[list])
            for (std::size_t t = 64 * cluster; t < std::min<std::size_t>(64 * cluster + 64, 200);
                 ++t)
                part.triangles.push_back(heap.blockers.triangles[t]);
        part.positions = heap.blockers.positions;
        const Drawn alone = test::draw_masks(part, heap.eyes);
        for (std::size_t i = 10 * list; i < std::min<std::size_t>(10 * list + 10, 37); ++i)
            EXPECT_EQ(some.mask(i), alone.mask(i)) << i;
    }
}

// ---- frames ------------------------------------------------------------------------------------

// A million normals of any length, along axes and near the poles: unit vectors at right angles.
TEST(TransferReceivers, HaveRightHandedFramesOfUnitVectors) {
    test::Random random(8);
    Eyes eyes;
    eyes.normals = {{0, 0, 1, 0},
                    {0, 0, -1, 0},
                    {0, 1, 0, 0},
                    {0, -1, 0, 0},
                    {1, 0, 0, 0},
                    {-1, 0, 0, 0},
                    {1e-30f, 0, -1, 0},
                    {0, 0, 1e-30f, 0},
                    {3e25f, 1e25f, -2e25f, 0},
                    {1, 1, -0.0f, 0},
                    {1, 1, 0.0f, 0},
                    {0x1p-12f, 0, -1 + 0x1p-23f, 0},
                    {0x1p-12f, 0x1p-13f, -1, 0}};
    while (eyes.normals.size() < 1000000)
        eyes.normals.emplace_back(random(-1, 1), random(-1, 1), random(-1, 1), 0);
    const auto count = static_cast<std::uint32_t>(eyes.normals.size());
    eyes.positions.assign(count, {1, 2, 3, 0});
    ReceiverBuffers r;
    r.count = count;
    r.stride = plane_stride(count);
    r.planes = test::empty<float>(std::size_t{RECEIVER_PLANES} * r.stride);
    const cl::Buffer status = test::upload(std::vector<cl_uint>{0, 0});
    test::mask_passes().receivers(test::device().queue, test::upload(eyes.positions),
                                  test::upload(eyes.normals), r, status);
    const auto planes = test::download<float>(r.planes, std::size_t{RECEIVER_PLANES} * r.stride);
    const auto row = [&](int plane, std::size_t i) {
        glm::dvec3 out;
        for (int k = 0; k < 3; ++k)
            out[k] = planes[static_cast<std::size_t>(plane + k) * r.stride + i];
        return out;
    };
    const double bound = 8 * 0x1p-24;  // products and sums of three roundings each
    double worst = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 t = row(RECEIVER_TANGENT, i), b = row(RECEIVER_BITANGENT, i),
                         n = row(RECEIVER_NORMAL, i);
        for (const double error :
             {glm::dot(t, t) - 1, glm::dot(b, b) - 1, glm::dot(n, n) - 1, glm::dot(t, b),
              glm::dot(b, n), glm::dot(n, t), glm::length(glm::cross(t, b) - n),
              glm::length(n - glm::normalize(glm::dvec3(eyes.normals[i])))})
            worst = std::max(worst, std::abs(error));
        ASSERT_LT(worst, bound) << i;
    }
    EXPECT_EQ(row(RECEIVER_POSITION, 7), glm::dvec3(1, 2, 3));
    EXPECT_EQ(test::download<cl_uint>(status, 2)[0], 0u);
}

// ---- no numbers --------------------------------------------------------------------------------

CLGI_IN_BOTH_MATHS(TransferInputs);

TEST_P(TransferInputs, CountWhatIsNotFiniteAndKeepTheRest) {
    const BuildOptions how{.math = GetParam()};
    const MaskHeap heap;
    const Drawn clean = test::draw_masks(heap.blockers, heap.eyes, {}, how);
    const auto vectors = test::transfer_vectors(clean, CellIntegral::exact, how);
    EXPECT_EQ(clean.counted(), (std::array<cl_uint, 2>{0, 0}));
    for (const float bad : {nan, infinity, -infinity})
        for (int axis = 0; axis < 3; ++axis) {
            // A corner: the triangle blocks nothing, the others as before.
            for (int corner = 0; corner < 3; ++corner) {
                MaskHeap spoilt, without;
                spoilt.blockers.positions[3 * 70 + corner][axis] = bad;
                without.blockers.triangles[70] = glm::uvec4(0);
                const Drawn drawn = test::draw_masks(spoilt.blockers, spoilt.eyes, {}, how);
                EXPECT_EQ(drawn.counted(), (std::array<cl_uint, 2>{0, 1}));
                expect_same_masks(drawn, test::draw_masks(without.blockers, without.eyes, {}, how),
                                  "bad");
            }
            // A receiver: its own light is no number.
            for (const bool normal : {false, true}) {
                MaskHeap spoilt;
                (normal ? spoilt.eyes.normals : spoilt.eyes.positions)[19][axis] = bad;
                const Drawn drawn = test::draw_masks(spoilt.blockers, spoilt.eyes, {}, how);
                EXPECT_EQ(drawn.counted(), (std::array<cl_uint, 2>{1, 0}));
                const auto found = test::transfer_vectors(drawn, CellIntegral::exact, how);
                for (std::size_t i = 0; i < 37; ++i)
                    if (i != 19) {
                        EXPECT_EQ(drawn.mask(i), clean.mask(i)) << i;
                        EXPECT_EQ(found[i], vectors[i]) << i;
                    }
                EXPECT_FALSE(std::isfinite(found[19][0] + found[19][3]));
            }
        }
    MaskHeap spoilt;
    spoilt.eyes.normals[19] = glm::vec4(0.0f);
    const Drawn drawn = test::draw_masks(spoilt.blockers, spoilt.eyes, {}, how);
    EXPECT_EQ(drawn.counted(), (std::array<cl_uint, 2>{1, 0}));
}

TEST(TransferInputs, MayBeNone) {
    Eyes nobody;
    nobody.positions.clear();
    nobody.normals.clear();
    const MaskPasses& passes = test::mask_passes();
    const cl::CommandQueue& queue = test::device().queue;
    ReceiverBuffers r;
    r.planes = r.masks = r.transfer = test::empty<float>(1);
    BlockerBuffers b;
    const cl::Buffer any = test::empty<float>(1 << 16);
    b.corners = b.boxes = b.lists = b.ranges = any;
    EXPECT_NO_THROW(passes.receivers(queue, any, any, r, any));
    EXPECT_NO_THROW(passes.blockers(queue, any, any, b, any));
    EXPECT_NO_THROW(passes.mask(queue, r, b, any));
    EXPECT_NO_THROW(passes.integrate(queue, r, any, any));
    EXPECT_NO_THROW(passes.shade(queue, r, any, any, 0, any, any));
    queue.finish();
}

TEST(TransferInputs, OfTooFewBytesAreRefused) {
    const MaskPasses& passes = test::mask_passes({.block = 4});
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer zeros = test::upload(std::vector<cl_uint>(1 << 16));
    const cl::Buffer scratch = test::empty<float>(1 << 16);
    ReceiverBuffers r;
    r.planes = r.masks = r.transfer = scratch;
    r.count = 5;
    r.stride = 16;
    BlockerBuffers b;
    b.corners = b.boxes = scratch;
    b.lists = b.ranges = zeros;
    b.triangle_count = 70;
    b.stride = 128;
    b.receivers_per_list = 2;
    const auto with = [](auto buffers, auto which, const cl::Buffer& other) {
        buffers.*which = other;
        return buffers;
    };
    const auto cleared = [&](const cl::Buffer& x) {
        if (x()) queue.enqueueFillBuffer(x, cl_uchar{0}, 0, x.getInfo<CL_MEM_SIZE>());
        return x;
    };
    using R = ReceiverBuffers;
    using B = BlockerBuffers;
    const std::size_t vectors = 25 * 16 * 4, cells = 64;
    const auto receive = [&](const cl::Buffer& p, const cl::Buffer& n, const R& to,
                             const cl::Buffer& s) { passes.receivers(queue, p, n, to, s); };
    const auto block = [&](const cl::Buffer& t, const B& to, const cl::Buffer& s) {
        passes.blockers(queue, t, zeros, to, s);
    };
    const auto mask = [&](const R& rr, const B& bb, const cl::Buffer& d) {
        passes.mask(queue, rr, bb, d);
    };
    const auto integrate = [&](const R& rr, const cl::Buffer& w, const cl::Buffer& d) {
        passes.integrate(queue, rr, w, d);
    };
    test::expect_refusals({
        {"transfer.receivers", "positions", 5 * 16,
         [&](const cl::Buffer& x) { receive(x, zeros, r, scratch); }},
        {"transfer.receivers", "normals", 5 * 16,
         [&](const cl::Buffer& x) { receive(zeros, x, r, scratch); }},
        {"transfer.receivers", "receivers", 12 * 16 * 4,
         [&](const cl::Buffer& x) { receive(zeros, zeros, with(r, &R::planes, x), scratch); }},
        {"transfer.receivers", "status", 8,
         [&](const cl::Buffer& x) { receive(zeros, zeros, r, x); }},
        {"transfer.blockers", "triangles", 70 * 16,
         [&](const cl::Buffer& x) { block(cleared(x), b, scratch); }},
        {"transfer.blockers", "corners", 9 * 128 * 4,
         [&](const cl::Buffer& x) { block(zeros, with(b, &B::corners, x), scratch); }},
        {"transfer.blockers", "boxes", 2 * 32,
         [&](const cl::Buffer& x) { block(zeros, with(b, &B::boxes, x), scratch); }},
        {"transfer.blockers", "status", 8, [&](const cl::Buffer& x) { block(zeros, b, x); }},
        {"transfer.planes", "heights", 32 * 32 * 4,
         [&](const cl::Buffer& x) {
             passes.planes(queue, x, test::empty<char>(3 * 128 * 128 * 128));
         }},
        {"transfer.planes", "table", 3 * 128 * 128 * 128,
         [&](const cl::Buffer& x) { passes.planes(queue, zeros, x); }},
        {"transfer.mask", "receivers", 12 * 16 * 4,
         [&](const cl::Buffer& x) { mask(with(r, &R::planes, x), b, zeros); }},
        {"transfer.mask", "masks", 32 * 16 * 4,
         [&](const cl::Buffer& x) { mask(with(r, &R::masks, x), b, zeros); }},
        {"transfer.mask", "corners", 9 * 128 * 4,
         [&](const cl::Buffer& x) { mask(r, with(b, &B::corners, x), zeros); }},
        {"transfer.mask", "boxes", 2 * 32,
         [&](const cl::Buffer& x) { mask(r, with(b, &B::boxes, x), zeros); }},
        {"transfer.mask", "lists", 4 * 4,
         [&](const cl::Buffer& x) { mask(r, with(b, &B::lists, cleared(x)), zeros); }},
        {"transfer.mask", "ranges", 8,
         [&](const cl::Buffer& x) { mask(r, with(b, &B::ranges, cleared(x)), zeros); }},
        {"transfer.mask", "drawn", 32 * 32 * 4, [&](const cl::Buffer& x) { mask(r, b, x); }},
        {"transfer.integrate", "receivers", 12 * 16 * 4,
         [&](const cl::Buffer& x) { integrate(with(r, &R::planes, x), zeros, zeros); }},
        {"transfer.integrate", "masks", 32 * 16 * 4,
         [&](const cl::Buffer& x) { integrate(with(r, &R::masks, x), zeros, zeros); }},
        {"transfer.integrate", "weights", (cells + 1) * 25 * 4,
         [&](const cl::Buffer& x) { integrate(r, x, zeros); }},
        {"transfer.integrate", "directions", (9 + cells) * 16,
         [&](const cl::Buffer& x) { integrate(r, zeros, x); }},
        {"transfer.integrate", "transfer", vectors,
         [&](const cl::Buffer& x) { integrate(with(r, &R::transfer, x), zeros, zeros); }},
        {"transfer.integrate_gloss", "exponents", 16 * 4,
         [&](const cl::Buffer& x) {
             passes.integrate_gloss(queue, r, zeros, zeros, x, glm::vec4(1.0f), r.transfer);
         }},
        {"transfer.shade", "transfer", vectors,
         [&](const cl::Buffer& x) { passes.shade(queue, r, x, zeros, 0, r.transfer, scratch); }},
        {"transfer.shade", "light", 25 * 16,
         [&](const cl::Buffer& x) { passes.shade(queue, r, zeros, x, 0, r.transfer, scratch); }},
        {"transfer.shade", "irradiance", 3 * 16 * 4,
         [&](const cl::Buffer& x) { passes.shade(queue, r, zeros, zeros, 0, x, scratch); }},
        {"transfer.shade", "non_finite", 4,
         [&](const cl::Buffer& x) { passes.shade(queue, r, zeros, zeros, 0, r.transfer, x); }},
    });
    EXPECT_NO_THROW(passes.build({"integrate", "integrate_gloss", "shade"}));
    B wrong = b;
    wrong.stride = 64;
    EXPECT_THROW(mask(r, wrong, zeros), Error);
    wrong = b;
    wrong.receivers_per_list = 0;
    EXPECT_THROW(mask(r, wrong, zeros), Error);
    for (const MaskOptions& bad :
         {MaskOptions{.size = 20}, MaskOptions{.table_size = 4}, MaskOptions{.table_size = 513},
          MaskOptions{.block = 3}, MaskOptions{.bands = 0}, MaskOptions{.bands = 10}})
        EXPECT_THROW(MaskPasses(test::programs(), bad), Error);
}

}  // namespace
}  // namespace clgi
