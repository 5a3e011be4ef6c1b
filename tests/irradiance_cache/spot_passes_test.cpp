// The passes of small lit places.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <clgi/advanced/emitters.hpp>
#include <clgi/passes/cache.hpp>
#include <numeric>

#include "device.hpp"
#include "math_modes.hpp"
#include "methods/irradiance_cache/spot_tiles.hpp"
#include "scenes.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

const glm::dvec3 floor_albedo(0.2, 0.5, 0.7);
constexpr double slope = 0.3;  // of the floor along x
constexpr std::uint32_t spot_view_size = 256, places = 16, face = 32;

// A tilted floor of 4 x 4 m and a plate over a part of it.
Scene floor_and_plate() {
    Scene scene = test::plain_scene(glm::vec3(floor_albedo));
    const auto at = [](double x, double z) { return glm::dvec3(x, slope * x, z); };
    test::add_quad(scene, {at(-2, 2), at(2, 2), at(2, -2), at(-2, -2)});
    Material dark;
    dark.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
    test::add_box(scene, {-3, 2, -3}, {0, 2.1, 3}, 1, test::add_material(scene, dark));
    return scene;
}

template <typename T>
std::vector<T> read(const cl::Buffer& from, std::size_t count) {
    std::vector<T> out(count);
    test::device().queue.enqueueReadBuffer(from, CL_TRUE, 0, count * sizeof(T), out.data());
    return out;
}

