// OpenEXR in and out. What a header claims is checked before anything of its size is allocated.
// SPDX-License-Identifier: MIT
#include <Iex.h>
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <half.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <set>
#include <string>

#include "io/atomic_file.hpp"
#include "io/exr_header.hpp"
#include "io/file_error.hpp"
#include "io/image_formats.hpp"

namespace clgi::io {
namespace {

namespace fs = std::filesystem;

// Names that OpenEXR gives a meaning of its own: not ours to read or to set.
bool is_reserved(const std::string& name) {
    static const std::set<std::string> names = {"type", "name", "view", "version", "chunkCount"};
    return names.count(name) > 0;
}

std::int64_t bytes_per_pixel(const Imf::Header& header) {
    std::int64_t bytes = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        bytes += c.channel().type == Imf::HALF ? 2 : 4;
    }
    return bytes;
}

// Checks everything that decides how much memory reading takes, and whether we can read at all.
void check_header(const fs::path& path, const Imf::Header& header) {
    if (header.hasType() && Imf::isDeepData(header.type())) {
        fail(path, "is a deep image; a flat one is needed");
    }
    std::int64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels) {
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1) {
            fail(path, std::string("channel ") + c.name() + " is subsampled");
        }
    }
    if (channels == 0) fail(path, "has no channels");

    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    check_dimensions(path, width, height, channels);

    // What the library holds at once: a tile, or as many rows as its largest block has.
    constexpr std::int64_t largest_block = std::int64_t{1} << 31, most_rows = 256;
    std::int64_t block = width * most_rows;
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        if (tile.xSize > 65536 || tile.ySize > 65536) fail(path, "has tiles larger than 65536");
        // A tile may reach past the picture, but not by much.
        block = std::int64_t{tile.xSize} * tile.ySize;
        if (block > std::max(4 * width * height, std::int64_t{1} << 22)) {
            fail(path, "has tiles larger than its picture");
        }
    }
    if (block > largest_block / bytes_per_pixel(header)) fail(path, "has too many channels");

    // No codec of OpenEXR packs as tightly as this; who claims more has no pixels behind it.
    constexpr std::int64_t tightest = 4096;
    const auto file_bytes = static_cast<std::int64_t>(fs::file_size(path));
    if (width * height * bytes_per_pixel(header) / tightest > file_bytes) {
        fail(path, "claims " + std::to_string(width) + "x" + std::to_string(height) +
                       " pixels in " + std::to_string(file_bytes) + " bytes");
    }
}

void read_attributes(const Imf::Header& header, Image& image) {
    for (auto a = header.begin(); a != header.end(); ++a) {
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute());
        if (text && !is_reserved(a.name())) image.attributes[a.name()] = text->value();
    }
}

// UINT and HALF channels are converted by the library.
void read_pixels(Imf::InputPart& part, Image& image) {
    const Imath::Box2i window = part.header().dataWindow();
    const auto width = static_cast<std::size_t>(image.width);
    const std::size_t samples = width * static_cast<std::size_t>(image.height);
    const Imf::ChannelList& channels = part.header().channels();
    Imf::FrameBuffer frame;
    for (auto c = channels.begin(); c != channels.end(); ++c) {
        image.channels.push_back({c.name(), std::vector<float>(samples)});
        frame.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, image.channels.back().values.data(),
                                                window, sizeof(float), width * sizeof(float)));
    }
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
}

class FileStream : public Imf::OStream {
public:
    FileStream(AtomicFile& file, const std::string& name)
        : Imf::OStream(name.c_str()), file_(file) {}
    void write(const char bytes[], int count) override {
        file_.write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return file_.tell(); }
    void seekp(std::uint64_t offset) override { file_.seek(offset); }

private:
    AtomicFile& file_;
};

// OpenEXR cuts longer names off and says nothing.
void check_name(const char* kind, const std::string& name) {
    if (!name.empty() && name.size() <= 255) return;
    throw Error(std::string("save_exr: the name of ") + kind + " has " +
                std::to_string(name.size()) + " letters, needs 1 to 255");
}

void check_image(const Image& image) {
    if (image.width < 1 || image.height < 1) {
        throw Error("save_exr: size is " + std::to_string(image.width) + "x" +
                    std::to_string(image.height) + ", needs at least 1x1");
    }
    if (image.channels.empty()) throw Error("save_exr: there are no channels");
    const auto samples =
        static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
    std::set<std::string> names;
    for (const Image::Channel& channel : image.channels) {
        if (channel.values.size() != samples) {
            throw Error("save_exr: channel " + channel.name + " has " +
                        std::to_string(channel.values.size()) + " samples, needs " +
                        std::to_string(samples));
        }
        check_name("a channel", channel.name);
        if (!names.insert(channel.name).second) {
            throw Error("save_exr: two channels are named " + channel.name);
        }
    }
    for (const auto& [name, text] : image.attributes) check_name("an attribute", name);
}

// Infinities saturate like every value that is too large; NaN stays, to be seen.
half saturated(float value) {
    constexpr float largest = 65504.0f;
    return half(std::clamp(value, -largest, largest));
}

std::vector<std::vector<half>> to_half(const Image& image) {
    std::vector<std::vector<half>> planes;
    for (const Image::Channel& channel : image.channels) {
        std::vector<half>& plane = planes.emplace_back();
        plane.reserve(channel.values.size());
        for (const float value : channel.values) plane.push_back(saturated(value));
    }
    return planes;
}

void write_exr(const Image& image, const std::string& name, PixelType wanted, AtomicFile& file) {
    const bool is_half = wanted == PixelType::half;
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, text] : image.attributes) {
        if (!is_reserved(key)) header.insert(key, Imf::StringAttribute(text));
    }
    const std::vector<std::vector<half>> halves =
        is_half ? to_half(image) : std::vector<std::vector<half>>();
    const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
    const std::size_t size = is_half ? sizeof(half) : sizeof(float);
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const Image::Channel& channel = image.channels[i];
        const void* values = is_half ? static_cast<const void*>(halves[i].data())
                                     : static_cast<const void*>(channel.values.data());
        header.channels().insert(channel.name, Imf::Channel(type));
        frame.insert(channel.name, Imf::Slice::Make(type, values, header.dataWindow(), size,
                                                    size * static_cast<std::size_t>(image.width)));
    }
    FileStream stream(file, name);
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(image.height);
}

}  // namespace

Image read_exr(const fs::path& path) {
    try {
        check_exr_attributes(path);
        Imf::MultiPartInputFile file(path.string().c_str());
        check_header(path, file.header(0));
        Imf::InputPart part(file, 0);
        const Imath::Box2i& window = part.header().dataWindow();
        Image image;
        image.width = window.max.x - window.min.x + 1;
        image.height = window.max.y - window.min.y + 1;
        read_attributes(part.header(), image);
        read_pixels(part, image);
        return image;
    } catch (const Iex::BaseExc& error) {
        fail(path, std::string("is broken: ") + error.what());
    }
}

void save_exr(const Image& image, const fs::path& path, PixelType type) {
    check_image(image);
    AtomicFile file(path);
    try {
        write_exr(image, path.string(), type, file);
    } catch (const Iex::BaseExc& error) {
        throw Error("save_exr: " + path.string() + ": " + error.what());
    }
    file.commit();
}

}  // namespace clgi::io
