// The tree of an irradiance cache, walked on the host as the kernels walk it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "device.hpp"
#include "math_modes.hpp"
#include "methods/irradiance_cache/records.hpp"
#include "patchwork.hpp"
#include "planted.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

std::uint32_t way_of(const glm::vec3& n) {
    int axis = 0;
    for (int c = 1; c < 3; ++c)
        if (std::abs(n[c]) > std::abs(n[axis])) axis = c;
    return static_cast<std::uint32_t>(2 * axis + (n[axis] < 0.0f ? 1 : 0));
}

std::vector<std::uint32_t> listed_at(const test::Planted& planted, const glm::vec3& p,
                                     const glm::vec3& n) {
    const RecordTree& tree = planted.tree;
    glm::vec3 centre = tree.centre;
    float half = tree.half_side;
    std::uint32_t node = tree.nodes[0];
    while (!(node & CACHE_LEAF)) {
        half *= 0.5f;
        std::uint32_t child = 0;
        for (int c = 0; c < 3; ++c) {
            const bool high = p[c] > centre[c];
            child |= high ? 1u << c : 0u;
            centre[c] += high ? half : -half;
        }
        node = tree.nodes[node + child];
    }
    const std::size_t first =
        (std::size_t{node & ~CACHE_LEAF} * CACHE_WAYS + way_of(n)) * CACHE_LISTED;
    return {planted.lists.begin() + static_cast<std::ptrdiff_t>(first),
            planted.lists.begin() + static_cast<std::ptrdiff_t>(first) + CACHE_LISTED};
}

// Records on the inside of a box with very different sides, dense in one corner.
std::vector<CacheRecord> in_a_box(int count) {
    test::Random random(7);
    std::vector<CacheRecord> out;
    for (int i = 0; i < count; ++i) {
        const int axis = i % 3;
        const bool high = i % 2 == 0;
        glm::vec3 p(random(0, 1), random(0, 1), random(0, 1)), n(0.0f);
        if (i % 5 == 0) p *= 0.05f;
        p[axis] = high ? 1.0f : 0.0f;
        n[axis] = high ? -1.0f : 1.0f;
        p *= glm::vec3(40.0f, 3.0f, 5.0f);
        out.push_back({p, n, n});
    }
    return out;
}

TEST(CacheTree, ListsARecordWhereItStands) {
    const std::vector<CacheRecord> records = in_a_box(1000);
    const test::Planted planted(records);
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        const auto near = listed_at(planted, records[i].position, records[i].normal);
        EXPECT_TRUE(std::find(near.begin(), near.end(), i) != near.end()) << i;
    }
}

// The nearest of those that face the same way, from any place on a wall.
TEST(CacheTree, ListsTheNearestRecord) {
    const std::vector<CacheRecord> records = in_a_box(1000);
    const test::Planted planted(records);
    int found = 0;
    const std::vector<CacheRecord> places = in_a_box(1500);
    for (std::size_t k = 1000; k < places.size(); ++k) {
        std::uint32_t nearest = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < records.size(); ++i) {
            if (glm::dot(records[i].normal, places[k].normal) < 0.9f) continue;
            const float apart = glm::distance(records[i].position, places[k].position);
            if (apart < least) {
                least = apart;
                nearest = i;
            }
        }
        const auto near = listed_at(planted, places[k].position, places[k].normal);
        found += std::find(near.begin(), near.end(), nearest) != near.end();
    }
    EXPECT_GE(found, 490);  // of 500; the list is that of the leaf's centre
}