// One record over the floor that faces it, one light, and what lies between.
struct LitFloor {
    explicit LitFloor(const Light& light, bool above = true) : host(floor_and_plate()) {
        host.lights = {light};
        scene.emplace(test::on_device(host));
        set = make_emitters(*scene, {});
        emitters.emitters = test::upload(set.emitters);
        emitters.views = test::upload(set.views);
        emitters.visibility = test::empty<std::uint32_t>(set.pixels);
        emitters.view_count = set.views.size();
        emitters.pixels = set.pixels;
        emitters.kind = Pixels::depth;
        scale = scene->frame().scale;
        params.count = 1;
        params.stride = params.row_stride = places;
        params.size = face;
        const glm::dvec3 place =
            scale * (glm::dvec3(0.2, above ? 1.5 : -1.5, 0.1) - scene->frame().origin);
        std::vector<float> planes(RECORD_PLANES * places, 0.0f);
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c) * places] = static_cast<float>(place[c]);
        planes[(RECORD_NORMAL + 1) * places] = planes[(RECORD_GEOMETRIC + 1) * places] =
            above ? -1.0f : 1.0f;
        records.planes = test::upload(planes);
        records.views = test::empty<View>(5);
        records.visibility = test::empty<std::uint64_t>(3 * face * face);
        draw_cube(records, 1);
        spot.seen = test::upload(std::vector<std::uint32_t>(words(), 0u));
        spot.of = test::upload(std::vector<SpotView>{{0, 0, 0, 0}});
        view = set.views[0];
        view.width = view.height = spot_view_size;
        view.first_pixel = 0;
        spot.views = test::upload(std::vector<View>{view});
        spot.visibility = test::empty<std::uint64_t>(spot_view_size * spot_view_size);
        gbuffer.raster_views(
            queue, {0, 1, spot_view_size, spot_view_size, spot_view_size * spot_view_size},
            spot.views, *scene, spot.visibility, Pixels::visibility);
        wanted.assign(SPOT_TILES_A_VIEW * set.views.size(), 1u);
        spot.wanted = test::upload(wanted);
        spot.count = test::empty<std::uint32_t>(SPOT_TILES_A_VIEW);
        spot.area = test::empty<float>(SPOT_TILES_A_VIEW);
        passes.mark(queue, params, *scene, records, spot);
    }

    void draw_cube(const CacheBuffers& of, std::uint32_t count, std::uint32_t stride = places) {
        CubeParams cube{};
        cube.point_count = count;
        cube.faces = 5;
        cube.size = face;
        cube.stride = stride;
        cube.lift = 1e-5f;
        cube.near = 5e-6f;
        std::vector<std::uint32_t> order(stride);
        std::iota(order.begin(), order.end(), 0u);
        gbuffer.cubes(queue, cube, of.planes, test::upload(order), of.views);
        gbuffer.raster_views(queue, {0, 5 * count, face, face, 3 * face * face * count}, of.views,
                             *scene, of.visibility, Pixels::visibility);
    }

    std::size_t words() const { return (2 * scene->info().vertex_count + 31) / 32; }

    double tallied() {
        spot.wanted = test::upload(wanted);
        passes.tally(queue, {1, 0, 0, 0}, spot_view_size, *scene, emitters, spot);
        const auto area = read<float>(spot.area, SPOT_TILES_A_VIEW);
        return std::accumulate(area.begin(), area.end(), 0.0) / (scale * scale);
    }

    std::vector<Vpl> placed(std::size_t most) {
        const auto count = read<std::uint32_t>(spot.count, SPOT_TILES_A_VIEW);
        const auto samples = spot_samples({1.0}, count, most);
        spot.samples = test::upload(samples);
        spot.spots = test::empty<Vpl>(samples.size());
        passes.spots(queue, {1, static_cast<std::uint32_t>(samples.size()), 0, 0}, spot_view_size,
                     *scene, emitters, spot);
        return read<Vpl>(spot.spots, samples.size());
    }

    // So many records stand in for what faces any way.
    CacheTree list(std::uint32_t count) {
        std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
        for (std::uint32_t k = 0; k < count; ++k)
            for (std::size_t way = 0; way < CACHE_WAYS; ++way) lists[way * CACHE_LISTED + k] = k;
        records.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
        records.lists = test::upload(lists);
        return one_leaf(1, places);
    }

    // by_spots: whether these tiles light by VPLs.
    void link_with(const std::vector<std::uint32_t>& tiles, bool by_spots) {
        params.spots = by_spots ? 1 : 0;
        params.thin = params.emitter_step = params.every = 1;
        params.emitter_count = params.whole_emitters =
            static_cast<std::uint32_t>(set.emitters.size());
        const View& shadows = set.views[0];
        gbuffer.raster_views(queue, {0, 1, shadows.width, shadows.height, set.pixels},
                             emitters.views, *scene, emitters.visibility, Pixels::depth);
        records.sky = test::empty<float>(4);
        for (cl::Buffer* light :
             {&records.rows, &records.base, &records.reflected, &records.bright})
            *light = test::empty<float>(3 * places);
        records.by_spots = test::upload(tiles);
        passes.link(queue, params, list(0), *scene, emitters, records);
    }

    // Of VPLs on surfaces.
    void hemicubes_of(const std::vector<Vpl>& vpls) {
        const auto count = static_cast<std::uint32_t>(vpls.size());
        const std::uint32_t stride = (count + 15) / 16 * 16;
        std::vector<float> planes(RECORD_PLANES * stride, 0.0f);
        for (std::uint32_t k = 0; k < count; ++k)
            for (std::uint32_t c = 0; c < 3; ++c) {
                const auto axis = static_cast<int>(c);
                planes[c * stride + k] = vpls[k].position[axis];
                for (const std::uint32_t first : {RECORD_NORMAL, RECORD_GEOMETRIC})
                    planes[(first + c) * stride + k] = vpls[k].normal[axis];
            }
        spot.spots = test::upload(vpls);
        spot.hemicubes.planes = test::upload(planes);
        spot.hemicubes.views = test::empty<View>(5 * count);
        spot.hemicubes.visibility = test::empty<std::uint64_t>(3 * face * face * count);
        draw_cube(spot.hemicubes, count, stride);
    }

    // lumen of all VPLs
    glm::dvec3 flux(const std::vector<Vpl>& vpls) const {
        glm::dvec3 out(0.0);
        for (const Vpl& one : vpls) out += glm::dvec3(one.flux);
        return out * scene->frame().exposure / (scale * scale);
    }

    Scene host;
    std::optional<DeviceScene> scene;
    EmitterSet set;
    EmitterBuffers emitters;
    CacheBuffers records;
    SpotBuffers spot;
    CacheParams params{};
    View view{};
    std::vector<std::uint32_t> wanted;
    double scale = 1.0;
    GBufferPasses gbuffer{test::programs(), test::usual_build()};
    CachePasses passes{test::programs(), test::usual_build()};
    const cl::CommandQueue& queue = test::device().queue;
};

