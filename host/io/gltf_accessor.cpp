// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <cstring>
#include <tuple>

#include "io/gltf_source.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

template <typename T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));  // files need not keep glTF's alignment
    return value;
}

// Unsigned integer of the type, as indices have it.
std::uint32_t load_index(const std::uint8_t* bytes, int component) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *bytes;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes);
        default:
            return load<std::uint32_t>(bytes);
    }
}

bool all_finite(const std::uint8_t* floats, std::size_t length) {
    for (std::size_t at = 0; at < length; at += sizeof(float)) {
        if (!std::isfinite(load<float>(floats + at))) return false;
    }
    return true;
}

const std::uint8_t* view_data(const Document& document, int view) {
    const BufferView& range = document.model.bufferViews[view];
    return document.model.buffers[range.buffer].data.data() + range.byteOffset;
}

// Whether `count` elements of `bytes` each, `stride` apart from `offset` on, end inside `length`.
// Written with divisions: every one of these numbers may be near 2^64.
bool fits(std::size_t length, std::size_t offset, std::size_t count, std::size_t stride,
          std::size_t bytes) {
    if (bytes > length || offset > length - bytes) return false;
    return count - 1 <= (length - bytes - offset) / stride;
}

void check_range(const Document& document, const std::string& name, int view, std::size_t offset,
                 std::size_t count, std::size_t stride, std::size_t bytes) {
    const BufferView& range = document.model.bufferViews[view];
    if (document.model.buffers[range.buffer].uri == no_bytes) {
        throw InputError(name +
                         " needs data that only EXT_meshopt_compression gives, which clgi does "
                         "not read");
    }
    if (!fits(range.byteLength, offset, count, stride, bytes)) {
        throw InputError(name + " reads " + std::to_string(count) + " elements at " +
                         std::to_string(offset) + ", beyond the " +
                         std::to_string(range.byteLength) + " bytes of bufferViews[" +
                         std::to_string(view) + "]");
    }
}

void check_sparse(const Document& document, const std::string& name, const Accessor& accessor) {
    const auto& [where, values] = std::tie(accessor.sparse.indices, accessor.sparse.values);
    const std::size_t count = sparse_count(accessor);
    if (count > accessor.count) {
        throw InputError(name + ".sparse replaces " + std::to_string(count) + " of " +
                         std::to_string(accessor.count) + " elements");
    }
    const std::size_t index_bytes = component_bytes(where.componentType);
    const std::size_t value_bytes = element_bytes(accessor);
    check_range(document, name + ".sparse.indices", where.bufferView, where.byteOffset, count,
                index_bytes, index_bytes);
    check_range(document, name + ".sparse.values", values.bufferView, values.byteOffset, count,
                value_bytes, value_bytes);

    const std::uint8_t* indices = view_data(document, where.bufferView) + where.byteOffset;
    std::uint32_t previous = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t index = load_index(indices + i * index_bytes, where.componentType);
        if (index >= accessor.count) {
            throw InputError(name + ".sparse replaces element " + std::to_string(index) +
                             ", there are " + std::to_string(accessor.count));
        }
        if (i > 0 && index <= previous) {
            throw InputError(name + ".sparse has indices that do not increase");
        }
        previous = index;
    }
}

}  // namespace

std::size_t component_bytes(int component) {
    return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(component));
}

// tinygltf's types: VEC2 is 2, MAT2 32 + 2, SCALAR 64 + 1.
std::size_t rows(const Accessor& accessor) { return accessor.type % 32; }

std::size_t columns(const Accessor& accessor) {
    return accessor.type / 32 == 1 ? rows(accessor) : 1;
}

std::size_t column_bytes(const Accessor& accessor) {
    const std::size_t bytes = component_bytes(accessor.componentType) * rows(accessor);
    return columns(accessor) > 1 ? (bytes + 3) / 4 * 4 : bytes;  // of a matrix: a multiple of 4
}

std::size_t element_bytes(const Accessor& accessor) {
    return column_bytes(accessor) * columns(accessor);
}

std::size_t sparse_count(const Accessor& accessor) {
    return accessor.sparse.isSparse ? static_cast<std::size_t>(accessor.sparse.count) : 0;
}

