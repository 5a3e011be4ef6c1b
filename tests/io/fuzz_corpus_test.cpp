// Every input that fuzzing kept, through the functions that it is found with (docs/stability.md).
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/options_input.hpp"
#include "fuzz/scene_input.hpp"

namespace clgi {
namespace {

struct Counted {
    int taken = 0, refused = 0;
};

// take: whether the bytes of a file are taken.
template <typename Take>
Counted replay(const char* corpus, const Take& take) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path folder =
        std::filesystem::path(CLGI_SOURCE) / "tests/fuzz/corpus" / corpus;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    Counted out;
    for (const std::filesystem::path& file : files) {
        std::ifstream stream(file, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
        bool taken = false;
        EXPECT_NO_THROW(taken =
                            take(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()))
            << file;
        ++(taken ? out.taken : out.refused);
    }
    return out;
}

TEST(FuzzCorpus, ScenesLoadOrAreRefusedInOneLine) {
    const Counted found = replay("scene", fuzz::try_scene);
    EXPECT_GE(found.taken, 12);  // the files that fuzzing began with
    EXPECT_GT(found.refused, 0);
}

TEST(FuzzCorpus, SolversGiveFiniteLightOrRefuseInOneLine) {
    std::array<int, fuzz::solver_count> taken{};
    const Counted found = replay("options", [&](const std::uint8_t* data, std::size_t size) {
        const bool out = fuzz::try_options(data, size);
        if (out) ++taken[fuzz::solver_of(data, size)];
        return out;
    });
    for (std::size_t solver = 0; solver < taken.size(); ++solver)
        EXPECT_GT(taken[solver], 0) << "of solver " << solver;
    EXPECT_GT(found.refused, 0);
}

}  // namespace
}  // namespace clgi