Light sun() {
    Light out = test::directional_light({0.3f, -1.0f, 0.1f});
    out.intensity = {3.0f, 4.0f, 5.0f};
    return out;
}

// Of the floor, where the plate does not shade it: section across the sun's light, m^2.
double lit_section() {
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, -1.0, 0.1)),
                     normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    constexpr int steps = 2000;
    double area = 0.0;
    for (int i = 0; i < steps; ++i) {  // nothing depends on z: the plate is wider than the floor
        const double x = -2.0 + 4.0 * (i + 0.5) / steps, up = 2.1 - slope * x;
        if (x - up * 0.3 > 0.0) area += 4.0 / steps * 4.0 * std::hypot(1.0, slope);
    }
    return area * -glm::dot(way, normal);
}

CLGI_IN_BOTH_MATHS(SpotPasses);

// From above the fronts of the floor's four vertices, from below their backs; nothing of the plate,
// which is behind the record or hidden.
TEST_P(SpotPasses, MarkTheSidesThatRecordsSee) {
    for (const bool above : {true, false}) {
        LitFloor of(sun(), above);
        int bits = 0;
        for (const std::uint32_t word : read<std::uint32_t>(of.spot.seen, of.words())) {
            bits += std::popcount(word);
            EXPECT_EQ(word & (above ? 0xaaaaaaaau : 0x55555555u), 0u);
        }
        EXPECT_EQ(bits, 4);
    }
}

TEST_P(SpotPasses, TallyWhatIsLitAndSeen) {
    LitFloor of(sun());
    EXPECT_NEAR(of.tallied(), lit_section(), 0.01 * lit_section());
    // Every other tile alone, then the others.
    double sum = 0.0;
    for (const std::size_t odd : {0, 1}) {
        for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t) of.wanted[t] = t % 2 == odd ? 1 : 0;
        const double half = of.tallied();
        EXPECT_GT(half, 0.1);
        sum += half;
    }
    EXPECT_NEAR(sum, lit_section(), 0.01 * lit_section());
    std::fill(of.wanted.begin(), of.wanted.end(), 1u);
    of.spot.seen = test::upload(std::vector<std::uint32_t>(of.words(), 0xaaaaaaaau));  // the backs
    EXPECT_EQ(of.tallied(), 0.0);
    // One triangle of the floor: the other has an edge of it, the plate has none.
    auto one = std::vector<std::uint32_t>(of.words(), 0u);
    for (const std::uint32_t vertex : {0u, 1u, 2u}) one[vertex / 16] |= 1u << 2 * (vertex % 16);
    of.spot.seen = test::upload(one);
    EXPECT_NEAR(of.tallied(), lit_section(), 0.01 * lit_section());
    one.assign(of.words(), 0u);
    one[0] = 1u;  // a corner is none
    of.spot.seen = test::upload(one);
    EXPECT_EQ(of.tallied(), 0.0);
}

TEST_P(SpotPasses, PlaceVplsThatSendWhatIsLit) {
    LitFloor of(sun());
    of.tallied();
    const std::vector<Vpl> vpls = of.placed(500);
    ASSERT_EQ(vpls.size(), 500u);
    const glm::dvec3 wanted = floor_albedo * glm::dvec3(3, 4, 5) * lit_section();
    const glm::dvec3 found = of.flux(vpls);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.012 * wanted[c]) << c;
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, -1.0, 0.1)),
                     normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    double area = 0.0;
    for (const Vpl& one : vpls) {
        EXPECT_LT(glm::length(glm::dvec3(one.normal) - normal), 1e-5);
        const glm::dvec3 at = glm::dvec3(one.position) / of.scale + of.scene->frame().origin;
        EXPECT_NEAR(at.y, slope * at.x, 1e-5);
        area += double{one.position.w} * glm::pi<double>() / (of.scale * of.scale);
        EXPECT_NEAR(one.normal.w, one.position.w * one.position.w, 1e-6 * one.normal.w);
    }
    EXPECT_NEAR(area, lit_section() / -glm::dot(way, normal), 0.15);
}

