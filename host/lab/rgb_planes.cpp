// Finds the planes that a comparison needs, or says which one is missing.
// SPDX-License-Identifier: MIT
#include "lab/rgb_planes.hpp"

#include <clgi/error.hpp>
#include <string>

namespace clgi::lab {
namespace {

std::string size_of(const io::Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height);
}

RgbPlanes planes_of(const io::Image& image, const char* which) {
    static constexpr std::array<const char*, 3> names = {"R", "G", "B"};
    const auto samples =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    RgbPlanes planes{};
    for (std::size_t c = 0; c < names.size(); ++c) {
        const io::Image::Channel* channel = image.find(names[c]);
        if (!channel || channel->values.size() != samples) {
            throw InputError(std::string("compare: picture ") + which + " has no channel " +
                             names[c]);
        }
        planes[c] = &channel->values;
    }
    return planes;
}

}  // namespace

std::pair<RgbPlanes, RgbPlanes> rgb_planes(const io::Image& a, const io::Image& b) {
    if (a.width != b.width || a.height != b.height) {
        throw InputError("compare: A has " + size_of(a) + " pixels, B has " + size_of(b));
    }
    if (a.width < 1 || a.height < 1) throw InputError("compare: the pictures are empty");
    return {planes_of(a, "A"), planes_of(b, "B")};
}

}  // namespace clgi::lab
