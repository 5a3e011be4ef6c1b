// Lobes narrower than a cell, and those that have no direction; planes too large for 32 bits.
// SPDX-License-Identifier: MIT
#include <functional>
#include <limits>

#include "mask_tools.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Drawn;
using test::Eyes;

using test::nan;

CLGI_IN_BOTH_MATHS(Gloss);

// Three receivers beside each other, nothing around them.
struct Glossy {
    explicit Glossy(const MaskOptions& masks, const BuildOptions& options) : how(options) {
        Eyes eyes;
        eyes.positions = {{0, 0, 0, 1}, {0.5f, 0.25f, 0, 1}, {-1, 0, 0.125f, 1}};
        eyes.normals = {{0, 0, 1, 0}, {0.2f, -0.1f, 0.9f, 0}, {0, 0.6f, 0.8f, 0}};
        drawn = test::draw_masks({}, eyes, masks, how);
        const MaskWeights weights = mask_weights(masks.size, masks.block);
        values = test::upload(weights.values);
        directions = test::upload(weights.directions);
    }

    // [25][stride], 0 where no receiver is.
    std::vector<float> lobes(const glm::vec3& eye, const std::vector<float>& exponents) const {
        return lobes(glm::vec4(eye, 0.0f), exponents);
    }
    std::vector<float> lobes(const glm::vec4& eye, std::vector<float> exponents) const {
        exponents.resize(drawn.receivers.stride);
        const cl::Buffer out = test::empty<float>(25 * std::size_t{drawn.receivers.stride});
        passes().integrate_gloss(test::device().queue, drawn.receivers, values, directions,
                                 test::upload(exponents), eye, out);
        auto found = test::download<float>(out, 25 * std::size_t{drawn.receivers.stride});
        for (std::size_t i = 0; i < found.size(); ++i)
            if (i % drawn.receivers.stride >= drawn.receivers.count) found[i] = 0.0f;
        return found;
    }
    const MaskPasses& passes() const { return test::mask_passes(drawn.options, how); }

    BuildOptions how;
    Drawn drawn;
    cl::Buffer values, directions;
};

void expect_lost(const Glossy& glossy, const std::vector<float>& found,
                 const std::vector<float>& wanted, std::size_t which, const std::string& label) {
    const std::uint32_t stride = glossy.drawn.receivers.stride;
    for (std::size_t k = 0; k < 25; ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            if (i == which)
                EXPECT_TRUE(std::isnan(found[k * stride + i])) << label << ", term " << k;
            else
                EXPECT_EQ(found[k * stride + i], wanted[k * stride + i]) << label << ", " << i;
        }
    const cl::Buffer counted = test::upload(std::vector<cl_uint>{0});
    glossy.passes().shade(test::device().queue, glossy.drawn.receivers, test::upload(found),
                          test::upload(std::vector<glm::vec4>(25, glm::vec4(1.0f))), SHADE_CLAMP,
                          test::empty<float>(3 * std::size_t{stride}), counted);
    EXPECT_EQ(test::download<cl_uint>(counted, 1)[0], 1u) << label;
}

// Cells are 2 / 8 wide, so exponents end at 2 / (1 / 4)^2 = 32.
TEST_P(Gloss, OfLobesNarrowerThanACellIsThatOfACell) {
    const Glossy glossy({.size = 32, .block = 4}, {.math = GetParam()});
    const glm::vec3 eye(0.3f, -0.2f, 2.0f);
    const auto cell = glossy.lobes(eye, {32, 32, 32});
    EXPECT_EQ(glossy.lobes(eye, {1000, 33, std::numeric_limits<float>::infinity()}), cell);
    const auto wider = glossy.lobes(eye, {31, 31, 31});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NE(wider[i], cell[i]) << i;
}

TEST_P(Gloss, WithoutADirectionIsNoNumber) {
    for (const int width : test::widths()) {
        const Glossy glossy({}, {.math = GetParam(), .packet_width = width});
        const std::string lanes = std::to_string(width) + " lanes";
        const glm::vec3 eye(0.5f, 0.25f, 0);  // the second receiver's own place
        const std::vector<float> found = glossy.lobes(eye, {3, 3, 3});
        const std::uint32_t stride = glossy.drawn.receivers.stride;
        for (const std::size_t i : {0u, 2u}) EXPECT_TRUE(std::isfinite(found[i])) << lanes;
        for (std::size_t k = 0; k < 25; ++k) EXPECT_TRUE(std::isnan(found[k * stride + 1])) << k;
        expect_lost(glossy, found, found, 1, lanes + ", eye at the receiver");
        const glm::vec3 above(0.3f, -0.2f, 2.0f);
        const std::vector<float> sound = glossy.lobes(above, {3, 4, 5});
        expect_lost(glossy, glossy.lobes(above, {3, nan, 5}), sound, 1, lanes + ", exponent");
        for (const float far : {nan, 1e25f, std::numeric_limits<float>::infinity()}) {
            const std::vector<float> lost = glossy.lobes({0, 0, far}, {3, 4, 5});
            for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(lost[i])) << lanes << far;
        }
    }
}

