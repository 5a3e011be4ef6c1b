// The command of a picture says all that was changed.
// SPDX-License-Identifier: MIT
#include "view/shown.hpp"

#include <gtest/gtest.h>

#include <clgi/options.hpp>
#include <clgi/procedural.hpp>

namespace clgi {
namespace {

using view::Drawn;
using view::Subject;

TEST(CommandOfAPicture, SaysWhatWasChanged) {
    Subject subject;
    subject.scene = cornell({LightSource::spot});
    subject.scene.environment.emplace();
    subject.clip = 2;
    subject.flags = "a.glb --environment sky.exr";
    subject.turned = 350.0;
    Drawn drawn;
    drawn.options.method = Method::light_atlas;
    drawn.options.picture.width = 320;
    drawn.options.picture.height = 200;
    drawn.options.samples = 8;
    drawn.options.vpls.count = 400;
    drawn.options.second_order.negative_vpls = 7;  // of another method
    drawn.options.picture.direct = false;
    EXPECT_EQ(view::command_of(subject, drawn),
              "clgi render a.glb --environment sky.exr --environment-rotation 350 --size 320x200 "
              "--method atlas --vpls 400 --samples 8 --no-direct");

    drawn.shown.turn = 20.5;
    drawn.shown.seconds = 0.125;
    drawn.shown.viewpoint = view::Viewpoint{{0.1, -2.0, 1e-3}, {1.0, 2.0, 3.0}};
    Light light = subject.scene.lights[0];
    light.position = {0.25, 1.0, -0.5};
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = {3.0f, 2.0f, 0.5f};
    drawn.shown.lights[0] = light;
    EXPECT_EQ(view::command_of(subject, drawn),
              "clgi render a.glb --environment sky.exr --environment-rotation 370.5 --animation 2 "
              "--time 0.125 --eye 0.1,-2,0.001 --look-at 1,2,3 --light 0:position=0.25,1,-0.5 "
              "--light 0:direction=0,-1,0 --light 0:intensity=3,2,0.5 --size 320x200 "
              "--method atlas --vpls 400 --samples 8 --no-direct");
    light.kind = Light::Kind::directional;
    drawn.shown.lights[0] = light;
    EXPECT_EQ(view::command_of(subject, drawn).find("position"), std::string::npos);
    light.kind = Light::Kind::point;
    drawn.shown.lights[0] = light;
    EXPECT_EQ(view::command_of(subject, drawn).find("direction"), std::string::npos);
}

TEST(CommandOfAPicture, QuotesWords) {
    EXPECT_EQ(view::quoted("a/b-1.glb"), "a/b-1.glb");
    EXPECT_EQ(view::quoted(""), "''");
    EXPECT_EQ(view::quoted("a b"), "'a b'");
    EXPECT_EQ(view::quoted("it's `x`"), "'it'\\''s `x`'");
}

TEST(CommandOfAPicture, SaysLowResolutionOff) {
    RendererOptions options;
    set_option(options, "low-res", "off");
    const RendererOptions kept = view::as_flags(options);
    EXPECT_EQ(kept.second_order.low_resolution_step, 1);
    Drawn drawn;
    drawn.options = kept;
    Subject subject;
    subject.scene = cornell();
    const std::string command = view::command_of(subject, drawn);
    EXPECT_NE(command.find(" --low-res off"), std::string::npos);
    EXPECT_EQ(command.find("low-res-step"), std::string::npos);
}

// Options of a plan that no flag has, such as those of bakes, are left out of a window's pictures.
TEST(CommandOfAPicture, KeepsWhatFlagsSayAlone) {
    RendererOptions options;
    options.method = Method::light_atlas;
    options.vpls.count = 123;
    options.vpls.samples_per_vpl = 99;  // of clgi bake
    options.antiradiance.bins = 64;     // of another method
    options.light_atlas.hemicube_size = 64;
    const RendererOptions kept = view::as_flags(options), usual;
    EXPECT_EQ(kept.method, Method::light_atlas);
    EXPECT_EQ(kept.vpls.count, 123);
    EXPECT_EQ(kept.light_atlas.hemicube_size, 64);
    EXPECT_EQ(kept.vpls.samples_per_vpl, usual.vpls.samples_per_vpl);
    EXPECT_EQ(kept.antiradiance.bins, usual.antiradiance.bins);
}

}  // namespace
}  // namespace clgi