// Tiles to the right of and above the middle of what is lit: VPLs lie in these, and what they send
// together with what pixels of the hemicube then still do is what pixels do alone.
TEST_P(SpotPasses, ShareTheLightWithPixels) {
    LitFloor of(sun());
    of.tallied();
    const auto count = read<std::uint32_t>(of.spot.count, SPOT_TILES_A_VIEW);
    double texels = 0.0, columns = 0.0, rows = 0.0;
    for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t) {
        texels += count[t];
        columns += static_cast<double>(t % SPOT_TILES) * count[t];
        rows += static_cast<double>(t / SPOT_TILES) * count[t];
    }
    const double column = std::round(columns / texels), row = std::round(rows / texels);
    for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t)
        of.wanted[t] = static_cast<double>(t % SPOT_TILES) >= column &&
                               static_cast<double>(t / SPOT_TILES) < row
                           ? 1
                           : 0;
    EXPECT_GT(of.tallied(), 0.1 * lit_section());
    EXPECT_LT(of.tallied(), 0.5 * lit_section());
    const std::vector<Vpl> vpls = of.placed(200);
    constexpr double half = SPOT_TILES / 2;
    for (const Vpl& one : vpls) {
        const glm::dvec3 way = glm::dvec3(one.position) - glm::dvec3(of.view.eye);
        EXPECT_GE(glm::dot(way, glm::dvec3(of.view.right)),
                  of.view.window.x + of.view.right.w * (column / half - 1.0) - 1e-4);
        EXPECT_GE(glm::dot(way, glm::dvec3(of.view.up)),
                  of.view.window.y + of.view.up.w * (1.0 - row / half) - 1e-4);
    }
    of.link_with(of.wanted, false);
    const std::vector<float> all = read<float>(of.records.reflected, 3 * places);
    of.link_with(of.wanted, true);
    const std::vector<float> rest = read<float>(of.records.reflected, 3 * places);
    of.hemicubes_of(vpls);
    const auto sent = static_cast<std::uint32_t>(vpls.size());
    of.passes.shine(of.queue, of.params, of.list(1), {1, sent, 0, 0}, *of.scene, of.records,
                    of.spot);
    const std::vector<float> both = read<float>(of.records.reflected, 3 * places);
    for (std::size_t c = 0; c < 3; ++c) {
        const float whole = all[c * places];
        EXPECT_LT(rest[c * places], 0.9f * whole) << c;
        EXPECT_GT(rest[c * places], 0.1f * whole) << c;
        EXPECT_NEAR(both[c * places], whole, 0.03f * whole) << c;
    }
}

// All of a spot's cone falls on the floor.
TEST_P(SpotPasses, PlaceVplsInACone) {
    Light light = test::spot_light({1.2, 1.6, 0.3}, {0.1f, -1.0f, 0.1f}, 0.3);
    light.intensity = {30.0f, 20.0f, 10.0f};
    LitFloor of(light);
    of.tallied();
    const double solid = 2.0 * glm::pi<double>() * (1.0 - std::cos(0.3));
    const std::vector<Vpl> vpls = of.placed(700);
    for (const Vpl& one : vpls) EXPECT_GT(one.flux.x, 0.0f);
    const glm::dvec3 found = of.flux(vpls), wanted = floor_albedo * glm::dvec3(30, 20, 10) * solid;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.006 * wanted[c]) << c;
}

