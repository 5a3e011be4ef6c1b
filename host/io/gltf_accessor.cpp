// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ranges>

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

const std::uint8_t* view_data(const Document& document, int view) {
    const tinygltf::BufferView& range = document.model.bufferViews[view];
    return document.buffers[range.buffer].data() + range.byteOffset;
}

std::size_t stride_of(const Document& document, const Accessor& accessor) {
    const std::size_t declared = document.model.bufferViews[accessor.bufferView].byteStride;
    return declared > 0 ? declared : Layout(accessor).bytes;
}

// Whether `count` elements of `bytes` each, `stride` apart from `offset` on, end inside the view.
// Written with divisions: every one of these numbers may be near 2^64.
void check_range(const Document& document, const std::string& name, int view, std::size_t offset,
                 std::size_t count, std::size_t stride, std::size_t bytes) {
    const tinygltf::BufferView& range = document.model.bufferViews[view];
    if (document.buffers[range.buffer].empty()) {
        refuse(name,
               "needs data that only EXT_meshopt_compression gives, which clgi does not read");
    }
    const std::size_t length = range.byteLength;
    if (bytes > length || offset > length - bytes ||
        count - 1 > (length - bytes - offset) / stride) {
        refuse(name, "reads " + std::to_string(count) + " elements at " + std::to_string(offset) +
                         ", beyond the " + std::to_string(length) + " bytes of " +
                         entry("bufferViews", view));
    }
}

void check_sparse(const Document& document, const std::string& name, const Accessor& accessor) {
    const auto& where = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    const auto count = static_cast<std::size_t>(accessor.sparse.count);
    if (count == 0 || count > accessor.count) {
        refuse(name + ".sparse", "replaces " + std::to_string(count) + " of " +
                                     std::to_string(accessor.count) + " elements");
    }
    const std::size_t index_bytes = tinygltf::GetComponentSizeInBytes(where.componentType);
    const std::size_t value_bytes = Layout(accessor).bytes;
    check_range(document, name + ".sparse.indices", where.bufferView, where.byteOffset, count,
                index_bytes, index_bytes);
    check_range(document, name + ".sparse.values", values.bufferView, values.byteOffset, count,
                value_bytes, value_bytes);

    const std::uint8_t* indices = view_data(document, where.bufferView) + where.byteOffset;
    double previous = -1.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double index = load_component(indices + i * index_bytes, where.componentType);
        if (index <= previous || index >= static_cast<double>(accessor.count)) {
            refuse(name + ".sparse", "has indices that do not increase, or that are beyond the " +
                                         std::to_string(accessor.count) + " elements");
        }
        previous = index;
    }
}

}  // namespace

// tinygltf's types: VEC2 is 2, MAT2 32 + 2, SCALAR 64 + 1. Columns of matrices begin at
// multiples of 4.
Layout::Layout(const Accessor& accessor)
    : component_bytes(tinygltf::GetComponentSizeInBytes(accessor.componentType)),
      rows(accessor.type % 32),
      columns(accessor.type / 32 == 1 ? rows : 1),
      column_bytes(columns == 1 ? component_bytes * rows : (component_bytes * rows + 3) / 4 * 4),
      bytes(column_bytes * columns) {}

void check_accessors(const Document& document) {
    // Elements that no bytes stand for cost nothing in the file; bound them by what does.
    std::size_t most_zeros = 65536;
    for (const Bytes buffer : document.buffers) most_zeros += buffer.size();
    std::size_t sparse_total = 0;

    for (std::size_t i = 0; i < document.model.accessors.size(); ++i) {
        const Accessor& accessor = document.model.accessors[i];
        const std::string name = entry("accessors", i);
        const std::size_t bytes = Layout(accessor).bytes;
        if (accessor.bufferView >= 0) {
            const std::size_t stride = stride_of(document, accessor);
            if (stride < bytes) {
                refuse(name, "has elements of " + std::to_string(bytes) +
                                 " bytes, its view a stride of " + std::to_string(stride));
            }
            check_range(document, name, accessor.bufferView, accessor.byteOffset, accessor.count,
                        stride, bytes);
        } else if (accessor.count > most_zeros) {
            refuse(name, "has " + std::to_string(accessor.count) + " elements and no data");
        }
        if (!accessor.sparse.isSparse) continue;
        // Many accessors may share one list of indices, each check reads all of it.
        sparse_total += accessor.sparse.count;
        if (sparse_total > std::size_t{1} << 28) refuse(name, "has too much sparse data");
        check_sparse(document, name, accessor);
    }
}

AccessorReader::AccessorReader(const Document& document, int accessor)
    : accessor_(document.model.accessors[accessor]), layout_(accessor_) {
    if (accessor_.bufferView >= 0) {
        data_ = view_data(document, accessor_.bufferView) + accessor_.byteOffset;
        stride_ = stride_of(document, accessor_);
    }
    const auto& sparse = accessor_.sparse;
    if (!sparse.isSparse) return;
    sparse_count_ = sparse.count;
    sparse_indices_ = view_data(document, sparse.indices.bufferView) + sparse.indices.byteOffset;
    sparse_values_ = view_data(document, sparse.values.bufferView) + sparse.values.byteOffset;
}

std::size_t AccessorReader::sparse_index(std::size_t i) const {
    const int type = accessor_.sparse.indices.componentType;
    return static_cast<std::size_t>(
        load_component(sparse_indices_ + i * tinygltf::GetComponentSizeInBytes(type), type));
}

const std::uint8_t* AccessorReader::dense(std::size_t element) const {
    return data_ ? data_ + element * stride_ : nullptr;
}

const std::uint8_t* AccessorReader::find(std::size_t element) const {
    if (sparse_count_ > 0) {
        const auto numbers = std::views::iota(std::size_t{0}, sparse_count_);
        const auto found = std::ranges::lower_bound(numbers, element, {},
                                                    [this](auto i) { return sparse_index(i); });
        if (found != numbers.end() && sparse_index(*found) == element) {
            return sparse_values_ + *found * layout_.bytes;
        }
    }
    return dense(element);
}

double AccessorReader::number(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0.0;
    bytes += component / layout_.rows * layout_.column_bytes +
             component % layout_.rows * layout_.component_bytes;
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
        load_component(bytes + component * layout_.component_bytes, accessor_.componentType));
}

std::size_t AccessorReader::first_not_finite() const {
    if (accessor_.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) return size();
    std::size_t next = 0;  // of those replaced; quicker than to find each
    for (std::size_t element = 0; element < size(); ++element) {
        const bool replaced = next < sparse_count_ && sparse_index(next) == element;
        const std::uint8_t* bytes =
            replaced ? sparse_values_ + next++ * layout_.bytes : dense(element);
        for (std::size_t at = 0; bytes && at < layout_.bytes; at += sizeof(float)) {
            if (!std::isfinite(load<float>(bytes + at))) return element;
        }
    }
    return size();
}

}  // namespace clgi::io::gltf
