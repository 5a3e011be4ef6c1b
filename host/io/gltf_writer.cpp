// SPDX-License-Identifier: MIT
#include "io/gltf_writer.hpp"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

namespace clgi::io::gltf {

std::string utf8(const std::string& name) {
    using nlohmann::json;
    return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace));
}

std::pair<glm::dvec3, double> color_and_strength(const glm::vec3& light) {
    const double strength = std::max({light.r, light.g, light.b});
    return {strength > 0.0 ? glm::dvec3(light) / strength : glm::dvec3(1.0), strength};
}

int GlbModel::add_view(const void* data, std::size_t bytes, int target, std::size_t stride) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = binary.size();
    view.byteLength = bytes;
    view.byteStride = stride;
    view.target = target;
    binary.resize(view.byteOffset + (bytes + 3) / 4 * 4);
    std::memcpy(binary.data() + view.byteOffset, data, bytes);
    return add(model.bufferViews, std::move(view));
}

int GlbModel::add_bounded(const std::vector<glm::vec3>& values) {
    glm::vec3 low = values[0], high = values[0];
    for (const glm::vec3& value : values) {
        low = glm::min(low, value);
        high = glm::max(high, value);
    }
    const int index = add_vertices(values);
    model.accessors.back().minValues = numbers(low);
    model.accessors.back().maxValues = numbers(high);
    return index;
}

}  // namespace clgi::io::gltf
