// KHR_draco_mesh_compression: without quantisation the surface is the one that was packed, and what
// a stream declares is compared with the accessors before anything is allocated.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if CLGI_HAS_DRACO

#include <draco/compression/encode.h>

#include "packed_scenes.hpp"
#include "time_limit.hpp"

namespace clgi::test {
namespace {

using GltfDraco = TimeLimit<20>;

const char* const draco_name = "KHR_draco_mesh_compression";

class DracoMesh {
public:
    DracoMesh(std::size_t points, const std::vector<std::uint32_t>& indices) {
        mesh_.set_num_points(static_cast<std::uint32_t>(points));
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            mesh_.AddFace({draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]),
                           draco::PointIndex(indices[i + 2])});
        }
    }

    // Returns its id.
    template <typename T, std::size_t n>
    int add(draco::GeometryAttribute::Type kind, draco::DataType type,
            const std::vector<std::array<T, n>>& values, bool normalized = false) {
        draco::GeometryAttribute attribute;
        attribute.Init(kind, nullptr, n, type, normalized, n * sizeof(T), 0);
        const int id =
            mesh_.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
        for (std::uint32_t i = 0; i < values.size(); ++i)
            mesh_.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
        return id;
    }

    Bytes packed(int method, int position_bits = 0) {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        if (position_bits > 0)
            encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, position_bits);
        draco::EncoderBuffer buffer;
        EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh_, &buffer).ok());
        return {buffer.data(), buffer.data() + buffer.size()};
    }

private:
    draco::Mesh mesh_;
};

GltfDraft draco_draft(const Bytes& stream, const json& ids, const json& attributes, int indices,
                      GltfDraft draft) {
    json primitive = {{"attributes", attributes}, {"indices", indices}};
    primitive["extensions"][draco_name] = {{"bufferView", draft.view(stream)}, {"attributes", ids}};
    draft.show(primitive);
    draft.add("scenes", {{"nodes", {0}}});
    draft.document["extensionsUsed"] = {draco_name, "KHR_mesh_quantization"};
    return draft;
}

Bytes packed_surface_draco(const WavySurface& surface, int method) {
    DracoMesh mesh(surface.count(), surface.indices);
    mesh.add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, surface.positions);
    mesh.add(draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, surface.normals);
    mesh.add(draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, surface.uvs);
    mesh.add(draco::GeometryAttribute::COLOR, draco::DT_UINT8, surface.colors, true);
    return mesh.packed(method);
}

GltfDraft surface_draft(const Bytes& stream, const WavySurface& surface) {
    GltfDraft draft;
    const std::size_t count = surface.count();
    const json attributes = {{"POSITION", draft.accessor(-1, count, "VEC3", float_type)},
                             {"NORMAL", draft.accessor(-1, count, "VEC3", float_type)},
                             {"TEXCOORD_0", draft.accessor(-1, count, "VEC2", float_type)},
                             {"COLOR_0", draft.accessor(-1, count, "VEC4", uint8_type, true)}};
    const int indices = draft.accessor(-1, surface.indices.size(), "SCALAR", uint16_type);
    return draco_draft(stream, {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}, {"COLOR_0", 3}},
                       attributes, indices, draft);
}

TEST_F(GltfDraco, SurfacesAreThoseThatWerePacked) {
    const WavySurface surface;
    const auto expected = triangle_soup(surface.load());
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        GltfDraft draft = surface_draft(packed_surface_draco(surface, method), surface);
        draft.document["extensionsRequired"] = {draco_name};
        const Scene scene = draft.load({.lightmaps = true});
        EXPECT_EQ(triangle_soup(scene), expected) << method;
        EXPECT_TRUE(scene.warnings.empty());
    }
}

// An accessor may have plain data of its own for other readers, and others may show it.
TEST_F(GltfDraco, TheCompressedMeshGoesBeforeTheFallback) {
    const WavySurface surface;
    const Bytes stream = packed_surface_draco(surface, draco::MESH_EDGEBREAKER_ENCODING);
    GltfDraft draft = surface_draft(stream, surface);
    Floats3 other(surface.count(), {5, 5, 5});
    other[1] = {6, 5, 5};
    other[2] = {5, 6, 5};
    const int position = draft.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    draft.document["accessors"][position]["bufferView"] = draft.view(other);
    EXPECT_EQ(triangle_soup(draft.load({.lightmaps = true})), triangle_soup(surface.load()));

    GltfDraft both = draft;
    both.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", position}}}});
    const Scene scene = both.load();
    EXPECT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(corner(scene, scene.parts[1].first_triangle, 1), glm::dvec3(6, 5, 5));
}

