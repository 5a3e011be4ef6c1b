// What dynamic transfer needs, before it is allocated.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <set>

#include "opencl_calls.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using test::calls;

// With lobes, other sides, a directional light and a picture of an environment.
const Scene& rich() {
    static const Scene scene = [] {
        Scene out = test::heap_of_solids(3);
        out.materials[1].roughness = 0.3f;
        out.materials[1].specular = 1.0f;
        out.materials[2].double_sided = true;
        out.lights = {test::directional_light({0, -1, 0}, 2.0f)};
        test::light_by_gradient(out, {0.9f, 2.0f, 3.5f}, {0, 1, 0});
        return out;
    }();
    return scene;
}

std::vector<glm::uvec3> half_of(const Scene& scene) {
    std::vector<glm::uvec3> out;
    for (std::size_t i = 0; i < scene.triangles.size(); i += 2) {
        const auto& corners = scene.triangles[i].vertex;
        out.emplace_back(corners[0], corners[1], corners[2]);
    }
    return out;
}

struct Variant {
    const char* what;
    DynamicTransferOptions options;
};

// Options that each change what is allocated.
std::vector<Variant> variants() {
    std::vector<Variant> out;
    const auto add = [&](const char* what) -> DynamicTransferOptions& {
        return out.emplace_back(Variant{what, {}}).options;
    };
    add("defaults");
    add("without gloss").gloss = false;
    add("interreflections").interreflections = 1;
    add("larger masks").masks.size = 64;
    add("larger cells").masks.block = 4;
    add("bands").masks.bands = 8;
    add("table").masks.planes = EdgePlanes::table;
    add("directional").directional = true;
    add("coarse").coarse = half_of(rich());
    DynamicTransferOptions& rings = add("coarse, two rings");
    rings.coarse = half_of(rich());
    rings.rings = 2;
    DynamicTransferOptions& all = add("all");
    all.coarse = half_of(rich());
    all.interreflections = 1;
    all.directional = true;
    all.masks = {.size = 16, .planes = EdgePlanes::table, .table_size = 16, .bands = 3};
    return out;
}

std::size_t estimated(const Scene& scene, const DeviceScene& device,
                      const DynamicTransferOptions& options) {
    return estimate(test::device().device, scene, device, options).bytes;
}

TEST(DynamicTransferEstimate, IsWhatIsAllocated) {
    const DeviceScene device = test::on_device(rich());
    std::set<std::size_t> different;
    for (const Variant& variant : variants()) {
        calls.clear();
        const std::size_t bytes = estimated(rich(), device, variant.options);
        EXPECT_EQ(calls.buffers + calls.builds + calls.enqueued, 0) << variant.what;
        calls.clear();
        DynamicTransferSolver solver(test::programs(), test::device().queue, rich(), device,
                                     variant.options);
        auto allocated = static_cast<std::size_t>(calls.bytes);
        if (variant.options.masks.planes == EdgePlanes::table)  // made of heights, for a while
            allocated -= pixel_heights(variant.options.masks.size).size() * sizeof(float);
        EXPECT_EQ(bytes, solver.bytes()) << variant.what;
        EXPECT_EQ(bytes, allocated) << variant.what;
        EXPECT_TRUE(different.insert(bytes).second) << variant.what;
        calls.clear();
        EXPECT_TRUE(solver.run());
        solver.reflect({1, 2, 3}).wait();
        EXPECT_EQ(calls.buffers, 0) << variant.what;
    }
}

// What a scene has counts as well: other sides, lobes, a picture.
TEST(DynamicTransferEstimate, FollowsTheScene) {
    const std::size_t whole = estimated(rich(), test::on_device(rich()), {});
    Scene scene = rich();
    scene.materials[2].double_sided = false;
    EXPECT_LT(estimated(scene, test::on_device(scene), {}), whole);
    scene = rich();
    scene.materials[1].specular = 0.0f;
    EXPECT_LT(estimated(scene, test::on_device(scene), {}), whole);
    scene = rich();
    scene.environment.reset();
    const DeviceScene black = test::on_device(scene);
    EXPECT_EQ(estimated(scene, black, {}),
              DynamicTransferSolver(test::programs(), test::device().queue, scene, black).bytes());
}

// It says what is needed where a solver could not be made.
TEST(DynamicTransferEstimate, IsNoErrorWhereMemoryIsTooSmall) {
    const DeviceScene device = test::on_device(rich());
    DynamicTransferOptions options;
    const std::size_t needed = estimated(rich(), device, options);
    const auto make = [&] {
        DynamicTransferSolver(test::programs(), test::device().queue, rich(), device, options);
    };
    options.memory_budget = needed;
    EXPECT_NO_THROW(make());
    options.memory_budget = needed - 1;
    EXPECT_EQ(estimated(rich(), device, options), needed);
    calls.clear();
    EXPECT_THROW(make(), DeviceError);
    EXPECT_EQ(calls.buffers, 0);
}

TEST(DynamicTransferEstimate, RefusesOptionsOutOfRange) {
    const DeviceScene device = test::on_device(rich());
    const auto refuses = [&](const auto& change) {
        DynamicTransferOptions options;
        change(options);
        EXPECT_THROW(estimated(rich(), device, options), Error);
    };
    refuses([](DynamicTransferOptions& o) { o.masks.size = 33; });
    refuses([](DynamicTransferOptions& o) { o.masks.block = 3; });
    refuses([](DynamicTransferOptions& o) { o.masks.bands = 10; });
    refuses([](DynamicTransferOptions& o) { o.interreflections = 2; });
    refuses([](DynamicTransferOptions& o) {
        o.coarse = {{0, 1, 2}};
        o.rings = 3;
    });
    Scene other = rich();
    test::add_floor(other, 2.0);
    EXPECT_THROW(estimated(other, device, {}), Error);
}

// The time is a guess. It grows with what takes time.
TEST(DynamicTransferEstimate, GuessesTheTime) {
    const DeviceScene device = test::on_device(rich());
    const auto time = [&](const DynamicTransferOptions& options) {
        return estimate(test::device().device, rich(), device, options).milliseconds;
    };
    const double usual = time({});
    EXPECT_GT(usual, 0.0);
    DynamicTransferOptions options;
    options.interreflections = 1;
    EXPECT_GT(time(options), 1.5 * usual);
    options = {};
    options.gloss = false;
    EXPECT_LT(time(options), usual);
    options = {};
    options.coarse = half_of(rich());
    EXPECT_LT(time(options), usual);
}

// Nothing to light is no error, and still has buffers.
TEST(DynamicTransferEstimate, OfAnEmptyScene) {
    const Scene scene = test::plain_scene();
    const DeviceScene device = test::on_device(scene);
    EXPECT_EQ(estimated(scene, device, {}),
              DynamicTransferSolver(test::programs(), test::device().queue, scene, device).bytes());
}

}  // namespace
}  // namespace clgi
