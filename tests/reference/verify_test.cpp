// A picture checked by a few path-traced pixels, against errors that are known otherwise.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <chrono>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <limits>

#include "furnace.hpp"
#include "rooms.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

using reference::Estimate;
using reference::PathTracer;
using reference::Picture;
using reference::Place;
using reference::Verification;
using reference::VerifyOptions;

using Radiance = std::vector<glm::vec3>;

// One in twenty intervals misses the truth; half as wide again, one in three hundred.
void expect_in(const Estimate& found, double wanted, double slack) {
    const double more = 0.25 * (found.high - found.low) + 1e-6;
    EXPECT_LE(found.low, wanted + more);
    EXPECT_GE(found.high, wanted - more);
    EXPECT_NEAR(found.value, wanted, slack);
    EXPECT_LE(found.low, found.value);
    EXPECT_GE(found.high, found.value);
    EXPECT_LT(found.high - found.low, 4.0 * slack);
}

TEST(Verify, MeasuresAPictureThatIsTooBright) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, 1.1f * box.radiance);
    const Verification found =
        PathTracer(box.scene).verify(box.camera, Furnace::width, Furnace::height, picture, {});
    expect_in(found.error, 0.1, 0.006);
    expect_in(found.energy, 1.1, 0.006);
    EXPECT_GT(found.pixels, 1000);
    EXPECT_LE(found.pixels, 1000 + 3 * 128);
    EXPECT_GE(found.samples, 50u * 1000);
    EXPECT_LE(found.samples, 64u * 1000 + 3 * 128 * 8);
    EXPECT_EQ(found.non_finite, 0u);
    EXPECT_GT(found.seconds, 0.0);
    EXPECT_FALSE(found.cancelled);
}

TEST(Verify, WeighsChannelsByLuminance) {
    const Furnace box;
    for (int c = 0; c < 3; ++c) {
        glm::vec3 wrong = box.radiance;
        wrong[c] *= 0.5f;
        const double change = 0.5 * luminance_weights[c] * double{box.radiance[c]} / box.luminance;
        const Radiance picture(Furnace::width * Furnace::height, wrong);
        VerifyOptions options;
        options.seed = 12 + static_cast<std::uint64_t>(c);
        const Verification found = PathTracer(box.scene).verify(box.camera, Furnace::width,
                                                                Furnace::height, picture, options);
        expect_in(found.error, change, 0.01);
        expect_in(found.energy, 1.0 - change, 0.01);
    }
}

TEST(Verify, FindsABlockThatIsWrong) {
    const Furnace box;
    Radiance picture(Furnace::width * Furnace::height, box.radiance);
    for (int y = 4; y < 10; ++y)
        for (int x = 7; x < 15; ++x) picture[static_cast<std::size_t>(y * 40 + x)] *= 3.0f;
    const Verification found =
        PathTracer(box.scene).verify(box.camera, Furnace::width, Furnace::height, picture, {});
    const double share = 48.0 / 1200.0;
    expect_in(found.error, 2.0 * std::sqrt(share), 0.04);
    expect_in(found.energy, 1.0 + 2.0 * share, 0.02);
}

TEST(Verify, FindsNoErrorInTheTruth) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, box.radiance);
    const Verification found =
        PathTracer(box.scene).verify(box.camera, Furnace::width, Furnace::height, picture, {});
    EXPECT_EQ(found.error.low, 0.0);
    EXPECT_LT(found.error.high, 0.05);
    EXPECT_GT(found.error.high, 0.0) << "64 paths are not the truth";
    expect_in(found.energy, 1.0, 0.006);
}

TEST(Verify, LooksThroughTheSamePixels) {
    // Emission alone, without noise: every pixel that is compared with another one would show.
    const Scene scene = [] {
        Scene out = test::furnished_room(1);
        for (std::size_t m = 0; m < out.materials.size(); ++m)
            out.materials[m].emission = glm::vec3(out.materials[m].base_color) * float(m + 1);
        return out;
    }();
    const Camera camera = test::camera_at({0.2, 1.8, 0.2}, {2.5, 0.6, 2.0});
    const PathTracer tracer(scene);
    reference::Options options;
    options.width = 41;
    options.height = 23;
    options.samples = 1;
    VerifyOptions check;
    check.effects = options.effects = reference::parse_effects("emission");
    const Picture picture = tracer.render(camera, options);
    const Verification found = tracer.verify(camera, 41, 23, picture.radiance, check);
    EXPECT_LT(found.error.high, 1e-6);
    EXPECT_NEAR(found.energy.low, 1.0, 1e-6);
    EXPECT_NEAR(found.energy.high, 1.0, 1e-6);
}

