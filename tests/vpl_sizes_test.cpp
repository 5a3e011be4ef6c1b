// The passes of VPLs and of the atlas refuse a buffer that is one byte too small.
// SPDX-License-Identifier: MIT
#include "refusals.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

using S = SiteBuffers;
using B = const cl::Buffer&;

constexpr std::uint32_t n = 3, samples = 5, stride = 16, sample_stride = 16, size = 8, word = 4;

// Every buffer exactly as large as it has to be, zeros all: sites of no sample.
struct Enough {
    DeviceScene scene = test::on_device([] {
        Scene world = test::plain_scene();
        test::add_floor(world, 1.0);
        return world;
    }());
    cl::Buffer zeros = test::upload(std::vector<float>(1 << 12));
    S buffers;
    Enough() {
        S& b = buffers;
        b.site_count = n;
        b.stride = stride;
        b.sample_count = samples;
        b.sample_stride = sample_stride;
        for (cl::Buffer S::*which : {&S::sites, &S::planes, &S::light, &S::balance, &S::power,
                                     &S::shot, &S::samples, &S::weights, &S::chosen})
            b.*which = test::upload(std::vector<float>(1 << 10));
    }
    S with(cl::Buffer S::*which, B other) const {
        S out = buffers;
        if (other()) clear(other);
        out.*which = other;
        return out;
    }
    static void clear(B buffer) {
        test::device().queue.enqueueFillBuffer(buffer, cl_uchar{0}, 0,
                                               buffer.getInfo<CL_MEM_SIZE>());
    }
};

using Call = std::function<void(const S&)>;

// A row for each of these members of SiteBuffers.
void add(std::vector<test::Argument>& out, const Enough& e, const char* pass, const Call& call,
         const std::vector<std::tuple<const char*, cl::Buffer S::*, std::size_t>>& members) {
    for (const auto& [name, which, bytes] : members)
        out.push_back(
            {pass, name, bytes, [&e, call, which = which](B b) { call(e.with(which, b)); }});
}

// The same for a buffer that is no member of SiteBuffers; zeros are in it.
void add(std::vector<test::Argument>& out, const char* pass, const char* name, std::size_t bytes,
         const std::function<void(B)>& call) {
    out.push_back({pass, name, bytes, [call](B b) {
                       if (b()) Enough::clear(b);
                       call(b);
                   }});
}

constexpr std::size_t plane = stride * word;

