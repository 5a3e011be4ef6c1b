// save_glb: a scene as tinygltf's model with one buffer, then the file.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "io/gltf_primitive.hpp"
#include "io/png_encode.hpp"

namespace clgi::io {

namespace gltf {

namespace {

using tinygltf::Value;

// More meshes than this make a file that readers choke on; the parts are then given up.
constexpr std::size_t most_parts = 100'000;

// Names may come from anywhere; what is not UTF-8 in them is replaced.
std::string utf8(const std::string& name) {
    using nlohmann::json;
    return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace));
}

// Appends to a list of the model; returns the index of the new entry.
template <typename T>
int add(std::vector<T>& list, T entry) {
    list.push_back(std::move(entry));
    return static_cast<int>(list.size()) - 1;
}

template <typename Vector>
std::vector<double> numbers(const Vector& v) {
    std::vector<double> list;
    for (int i = 0; i < Vector::length(); ++i) list.push_back(v[i]);
    return list;
}

// For emission and lights: a color whose largest channel is 1, and what multiplies it.
std::pair<glm::dvec3, double> color_and_strength(const glm::vec3& light) {
    const double strength = std::max({light.r, light.g, light.b});
    return {strength > 0.0 ? glm::dvec3(light) / strength : glm::dvec3(1.0), strength};
}

// The transform as scale, then turn, then shift, which is all that glTF can say.
Value transform_of(const glm::dmat3& m) {
    const double scale_u = std::hypot(m[0][0], m[0][1]);
    const double angle =
        scale_u > 0.0 ? std::atan2(-m[0][1], m[0][0]) : std::atan2(m[1][0], m[1][1]);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double scale_v = m[1][0] * s + m[1][1] * c;
    const double shear = m[1][0] * c - m[1][1] * s;
    const bool affine = m[0][2] == 0.0 && m[1][2] == 0.0 && m[2][2] == 1.0;
    require(affine && std::abs(shear) <= 1e-4 * (scale_u + std::abs(scale_v)),
            "has a uv transform that glTF cannot express");
    const auto pair = [](double x, double y) { return Value(Value::Array{Value(x), Value(y)}); };
    return Value(Value::Object{{"offset", pair(m[2][0], m[2][1])},
                               {"rotation", Value(angle)},
                               {"scale", pair(scale_u, scale_v)}});
}

tinygltf::Light light_of(const Light& light) {
    const auto [color, strength] = color_and_strength(light.intensity);
    tinygltf::Light written;
    written.name = utf8(light.name);
    written.color = numbers(color);
    written.intensity = strength;
    written.type = "directional";
    if (light.kind == Light::Kind::directional) return written;
    written.type = light.kind == Light::Kind::spot ? "spot" : "point";
    written.range = light.range;
    written.spot.innerConeAngle = light.inner_angle;
    written.spot.outerConeAngle = light.outer_angle;
    return written;
}

tinygltf::Camera camera_of(const Camera& camera, double scene_size) {
    const bool perspective = camera.kind == Camera::Kind::perspective;
    tinygltf::Camera written;
    written.name = utf8(camera.name);
    written.type = perspective ? "perspective" : "orthographic";
    written.perspective.yfov = camera.vertical_fov;
    // glTF wants a near distance above 0; 0 here means that it is for the reader to choose.
    written.perspective.znear = camera.near > 0.0f ? camera.near : 1e-3 * scene_size;
    written.orthographic.xmag = written.orthographic.ymag = camera.half_height;
    written.orthographic.znear = camera.near;
    // tinygltf writes a far distance in any case. Nobody reads this one.
    written.perspective.zfar = written.orthographic.zfar = 2.0 * camera.near + 10.0 * scene_size;
    return written;
}

// A rotation that takes -Z to a direction.
glm::dquat turn_to(const glm::dvec3& direction) {
    const glm::dvec3 forward = glm::normalize(direction);
    const bool upright = std::abs(forward.y) < 0.9;
    return glm::quatLookAt(forward, upright ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
}

class GlbWriter {
public:
    explicit GlbWriter(const Scene& scene) : scene_(scene) {
        model_.asset.generator = "clgi";
        for (const Texture& texture : scene.textures) add_texture(texture);
        each("materials", scene.materials,
             [&](const Material& material) { add_material(material); });
        add_meshes();
        for (const Light& light : scene.lights) {
            const bool directed = light.kind != Light::Kind::point;
            tinygltf::Node node = node_at(
                light.position, directed ? turn_to(light.direction) : glm::dquat(1, 0, 0, 0));
            const int index = add(model_.lights, light_of(light));
            node.extensions["KHR_lights_punctual"] = Value(Value::Object{{"light", Value(index)}});
            add_root(std::move(node));
        }
        const double size = glm::length(bounds(scene).high - bounds(scene).low);
        for (const Camera& camera : scene.cameras) {
            const glm::dmat3 axes(camera.right, camera.up, -camera.forward);
            tinygltf::Node node = node_at(camera.position, glm::normalize(glm::quat_cast(axes)));
            node.camera = add(model_.cameras, camera_of(camera, size > 0.0 ? size : 1.0));
            add_root(std::move(node));
        }
        if (!roots_.empty()) {  // tinygltf writes null for a scene of nothing
            tinygltf::Scene listed;
            listed.name = utf8(scene.name);
            listed.nodes = roots_;
            model_.defaultScene = add(model_.scenes, std::move(listed));
        }
        if (!binary_.empty()) model_.buffers.emplace_back().data = std::move(binary_);
    }

    std::string file() {
        std::ostringstream stream;
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true);
        return std::move(stream).str();
    }

private:
    static tinygltf::Node node_at(const glm::dvec3& position, const glm::dquat& rotation) {
        tinygltf::Node node;
        node.translation = numbers(position);
        node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
        return node;
    }

    void add_root(tinygltf::Node node) { roots_.push_back(add(model_.nodes, std::move(node))); }

    // Appends the bytes as a buffer view, aligned to 4. stride 0: none.
    int add_view(const void* data, std::size_t bytes, int target = 0, std::size_t stride = 0) {
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = binary_.size();
        view.byteLength = bytes;
        view.byteStride = stride;
        view.target = target;
        binary_.resize(view.byteOffset + (bytes + 3) / 4 * 4);
        std::memcpy(binary_.data() + view.byteOffset, data, bytes);
        return add(model_.bufferViews, std::move(view));
    }

    void add_texture(const Texture& texture) {
        const auto png = encode_png(texture.width, texture.height, texture.rgba.data());
        tinygltf::Image image;
        image.name = utf8(texture.name);
        image.mimeType = "image/png";
        image.bufferView = add_view(png.data(), png.size());
        tinygltf::Sampler sampler;
        sampler.wrapS = wrap_code(texture.wrap_s);
        sampler.wrapT = wrap_code(texture.wrap_t);
        sampler.magFilter =
            texture.nearest ? TINYGLTF_TEXTURE_FILTER_NEAREST : TINYGLTF_TEXTURE_FILTER_LINEAR;
        sampler.minFilter = sampler.magFilter;
        tinygltf::Texture written;
        written.source = add(model_.images, std::move(image));
        written.sampler = add(model_.samplers, std::move(sampler));
        add(model_.textures, std::move(written));
    }

    void extend(tinygltf::ExtensionMap& extensions, const char* name, Value value) {
        extensions[name] = std::move(value);
        std::vector<std::string>& used = model_.extensionsUsed;
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    }

    tinygltf::TextureInfo info_of(const TextureSlot& slot) {
        tinygltf::TextureInfo info;
        info.index = slot.texture;  // -1, none, is not written
        info.texCoord = slot.uv_set;
        if (slot.texture >= 0 && slot.transform != glm::mat3(1.0f)) {
            extend(info.extensions, "KHR_texture_transform",
                   transform_of(glm::dmat3(slot.transform)));
        }
        return info;
    }

    void add_material(const Material& material) {
        tinygltf::Material written;
        written.name = utf8(material.name);
        written.pbrMetallicRoughness.baseColorFactor = numbers(material.base_color);
        written.pbrMetallicRoughness.metallicFactor = material.metallic;
        written.pbrMetallicRoughness.roughnessFactor = material.roughness;
        written.pbrMetallicRoughness.baseColorTexture = info_of(material.base_texture);
        written.doubleSided = material.double_sided;
        if (material.alpha_mode == AlphaMode::mask) {
            written.alphaMode = "MASK";
            written.alphaCutoff = material.alpha_cutoff;
        }
        written.emissiveFactor = numbers(material.emission);
        written.emissiveTexture = info_of(material.emission_texture);
        // Factors end at 1; what is brighter goes into the strength. So does what is very dark:
        // tinygltf takes factors below 1e-12 for black.
        const auto [color, strength] = color_and_strength(material.emission);
        if (strength > 1.0 || (strength > 0.0 && strength < 1e-6)) {
            written.emissiveFactor = numbers(color);
            extend(written.extensions, "KHR_materials_emissive_strength",
                   Value(Value::Object{{"emissiveStrength", Value(strength)}}));
        }
        add(model_.materials, std::move(written));
    }

    // Each array gets a view of its own: tinygltf writes the offsets of accessors with 32 bits.
    template <typename T>
    int add_array(const std::vector<T>& values, int type, int component, int target,
                  std::size_t stride = 0) {
        tinygltf::Accessor accessor;
        accessor.bufferView = add_view(values.data(), values.size() * sizeof(T), target, stride);
        accessor.count = values.size();
        accessor.type = type;
        accessor.componentType = component;
        return add(model_.accessors, std::move(accessor));
    }

    // Of the vertices in use. tinygltf's types: VEC2 is 2, VEC3 is 3, VEC4 is 4.
    template <typename Make>
    int add_vertices(const std::vector<std::uint32_t>& vertices, Make make) {
        std::vector<decltype(make(0u))> values;
        for (const std::uint32_t v : vertices) values.push_back(make(v));
        return add_array(values, values[0].length(), TINYGLTF_COMPONENT_TYPE_FLOAT,
                         TINYGLTF_TARGET_ARRAY_BUFFER, sizeof(values[0]));
    }

    // Triangles of one material as a primitive with vertices of its own.
    tinygltf::Primitive primitive_of(std::vector<Corners> triangles, std::uint32_t material) {
        const std::vector<std::uint32_t> used = renumberer_.renumber(triangles);
        glm::vec3 low(INFINITY);
        glm::vec3 high(-INFINITY);
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = static_cast<int>(material);
        std::map<std::string, int>& attributes = primitive.attributes;
        attributes["POSITION"] = add_vertices(used, [&](std::uint32_t v) {
            const glm::vec3 p(scene_.positions[v] - centre_);
            low = glm::min(low, p);
            high = glm::max(high, p);
            return p;
        });
        model_.accessors.back().minValues = numbers(low);
        model_.accessors.back().maxValues = numbers(high);
        attributes["NORMAL"] =
            add_vertices(used, [&](std::uint32_t v) { return glm::normalize(scene_.normals[v]); });
        if (!scene_.uvs.empty()) {
            const auto& uvs = scene_.uvs;
            attributes["TEXCOORD_0"] =
                add_vertices(used, [&](std::uint32_t v) { return glm::vec2(uvs[v]); });
            attributes["TEXCOORD_1"] =
                add_vertices(used, [&](std::uint32_t v) { return glm::vec2(uvs[v].z, uvs[v].w); });
        }
        if (!scene_.colors.empty()) {
            attributes["COLOR_0"] =
                add_vertices(used, [&](std::uint32_t v) { return scene_.colors[v]; });
        }
        std::vector<std::uint32_t> indices;
        for (const Corners& corner : triangles) {
            indices.insert(indices.end(), corner.begin(), corner.end());
        }
        primitive.indices =
            add_array(indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                      TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        return primitive;
    }

    // A node with the triangles of a range as its mesh.
    void add_range(const std::string& name, std::size_t begin, std::size_t end,
                   tinygltf::Node& root) {
        if (begin >= end) return;
        std::map<std::uint32_t, std::vector<Corners>> by_material;
        for (std::size_t t = begin; t < end; ++t) {
            const auto& [vertex, material] = scene_.triangles[t];
            by_material[material].push_back({vertex[0], vertex[1], vertex[2]});
        }
        tinygltf::Mesh mesh;
        for (auto& [material, triangles] : by_material) {
            mesh.primitives.push_back(primitive_of(std::move(triangles), material));
        }
        tinygltf::Node node;
        node.name = utf8(name);
        node.mesh = add(model_.meshes, std::move(mesh));
        root.children.push_back(add(model_.nodes, std::move(node)));
    }

    // A node at the centre of the scene; below it the parts in the order of their triangles, and
    // what is between them.
    void add_meshes() {
        if (scene_.triangles.empty()) return;
        const Bounds box = bounds(scene_);
        centre_ = (box.low + box.high) * 0.5;
        std::vector<Part> parts = scene_.parts;
        std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
            return a.first_triangle < b.first_triangle;
        });
        if (parts.size() > most_parts) parts.clear();
        tinygltf::Node root;
        root.translation = numbers(centre_);
        std::size_t done = 0;
        for (const Part& part : parts) {
            const std::size_t begin = std::max<std::size_t>(part.first_triangle, done);
            const std::size_t end = std::size_t{part.first_triangle} + part.triangle_count;
            if (end <= begin) continue;  // inside the part before it
            add_range("", done, begin, root);
            add_range(part.name, begin, end, root);
            done = end;
        }
        add_range("", done, scene_.triangles.size(), root);
        add_root(std::move(root));
    }

    const Scene& scene_;
    tinygltf::Model model_;
    std::vector<std::uint8_t> binary_;
    std::vector<int> roots_;  // nodes of the scene
    glm::dvec3 centre_ = glm::dvec3(0.0);
    Renumberer renumberer_;
};

}  // namespace

}  // namespace gltf

void save_glb(const Scene& scene, const std::filesystem::path& path) {
    std::string bytes;
    try {
        validate(scene);
        bytes = gltf::GlbWriter(scene).file();
        // tinygltf cuts the length of a file to 32 bits.
        gltf::require(bytes.size() <= UINT32_MAX, "the scene is larger than the 4 GiB of a GLB");
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace clgi::io
