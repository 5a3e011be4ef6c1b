// The bits of which VPLs see which texels, against geometry.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t shooters = 16, texels = 403, size = 128;
constexpr cl_uchar not_looked_up = 0xa5;

struct Box {
    glm::dvec3 low, high;
};
const Box room{{-1, -1, -1}, {1, 1, 1}}, block{{-0.35, -0.5, -0.3}, {0.45, 0.3, 0.4}};

// Anywhere on a box, which faces in or out; the normal there.
std::pair<glm::dvec3, glm::dvec3> on_box(const Box& box, double facing, test::Random& random) {
    const int axis = random.integer(0, 2), side = random.integer(0, 1);
    glm::dvec3 p(random(0.02, 0.98), random(0.02, 0.98), random(0.02, 0.98)), normal(0);
    p[axis] = side;
    normal[axis] = facing * (side ? 1.0 : -1.0);
    return {box.low + p * (box.high - box.low), normal};
}

// Whether the way from a to b crosses the block, made larger by so much.
bool crosses(const glm::dvec3& a, const glm::dvec3& b, double larger) {
    double first = 0.0, last = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = block.low[axis] - larger - a[axis];
        const double high = block.high[axis] + larger - a[axis], d = b[axis] - a[axis];
        if (d == 0.0) {
            if (low > 0.0 || high < 0.0) return false;
            continue;
        }
        first = std::max(first, std::min(low / d, high / d));
        last = std::min(last, std::max(low / d, high / d));
    }
    return first < last;
}

enum class Sight { no, yes, doubtful };

// A room with a block in it; VPLs and texels on both.
struct Furnished {
    DeviceScene scene;
    std::vector<std::pair<glm::dvec3, glm::dvec3>> eyes, points;
    std::vector<bool> eye_on_block, point_on_block;
    std::vector<test::SitePlace> places;
    std::vector<cl_uint> order;
    std::vector<test::SurfacePlace> surface;
    Furnished() : scene(make()) {
        test::Random random(41);
        for (std::uint32_t i = 0; i < shooters; ++i) {
            eye_on_block.push_back(i % 4 == 1);
            eyes.push_back(i % 4 == 1 ? on_box(block, 1, random) : on_box(room, -1, random));
            const glm::vec3 p = scene.frame().to_local(eyes[i].first), n(eyes[i].second);
            places.push_back({p, n, 1e-3f, glm::vec3(1.0f), {{p, n, n}}});
            order.push_back((i * 5 + 3) % shooters);
        }
        for (std::uint32_t t = 0; t < texels; ++t) {
            point_on_block.push_back(t % 5 == 1);
            points.push_back(t % 5 == 1 ? on_box(block, 1, random) : on_box(room, -1, random));
            // The shading normal has no part in it.
            surface.push_back({scene.frame().to_local(points[t].first), test::direction(random),
                               glm::vec3(points[t].second)});
        }
    }
    static DeviceScene make() {
        Scene world = test::plain_scene();
        test::add_box(world, room.low, room.high, -1);
        test::add_box(world, block.low, block.high, 1);
        return test::on_device(world);
    }
    // Doubtful near the horizons, and within a pixel of the block's outline.
    Sight sight(std::uint32_t site, std::size_t texel) const {
        const auto& [eye, up] = eyes[site];
        const auto& [point, normal] = points[texel];
        const glm::dvec3 d = point - eye;
        const double above = glm::dot(d, up), back = -glm::dot(d, normal);
        if (std::min(above, back) <= -1e-5) return Sight::no;
        if (std::min(above, back) < 0.02) return Sight::doubtful;
        if (eye_on_block[site] || point_on_block[texel]) return Sight::yes;  // it is convex
        const double pixel = 2.0 / size * glm::length(d);
        if (crosses(eye, point, -pixel)) return Sight::no;
        return crosses(eye, point, pixel) ? Sight::doubtful : Sight::yes;
    }
};

struct SeenBatch {
    std::uint32_t first, count, first_row, first_texel = 0;
    std::size_t rows() const { return first_row + seen_rows(count) + 1; }
};

