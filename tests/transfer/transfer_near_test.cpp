// Lists of single triangles for every receiver: the same masks as of clusters with the same
// triangles, bit for bit.
// SPDX-License-Identifier: MIT
#include "mask_tools.hpp"
#include "math_modes.hpp"
#include "refusals.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Drawn;
using test::MaskHeap;

using Lists = std::vector<std::vector<cl_uint>>;  // [receiver] triangles

void set_near(Blockers& blockers, const Lists& lists) {
    blockers.near_lists = {0};
    blockers.near.clear();
    for (const auto& list : lists) {
        blockers.near.insert(blockers.near.end(), list.begin(), list.end());
        blockers.near_lists.push_back(static_cast<cl_uint>(blockers.near.size()));
    }
}

// No clusters for anyone.
void clear_far(Blockers& blockers) {
    blockers.lists = {0, 0};
    blockers.ranges = {0, 0};
    blockers.receivers_per_list = ~0u;
}

// Lists of 0, 1, 2 ... 36 triangles, so of no packet, of one that is not full, and of more.
Lists growing_lists() {
    test::Random random(23);
    Lists out(37);
    for (int i = 0; i < 37; ++i)
        for (int k = 0; k < i; ++k) out[i].push_back(static_cast<cl_uint>(random.integer(0, 199)));
    return out;
}

// What a receiver sees of its triangles alone, as the only cluster.
std::vector<std::vector<cl_uint>> one_by_one(const MaskHeap& heap, const Lists& lists,
                                             const MaskOptions& masks, const BuildOptions& how) {
    std::vector<std::vector<cl_uint>> out;
    for (std::size_t i = 0; i < lists.size(); ++i) {
        Blockers part;
        part.positions = heap.blockers.positions;
        for (const cl_uint t : lists[i]) part.triangles.push_back(heap.blockers.triangles[t]);
        test::Eyes eye{{heap.eyes.positions[i]}, {heap.eyes.normals[i]}};
        out.push_back(test::draw_masks(part, eye, masks, how).mask(0));
    }
    return out;
}

CLGI_IN_BOTH_MATHS(TransferNear);

TEST_P(TransferNear, ListsGiveTheMasksOfClustersOfTheSameTriangles) {
    MaskHeap heap;
    const Lists lists = growing_lists();
    for (const EdgePlanes planes : {EdgePlanes::exact, EdgePlanes::table}) {
        MaskOptions masks;
        masks.planes = planes;
        masks.table_size = 32;
        const auto wanted = one_by_one(heap, lists, masks, {.math = GetParam()});
        Blockers near = heap.blockers;
        clear_far(near);
        set_near(near, lists);
        for (const int width : test::widths()) {
            const BuildOptions how{.math = GetParam(), .packet_width = width};
            const Drawn drawn = test::draw_masks(near, heap.eyes, masks, how);
            for (std::size_t i = 0; i < lists.size(); ++i)
                ASSERT_EQ(drawn.mask(i), wanted[i]) << i << " with " << width << " lanes";
            EXPECT_EQ(drawn.count(0), 0);
            EXPECT_GT(drawn.count(36), 36);
        }
    }
}

// Clusters and singles together: the union of both, and every receiver has its own singles though
// it shares a list of clusters with nine others.
TEST_P(TransferNear, ListsAddToThoseOfClusters) {
    const MaskHeap heap;
    const BuildOptions how{.math = GetParam()};
    Blockers far = heap.blockers;
    far.receivers_per_list = 10;
    far.lists = {0, 1, 1, 2, 2};
    far.ranges = {3, 1, 1, 1};
    Blockers near = heap.blockers, both = far;
    clear_far(near);
    set_near(near, growing_lists());
    set_near(both, growing_lists());
    const Drawn a = test::draw_masks(far, heap.eyes, {}, how),
                b = test::draw_masks(near, heap.eyes, {}, how),
                c = test::draw_masks(both, heap.eyes, {}, how);
    int more = 0;
    for (std::uint32_t i = 0; i < 37; ++i) {
        std::vector<cl_uint> either = a.mask(i);
        for (std::size_t w = 0; w < either.size(); ++w) either[w] |= b.mask(i)[w];
        EXPECT_EQ(c.mask(i), either) << i;
        more += c.count(i) > a.count(i) && c.count(i) > b.count(i);
    }
    EXPECT_GT(more, 5);  // receivers that see something of both
}

TEST_P(TransferNear, ListsMayAllBeEmpty) {
    const MaskHeap heap;
    const BuildOptions how{.math = GetParam()};
    Blockers none = heap.blockers;
    set_near(none, Lists(37));
    test::expect_same_masks(test::draw_masks(none, heap.eyes, {}, how),
                            test::draw_masks(heap.blockers, heap.eyes, {}, how), "empty lists");
}

TEST(TransferNearInputs, OfTooFewBytesAreRefused) {
    const MaskHeap heap;
    Blockers near = heap.blockers;
    set_near(near, Lists(37));
    const Drawn drawn = test::draw_masks(near, heap.eyes);
    const auto mask = [&](const BlockerBuffers& b) {
        test::mask_passes().mask(test::device().queue, drawn.receivers, b, test::mask_table({}));
    };
    const auto cleared = [&](const cl::Buffer& x) {
        if (x())
            test::device().queue.enqueueFillBuffer(x, cl_uchar{0}, 0, x.getInfo<CL_MEM_SIZE>());
        return x;
    };
    test::expect_refusals({
        {"transfer.mask_near", "near_lists", 38 * 4,
         [&](const cl::Buffer& x) {
             BlockerBuffers b = drawn.blockers;
             b.near_lists = cleared(x);
             mask(b);
         }},
        {"transfer.mask_near", "near", 4,
         [&](const cl::Buffer& x) {
             BlockerBuffers b = drawn.blockers;
             b.near = x;
             mask(b);
         }},
    });
    EXPECT_NO_THROW(test::mask_passes().build({"mask_near"}));
    BlockerBuffers b = drawn.blockers;
    b.receivers_per_list = 0;
    EXPECT_THROW(mask(b), Error);
}

}  // namespace
}  // namespace clgi
