// SPDX-License-Identifier: MIT
#include "io/gltf_parse.hpp"

#include <clgi/error.hpp>
#include <climits>
#include <nlohmann/json.hpp>

#include "io/gltf_asset.hpp"
#include "io/gltf_guard.hpp"
#include "io/gltf_source.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

// tinygltf's callbacks. What they throw passes through it: it holds nothing but containers.
bool exists(const std::string&, void*) { return true; }

std::string same_name(const std::string& name, void*) { return name; }

bool read(std::vector<unsigned char>* bytes, std::string*, const std::string& uri, void* sources) {
    *bytes = static_cast<Sources*>(sources)->read(uri);
    return true;
}

// Images stay encoded until a material needs them. Those in buffers are there already.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

std::string last_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return printable(text.substr(text.rfind('\n') + 1));
}

void check_view(const json& view, const json& buffers) {
    const std::size_t length = view.at("byteLength").get<std::size_t>();
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    const std::size_t there = buffers[view.at("buffer").get<std::size_t>()].at("byteLength");
    if (length > there || offset > there - length) {
        throw InputError("is " + std::to_string(length) + " bytes at " + std::to_string(offset) +
                         ", its buffer has " + std::to_string(there));
    }
    if (!view.contains("byteStride")) return;
    const std::size_t stride = view.at("byteStride").get<std::size_t>();
    if (stride < 4 || stride > 252 || stride % 4 != 0) {
        throw InputError("has a byteStride of " + std::to_string(stride) +
                         ", not a multiple of 4 up to 252");
    }
    if (view.value("target", 0) == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER) {
        throw InputError("holds indices, but has a byteStride");
    }
}

// What a table of kinds cannot say of single members.
void check_members(json& root) {
    const json& views = list_in(root, "bufferViews");
    for (std::size_t i = 0; i < views.size(); ++i) {
        of_entry("bufferViews", i, [&] { check_view(views[i], root["buffers"]); });
    }
    const json& accessors = list_in(root, "accessors");
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        if (accessors[i].contains("byteOffset") && !accessors[i].contains("bufferView")) {
            refuse(entry("accessors", i), "has an offset into no view");
        }
    }
}

}  // namespace

Document parse(const std::filesystem::path& path) {
    std::vector<std::uint8_t> file = read_file(path);
    const Container container = open_container(file);
    Sources sources(path.parent_path(), file, container);
    Document document;
    std::string text;
    {
        json root = parse_json(container.json);
        guard(root, asset_rules());
        check_asset(root, document);
        guard(root, rules());
        check_members(root);
        sources.take_uris(root, document.image_types);
        drop_foreign(root);
        text = root.dump();
    }  // the tree is several times the size of its text
    if (text.size() > INT_MAX) throw InputError("the JSON is larger than 2 GiB");
    if (!container.binary) std::vector<std::uint8_t>().swap(file);

    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks({exists, same_name, read, nullptr, &sources});
    reader.SetImageLoader(keep_encoded, nullptr);
    std::string error;
    std::string warning;
    if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                    static_cast<unsigned>(text.size()), "")) {
        throw InputError(last_line(error));
    }
    for (tinygltf::Buffer& buffer : document.model.buffers) {
        if (buffer.uri != no_bytes) std::string().swap(buffer.uri);  // may be as large as the data
    }
    return document;
}

}  // namespace clgi::io::gltf
