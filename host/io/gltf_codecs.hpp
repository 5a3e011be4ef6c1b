// The codecs of extensions, each an option of the build, and what a file may unpack with them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace clgi::io::gltf {

struct Codec {
    const char* extension;
    const char* option;  // of the build
    bool built;
};
constexpr Codec meshopt_codec = {"EXT_meshopt_compression", "CLGI_MESHOPT", CLGI_HAS_MESHOPT != 0};
constexpr Codec draco_codec = {"KHR_draco_mesh_compression", "CLGI_DRACO", CLGI_HAS_DRACO != 0};
constexpr Codec webp_codec = {"EXT_texture_webp", "CLGI_WEBP", CLGI_HAS_WEBP != 0};
constexpr Codec codecs[] = {meshopt_codec, draco_codec, webp_codec};

// Null where it is no extension with a codec.
inline const Codec* find_codec(const std::string& extension) {
    for (const Codec& codec : codecs) {
        if (extension == codec.extension) return &codec;
    }
    return nullptr;
}

// "EXT_meshopt_compression, which this build of clgi does not read: CLGI_MESHOPT is OFF"
inline std::string missing(const Codec& codec) {
    return std::string(codec.extension) +
           ", which this build of clgi does not read: " + codec.option + " is OFF";
}

// Bounds what is unpacked of one file. Entropy codes may spend no bit on a symbol, so a few bytes
// could stand for gigabytes; and many parts of a file may name the same bytes.
class UnpackBudget {
public:
    // held: bytes of the file and of those that it names.
    explicit UnpackBudget(std::size_t held = 0) : packed_left_(held) {}

    // Throws InputError if the parts unpacked so far are together longer than what there is.
    void take_packed(std::size_t bytes);

    // Throws InputError beyond 64 MiB and a thousand times what was packed.
    void take_unpacked(std::size_t bytes);

private:
    std::size_t packed_left_;
    std::size_t unpacked_left_ = std::size_t{1} << 26;
};

}  // namespace clgi::io::gltf
