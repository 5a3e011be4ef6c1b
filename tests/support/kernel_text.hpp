// Kernel source for small test kernels: their includes put in place, as the build does for passes.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace clgi::test {

// path: relative to the repository. An include is looked for in include/, kernels/ and tests/.
inline std::string kernel_text(const std::string& path, std::set<std::string> seen = {}) {
    const std::filesystem::path root = CLGI_SOURCE;
    std::ifstream file(root / path);
    if (!file) throw Error("kernel_text: " + path + " cannot be read");
    const std::string keyword = "#include \"";
    std::string line;
    std::ostringstream text;
    while (std::getline(file, line)) {
        if (line.compare(0, keyword.size(), keyword) != 0) {
            text << line << '\n';
            continue;
        }
        const std::string name = line.substr(keyword.size(), line.rfind('"') - keyword.size());
        if (!seen.insert(name).second) continue;
        for (const char* folder : {"include/", "kernels/", "tests/"})
            if (std::filesystem::exists(root / (folder + name))) {
                // Include guards sort out what a neighbour has brought already.
                text << kernel_text(folder + name, seen);
                break;
            }
    }
    return text.str();
}

}  // namespace clgi::test
