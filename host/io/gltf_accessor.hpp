// Reading accessors: any component type, normalised integers, strides, sparse replacement.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// How the numbers of an element lie in memory.
struct Layout {
    explicit Layout(const Accessor& accessor);

    std::size_t component_bytes;
    std::size_t rows;
    std::size_t columns;  // above 1: a matrix
    std::size_t column_bytes;
    std::size_t bytes;
};

class AccessorReader {
public:
    AccessorReader(const Document& document, int accessor);

    std::size_t size() const { return accessor_.count; }
    std::size_t width() const { return layout_.rows; }

    // element < size(). number maps normalised integers to [0,1] or [-1,1].
    double number(std::size_t element, std::size_t component) const;
    std::uint32_t integer(std::size_t element, std::size_t component = 0) const;

    template <int n>
    glm::vec<n, double> vector(std::size_t element, std::size_t first_component = 0) const {
        glm::vec<n, double> v;
        for (int i = 0; i < n; ++i) v[i] = number(element, first_component + i);
        return v;
    }

    // The first element with a number that is not finite, size() when there is none.
    std::size_t first_not_finite() const;

private:
    const std::uint8_t* find(std::size_t element) const;  // null: zeros
    const std::uint8_t* dense(std::size_t element) const;
    std::size_t sparse_index(std::size_t i) const;

    const Accessor& accessor_;
    Layout layout_;
    const std::uint8_t* data_ = nullptr;
    std::size_t stride_ = 0;
    std::size_t sparse_count_ = 0;
    const std::uint8_t* sparse_indices_ = nullptr;
    const std::uint8_t* sparse_values_ = nullptr;
};

// Nothing where there is no attribute of that name.
inline std::optional<AccessorReader> reader_of(const Document& document,
                                               const Attributes& attributes,
                                               const std::string& name) {
    const int accessor = attribute(attributes, name);
    if (accessor < 0) return std::nullopt;
    return AccessorReader(document, accessor);
}

}  // namespace clgi::io::gltf
