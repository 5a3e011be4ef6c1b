// Buffers, buffer views and accessors as the JSON declares them.
// SPDX-License-Identifier: MIT
#include <limits>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

struct Shape {
    const char* name;
    int rows;
    int columns;
};
constexpr Shape shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                            {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

std::size_t at_least_one(const Value& value) {
    const std::uint64_t number = value.integer();
    if (number == 0) value.fail("is 0, at least 1 is needed");
    return number;
}

Component component(const Value& value) {
    const std::uint64_t code = value.integer();
    if (code < 5120 || code > 5126 || code == 5124) {
        value.fail("is " + std::to_string(code) + ", no component type");
    }
    return static_cast<Component>(code);
}

Buffer read_buffer(const Value& value) {
    Buffer buffer;
    buffer.length = at_least_one(value.at("byteLength"));
    if (const auto uri = value.find("uri")) buffer.uri = uri->text();
    if (const auto meshopt = value.extension("EXT_meshopt_compression")) {
        buffer.fallback = meshopt->flag_or("fallback", false);
    }
    return buffer;
}

BufferView read_view(const Value& value, const std::vector<Buffer>& buffers) {
    BufferView view;
    view.buffer = value.at("buffer").index(buffers.size(), "buffers");
    view.offset = value.integer_or("byteOffset", 0);
    view.length = at_least_one(value.at("byteLength"));
    const std::size_t available = buffers[view.buffer].length;
    if (view.length > available || view.offset > available - view.length) {
        value.fail("is " + std::to_string(view.length) + " bytes at " +
                   std::to_string(view.offset) + ", its buffer has " + std::to_string(available));
    }
    if (const auto stride = value.find("byteStride")) {
        view.stride = stride->integer();
        if (view.stride < 4 || view.stride > 252 || view.stride % 4 != 0) {
            stride->fail("is " + std::to_string(view.stride) + ", not a multiple of 4 up to 252");
        }
    }
    if (const auto target = value.find("target")) {
        const std::uint64_t code = target->integer();
        if (code != 34962 && code != 34963) target->fail("is neither 34962 nor 34963");
        if (code == 34963 && view.stride > 0) value.fail("holds indices, but has a byteStride");
    }
    return view;
}

Sparse read_sparse(const Value& value, std::size_t accessor_count, std::size_t views) {
    Sparse sparse;
    sparse.count = at_least_one(value.at("count"));
    if (sparse.count > accessor_count) {
        value.fail("replaces " + std::to_string(sparse.count) + " of " +
                   std::to_string(accessor_count) + " elements");
    }
    const Value indices = value.at("indices");
    sparse.index_view = indices.at("bufferView").index(views, "buffer views");
    sparse.index_offset = indices.integer_or("byteOffset", 0);
    sparse.index_type = component(indices.at("componentType"));
    if (sparse.index_type != Component::uint8 && sparse.index_type != Component::uint16 &&
        sparse.index_type != Component::uint32) {
        indices.fail("are not of an unsigned integer type");
    }
    const Value values = value.at("values");
    sparse.value_view = values.at("bufferView").index(views, "buffer views");
    sparse.value_offset = values.integer_or("byteOffset", 0);
    return sparse;
}

Accessor read_accessor(const Value& value, std::size_t views) {
    Accessor accessor;
    accessor.component = component(value.at("componentType"));
    accessor.count = at_least_one(value.at("count"));
    accessor.normalized = value.flag_or("normalized", false);
    accessor.view = value.index_or_none("bufferView", views, "buffer views");
    accessor.offset = value.integer_or("byteOffset", 0);
    if (accessor.view < 0 && value.find("byteOffset")) value.fail("has an offset into no view");

    const std::string type = value.at("type").text();
    bool known = false;
    for (const Shape& shape : shapes) {
        if (type != shape.name) continue;
        accessor.rows = shape.rows;
        accessor.columns = shape.columns;
        known = true;
    }
    if (!known) value.at("type").fail("is \"" + printable(type) + "\"");

    if (const auto sparse = value.find("sparse")) {
        accessor.sparse = read_sparse(*sparse, accessor.count, views);
    }
    return accessor;
}

}  // namespace

std::size_t byte_size(Component component) {
    switch (component) {
        case Component::int8:
        case Component::uint8:
            return 1;
        case Component::int16:
        case Component::uint16:
            return 2;
        default:
            return 4;
    }
}

std::size_t Accessor::column_bytes() const {
    const std::size_t bytes = byte_size(component) * static_cast<std::size_t>(rows);
    return columns > 1 ? (bytes + 3) / 4 * 4 : bytes;
}

std::size_t Accessor::element_bytes() const {
    return column_bytes() * static_cast<std::size_t>(columns);
}

void read_data(const Value& root, Document& document) {
    const std::size_t buffers = entries(root, "buffers", max_rare_entries);
    for (std::size_t i = 0; i < buffers; ++i) {
        document.buffers.push_back(read_buffer(root.at("buffers").item(i)));
    }
    const std::size_t views = entries(root, "bufferViews");
    for (std::size_t i = 0; i < views; ++i) {
        document.views.push_back(read_view(root.at("bufferViews").item(i), document.buffers));
    }
    const std::size_t accessors = entries(root, "accessors");
    for (std::size_t i = 0; i < accessors; ++i) {
        document.accessors.push_back(read_accessor(root.at("accessors").item(i), views));
    }
}

}  // namespace clgi::io::gltf
