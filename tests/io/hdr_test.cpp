// Radiance HDR: closed forms, both run codes, broken files, and a second opinion on real ones.
// SPDX-License-Identifier: MIT
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>  // the second opinion on HDR
#pragma GCC diagnostic pop

#include <cstdint>

#include "pictures.hpp"

namespace {

using namespace pictures;
using Hdr = ImageIo;

// A Radiance file of flat texels.
std::string hdr_file(const std::string& size, const std::string& texels,
                     const std::string& variables = "FORMAT=32-bit_rle_rgbe\n") {
    return "#?RADIANCE\n# a comment\n" + variables + "\n" + size + "\n" + texels;
}

std::string texel(int r, int g, int b, int e) {
    return {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(e)};
}

TEST_F(Hdr, TexelsHaveTheirClosedForm) {
    const auto path =
        write("a.hdr", hdr_file("-Y 1 +X 4", texel(128, 64, 255, 129) + texel(255, 255, 255, 0) +
                                                 texel(255, 0, 0, 255) + texel(1, 0, 0, 3)));
    const Image image = clgi::io::load_image(path);
    EXPECT_EQ(image.find("R")->values,
              (std::vector<float>{1.0f, 0.0f, 255.0f * 0x1p119f, 0x1p-133f}));
    EXPECT_EQ(image.find("G")->values[0], 0.5f);
    EXPECT_EQ(image.find("B")->values[0], 255.0f / 128.0f);
}

TEST_F(Hdr, PlanarRunsAreDecoded) {
    // Width 10: R a run of 10, G ten literals, B a run of 4 and six literals, E a run of 10.
    const std::string row = std::string("\x02\x02\x00\x0a", 4) + "\x8a\x40" + "\x0a" +
                            std::string("\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a", 10) +
                            "\x84\x80" + "\x06" + std::string("\x0b\x0c\x0d\x0e\x0f\x10", 6) +
                            "\x8a\x88";
    const Image image = clgi::io::load_image(write("a.hdr", hdr_file("-Y 1 +X 10", row)));
    for (std::size_t x = 0; x < 10; ++x) {
        EXPECT_EQ(image.find("R")->values[x], 64.0f);
        EXPECT_EQ(image.find("G")->values[x], static_cast<float>(x + 1));
        EXPECT_EQ(image.find("B")->values[x], x < 4 ? 128.0f : static_cast<float>(x + 7));
    }
}

TEST_F(Hdr, OldRunsAreDecoded) {
    const std::string texels = texel(9, 9, 9, 136) + texel(1, 1, 1, 2) + texel(5, 5, 5, 136) +
                               texel(1, 1, 1, 44) + texel(1, 1, 1, 1);  // 44 + 256
    const Image image = clgi::io::load_image(write("a.hdr", hdr_file("-Y 1 +X 304", texels)));
    const auto& red = image.find("R")->values;
    for (std::size_t x = 0; x < 304; ++x) ASSERT_EQ(red[x], x < 3 ? 9.0f : 5.0f) << x;
}

TEST_F(Hdr, RowsAndColumnsMayRunEitherWay) {
    const std::string texels =
        texel(1, 0, 0, 136) + texel(2, 0, 0, 136) + texel(3, 0, 0, 136) + texel(4, 0, 0, 136);
    const auto red = [&](const std::string& size) {
        return clgi::io::load_image(write("a.hdr", hdr_file(size, texels))).find("R")->values;
    };
    EXPECT_EQ(red("-Y 2 +X 2"), (std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(red("+Y 2 +X 2"), (std::vector<float>{3, 4, 1, 2}));
    EXPECT_EQ(red("-Y 2 -X 2"), (std::vector<float>{2, 1, 4, 3}));
    expect_refused(write("b.hdr", hdr_file("+X 2 -Y 2", texels)), "size line");
}

TEST_F(Hdr, ExposureIsDividedOut) {
    const auto path = write(
        "a.hdr", hdr_file("-Y 1 +X 1", texel(128, 128, 128, 129), "EXPOSURE=2\nEXPOSURE= 4.0\n"));
    EXPECT_EQ(clgi::io::load_image(path).find("G")->values[0], 0.125f);
    expect_refused(write("b.hdr", hdr_file("-Y 1 +X 1", texel(1, 1, 1, 129), "EXPOSURE=0\n")),
                   "EXPOSURE");
}

TEST_F(Hdr, WrongHeadersAreRefused) {
    const std::string one = texel(9, 9, 9, 129);
    expect_refused(write("a.hdr", hdr_file("-Y 1 +X 1", one, "FORMAT=32-bit_rle_xyze\n")),
                   "FORMAT");
    expect_refused(write("b.hdr", hdr_file("-Y 0 +X 0", one)), "0x0");
    expect_refused(write("c.hdr", hdr_file("-Y 1 +X 2147483648", one)), "2147483648");
    expect_refused(write("d.hdr", hdr_file("-Y 99999999999999999999 +X 1", one)), "size line");
    expect_refused(write("e.hdr", hdr_file("-Y -1 +X 1", one)), "-1");
    expect_refused(write("f.hdr", hdr_file("-Y 65536 +X 65536", one)), "at most");
    expect_refused(write("g.hdr", hdr_file("hello", one)), "size line");
    expect_refused(write("h.hdr", "#?RADIANCE"), "header does not end");
    expect_refused(write("i.hdr", hdr_file("-Y 60000 +X 5000", one)), "truncated");
}

TEST_F(Hdr, RunsPastTheRowAreRefused) {
    const std::string start("\x02\x02\x00\x0a", 4);
    expect_refused(write("a.hdr", hdr_file("-Y 1 +X 10", start + "\xff\x40")), "passes");
    expect_refused(write("b.hdr", hdr_file("-Y 1 +X 10", start + std::string("\x00", 1))),
                   "passes");
    expect_refused(write("c.hdr", hdr_file("-Y 1 +X 10", start + "\x0b")), "passes");
    expect_refused(write("d.hdr", hdr_file("-Y 1 +X 11", start + "\x8a\x40")), "another width");
    expect_refused(write("e.hdr", hdr_file("-Y 1 +X 2", texel(1, 1, 1, 1))), "nothing to repeat");
    expect_refused(write("f.hdr", hdr_file("-Y 1 +X 2", texel(3, 3, 3, 3) + texel(1, 1, 1, 9))),
                   "passes");
}

TEST_F(Hdr, EveryTruncationIsRefused) {
    const std::string row = std::string("\x02\x02\x00\x0a", 4) + "\x8a\x40\x8a\x40\x8a\x40\x8a\x88";
    const std::string whole = hdr_file("-Y 3 +X 10", row + row + row);
    EXPECT_NO_THROW(clgi::io::load_image(write("a.hdr", whole)));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write("a.hdr", whole.substr(0, length));
        EXPECT_THROW(clgi::io::load_image(at("a.hdr")), clgi::InputError) << length;
    }
}

TEST_F(Hdr, RealProbesAreWhatStbReads) {
    const auto files = probes(".hdr");
    if (files.empty()) GTEST_SKIP() << "there are no light probes in CLGI_SCENES_DIR/hdr";
    for (const fs::path& path : files) {
        const Image image = clgi::io::load_image(path);
        int width = 0, height = 0, channels = 0;
        float* expected = stbi_loadf(path.string().c_str(), &width, &height, &channels, 3);
        ASSERT_NE(expected, nullptr) << path;
        ASSERT_EQ(image.width, width) << path;
        ASSERT_EQ(image.height, height) << path;
        for (std::size_t c = 0; c < 3; ++c) {
            std::size_t different = 0;
            for (std::size_t i = 0; i < image.channels[c].values.size(); ++i) {
                different += image.channels[c].values[i] != expected[3 * i + c];
            }
            EXPECT_EQ(different, 0u) << path;
        }
        stbi_image_free(expected);
    }
}

}  // namespace
