// A bake that is cancelled goes on to the bits of one that is not, whatever it keeps.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>

#include "frames.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

Scene short_room() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_box(scene, glm::dvec3(-1.0), {1.0, 1.2, 1.4}, -1);
    scene.lights = {test::spot_light({0.2, 1.0, 0.3}, {-0.3f, -1.0f, -0.2f}, 0.6, 10.0f)};
    return scene;
}

// What a solver keeps while it bakes.
enum class Keeps { all, transport, nothing };

struct Baker {
    explicit Baker(Keeps keeps = Keeps::all, std::uint32_t vpls = 200) {
        const Patches patches = make_patches(world);
        VplOptions vpl_options;
        vpl_options.count = vpls;
        AtlasOptions atlas_options;
        atlas_options.size = 40;
        options.hemicube_size = 64;
        options.bounces = 3;
        options.build.form = Form::packets;  // whose batches are counted
        const AtlasLayout atlas = make_atlas(world, patches.triangle_patch, atlas_options);
        const VplLayout placed = place_vpls(world, patches, vpl_options);
        vpl_count = static_cast<std::uint32_t>(placed.vpls.size());
        const auto make = [&](std::size_t budget) {
            options.memory_budget = budget;
            solver = std::make_unique<LightAtlasSolver>(test::programs(), test::device().queue,
                                                        on_device, placed, atlas, options);
        };
        make(0);
        // A byte less, and what was kept last is kept no more.
        for (int k = 0; k < static_cast<int>(keeps); ++k) make(solver->bytes() - 1);
        EXPECT_EQ(solver->status().visibility_kept, keeps == Keeps::all);
        EXPECT_EQ(solver->status().transport_kept, keeps != Keeps::nothing);
    }

    // Stops at the first report of at least this share.
    bool run_until(double share) {
        return solver->run([&](double done) { return done < share; });
    }
    std::size_t launches(const char* name) const {
        std::size_t out = 0;
        for (const PassEvent& event : solver->events()) out += std::string(event.name) == name;
        return out;
    }

    Scene world = short_room();
    DeviceScene on_device = test::on_device(world);
    LightAtlasOptions options;
    std::uint32_t vpl_count = 0;
    std::unique_ptr<LightAtlasSolver> solver;
};

const std::vector<glm::vec3>& wanted(Keeps keeps = Keeps::all) {
    static std::vector<glm::vec3> bits[3];
    std::vector<glm::vec3>& out = bits[static_cast<int>(keeps)];
    if (out.empty()) {
        Baker whole(keeps);
        EXPECT_TRUE(whole.solver->run());
        EXPECT_FALSE(whole.solver->state());
        out = whole.solver->irradiance();
    }
    return out;
}

std::uint32_t done(const LightAtlasState& state) {
    EXPECT_EQ(std::min(state.measured_vpls, state.filled_vpls), 0u);  // one or the other
    return std::max(state.measured_vpls, state.filled_vpls);
}

constexpr Keeps kinds[] = {Keeps::all, Keeps::transport, Keeps::nothing};

// Kept, in the middle of measuring and after it, before, in and after the exchange, and when all
// VPLs have lit the texels; not kept, in the middle of filling.
TEST(LightAtlasState, GoesOnToTheSameBits) {
    for (const Keeps keeps : kinds)
        for (const double share : {0.05, 0.5, 0.81, 0.99}) {
            Baker first(keeps);
            ASSERT_FALSE(first.run_until(share));
            const auto state = first.solver->state();
            if (keeps != Keeps::all && share < 0.45) {
                EXPECT_FALSE(state);
                continue;
            }
            ASSERT_TRUE(state);
            EXPECT_GT(done(*state), 0u);
            EXPECT_EQ(state->measured_vpls > 0, keeps == Keeps::all);
            EXPECT_EQ(done(*state) < first.vpl_count, share < (keeps == Keeps::all ? 0.8 : 0.9));
            Baker second(keeps);
            second.solver->restore(*state);
            ASSERT_TRUE(second.solver->run());
            EXPECT_FALSE(second.solver->state());
            EXPECT_TRUE(test::same_bits(second.solver->irradiance(), wanted(keeps))) << share;
            EXPECT_EQ(second.solver->status().shots, 2 * second.vpl_count);
            // What was measured is not measured again.
            const std::size_t left = (second.vpl_count - state->measured_vpls + 7) / 8;
            if (keeps == Keeps::all) {
                EXPECT_EQ(second.launches("vpl.transport"), left);
                EXPECT_EQ(second.launches("atlas.see_blocks"), left);
                EXPECT_EQ(second.launches("vpl.balance_receivers") > 0, left > 0);
            }
            // Whoever went on can start anew, and so can who gave it away, and who had begun.
            Baker third(keeps);
            ASSERT_FALSE(third.run_until(0.02));
            third.solver->restore(*state);
            ASSERT_TRUE(third.solver->run());
            EXPECT_TRUE(test::same_bits(third.solver->irradiance(), wanted(keeps))) << share;
            for (Baker* baker : {&second, &first, &third}) {
                ASSERT_TRUE(baker->solver->run());
                EXPECT_TRUE(test::same_bits(baker->solver->irradiance(), wanted(keeps))) << share;
            }
        }
}