TEST(Sizes, OfVplPasses) {
    const Enough e;
    const VplPasses& passes = test::vpl_passes();
    const cl::CommandQueue& queue = test::device().queue;
    const TransportParams shooters{1, 2, 0, n, stride, sample_stride, size, 1.0f, 1, 4, 0, 0};
    const ShootParams shoot{1, 2, 0, n, stride, 1.0f, SHOOT_ALL, 0.0f};
    const auto& z = e.zeros;
    const std::tuple<const char*, cl::Buffer S::*, std::size_t> sites{"sites", &S::sites,
                                                                      n * sizeof(Site)},
        planes{"planes", &S::planes, SITE_PLANES * plane},
        points{"samples", &S::samples, GBUFFER_PLANES * sample_stride * word},
        light{"light", &S::light, SITE_LIGHT_PLANES * plane}, power{"power", &S::power, plane},
        shot{"shot", &S::shot, 3 * plane}, balance{"balance", &S::balance, BALANCE_PLANES * plane},
        weights{"weights", &S::weights, sample_stride * word},
        chosen{"chosen", &S::chosen, 3 * word};
    std::vector<test::Argument> all;
    const auto place = [&](const S& b, B ids) { passes.place(queue, e.scene, b, ids); };
    add(all, e, "vpl.place", [&](const S& b) { place(b, z); }, {sites, planes, points});
    add(all, "vpl.place", "ids", GBUFFER_ID_PLANES * sample_stride * word,
        [&](B b) { place(e.buffers, b); });

    add(all, e, "vpl.receive", [&](const S& b) { passes.receive(queue, b, z); },
        {sites, planes, points, light});
    add(all, "vpl.receive", "irradiance", 3 * sample_stride * word,
        [&](B b) { passes.receive(queue, e.buffers, b); });

    add(all, e, "vpl.weigh", [&](const S& b) { passes.weigh(queue, b, z); },
        {sites, planes, points, light, weights});
    add(all, "vpl.weigh", "irradiance", 3 * sample_stride * word,
        [&](B b) { passes.weigh(queue, e.buffers, b); });

    // Two words a pixel take twice the room; kept rows that of all sites.
    for (const cl_uint words : {1u, 2u})
        for (const cl_uint kept : {0u, 1u}) {
            TransportParams params = shooters;
            params.words = words;
            params.kept = kept;
            const auto call = [&passes, &queue, params](const S& b, B views, B depth, B rows) {
                passes.transport(queue, params, b, views, depth, rows);
            };
            add(all, e, "vpl.transport", [=](const S& b) { call(b, z, z, z); },
                {sites, planes, points, chosen});
            add(all, "vpl.transport", "views", 10 * sizeof(View),
                [=, &e](B b) { call(e.buffers, b, z, z); });
            add(all, "vpl.transport", "depth", words * word * 2 * 3 * size * size,
                [=, &e](B b) { call(e.buffers, z, b, z); });
            add(all, "vpl.transport", "rows", (kept ? n : 2) * stride * sizeof(cl_half),
                [=, &e](B b) { call(e.buffers, z, z, b); });
        }

    // Views of one pixel each, the first one, where nothing is.
    const cl::Buffer views = test::upload([] {
        View view{};
        view.width = view.height = 1;
        return std::vector<View>(10, view);
    }());
    const auto reach = [&](const S& b, B v, B visibility) {
        if (visibility()) queue.enqueueFillBuffer(visibility, cl_uchar{255}, 0, 8);
        passes.reach(queue, shooters, e.scene, b, v, visibility);
    };
    const cl::Buffer nothing = test::upload(std::vector<std::uint64_t>(2 * 3 * size * size, ~0ull));
    add(all, e, "vpl.reach", [&](const S& b) { reach(b, views, nothing); },
        {sites, planes, points, chosen, balance});
    all.push_back({"vpl.reach", "views", 10 * sizeof(View), [&](B b) {
                       if (b()) queue.enqueueCopyBuffer(views, b, 0, 0, 10 * sizeof(View) - 1);
                       reach(e.buffers, b, nothing);
                   }});
    all.push_back({"vpl.reach", "visibility", 2 * 3 * size * size * 8,
                   [&](B b) { reach(e.buffers, views, b); }});

    add(all, e, "vpl.balance_receivers",
        [&](const S& b) { passes.balance_receivers(queue, shoot, b, z); },
        {sites, planes, points, balance});
    add(all, "vpl.balance_receivers", "rows", n * stride * sizeof(cl_half),
        [&](B b) { passes.balance_receivers(queue, shoot, e.buffers, b); });

    add(all, e, "vpl.emit", [&](const S& b) { passes.emit(queue, shoot, b, z); },
        {sites, planes, points, light, power, shot});
    add(all, "vpl.emit", "strongest", sizeof(ArgMax),
        [&](B b) { passes.emit(queue, shoot, e.buffers, b); });
    all.push_back({"vpl.emit", "chosen", 2 * word,
                   [&](B b) { passes.emit(queue, shoot, e.with(&S::chosen, b), z); }});

    for (const cl_uint kept : {0u, 1u}) {
        ShootParams params = shoot;
        params.kept = kept;
        add(all, e, "vpl.balance_shooters",
            [=, &passes, &queue](const S& b) { passes.balance_shooters(queue, params, b, z); },
            {sites, planes, points, chosen, balance});
        add(all, "vpl.balance_shooters", "rows", (kept ? n : 2) * stride * sizeof(cl_half),
            [=, &e, &passes, &queue](B b) {
                passes.balance_shooters(queue, params, e.buffers, b);
            });
        add(all, e, "vpl.shoot",
            [=, &passes, &queue](const S& b) { passes.shoot(queue, params, b, z, z); },
            {sites, planes, points, chosen, balance, shot, light, power});
        add(all, "vpl.shoot", "rows", (kept ? n : 2) * stride * sizeof(cl_half),
            [=, &e, &passes, &queue](B b) { passes.shoot(queue, params, e.buffers, b, z); });
        add(all, "vpl.shoot", "non_finite", word,
            [=, &e, &passes, &queue](B b) { passes.shoot(queue, params, e.buffers, z, b); });
    }
    test::expect_refusals(all);

    S wrong = e.buffers;
    wrong.stride = 20;
    EXPECT_THROW(passes.receive(queue, wrong, z), Error);
    wrong = e.buffers;
    wrong.sample_count = 14;  // and the sites: one more than there is room for
    EXPECT_THROW(passes.receive(queue, wrong, z), Error);
}