TEST_F(GltfDraco, IntegersKeepTheirFormat) {
    const std::vector<std::array<std::int16_t, 3>> positions = {
        {-300, 0, 7}, {500, -1, 7}, {0, 900, 7}};
    DracoMesh mesh(3, {0, 1, 2});
    mesh.add(draco::GeometryAttribute::POSITION, draco::DT_INT16, positions);
    const Bytes stream = mesh.packed(draco::MESH_SEQUENTIAL_ENCODING);
    const auto draft_of = [&](int component) {
        GltfDraft draft;
        const int position = draft.accessor(-1, 3, "VEC3", component);
        const int indices = draft.accessor(-1, 3, "SCALAR", uint16_type);
        return draco_draft(stream, {{"POSITION", 0}}, {{"POSITION", position}}, indices, draft);
    };
    const Scene scene = draft_of(int16_type).load();
    for (int i = 0; i < 3; ++i) {
        const auto& p = positions[static_cast<std::size_t>(i)];
        EXPECT_EQ(corner(scene, 0, i), glm::dvec3(p[0], p[1], p[2]));
    }
    EXPECT_NE(refusal(draft_of(int8_type)).find("cannot hold"), std::string::npos);
    EXPECT_NE(refusal(draft_of(uint16_type)).find("cannot hold"), std::string::npos);
}

TEST_F(GltfDraco, StripsBecomeTriangles) {
    const WavySurface surface;
    GltfDraft draft =
        surface_draft(packed_surface_draco(surface, draco::MESH_EDGEBREAKER_ENCODING), surface);
    draft.document["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(triangle_soup(draft.load({.lightmaps = true})), triangle_soup(surface.load()));
}

TEST_F(GltfDraco, PrimitivesThatShareAMeshUnpackItOnce) {
    const WavySurface surface;
    const Bytes stream = packed_surface_draco(surface, draco::MESH_EDGEBREAKER_ENCODING);
    GltfDraft draft = surface_draft(stream, surface);
    json& primitives = draft.document["meshes"][0]["primitives"];
    const json primitive = primitives[0];
    for (int i = 1; i < 1000; ++i) primitives.push_back(primitive);
    EXPECT_EQ(draft.load().triangles.size(), 1000 * surface.indices.size() / 3);
}

TEST_F(GltfDraco, WhatTheAccessorsSayMustAgree) {
    const WavySurface surface;
    struct Case {
        const char* path;
        json value;
        const char* because;
    };
    const char* const extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const std::string in = extension;
    const std::string id = in + "/attributes/POSITION", extra = in + "/attributes/TANGENT",
                      view = in + "/bufferView";
    const Case cases[] = {{"/accessors/0/count", 62, "elements"},
                          {"/accessors/0/type", "VEC2", "components"},
                          {"/accessors/0/type", "MAT2", "components"},
                          {"/accessors/2/count", 64, "elements"},
                          {"/accessors/4/count", 285, "triangles"},
                          {"/accessors/4/count", 289, "triangles"},
                          {"/accessors/4/type", "VEC3", "not scalars"},
                          {"/meshes/0/primitives/0/mode", 1, "for triangles"},
                          {id.c_str(), 4, "which the compressed mesh has not"},
                          {id.c_str(), -1, "whole number"},
                          {extra.c_str(), 0, "the primitive has not"},
                          {view.c_str(), 1, "there are 1 bufferViews"}};
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Bytes stream = packed_surface_draco(surface, method);
        for (const Case& wrong : cases) {
            GltfDraft draft = surface_draft(stream, surface);
            draft.document[json::json_pointer(wrong.path)] = wrong.value;
            const std::string message = refusal(draft);
            EXPECT_NE(message.find(wrong.because), std::string::npos)
                << wrong.path << " " << wrong.value << ": " << message;
        }
        GltfDraft fewer = surface_draft(stream, surface);
        for (int i = 0; i < 4; ++i) fewer.document["accessors"][i]["count"] = 60;
        EXPECT_NE(refusal(fewer).find("63 vertices, its accessors 60"), std::string::npos)
            << refusal(fewer);
        GltfDraft without = surface_draft(stream, surface);
        without.document["meshes"][0]["primitives"][0].erase("indices");
        EXPECT_NE(refusal(without).find("needs an accessor of indices"), std::string::npos);
    }
}

