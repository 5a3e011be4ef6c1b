// libFuzzer: bytes of a glTF file.
// SPDX-License-Identifier: MIT
#include "fuzz/scene_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    clgi::fuzz::try_scene(data, size);
    return 0;
}
