// Triangles and receivers for the passes of masks, and what a mask should be, in double precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <array>
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <map>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi::test {

using Triangle = std::array<glm::dvec3, 3>;

// A receiver at the origin, looking along z: its frame is the world's.
struct Eyes {
    std::vector<glm::vec4> positions{{0.0f, 0.0f, 0.0f, 1.0f}};
    std::vector<glm::vec4> normals{{0.0f, 0.0f, 1.0f, 0.0f}};
};

// Blockers as buffers want them, and the lists of clusters.
struct Blockers {
    std::vector<glm::vec4> positions;
    std::vector<glm::uvec4> triangles;
    std::vector<cl_uint> lists{0, 1};
    std::vector<cl_uint> ranges;            // all clusters, where empty
    std::vector<cl_uint> near_lists, near;  // no singles, where both are empty
    std::uint32_t receivers_per_list = ~0u;

    Blockers() = default;
    explicit Blockers(const std::vector<Triangle>& all) {
        for (const Triangle& triangle : all) add(triangle);
    }
    void add(const Triangle& triangle) {
        const auto first = static_cast<cl_uint>(positions.size());
        for (const glm::dvec3& corner : triangle) positions.emplace_back(glm::vec3(corner), 1.0f);
        triangles.emplace_back(first, first + 1, first + 2, 0);
    }
};

inline Triangle random_triangle(Random& random) {
    const auto normal = [&] {  // of three uniform ones: near enough
        return random(-1, 1) + random(-1, 1) + random(-1, 1);
    };
    glm::dvec3 middle(normal(), normal(), normal());
    middle *= random(0.5, 3.0) / glm::length(middle);
    const double size = random(0.05, 1.0);
    Triangle out;
    for (glm::dvec3& p : out)
        p = glm::dvec3(glm::vec3(middle + size * glm::dvec3(normal(), normal(), normal())));
    return out;
}

// Each triangle alone in a cluster, for a receiver of its own.
inline Blockers one_each(const std::vector<Triangle>& all) {
    Blockers out;
    out.lists = {0};
    out.receivers_per_list = 1;
    for (const Triangle& triangle : all) {
        out.ranges.insert(out.ranges.end(),
                          {static_cast<cl_uint>(out.triangles.size() / BLOCKER_CLUSTER), 1});
        out.lists.push_back(static_cast<cl_uint>(out.ranges.size() / 2));
        out.add(triangle);
        const glm::uvec4 corner(out.triangles.back().x);  // keeps the box as it is
        while (out.triangles.size() % BLOCKER_CLUSTER) out.triangles.push_back(corner);
    }
    return out;
}

struct Drawn {
    MaskOptions options;
    ReceiverBuffers receivers;
    BlockerBuffers blockers;
    cl::Buffer status;
    std::vector<cl_uint> words;  // [MASK_WORDS][stride]

    bool bit(std::size_t receiver, int column, int row) const {
        const int at = row / 32 * MASK_COLUMNS(options.size) + column;
        return words[static_cast<std::size_t>(at) * receivers.stride + receiver] >> (row % 32) & 1;
    }
    int count(std::size_t receiver) const {
        int out = 0;
        for (int word = 0; word < MASK_WORDS(options.size); ++word)
            out += __builtin_popcount(
                words[static_cast<std::size_t>(word) * receivers.stride + receiver]);
        return out;
    }
    // Words of one receiver.
    std::vector<cl_uint> mask(std::size_t receiver) const {
        std::vector<cl_uint> out;
        for (int word = 0; word < MASK_WORDS(options.size); ++word)
            out.push_back(words[static_cast<std::size_t>(word) * receivers.stride + receiver]);
        return out;
    }
    std::array<cl_uint, 2> counted() const {
        const auto values = download<cl_uint>(status, MASK_STATUS_WORDS);
        return {values[0], values[1]};
    }
};

// Passes of every kind that a test program asks for, built once.
inline const MaskPasses& mask_passes(const MaskOptions& masks = {},
                                     const BuildOptions& how = usual_build()) {
    static std::map<std::string, MaskPasses> made;
    std::string key;
    for (const std::size_t part :
         {static_cast<std::size_t>(masks.size), static_cast<std::size_t>(masks.planes),
          static_cast<std::size_t>(masks.table_size), static_cast<std::size_t>(masks.block),
          static_cast<std::size_t>(masks.bands), static_cast<std::size_t>(how.math),
          static_cast<std::size_t>(how.packet_width), how.local_size})
        key += std::to_string(part) + " ";
    return made.try_emplace(key, programs(), masks, how).first->second;
}

// What `mask` reads: the table of planes, or the heights of pixels.
inline const cl::Buffer& mask_table(const MaskOptions& masks) {
    static std::map<std::array<int, 3>, cl::Buffer> made;
    cl::Buffer& out = made[{masks.size, static_cast<int>(masks.planes), masks.table_size}];
    if (out()) return out;
    const cl::Buffer heights = upload(pixel_heights(masks.size));
    if (masks.planes == EdgePlanes::exact) return out = heights;
    out = empty<char>(mask_table_bytes(masks));
    mask_passes(masks).planes(device().queue, heights, out);
    device().queue.finish();
    return out;
}

inline Drawn draw_masks(const Blockers& blockers, const Eyes& eyes = {},
                        const MaskOptions& masks = {}, const BuildOptions& how = usual_build()) {
    const MaskPasses& passes = mask_passes(masks, how);
    const cl::CommandQueue& queue = device().queue;
    Drawn out;
    out.options = masks;
    ReceiverBuffers& r = out.receivers;
    r.count = static_cast<std::uint32_t>(eyes.positions.size());
    r.stride = plane_stride(r.count);
    r.planes = empty<float>(std::size_t{RECEIVER_PLANES} * r.stride);
    const std::size_t words = static_cast<std::size_t>(MASK_WORDS(masks.size)) * r.stride;
    r.masks = upload(std::vector<cl_uint>(words, 0xdeadbeefu));
    r.transfer = empty<float>(static_cast<std::size_t>(sh::terms(masks.bands)) * r.stride);
    BlockerBuffers& b = out.blockers;
    b.triangle_count = static_cast<std::uint32_t>(blockers.triangles.size());
    b.stride = blocker_stride(b.triangle_count);
    b.corners = empty<float>(std::size_t{BLOCKER_PLANES} * std::max(b.stride, 1u));
    b.boxes = empty<BlockerBox>(b.stride / BLOCKER_CLUSTER + 1);
    b.lists = upload(blockers.lists);
    b.ranges = upload(blockers.ranges.empty() ? std::vector<cl_uint>{0, b.stride / BLOCKER_CLUSTER}
                                              : blockers.ranges);
    b.receivers_per_list = blockers.receivers_per_list;
    if (!blockers.near_lists.empty()) {
        b.near_lists = upload(blockers.near_lists);
        b.near = blockers.near.empty() ? empty<cl_uint>(1) : upload(blockers.near);
    }
    out.status = upload(std::vector<cl_uint>(MASK_STATUS_WORDS));
    passes.receivers(queue, upload(eyes.positions), upload(eyes.normals), r, out.status);
    const bool none = blockers.triangles.empty();
    passes.blockers(queue, none ? empty<glm::uvec4>(1) : upload(blockers.triangles),
                    none ? empty<glm::vec4>(1) : upload(blockers.positions), b, out.status);
    passes.mask(queue, r, b, mask_table(masks));
    out.words = download<cl_uint>(r.masks, words);
    return out;
}

// 37 receivers with a normal each, among 200 triangles.
struct MaskHeap {
    explicit MaskHeap(std::uint64_t seed = 5, double scale = 1.0) {
        Random random(seed);
        for (int i = 0; i < 200; ++i) {
            Triangle t = random_triangle(random);
            for (glm::dvec3& p : t) p *= scale;
            blockers.add(t);
        }
        eyes.positions.clear();
        eyes.normals.clear();
        for (int i = 0; i < 37; ++i) {
            const auto s = static_cast<float>(scale);
            eyes.positions.emplace_back(s * static_cast<float>(random(-1, 1)),
                                        s * static_cast<float>(random(-1, 1)),
                                        s * static_cast<float>(random(-1, 1)), 1);
            eyes.normals.emplace_back(random(-1, 1), random(-1, 1), random(-1, 1), 0);
        }
    }
    Blockers blockers;
    Eyes eyes;
};

inline void expect_same_masks(const Drawn& a, const Drawn& b, const std::string& what) {
    for (std::uint32_t i = 0; i < a.receivers.count; ++i)
        ASSERT_EQ(a.mask(i), b.mask(i)) << what << ", receiver " << i;
}

// Transfer vectors [receiver][term] of masks that were drawn.
inline std::vector<std::vector<double>> transfer_vectors(
    const Drawn& drawn, CellIntegral integral = CellIntegral::exact,
    const BuildOptions& how = usual_build()) {
    const MaskOptions& masks = drawn.options;
    const MaskWeights weights = mask_weights(masks.size, masks.block, masks.bands, integral);
    mask_passes(masks, how)
        .integrate(device().queue, drawn.receivers, upload(weights.values),
                   upload(weights.directions));
    const auto terms = static_cast<std::size_t>(sh::terms(masks.bands));
    const std::size_t stride = drawn.receivers.stride;
    const std::vector<float> values = download<float>(drawn.receivers.transfer, terms * stride);
    std::vector<std::vector<double>> out(drawn.receivers.count);
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t k = 0; k < terms; ++k) out[i].push_back(values[k * stride + i]);
    return out;
}

