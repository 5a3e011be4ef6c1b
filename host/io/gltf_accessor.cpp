// SPDX-License-Identifier: MIT
#include "io/gltf_accessor.hpp"

#include <algorithm>
#include <clgi/error.hpp>
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

// Unsigned integer of the type, as indices have it.
std::uint32_t load_index(const std::uint8_t* bytes, Component component) {
    switch (component) {
        case Component::uint8:
            return *bytes;
        case Component::uint16:
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
    const BufferView& range = document.views[view];
    return document.buffers[range.buffer].data.data() + range.offset;
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
    const BufferView& range = document.views[view];
    if (document.buffers[range.buffer].data.empty()) {
        throw InputError(name +
                         " needs data that only EXT_meshopt_compression gives, which clgi does "
                         "not read");
    }
    if (!fits(range.length, offset, count, stride, bytes)) {
        throw InputError(name + " reads " + std::to_string(count) + " elements at " +
                         std::to_string(offset) + ", beyond the " + std::to_string(range.length) +
                         " bytes of bufferViews[" + std::to_string(view) + "]");
    }
}

void check_sparse(const Document& document, const std::string& name, const Accessor& accessor) {
    const Sparse& sparse = *accessor.sparse;
    const std::size_t index_bytes = byte_size(sparse.index_type);
    const std::size_t value_bytes = accessor.element_bytes();
    check_range(document, name + ".sparse.indices", sparse.index_view, sparse.index_offset,
                sparse.count, index_bytes, index_bytes);
    check_range(document, name + ".sparse.values", sparse.value_view, sparse.value_offset,
                sparse.count, value_bytes, value_bytes);

    const std::uint8_t* indices = view_data(document, sparse.index_view) + sparse.index_offset;
    std::uint32_t previous = 0;
    for (std::size_t i = 0; i < sparse.count; ++i) {
        const std::uint32_t index = load_index(indices + i * index_bytes, sparse.index_type);
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

void check_accessors(const Document& document) {
    // Elements that no bytes stand for cost nothing in the file; bound them by what does.
    std::size_t most_zeros = 65536;
    for (const Buffer& buffer : document.buffers) most_zeros += buffer.data.size();
    std::size_t sparse_total = 0;

    for (std::size_t i = 0; i < document.accessors.size(); ++i) {
        const Accessor& accessor = document.accessors[i];
        const std::string name = "accessors[" + std::to_string(i) + "]";
        const std::size_t bytes = accessor.element_bytes();
        if (accessor.view >= 0) {
            const std::size_t declared = document.views[accessor.view].stride;
            const std::size_t stride = declared > 0 ? declared : bytes;
            if (stride < bytes) {
                throw InputError(name + " has elements of " + std::to_string(bytes) +
                                 " bytes, its view a stride of " + std::to_string(stride));
            }
            check_range(document, name, accessor.view, accessor.offset, accessor.count, stride,
                        bytes);
        } else if (accessor.count > most_zeros) {
            throw InputError(name + " has " + std::to_string(accessor.count) +
                             " elements and no data");
        }
        if (!accessor.sparse) continue;
        // Many accessors may share one list of indices, each check reads all of it.
        sparse_total += accessor.sparse->count;
        if (sparse_total > std::size_t{1} << 28) throw InputError(name + ": too much sparse data");
        check_sparse(document, name, accessor);
    }
}

AccessorReader::AccessorReader(const Document& document, int accessor)
    : accessor_(document.accessors[accessor]) {
    if (accessor_.view >= 0) {
        const std::size_t declared = document.views[accessor_.view].stride;
        data_ = view_data(document, accessor_.view) + accessor_.offset;
        stride_ = declared > 0 ? declared : accessor_.element_bytes();
    }
    if (accessor_.sparse) {
        const Sparse& sparse = *accessor_.sparse;
        sparse_indices_ = view_data(document, sparse.index_view) + sparse.index_offset;
        sparse_values_ = view_data(document, sparse.value_view) + sparse.value_offset;
    }
}

std::size_t AccessorReader::sparse_index(std::size_t i) const {
    const Component type = accessor_.sparse->index_type;
    return load_index(sparse_indices_ + i * byte_size(type), type);
}

const std::uint8_t* AccessorReader::find(std::size_t element) const {
    if (accessor_.sparse) {
        std::size_t low = 0;
        std::size_t high = accessor_.sparse->count;
        while (low < high) {  // first index not below the element; check_accessors saw them sorted
            const std::size_t middle = (low + high) / 2;
            if (sparse_index(middle) < element) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        if (low < accessor_.sparse->count && sparse_index(low) == element) {
            return sparse_values_ + low * accessor_.element_bytes();
        }
    }
    return data_ ? data_ + element * stride_ : nullptr;
}

double AccessorReader::number(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0.0;
    bytes += component / width() * accessor_.column_bytes() +
             component % width() * byte_size(accessor_.component);
    const auto signed_unit = [this](double value, double largest) {
        return accessor_.normalized ? std::max(value / largest, -1.0) : value;
    };
    switch (accessor_.component) {
        case Component::int8:
            return signed_unit(load<std::int8_t>(bytes), 127.0);
        case Component::uint8:
            return signed_unit(load<std::uint8_t>(bytes), 255.0);
        case Component::int16:
            return signed_unit(load<std::int16_t>(bytes), 32767.0);
        case Component::uint16:
            return signed_unit(load<std::uint16_t>(bytes), 65535.0);
        case Component::uint32:
            return load<std::uint32_t>(bytes);
        case Component::float32:
            return load<float>(bytes);
    }
    return 0.0;
}

std::uint32_t AccessorReader::integer(std::size_t element, std::size_t component) const {
    const std::uint8_t* bytes = find(element);
    if (!bytes) return 0;
    return load_index(bytes + component * byte_size(accessor_.component), accessor_.component);
}

std::size_t AccessorReader::first_not_finite() const {
    if (accessor_.component != Component::float32) return size();
    const std::size_t length = accessor_.element_bytes();
    const std::size_t replaced = accessor_.sparse ? accessor_.sparse->count : 0;
    std::size_t next = 0;  // of those replaced; quicker than to find each
    for (std::size_t element = 0; element < size(); ++element) {
        const std::uint8_t* bytes = data_ ? data_ + element * stride_ : nullptr;
        if (next < replaced && sparse_index(next) == element) {
            bytes = sparse_values_ + next++ * length;
        }
        if (bytes && !all_finite(bytes, length)) return element;
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
