// Walks the headers of an OpenEXR file: magic number and version, then for every part a list of
// attributes (name, type, size, value) that an empty name ends. Several parts end with an empty
// list. All numbers are little-endian.
// SPDX-License-Identifier: MIT
#include "io/exr_header.hpp"

#include <clgi/error.hpp>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>

namespace clgi::io {
namespace {

namespace fs = std::filesystem;

class Walker {
public:
    explicit Walker(const fs::path& path)
        : path_(path), stream_(path, std::ios::binary), size_(fs::file_size(path)) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(path_.string() + ": " + what);
    }

    std::uint8_t byte() {
        if (position_ == size_) fail("is truncated");
        ++position_;
        return static_cast<std::uint8_t>(stream_.get());
    }

    std::uint32_t number() {
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t{byte()} << shift;
        return value;
    }

    std::string name() {
        constexpr std::size_t longest = 255;
        std::string text;
        for (std::uint8_t c = byte(); c != 0; c = byte()) {
            text.push_back(static_cast<char>(c));
            if (text.size() > longest) fail("has a name in its header that does not end");
        }
        return text;
    }

    void skip(std::uint64_t count) {
        if (count > size_ - position_) fail("has a header that claims more bytes than the file");
        position_ += count;
        stream_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
    }

    std::uint64_t position() const { return position_; }

private:
    fs::path path_;
    std::ifstream stream_;
    std::uint64_t size_;
    std::uint64_t position_ = 0;
};

// OpenEXR reads as many bytes of these as the type has, whatever size the header gives.
bool has_other_size(const std::string& type, std::uint64_t size) {
    static const std::map<std::string, std::uint64_t> sizes = {
        {"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
        {"compression", 1},    {"double", 8},    {"envmap", 1},
        {"deepImageState", 1}, {"float", 4},     {"int", 4},
        {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
        {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
        {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
        {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
        {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};
    const auto found = sizes.find(type);
    return found != sizes.end() && found->second != size;
}

void walk_channels(Walker& walker) {
    constexpr std::uint64_t channel_bytes = 16;  // type, linearity, sampling
    while (!walker.name().empty()) walker.skip(channel_bytes);
}

void walk_strings(Walker& walker, std::uint64_t end) {
    while (walker.position() < end) walker.skip(walker.number());
}

void walk_preview(Walker& walker) {
    const std::uint64_t width = walker.number(), height = walker.number();
    if (width > 65536 || height > 65536) walker.fail("has a preview larger than 65536x65536");
    walker.skip(width * height * 4);
}

// Values that hold counts of their own are walked by these; they must end where their size says.
void walk_value(Walker& walker, const std::string& name, const std::string& type) {
    const std::uint64_t size = walker.number(), end = walker.position() + size;
    if (type == "chlist") {
        walk_channels(walker);
    } else if (type == "stringvector") {
        walk_strings(walker, end);
    } else if (type == "preview") {
        walk_preview(walker);
    } else {
        walker.skip(size);
    }
    if (walker.position() != end || has_other_size(type, size)) {
        walker.fail("has the attribute " + name + " in another size than it says");
    }
}

}  // namespace

void check_exr_attributes(const fs::path& path) {
    Walker walker(path);
    walker.number();  // the magic number, known by now
    const bool several_parts = (walker.number() & 0x1000) != 0;
    for (bool first = true;; first = false) {
        std::string name = walker.name();
        if (name.empty() && !first) return;
        for (; !name.empty(); name = walker.name()) {
            const std::string type = walker.name();
            walk_value(walker, name, type);
        }
        if (!several_parts) return;
    }
}

}  // namespace clgi::io