TEST(Sizes, OfAtlasPasses) {
    const Enough e;
    const AtlasPasses& passes = test::atlas_passes();
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t texels = 7, texel_stride = 32;
    constexpr std::size_t texel_plane = texel_stride * word;
    const FillParams params{1, 2, stride, sample_stride, texels, texel_stride, 0, 1};
    const cl::Buffer z = e.zeros, out = test::upload(std::vector<float>(1 << 10));
    std::vector<test::Argument> all;
    const auto gather = [&](const S& b, B views, B places, B irradiance, B filled) {
        passes.gather(queue, params, b, views, z, places, irradiance, filled);
    };
    add(all, e, "atlas.gather", [&](const S& b) { gather(b, z, z, out, out); },
        {{"chosen", &S::chosen, 3 * word},
         {"sites", &S::sites, n * sizeof(Site)},
         {"planes", &S::planes, SITE_PLANES * plane},
         {"light", &S::light, SITE_LIGHT_PLANES * plane},
         {"samples", &S::samples, GBUFFER_PLANES * sample_stride * word},
         {"weights", &S::weights, sample_stride * word}});
    add(all, "atlas.gather", "views", 10 * sizeof(View),
        [&](B b) { gather(e.buffers, b, z, out, out); });
    add(all, "atlas.gather", "texels", (GBUFFER_GEOMETRIC + 3) * texel_plane,
        [&](B b) { gather(e.buffers, z, b, out, out); });
    add(all, "atlas.gather", "irradiance", 3 * texel_plane,
        [&](B b) { gather(e.buffers, z, z, b, out); });
    add(all, "atlas.gather", "filled", texel_plane, [&](B b) { gather(e.buffers, z, z, out, b); });

    const auto nearest = [&](const S& b, B places, B reach) {
        passes.nearest(queue, params, b, places, reach);
    };
    add(all, e, "atlas.nearest", [&](const S& b) { nearest(b, z, out); },
        {{"planes", &S::planes, SITE_PLANES * plane},
         {"balance", &S::balance, BALANCE_PLANES * plane}});
    add(all, "atlas.nearest", "texels", (GBUFFER_GEOMETRIC + 3) * texel_plane,
        [&](B b) { nearest(e.buffers, b, out); });
    add(all, "atlas.nearest", "reach", texel_plane, [&](B b) { nearest(e.buffers, z, b); });

    const auto complete = [&](B reach, B filled, B irradiance, B bad) {
        passes.complete(queue, params, reach, filled, irradiance, bad);
    };
    add(all, "atlas.complete", "reach", texel_plane, [&](B b) { complete(b, z, out, out); });
    add(all, "atlas.complete", "filled", texel_plane, [&](B b) { complete(z, b, out, out); });
    add(all, "atlas.complete", "irradiance", 3 * texel_plane, [&](B b) { complete(z, z, b, out); });
    add(all, "atlas.complete", "non_finite", word, [&](B b) { complete(z, z, out, b); });
    test::expect_refusals(all);

    FillParams wrong = params;
    wrong.stride = 24;
    EXPECT_THROW(passes.gather(queue, wrong, e.buffers, z, z, z, out, out), Error);
    EXPECT_THROW(passes.nearest(queue, wrong, e.buffers, z, out), Error);
    EXPECT_THROW(passes.complete(queue, wrong, z, z, out, out), Error);
}

}  // namespace
}  // namespace clgi
