// The passes of VPLs and of the atlas refuse a buffer that is one byte too small.
// SPDX-License-Identifier: MIT
#include "refusals.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

using S = SiteBuffers;
using B = const cl::Buffer&;

constexpr std::uint32_t n = 3, samples = 5, stride = 16, sample_stride = 16, size = 8, word = 4,
                        point_stride = 16;

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
        b.most_samples = 3;
        b.per_site = points_per_site(b.most_samples);
        b.point_stride = point_stride;
        for (cl::Buffer S::*which :
             {&S::sites, &S::planes, &S::light, &S::balance, &S::power, &S::shot, &S::samples,
              &S::points, &S::chosen, &S::sent, &S::sample_power, &S::site_power, &S::sends,
              &S::list, &S::listed})
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
    const TransportParams shooters{1, 2, 0, n, stride, sample_stride, size, 1.0f, 0, 0, 0, 0};
    const ShootParams shoot{1, 2, 0, n, stride, 1.0f, SHOOT_ALL, 0.0f};
    const auto& z = e.zeros;
    const std::tuple<const char*, cl::Buffer S::*, std::size_t> sites{"sites", &S::sites,
                                                                      n * sizeof(Site)},
        planes{"planes", &S::planes, SITE_PLANES * plane},
        points{"samples", &S::samples, GBUFFER_PLANES * sample_stride * word},
        light{"light", &S::light, SITE_LIGHT_PLANES * plane}, power{"power", &S::power, plane},
        shot{"shot", &S::shot, 3 * plane}, balance{"balance", &S::balance, BALANCE_PLANES * plane},
        few{"points", &S::points, SITE_POINT_PLANES * point_stride * word},
        chosen{"chosen", &S::chosen, 3 * word};
    std::vector<test::Argument> all;
    const auto place = [&](const S& b, B ids) { passes.place(queue, e.scene, b, ids); };
    add(all, e, "vpl.place", [&](const S& b) { place(b, z); }, {sites, planes, points});
    add(all, "vpl.place", "ids", GBUFFER_ID_PLANES * sample_stride * word,
        [&](B b) { place(e.buffers, b); });

    add(all, e, "vpl.points", [&](const S& b) { passes.points(queue, b); },
        {sites, planes, points, few});

    add(all, e, "vpl.receive", [&](const S& b) { passes.receive(queue, b, z); },
        {sites, planes, points, light});
    add(all, "vpl.receive", "irradiance", 3 * sample_stride * word,
        [&](B b) { passes.receive(queue, e.buffers, b); });

    add(all, e, "vpl.send", [&](const S& b) { passes.send(queue, b, z, -1.0f); },
        {sites,
         planes,
         points,
         light,
         {"sent", &S::sent, 3 * sample_stride * word},
         {"sample_power", &S::sample_power, 3 * sample_stride * word},
         {"site_power", &S::site_power, 3 * plane},
         {"sends", &S::sends, n}});
    add(all, "vpl.send", "irradiance", 3 * sample_stride * word,
        [&](B b) { passes.send(queue, e.buffers, b, -1.0f); });

    for (const cl_uint kept : {0u, 1u}) {  // kept rows: of all sites
        TransportParams params = shooters;
        params.kept = kept;
        const auto call = [&passes, &queue, params](const S& b, B views, B depth, B rows) {
            passes.transport(queue, params, b, views, depth, rows);
        };
        add(all, e, "vpl.transport", [=](const S& b) { call(b, z, z, z); },
            {sites, planes, points, few, chosen});
        add(all, "vpl.transport", "views", 10 * sizeof(View),
            [=, &e](B b) { call(e.buffers, b, z, z); });
        add(all, "vpl.transport", "depth", word * 2 * 3 * size * size,
            [=, &e](B b) { call(e.buffers, z, b, z); });
        add(all, "vpl.transport", "rows", (kept ? n : 2) * stride * sizeof(cl_half),
            [=, &e](B b) { call(e.buffers, z, z, b); });
    }

    for (const cl_uint kept : {0u, 1u}) {
        TransportParams params = shooters;
        params.kept = kept;
        const auto call = [&passes, &queue, params](const S& b, B rows) {
            passes.transport_open(queue, params, b, rows);
        };
        add(all, e, "vpl.transport_open", [=](const S& b) { call(b, z); },
            {sites, planes, points, few, chosen});
        add(all, "vpl.transport_open", "rows", (kept ? n : 2) * stride * sizeof(cl_half),
            [=, &e](B b) { call(e.buffers, b); });
    }
    add(all, e, "vpl.reach_open",
        [&](const S& b) { passes.reach_open(queue, shooters, e.scene, b); },
        {sites, planes, points, chosen, balance});

    // Views of one pixel each, the first one, where nothing is.
    const cl::Buffer views = test::upload([] {
        View view{};
        view.width = view.height = 1;
        return std::vector<View>(10, view);
    }());
    const auto reach = [&](const S& b, B v, B depth) {
        passes.reach(queue, shooters, b, v, depth);
    };
    add(all, e, "vpl.reach", [&](const S& b) { reach(b, views, z); },
        {sites, planes, points, chosen, balance});
    all.push_back({"vpl.reach", "views", 10 * sizeof(View), [&](B b) {
                       if (b()) queue.enqueueCopyBuffer(views, b, 0, 0, 10 * sizeof(View) - 1);
                       reach(e.buffers, b, z);
                   }});
    all.push_back({"vpl.reach", "depth", 2 * 3 * size * size * word,
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

// Nine shooters as below; 20 listed texels, of which 6 are in no block, and 3 blocks.
TEST(Sizes, OfBlocksOfTexels) {
    const AtlasPasses& passes = test::atlas_passes();
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t texel_stride = 64, listed_stride = 32;
    constexpr std::size_t planes = (GBUFFER_GEOMETRIC + 3) * word;
    const BlockParams params{9, size, texel_stride, 3, 20, listed_stride, 6, 3};
    const cl::Buffer z = test::upload(std::vector<float>(1 << 10)), views = test::empty<View>(45);
    Enough::clear(views);
    const cl::Buffer depths = test::upload(std::vector<cl_uint>(9 * 3 * size * size));
    BlockBuffers enough;
    enough.planes = enough.places = z;
    enough.seen = test::upload(std::vector<float>(1 << 10));
    enough.blocks = test::upload(std::vector<AtlasBlock>(3));
    const cl::Buffer out = test::upload(std::vector<float>(1 << 10));
    const auto with = [&](cl::Buffer BlockBuffers::*member, const B& buffer) {
        BlockBuffers b = enough;
        b.*member = buffer;
        return b;
    };
    std::vector<test::Argument> all;
    const auto flat = [&](const B& texels, const BlockBuffers& b) {
        passes.flat(queue, params, texels, b);
    };
    add(all, "atlas.flat", "texels", planes * texel_stride, [&](B b) { flat(b, enough); });
    add(all, "atlas.flat", "listed", planes * listed_stride,
        [&](B b) { flat(z, with(&BlockBuffers::planes, b)); });
    add(all, "atlas.flat", "blocks", 3 * sizeof(AtlasBlock),
        [&](B b) { flat(z, with(&BlockBuffers::blocks, b)); });
    const auto listed = [&](const B& v, const B& depth, const BlockBuffers& b, const B& seen) {
        passes.see_listed(queue, params, v, depth, b, seen);
    };
    const auto blocks = [&](const B& v, const B& depth, const B& texels, const BlockBuffers& b,
                            const B& seen) {
        passes.see_blocks(queue, params, v, depth, texels, b, seen);
    };
    add(all, "atlas.see_listed", "views", 45 * sizeof(View),
        [&](B b) { listed(b, depths, enough, out); });
    add(all, "atlas.see_listed", "depth", 9 * 3 * size * size * word,
        [&](B b) { listed(views, b, enough, out); });
    add(all, "atlas.see_listed", "listed", planes * listed_stride,
        [&](B b) { listed(views, depths, with(&BlockBuffers::planes, b), out); });
    add(all, "atlas.see_listed", "places", 6 * word,
        [&](B b) { listed(views, depths, with(&BlockBuffers::places, b), out); });
    add(all, "atlas.see_listed", "listed_seen", 2 * listed_stride,
        [&](B b) { listed(views, depths, with(&BlockBuffers::seen, b), out); });
    add(all, "atlas.see_listed", "seen", 5 * texel_stride,
        [&](B b) { listed(views, depths, enough, b); });
    add(all, "atlas.see_blocks", "views", 45 * sizeof(View),
        [&](B b) { blocks(b, depths, z, enough, out); });
    add(all, "atlas.see_blocks", "depth", 9 * 3 * size * size * word,
        [&](B b) { blocks(views, b, z, enough, out); });
    add(all, "atlas.see_blocks", "texels", planes * texel_stride,
        [&](B b) { blocks(views, depths, b, enough, out); });
    add(all, "atlas.see_blocks", "blocks", 3 * sizeof(AtlasBlock),
        [&](B b) { blocks(views, depths, z, with(&BlockBuffers::blocks, b), out); });
    add(all, "atlas.see_blocks", "listed_seen", 2 * listed_stride,
        [&](B b) { blocks(views, depths, z, with(&BlockBuffers::seen, b), out); });
    add(all, "atlas.see_blocks", "seen", 5 * texel_stride,
        [&](B b) { blocks(views, depths, z, enough, b); });
    test::expect_refusals(all);

    BlockParams wrong = params;
    wrong.listed_stride = 16;
    EXPECT_THROW(passes.see_listed(queue, wrong, views, depths, enough, out), Error);
    EXPECT_THROW(passes.see_blocks(queue, wrong, views, depths, z, enough, out), Error);
    wrong = params;
    wrong.unblocked = 21;
    EXPECT_THROW(passes.see_listed(queue, wrong, views, depths, enough, out), Error);
}

TEST(Sizes, OfAtlasPasses) {
    const Enough e;
    const AtlasPasses& passes = test::atlas_passes();
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t texels = 7, texel_stride = 32;
    constexpr std::size_t texel_plane = texel_stride * word;
    const FillParams params{
        1, 2, stride, sample_stride, texels, texel_stride, 0, FILL_FORM_FACTORS};
    const cl::Buffer z = e.zeros, out = test::upload(std::vector<float>(1 << 10));
    std::vector<test::Argument> all;
    // Nine shooters have two rows, which are put after three others.
    const cl::Buffer views = test::empty<View>(45);
    Enough::clear(views);
    const auto see = [&](B v, B depth, B places, B seen) {
        passes.see(queue, {9, size, texels, texel_stride, 0, 3, 0, 0}, v, depth, places, seen);
    };
    const cl::Buffer depths = test::upload(std::vector<cl_uint>(9 * 3 * size * size));
    add(all, "atlas.see", "views", 45 * sizeof(View), [&](B b) { see(b, depths, z, out); });
    add(all, "atlas.see", "depth", 9 * 3 * size * size * word, [&](B b) { see(views, b, z, out); });
    add(all, "atlas.see", "texels", (GBUFFER_GEOMETRIC + 3) * texel_plane,
        [&](B b) { see(views, depths, b, out); });
    add(all, "atlas.see", "seen", 5 * texel_stride, [&](B b) { see(views, depths, z, b); });

    // Not kept, two shooters have one row; kept, all sites have.
    for (const cl_uint kept : {0u, 1u}) {
        FillParams how = params;
        if (kept) how.flags |= FILL_KEPT;
        const auto gather = [&passes, &queue, how](const S& b, B places, B seen, B gathered,
                                                   B filled) {
            S sites = b;
            if (how.flags & FILL_KEPT) sites.site_count = 9;
            passes.gather(queue, how, sites, places, seen, gathered, filled);
        };
        const std::size_t count = kept ? 9 : n;
        add(all, e, "atlas.gather", [=](const S& b) { gather(b, z, z, out, out); },
            {{"list", &S::list, 3 * word},
             {"listed", &S::listed, word},
             {"sites", &S::sites, count * sizeof(Site)},
             {"planes", &S::planes, SITE_PLANES * plane},
             {"site_power", &S::site_power, 3 * plane},
             {"samples", &S::samples, GBUFFER_PLANES * sample_stride * word},
             {"sample_power", &S::sample_power, 3 * sample_stride * word}});
        add(all, "atlas.gather", "texels", (GBUFFER_NORMAL + 3) * texel_plane,
            [=, &e](B b) { gather(e.buffers, b, z, out, out); });
        add(all, "atlas.gather", "seen", (kept ? 2 : 1) * texel_stride,
            [=, &e](B b) { gather(e.buffers, z, b, out, out); });
        add(all, "atlas.gather", "gathered", 3 * texel_plane,
            [=, &e](B b) { gather(e.buffers, z, z, b, out); });
        add(all, "atlas.gather", "filled", texel_plane,
            [=, &e](B b) { gather(e.buffers, z, z, out, b); });
    }

    const auto open = [&](const S& b, B places, B gathered, B filled) {
        passes.gather_open(queue, params, b, places, gathered, filled);
    };
    add(all, e, "atlas.gather_open", [=](const S& b) { open(b, z, out, out); },
        {{"list", &S::list, 3 * word},
         {"listed", &S::listed, word},
         {"sites", &S::sites, n * sizeof(Site)},
         {"planes", &S::planes, SITE_PLANES * plane},
         {"site_power", &S::site_power, 3 * plane},
         {"samples", &S::samples, GBUFFER_PLANES * sample_stride * word},
         {"sample_power", &S::sample_power, 3 * sample_stride * word}});
    add(all, "atlas.gather_open", "texels", (GBUFFER_GEOMETRIC + 3) * texel_plane,
        [&](B b) { open(e.buffers, b, out, out); });
    add(all, "atlas.gather_open", "gathered", 3 * texel_plane,
        [&](B b) { open(e.buffers, z, b, out); });
    add(all, "atlas.gather_open", "filled", texel_plane, [&](B b) { open(e.buffers, z, out, b); });

    const auto nearest = [&](const S& b, B places, B reach) {
        passes.nearest(queue, params, b, places, reach);
    };
    add(all, e, "atlas.nearest", [&](const S& b) { nearest(b, z, out); },
        {{"planes", &S::planes, SITE_PLANES * plane},
         {"balance", &S::balance, BALANCE_PLANES * plane}});
    add(all, "atlas.nearest", "texels", (GBUFFER_GEOMETRIC + 3) * texel_plane,
        [&](B b) { nearest(e.buffers, b, out); });
    add(all, "atlas.nearest", "reach", texel_plane, [&](B b) { nearest(e.buffers, z, b); });

    const auto complete = [&](B reach, B filled, B gathered, B irradiance, B bad) {
        passes.complete(queue, params, reach, filled, gathered, irradiance, bad);
    };
    add(all, "atlas.complete", "reach", texel_plane, [&](B b) { complete(b, z, z, out, out); });
    add(all, "atlas.complete", "filled", texel_plane, [&](B b) { complete(z, b, z, out, out); });
    add(all, "atlas.complete", "gathered", 3 * texel_plane,
        [&](B b) { complete(z, z, b, out, out); });
    add(all, "atlas.complete", "irradiance", 3 * texel_plane,
        [&](B b) { complete(z, z, z, b, out); });
    add(all, "atlas.complete", "non_finite", word, [&](B b) { complete(z, z, z, out, b); });
    test::expect_refusals(all);

    FillParams wrong = params;
    wrong.stride = 24;
    EXPECT_THROW(passes.gather(queue, wrong, e.buffers, z, z, out, out), Error);
    EXPECT_THROW(passes.see(queue, {1, size, texels, 24, 0, 0, 0, 0}, z, z, z, out), Error);
    EXPECT_THROW(passes.see(queue, {1, size, texels, texel_stride, 8, 0, 0, 0}, z, z, z, out),
                 Error);
    EXPECT_THROW(passes.nearest(queue, wrong, e.buffers, z, out), Error);
    EXPECT_THROW(passes.complete(queue, wrong, z, z, z, out, out), Error);
}

}  // namespace
}  // namespace clgi