// A direction to the eye gives each receiver what an eye at that place from it would, near or far.
TEST_P(Gloss, OfADirectionIsThatOfAnEyeThere) {
    const glm::vec3 direction(0.3f, -0.2f, 2.0f);
    for (const int width : {1, 0}) {
        const Glossy glossy({}, {.math = GetParam(), .packet_width = width});
        const std::uint32_t stride = glossy.drawn.receivers.stride;
        const auto found = glossy.lobes(glm::vec4(direction, 1.0f), {3, 4, 5});
        const glm::vec3 places[] = {{0, 0, 0}, {0.5f, 0.25f, 0}, {-1, 0, 0.125f}};
        for (std::size_t i = 0; i < 3; ++i)
            for (const float away : {1.0f, 64.0f}) {
                const auto wanted = glossy.lobes(places[i] + away * direction, {3, 4, 5});
                for (std::size_t k = 0; k < 25; ++k)
                    EXPECT_NEAR(found[k * stride + i], wanted[k * stride + i], 2e-5f)
                        << i << ", " << k << ", " << away;
            }
    }
}

// Receivers of pixels that show nothing have frames of zeros at the origin. An eye there loses
// nothing.
TEST_P(Gloss, OfNoSurfaceIsNothing) {
    for (const int width : {1, 0}) {
        const Glossy glossy({}, {.math = GetParam(), .packet_width = width});
        const std::uint32_t stride = glossy.drawn.receivers.stride;
        auto planes = test::download<float>(glossy.drawn.receivers.planes,
                                            RECEIVER_PLANES * std::size_t{stride});
        for (std::size_t k = 0; k < RECEIVER_PLANES; ++k) planes[k * stride + 1] = 0.0f;
        test::device().queue.enqueueWriteBuffer(glossy.drawn.receivers.planes, CL_TRUE, 0,
                                                planes.size() * sizeof(float), planes.data());
        const auto found = glossy.lobes(glm::vec3(0, 0, 0), {3, 0, 5});
        for (std::size_t k = 0; k < 25; ++k) {
            EXPECT_TRUE(std::isnan(found[k * stride])) << k;  // a surface at the eye
            EXPECT_EQ(found[k * stride + 1], 0.0f) << k;
            EXPECT_TRUE(std::isfinite(found[k * stride + 2])) << k;
        }
    }
}

std::string refusal(const std::function<void()>& call) {
    try {
        call();
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

// Places are computed in 32 bits; buffers are not looked at before.
TEST(TransferPlanes, OfMoreThan32BitsAreRefused) {
    const MaskPasses& passes = test::mask_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer any = test::empty<float>(16);
    ReceiverBuffers r;
    r.planes = r.masks = r.transfer = any;
    BlockerBuffers b;
    b.corners = b.boxes = b.lists = b.ranges = any;
    r.count = r.stride = 1u << 29;
    EXPECT_EQ(refusal([&] { passes.receivers(queue, any, any, r, any); }),
              "transfer.receivers: receivers has 12 planes of 536870912, at most 2^32 numbers "
              "needed");
    r.count = r.stride = (1u << 27) + 16;  // 32 words a mask
    const std::string masks = ": masks has 32 planes of 134217744, at most 2^32 numbers needed";
    EXPECT_EQ(refusal([&] { passes.mask(queue, r, b, any); }), "transfer.mask" + masks);
    EXPECT_EQ(refusal([&] { passes.integrate(queue, r, any, any); }), "transfer.integrate" + masks);
    r.count = r.stride = 1u << 28;
    EXPECT_EQ(refusal([&] { passes.shade(queue, r, any, any, 0, any, any); }),
              "transfer.shade: transfer has 25 planes of 268435456, at most 2^32 numbers needed");
    r.count = r.stride = 1u << 27;
    EXPECT_NE(refusal([&] { passes.mask(queue, r, b, any); }).find("bytes"), std::string::npos);
    b.triangle_count = b.stride = 1u << 29;
    EXPECT_EQ(refusal([&] { passes.blockers(queue, any, any, b, any); }),
              "transfer.blockers: corners has 9 planes of 536870912, at most 2^32 numbers needed");
}

}  // namespace
}  // namespace clgi