// ||a - b|| / ||b||
inline double relative_l2(const std::vector<double>& a, const std::vector<double>& b) {
    double error = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        error += (a[i] - b[i]) * (a[i] - b[i]);
        whole += b[i] * b[i];
    }
    return std::sqrt(error / whole);
}

// ---- what a mask should be ---------------------------------------------------------------------

struct TangentFrame {
    glm::dvec3 tangent, bitangent, normal;
};

// [Duff17, listing 3] in double precision.
inline TangentFrame frame_of(const glm::vec3& normal) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(normal));
    const double s = std::copysign(1.0, n.z), a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return {{1.0 + s * n.x * n.x * a, s * b, -s * n.x}, {b, s + n.y * n.y * a, -n.y}, n};
}

struct Pixel {
    int column, row;
    glm::dvec3 direction;  // in the frame
};

inline std::vector<Pixel> disc_pixels(int size) {
    std::vector<Pixel> out;
    for (int column = 0; column < size; ++column)
        for (int row = 0; row < size; ++row) {
            const double x = (2 * column + 1.0) / size - 1.0, y = (2 * row + 1.0) / size - 1.0;
            if (x * x + y * y < 1.0)
                out.push_back({column, row, {x, y, std::sqrt(1.0 - x * x - y * y)}});
        }
    return out;
}

