// Checks that end where an asked error is decided.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <vector>

#include "furnace.hpp"

namespace clgi {
namespace {

using reference::PathTracer;
using reference::Verification;
using reference::VerifyOptions;

using Radiance = std::vector<glm::vec3>;

// An error above or below the one that is asked for: two looks of eight, where all samples would
// say the same.
TEST(VerifyEarly, EndsWhereItIsDecided) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, 1.1f * box.radiance);
    for (const double decide : {0.05, 0.2}) {
        VerifyOptions options;
        options.decide = decide;
        const Verification found = PathTracer(box.scene).verify(box.camera, Furnace::width,
                                                                Furnace::height, picture, options);
        EXPECT_NEAR(found.error.value, 0.1, 0.02);
        EXPECT_NEAR(found.samples, 1000.0 * 16 + 3 * 128 * 8, 0.1 * 1000 * 16) << decide;
    }
}

// What little a first pass knows of an error near 0 does not leave it with few pixels.
TEST(VerifyEarly, DecidesByManyPixels) {
    Furnace box;
    box.scene.materials.back().emission *= 300.0f;
    const Radiance picture(Furnace::width * Furnace::height, 300.0f * box.radiance);
    VerifyOptions options;
    options.seconds = 4.0;
    options.decide = 0.1;
    const Verification found =
        PathTracer(box.scene).verify(box.camera, Furnace::width, Furnace::height, picture, options);
    EXPECT_LT(found.error.high, 0.1);
    EXPECT_GT(found.pixels, 800);
}

// Three passes of four pixels come before the result, and three more for what is hard to decide.
TEST(VerifyEarly, LearnsOnceMoreForWhatIsHard) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, box.radiance);
    for (const bool hard : {false, true}) {
        VerifyOptions options;
        options.seconds = 0.2;
        options.pixels = 16;
        options.decide = hard ? 1e-4 : 10.0;
        EXPECT_EQ(PathTracer(box.scene)
                      .verify(box.camera, Furnace::width, Furnace::height, picture, options)
                      .pixels,
                  16 + (hard ? 24 : 12));
    }
}

}  // namespace
}  // namespace clgi
