// glTF's formulas once more, straight from tinygltf's model in double precision: what animated
// files look like at a time, written without a look at the library's own code.
// SPDX-License-Identifier: MIT
#pragma once

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

namespace clgi::test {

struct TrueCorner {
    glm::dvec3 position, normal;
};

class GltfTruth {
public:
    explicit GltfTruth(const std::filesystem::path& file) {
        tinygltf::TinyGLTF reader;
        reader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                                 const unsigned char*, int, void*) { return true; },
                              nullptr);
        std::string error, warning;
        const bool right = file.extension() == ".glb"
                               ? reader.LoadBinaryFromFile(&model_, &error, &warning, file.string())
                               : reader.LoadASCIIFromFile(&model_, &error, &warning, file.string());
        if (!right) throw std::runtime_error(file.string() + ": " + error);
    }

    std::size_t clips() const { return model_.animations.size(); }

    double duration(std::size_t clip) const {
        double end = 0.0;
        for (const auto& channel : model_.animations[clip].channels) {
            const auto& sampler =
                model_.animations[clip].samplers[static_cast<std::size_t>(channel.sampler)];
            end = std::max(end, numbers(sampler.input).back());
        }
        return end;
    }

    // Corners of all triangles that the default scene shows, in the order of nodes by their
    // distance from the root.
    std::vector<TrueCorner> at(std::size_t clip, double time) {
        tinygltf::Model still = model_;
        for (const auto& channel : model_.animations[clip].channels)
            drive(model_.animations[clip], channel, time);
        std::vector<TrueCorner> corners;
        std::vector<int> nodes =
            model_.scenes[static_cast<std::size_t>(std::max(model_.defaultScene, 0))].nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(nodes[i])];
            nodes.insert(nodes.end(), node.children.begin(), node.children.end());
        }
        for (const int node : nodes)
            if (model_.nodes[static_cast<std::size_t>(node)].mesh >= 0) show(node, corners);
        model_ = std::move(still);
        return corners;
    }

