// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace clgi::io::gltf {

namespace {

template <typename T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));  // files need not keep glTF's alignment
    return value;
}

// A double holds each of these types exactly.
double load_component(const std::uint8_t* bytes, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return load<std::int8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return load<std::int16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(bytes);
        default:
            return load<float>(bytes);
    }
}

std::size_t size_of(int component) {
    return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(component));
}

}  // namespace

// tinygltf's types: VEC2 is 2, MAT2 32 + 2, SCALAR 64 + 1.
std::size_t rows(const Accessor& accessor) { return accessor.type % 32; }

std::size_t columns(const Accessor& accessor) {
    return accessor.type / 32 == 1 ? rows(accessor) : 1;
}

void check_accessors(const Document& document) {
    // Elements that no bytes stand for cost nothing in the file; bound them by what does.
    std::size_t most_zeros = 65536;
    for (const Bytes buffer : document.buffers) most_zeros += buffer.size();
    std::size_t sparse_total = 0;

    each("accessors", document.model.accessors, [&](const Accessor& accessor) {
        require(accessor.bufferView >= 0 || accessor.count <= most_zeros, "has ", accessor.count,
                " elements and no data");
        const AccessorReader reader(document, accessor);
        if (!accessor.sparse.isSparse) return;
        // Many accessors may share one list of indices, each check reads all of it.
        sparse_total += accessor.sparse.count;
        require(sparse_total <= std::size_t{1} << 28, "has too much sparse data");
        require(reader.is_in_order(), ".sparse has indices that do not increase below ",
                accessor.count);
    });
}

AccessorReader::AccessorReader(const Document& document, const Accessor& accessor)
    : accessor_(accessor),
      component_bytes_(size_of(accessor.componentType)),
      column_bytes_(component_bytes_ * rows(accessor)) {
    if (columns(accessor) > 1) column_bytes_ = (column_bytes_ + 3) / 4 * 4;
    bytes_ = column_bytes_ * columns(accessor);
    if (accessor.bufferView >= 0) {
        dense_ = elements(document, accessor.bufferView, accessor.byteOffset, accessor.count,
                          bytes_, true);
    }
    if (!accessor.sparse.isSparse) return;
    const auto& indices = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    sparse_count_ = accessor.sparse.count;
    require(sparse_count_ > 0 && sparse_count_ <= accessor.count, ".sparse replaces ",
            sparse_count_, " of ", accessor.count, " elements");
    sparse_indices_ = elements(document, indices.bufferView, indices.byteOffset, sparse_count_,
                               size_of(indices.componentType), false);
    sparse_values_ =
        elements(document, values.bufferView, values.byteOffset, sparse_count_, bytes_, false);
}

AccessorReader::Elements AccessorReader::elements(const Document& document, int view,
                                                  std::size_t offset, std::size_t count,
                                                  std::size_t bytes, bool strided) {
    const tinygltf::BufferView& range = document.model.bufferViews[view];
    const Bytes buffer = document.buffers[range.buffer];
    if (buffer.empty()) {
        fail("needs data that only ",
             meshopt_codec.built ? "a fallback buffer has" : missing(meshopt_codec));
    }
    const std::size_t stride = strided && range.byteStride > 0 ? range.byteStride : bytes;
    require(stride >= bytes, "has elements of ", bytes, " bytes, its view a stride of ", stride);
    // Written with divisions: every one of these numbers may be near 2^64.
    const std::size_t length = range.byteLength;
    require(bytes <= length && offset <= length - bytes &&
                count - 1 <= (length - bytes - offset) / stride,
            "reads ", count, " elements at ", offset, ", beyond the ", length,
            " bytes of bufferViews[", view, "]");
    return {buffer.data() + range.byteOffset + offset, stride};
}

std::size_t AccessorReader::replaced(std::size_t i) const {
    return static_cast<std::size_t>(
        load_component(sparse_indices_.at(i), accessor_.sparse.indices.componentType));
}

bool AccessorReader::is_in_order() const {
    for (std::size_t i = 0; i < sparse_count_; ++i) {
        if (replaced(i) >= size() || (i > 0 && replaced(i) <= replaced(i - 1))) return false;
    }
    return true;
}

const std::uint8_t* AccessorReader::find(std::size_t element) const {
    if (sparse_count_ > 0) {
        std::size_t found = 0, end = sparse_count_;  // is_in_order(): they increase
        while (found < end) {
            const std::size_t middle = found + (end - found) / 2;
            if (replaced(middle) < element) {
                found = middle + 1;
            } else {
                end = middle;
            }
        }
        if (found < sparse_count_ && replaced(found) == element) return sparse_values_.at(found);
    }
    return dense_.at(element);
}

double AccessorReader::number(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0.0;
    const std::size_t height = rows(accessor_);
    bytes += component / height * column_bytes_ + component % height * component_bytes_;
    const int type = accessor_.componentType;
    const double value = load_component(bytes, type);
    constexpr double largest[] = {127.0, 255.0, 32767.0, 65535.0};
    if (!accessor_.normalized || type > TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return value;
    return std::max(value / largest[type - TINYGLTF_COMPONENT_TYPE_BYTE], -1.0);
}

std::uint32_t AccessorReader::integer(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0;
    return static_cast<std::uint32_t>(
        load_component(bytes + component * component_bytes_, accessor_.componentType));
}

std::size_t AccessorReader::first_not_finite() const {
    std::size_t next = 0;  // of those replaced; quicker than to find each
    for (std::size_t element = 0; element < size(); ++element) {
        const bool is_replaced = next < sparse_count_ && replaced(next) == element;
        const std::uint8_t* bytes = is_replaced ? sparse_values_.at(next++) : dense_.at(element);
        for (std::size_t at = 0; bytes && at < bytes_; at += sizeof(float)) {
            if (!std::isfinite(load<float>(bytes + at))) return element;
        }
    }
    return size();
}

}  // namespace clgi::io::gltf
