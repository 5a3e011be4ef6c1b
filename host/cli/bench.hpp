// What the tables of clgi bench share.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace clgi::cli {

struct BenchFlags {
    DeviceFlags device;
    std::string table;
    std::string mesh;
    std::vector<std::string> scenes;
    std::vector<std::string> only;
    std::uint32_t most_vpls = 1600;
    int repeats = 30;
    int vertices = 1000;
    bool json = false;
};

// kautz1 and kautz2. Throws Error in a program built without clgi::mesh.
void run_kautz(const BenchFlags& flags, const Session& session);

}  // namespace clgi::cli
