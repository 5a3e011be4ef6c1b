// EXT_meshopt_compression: what meshoptimizer packed is what comes out, and nothing that it says of
// itself is believed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if CLGI_HAS_MESHOPT

#include <meshoptimizer.h>

#include "packed_scenes.hpp"
#include "time_limit.hpp"

namespace clgi::test {
namespace {

using GltfMeshopt = TimeLimit<20>;

const char* const meshopt_name = "EXT_meshopt_compression";

template <typename T>
Bytes packed_vertices(const std::vector<T>& values) {
    Bytes bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(),
                                            values.size(), sizeof(T)));
    return bytes;
}

Bytes packed_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    Bytes bytes(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    bytes.resize(
        meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

Bytes packed_sequence(const std::vector<std::uint32_t>& indices, std::size_t vertices) {
    Bytes bytes(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    bytes.resize(
        meshopt_encodeIndexSequence(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

// Its second buffer has no bytes: only compressed views show it.
struct MeshoptDraft {
    GltfDraft draft;
    std::size_t unpacked = 0;

    int view(const Bytes& bytes, std::size_t count, std::size_t stride, const char* mode,
             const char* filter = "NONE") {
        const int index = draft.view(bytes);
        json packed = draft.document["bufferViews"][index];
        packed.update(
            {{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
        json entry = {{"buffer", 1}, {"byteOffset", unpacked}, {"byteLength", count * stride}};
        if (mode == std::string("ATTRIBUTES")) entry["byteStride"] = stride;
        entry["extensions"][meshopt_name] = packed;
        draft.document["bufferViews"][index] = entry;
        unpacked += count * stride;
        return index;
    }

    template <typename T>
    int attribute(const std::vector<T>& values, const char* type, int component, bool normalized) {
        const int data = view(packed_vertices(values), values.size(), sizeof(T), "ATTRIBUTES");
        return draft.accessor(data, values.size(), type, component, normalized);
    }

    GltfDraft finished() const {
        GltfDraft out = draft;
        if (out.document.contains("nodes")) out.add("scenes", {{"nodes", {0}}});
        const std::string uri = "data:application/octet-stream;base64," + base64(out.bytes);
        json fallback = {{"byteLength", std::max<std::size_t>(unpacked, 1)}};
        fallback["extensions"][meshopt_name]["fallback"] = true;
        out.document["buffers"] =
            json::array({json{{"uri", uri}, {"byteLength", out.bytes.size()}}, fallback});
        return out;
    }
    json& packed(int view) {
        return draft.document["bufferViews"][view]["extensions"][meshopt_name];
    }
};

MeshoptDraft packed_surface(const WavySurface& surface, bool as_triangles,
                            std::size_t index_bytes) {
    MeshoptDraft out;
    json attributes = {{"POSITION", out.attribute(surface.positions, "VEC3", float_type, false)},
                       {"NORMAL", out.attribute(surface.normals, "VEC3", float_type, false)},
                       {"TEXCOORD_0", out.attribute(surface.uvs, "VEC2", float_type, false)},
                       {"COLOR_0", out.attribute(surface.colors, "VEC4", uint8_type, true)}};
    const std::size_t count = surface.indices.size();
    const int view = as_triangles ? out.view(packed_triangles(surface.indices, surface.count()),
                                             count, index_bytes, "TRIANGLES")
                                  : out.view(packed_sequence(surface.indices, surface.count()),
                                             count, index_bytes, "INDICES");
    const int type = index_bytes == 2 ? uint16_type : uint32_type;
    const int corners = out.draft.accessor(view, count, "SCALAR", type);
    out.draft.show({{"attributes", attributes}, {"indices", corners}});
    return out;
}

TEST_F(GltfMeshopt, SurfacesAreThoseThatWerePacked) {
    const WavySurface surface;
    const auto expected = triangle_soup(surface.load());
    for (const bool as_triangles : {true, false}) {
        for (const std::size_t index_bytes : {2, 4}) {
            const Scene scene = packed_surface(surface, as_triangles, index_bytes)
                                    .finished()
                                    .load({.lightmaps = true});
            EXPECT_EQ(triangle_soup(scene), expected) << as_triangles << index_bytes;
            EXPECT_TRUE(scene.warnings.empty());
        }
    }
}

TEST_F(GltfMeshopt, ExponentsGiveBackShortNumbers) {
    WavySurface surface;
    Floats3 filtered(surface.count());
    meshopt_encodeFilterExp(filtered.data(), surface.count(), 12, 15, &surface.positions[0][0]);
    MeshoptDraft out;
    const int view =
        out.view(packed_vertices(filtered), surface.count(), 12, "ATTRIBUTES", "EXPONENTIAL");
    const int positions = out.draft.accessor(view, surface.count(), "VEC3", float_type);
    const int corners = out.draft.accessor(out.draft.view(surface.indices), surface.indices.size(),
                                           "SCALAR", uint32_type);
    out.draft.show({{"attributes", {{"POSITION", positions}}}, {"indices", corners}});
    const Scene scene = out.finished().load();
    GltfDraft plain;
    const int plain_positions = plain.vec3(surface.positions);
    const int plain_corners =
        plain.accessor(plain.view(surface.indices), surface.indices.size(), "SCALAR", uint32_type);
    plain.show({{"attributes", {{"POSITION", plain_positions}}}, {"indices", plain_corners}});
    // Multiples of 1/8 below 4 have five bits: 15 hold them exactly.
    EXPECT_EQ(triangle_soup(scene), triangle_soup(plain.load()));
}

TEST_F(GltfMeshopt, OctahedralNormalsAreThoseThatWerePackedToAStep) {
    const WavySurface surface;
    const std::size_t count = surface.count();
    const auto check = [&](auto unit, int component, int bits) {
        using Unit = decltype(unit);
        std::vector<std::array<float, 4>> source(count);
        for (std::size_t i = 0; i < count; ++i) {
            const auto& n = surface.normals[i];
            source[i] = {n[0], n[1], n[2], 0.0f};
        }
        std::vector<std::array<Unit, 4>> filtered(count);
        meshopt_encodeFilterOct(filtered.data(), count, sizeof(filtered[0]), bits, &source[0][0]);
        MeshoptDraft out;
        out.draft.document["extensionsUsed"] = {"KHR_mesh_quantization"};
        const int view = out.view(packed_vertices(filtered), count, sizeof(filtered[0]),
                                  "ATTRIBUTES", "OCTAHEDRAL");
        const int normals = out.draft.accessor(view, count, "VEC3", component, true);
        const int positions = out.draft.vec3(surface.positions);
        const int corners = out.draft.accessor(out.draft.view(surface.indices),
                                               surface.indices.size(), "SCALAR", uint32_type);
        out.draft.show(
            {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", corners}});
        const Scene scene = out.finished().load();
        ASSERT_EQ(scene.normals.size(), count);
        // Half a step of x and y moves the vector by at most sqrt(18) half steps, and three
        // components are rounded; making it a unit vector at most doubles that.
        const double half_step = 0.5 / ((1 << (bits - 1)) - 1);
        const double bound = 2.0 * (std::sqrt(18.0) + std::sqrt(3.0)) * half_step;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& n = surface.normals[i];
            EXPECT_VEC_NEAR(scene.normals[i], glm::dvec3(n[0], n[1], n[2]), bound);
        }
    };
    check(std::int8_t{}, int8_type, 8);
    check(std::int16_t{}, int16_type, 16);
}

TEST_F(GltfMeshopt, QuaternionsTurnCopiesAsTheyWerePacked) {
    const std::vector<std::array<float, 4>> turns = {
        {0.5f, 0.5f, 0.5f, 0.5f}, {0.6f, 0, 0, 0.8f}, {0, -0.28f, 0, 0.96f}, {0, 0, 0.8f, -0.6f}};
    std::vector<std::array<std::int16_t, 4>> filtered(turns.size());
    meshopt_encodeFilterQuat(filtered.data(), turns.size(), 8, 16, &turns[0][0]);
    MeshoptDraft out;
    const int view =
        out.view(packed_vertices(filtered), turns.size(), 8, "ATTRIBUTES", "QUATERNION");
    const int rotation = out.draft.accessor(view, turns.size(), "VEC4", int16_type, true);
    const int positions = out.draft.vec3(one_triangle);
    json node;
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotation;
    out.draft.show({{"attributes", {{"POSITION", positions}}}}, node);
    const Scene scene = out.finished().load();
    ASSERT_EQ(scene.triangles.size(), turns.size());
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const glm::dvec3 u(turns[i][0], turns[i][1], turns[i][2]);
        for (const int axis : {1, 2}) {
            const glm::dvec3 p(one_triangle[axis][0], one_triangle[axis][1], 0.0);
            const glm::dvec3 t = 2.0 * glm::cross(u, p);
            const glm::dvec3 turned = p + double{turns[i][3]} * t + glm::cross(u, t);
            // A step of 1/32767 in three components, at most sqrt(3) times that in the fourth, and
            // twice the error of a quaternion in what it turns: 2 (3 + sqrt(3)) < 10.
            EXPECT_VEC_NEAR(corner(scene, i, axis), turned, 10.0 / 32767.0) << i;
        }
    }
}

TEST_F(GltfMeshopt, QuantisedPositionsNeedOnlyTheirExtension) {
    const std::vector<std::array<std::int16_t, 4>> corners = {
        {-300, 0, 7, 0}, {500, 1, 7, 0}, {0, 900, 7, 0}};
    MeshoptDraft out;
    const int view = out.view(packed_vertices(corners), 3, 8, "ATTRIBUTES");
    const int positions = out.draft.accessor(view, 3, "VEC3", int16_type);
    out.draft.show({{"attributes", {{"POSITION", positions}}}});
    EXPECT_NE(refusal(out.finished()).find("not allowed there"), std::string::npos);
    out.draft.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    out.draft.document["extensionsRequired"] = {"KHR_mesh_quantization", meshopt_name};
    const Scene scene = out.finished().load();
    EXPECT_EQ(corner(scene, 0, 0), glm::dvec3(-300, 0, 7));
    EXPECT_EQ(corner(scene, 0, 2), glm::dvec3(0, 900, 7));
}

// A fallback is for readers without the extension: it need not even exist.
TEST_F(GltfMeshopt, FallbacksAreNotRead) {
    GltfDraft draft = packed_surface(WavySurface(), true, 2).finished();
    draft.document["buffers"][1]["uri"] = "no-such-file.bin";
    EXPECT_EQ(refusal(draft), "");
    draft.document["buffers"][1].erase("uri");
    draft.document["buffers"][1].erase("extensions");  // as early files have it
    EXPECT_EQ(refusal(draft), "");
}

TEST_F(GltfMeshopt, PlainViewsOfAnEmptyFallbackAreRefused) {
    MeshoptDraft out = packed_surface(WavySurface(), true, 2);
    out.draft.document["bufferViews"][0].erase("extensions");
    EXPECT_NE(refusal(out.finished()).find("needs data that only a fallback buffer has"),
              std::string::npos);
}

TEST_F(GltfMeshopt, WhatViewsSayOfThemselvesIsChecked) {
    constexpr std::uint64_t huge = UINT64_MAX;
    struct Case {
        int view;  // 0: positions, 3: colours, 4: indices
        const char* key;
        json value;
        const char* because;
    };
    const Case cases[] = {{0, "count", 62, "gives 744 bytes"},
                          {0, "count", 1 << 20, "cannot hold"},
                          {0, "count", huge, "cannot hold"},
                          {0, "count", 0, "at least 1"},
                          {0, "byteStride", 10, "byteStride of 10"},
                          {0, "byteStride", 260, "byteStride of 260"},
                          {0, "byteStride", huge - 3, "byteStride of"},
                          {0, "byteStride", 8, "gives 504 bytes"},
                          {0, "byteOffset", 1 << 30, "its buffer has"},
                          {0, "byteOffset", huge, "its buffer has"},
                          {0, "byteLength", huge, "its buffer has"},
                          {0, "byteLength", 1, "cannot hold"},
                          {0, "buffer", 2, "there are 2 buffers"},
                          {0, "buffer", 1, "is in a buffer without data"},
                          {0, "mode", "POINTS", "none of"},
                          {0, "filter", "GZIP", "none of"},
                          {0, "filter", "OCTAHEDRAL", "octahedral vectors of 12 bytes"},
                          {0, "filter", "QUATERNION", "quaternions of 12 bytes"},
                          {3, "filter", "QUATERNION", "quaternions of 4 bytes"},
                          {4, "filter", "EXPONENTIAL", "a filter for indices"},
                          {4, "byteStride", 1, "indices of 1 bytes"},
                          {4, "byteStride", 8, "indices of 8 bytes"},
                          {4, "count", 287, "corners of triangles"},
                          {4, "mode", "ATTRIBUTES", "byteStride of 2"}};
    for (const Case& wrong : cases) {
        MeshoptDraft out = packed_surface(WavySurface(), true, 2);
        out.packed(wrong.view)[wrong.key] = wrong.value;
        const std::string message = refusal(out.finished());
        EXPECT_NE(message.find(wrong.because), std::string::npos)
            << wrong.key << " " << wrong.value << ": " << message;
    }
    MeshoptDraft out = packed_surface(WavySurface(), true, 2);
    out.draft.document["bufferViews"][0]["byteStride"] = 16;
    EXPECT_NE(refusal(out.finished()).find("the view one of 16"), std::string::npos);
}

// The most that a stream can stand for, named by many views: 64 bytes of zeros a byte.
TEST_F(GltfMeshopt, ManyViewsOfTheSameBytesAreBounded) {
    const std::vector<std::array<float, 16>> zeros(1 << 14);
    MeshoptDraft out;
    const int view = out.view(packed_vertices(zeros), zeros.size(), 64, "ATTRIBUTES");
    EXPECT_EQ(refusal(out.finished()), "");
    for (int i = 0; i < 20'000; ++i)
        out.draft.add("bufferViews", out.draft.document["bufferViews"][view]);
    EXPECT_NE(refusal(out.finished()).find("longer, with the compressed parts before it"),
              std::string::npos);
}

TEST_F(GltfMeshopt, DamagedStreamsAreRefusedInOneLineOrLoad) {
    const WavySurface surface;
    const auto positions = [&](const Bytes& bytes) {
        MeshoptDraft out;
        const int view = out.view(bytes, surface.count(), 12, "ATTRIBUTES");
        const int accessor = out.draft.accessor(view, surface.count(), "VEC3", float_type);
        out.draft.show({{"attributes", {{"POSITION", accessor}}}});
        return out.finished();
    };
    const auto corners = [&](const char* mode) {
        return [&surface, mode](const Bytes& bytes) {
            MeshoptDraft out;
            const int view = out.view(bytes, surface.indices.size(), 4, mode);
            const int indices =
                out.draft.accessor(view, surface.indices.size(), "SCALAR", uint32_type);
            const int accessor = out.draft.vec3(surface.positions);
            out.draft.show({{"attributes", {{"POSITION", accessor}}}, {"indices", indices}});
            return out.finished();
        };
    };
    // No beginning holds all: each is refused.
    const Bytes vertices = packed_vertices(surface.positions);
    EXPECT_GE(expect_damage_is_survived(vertices, positions), int(vertices.size()) - 1);
    const Bytes triangles = packed_triangles(surface.indices, surface.count());
    EXPECT_GE(expect_damage_is_survived(triangles, corners("TRIANGLES")),
              int(triangles.size()) - 1);
    const Bytes sequence = packed_sequence(surface.indices, surface.count());
    EXPECT_GE(expect_damage_is_survived(sequence, corners("INDICES")), int(sequence.size()) - 1);
}

}  // namespace
}  // namespace clgi::test

#endif
