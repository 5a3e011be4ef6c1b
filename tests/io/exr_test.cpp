// OpenEXR: round trips, hard values, and files that are not what they say.
// SPDX-License-Identifier: MIT
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfPreviewImage.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "pictures.hpp"

namespace {

using namespace pictures;
using clgi::io::PixelType;
using Exr = ImageIo;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
constexpr float largest = std::numeric_limits<float>::max();

// Overwrites the data window of an uncompressed header: four little-endian ints.
void set_data_window(const fs::path& path, std::array<std::int32_t, 4> window) {
    std::string bytes = bytes_of(path);
    const std::string mark("dataWindow\0box2i\0", 17);
    const std::size_t found = bytes.find(mark);
    ASSERT_NE(found, std::string::npos);
    std::memcpy(bytes.data() + found + mark.size() + 4, window.data(), 16);
    std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(Exr, FullStorageKeepsEveryBit) {
    const std::vector<float> values = {0.0f,   -0.0f,    1.0f,    -1.0f,    1e20f, 65504.0f,
                                       1e-40f, 1.4e-45f, largest, -largest, 0.1f,  3.0e-8f};
    clgi::io::save_exr(row_of(values), at("a.exr"), PixelType::full);
    clgi::io::LoadReport report;
    const Image image = clgi::io::load_image(at("a.exr"), &report);
    EXPECT_EQ(report.non_finite, 0u);
    for (const char* name : {"R", "G", "B"}) {
        const auto* channel = image.find(name);
        ASSERT_NE(channel, nullptr);
        for (std::size_t i = 0; i < values.size(); ++i) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(channel->values[i]),
                      std::bit_cast<std::uint32_t>(values[i]));
        }
    }
}

TEST_F(Exr, HalfStorageSaturatesInsteadOfBecomingInfinite) {
    const std::vector<float> values = {65504.0f, 65519.0f, 65520.0f, 1e20f, inf, largest};
    clgi::io::save_exr(row_of(values), at("a.exr"), PixelType::half);
    const Image image = clgi::io::read_image(at("a.exr"));
    for (const float v : image.find("R")->values) EXPECT_EQ(v, 65504.0f);
    clgi::io::save_exr(row_of({-65520.0f, -inf}), at("b.exr"), PixelType::half);
    EXPECT_EQ(clgi::io::read_image(at("b.exr")).find("R")->values,
              (std::vector<float>{-65504.0f, -65504.0f}));
}

TEST_F(Exr, HalfStorageRoundsToNearest) {
    clgi::io::save_exr(row_of({1.0f, 0.1f, -1.0f, 2.9e-8f, 6.0e-8f, 2049.0f}), at("a.exr"),
                       PixelType::half);
    const auto values = clgi::io::load_image(at("a.exr")).find("G")->values;
    EXPECT_EQ(values[0], 1.0f);
    EXPECT_NEAR(values[1], 0.1f, 0.1f * 0x1p-11f);
    EXPECT_EQ(values[2], -1.0f);
    EXPECT_EQ(values[3], 0.0f);
    EXPECT_EQ(values[4], 0x1p-24f);  // the smallest half
    EXPECT_EQ(values[5], 2048.0f);
}

TEST_F(Exr, NonFiniteSamplesAreReplacedAndCounted) {
    clgi::io::save_exr(row_of({nan_value, inf, -inf, 1.0f}), at("a.exr"), PixelType::full);
    clgi::io::LoadReport report;
    const Image image = clgi::io::load_image(at("a.exr"), &report);
    EXPECT_EQ(report.non_finite, 9u);
    EXPECT_EQ(image.find("R")->values, (std::vector<float>{0.0f, largest, -largest, 1.0f}));
    EXPECT_TRUE(std::isnan(clgi::io::read_image(at("a.exr")).find("R")->values[0]));
}

