// save_glb: the parts of a scene, then the container, then the file.
// SPDX-License-Identifier: MIT
#include "io/gltf_write.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <cstring>

#include "io/atomic_file.hpp"

namespace clgi::io {

namespace gltf {

int GlbDraft::add(const char* array, nlohmann::json entry) {
    nlohmann::json& entries = json[array];
    entries.push_back(std::move(entry));
    return static_cast<int>(entries.size()) - 1;
}

int GlbDraft::add_view(const void* data, std::size_t bytes, int target, std::size_t stride) {
    const std::size_t offset = binary.size();
    binary.resize(offset + (bytes + 3) / 4 * 4);
    std::memcpy(binary.data() + offset, data, bytes);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
    if (target != 0) view["target"] = target;
    if (stride != 0) view["byteStride"] = stride;
    return add("bufferViews", std::move(view));
}

void GlbDraft::declare_extension(const char* name) {
    nlohmann::json& used = json["extensionsUsed"];
    if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

}  // namespace gltf

namespace {

void append_word(std::string& bytes, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<char>(value >> shift & 0xFF));
    }
}

gltf::GlbDraft draft_of(const Scene& scene) {
    gltf::GlbDraft draft;
    draft.json["asset"] = {{"version", "2.0"}, {"generator", "clgi"}};
    std::vector<int> roots;
    gltf::write_materials(scene, draft);
    gltf::write_meshes(scene, draft, roots);
    gltf::write_lights(scene, draft, roots);
    gltf::write_cameras(scene, draft, roots);

    nlohmann::json listed = {{"name", scene.name}};
    if (!roots.empty()) listed["nodes"] = roots;
    draft.json["scene"] = draft.add("scenes", std::move(listed));
    if (!draft.binary.empty()) draft.add("buffers", {{"byteLength", draft.binary.size()}});
    return draft;
}

// Everything before the binary chunk's contents.
std::string head_of_glb(const gltf::GlbDraft& draft) {
    // Names may come from anywhere; what is not UTF-8 in them is replaced.
    std::string json = draft.json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t binary = draft.binary.size();
    const std::size_t total = 12 + 8 + json.size() + (binary > 0 ? 8 + binary : 0);
    if (total > UINT32_MAX) throw InputError("the scene is larger than the 4 GiB of a GLB");

    std::string head = "glTF";
    append_word(head, 2);
    append_word(head, total);
    append_word(head, json.size());
    head += "JSON" + json;
    if (binary > 0) {
        append_word(head, binary);
        head += std::string("BIN\0", 4);
    }
    return head;
}

}  // namespace

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    gltf::GlbDraft draft;
    std::string head;
    try {
        validate(scene);
        draft = draft_of(scene);
        head = head_of_glb(draft);
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
    AtomicFile file(path);
    file.write(head.data(), head.size());
    file.write(draft.binary.data(), draft.binary.size());
    file.commit();
}

}  // namespace clgi::io