void check_accessors(const Document& document) {
    // Elements that no bytes stand for cost nothing in the file; bound them by what does.
    std::size_t most_zeros = 65536;
    for (const auto& buffer : document.model.buffers) most_zeros += buffer.data.size();
    std::size_t sparse_total = 0;

    for (std::size_t i = 0; i < document.model.accessors.size(); ++i) {
        const Accessor& accessor = document.model.accessors[i];
        const std::string name = entry("accessors", i);
        const std::size_t bytes = element_bytes(accessor);
        if (accessor.bufferView >= 0) {
            const std::size_t declared = document.model.bufferViews[accessor.bufferView].byteStride;
            const std::size_t stride = declared > 0 ? declared : bytes;
            if (stride < bytes) {
                throw InputError(name + " has elements of " + std::to_string(bytes) +
                                 " bytes, its view a stride of " + std::to_string(stride));
            }
            check_range(document, name, accessor.bufferView, accessor.byteOffset, accessor.count,
                        stride, bytes);
        } else if (accessor.count > most_zeros) {
            throw InputError(name + " has " + std::to_string(accessor.count) +
                             " elements and no data");
        }
        if (!accessor.sparse.isSparse) continue;
        // Many accessors may share one list of indices, each check reads all of it.
        sparse_total += sparse_count(accessor);
        if (sparse_total > std::size_t{1} << 28) throw InputError(name + ": too much sparse data");
        check_sparse(document, name, accessor);
    }
}

AccessorReader::AccessorReader(const Document& document, int accessor)
    : accessor_(document.model.accessors[accessor]),
      width_(rows(accessor_)),
      component_bytes_(component_bytes(accessor_.componentType)),
      column_bytes_(column_bytes(accessor_)),
      element_bytes_(element_bytes(accessor_)),
      sparse_count_(sparse_count(accessor_)) {
    if (accessor_.bufferView >= 0) {
        const std::size_t declared = document.model.bufferViews[accessor_.bufferView].byteStride;
        data_ = view_data(document, accessor_.bufferView) + accessor_.byteOffset;
        stride_ = declared > 0 ? declared : element_bytes_;
    }
    if (sparse_count_ > 0) {
        const auto& [indices, values] = std::tie(accessor_.sparse.indices, accessor_.sparse.values);
        sparse_indices_ = view_data(document, indices.bufferView) + indices.byteOffset;
        sparse_values_ = view_data(document, values.bufferView) + values.byteOffset;
    }
}

std::size_t AccessorReader::sparse_index(std::size_t i) const {
    const int type = accessor_.sparse.indices.componentType;
    return load_index(sparse_indices_ + i * component_bytes(type), type);
}

const std::uint8_t* AccessorReader::find(std::size_t element) const {
    if (sparse_count_ > 0) {
        std::size_t low = 0;
        std::size_t high = sparse_count_;
        while (low < high) {  // first index not below the element; check_accessors saw them sorted
            const std::size_t middle = (low + high) / 2;
            if (sparse_index(middle) < element) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        if (low < sparse_count_ && sparse_index(low) == element) {
            return sparse_values_ + low * element_bytes_;
        }
    }
    return data_ ? data_ + element * stride_ : nullptr;
}

double AccessorReader::number(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0.0;
    bytes += component / width_ * column_bytes_ + component % width_ * component_bytes_;
    const auto signed_unit = [this](double value, double largest) {
        return accessor_.normalized ? std::max(value / largest, -1.0) : value;
    };
    switch (accessor_.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return signed_unit(load<std::int8_t>(bytes), 127.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return signed_unit(load<std::uint8_t>(bytes), 255.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return signed_unit(load<std::int16_t>(bytes), 32767.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return signed_unit(load<std::uint16_t>(bytes), 65535.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load<float>(bytes);
    }
    return 0.0;
}

std::uint32_t AccessorReader::integer(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0;
    return load_index(bytes + component * component_bytes_, accessor_.componentType);
}

std::size_t AccessorReader::first_not_finite() const {
    if (accessor_.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) return size();
    std::size_t next = 0;  // of those replaced; quicker than to find each
    for (std::size_t element = 0; element < size(); ++element) {
        const std::uint8_t* bytes = data_ ? data_ + element * stride_ : nullptr;
        if (next < sparse_count_ && sparse_index(next) == element) {
            bytes = sparse_values_ + next++ * element_bytes_;
        }
        if (bytes && !all_finite(bytes, element_bytes_)) return element;
    }
    return size();
}

glm::dvec2 AccessorReader::vec2(std::size_t element) const {
    return {number(element, 0), number(element, 1)};
}

glm::dvec3 AccessorReader::vec3(std::size_t element) const {
    return {number(element, 0), number(element, 1), number(element, 2)};
}

glm::dvec4 AccessorReader::vec4(std::size_t element) const {
    return {number(element, 0), number(element, 1), number(element, 2), number(element, 3)};
}

glm::dmat4 AccessorReader::mat4(std::size_t element) const {
    glm::dmat4 matrix;
    for (std::size_t i = 0; i < 16; ++i) {
        matrix[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = number(element, i);
    }
    return matrix;
}

}  // namespace clgi::io::gltf
