// Potentially visible sets: named cases, random triangles against double precision, and the masks
// that are drawn with them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/visible_sets.hpp>
#include <limits>
#include <set>

#include "mask_tools.hpp"
#include "math_modes.hpp"
#include "refusals.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Drawn;
using test::MaskHeap;
using test::Triangle;

// Bits after the triangles of `drawn` were looked at, on top of those that are there.
std::vector<cl_uint> add_seen(const Drawn& drawn, std::vector<cl_uint> bits,
                              const BuildOptions& how) {
    MaskOptions heights = drawn.options;
    heights.planes = EdgePlanes::exact;
    bits.resize(visible_words(drawn.blockers.triangle_count) * drawn.receivers.stride, 0);
    if (bits.empty()) return bits;
    const cl::Buffer seen = test::upload(bits);
    test::mask_passes(drawn.options, how)
        .visible(test::device().queue, drawn.receivers, drawn.blockers, test::mask_table(heights),
                 seen);
    return test::download<cl_uint>(seen, bits.size());
}

VisibleSets sets_of(const Drawn& drawn, const std::vector<cl_uint>& bits) {
    return visible_sets(bits, drawn.receivers.count, drawn.receivers.stride,
                        drawn.blockers.triangle_count);
}

std::vector<cl_uint> of_receiver(const VisibleSets& sets, std::size_t receiver) {
    return {sets.near.begin() + sets.near_lists[receiver],
            sets.near.begin() + sets.near_lists[receiver + 1]};
}

CLGI_IN_BOTH_MATHS(TransferVisible);

std::vector<cl_uint> visible_of(Math math, const std::vector<Triangle>& triangles) {
    const BuildOptions how{.math = math};
    const Drawn drawn = test::draw_masks(Blockers(triangles), {}, {}, how);
    return of_receiver(sets_of(drawn, add_seen(drawn, {}, how)), 0);
}

using List = std::vector<cl_uint>;

// A triangle is seen where it is in front, in whatever order triangles come.
TEST_P(TransferVisible, TrianglesHideWhatIsBehindThem) {
    const Triangle wide{{{3, 0, 1}, {-2, 2, 1}, {-2, -2, 1}}},
        behind{{{.3, 0, 2}, {0, .3, 2}, {-.3, -.3, 2}}},
        before{{{.1, 0, .5}, {0, .1, .5}, {-.1, -.1, .5}}},
        below{{{1, 0, -1}, {0, 1, -1}, {-1, -1, -1}}};
    EXPECT_EQ(visible_of(GetParam(), {wide, behind}), (List{0}));
    EXPECT_EQ(visible_of(GetParam(), {behind, wide}), (List{1}));
    EXPECT_EQ(visible_of(GetParam(), {wide, before}), (List{0, 1}));
    EXPECT_EQ(visible_of(GetParam(), {behind, below, before, wide}), (List{2, 3}));
    EXPECT_EQ(visible_of(GetParam(), {below}), List());
    EXPECT_EQ(visible_of(GetParam(), {}), List());
    // From its other side as well.
    EXPECT_EQ(visible_of(GetParam(), {{wide[2], wide[1], wide[0]}, behind}), (List{0}));
    // At the same distance the first is seen.
    EXPECT_EQ(visible_of(GetParam(), {behind, wide, wide}), (List{1}));
}

// Two triangles through each other along x = 0: each hides half of the other, though the one's
// corners are all as far away as the other's.
TEST_P(TransferVisible, TrianglesThatCrossAreBothSeen) {
    const Triangle left{{{-1, -1, .6}, {-1, 1, .6}, {1, 0, 1.4}}},
        right{{{1, -1, .6}, {1, 1, .6}, {-1, 0, 1.4}}},
        low{{{.1, -.1, 1.3}, {.1, .1, 1.3}, {.3, 0, 1.3}}};
    EXPECT_EQ(visible_of(GetParam(), {left, right}), (List{0, 1}));
    // Behind the near half of `right`, and before the far half of `left` where that is hidden.
    EXPECT_EQ(visible_of(GetParam(), {left, right, low}), (List{0, 1}));
    EXPECT_EQ(visible_of(GetParam(), {left, low}), (List{0}));
}

