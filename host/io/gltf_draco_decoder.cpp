// SPDX-License-Identifier: MIT
#include "io/gltf_draco_decoder.hpp"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <new>
#include <type_traits>

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

struct Bounded {
    const DracoCounts& counts;
    std::size_t most;
    UnpackBudget& budget;
    std::string refused;  // why, if the library was stopped

    // The library's functions return false for a failure.
    template <typename Work>
    bool holds(const Work& work) {
        try {
            work();
            return true;
        } catch (const InputError& error) {
            refused = error.what();
            return false;
        }
    }
};

// Of corners alone the library holds about so many bytes a triangle, and as many again for each
// set of attributes with seams of its own.
constexpr std::size_t bytes_per_triangle = 36;

// The counts are looked at where the library is about to read them.
template <typename Decoder>
class BoundedDecoder : public Decoder {
public:
    explicit BoundedDecoder(Bounded& bounded) : bounded_(bounded) {}

protected:
    bool DecodeGeometryData() override {
        return bounded_.holds([&] { check_counts(*this->buffer()); }) &&
               Decoder::DecodeGeometryData();
    }

    // All attributes are declared by now, but have no values yet.
    bool DecodeAllAttributes() override {
        return bounded_.holds([&] { check_attributes(*this->point_cloud()); }) &&
               Decoder::DecodeAllAttributes();
    }

private:
    // ahead: a copy, so the library's own reading begins where it did.
    void check_counts(draco::DecoderBuffer ahead) {
        constexpr bool sequential = std::is_same_v<Decoder, draco::MeshSequentialDecoder>;
        std::uint32_t first = 0, second = 0;
        std::uint8_t seams = 0;
        require(draco::DecodeVarint(&first, &ahead) && draco::DecodeVarint(&second, &ahead) &&
                    ahead.Decode(&seams),
                "ends before it says its size");
        const std::size_t triangles = sequential ? first : second;
        const std::size_t points = sequential ? second : first;  // else at least so many
        const DracoCounts& counts = bounded_.counts;
        require(counts.strip ? triangles <= counts.corners : counts.corners == 3 * triangles,
                "has ", triangles, " triangles, its accessor ", counts.corners, " indices");
        require(triangles <= bounded_.most, "has more triangles than are allowed");
        require(sequential ? points == counts.points : points <= counts.points, "has ", points,
                " vertices, its accessors ", counts.points);
        bounded_.budget.take_unpacked(triangles * bytes_per_triangle *
                                      (sequential ? 1 : 1 + std::size_t{seams}));
    }

    void check_attributes(const draco::PointCloud& cloud) {
        require(cloud.num_points() == bounded_.counts.points, "has ", cloud.num_points(),
                " vertices, its accessors ", bounded_.counts.points);
        std::size_t numbers = 0;  // of a vertex, with its place in the attribute
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            numbers += std::size_t{1} + cloud.attribute(i)->num_components();
        }
        bounded_.budget.take_unpacked(8 * numbers * cloud.num_points());
    }

    Bounded& bounded_;
};

template <typename Decoder>
std::unique_ptr<draco::Mesh> decode_with(Bounded& bounded, draco::DecoderBuffer& buffer) {
    auto mesh = std::make_unique<draco::Mesh>();
    bool good = false;
    try {
        const draco::DecoderOptions options;
        good = BoundedDecoder<Decoder>(bounded).Decode(options, &buffer, mesh.get()).ok();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception&) {
    }
    if (!good) fail(bounded.refused.empty() ? "is damaged" : bounded.refused);
    return mesh;
}

}  // namespace

std::unique_ptr<draco::Mesh> decode_draco(Bytes stream, const DracoCounts& counts, std::size_t most,
                                          UnpackBudget& budget) {
    budget.take_packed(stream.size());
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header;
    require(draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok(), "is no Draco stream");
    // The only version that the extension allows; older ones state their counts in other places.
    require(header.version_major == 2 && header.version_minor == 2, "is of version ",
            int{header.version_major}, ".", int{header.version_minor}, ", clgi reads 2.2");
    require(header.encoder_type == draco::TRIANGULAR_MESH, "is not a mesh of triangles");
    Bounded bounded{counts, most, budget, {}};
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
        return decode_with<draco::MeshSequentialDecoder>(bounded, buffer);
    }
    require(header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING,
            "is encoded by an unknown method");
    return decode_with<draco::MeshEdgebreakerDecoder>(bounded, buffer);
}

}  // namespace clgi::io::gltf