TEST(LightAtlasState, MayBeCutShortAgainAndAgain) {
    for (const Keeps keeps : {Keeps::all, Keeps::nothing}) {
        const double begin = keeps == Keeps::all ? 0.05 : 0.45;
        Baker baker(keeps);
        EXPECT_FALSE(baker.run_until(begin));
        int rounds = 0;
        for (auto state = baker.solver->state(); state; state = baker.solver->state(), ++rounds) {
            ASSERT_LT(rounds, 20);
            Baker next(keeps);
            next.solver->restore(*state);
            int reports = 0;
            next.solver->run([&](double) { return ++reports < 3; });
            baker.solver->restore(*state);
            if (const auto later = next.solver->state()) {
                EXPECT_GE(done(*later), done(*state));
                // Cancelled before anything was done, the state is the one that was given.
                baker.solver->restore(*later);
            }
            if (rounds >= 3)
                baker.solver->run();
            else
                baker.run_until(begin + 0.15 * (rounds + 1));
        }
        EXPECT_GT(rounds, 1);
        EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted(keeps)));
    }
}

TEST(LightAtlasState, IsKeptWhenTheNextRunIsCancelledAtOnce) {
    for (const Keeps keeps : kinds) {
        Baker first(keeps), second(keeps);
        ASSERT_FALSE(first.run_until(keeps == Keeps::all ? 0.05 : 0.6));
        const auto state = first.solver->state();
        ASSERT_TRUE(state);
        second.solver->restore(*state);
        ASSERT_FALSE(second.run_until(0.0));
        const auto again = second.solver->state();
        ASSERT_TRUE(again);
        EXPECT_EQ(done(*again), done(*state));
        EXPECT_EQ(again->rows, state->rows);
        EXPECT_EQ(again->seen, state->seen);
        EXPECT_TRUE(test::same_bits(again->irradiance, state->irradiance));
        EXPECT_TRUE(test::same_bits(again->light, state->light));
        ASSERT_TRUE(second.solver->run());
        EXPECT_TRUE(test::same_bits(second.solver->irradiance(), wanted(keeps)));
    }
}

// Light that changes between two runs belongs to no state of what was measured.
TEST(LightAtlasState, OfWhatWasMeasuredServesOtherLights) {
    const auto darker = [](Baker& baker) {
        Light light = baker.world.lights[0];
        light.intensity *= glm::vec3(0.1f, 0.5f, 2.0f);
        baker.on_device.set_light(0, light);
        baker.solver->lights_changed();
    };
    Baker first, second, fresh;
    ASSERT_FALSE(first.run_until(0.5));
    for (Baker* baker : {&second, &fresh}) darker(*baker);
    second.solver->restore(*first.solver->state());
    ASSERT_TRUE(second.solver->run());
    ASSERT_TRUE(fresh.solver->run());
    EXPECT_TRUE(test::same_bits(second.solver->irradiance(), fresh.solver->irradiance()));
    EXPECT_FALSE(test::same_bits(fresh.solver->irradiance(), wanted()));
}

TEST(LightAtlasState, IsNoneBeforeThereIsAnythingToKeep) {
    for (const Keeps keeps : kinds) {
        Baker baker(keeps);
        EXPECT_FALSE(baker.solver->state());
        ASSERT_FALSE(baker.run_until(0.0));
        EXPECT_FALSE(baker.solver->state());
        ASSERT_TRUE(baker.solver->run());
        EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted(keeps)));
    }
}

// What is asked for after the last texel comes too late.
TEST(LightAtlasState, IsNoneAtTheEnd) {
    for (const Keeps keeps : kinds) {
        Baker baker(keeps);
        EXPECT_TRUE(baker.run_until(1.0));
        EXPECT_FALSE(baker.solver->state());
    }
}

TEST(LightAtlasState, OfAnotherSizeIsRefused) {
    for (const Keeps keeps : kinds) {
        Baker baker(keeps), other(keeps, 120),
            others(keeps == Keeps::all ? Keeps::nothing : Keeps::all);
        ASSERT_FALSE(baker.run_until(0.5));
        const LightAtlasState state = *baker.solver->state();
        EXPECT_THROW(other.solver->restore(state), Error);
        EXPECT_THROW(others.solver->restore(state), Error);  // who keeps something else
        const auto refused = [&](const auto& change) {
            LightAtlasState changed = state;
            change(changed);
            EXPECT_THROW(baker.solver->restore(changed), Error);
        };
        std::uint32_t LightAtlasState::*const count =
            keeps == Keeps::all ? &LightAtlasState::measured_vpls : &LightAtlasState::filled_vpls;
        refused([&](LightAtlasState& s) { s.*count = 0; });
        refused([&](LightAtlasState& s) { s.*count = state.vpls + 8; });
        refused([&](LightAtlasState& s) { s.*count += 1; });
        refused([&](LightAtlasState& s) { s.texels += 1; });
        refused([&](LightAtlasState& s) { s.vpls += 1; });
        refused([&](LightAtlasState& s) { s.balance.pop_back(); });
        if (keeps == Keeps::all) {
            refused([&](LightAtlasState& s) { s.rows.pop_back(); });
            refused([&](LightAtlasState& s) { s.seen.pop_back(); });
            refused([&](LightAtlasState& s) { s.filled_vpls = 8; });
        } else {
            refused([&](LightAtlasState& s) { s.light.pop_back(); });
            refused([&](LightAtlasState& s) { s.irradiance.pop_back(); });
            refused([&](LightAtlasState& s) { s.filled.pop_back(); });
        }
        ASSERT_TRUE(baker.solver->run());  // nothing of it stayed behind
        EXPECT_TRUE(test::same_bits(baker.solver->irradiance(), wanted(keeps)));
    }
}

TEST(LightAtlasSolver, NeedsAtLeastTheBytesThatAreCheckedBefore) {
    Baker baker;
    const std::size_t least = light_atlas_least_bytes(baker.vpl_count, 10 * baker.vpl_count);
    EXPECT_GT(least, 100 * 10 * baker.vpl_count);
    EXPECT_LT(least, baker.solver->bytes());
}

}  // namespace
}  // namespace clgi
