// SPDX-License-Identifier: MIT
#include "io/gltf_source.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <nlohmann/json.hpp>

#include "io/gltf_guard.hpp"
#include "io/gltf_text.hpp"
#include "io/gltf_uri.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

void require_length(std::size_t there, std::size_t declared) {
    if (there < declared) {
        throw InputError("has " + std::to_string(there) + " bytes, its byteLength is " +
                         std::to_string(declared));
    }
}

bool is_fallback(const json& buffer) {
    const json::json_pointer flag("/extensions/EXT_meshopt_compression/fallback");
    return buffer.contains(flag) && buffer.at(flag).get<bool>();
}

void take_image(json& image, MediaTypes& types) {
    const auto uri = image.find("uri");
    if (uri == image.end()) return;
    const std::string text = uri->get<std::string>();
    if (!is_data_uri(text)) return;
    types = {std::string(data_uri_type(text)), image.value("mimeType", "")};
    *uri = "data:image/png;base64," + std::string(data_uri_base64(text));  // whatever it is
}

}  // namespace

void Sources::take_file(json& buffer, std::size_t index, const std::string& uri) {
    Source& source = sources_[index];
    source.file = resolve_uri(folder_, uri);
    buffer["uri"] = std::to_string(index);
    const std::size_t first = first_in_.try_emplace(source.file, index).first->second;
    if (first == index) return;
    sources_[first].length = std::max(sources_[first].length, source.length);
    source.served_by = first;
    buffer["uri"] = no_bytes;
}

void Sources::take_buffer(json& buffer, std::size_t index) {
    const std::size_t length = buffer["byteLength"].get<std::size_t>();
    sources_[index] = {{}, length, index};
    if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
        const std::string text = uri->get<std::string>();
        if (!is_data_uri(text)) return take_file(buffer, index, text);
        const std::string_view base64 = data_uri_base64(text);
        require_length(base64.size() / 4 * 3 + base64.size() % 4 * 3 / 4, length);
        *uri = "data:application/octet-stream;base64," +
               std::string(base64.substr(0, (length * 4 + 2) / 3));
    } else if (is_fallback(buffer)) {
        buffer["uri"] = no_bytes;
    } else if (index == 0 && binary_) {
        require_length(binary_->size(), length);
        buffer["uri"] = "0";
    } else {
        throw InputError("has no uri and the file no binary chunk for it");
    }
}

void Sources::take_uris(json& root, std::vector<MediaTypes>& image_types) {
    json& buffers = list_in(root, "buffers");
    sources_.resize(buffers.size());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        of_entry("buffers", i, [&] { take_buffer(buffers[i], i); });
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        buffers[i]["byteLength"] = buffers[i]["uri"] == no_bytes ? 1 : sources_[i].length;
    }
    json& views = list_in(root, "bufferViews");
    for (json& view : views) {
        view["buffer"] = sources_[view["buffer"].get<std::size_t>()].served_by;
    }

    json& images = list_in(root, "images");
    image_types.resize(images.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        of_entry("images", i, [&] {
            take_image(images[i], image_types[i]);
            const auto view = images[i].find("bufferView");
            if (view == images[i].end()) return;
            const json& buffer = views[view->get<std::size_t>()]["buffer"];
            if (buffers[buffer.get<std::size_t>()]["uri"] == no_bytes) {
                throw InputError("is in a buffer without data");
            }
        });
    }
}

std::vector<std::uint8_t> Sources::read(const std::string& uri) {
    if (uri == no_bytes) return {0};
    const std::size_t index = std::stoul(uri);
    const Source& source = sources_[index];
    if (!source.file.empty()) {
        return of_entry("buffers", index, [&] {
            std::vector<std::uint8_t> bytes = read_file(source.file, source.length);
            require_length(bytes.size(), source.length);
            return bytes;
        });
    }
    // No second copy of what may be gigabytes.
    const std::ptrdiff_t head = binary_->data() - file_.data();
    std::vector<std::uint8_t> bytes = std::move(file_);
    bytes.erase(bytes.begin(), bytes.begin() + head);
    bytes.resize(source.length);
    return bytes;
}

Bytes image_bytes(const Model& model, std::size_t image, const std::filesystem::path& folder,
                  std::size_t limit, std::vector<std::uint8_t>& held) {
    const tinygltf::Image& source = model.images[image];
    if (source.bufferView >= 0) {
        const BufferView& view = model.bufferViews[source.bufferView];
        return Bytes(model.buffers[view.buffer].data).subspan(view.byteOffset, view.byteLength);
    }
    if (source.uri.empty()) return source.image;
    held = read_file(resolve_uri(folder, source.uri), limit);
    return held;
}

}  // namespace clgi::io::gltf
