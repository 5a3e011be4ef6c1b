// save_glb: the parts of a scene, then the file.
// SPDX-License-Identifier: MIT
#include "io/gltf_write.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>

#include "io/atomic_file.hpp"

namespace clgi::io {

namespace gltf {

int GlbDraft::add_view(const void* data, std::size_t bytes, int target, std::size_t stride) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = binary.size();
    view.byteLength = bytes;
    view.byteStride = stride;
    view.target = target;
    binary.resize(view.byteOffset + (bytes + 3) / 4 * 4);
    std::memcpy(binary.data() + view.byteOffset, data, bytes);
    return add(model.bufferViews, std::move(view));
}

void GlbDraft::declare_extension(const char* name) {
    std::vector<std::string>& used = model.extensionsUsed;
    if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

std::string utf8(const std::string& name) {
    using nlohmann::json;
    return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace));
}

}  // namespace gltf

namespace {

gltf::GlbDraft draft_of(const Scene& scene) {
    gltf::GlbDraft draft;
    draft.model.asset.generator = "clgi";
    gltf::write_materials(scene, draft);
    gltf::write_meshes(scene, draft);
    gltf::write_lights(scene, draft);
    gltf::write_cameras(scene, draft);

    if (!draft.roots.empty()) {  // tinygltf writes null for a scene of nothing
        tinygltf::Scene listed;
        listed.name = gltf::utf8(scene.name);
        listed.nodes = draft.roots;
        draft.model.defaultScene = gltf::add(draft.model.scenes, std::move(listed));
    }
    if (!draft.binary.empty()) {
        draft.model.buffers.emplace_back();
        draft.model.buffers[0].data = std::move(draft.binary);
    }
    return draft;
}

// Counts, since tinygltf cuts the length of a file to 32 bits.
class FileStream : public std::streambuf {
public:
    explicit FileStream(AtomicFile& file) : file_(file) {}

    bool is_too_long() const { return written_ > UINT32_MAX; }

private:
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        written_ += static_cast<std::uint64_t>(count);
        if (!is_too_long()) file_.write(bytes, static_cast<std::size_t>(count));
        return count;
    }
    int overflow(int byte) override {
        const char one = static_cast<char>(byte);
        return xsputn(&one, 1) == 1 ? byte : traits_type::eof();
    }

    AtomicFile& file_;
    std::uint64_t written_ = 0;
};

}  // namespace

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    gltf::GlbDraft draft;
    try {
        validate(scene);
        draft = draft_of(scene);
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
    AtomicFile file(path);
    FileStream buffer(file);
    std::ostream stream(&buffer);
    stream.exceptions(std::ios::badbit);  // what AtomicFile throws passes through
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&draft.model, stream, false, true);
    if (buffer.is_too_long()) {
        throw InputError(path.string() + ": the scene is larger than the 4 GiB of a GLB");
    }
    file.commit();
}

}  // namespace clgi::io
