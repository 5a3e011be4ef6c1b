// Small glTF files, written by the tests that load them.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace clgi::test {

using nlohmann::json;

constexpr int int8_type = 5120;
constexpr int uint8_type = 5121;
constexpr int int16_type = 5122;
constexpr int uint16_type = 5123;
constexpr int uint32_type = 5125;
constexpr int float_type = 5126;

// A folder that goes away with the test.
class TempFolder {
public:
    TempFolder() {
        const std::filesystem::path base = std::filesystem::temp_directory_path();
        std::string pattern = (base / "clgi-gltf-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
        }
    }
    return text;
}

using Floats3 = std::vector<std::array<float, 3>>;

struct GltfDraft {
    json document = {{"asset", {{"version", "2.0"}}}};
    std::vector<std::uint8_t> bytes;

    int add(const std::string& array, const json& entry) {
        document[array].push_back(entry);
        return static_cast<int>(document[array].size()) - 1;
    }

    template <typename T>
    int view(const std::vector<T>& values, int stride = 0) {
        const std::size_t offset = (bytes.size() + 3) / 4 * 4;
        const std::size_t length = values.size() * sizeof(T);
        bytes.resize(offset + length);
        if (length > 0) std::memcpy(bytes.data() + offset, values.data(), length);
        json entry = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
        if (stride > 0) entry["byteStride"] = stride;
        return add("bufferViews", entry);
    }

    int accessor(int view, std::size_t count, const char* type, int component,
                 bool normalized = false) {
        json entry = {{"count", count}, {"type", type}, {"componentType", component}};
        if (view >= 0) entry["bufferView"] = view;
        if (normalized) entry["normalized"] = true;
        return add("accessors", entry);
    }

    int vec3(const Floats3& values) {
        return accessor(view(values), values.size(), "VEC3", float_type);
    }
    int indices(const std::vector<std::uint16_t>& values) {
        return accessor(view(values), values.size(), "SCALAR", uint16_type);
    }

    // A mesh of one primitive, and a node that shows it.
    int show(const json& primitive, const json& node = json::object()) {
        json shown = node;
        shown["mesh"] = add("meshes", json{{"primitives", json::array({primitive})}});
        return add("nodes", shown);
    }

    std::string text() const {
        json complete = document;
        if (!bytes.empty() && !complete.contains("buffers")) {
            const std::string uri = "data:application/octet-stream;base64," + base64(bytes);
            complete["buffers"] = json::array({json{{"uri", uri}, {"byteLength", bytes.size()}}});
        }
        return complete.dump();
    }

    Scene load(const io::GltfOptions& options = {}) const {
        const TempFolder folder;
        return io::load_gltf(folder.write("draft.gltf", text()), options);
    }
};

// One right triangle in the xy plane, seen from +z.
inline const Floats3 one_triangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

inline GltfDraft triangle_draft(const json& node = json::object()) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    draft.show({{"attributes", {{"POSITION", positions}}}}, node);
    return draft;
}

// What load_gltf says about a file that it refuses; "" when it takes it.
inline std::string refusal(const std::filesystem::path& file, const io::GltfOptions& options = {}) {
    try {
        io::load_gltf(file, options);
        return "";
    } catch (const InputError& error) {
        return error.what();
    }
}

inline std::string refusal(const std::string& text, const io::GltfOptions& options = {}) {
    const TempFolder folder;
    return refusal(folder.write("refused.gltf", text), options);
}

inline std::string refusal(const GltfDraft& draft, const io::GltfOptions& options = {}) {
    return refusal(draft.text(), options);
}

inline glm::dvec3 corner(const Scene& scene, std::size_t triangle, int i) {
    return scene.positions[scene.triangles[triangle].vertex[i]];
}

// Twice the area, along the side that the corners run around counter-clockwise.
inline glm::dvec3 winding(const Scene& scene, std::size_t triangle) {
    const glm::dvec3 a = corner(scene, triangle, 0);
    return glm::cross(corner(scene, triangle, 1) - a, corner(scene, triangle, 2) - a);
}

// Saved and loaded again.
inline Scene reload(const Scene& scene) {
    const TempFolder folder;
    io::save_glb(scene, folder.path() / "saved.glb");
    return io::load_gltf(folder.path() / "saved.glb");
}

}  // namespace clgi::test

// Whole positions and exact binary fractions: no rounding enters, so the default is exact.
#define EXPECT_VEC_NEAR(actual, expected, tolerance) \
    EXPECT_LE(glm::length(glm::dvec3(actual) - glm::dvec3(expected)), tolerance)