// Pixel by pixel in double precision; pixels near an edge or where two triangles are as near are
// left to either.
TEST_P(TransferVisible, TrianglesAreThoseOfDoublePrecision) {
    const BuildOptions how{.math = GetParam()};
    test::Random random(12);
    for (const int size : {8, 32, 128}) {
        MaskOptions masks;
        masks.size = size;
        masks.block = size == 128 ? 4 : 2;
        std::vector<Triangle> triangles;
        for (int i = 0; i < 150; ++i) triangles.push_back(test::random_triangle(random));
        const Drawn drawn = test::draw_masks(Blockers(triangles), {}, masks, how);
        const List list = of_receiver(sets_of(drawn, add_seen(drawn, {}, how)), 0);
        const std::set<cl_uint> seen(list.begin(), list.end());
        std::set<cl_uint> certain, possible;
        for (const test::Pixel& pixel : test::disc_pixels(size)) {
            std::vector<std::pair<double, cl_uint>> inside;  // by distance
            bool doubtful = false;
            for (cl_uint t = 0; t < triangles.size(); ++t) {
                const double margin = test::inside(triangles[t], {}, pixel.direction);
                if (margin < -1e-5) continue;
                if (margin < 1e-5) {
                    doubtful = true;
                    possible.insert(t);
                    continue;
                }
                const Triangle& c = triangles[t];
                const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
                inside.emplace_back(glm::dot(n, c[0]) / glm::dot(n, pixel.direction), t);
            }
            std::sort(inside.begin(), inside.end());
            for (const auto& [distance, t] : inside)
                if (distance < inside[0].first * 1.001) possible.insert(t);
            if (!inside.empty() && !doubtful &&
                (inside.size() == 1 || inside[1].first > 1.001 * inside[0].first))
                certain.insert(inside[0].second);
        }
        EXPECT_GT(certain.size(), size == 8 ? 3u : 15u) << size;
        EXPECT_LT(possible.size(), 120u) << size;
        for (const cl_uint t : certain) EXPECT_TRUE(seen.count(t)) << t << " at " << size;
        for (const cl_uint t : seen) EXPECT_TRUE(possible.count(t)) << t << " at " << size;
    }
}

Blockers singles_of(const Blockers& all, const VisibleSets& sets) {
    Blockers out = all;
    out.lists = {0, 0};
    out.ranges = {0, 0};
    out.receivers_per_list = ~0u;
    out.near_lists = sets.near_lists;
    out.near = sets.near;
    return out;
}

TEST_P(TransferVisible, TrianglesDrawTheMasksOfAll) {
    const MaskHeap heap;
    for (const int size : {8, 32, 64}) {
        MaskOptions masks;
        masks.size = size;
        std::vector<cl_uint> first;
        for (const int width : test::widths()) {
            if (size != 32 && width != test::widths().back()) continue;
            const BuildOptions how{.math = GetParam(), .packet_width = width};
            const Drawn whole = test::draw_masks(heap.blockers, heap.eyes, masks, how);
            const std::vector<cl_uint> bits = add_seen(whole, {}, how);
            const VisibleSets sets = sets_of(whole, bits);
            EXPECT_LT(sets.near.size(), 37u * 100u);
            test::expect_same_masks(
                test::draw_masks(singles_of(heap.blockers, sets), heap.eyes, masks, how), whole,
                std::to_string(size));
            if (first.empty()) first = bits;
            EXPECT_EQ(bits, first) << width << " lanes";
        }
    }
}

// Singles are looked at like clusters: half of the triangles as these and half as those.
TEST_P(TransferVisible, TrianglesMayBeSingles) {
    MaskHeap heap;
    for (const int width : test::widths()) {
        const BuildOptions how{.math = GetParam(), .packet_width = width};
        heap.blockers.ranges.clear();
        heap.blockers.near_lists.clear();
        heap.blockers.near.clear();
        const Drawn whole = test::draw_masks(heap.blockers, heap.eyes, {}, how);
        const std::vector<cl_uint> wanted = add_seen(whole, {}, how);
        heap.blockers.ranges = {0, 2};
        heap.blockers.near_lists = {0};
        for (cl_uint i = 0; i < 37; ++i) {
            for (cl_uint t = 128; t < 200; ++t)
                if (i % 3 != 0) heap.blockers.near.push_back(t);
            heap.blockers.near_lists.push_back(static_cast<cl_uint>(heap.blockers.near.size()));
        }
        const Drawn half = test::draw_masks(heap.blockers, heap.eyes, {}, how);
        const std::vector<cl_uint> found = add_seen(half, {}, how);
        for (std::size_t word = 0; word < 7; ++word)
            for (std::size_t i = 0; i < 37; ++i) {
                const std::size_t at = word * whole.receivers.stride + i;
                if (i % 3 != 0) {
                    EXPECT_EQ(found[at], wanted[at]) << i;
                } else if (word >= 4) {
                    EXPECT_EQ(found[at], 0u) << i;
                }
            }
        const VisibleSets sets = sets_of(half, found);
        test::expect_same_masks(
            test::draw_masks(singles_of(heap.blockers, sets), heap.eyes, {}, how), half, "singles");
    }
}