// At centres of leaves: no record that is left out counts as nearer than one that is listed, among
// all that face the way.
TEST(CacheTree, LeavesOutNoneThatIsNearer) {
    std::vector<CacheRecord> records = in_a_box(700);
    test::Random random(9);
    for (CacheRecord& record : records)  // few are parallel to an axis
        record.normal =
            glm::normalize(record.normal + glm::vec3(test::random_vec3(random, -0.6, 0.6)));
    const test::Planted planted(records);
    for (int k = 0; k < 3000; ++k) {
        const CacheRecord& about = records[static_cast<std::size_t>(random.integer(0, 699))];
        const glm::vec3 p = about.position + glm::vec3(test::random_vec3(random, -1, 1));
        const glm::vec3 n(test::random_vec3(random, -1, 1));
        const RecordTree& tree = planted.tree;
        glm::vec3 centre = tree.centre;
        double half = tree.half_side;
        for (std::uint32_t node = tree.nodes[0]; !(node & CACHE_LEAF);) {
            half *= 0.5;
            std::uint32_t child = 0;
            for (int c = 0; c < 3; ++c) {
                const bool high = p[c] > centre[c];
                child |= high ? 1u << c : 0u;
                centre[c] += static_cast<float>(high ? half : -half);
            }
            node = tree.nodes[node + child];
        }
        const auto distance = [&](std::uint32_t i) {
            const glm::dvec3 d = glm::dvec3(centre) - glm::dvec3(records[i].position);
            const double off = std::abs(glm::dot(d, glm::dvec3(records[i].normal)));
            return glm::dot(d, d) + 16.0 * std::pow(std::max(off - 1.7 * half, 0.0), 2.0);
        };
        const std::uint32_t way = way_of(n);
        std::vector<double> all, found;
        for (std::uint32_t i = 0; i < records.size(); ++i) {
            const float along = records[i].normal[static_cast<int>(way / 2)];
            if ((way % 2 == 0 ? along : -along) > 0.1f) all.push_back(distance(i));
        }
        std::sort(all.begin(), all.end());
        for (const std::uint32_t i : listed_at(planted, p, n))
            if (i != CACHE_NONE) found.push_back(distance(i));
        ASSERT_EQ(found.size(), std::min<std::size_t>(all.size(), CACHE_LISTED));
        for (std::size_t i = 0; i < found.size(); ++i)
            ASSERT_NEAR(found[i], all[i], 1e-5 * (1.0 + all[i])) << k << ", " << i;
    }
}

// The library's walk and the one above, at corners of leaves and for normals of any length and way.
TEST(CacheTree, IsWalkedAsKernelsDo) {
    const std::vector<CacheRecord> records = in_a_box(400);
    const test::Planted planted(records);
    test::Random random(8);
    for (int i = 0; i < 2000; ++i) {
        CacheRecord place = records[static_cast<std::size_t>(random.integer(0, 399))];
        if (i % 3 == 0) place.position = planted.tree.centre;
        if (i % 3 == 1) place.position = test::random_vec3(random, -1.0, 41.0);
        place.normal = test::random_vec3(random, -2.0, 2.0);
        if (i % 4 == 0) place.normal = {1.0f, -1.0f, i % 8 == 0 ? 1.0f : -1.0f};
        const auto wanted = listed_at(planted, place.position, place.normal);
        EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), planted.listed(place))) << i;
    }
}

TEST(CacheTree, TakesRecordsInOnePlace) {
    const std::vector<CacheRecord> records(40, {{1, 2, 3}, {0, 1, 0}, {0, 1, 0}});
    const test::Planted planted(records);
    const auto near = listed_at(planted, {1, 2, 3}, {0, 1, 0});
    EXPECT_NE(near[CACHE_LISTED - 1], CACHE_NONE);
    EXPECT_EQ(listed_at(planted, {1, 2, 3}, {0, -1, 0})[0], CACHE_NONE);
}

