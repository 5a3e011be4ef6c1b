// SPDX-License-Identifier: MIT
#include "io/gltf_codecs.hpp"

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

// As deflate at its best. Real meshes unpack to ten or twenty times their size.
constexpr std::size_t most_per_packed_byte = 1024;

}  // namespace

void UnpackBudget::take_packed(std::size_t bytes) {
    require(bytes <= packed_left_, "is longer, with the compressed parts before it, than the file");
    packed_left_ -= bytes;
    unpacked_left_ += most_per_packed_byte * bytes;
}

void UnpackBudget::take_unpacked(std::size_t bytes) {
    require(bytes <= unpacked_left_, "unpacks to more than ", most_per_packed_byte,
            " times its size");
    unpacked_left_ -= bytes;
}

}  // namespace clgi::io::gltf