TEST_F(Exr, AttributesAndChannelNamesComeBack) {
    Image image = row_of({1.0f, 2.0f});
    image.channels.push_back({"normal.X", {0.5f, -0.5f}});
    image.attributes = {{"clgi:quantity", "radiance"},
                        {"clgi:unit", "cd/m^2"},
                        {"an attribute with a name longer than thirty-one letters", ""}};
    clgi::io::save_exr(image, at("a.exr"), PixelType::full);
    const Image back = clgi::io::load_image(at("a.exr"));
    EXPECT_EQ(back.attributes, image.attributes);
    ASSERT_NE(back.find("normal.X"), nullptr);
    EXPECT_EQ(back.find("normal.X")->values, image.channels[3].values);
    EXPECT_EQ(back.find("normal.Y"), nullptr);
}

TEST_F(Exr, AttributeNamedAsAPartTypeDoesNotSpoilTheFile) {
    Image image = row_of({1.0f});
    image.attributes = {{"type", "deepscanline"}, {"name", "x"}};
    clgi::io::save_exr(image, at("a.exr"), PixelType::full);
    EXPECT_EQ(clgi::io::load_image(at("a.exr")).width, 1);
}

TEST_F(Exr, OnePixelComesBack) {
    clgi::io::save_exr(row_of({0.25f}), at("a.exr"), PixelType::half);
    const Image image = clgi::io::load_image(at("a.exr"));
    EXPECT_EQ(image.width, 1);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.find("B")->values, std::vector<float>{0.25f});
}

TEST_F(Exr, RowsStayInTheirOrder) {
    Image image;
    image.width = 3;
    image.height = 40;  // more than one block of ZIP
    std::vector<float> values;
    for (int i = 0; i < 120; ++i) values.push_back(static_cast<float>(i));
    image.channels = {{"Y", values}};
    clgi::io::save_exr(image, at("a.exr"), PixelType::full);
    EXPECT_EQ(clgi::io::load_image(at("a.exr")).find("Y")->values, values);
}

TEST_F(Exr, BrokenImagesAreNotSaved) {
    Image image = row_of({1.0f, 2.0f});
    image.channels[1].values.pop_back();
    EXPECT_THROW(clgi::io::save_exr(image, at("a.exr"), PixelType::full), clgi::Error);
    EXPECT_THROW(clgi::io::save_exr(Image{}, at("a.exr"), PixelType::full), clgi::Error);
    image = row_of({1.0f});
    image.channels[1].name = "R";
    EXPECT_THROW(clgi::io::save_exr(image, at("a.exr"), PixelType::full), clgi::Error);
    image = row_of({1.0f});
    image.attributes = {{"compression", "not a string attribute"}};
    EXPECT_THROW(clgi::io::save_exr(image, at("a.exr"), PixelType::full), clgi::Error);
    image.attributes = {{std::string(256, 'a'), "too long a name"}};
    EXPECT_THROW(clgi::io::save_exr(image, at("a.exr"), PixelType::full), clgi::Error);
    image = row_of({1.0f});
    image.channels[1].name = std::string(256, 'a');
    EXPECT_THROW(clgi::io::save_exr(image, at("a.exr"), PixelType::full), clgi::Error);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(Exr, ZeroByZeroIsRefused) {
    clgi::io::save_exr(row_of({1.0f}), at("a.exr"), PixelType::full);
    set_data_window(at("a.exr"), {0, 0, -1, -1});
    expect_refused(at("a.exr"), "");
}

TEST_F(Exr, HugeDimensionsAreRefusedBeforeAllocating) {
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
    const std::vector<std::array<std::int32_t, 4>> windows = {
        {0, 0, most, 0},    {0, 0, 0, most},          {least, least, most, most},
        {0, 0, most, most}, {0, 0, 65536, 0},         {0, 0, 65535, 65535},
        {0, 0, 1 << 29, 0}, {0, 0, 1 << 29, 1 << 29}, {0, 0, 20000, 20000},
        {least, 0, -1, 0},  {most - 1, 0, most, 1},   {0, 0, 0, 1 << 29}};
    for (const auto& window : windows) {
        clgi::io::save_exr(row_of({1.0f, 2.0f}), at("a.exr"), PixelType::full);
        set_data_window(at("a.exr"), window);
        EXPECT_THROW(clgi::io::load_image(at("a.exr")), clgi::InputError)
            << window[0] << " " << window[1] << " " << window[2] << " " << window[3];
    }
}

// Sizes inside a header, as 32-bit numbers at some distance behind a mark.
TEST_F(Exr, HeaderThatClaimsMoreThanTheFileIsRefused) {
    Imf::Header header(4, 4);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(16, 16));
    header.insert("words", Imf::StringVectorAttribute({"one", "two"}));
    header.setPreviewImage(Imf::PreviewImage(2, 2));
    const std::vector<std::uint16_t> values(16, 0);
    {
        Imf::TiledOutputFile file(at("whole.exr").string().c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::HALF, values.data(), header.dataWindow()));
        file.setFrameBuffer(frame);
        file.writeTile(0, 0);
    }
    EXPECT_NO_THROW(clgi::io::load_image(at("whole.exr")));
    const std::string whole = bytes_of(at("whole.exr"));
    const auto refuse = [&](const std::string& mark, std::size_t behind, const char* because) {
        const std::size_t found = whole.find(mark);
        ASSERT_NE(found, std::string::npos) << mark;
        std::string bytes = whole;
        bytes.replace(found + mark.size() + behind, 4, "\x00\x00\x00\x70", 4);
        expect_refused(write("a.exr", bytes), because);
    };
    refuse(std::string("channels\0chlist\0", 16), 0, "another size");
    refuse(std::string("words\0stringvector\0", 19), 0, "");
    refuse(std::string("words\0stringvector\0", 19), 4, "claims more bytes");
    refuse(std::string("preview\0preview\0", 16), 4, "preview");
    refuse(std::string("preview\0preview\0", 16), 8, "preview");
    refuse(std::string("tiles\0tiledesc\0", 15), 4, "tiles");
    refuse(std::string("tiles\0tiledesc\0", 15), 8, "tiles");
}

