// unpack_view: EXT_meshopt_compression. What meshoptimizer takes for granted is checked before.
// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

enum class Mode { attributes, triangles, indices };

Mode mode_of(const json& packed) {
    const std::string_view mode = packed["mode"].get_ref<const std::string&>();
    if (mode == "ATTRIBUTES") return Mode::attributes;
    return mode == "TRIANGLES" ? Mode::triangles : Mode::indices;
}

// Bytes that one can stand for: 16 equal bytes take 2 bits, a triangle or an index at least a byte.
std::size_t most_per_byte(Mode mode) {
    if (mode == Mode::attributes) return 64;
    return mode == Mode::triangles ? 12 : 4;
}

void check_shape(Mode mode, std::string_view filter, std::size_t count, std::size_t stride) {
    if (mode == Mode::attributes) {
        require(stride % 4 == 0 && stride <= 256, "has a byteStride of ", stride,
                ", not a multiple of 4 up to 256");
    } else {
        require(stride == 2 || stride == 4, "has indices of ", stride, " bytes");
        require(filter == "NONE", "has a filter for indices");
    }
    require(mode != Mode::triangles || count % 3 == 0, "has ", count, " corners of triangles");
    require(filter != "OCTAHEDRAL" || stride == 4 || stride == 8, "has octahedral vectors of ",
            stride, " bytes");
    require(filter != "QUATERNION" || stride == 8, "has quaternions of ", stride, " bytes");
}

bool decode(Mode mode, Bytes from, std::size_t count, std::size_t stride, void* to) {
    if (mode == Mode::attributes) {
        return meshopt_decodeVertexBuffer(to, count, stride, from.data(), from.size()) == 0;
    }
    if (mode == Mode::triangles) {
        return meshopt_decodeIndexBuffer(to, count, stride, from.data(), from.size()) == 0;
    }
    return meshopt_decodeIndexSequence(to, count, stride, from.data(), from.size()) == 0;
}

void undo_filter(std::string_view filter, void* data, std::size_t count, std::size_t stride) {
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(data, count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, count, stride);
}

// view: the view that shows the unpacked bytes.
std::vector<std::uint8_t> unpack(const json& packed, const json& view, Document& document) {
    const Bytes buffer = document.buffers[packed["buffer"].get<std::size_t>()];
    require(!buffer.empty(), "is in a buffer without data");
    const auto count = packed["count"].get<std::size_t>();
    const auto stride = packed["byteStride"].get<std::size_t>();
    const auto length = packed["byteLength"].get<std::size_t>();
    const std::string filter = packed.value("filter", "NONE");
    const Mode mode = mode_of(packed);
    check_shape(mode, filter, count, stride);
    require(count <= most_per_byte(mode) * length / stride, "says ", count, " elements of ", stride,
            " bytes, which its ", length, " bytes cannot hold");
    require(view["byteLength"] == count * stride, "gives ", count * stride,
            " bytes, the byteLength of the view is ", view["byteLength"].get<std::size_t>());
    require(view.value("byteStride", stride) == stride, "has a byteStride of ", stride,
            ", the view one of ", view.value("byteStride", stride));
    document.unpacking.take_packed(length);
    document.unpacking.take_unpacked(count * stride);

    const Bytes source = buffer.subspan(packed.value("byteOffset", std::size_t{0}), length);
    std::vector<std::uint8_t> bytes(count * stride);
    require(decode(mode, source, count, stride, bytes.data()), "is damaged");
    undo_filter(filter, bytes.data(), count, stride);
    return bytes;
}

}  // namespace

void unpack_view(json& view, Document& document) {
    const json packed = view["extensions"][meshopt_codec.extension];
    Bytes bytes = document.files.emplace_back(
        within([] { return std::string(".extensions.") + meshopt_codec.extension; },
               [&] { return unpack(packed, view, document); }));
    view["buffer"] = document.buffers.size();
    view.erase("byteOffset");
    document.buffers.push_back(bytes);
}

}  // namespace clgi::io::gltf
