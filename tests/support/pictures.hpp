// What the tests of picture files share: a folder of their own, small pictures, real probes.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "io/image_formats.hpp"

namespace pictures {

namespace fs = std::filesystem;
using clgi::io::Image;

// A folder of its own for every test, gone afterwards.
class ImageIo : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("clgi-") + info->test_suite_name() + info->name() + "-" +
                   std::to_string(std::random_device()()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path at(const std::string& name) const { return folder_ / name; }

    fs::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(at(name), std::ios::binary) << bytes;
        return at(name);
    }

    std::size_t file_count() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

inline std::string bytes_of(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline Image row_of(const std::vector<float>& values) {
    Image image;
    image.width = static_cast<int>(values.size());
    image.height = 1;
    image.channels = {{"R", values}, {"G", values}, {"B", values}};
    return image;
}

inline void expect_refused(const fs::path& path, const std::string& because) {
    try {
        clgi::io::load_image(path);
        ADD_FAILURE() << path.filename() << " was read";
    } catch (const clgi::InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find(path.filename().string()), std::string::npos) << text;
        EXPECT_NE(text.find(because), std::string::npos) << text;
    }
}

// The real light probes with that extension; none where they are not at hand.
inline std::vector<fs::path> probes(const std::string& extension) {
    std::vector<fs::path> found;
#ifdef CLGI_SCENES_DIR
    const fs::path folder = fs::path(CLGI_SCENES_DIR) / "hdr";
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        if (entry.path().extension() == extension) found.push_back(entry.path());
    }
#else
    (void)extension;
#endif
    return found;
}

}  // namespace pictures