TEST(Verify, MeasuresTheNoiseOfAPicture) {
    const Scene scene = test::furnished_room(3);
    const Camera camera = test::camera_at({0.2, 1.8, 0.2}, {2.5, 0.6, 2.0});
    const PathTracer tracer(scene);
    reference::Options options;
    options.width = 48;
    options.height = 36;
    options.samples = 16;
    const Picture picture = tracer.render(camera, options);
    VerifyOptions check;
    check.samples = 256;
    const Verification found = tracer.verify(camera, 48, 36, picture.radiance, check);
    EXPECT_LE(found.error.low, 1.05 * picture.relative_error);
    EXPECT_GE(found.error.high, 0.95 * picture.relative_error);
    EXPECT_NEAR(found.error.value, picture.relative_error, 0.3 * picture.relative_error);
}

struct Case {
    Scene scene;
    Camera camera;
    Radiance picture;
    double error = 0.0;
    double energy = 0.0;
};

// A converged picture with errors put into it: of every pixel, of a block, or of a few specks.
Case damaged(std::uint64_t seed, int width, int height) {
    test::Random random(seed);
    Case out;
    out.scene = test::furnished_room(seed);
    out.camera = test::camera_at({random(0.1, 0.5), random(0.8, 2.0), random(0.1, 0.5)},
                                 {3.0, random(0.5, 1.5), random(1.5, 2.5)});
    reference::Options options;
    options.width = width;
    options.height = height;
    options.samples = 512;
    options.seed = 1000 + seed;
    const Picture truth = PathTracer(out.scene).render(out.camera, options);
    out.picture = truth.radiance;
    double mean = 0.0, square = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < out.picture.size(); ++k) {
        const int x = static_cast<int>(k) % width, y = static_cast<int>(k) / width;
        if (seed % 3 == 0) out.picture[k] *= static_cast<float>(1.0 + random(-0.3, 0.4));
        if (seed % 3 == 1 && x >= 12 && x < 18 && y >= 5 && y < 10) out.picture[k] *= 0.4f;
        if (seed % 3 == 2 && k % 31 == 0) out.picture[k] *= 3.0f;
        const double light = luminance(glm::dvec3(truth.radiance[k]));
        const double change = luminance(glm::dvec3(out.picture[k])) - light;
        mean += light;
        sum += light + change;
        square += change * change + double{truth.error[k]} * double{truth.error[k]};
    }
    const auto pixels = static_cast<double>(out.picture.size());
    out.error = std::sqrt(square / pixels) / (mean / pixels);
    out.energy = sum / mean;
    return out;
}

TEST(Verify, HoldsInRandomRooms) {
    constexpr int width = 24, height = 18;
    int checks = 0, above = 0, below = 0, energy = 0;
    double width_of_energy = 0.0;
    for (std::uint64_t room = 0; room < 6; ++room) {
        const Case damage = damaged(room, width, height);
        const PathTracer tracer(damage.scene);
        VerifyOptions options;
        options.pixels = 250;
        options.samples = 16;
        for (options.seed = 1; options.seed <= 25; ++options.seed) {
            const Verification found =
                tracer.verify(damage.camera, width, height, damage.picture, options);
            ++checks;
            above += damage.error > found.error.high;
            below += damage.error < found.error.low;
            energy += damage.energy < found.energy.low || damage.energy > found.energy.high;
            width_of_energy += found.energy.high - found.energy.low;
        }
    }
    // 150 checks. Intervals that miss 2.5 % on each side miss 10 or more there in 1 of 200.
    EXPECT_LE(above, 9);
    EXPECT_LE(below, 9);
    EXPECT_LE(energy, 15);
    EXPECT_LT(width_of_energy / checks, 0.2) << "they say something";
}

TEST(Verify, IsWideWhereLightComesByRarePaths) {
    // The dark one of two chambers: most of its light has passed the slit.
    const Scene scene = test::chambers();
    const Camera camera = test::camera_at({3.8, 1.2, 2.8}, {2.2, 1.0, 0.2});
    const PathTracer tracer(scene);
    reference::Options options;
    options.width = 16;
    options.height = 12;
    options.samples = 2048;
    options.seed = 99;
    const Picture picture = tracer.render(camera, options);
    VerifyOptions few;
    few.pixels = 200;
    few.samples = 8;
    int above = 0;
    double narrowest = 1e9;
    for (few.seed = 1; few.seed <= 50; ++few.seed) {
        const Verification found = tracer.verify(camera, 16, 12, picture.radiance, few);
        above += picture.relative_error > found.error.high;
        narrowest = std::min(narrowest, found.error.high);
    }
    EXPECT_LE(above, 4);
    EXPECT_GT(narrowest, 2.0 * picture.relative_error) << "so few paths cannot know";
}

TEST(Verify, MeasuresIrradianceAtPlaces) {
    const Furnace box;
    std::vector<Place> places;
    for (int k = 0; k < 300; ++k) {
        const float side = k % 2 == 0 ? 1.0f : -1.0f;
        places.push_back({{side, 0.002 * k - 0.3, 0.1}, {-side, 0, 0}});
    }
    const Radiance lux(places.size(), 0.9f * 3.14159265f * box.radiance);
    const Verification found = PathTracer(box.scene).verify(places, lux, {});
    expect_in(found.error, 0.1, 0.006);
    expect_in(found.energy, 0.9, 0.006);
}