// For packets of every width; of equals, of which there are many here, the first ones.
TEST(CacheTree, HasTheSameListsForEveryWidth) {
    std::vector<CacheRecord> records;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 n(0, i % 3 == 0 ? -1 : 1, 0);
        records.push_back({glm::vec3(i % 10, i % 2, i / 30), n, n});
    }
    const test::Planted wanted(records);
    for (const int width : {1, 4, 8, 16}) {
        const test::Planted planted(records, {.packet_width = width, .local_size = 3});
        EXPECT_EQ(planted.lists, wanted.lists) << width;
    }
    for (const auto& [p, up] :
         {std::pair(glm::vec3(4, 0, 5), 1), std::pair(glm::vec3(0, 1, 9), -1)}) {
        const auto list = listed_at(wanted, p, {0, up, 0});
        const auto place = [&](std::uint32_t i) { return records[i].position; };
        for (std::size_t k = 1; k < list.size(); ++k)
            if (place(list[k]) == place(list[k - 1])) {
                EXPECT_LT(list[k - 1], list[k]) << k;
            }
    }
}

TEST(CacheTree, RefusesBuffersThatAreTooSmall) {
    const RecordTree tree = make_tree(in_a_box(40));
    const CachePasses passes(test::programs(), test::usual_build());
    const CachePasses::Crowds whole = {test::upload(tree.leaves), test::upload(tree.records),
                                       test::upload(tree.order), test::upload(tree.boxes)};
    const std::size_t words = tree.leaves.size() * CACHE_WAYS * CACHE_LISTED;
    const cl::Buffer lists = test::empty<std::uint32_t>(words), tiny = test::empty<float>(1);
    const cl::CommandQueue& queue = test::device().queue;
    EXPECT_NO_THROW(passes.list(queue, tree.params, whole, lists).wait());
    using Crowds = CachePasses::Crowds;
    for (cl::Buffer Crowds::*small :
         {&Crowds::leaves, &Crowds::records, &Crowds::order, &Crowds::boxes}) {
        Crowds wrong = whole;
        wrong.*small = tiny;
        EXPECT_THROW(passes.list(queue, tree.params, wrong, lists), Error);
    }
    EXPECT_THROW(passes.list(queue, tree.params, whole, tiny), Error);
    for (std::uint32_t CacheListParams::*of :
         {&CacheListParams::record_count, &CacheListParams::stride,
          &CacheListParams::crowd_stride}) {
        CacheListParams wrong = tree.params;
        wrong.*of = 0;
        EXPECT_THROW(passes.list(queue, wrong, whole, lists), Error);
    }
}

// Two walls in a block of pixels have a record each, a row of pixels past the edge counts too.
TEST(CacheRecords, OfAPictureStandOnEachOfItsPlanes) {
    constexpr int width = 13, height = 7;
    std::vector<CacheRecord> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec3 n = x < 5 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
            const glm::vec3 p = x < 5 ? glm::vec3(0, y, 5 - x) : glm::vec3(x - 5, y, 0);
            pixels.push_back(y == 6 && x == 12 ? CacheRecord{} : CacheRecord{p, n, n});
        }
    const std::vector<CacheRecord> one = seen_records(pixels, width, height, 1);
    ASSERT_GE(one.size(), 2u);
    int left = 0, right = 0;
    for (const CacheRecord& record : one) (record.normal.x > 0.5f ? left : right)++;
    EXPECT_GE(left, 1);
    EXPECT_GE(right, 1);
    EXPECT_EQ(seen_records(pixels, width, height, 1000).size(), std::size_t{width * height - 1});
}

TEST(CacheRecords, KeepApart) {
    std::vector<CacheRecord> records = {{{0, 1, 0}, {0, -1, 0}, {0, -1, 0}}};
    std::vector<CacheRecord> candidates;
    for (int i = 0; i < 200; ++i) {
        const float x = static_cast<float>(i % 20) * 0.1f, z = static_cast<float>(i / 20) * 0.1f;
        candidates.push_back({{x, 0, z}, {0, 1, 0}, {0, 1, 0}});
    }
    candidates.push_back({});  // the ray left the scene
    const std::vector<std::size_t> viewers(candidates.size(), 0);
    add_records(records, candidates, viewers, 5);
    ASSERT_EQ(records.size(), 6u);
    for (std::size_t i = 1; i < records.size(); ++i)
        for (std::size_t j = 1; j < i; ++j)
            EXPECT_GE(glm::distance(records[i].position, records[j].position), 0.3f);
    add_records(records, candidates, viewers, 1000);
    EXPECT_LE(records.size(), 201u);
}

