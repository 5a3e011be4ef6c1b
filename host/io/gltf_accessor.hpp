// Reading accessors: any component type, normalised integers, strides, sparse replacement.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

std::size_t component_bytes(int component);
std::size_t rows(const Accessor& accessor);
std::size_t columns(const Accessor& accessor);  // above 1: a matrix
std::size_t element_bytes(const Accessor& accessor);
std::size_t sparse_count(const Accessor& accessor);  // of elements that are replaced

// Throws InputError when an accessor, or its sparse part, would read outside its buffer view,
// needs data that is not there, or replaces elements out of order. After this no read by an
// AccessorReader leaves its buffer.
void check_accessors(const Document& document);

class AccessorReader {
public:
    AccessorReader(const Document& document, int accessor);

    std::size_t size() const { return accessor_.count; }
    std::size_t width() const { return width_; }

    // element < size(), component < width(). number maps normalised integers to [0,1] or [-1,1].
    double number(std::size_t element, std::size_t component) const;
    std::uint32_t integer(std::size_t element, std::size_t component = 0) const;

    // The first element with a number that is not finite, size() when there is none.
    std::size_t first_not_finite() const;

    glm::dvec2 vec2(std::size_t element) const;
    glm::dvec3 vec3(std::size_t element) const;
    glm::dvec4 vec4(std::size_t element) const;
    glm::dmat4 mat4(std::size_t element) const;

private:
    const std::uint8_t* find(std::size_t element) const;  // null: zeros
    std::size_t sparse_index(std::size_t i) const;

    const Accessor& accessor_;
    std::size_t width_;
    std::size_t component_bytes_;
    std::size_t column_bytes_;
    std::size_t element_bytes_;
    std::size_t sparse_count_;
    const std::uint8_t* data_ = nullptr;
    std::size_t stride_ = 0;
    const std::uint8_t* sparse_indices_ = nullptr;
    const std::uint8_t* sparse_values_ = nullptr;
};

}  // namespace clgi::io::gltf