void expect_same(const Verification& a, const Verification& b) {
    EXPECT_EQ(a.error.value, b.error.value);
    EXPECT_EQ(a.error.low, b.error.low);
    EXPECT_EQ(a.error.high, b.error.high);
    EXPECT_EQ(a.energy.value, b.energy.value);
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.pixels, b.pixels);
}

TEST(Verify, TheSeedDecides) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, 1.1f * box.radiance);
    const PathTracer tracer(box.scene);
    VerifyOptions options;
    options.pixels = 100;
    options.samples = 16;
    const auto check = [&](std::uint64_t seed, int threads) {
        options.seed = seed;
        options.threads = threads;
        return tracer.verify(box.camera, Furnace::width, Furnace::height, picture, options);
    };
    expect_same(check(5, 1), check(5, 2));
    EXPECT_NE(check(5, 0).error.value, check(6, 0).error.value);
}

TEST(Verify, KeepsItsTime) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, 1.1f * box.radiance);
    const PathTracer tracer(box.scene);
    VerifyOptions options;
    options.samples = 1 << 20;
    const auto check = [&](double seconds) {
        options.seconds = seconds;
        return tracer.verify(box.camera, Furnace::width, Furnace::height, picture, options);
    };
    const Verification less = check(1e-6), more = check(1.0);
    EXPECT_EQ(less.pixels, 200 + 3 * 128) << "what it takes at least";
    EXPECT_LE(less.samples, 200u * 32 + 3 * 128 * 8);
    EXPECT_GT(more.samples, 4 * less.samples);
    EXPECT_LT(more.seconds, 3.0);
    EXPECT_LT(more.error.high - more.error.low, less.error.high - less.error.low);
}

TEST(Verify, CanBeCancelled) {
    const Furnace box;
    const Radiance picture(Furnace::width * Furnace::height, box.radiance);
    const PathTracer tracer(box.scene);
    int calls = 0;
    double last = 0.0;
    VerifyOptions options;
    options.pixels = 64;
    const auto run = [&](int most) {
        calls = 0;
        last = 0.0;
        return tracer.verify(box.camera, Furnace::width, Furnace::height, picture, options,
                             [&](double done) {
                                 EXPECT_GT(done, last);
                                 EXPECT_LE(done, 1.0);
                                 last = done;
                                 return ++calls < most;
                             });
    };
    EXPECT_FALSE(run(1000).cancelled);
    EXPECT_EQ(last, 1.0);
    EXPECT_GE(calls, 4);
    const Verification cut = run(2);
    EXPECT_TRUE(cut.cancelled);
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(cut.error.value, 0.0);
    EXPECT_GT(cut.samples, 0u);
}

TEST(Verify, RefusesWhatItCannotCheck) {
    const Furnace box;
    const PathTracer tracer(box.scene);
    const Radiance picture(12, box.radiance);
    const auto refuses = [&](const std::string& text, const std::function<void()>& call) {
        try {
            call();
            ADD_FAILURE() << "no error: " << text;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
        }
    };
    const auto check = [&](int width, int height, const Radiance& radiance,
                           const VerifyOptions& options) {
        return tracer.verify(box.camera, width, height, radiance, options);
    };
    refuses("the picture has 12 pixels, 15 needed", [&] { check(5, 3, picture, {}); });
    refuses("0x3", [&] { check(0, 3, {}, {}); });
    refuses("16385x1", [&] { check(16385, 1, Radiance(16385), {}); });
    Radiance broken = picture;
    broken[3].y = std::numeric_limits<float>::quiet_NaN();
    broken[5].z = std::numeric_limits<float>::infinity();
    refuses("2 pixels of the picture are not finite", [&] { check(4, 3, broken, {}); });
    VerifyOptions options;
    options.pixels = 15;
    refuses("pixels is 15", [&] { check(4, 3, picture, options); });
    options = {};
    options.samples = 7;
    refuses("samples is 7", [&] { check(4, 3, picture, options); });
    options = {};
    options.seconds = -1.0;
    refuses("seconds is -1", [&] { check(4, 3, picture, options); });
    options.seconds = std::numeric_limits<double>::quiet_NaN();
    refuses("seconds is", [&] { check(4, 3, picture, options); });
    options = {};
    options.effects.shadowed = false;
    refuses("one bounce", [&] { check(4, 3, picture, options); });
    const std::vector<Place> places(3, {{0, 0, 0}, {0, 1, 0}});
    refuses("4 pixels, 3 needed", [&] { tracer.verify(places, Radiance(4), {}); });
    refuses("at least 1", [&] { tracer.verify({}, {}, {}); });
}

}  // namespace
}  // namespace clgi
