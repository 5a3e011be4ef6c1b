// Many views in one call: every way of drawing them gives the same words, and views that the device
// itself has placed are those that the host would place.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>

#include "depth_words.hpp"
#include "frames.hpp"
#include "lab/scenes/rooms.hpp"
#include "patchwork.hpp"

namespace clgi {
namespace {

using test::same_bits;

// Views of different sizes and kinds, side by side in one buffer of pixels.
std::vector<View> many_views(const DeviceScene& scene) {
    std::vector<View> views;
    std::uint32_t pixel = 5;  // not the first
    const std::pair<int, int> sizes[] = {{64, 64}, {97, 33}, {16, 130}, {1, 1}, {70, 70}};
    for (int k = 0; k < 5; ++k) {
        Camera camera = test::camera_at({1.8 - 0.7 * k, 0.9, 1.5 - 0.2 * k}, {0.1 * k, 0, 0});
        if (k == 2) {
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = 0.8f;
        }
        View view = make_view(camera, scene.frame(), sizes[k].first, sizes[k].second);
        if (k % 2 == 1) view.flags = 0;  // back faces as well
        view.first_pixel = pixel;
        pixel += view.width * view.height;
        views.push_back(view);
    }
    return views;
}

struct Way {
    const char* name;
    bool whole;               // a view a work-item or a group
    std::uint32_t at_a_time;  // views of the lists
    std::uint32_t capacity;   // polygons of the lists; 0: plenty
};

// The pixels of all views, drawn in one of the ways.
template <typename Word>
std::vector<Word> drawn(const DeviceScene& scene, const std::vector<View>& views, const Way& way,
                        const GBufferPasses& passes = test::gbuffer_passes()) {
    const cl::CommandQueue& queue = test::device().queue;
    const Pixels kind = sizeof(Word) == 4 ? Pixels::depth : Pixels::visibility;
    const ViewSpan span = span_of(views, 0, views.size());
    const RasterBuffers buffers =
        test::raster_buffers(scene, span.pixels, kind, way.at_a_time, way.capacity);
    queue.enqueueFillBuffer(buffers.pixels, cl_uchar{0x5a}, 0, span.pixels * sizeof(Word));
    const cl::Buffer on_device = test::upload(views);
    if (way.whole) {
        passes.raster_views(queue, span, on_device, scene, buffers.pixels, kind);
    } else {
        Recorder record(queue, "test");
        record.begin({});
        draw_by_lists(record, passes, scene, span, on_device, buffers);
    }
    return test::download<Word>(buffers.pixels, span.pixels);
}

constexpr Way ways[] = {{"one by one", false, 1, 0},   {"three at a time", false, 3, 0},
                        {"all at once", false, 5, 0},  {"a view a work-item", true, 1, 0},
                        {"short lists", false, 5, 20}, {"lists of one", false, 2, 1}};

// Builds other than those of the device. One draws a mesh of small triangles as it does one of all
// sizes: two of them draw both.
const std::vector<BuildOptions> other_builds = {
    {.packet_width = 1, .form = Form::packets, .local_size = 7, .atomics64 = false},
    {.form = Form::groups, .local_size = 100},
    {.form = Form::groups, .local_size = 7, .atomics64 = false}};

void expect_same_words(const Scene& world, const std::vector<BuildOptions>& builds = other_builds) {
    const DeviceScene scene = test::on_device(world);
    const std::vector<View> views = many_views(scene);
    const auto wanted = drawn<std::uint64_t>(scene, views, ways[0]);
    std::size_t seen = 0;
    for (std::size_t p = 5; p < wanted.size(); ++p) seen += wanted[p] != ~std::uint64_t{0};
    EXPECT_GT(seen, wanted.size() / 10);
    for (int p = 0; p < 5; ++p) EXPECT_EQ(wanted[p], 0x5a5a5a5a5a5a5a5aull) << "before the views";
    const auto depth = drawn<std::uint32_t>(scene, views, ways[0]);
    test::expect_closeness(depth, wanted, "depth alone");
    for (const Way& way : ways) {
        EXPECT_TRUE(same_bits(drawn<std::uint64_t>(scene, views, way), wanted)) << way.name;
        EXPECT_TRUE(same_bits(drawn<std::uint32_t>(scene, views, way), depth)) << way.name;
    }
    for (const BuildOptions& build : builds) {
        const GBufferPasses passes(test::programs(), build);
        for (const Way& way : {ways[1], ways[3], ways[4]}) {
            EXPECT_TRUE(same_bits(drawn<std::uint64_t>(scene, views, way, passes), wanted))
                << way.name << ", group of " << build.local_size;
            EXPECT_TRUE(same_bits(drawn<std::uint32_t>(scene, views, way, passes), depth))
                << way.name << ", group of " << build.local_size;
        }
    }
}

// Small and large triangles, clipped ones and masked ones, seen from both sides.
TEST(Views, OfDepthAloneSayWhichSideIsSeen) {
    Scene world = test::patchwork(200, 72);
    for (std::size_t m = 0; m < world.materials.size(); ++m) {
        world.materials[m].double_sided = m % 3 == 2;
        if (m % 2) world.materials[m].alpha_mode = AlphaMode::mask;
        if (m % 4 == 3) world.materials[m].alpha_mode = AlphaMode::blend;
    }
    Scene fine = bumpy_mesh();
    for (std::size_t t = 0; t < fine.triangles.size(); t += 3)
        std::swap(fine.triangles[t].vertex[1], fine.triangles[t].vertex[2]);
    for (const Scene& shown : {world, fine}) {
        const DeviceScene scene = test::on_device(shown);
        std::vector<View> views = many_views(scene);
        for (View& view : views) view.flags = 0;
        test::Sides sides;
        const auto depth = drawn<std::uint32_t>(scene, views, ways[0]);
        const auto words = drawn<std::uint64_t>(scene, views, ways[0]);
        for (const View& view : views) test::count_sides(scene, view, depth, words, sides);
        EXPECT_GT(sides.fronts, 1000u);
        EXPECT_GT(sides.backs, 1000u);
        // Of two triangles at one closeness, but for the lowest bit, either may be seen.
        EXPECT_LE(1000 * sides.wrong, sides.fronts + sides.backs);
    }
}

// Two triangles at one place, wound each way: the front is seen, whichever comes first.
TEST(Views, OfDepthAloneShowFrontsBeforeBacksAtOnePlace) {
    for (const double half : {0.01, 1.0})  // of a few pixels, and of many
        for (const bool back_first : {false, true})
            for (const int shown : {1, 2, 3}) {  // front, back, both
                Scene world = test::plain_scene();
                for (const bool back : {back_first, !back_first}) {
                    if (!(shown & (back ? 2 : 1))) continue;
                    const glm::dvec3 a(-half, -half, 0), b(half, -half, 0), c(0, half, 0);
                    test::add_triangle(world, a, back ? c : b, back ? b : c);
                }
                test::add_triangle(world, {-2, -2, -1}, {2, -2, -1}, {0, 2, -1});
                const DeviceScene scene = test::on_device(world);
                View view = make_view(test::camera_at({0, 0, 2}, {0, 0, 0}), scene.frame(), 99, 99);
                view.flags = 0;
                for (const Way& way : ways) {
                    const auto depth = drawn<std::uint32_t>(scene, {view}, way);
                    EXPECT_EQ(depth[49 * 99 + 49] & 1u, shown == 2 ? 1u : 0u)
                        << way.name << ", half " << half << ", shown " << shown;
                    EXPECT_EQ(depth[0], ~0u);
                }
            }
}

TEST(Views, AreTheSameWordsInEveryWayOfDrawing) { expect_same_words(test::patchwork(200, 71)); }

TEST(Views, OfADenseMeshAreTheSameWordsInEveryWayOfDrawing) {
    expect_same_words(bumpy_mesh(), {other_builds[0], other_builds[1]});
}

// Whether alpha is looked up is decided by a comparison of its own for each kind of word.
TEST(Views, OfMaskedSurfacesAreTheSameWordsInEveryWayOfDrawing) {
    Scene world = test::patchwork(200, 79);
    for (std::size_t m = 0; m < world.materials.size(); m += 2) {
        world.materials[m].alpha_mode = AlphaMode::mask;
        world.materials[m].alpha_cutoff = 0.25f;
    }
    expect_same_words(world);
    // Masked triangles are seen, and seen through.
    const auto triangles_seen = [](const Scene& shown) {
        const DeviceScene scene = test::on_device(shown);
        std::vector<int> out;
        for (const auto word : drawn<std::uint64_t>(scene, many_views(scene), ways[0])) {
            const auto triangle = static_cast<std::uint32_t>(word);
            out.push_back(triangle < scene.triangle_order().size()
                              ? static_cast<int>(scene.triangle_order()[triangle])
                              : -1);
        }
        return out;
    };
    const auto cut = triangles_seen(world);
    Scene opaque = world;
    for (Material& material : opaque.materials) material.alpha_mode = AlphaMode::opaque;
    const auto full = triangles_seen(opaque);
    const auto masked = [&](int triangle) {
        return triangle >= 0 && world.triangles[triangle].material % 2 == 0;
    };
    std::size_t kept = 0, through = 0;
    for (std::size_t p = 0; p < full.size(); ++p) {
        kept += masked(full[p]) && cut[p] == full[p];
        through += masked(full[p]) && cut[p] != full[p];
        EXPECT_TRUE(masked(full[p]) || cut[p] == full[p]) << p;
    }
    EXPECT_GT(kept, 500u);
    EXPECT_GT(through, 500u);
}

// What no cluster test may remove: each triangle drawn alone, where it is the nearest.
TEST(Views, LoseNothingToCulledClusters) {
    for (const std::uint64_t seed : {72u, 73u, 74u}) {
        const Scene world = test::patchwork(700, seed, false);
        const DeviceScene scene = test::on_device(world);
        for (View view : many_views(scene)) {
            view.first_pixel = 0;
            const auto words = drawn<std::uint64_t>(scene, {view}, ways[0]);
            // Clusters that everything falls into are never passed over.
            DeviceScene open = test::on_device(world);
            const float far = std::numeric_limits<float>::max() / 16;
            const std::vector<Cluster> all(
                scene.info().cluster_count,
                {glm::vec4(glm::vec3(-far), 0), glm::vec4(glm::vec3(far), 0), {0, 0, 0, 2}});
            test::device().queue.enqueueWriteBuffer(open.clusters(), CL_TRUE, 0,
                                                    all.size() * sizeof(Cluster), all.data());
            EXPECT_TRUE(same_bits(drawn<std::uint64_t>(open, {view}, ways[0]), words)) << seed;
        }
    }
}

// Clusters beside the view and behind it, and a mesh seen from behind, cost no work.
TEST(Views, PassOverWhatTheyCannotSee) {
    const DeviceScene scene = test::on_device(bumpy_mesh());
    View view = many_views(scene)[0];
    view.first_pixel = 0;
    // Without depth in common: a cluster whose box lies elsewhere hides what is in it.
    DeviceScene elsewhere = test::on_device(bumpy_mesh());
    const glm::vec3 behind = glm::vec3(view.eye) - 3.0f * glm::vec3(view.forward);
    const glm::vec3 beside =
        glm::vec3(view.eye) + glm::vec3(view.forward) + 9.0f * glm::vec3(view.right);
    const glm::vec3 above =
        glm::vec3(view.eye) + glm::vec3(view.forward) + 9.0f * glm::vec3(view.up);
    const glm::vec3 ahead = glm::vec3(view.eye) + glm::vec3(view.forward);
    const glm::vec4 away(glm::vec3(view.forward), 0.1f), toward(-glm::vec3(view.forward), 0.1f);
    const auto shown = [&](const glm::vec3& middle, const glm::vec4& cone, bool cull_backs) {
        const std::vector<Cluster> all(
            scene.info().cluster_count,
            {glm::vec4(middle - 0.01f, 0), glm::vec4(middle + 0.01f, 0), cone});
        test::device().queue.enqueueWriteBuffer(elsewhere.clusters(), CL_TRUE, 0,
                                                all.size() * sizeof(Cluster), all.data());
        View seen = view;
        seen.flags = cull_backs ? VIEW_CULL_BACK_FACES : 0;
        std::size_t count = 0;
        for (const auto word : drawn<std::uint64_t>(elsewhere, {seen}, ways[0]))
            count += word != ~std::uint64_t{0};
        return count;
    };
    EXPECT_GT(shown(ahead, toward, true), 0u);
    EXPECT_EQ(shown(behind, toward, true), 0u);
    for (const glm::vec3& side : {beside, above})
        for (const float sign : {1.0f, -1.0f})
            EXPECT_EQ(shown(ahead + sign * (side - ahead), toward, true), 0u);
    EXPECT_EQ(shown(ahead, away, true), 0u);
    EXPECT_GT(shown(ahead, away, false), 0u);  // both sides are drawn
}

// The views of an area light's hemicube and a point light's cube, placed on the device instead.
TEST(Views, AroundPointsAreThoseOfTheHost) {
    Scene world = test::patchwork(60, 75, false);
    const DeviceScene scene = test::on_device(world);
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t stride = 16, size = 32;
    test::Random random(76);
    std::vector<float> points(POINT_PLANES * stride);
    std::vector<glm::vec3> at(stride), normal(stride);
    for (std::uint32_t i = 0; i < stride; ++i) {
        at[i] = test::random_vec3(random, -0.5, 0.5);
        normal[i] = i == 9 ? glm::vec3(0) : glm::normalize(test::random_vec3(random, -1, 1));
        // Along the axis that frames are built from, and near it.
        if (i == 3) normal[i] = {0, 1, 0};
        if (i == 5) normal[i] = {0, -1, 0};
        if (i == 6) normal[i] = glm::normalize(glm::vec3(1e-4f, -1, 0));
        for (int c = 0; c < 3; ++c) {
            points[c * stride + i] = at[i][c];
            points[(GBUFFER_NORMAL + c) * stride + i] = normal[i][c];
        }
    }
    const std::vector<cl_uint> chosen{7, 3, 9, 0, 5, 6};
    for (const std::uint32_t faces : {5u, 6u}) {
        const cl::Buffer views = test::empty<View>(2 + faces * chosen.size());
        const CubeParams params{
            static_cast<std::uint32_t>(chosen.size()), faces, size, 2, 11, stride, 1e-3f, 2e-3f};
        test::gbuffer_passes().cubes(queue, params, test::upload(points), test::upload(chosen),
                                     views);
        const auto found = test::download<View>(views, faces * chosen.size(), 2);
        std::uint32_t pixel = 11;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const View& view = found[i];
            const std::uint32_t point = chosen[i / faces], face = i % faces;
            const glm::vec3 forward(view.forward), right(view.right), up(view.up);
            EXPECT_EQ(view.first_pixel, pixel);
            pixel += view.width * view.height;
            EXPECT_EQ(view.width, size);
            EXPECT_EQ(view.height, faces == 5 && face > 0 ? size / 2 : size);
            if (point == 9) {  // no surface: nothing is ever near enough
                EXPECT_TRUE(std::isinf(view.forward.w));
                continue;
            }
            EXPECT_EQ(view.forward.w, params.near);
            const glm::vec3 eye = at[point] + params.lift * normal[point];
            EXPECT_LT(glm::distance(glm::vec3(view.eye), eye), 1e-6f);
            EXPECT_LT(glm::distance(glm::cross(forward, up), right), 1e-6f);  // right-handed
            for (const glm::vec3& axis : {forward, up, right})
                EXPECT_NEAR(glm::length(axis), 1.0f, 1e-6f) << point << ", face " << face;
            EXPECT_LT(std::abs(glm::dot(forward, up)), 1e-6f) << point << ", face " << face;
            if (faces == 6) {
                glm::vec3 wanted(0.0f);
                wanted[face / 2] = face % 2 ? -1.0f : 1.0f;
                EXPECT_EQ(forward, wanted);
            } else if (face == 0) {
                EXPECT_LT(glm::distance(forward, normal[point]), 1e-6f);
            } else {
                const View& first = found[i - face];
                const glm::vec3 sides[] = {glm::vec3(first.right), glm::vec3(first.up),
                                           -glm::vec3(first.right), -glm::vec3(first.up)};
                EXPECT_LT(glm::distance(forward, sides[face - 1]), 1e-6f);
                EXPECT_LT(glm::distance(up, normal[point]), 1e-6f);
                EXPECT_EQ(view.window.y, 0.5f);  // the half above the surface
                EXPECT_EQ(view.window.w, CUBE_FOOTPRINT);
                EXPECT_EQ(view.up.w, 0.5f);
            }
        }
    }
}

// A light chosen by arg-max on the device is seen from without the host knowing which it is.
TEST(Views, FollowAChoiceThatNeverLeavesTheDevice) {
    const test::Device& on = test::device();
    const Scene world = test::patchwork(300, 77, false);
    const DeviceScene scene = test::on_device(world);
    const std::uint32_t count = scene.info().triangle_count, stride = plane_stride(count);
    std::vector<SurfaceSample> samples;
    std::vector<float> power(count);
    test::Random random(78);
    for (std::uint32_t t = 0; t < count; ++t) {
        samples.push_back({t, 0.25f, 0.5f, 0.0f});
        power[t] = static_cast<float>(random(0, 1));
    }
    const GBuffer points{test::empty<float>(GBUFFER_PLANES * stride),
                         test::empty<cl_int>(GBUFFER_ID_PLANES * stride), stride};
    test::gbuffer_passes().surface(on.queue, scene, {count, stride, 0, 0}, test::upload(samples),
                                   points);
    const ParallelPasses parallel(test::programs());
    const cl::Buffer best = test::empty<ArgMax>(1), views = test::empty<View>(5);
    const cl::Buffer pixels = test::empty<cl_uint>(3 * 64 * 64);
    const ViewSpan span{0, 5, 64, 64, 3 * 64 * 64};
    const auto maps = [&](const cl::Buffer& chosen) {
        test::gbuffer_passes().cubes(on.queue, {1, 5, 64, 0, 0, stride, 1e-3f, 5e-4f},
                                     points.planes, chosen, views);
        test::gbuffer_passes().raster_views(on.queue, span, views, scene, pixels, Pixels::depth);
        return test::download<cl_uint>(pixels, span.pixels);
    };
    const auto brightest =
        static_cast<cl_uint>(std::max_element(power.begin(), power.end()) - power.begin());
    const auto wanted = maps(test::upload(std::vector<cl_uint>{brightest}));
    parallel.arg_max(on.queue, count, test::upload(power), best,
                     test::empty<char>(arg_max_scratch_bytes(count)));
    // The index is the second word of the result; a slice of it is what `cubes` reads.
    const auto result = test::upload(std::vector<cl_uint>(1));
    on.queue.enqueueCopyBuffer(best, result, offsetof(ArgMax, index), 0, sizeof(cl_uint));
    EXPECT_TRUE(same_bits(maps(result), wanted));
    EXPECT_GT(std::count_if(wanted.begin(), wanted.end(), [](cl_uint d) { return d != ~0u; }), 500);
}

}  // namespace
}  // namespace clgi
