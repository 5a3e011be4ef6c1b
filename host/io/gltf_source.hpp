// Where the bytes of a document's buffers and images are, found and judged before tinygltf asks
// for them.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>

#include "io/gltf_container.hpp"
#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// What stands for the uri of a buffer without bytes: one whose data only EXT_meshopt_compression
// gives, or one that lies in the same file as another, which then serves both.
constexpr const char* no_bytes = "none";

class Sources {
public:
    // container: of the file's bytes, which are taken over when they are asked for.
    Sources(std::filesystem::path folder, std::vector<std::uint8_t>& file,
            const Container& container)
        : folder_(std::move(folder)), file_(file), binary_(container.binary) {}

    // Replaces the uris of buffers by numbers or by plain base64 of the declared length, and
    // those of images inside the document by plain base64. Throws InputError for a uri that names
    // nothing, or something outside the folder.
    void take_uris(nlohmann::json& root, std::vector<MediaTypes>& image_types);

    // The bytes of the buffer that such a number stands for.
    std::vector<std::uint8_t> read(const std::string& uri);

private:
    void take_buffer(nlohmann::json& buffer, std::size_t index);
    void take_file(nlohmann::json& buffer, std::size_t index, const std::string& uri);

    struct Source {
        std::filesystem::path file;  // empty: the binary chunk
        std::size_t length = 0;
        std::size_t served_by = 0;  // itself, or the first buffer in the same file
    };

    std::filesystem::path folder_;
    std::vector<std::uint8_t>& file_;
    std::optional<Bytes> binary_;
    std::vector<Source> sources_;  // one a buffer
    std::map<std::filesystem::path, std::size_t> first_in_;
};

// The bytes of an image, not decoded: in the model, or the first `limit` of its file, which `held`
// then holds.
Bytes image_bytes(const Model& model, std::size_t image, const std::filesystem::path& folder,
                  std::size_t limit, std::vector<std::uint8_t>& held);

}  // namespace clgi::io::gltf