// Ten receivers a list of clusters: what is in no list is not seen.
TEST_P(TransferVisible, TrianglesAreThoseOfTheReceiversList) {
    const BuildOptions how{.math = GetParam()};
    MaskHeap heap;
    heap.blockers.receivers_per_list = 10;
    heap.blockers.lists = {0, 1, 3, 3, 4};
    heap.blockers.ranges = {1, 2, 3, 1, 0, 1, 0, 1};
    const Drawn some = test::draw_masks(heap.blockers, heap.eyes, {}, how);
    const VisibleSets sets = sets_of(some, add_seen(some, {}, how));
    const std::set<cl_uint> wanted[] = {{1, 2}, {0, 3}, {}, {0}};
    for (std::size_t i = 0; i < 37; ++i)
        for (const cl_uint t : of_receiver(sets, i))
            EXPECT_TRUE(wanted[i / 10].count(t / BLOCKER_CLUSTER)) << i;
    test::expect_same_masks(test::draw_masks(singles_of(heap.blockers, sets), heap.eyes, {}, how),
                            some, "lists");
}

// Bits of several frames add up; their sets draw the masks of every frame.
TEST_P(TransferVisible, TrianglesOfFramesAddUp) {
    const BuildOptions how{.math = GetParam()};
    std::vector<MaskHeap> frames(3);
    for (std::size_t f = 0; f < frames.size(); ++f)
        for (std::size_t i = 0; i < frames[f].blockers.positions.size(); ++i)
            frames[f].blockers.positions[i] +=
                0.2f * static_cast<float>(f) * glm::vec4(std::sin(i / 3), std::cos(i / 3), 0, 0);
    std::vector<cl_uint> bits;
    std::vector<Drawn> whole;
    std::size_t least = 0;
    for (const MaskHeap& frame : frames) {
        whole.push_back(test::draw_masks(frame.blockers, frame.eyes, {}, how));
        bits = add_seen(whole.back(), bits, how);
        const std::size_t size = sets_of(whole.back(), bits).near.size();
        EXPECT_GT(size, least);
        least = size;
    }
    const VisibleSets sets = sets_of(whole[0], bits);
    for (std::size_t f = 0; f < frames.size(); ++f)
        test::expect_same_masks(
            test::draw_masks(singles_of(frames[f].blockers, sets), frames[f].eyes, {}, how),
            whole[f], "frame " + std::to_string(f));
}

// Triangles seen edge-on, at the eye, huge, tiny and none at all: the masks stay the same.
TEST_P(TransferVisible, TrianglesOfOddShapesAreNotLost) {
    const BuildOptions how{.math = GetParam()};
    MaskHeap heap;
    test::Random random(31);
    for (int i = 0; i < 200; ++i) {
        const auto far = static_cast<float>(std::pow(10.0, random(-9, 9)));
        const auto flat = static_cast<float>(std::pow(10.0, random(-9, 0)));
        for (int k = 0; k < 3; ++k) {
            glm::vec4& p = heap.blockers.positions[3 * i + k];
            p = glm::vec4(far * p.x, far * p.y, far * flat * p.z, 1.0f);
        }
    }
    for (int i = 0; i < 37; ++i) heap.eyes.positions[i] = glm::vec4(0, 0, i % 2 ? 1e-7f : 0.0f, 1);
    heap.blockers.positions[30].x = std::numeric_limits<float>::infinity();
    const Drawn whole = test::draw_masks(heap.blockers, heap.eyes, {}, how);
    const VisibleSets sets = sets_of(whole, add_seen(whole, {}, how));
    EXPECT_GT(sets.near.size(), 37u);
    test::expect_same_masks(test::draw_masks(singles_of(heap.blockers, sets), heap.eyes, {}, how),
                            whole, "odd shapes");
}