// One in each block with doubt, at the pixel with most of it; blocks with more doubt come first.
TEST(CacheRecords, AreRefinedWhereDoubtIsLargest) {
    constexpr int width = 7, height = 5, side = 3;
    const auto count = static_cast<std::size_t>(width * height);
    std::vector<CacheRecord> pixels;
    for (std::size_t i = 0; i < count; ++i)
        pixels.push_back({glm::vec3(static_cast<float>(i)), {0, 1, 0}, {0, 1, 0}});
    std::vector<float> doubt(count, 0.0f);
    const auto at = [](int x, int y) { return static_cast<std::size_t>(y * width + x); };
    doubt[at(1, 1)] = 2.0f;
    doubt[at(2, 2)] = 3.0f;  // of the same block
    doubt[at(6, 4)] = 4.0f;  // of the last, which is 1 x 2 pixels
    doubt[at(4, 0)] = 1.0f;
    doubt[at(0, 3)] = std::numeric_limits<float>::quiet_NaN();
    doubt[at(3, 4)] = 9.0f;  // nothing is there
    pixels[at(3, 4)] = {};
    const auto places = [&](std::size_t most) {
        std::vector<float> out;
        for (const CacheRecord& record : doubtful_records(pixels, doubt, width, height, side, most))
            out.push_back(record.position.x);
        return out;
    };
    const auto place = [&](int x, int y) { return static_cast<float>(at(x, y)); };
    EXPECT_EQ(places(10), (std::vector<float>{place(2, 2), place(6, 4), place(4, 0)}));
    EXPECT_EQ(places(1), (std::vector<float>{place(2, 2)}));
    EXPECT_TRUE(places(0).empty());
}

// Doubt counts by the square of what a pixel reflects: of a black one as of glTF's dielectrics.
// Rows are longer than the picture.
TEST(CacheRecords, AreRefinedForWhatIsReflected) {
    constexpr std::size_t stride = 5;
    std::vector<float> doubt = {2.0f, 3.0f, 4.0f, 0.0f}, base(3 * stride, 9.0f);
    const glm::dvec3 colour[] = {{0.5, 0.25, 0.75}, {0.1, 0.8, 0.3}, {0, 0, 0}, {1, 1, 1}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            base[c * stride + i] = static_cast<float>(colour[i][static_cast<glm::length_t>(c)]);
    keep_what_is_reflected(doubt, base, stride);
    const double first = 0.2126 * 0.5 + 0.7152 * 0.25 + 0.0722 * 0.75,
                 second = 0.2126 * 0.1 + 0.7152 * 0.8 + 0.0722 * 0.3;
    EXPECT_NEAR(doubt[0], 2.0 * first * first, 1e-6);
    EXPECT_NEAR(doubt[1], 3.0 * second * second, 1e-6);
    EXPECT_NEAR(doubt[2], 4.0 * 0.04 * 0.04, 1e-8);
    EXPECT_EQ(doubt[3], 0.0f);
}

// Of three pixels 1 and 3 of exposed irradiance are in doubt, of what is reflected. What is not a
// number does not count.
TEST(CacheRecords, AreInDoubtByAShareOfThePicture) {
    constexpr std::size_t stride = 5;
    const float none = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> radiance(3 * stride, 1e6f), doubt = {1.0f, 9.0f, none, 0.0f};
    const glm::vec3 seen[] = {{2, 2, 2}, {4, 5, 6}, {1, 2, 3}, {0, 0, 0}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            radiance[c * stride + i] = seen[i][static_cast<glm::length_t>(c)];
    const double mean = (2.0 + 0.2126 * 4.0 + 0.7152 * 5.0 + 0.0722 * 6.0) / 3.0;
    EXPECT_NEAR(relative_doubt(doubt, radiance, stride, 8.0),
                8.0 * std::sqrt((1.0 + 9.0) / 3.0) / std::numbers::pi / mean, 1e-6);
    EXPECT_EQ(relative_doubt(doubt, std::vector<float>(3 * stride, 0.0f), stride, 8.0), 0.0);
}

// The first record shows the second alone, which shows the third, which shows itself and nothing:
// its importance is the sum of a geometric series.
TEST(CacheRecords, AreImportantByWhatTheySend) {
    WeighedPicks picks;
    picks.by_each = 2;
    picks.nearest = {1, 1, 2, 2, 2, CACHE_NONE};
    picks.reflectance = {0.5f, 0.3f, 0.25f, 0.5f, 0.5f, 0.9f};
    const std::vector<double> found = importance_of(3, 1, picks);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0], 1.0);
    EXPECT_NEAR(found[1], 0.4, 1e-7);
    EXPECT_NEAR(found[2], 0.4 * 0.375 / (1.0 - 0.25), 1e-4);
    picks.nearest = {};
    picks.reflectance = {};
    EXPECT_EQ(importance_of(4, 4, picks), std::vector<double>(4, 0.25));
}

