// What the tables of clgi bench share.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/progress.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program/session.hpp"

namespace clgi::program {

struct BenchFlags {
    DeviceFlags device;
    std::string table;
    std::string mesh;
    std::vector<std::string> scenes;
    std::vector<std::string> only;
    std::uint32_t most_vpls = 1600;
    int repeats = 30;
    int vertices = 1000;
    int samples = 0;
    bool json = false;
};

// Runs a measurement that takes Progress and reports how far it is; Ctrl-C ends it.
template <typename Measure>
auto measured(const BenchFlags& flags, Measure&& measure) {
    catch_interrupts();
    const auto bar = progress_bar(flags.table, flags.device.quiet);
    auto out = measure([&](double done) {
        if (!bar(done)) throw Interrupted();
        return true;
    });
    bar(1.0);
    return out;
}

// The beginning of what --json prints.
inline nlohmann::ordered_json table_json(const BenchFlags& flags, const std::string& device) {
    return {{"table", flags.table}, {"device", device}, {"rows", nlohmann::ordered_json::array()}};
}

// kautz1 and kautz2. Throws Error in a program built without clgi::mesh.
void run_kautz(const BenchFlags& flags, const Session& session);

// dachsbacher1 and dachsbacher2.
void run_dachsbacher(const BenchFlags& flags, const Session& session);

}  // namespace clgi::program