std::vector<cl_uchar> see(const Furnished& in, const SeenBatch& batch, const AtlasPasses& passes) {
    const test::Sites sites(in.places, in.order);
    const std::uint32_t stride = test::padded(texels);
    const cl::Buffer seen =
        test::upload(std::vector<cl_uchar>(batch.rows() * stride, not_looked_up));
    test::see(test::hemicubes(sites, &in.scene, {batch.first, batch.count, size, 2e-5f}), texels,
              test::upload_points(in.surface, stride, GBUFFER_GEOMETRIC + 3), seen, batch.first_row,
              passes, batch.first_texel);
    return test::download<cl_uchar>(seen, batch.rows() * stride);
}

CLGI_IN_BOTH_MATHS(See);

TEST_P(See, IsABitForEveryVplThatSeesATexel) {
    const Furnished in;
    const std::uint32_t stride = test::padded(texels);
    int yes = 0, hidden = 0;
    for (const SeenBatch batch :
         {SeenBatch{0, 16, 0}, {3, 1, 0}, {5, 7, 2}, {8, 8, 1}, {2, 9, 3}}) {
        const auto found = see(in, batch, test::atlas_passes(GetParam()));
        const std::size_t last_row = batch.first_row + seen_rows(batch.count);
        for (std::size_t row = 0; row < batch.rows(); ++row)
            for (std::size_t t = 0; t < stride; ++t) {
                const unsigned byte = found[row * stride + t];
                if (row < batch.first_row || row >= last_row) {
                    EXPECT_EQ(byte, not_looked_up) << "row " << row;
                    continue;
                }
                if (t >= texels) continue;
                for (std::uint32_t bit = 0; bit < SEEN_VPLS; ++bit) {
                    const std::size_t s = (row - batch.first_row) * SEEN_VPLS + bit;
                    const bool seen = (byte >> bit & 1u) != 0;
                    if (s >= batch.count) {
                        EXPECT_FALSE(seen) << "bit " << bit << " of no VPL";
                        continue;
                    }
                    const Sight wanted = in.sight(in.order[batch.first + s], t);
                    if (wanted == Sight::doubtful) continue;
                    EXPECT_EQ(seen, wanted == Sight::yes) << "VPL " << s << ", texel " << t;
                    yes += seen;
                    hidden += !seen;
                }
            }
    }
    EXPECT_GT(yes, 3000);
    EXPECT_GT(hidden, 3000);
}

// A packet that lies in part beyond the last texel may write the padding of its row, and no more.
TEST(See, IsTheSameForEveryWidthGroupAndPart) {
    const Furnished in;
    const std::uint32_t stride = test::padded(texels);
    const SeenBatch batch{3, 13, 1}, late{3, 13, 1, 96};
    const auto usual = see(in, batch, test::atlas_passes());
    for (const int width : test::widths()) {
        BuildOptions build;
        build.packet_width = width;
        build.local_size = width == 4 ? 1 : 0;
        const AtlasPasses passes(test::programs(), build);
        const auto whole = see(in, batch, passes), part = see(in, late, passes);
        for (std::size_t k = 0; k < usual.size(); ++k) {
            if (k % stride >= texels) continue;
            EXPECT_EQ(whole[k], usual[k]) << "width " << width << ", byte " << k;
            EXPECT_EQ(part[k], k % stride < 96 ? not_looked_up : usual[k])
                << width << ", byte " << k;
        }
    }
}

TEST(See, OfNoVplWritesNothing) {
    const Furnished in;
    const std::uint32_t stride = test::padded(texels);
    const cl::Buffer seen = test::upload(std::vector<cl_uchar>(stride, not_looked_up));
    test::atlas_passes().see(test::device().queue, {0, size, texels, stride, 0, 0, 0, 0},
                             test::empty<View>(5), seen,
                             test::upload_points(in.surface, stride, GBUFFER_GEOMETRIC + 3), seen);
    EXPECT_EQ(test::download<cl_uchar>(seen, stride), std::vector<cl_uchar>(stride, not_looked_up));
}

}  // namespace
}  // namespace clgi
