// Patches, VPLs and texels laid out together are those of one call after the other.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/bake_layout.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <tuple>

#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

bool same(const VplSite& a, const VplSite& b) {
    const auto all = [](const VplSite& v) {
        return std::tie(v.triangle, v.b1, v.b2, v.first_sample, v.sample_count, v.region, v.area,
                        v.back);
    };
    return all(a) == all(b);
}

bool same(const SamplePoint& a, const SamplePoint& b) {
    return std::tie(a.triangle, a.b1, a.b2) == std::tie(b.triangle, b.b1, b.b2);
}

bool same(const AtlasTexel& a, const AtlasTexel& b) {
    const auto all = [](const AtlasTexel& t) {
        return std::tie(t.texel, t.triangle, t.b1, t.b2, t.coverage, t.area, t.chart, t.centre);
    };
    return all(a) == all(b);
}

template <typename T>
void expect_same(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.size(); ++i) differing += !same(a[i], b[i]);
    EXPECT_EQ(differing, 0u) << what;
}

TEST(BakeLayout, IsThatOfItsParts) {
    for (const Scene& scene : {corridor(), bumpy_mesh()}) {
        VplOptions vpls;
        vpls.count = 90;
        AtlasOptions atlas;
        atlas.size = 256;
        const Patches patches = make_patches(scene);
        const VplLayout sites = place_vpls(scene, patches, vpls);
        const AtlasLayout texels = make_atlas(scene, patches.triangle_patch, atlas);
        const BakeLayout made = make_bake_layout(scene, vpls, atlas);
        EXPECT_EQ(made.patches.triangle_patch, patches.triangle_patch);
        EXPECT_EQ(made.patches.triangles, patches.triangles);
        EXPECT_EQ(made.patches.neighbours, patches.neighbours);
        EXPECT_EQ(made.vpls.patch_region, sites.patch_region);
        expect_same(made.vpls.vpls, sites.vpls, "VPLs");
        expect_same(made.vpls.samples, sites.samples, "samples");
        expect_same(made.atlas.texels, texels.texels, "texels");
        EXPECT_EQ(made.atlas.uvs, texels.uvs);
        EXPECT_EQ(made.atlas.skipped_area, texels.skipped_area);
        EXPECT_GT(made.atlas.charts.size(), 6u);
    }
}

TEST(BakeLayout, FailsAsItsPartsDo) {
    const auto message = [](const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas) {
        try {
            make_bake_layout(scene, vpls, atlas);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    VplOptions no_vpls;
    no_vpls.samples_per_vpl = 0;
    AtlasOptions no_texels;
    no_texels.size = 0;
    Scene broken = corridor();
    broken.triangles[3].material = 1000;
    EXPECT_EQ(message(broken, no_vpls, no_texels).find("make_patches: triangle 3"), 0u);
    EXPECT_EQ(message(corridor(), no_vpls, no_texels).find("place_vpls: samples_per_vpl"), 0u);
    EXPECT_EQ(message(corridor(), {}, no_texels).find("atlas: size"), 0u);
}

}  // namespace
}  // namespace clgi