TEST(TransferVisibleInputs, OfTooFewBytesAreRefused) {
    const MaskHeap heap;
    const Drawn drawn = test::draw_masks(heap.blockers, heap.eyes);
    const MaskPasses& passes = test::mask_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer scratch = test::upload(std::vector<cl_uint>(1 << 16));
    const auto see = [&](const ReceiverBuffers& r, const BlockerBuffers& b) {
        passes.visible(queue, r, b, scratch, scratch);
    };
    test::expect_refusals({
        {"transfer.visible", "heights", 32 * 32 * 4,
         [&](const cl::Buffer& x) {
             passes.visible(queue, drawn.receivers, drawn.blockers, x, scratch);
         }},
        {"transfer.visible", "seen", 7 * std::size_t{drawn.receivers.stride} * 4,
         [&](const cl::Buffer& x) {
             passes.visible(queue, drawn.receivers, drawn.blockers, scratch, x);
         }},
    });
    BlockerBuffers near = drawn.blockers;
    near.near_lists = test::upload(std::vector<cl_uint>(38));
    near.near = scratch;
    EXPECT_NO_THROW(see(drawn.receivers, near));
    near.near_lists = test::empty<cl_uint>(37);
    EXPECT_THROW(see(drawn.receivers, near), Error);
    near.near_lists = cl::Buffer();
    EXPECT_THROW(see(drawn.receivers, near), Error);
    BlockerBuffers b = drawn.blockers;
    b.receivers_per_list = 0;
    EXPECT_THROW(see(drawn.receivers, b), Error);
    for (cl::Buffer BlockerBuffers::*which : {&BlockerBuffers::lists, &BlockerBuffers::ranges,
                                              &BlockerBuffers::boxes, &BlockerBuffers::corners}) {
        b = drawn.blockers;
        b.*which = test::empty<char>(4);
        EXPECT_THROW(see(drawn.receivers, b), Error);
    }
    ReceiverBuffers r = drawn.receivers;
    r.planes = test::empty<char>(4);
    EXPECT_THROW(see(r, drawn.blockers), Error);
    r = drawn.receivers;
    r.count = 0;
    r.stride = 0;
    EXPECT_NO_THROW(see(r, drawn.blockers));
    EXPECT_NO_THROW(passes.build({"visible", "visible_near"}));
}

// ---- lists of bits -----------------------------------------------------------------------------

TEST(VisibleSets, ListBitsAndRingsOnce) {
    // 3 receivers, a stride of 4, 70 triangles; the word of no receiver is not looked at.
    std::vector<std::uint32_t> seen(12, 0);
    seen[0] = 1u | 1u << 31;
    seen[4] = 1u;
    seen[8 + 2] = 1u << 5;
    seen[3] = seen[7] = 0xffffffffu;
    const VisibleSets alone = visible_sets(seen, 3, 4, 70);
    EXPECT_EQ(alone.near_lists, (List{0, 3, 3, 4}));
    EXPECT_EQ(alone.near, (List{0, 31, 32, 69}));
    const VisibleSets rings{{0, 3, 4, 4}, {32, 2, 31, 69}};
    const VisibleSets both = visible_sets(seen, 3, 4, 70, rings);
    EXPECT_EQ(both.near_lists, (List{0, 4, 5, 6}));
    EXPECT_EQ(both.near, (List{0, 2, 31, 32, 69, 69}));
    EXPECT_EQ(visible_sets({}, 0, 0, 0).near_lists, (List{0}));
}

TEST(VisibleSets, RefuseArraysOfOtherSizes) {
    const auto text = [](std::size_t words, std::uint32_t stride, const VisibleSets& rings) {
        try {
            visible_sets(std::vector<std::uint32_t>(words), 2, stride, 33, rings);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(text(4, 2, {}), "");
    EXPECT_EQ(text(3, 2, {}), "visible_sets: seen holds 3 words, 4 needed");
    EXPECT_EQ(text(4, 1, {}), "visible_sets: stride is 1, at least 2 needed");
    EXPECT_EQ(text(4, 2, {{0, 1}, {0}}), "visible_sets: rings have 2 places, 3 needed");
    EXPECT_EQ(text(4, 2, {{0, 1, 0}, {0}}),
              "visible_sets: the ring of receiver 1 ends before it begins");
    EXPECT_EQ(text(4, 2, {{0, 1, 2}, {0}}),
              "visible_sets: rings end at 2, there are 1 triangles in them");
    EXPECT_EQ(text(4, 2, {{0, 0, 1}, {33}}),
              "visible_sets: a ring names triangle 33, there are 33");
}

}  // namespace
}  // namespace clgi
