// unpack_meshes: KHR_draco_mesh_compression. Unpacked data become buffers, views and accessors like
// all others, so they are checked and read like all others.
// SPDX-License-Identifier: MIT
#include <cstring>
#include <tuple>

#include "io/gltf_accessor.hpp"
#include "io/gltf_draco_decoder.hpp"

namespace clgi::io::gltf {

namespace {

template <typename T>
void copy_values(const draco::PointAttribute& from, std::size_t points, std::uint8_t* to) {
    T value[4];
    const auto channels = from.num_components();
    for (std::uint32_t point = 0; point < points; ++point) {
        const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(point));
        require(index.value() < from.size() &&
                    from.ConvertValue<T>(index, static_cast<std::int8_t>(channels), value),
                "has a value that the accessor's componentType cannot hold");
        std::memcpy(to, value, channels * sizeof(T));
        to += channels * sizeof(T);
    }
}

void copy_values(const draco::PointAttribute& from, int component, std::size_t points,
                 std::uint8_t* to) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return copy_values<std::int8_t>(from, points, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return copy_values<std::uint8_t>(from, points, to);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return copy_values<std::int16_t>(from, points, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return copy_values<std::uint16_t>(from, points, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return copy_values<std::uint32_t>(from, points, to);
        default:
            return copy_values<float>(from, points, to);
    }
}

class MeshUnpacker {
public:
    MeshUnpacker(Document& document, std::size_t most)
        : document_(document), accessors_(document.model.accessors), triangles_left_(most) {}

    void unpack(Primitive& primitive) {
        const tinygltf::Value* packed = extension(primitive.extensions, draco_codec.extension);
        if (!packed) return;
        within([] { return std::string(".extensions.") + draco_codec.extension; },
               [&] { unpack(*packed, primitive); });
        primitive.extensions.erase(draco_codec.extension);
    }

private:
    void unpack(const tinygltf::Value& packed, Primitive& primitive) {
        require(primitive.mode == TINYGLTF_MODE_TRIANGLES ||
                    primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
                "is for triangles, not for mode ", primitive.mode);
        primitive.indices = index_in(packed, "indices");
        require(primitive.indices >= 0, "needs an accessor of indices");
        require(accessors_[primitive.indices].type == TINYGLTF_TYPE_SCALAR,
                "has indices that are not scalars");
        const tinygltf::Value& ids = packed.Get("attributes");
        const std::vector<std::string> names = ids.Keys();
        require(!names.empty(), ".attributes is empty");
        for (const std::string& name : names) {
            require(primitive.attributes.contains(name), "has ", printable(name),
                    ", the primitive has not");
        }
        const int view = index_in(packed, "bufferView");
        const DracoCounts counts = {accessors_[primitive.attributes[names[0]]].count,
                                    accessors_[primitive.indices].count,
                                    primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP};
        const draco::Mesh& mesh = mesh_of(view, counts);
        for (const std::string& name : names) {
            within([&] { return ".attributes." + printable(name); },
                   [&] {
                       int& accessor = primitive.attributes[name];
                       accessor =
                           unpacked_attribute(view, mesh, index_in(ids, name.c_str()), accessor);
                   });
        }
        primitive.indices = unpacked_indices(view, mesh, counts, primitive.indices);
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
    }

    // Primitives may share a mesh; it is decoded once.
    const draco::Mesh& mesh_of(int view, const DracoCounts& counts) {
        std::unique_ptr<draco::Mesh>& mesh = meshes_[view];
        if (mesh) return *mesh;
        const tinygltf::BufferView& range = document_.model.bufferViews[view];
        const Bytes buffer = document_.buffers[range.buffer];
        require(!buffer.empty(), "is in a buffer without data");
        mesh = decode_draco(buffer.subspan(range.byteOffset, range.byteLength), counts,
                            triangles_left_, document_.unpacking);
        triangles_left_ -= mesh->num_faces();
        return *mesh;
    }

    int unpacked_attribute(int view, const draco::Mesh& mesh, int id, int accessor) {
        const auto [known, fresh] = unpacked_.try_emplace({view, id, accessor}, 0);
        if (!fresh) return known->second;
        const draco::PointAttribute* from =
            mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        require(from != nullptr, " is ", id, ", which the compressed mesh has not");
        Accessor to = accessors_[accessor];
        require(to.count == mesh.num_points(), "has ", to.count,
                " elements, the compressed mesh has ", mesh.num_points(), " vertices");
        require(columns(to) == 1 && rows(to) == from->num_components(), "has ", rows(to),
                " components, the compressed mesh has ", int{from->num_components()});
        const int component = tinygltf::GetComponentSizeInBytes(to.componentType);
        const std::size_t length = to.count * rows(to) * static_cast<std::size_t>(component);
        document_.unpacking.take_unpacked(length);
        std::vector<std::uint8_t> bytes(length);
        copy_values(*from, to.componentType, to.count, bytes.data());
        return known->second = add(std::move(to), std::move(bytes));
    }

    int unpacked_indices(int view, const draco::Mesh& mesh, const DracoCounts& counts,
                         int accessor) {
        const std::size_t corners = std::size_t{3} * mesh.num_faces();
        require(counts.strip || counts.corners == corners, "has ", mesh.num_faces(),
                " triangles, its accessor ", counts.corners, " indices");
        const auto [known, fresh] = unpacked_.try_emplace({view, -1, accessor}, 0);
        if (!fresh) return known->second;
        Accessor to = accessors_[accessor];
        to.count = corners;
        to.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        to.normalized = false;
        document_.unpacking.take_unpacked(corners * sizeof(std::uint32_t));
        std::vector<std::uint8_t> bytes(corners * sizeof(std::uint32_t));
        for (std::uint32_t i = 0; i < corners; ++i) {
            const std::uint32_t point =
                mesh.face(draco::FaceIndex(i / 3))[static_cast<int>(i % 3)].value();
            std::memcpy(bytes.data() + i * sizeof(point), &point, sizeof(point));
        }
        return known->second = add(std::move(to), std::move(bytes));
    }

    // Other primitives may go on with the accessor that this one replaces.
    int add(Accessor accessor, std::vector<std::uint8_t> bytes) {
        tinygltf::BufferView view;
        view.buffer = static_cast<int>(document_.buffers.size());
        view.byteLength = bytes.size();
        accessor.bufferView = static_cast<int>(document_.model.bufferViews.size());
        accessor.byteOffset = 0;
        accessor.sparse.isSparse = false;
        document_.buffers.push_back(document_.files.emplace_back(std::move(bytes)));
        document_.model.bufferViews.push_back(view);
        accessors_.push_back(std::move(accessor));
        return static_cast<int>(accessors_.size()) - 1;
    }

    Document& document_;
    std::vector<Accessor>& accessors_;
    std::size_t triangles_left_;
    std::map<int, std::unique_ptr<draco::Mesh>> meshes_;  // by view
    std::map<std::tuple<int, int, int>, int> unpacked_;   // accessors, by view, id and accessor
};

}  // namespace

void unpack_meshes(Document& document, std::size_t most) {
    MeshUnpacker unpacker(document, most);
    each("meshes", document.model.meshes, [&](Mesh& mesh) {
        each(".primitives", mesh.primitives, [&](Primitive& p) { unpacker.unpack(p); });
    });
}

}  // namespace clgi::io::gltf