// A header and counts, and nothing after that.
TEST_F(GltfDraco, CountsAreJudgedBeforeDecoding) {
    const auto varint = [](std::uint32_t value) {
        Bytes bytes;
        for (; value >= 128; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 128));
        bytes.push_back(static_cast<std::uint8_t>(value));
        return bytes;
    };
    const auto message = [&](std::uint8_t method, std::uint32_t triangles, std::uint8_t seams) {
        Bytes stream = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, method, 0, 0};
        if (method == 1) stream.push_back(0);  // the traversal
        for (const std::uint32_t count : {method == 1 ? 3 : triangles, method == 1 ? triangles : 3})
            for (const std::uint8_t byte : varint(count)) stream.push_back(byte);
        stream.push_back(seams);
        GltfDraft draft;
        const int position = draft.accessor(-1, 3, "VEC3", float_type);
        const int indices = draft.accessor(-1, std::size_t{3} * triangles, "SCALAR", uint32_type);
        return refusal(
            draco_draft(stream, {{"POSITION", 0}}, {{"POSITION", position}}, indices, draft));
    };
    for (const std::uint8_t method : {0, 1}) {
        EXPECT_NE(message(method, 0x7fffffff, 0).find("more triangles than are allowed"),
                  std::string::npos);
        EXPECT_NE(message(method, 1 << 25, 0).find("times its size"), std::string::npos);
        EXPECT_NE(message(method, 1, 0).find("damaged"), std::string::npos);
    }
    // A table for each of 255 sets of seams.
    EXPECT_NE(message(1, 1 << 16, 255).find("times its size"), std::string::npos);
    EXPECT_NE(message(1, 1 << 16, 0).find("damaged"), std::string::npos);
}

TEST_F(GltfDraco, TrianglesAreBoundedByMaxTriangles) {
    const WavySurface surface;
    const GltfDraft draft =
        surface_draft(packed_surface_draco(surface, draco::MESH_EDGEBREAKER_ENCODING), surface);
    const std::size_t there = surface.indices.size() / 3;
    EXPECT_EQ(refusal(draft, {.max_triangles = there}), "");
    EXPECT_NE(refusal(draft, {.max_triangles = there - 1}).find("more triangles than are allowed"),
              std::string::npos);
}

// A thousand attributes of 4 numbers: few bytes each where all values are the same.
TEST_F(GltfDraco, AttributesAreBoundedBeforeTheyHaveValues) {
    constexpr int side = 65;
    Floats3 positions;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
            const std::uint32_t i = x + side * y;
            if (x + 1 == side || y + 1 == side) continue;
            for (const std::uint32_t c : {i, i + 1, i + side, i + side, i + 1, i + side + 1})
                indices.push_back(c);
        }
    }
    const auto message = [&](int attributes) {
        DracoMesh mesh(positions.size(), indices);
        mesh.add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, positions);
        const std::vector<std::array<std::uint8_t, 4>> zeros(positions.size());
        for (int i = 0; i < attributes; ++i)
            mesh.add(draco::GeometryAttribute::GENERIC, draco::DT_UINT8, zeros);
        const Bytes stream = mesh.packed(draco::MESH_SEQUENTIAL_ENCODING, 10);
        GltfDraft draft;
        const int position = draft.accessor(-1, positions.size(), "VEC3", float_type);
        const int corners = draft.accessor(-1, indices.size(), "SCALAR", uint32_type);
        return refusal(
            draco_draft(stream, {{"POSITION", 0}}, {{"POSITION", position}}, corners, draft));
    };
    EXPECT_EQ(message(3), "");
    EXPECT_NE(message(1000).find("times its size"), std::string::npos);
}

TEST_F(GltfDraco, DamagedStreamsAreRefusedInOneLineOrLoad) {
    const WavySurface surface;
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Bytes stream = packed_surface_draco(surface, method);
        const int refused = expect_damage_is_survived(
            stream, [&](const Bytes& bytes) { return surface_draft(bytes, surface); });
        EXPECT_GE(refused, static_cast<int>(stream.size()) - 1) << method;
    }
}

}  // namespace
}  // namespace clgi::test

#endif
