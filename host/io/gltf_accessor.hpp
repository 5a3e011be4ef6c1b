// Reading accessors: any component type, normalised integers, strides, sparse replacement.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

std::size_t rows(const Accessor& accessor);
std::size_t columns(const Accessor& accessor);  // above 1: a matrix

class AccessorReader {
public:
    // Throws InputError if the accessor, or its sparse part, reads outside its view.
    AccessorReader(const Document& document, const Accessor& accessor);

    std::size_t size() const { return accessor_.count; }

    // element < size(). number maps normalised integers to [0,1] or [-1,1].
    double number(std::size_t element, std::size_t component) const;
    std::uint32_t integer(std::size_t element, std::size_t component = 0) const;

    template <int n>
    glm::vec<n, double> vector(std::size_t element, std::size_t first_component = 0) const {
        glm::vec<n, double> v;
        for (int i = 0; i < n; ++i) v[i] = number(element, first_component + i);
        return v;
    }

    // Reading expects that replaced elements are in order.
    bool is_in_order() const;

    // The first element with a number that is not finite, size() when there is none.
    std::size_t first_not_finite() const;

private:
    struct Elements {
        const std::uint8_t* data = nullptr;
        std::size_t stride = 0;

        // Null without data.
        const std::uint8_t* at(std::size_t i) const { return data ? data + i * stride : nullptr; }
    };

    static Elements elements(const Document& document, int view, std::size_t offset,
                             std::size_t count, std::size_t bytes, bool strided);
    const std::uint8_t* find(std::size_t element) const;  // null: zeros
    std::size_t replaced(std::size_t i) const;

    const Accessor& accessor_;
    std::size_t component_bytes_;
    std::size_t column_bytes_;
    std::size_t bytes_;
    std::size_t sparse_count_ = 0;
    Elements dense_;
    Elements sparse_indices_;
    Elements sparse_values_;
};

// Nothing where there is no attribute of that name.
inline std::optional<AccessorReader> reader_of(const Document& document,
                                               const Attributes& attributes,
                                               const std::string& name) {
    const int accessor = attribute(attributes, name);
    if (accessor < 0) return std::nullopt;
    return AccessorReader(document, document.model.accessors[accessor]);
}

}  // namespace clgi::io::gltf
