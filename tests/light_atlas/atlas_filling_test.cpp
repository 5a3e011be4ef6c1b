// The solver's two ways to fill the atlas.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/light_atlas.hpp>
#include <clgi/procedural.hpp>

#include "device.hpp"

namespace clgi {
namespace {

struct Baked {
    std::vector<glm::vec3> irradiance;
    LightAtlasStatus status;
    std::size_t bytes = 0;
    std::vector<std::string> passes;
    bool has(const char* pass) const {
        return std::find(passes.begin(), passes.end(), pass) != passes.end();
    }
};

struct Room {
    Scene scene = cornell({.light = LightSource::spot});
    Patches patches = make_patches(scene);
    VplLayout vpls = place_vpls(scene, patches, {.count = 60});
    AtlasLayout atlas = make_atlas(scene, patches.triangle_patch, {.size = 96});
    DeviceScene device_scene = test::on_device(scene);

    Baked bake(LightAtlasOptions options) const {
        options.bounces = 2;
        options.hemicube_size = 128;
        LightAtlasSolver solver(test::programs(), test::device().queue, device_scene, vpls, atlas,
                                options);
        EXPECT_TRUE(solver.run());
        Baked out{solver.irradiance(), solver.status(), solver.bytes(), {}};
        for (const PassEvent& pass : solver.events()) out.passes.push_back(pass.name);
        return out;
    }
};

double rms(const Baked& got, const Baked& wanted) {
    double error = 0.0, all = 0.0;
    for (std::size_t i = 0; i < got.irradiance.size(); ++i) {
        const glm::dvec3 g(got.irradiance[i]), w(wanted.irradiance[i]);
        error += glm::dot(g - w, g - w);
        all += glm::dot(w, w);
    }
    return std::sqrt(error / all);
}

TEST(LightAtlas, IsFilledAlikeByGatheringAndByProjection) {
    const Room room;
    LightAtlasOptions options;
    options.build.form = Form::packets;  // whose batches are as large in both
    const Baked gathered = room.bake(options);
    options.filling = Filling::project;
    options.kernel = 0;
    const Baked coarse = room.bake(options);
    options.mesh = 2048;
    const Baked fine = room.bake(options);
    EXPECT_EQ(fine.status.non_finite, 0u);
    // Measured: 1.4 % and 1.0 %. What is left lies within a pixel of the creases of the room.
    EXPECT_LT(rms(coarse, gathered), 0.02);
    EXPECT_LT(rms(fine, gathered), 0.85 * rms(coarse, gathered));

    // What a filling does not take costs neither memory nor launches.
    for (const char* pass : {"atlas.geometry", "atlas.replicate", "atlas.project"}) {
        EXPECT_FALSE(gathered.has(pass)) << pass;
        EXPECT_TRUE(coarse.has(pass)) << pass;
    }
    EXPECT_TRUE(gathered.has("atlas.gather"));
    EXPECT_FALSE(coarse.has("atlas.gather"));
    EXPECT_LT(gathered.bytes, coarse.bytes);
}

TEST(LightAtlas, IsProjectedAlikeInEveryRunAndInGroupsOfAnySize) {
    const Room room;
    LightAtlasOptions options;
    options.filling = Filling::project;
    const Baked first = room.bake(options), second = room.bake(options);
    EXPECT_EQ(first.irradiance, second.irradiance);
    options.build.local_size = 3;
    EXPECT_EQ(first.irradiance, room.bake(options).irradiance);
}

TEST(LightAtlas, RefusesMeshesThatDoNotFitTheFaces) {
    const Room room;
    const auto refuses = [&](const char* text, LightAtlasOptions options) {
        try {
            options.hemicube_size = 64;
            LightAtlasSolver(test::programs(), test::device().queue, room.device_scene, room.vpls,
                             room.atlas, options);
            ADD_FAILURE() << text << ": taken";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
        }
    };
    const auto with = [](int mesh, int kernel) {
        LightAtlasOptions out;
        out.mesh = mesh;
        out.kernel = kernel;
        return out;
    };
    refuses("mesh is 2.000000, 8", with(2, 5));
    refuses("mesh is 500, twice the square of an even number needed", with(500, 5));
    refuses("mesh is 18, twice the square", with(18, 5));
    refuses("at most 2 hemicube_size^2 = 8192 needed", with(2 * 66 * 66, 5));
    refuses("kernel is -1.000000", with(512, -1));
    refuses("kernel is 65.000000", with(512, 65));
}

}  // namespace
}  // namespace clgi
