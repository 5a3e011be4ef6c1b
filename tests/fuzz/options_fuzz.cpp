// libFuzzer: a scene and options of a solver, chosen by bytes.
// SPDX-License-Identifier: MIT
#include "fuzz/options_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    clgi::fuzz::try_options(data, size);
    return 0;
}