// Two cells: by doubt alone the second would be split first, but only it sees what is in doubt.
TEST(CacheRecords, SplitTheCellThatIsWorthMost) {
    const glm::vec3 up(0, 1, 0);
    const std::vector<CacheRecord> first = {{{0, 0, 0}, up, up}, {{10, 0, 0}, up, up}};
    const auto at = [&](float x) { return CacheRecord{{x, 0, 0}, up, up}; };
    WeighedPicks picks;
    picks.by_each = 3;
    picks.places = {at(1), at(2), at(-1.5f), at(11), at(12), {}};
    picks.reflectance.assign(6, 0.5f);
    picks.worth = {4.0f, 2.0f, 1.0f, 100.0f, 50.0f, 0.0f};
    picks.nearest = {0, 0, 0, 1, 1, CACHE_NONE};
    const auto places = [&](std::size_t count) {
        std::vector<CacheRecord> records = first;
        split_cells(records, 1, picks, count);
        std::vector<float> out;
        for (std::size_t i = 2; i < records.size(); ++i) out.push_back(records[i].position.x);
        return out;
    };
    // Times their squared distances: 4, 8 and 2.25; after the pick at 2 those are 4, 0 and 2.25.
    EXPECT_EQ(places(1), (std::vector<float>{2}));
    EXPECT_EQ(places(10), (std::vector<float>{2, 1, -1.5f}));
    EXPECT_TRUE(places(0).empty());
    // The second cell is worth 6 and the first 5; a split leaves 3. Then 20, of which 10 are left.
    picks.nearest = {0, 1, 1, 1, 1, CACHE_NONE};
    picks.places = {at(1), at(9), at(8), at(11), at(12), {}};
    picks.worth = {5.0f, 2.0f, 4.0f, 0.0f, 0.0f, 0.0f};
    EXPECT_EQ(places(2), (std::vector<float>{8, 1}));
    picks.worth = {5.0f, 2.0f, 18.0f, 0.0f, 0.0f, 0.0f};
    EXPECT_EQ(places(2), (std::vector<float>{8, 9}));
    // Where no record counts, one cell for all, worth 9.8, beside 8.2 and 5.1: at first with
    // distances to the viewer of each, of which the second, at 10, has an importance of 0.17.
    picks.nearest = {CACHE_NONE, CACHE_NONE, 1, CACHE_NONE, 0, 1};
    picks.places = {at(1), at(9), at(8), at(-20), at(12), {}};
    picks.worth = {5.0f, 4.0f, 8.0f, 3.0f, 30.0f, 0.0f};
    EXPECT_EQ(places(5), (std::vector<float>{-20, 8, 12, 9, 1}));
}

}  // namespace
}  // namespace clgi