private:
    using Numbers = std::vector<double>;

    // All components of an accessor, sparse or not.
    Numbers numbers(int index) const {
        const tinygltf::Accessor& a = model_.accessors[static_cast<std::size_t>(index)];
        const std::size_t width = static_cast<std::size_t>(
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type)));
        Numbers out(a.count * width, 0.0);
        const auto bytes_of = [&](int view, std::size_t offset) {
            const tinygltf::BufferView& v = model_.bufferViews[static_cast<std::size_t>(view)];
            return model_.buffers[static_cast<std::size_t>(v.buffer)].data.data() + v.byteOffset +
                   offset;
        };
        if (a.bufferView >= 0) {
            const unsigned char* bytes = bytes_of(a.bufferView, a.byteOffset);
            const auto stride = static_cast<std::size_t>(
                a.ByteStride(model_.bufferViews[static_cast<std::size_t>(a.bufferView)]));
            for (std::size_t i = 0; i < a.count; ++i)
                for (std::size_t c = 0; c < width; ++c)
                    out[i * width + c] =
                        number(bytes + i * stride, c, a.componentType, a.normalized);
        }
        if (!a.sparse.isSparse) return out;
        const unsigned char* at = bytes_of(a.sparse.indices.bufferView,
                                           static_cast<std::size_t>(a.sparse.indices.byteOffset));
        const unsigned char* values = bytes_of(
            a.sparse.values.bufferView, static_cast<std::size_t>(a.sparse.values.byteOffset));
        for (int i = 0; i < a.sparse.count; ++i) {
            const auto place = static_cast<std::size_t>(
                number(at, static_cast<std::size_t>(i), a.sparse.indices.componentType, false));
            for (std::size_t c = 0; c < width; ++c)
                out[place * width + c] = number(values, static_cast<std::size_t>(i) * width + c,
                                                a.componentType, a.normalized);
        }
        return out;
    }

    static double number(const unsigned char* bytes, std::size_t i, int type, bool normalized) {
        const auto read = [&](auto value, double most) {
            std::memcpy(&value, bytes + i * sizeof value, sizeof value);
            return normalized ? std::max(static_cast<double>(value) / most, -1.0)
                              : static_cast<double>(value);
        };
        switch (type) {
            case 5120:
                return read(std::int8_t{}, 127.0);
            case 5121:
                return read(std::uint8_t{}, 255.0);
            case 5122:
                return read(std::int16_t{}, 32767.0);
            case 5123:
                return read(std::uint16_t{}, 65535.0);
            case 5125:
                return read(std::uint32_t{}, 1.0);
            default:
                return read(float{}, 1.0);
        }
    }

    // Appendix C of glTF 2.0; the spherical step as a power of the turn between the two.
    void drive(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
               double time) {
        const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
        tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(channel.target_node)];
        const Numbers keys = numbers(sampler.input), values = numbers(sampler.output);
        const bool cubic = sampler.interpolation == "CUBICSPLINE";
        const std::size_t width = values.size() / keys.size() / (cubic ? 3 : 1);
        const auto key = [&](std::size_t k, std::size_t part) {
            const auto from =
                values.begin() + static_cast<std::ptrdiff_t>((cubic ? 3 * k + part : k) * width);
            return Numbers(from, from + static_cast<std::ptrdiff_t>(width));
        };
        std::size_t k = 0;
        while (k + 1 < keys.size() && keys[k + 1] <= time) ++k;
        Numbers value = key(k, 1);
        const bool turns = channel.target_path == "rotation";
        if (time > keys[k] && k + 1 < keys.size() && sampler.interpolation != "STEP") {
            const double step = keys[k + 1] - keys[k], t = (time - keys[k]) / step;
            const Numbers next = key(k + 1, 1);
            if (turns && !cubic) {
                glm::dquat a(value[3], value[0], value[1], value[2]);
                glm::dquat b(next[3], next[0], next[1], next[2]);
                a = glm::normalize(a);
                b = glm::normalize(b);
                if (glm::dot(a, b) < 0.0) b = -b;
                const glm::dquat between = glm::inverse(a) * b;
                const double half =
                    std::atan2(glm::length(glm::dvec3(between.x, between.y, between.z)), between.w);
                const double sine = std::sin(half);
                const glm::dvec3 axis = sine > 1e-12
                                            ? glm::dvec3(between.x, between.y, between.z) / sine
                                            : glm::dvec3(0.0);
                const glm::dvec3 part = axis * std::sin(half * t);
                const glm::dquat q = a * glm::dquat(std::cos(half * t), part.x, part.y, part.z);
                value = {q.x, q.y, q.z, q.w};
            } else {
                const Numbers out = cubic ? key(k, 2) : value, in = cubic ? key(k + 1, 0) : next;
                for (std::size_t i = 0; i < width; ++i)
                    value[i] = !cubic ? value[i] + t * (next[i] - value[i])
                                      : value[i] * (1 + t * t * (2 * t - 3)) +
                                            step * out[i] * t * (1 - t) * (1 - t) +
                                            next[i] * t * t * (3 - 2 * t) +
                                            step * in[i] * t * t * (t - 1);
            }
        }
        (turns                                  ? node.rotation
         : channel.target_path == "scale"       ? node.scale
         : channel.target_path == "translation" ? node.translation
                                                : node.weights) = value;
    }

    glm::dmat4 local(const tinygltf::Node& node) const {
        if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
        glm::dmat4 out(1.0);
        if (!node.translation.empty())
            out = glm::translate(out, glm::make_vec3(node.translation.data()));
        if (!node.rotation.empty()) {
            const Numbers& r = node.rotation;
            out = out * glm::mat4_cast(glm::normalize(glm::dquat(r[3], r[0], r[1], r[2])));
        }
        return node.scale.empty() ? out : glm::scale(out, glm::make_vec3(node.scale.data()));
    }

    glm::dmat4 global(int index) const {
        glm::dmat4 out = local(model_.nodes[static_cast<std::size_t>(index)]);
        for (std::size_t parent = 0; parent < model_.nodes.size(); ++parent) {
            const std::vector<int>& children = model_.nodes[parent].children;
            if (std::find(children.begin(), children.end(), index) != children.end())
                return global(static_cast<int>(parent)) * out;
        }
        return out;
    }

    void show(int index, std::vector<TrueCorner>& corners) const {
        const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(index)];
        const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
        const Numbers& weights = node.weights.empty() ? mesh.weights : node.weights;
        std::vector<glm::dmat4> joints;
        if (node.skin >= 0) {
            const tinygltf::Skin& skin = model_.skins[static_cast<std::size_t>(node.skin)];
            Numbers binds;
            if (skin.inverseBindMatrices >= 0) binds = numbers(skin.inverseBindMatrices);
            for (std::size_t j = 0; j < skin.joints.size(); ++j)
                joints.push_back(global(skin.joints[j]) * (binds.empty()
                                                               ? glm::dmat4(1.0)
                                                               : glm::make_mat4(&binds[16 * j])));
        }
        const glm::dmat4 placed = global(index);
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            const auto read = [&](const std::map<std::string, int>& from, const char* name) {
                const auto found = from.find(name);
                return found == from.end() ? Numbers() : numbers(found->second);
            };
            Numbers positions = read(primitive.attributes, "POSITION");
            Numbers normals = read(primitive.attributes, "NORMAL");
            for (std::size_t t = 0; t < primitive.targets.size() && t < weights.size(); ++t) {
                const Numbers moved = read(primitive.targets[t], "POSITION");
                const Numbers turned = read(primitive.targets[t], "NORMAL");
                for (std::size_t i = 0; i < moved.size(); ++i)
                    positions[i] += weights[t] * moved[i];
                for (std::size_t i = 0; i < turned.size() && !normals.empty(); ++i)
                    normals[i] += weights[t] * turned[i];
            }
            std::vector<Numbers> sets, shares;
            for (int set = 0;; ++set) {
                const std::string number = std::to_string(set);
                Numbers found = read(primitive.attributes, ("JOINTS_" + number).c_str());
                if (found.empty() || joints.empty()) break;
                sets.push_back(std::move(found));
                shares.push_back(read(primitive.attributes, ("WEIGHTS_" + number).c_str()));
            }
            std::vector<TrueCorner> vertices(positions.size() / 3);
            for (std::size_t v = 0; v < vertices.size(); ++v) {
                glm::dmat4 matrix(0.0);
                double total = 0.0;
                for (std::size_t s = 0; s < sets.size(); ++s)
                    for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
                        matrix += shares[s][i] * joints[static_cast<std::size_t>(sets[s][i])];
                        total += shares[s][i];
                    }
                matrix = total > 0.0 ? matrix / total : placed;
                vertices[v].position =
                    glm::dvec3(matrix * glm::dvec4(glm::make_vec3(&positions[3 * v]), 1.0));
                if (!normals.empty())
                    vertices[v].normal = glm::normalize(glm::inverseTranspose(glm::dmat3(matrix)) *
                                                        glm::make_vec3(&normals[3 * v]));
            }
            Numbers indices;
            if (primitive.indices >= 0)
                indices = numbers(primitive.indices);
            else
                for (std::size_t i = 0; i < vertices.size(); ++i) indices.push_back(double(i));
            for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
                if (indices[i] == indices[i + 1] || indices[i + 1] == indices[i + 2] ||
                    indices[i + 2] == indices[i])
                    continue;
                TrueCorner corner[3];
                for (std::size_t k = 0; k < 3; ++k)
                    corner[k] = vertices[static_cast<std::size_t>(indices[i + k])];
                const glm::dvec3 flat = glm::cross(corner[1].position - corner[0].position,
                                                   corner[2].position - corner[0].position);
                for (TrueCorner& c : corner)
                    corners.push_back(
                        {c.position, normals.empty() ? glm::normalize(flat) : c.normal});
            }
        }
    }

    tinygltf::Model model_;
};

}  // namespace clgi::test