TEST_F(Exr, EveryTruncationIsRefused) {
    Image image = row_of(std::vector<float>(50, 0.0f));
    for (std::size_t i = 0; i < 50; ++i) image.channels[0].values[i] = 1.0f / (1.0f + i);
    clgi::io::save_exr(image, at("whole.exr"), PixelType::full);
    const std::string whole = bytes_of(at("whole.exr"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        write("a.exr", whole.substr(0, length));
        EXPECT_THROW(clgi::io::load_image(at("a.exr")), clgi::InputError) << length;
    }
}

// Any byte may be wrong: the picture is read or refused, nothing else.
TEST_F(Exr, EveryWrongByteIsReadOrRefused) {
    clgi::io::save_exr(row_of({1.0f, 0.5f, 0.25f, 0.125f}), at("whole.exr"), PixelType::half);
    const std::string whole = bytes_of(at("whole.exr"));
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const char value : {'\x00', '\x7f', '\xff', static_cast<char>(whole[i] ^ 1)}) {
            std::string bytes = whole;
            bytes[i] = value;
            write("a.exr", bytes);
            try {
                clgi::io::load_image(at("a.exr"));
            } catch (const clgi::InputError&) {
            }
        }
    }
}

TEST_F(Exr, IntegerChannelsAreConverted) {
    Imf::Header header(3, 1);
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    const std::uint32_t values[3] = {0, 7, 4294967295u};
    {
        Imf::OutputFile file(at("a.exr").string().c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("id", Imf::Slice::Make(Imf::UINT, values, header.dataWindow()));
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    EXPECT_EQ(clgi::io::load_image(at("a.exr")).find("id")->values,
              (std::vector<float>{0.0f, 7.0f, 4294967296.0f}));
}

TEST_F(Exr, SubsampledChannelsAreRefusedByName) {
    Imf::Header header(4, 4);
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    const std::vector<std::uint16_t> values(4, 0);
    {
        Imf::OutputFile file(at("a.exr").string().c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("RY",
                     Imf::Slice::Make(Imf::HALF, values.data(), header.dataWindow(), 2, 4, 2, 2));
        file.setFrameBuffer(frame);
        file.writePixels(4);
    }
    expect_refused(at("a.exr"), "RY is subsampled");
}

TEST_F(Exr, DataWindowOffTheOriginIsReadWhole) {
    for (const Imath::V2i& origin : {Imath::V2i(-7, -3), Imath::V2i(1000, 2000)}) {
        const Imath::Box2i window(origin, origin + Imath::V2i(1, 1));
        Imf::Header header(Imath::Box2i(Imath::V2i(0), Imath::V2i(9)), window);
        header.channels().insert("R", Imf::Channel(Imf::FLOAT));
        const float values[4] = {1.0f, 2.0f, 3.0f, 4.0f};
        {
            Imf::OutputFile file(at("a.exr").string().c_str(), header);
            Imf::FrameBuffer frame;
            frame.insert("R", Imf::Slice::Make(Imf::FLOAT, values, window));
            file.setFrameBuffer(frame);
            file.writePixels(2);
        }
        const Image image = clgi::io::load_image(at("a.exr"));
        EXPECT_EQ(image.width, 2);
        EXPECT_EQ(image.find("R")->values, (std::vector<float>{1.0f, 2.0f, 3.0f, 4.0f}));
    }
}

TEST_F(Exr, TiledFilesAreRead) {
    std::vector<float> values;
    for (int i = 0; i < 19 * 13; ++i) values.push_back(static_cast<float>(i));
    Imf::Header header(19, 13);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
    {
        Imf::TiledOutputFile file(at("a.exr").string().c_str(), header);
        for (int level = 0; level < file.numLevels(); ++level) {
            const Imath::Box2i window = file.dataWindowForLevel(level);
            Imf::FrameBuffer frame;
            frame.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
            file.setFrameBuffer(frame);
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    EXPECT_EQ(clgi::io::load_image(at("a.exr")).find("R")->values, values);
}

TEST_F(Exr, OfSeveralPartsTheFirstIsRead) {
    std::vector<Imf::Header> headers(2, Imf::Header(2, 1));
    const float values[2][2] = {{1.0f, 2.0f}, {8.0f, 9.0f}};
    for (std::size_t part = 0; part < 2; ++part) {
        headers[part].setName("part " + std::to_string(part));
        headers[part].setType(Imf::SCANLINEIMAGE);
        headers[part].channels().insert("R", Imf::Channel(Imf::FLOAT));
    }
    {
        Imf::MultiPartOutputFile file(at("a.exr").string().c_str(), headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            Imf::OutputPart output(file, part);
            Imf::FrameBuffer frame;
            frame.insert("R", Imf::Slice::Make(Imf::FLOAT, values[part], headers[0].dataWindow()));
            output.setFrameBuffer(frame);
            output.writePixels(1);
        }
    }
    EXPECT_EQ(clgi::io::load_image(at("a.exr")).find("R")->values,
              (std::vector<float>{1.0f, 2.0f}));
}

TEST_F(Exr, DeepFilesAreRefusedClearly) {
    Imf::Header header(1, 1);
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    {
        Imf::DeepScanLineOutputFile file(at("a.exr").string().c_str(), header);
        float sample = 1.0f;
        float* samples[1] = {&sample};
        unsigned count[1] = {1};
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(count),
                                                sizeof(unsigned), sizeof(unsigned)));
        frame.insert("R", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples),
                                         sizeof(float*), sizeof(float*), sizeof(float)));
        file.setFrameBuffer(frame);
        file.writePixels(1);
    }
    expect_refused(at("a.exr"), "deep");
}

TEST_F(Exr, RealProbeSurvivesARoundTrip) {
    const auto files = probes(".exr");
    if (files.empty()) GTEST_SKIP() << "there are no light probes in CLGI_SCENES_DIR/hdr";
    for (const fs::path& path : files) {
        clgi::io::LoadReport report;
        const Image image = clgi::io::load_image(path, &report);
        EXPECT_EQ(report.non_finite, 0u);
        clgi::io::save_exr(image, at("a.exr"), PixelType::full);
        const Image back = clgi::io::load_image(at("a.exr"));
        ASSERT_EQ(back.channels.size(), image.channels.size());
        for (std::size_t c = 0; c < image.channels.size(); ++c) {
            EXPECT_EQ(back.channels[c].name, image.channels[c].name);
            EXPECT_EQ(back.channels[c].values, image.channels[c].values);
        }
    }
}

}  // namespace