// By a second implementation, in double precision; the plate hides some of them. Other records
// beside it, in whatever order and facing its way, spread their light over what it stands for.
TEST_P(SpotPasses, LightRecordsThatTheySee) {
    LitFloor of(sun());
    std::vector<float> planes(RECORD_PLANES * places, 0.0f);
    const auto put = [&](std::uint32_t first, std::uint32_t record, const glm::dvec3& value) {
        for (std::uint32_t c = 0; c < 3; ++c)
            planes[(first + c) * places + record] = static_cast<float>(value[static_cast<int>(c)]);
    };
    const auto local = [&](glm::dvec3 at) { return of.scale * (at - of.scene->frame().origin); };
    const glm::dvec3 at(0.3, 3.0, 0.2), facing = glm::normalize(glm::dvec3(0.2, -1.0, 0.1));
    put(RECORD_POSITION, 0, local(at));
    put(RECORD_NORMAL, 0, facing);
    const glm::dvec3 beside[] = {{0.5, 0.1, 0.0}, {-0.2, 0.0, 0.9}, {0.3, 0.0, 0.4}};
    for (std::uint32_t k = 0; k < 3; ++k) {
        put(RECORD_POSITION, k + 1, local(at + beside[k]));
        put(RECORD_NORMAL, k + 1, k < 2 ? facing : -facing);
    }
    of.records.planes = test::upload(planes);

    std::vector<Vpl> vpls;
    // Alone; with one other that faces its way; with two.
    const double wide[] = {0.0, 0.26, 0.85 / 2.0};
    glm::dvec3 wanted[3] = {};
    int hidden = 0;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    for (std::uint32_t k = 0; k < 12; ++k) {
        const double x = k < 4 ? -1.9 + 0.2 * k : -0.1 + 0.2 * (k - 4);
        const glm::dvec3 from(x, slope * x, 0.1 * k - 0.5);
        const double radius2 = 0.02 * (k + 1) * of.scale * of.scale;
        const glm::dvec3 flux(1.0 + k, 2.0, 3.0 + 0.1 * k);
        vpls.push_back(
            {float4(local(from), radius2), float4(normal, radius2 * radius2), float4(flux, 1.0)});
        // Where the way crosses the plate's underside.
        const double share = (2.0 - from.y) / (at.y - from.y);
        const double crossing = from.x + share * (at.x - from.x);
        ASSERT_GT(std::abs(crossing), 0.13);  // a pixel of their hemicubes
        hidden += crossing < 0.0;
        if (crossing < 0.0) continue;
        for (int others = 0; others < 3; ++others) {
            glm::dvec3 to = local(from) - local(at);
            const double height = glm::dot(to, facing);
            to += (std::hypot(height, std::sqrt(wide[others]) * of.scale) - height) * facing;
            const double square = glm::dot(to, to),
                         cosines = glm::dot(to, facing) * -glm::dot(to, normal) / square;
            wanted[others] +=
                flux * cosines * (square + radius2) /
                (glm::pi<double>() * (square * (square + radius2) + radius2 * radius2));
        }
    }
    ASSERT_TRUE(hidden > 2 && hidden < 10);
    vpls.push_back(vpls.back());  // one that faces away
    for (int c = 0; c < 3; ++c) vpls.back().normal[c] *= -1.0f;
    of.hemicubes_of(vpls);
    std::vector<float> before(3 * places, 0.0f);
    before[0] = before[places] = 2.0f;
    // The fourth faces the other way and is none of them.
    for (const std::uint32_t records : {1u, 2u, 3u, 4u}) {
        of.records.reflected = test::upload(before);
        of.passes.shine(of.queue, of.params, of.list(records), {1, 13, 0, 0}, *of.scene, of.records,
                        of.spot);
        const auto found = read<float>(of.records.reflected, 3 * places);
        for (std::size_t c = 0; c < 3; ++c) {
            const double more = wanted[std::min(records, 3u) - 1][static_cast<int>(c)];
            EXPECT_NEAR(found[c * places], before[c * places] + more, 1e-4 * more) << c;
        }
        EXPECT_EQ(found[1], 0.0f);
    }
}

}  // namespace
}  // namespace clgi
