// SPDX-License-Identifier: MIT
#include "io/gltf_buffer.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <map>

#include "io/gltf_uri.hpp"

namespace clgi::io::gltf {

namespace {

Bytes take_prefix(Bytes data, std::size_t length) {
    if (data.size() < length) {
        throw InputError("has " + std::to_string(data.size()) + " bytes, its byteLength is " +
                         std::to_string(length));
    }
    return data.first(length);
}

// How much of each file is asked for, so that many buffers in one file cost one reading of it.
using Wanted = std::map<std::filesystem::path, std::size_t>;

void load_external(Document& document, const std::filesystem::path& folder) {
    Wanted wanted;
    std::vector<std::filesystem::path> files(document.buffers.size());
    for (std::size_t i = 0; i < document.buffers.size(); ++i) {
        const Buffer& buffer = document.buffers[i];
        if (!buffer.uri || is_data_uri(*buffer.uri)) continue;
        try {
            files[i] = resolve_uri(folder, *buffer.uri);
        } catch (const InputError& error) {
            throw InputError("buffers[" + std::to_string(i) + "]: " + error.what());
        }
        std::size_t& length = wanted[files[i]];
        length = std::max(length, buffer.length);
    }

    std::map<std::filesystem::path, Bytes> loaded;
    for (const auto& [file, length] : wanted) {
        document.storage.push_back(read_file(file, length));
        loaded[file] = document.storage.back();
    }
    for (std::size_t i = 0; i < document.buffers.size(); ++i) {
        if (!files[i].empty()) document.buffers[i].data = loaded[files[i]];
    }
}

}  // namespace

void load_buffers(Document& document, const std::optional<Bytes>& binary_chunk,
                  const std::filesystem::path& folder) {
    load_external(document, folder);
    for (std::size_t i = 0; i < document.buffers.size(); ++i) {
        Buffer& buffer = document.buffers[i];
        try {
            if (buffer.uri && is_data_uri(*buffer.uri)) {
                document.storage.push_back(decode_data_uri(*buffer.uri));
                buffer.data = document.storage.back();
                buffer.uri.reset();  // as large as what it held
            } else if (!buffer.uri && buffer.fallback) {
                continue;  // refused where an accessor needs it
            } else if (!buffer.uri && i == 0 && binary_chunk) {
                buffer.data = *binary_chunk;
            } else if (!buffer.uri) {
                throw InputError("has no uri and the file no binary chunk for it");
            }
            buffer.data = take_prefix(buffer.data, buffer.length);
        } catch (const InputError& error) {
            throw InputError("buffers[" + std::to_string(i) + "] " + error.what());
        }
    }
}

Bytes picture_bytes(const Document& document, const Picture& picture,
                    const std::filesystem::path& folder, std::size_t limit,
                    std::vector<std::uint8_t>& held) {
    if (picture.view >= 0) {
        const BufferView& view = document.views[picture.view];
        const Bytes data = document.buffers[view.buffer].data;
        if (data.empty()) throw InputError("is in a buffer without data");
        return data.subspan(view.offset, view.length);
    }
    held = is_data_uri(picture.uri) ? decode_data_uri(picture.uri)
                                    : read_file(resolve_uri(folder, picture.uri), limit);
    return held;
}

}  // namespace clgi::io::gltf