// How far a direction is inside the cone of a triangle seen from `eye`: the least of the three
// sines to its planes; below 0 outside. From either side; a triangle without a cone is outside of
// all.
inline double inside(const Triangle& triangle, const glm::dvec3& eye, const glm::dvec3& direction) {
    const glm::dvec3 a = triangle[0] - eye, b = triangle[1] - eye, c = triangle[2] - eye;
    const double turn = glm::dot(a, glm::cross(b, c));
    if (turn == 0.0) return -1.0;
    double least = 1.0;
    for (const glm::dvec3& plane : {glm::cross(a, b), glm::cross(b, c), glm::cross(c, a)})
        least = std::min(
            least, std::copysign(1.0, turn) * glm::dot(plane, direction) / glm::length(plane));
    return least;
}

// ---- meshes ------------------------------------------------------------------------------------

inline std::vector<Triangle> icosahedron() {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    const glm::dvec3 v[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int f[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<Triangle> out;
    for (const auto& face : f) out.push_back({v[face[0]], v[face[1]], v[face[2]]});
    return out;
}

// A sphere around the origin, of radius 1 at its corners; 20 * 4^levels triangles.
inline std::vector<Triangle> icosphere(int levels) {
    std::vector<Triangle> out = icosahedron();
    for (Triangle& t : out)
        for (glm::dvec3& p : t) p = glm::normalize(p);
    for (int level = 0; level < levels; ++level) {
        std::vector<Triangle> finer;
        for (const Triangle& t : out) {
            const glm::dvec3 a = glm::normalize(t[0] + t[1]), b = glm::normalize(t[1] + t[2]),
                             c = glm::normalize(t[2] + t[0]);
            finer.push_back({t[0], a, c});
            finer.push_back({a, t[1], b});
            finer.push_back({c, b, t[2]});
            finer.push_back({a, b, c});
        }
        out = finer;
    }
    return out;
}

inline std::vector<Triangle> placed(std::vector<Triangle> triangles, double scale,
                                    const glm::dvec3& at) {
    for (Triangle& t : triangles)
        for (glm::dvec3& p : t) p = scale * p + at;
    return triangles;
}

}  // namespace clgi::test
