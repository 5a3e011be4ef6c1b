// What every picture file goes through: the choice of a reader, whole files or none, PNG.
// SPDX-License-Identifier: MIT
#include "io/atomic_file.hpp"
#include "pictures.hpp"

namespace {

using namespace pictures;
using clgi::io::PixelType;
using Png = ImageIo;
using LoadImage = ImageIo;
using AtomicFile = ImageIo;

TEST_F(Png, BytesBeginWithTheSignature) {
    clgi::io::save_png(2, 1, {255, 0, 0, 255, 0, 255, 0, 255}, at("a.png"));
    EXPECT_EQ(bytes_of(at("a.png")).substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(Png, IsReadBackAsItsBytes) {
    clgi::io::save_png(2, 1, {0, 51, 255, 255, 1, 2, 3, 0}, at("a.png"));
    const Image image = clgi::io::read_image_or_png(at("a.png"));
    ASSERT_EQ(image.width, 2);
    ASSERT_EQ(image.height, 1);
    const std::vector<float> red = {0.0f, 1.0f / 255.0f}, alpha = {1.0f, 0.0f};
    EXPECT_EQ(image.find("R")->values, red);
    EXPECT_EQ(image.find("G")->values[0], 0.2f);
    EXPECT_EQ(image.find("A")->values, alpha);
    write("b.png", bytes_of(at("a.png")).substr(0, 50));
    EXPECT_THROW(clgi::io::read_image_or_png(at("b.png")), clgi::InputError);
}

TEST_F(Png, WrongSizesAreRefused) {
    EXPECT_THROW(clgi::io::save_png(2, 2, std::vector<std::uint8_t>(15), at("a.png")), clgi::Error);
    EXPECT_THROW(clgi::io::save_png(0, 0, {}, at("a.png")), clgi::Error);
    EXPECT_THROW(clgi::io::save_png(-1, -1, std::vector<std::uint8_t>(4), at("a.png")),
                 clgi::Error);
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(LoadImage, SaysWhatIsWrongWithThePath) {
    expect_refused(at("missing.exr"), "no such file");
    expect_refused(folder_, "directory");
    expect_refused(write("empty.exr", ""), "empty");
    expect_refused(write("text.exr", "just a few words"), "neither");
    clgi::io::save_png(1, 1, {1, 2, 3, 4}, at("a.png"));
    expect_refused(at("a.png"), "PNG");
}

TEST_F(LoadImage, GoesByContentAndNotByName) {
    clgi::io::save_exr(row_of({0.5f}), at("a.hdr"), PixelType::full);
    EXPECT_EQ(clgi::io::load_image(at("a.hdr")).find("R")->values[0], 0.5f);
}

TEST_F(AtomicFile, WithoutCommitTheOldFileStaysAndNothingElse) {
    write("a.txt", "old");
    {
        clgi::io::AtomicFile file(at("a.txt"));
        file.write("new", 3);
        EXPECT_EQ(file_count(), 2u);
    }
    EXPECT_EQ(bytes_of(at("a.txt")), "old");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, CommitReplacesTheOldFile) {
    write("a.txt", "old");
    clgi::io::AtomicFile file(at("a.txt"));
    file.write("NEW", 3);
    file.seek(1);
    file.write("e", 1);
    EXPECT_EQ(file.tell(), 2u);
    EXPECT_EQ(bytes_of(at("a.txt")), "old");
    file.commit();
    EXPECT_EQ(bytes_of(at("a.txt")), "NeW");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, FollowsASymbolicLink) {
    write("real.txt", "old");
    fs::create_symlink(at("real.txt"), at("link.txt"));
    clgi::io::AtomicFile file(at("link.txt"));
    file.write("new", 3);
    file.commit();
    EXPECT_TRUE(fs::is_symlink(at("link.txt")));
    EXPECT_EQ(bytes_of(at("real.txt")), "new");
}

TEST_F(AtomicFile, RefusesWhatIsNoFile) {
    EXPECT_THROW(clgi::io::AtomicFile file(folder_), clgi::InputError);
    EXPECT_THROW(clgi::io::AtomicFile file(at("no/such/folder/a.txt")), clgi::InputError);
    EXPECT_THROW(clgi::io::AtomicFile file(""), clgi::InputError);
    EXPECT_THROW(clgi::io::AtomicFile file("/dev/null"), clgi::InputError);
    EXPECT_EQ(file_count(), 0u);
}

}  // namespace
