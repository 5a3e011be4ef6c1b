// 8-bit pictures to disk.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/io/image.hpp>
#include <string>

#include "io/atomic_file.hpp"
#include "io/png_encode.hpp"

namespace clgi::io {

void save_png(int width, int height, const std::vector<std::uint8_t>& rgba,
              const std::filesystem::path& path) {
    if (width < 1 || height < 1) {
        throw Error("save_png: size is " + std::to_string(width) + "x" + std::to_string(height) +
                    ", needs at least 1x1");
    }
    const auto needed = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) * 4;
    if (rgba.size() != needed) {
        throw Error("save_png: rgba has " + std::to_string(rgba.size()) + " bytes, needs " +
                    std::to_string(needed));
    }
    AtomicFile file(path);
    const std::vector<std::uint8_t> bytes = encode_png(width, height, rgba.data());
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace clgi::io
