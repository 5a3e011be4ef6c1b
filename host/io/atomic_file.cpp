// Write beside, then rename: readers see the old file or the new one, never half of one.
// SPDX-License-Identifier: MIT
#include "io/atomic_file.hpp"

#include <cerrno>
#include <clgi/error.hpp>
#include <cstring>
#include <random>
#include <string>

namespace clgi::io {
namespace {

namespace fs = std::filesystem;

// Renaming over a link would replace the link, over a device (/dev/null) the device.
fs::path writable_target(const fs::path& path) {
    std::error_code error;
    fs::path target = path;
    if (fs::is_symlink(path, error)) {
        target = fs::weakly_canonical(path, error);
        if (error) throw InputError(path.string() + ": " + error.message());
    }
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) throw InputError(path.string() + ": is a directory");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        throw InputError(path.string() + ": is not a regular file");
    }
    if (!target.has_filename()) throw InputError(path.string() + ": is not a file name");
    return target;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : target_(writable_target(path)) {
    std::random_device random;
    constexpr int attempts = 8;  // names collide only by accident or malice
    for (int attempt = 0; attempt < attempts && !stream_; ++attempt) {
        temporary_ = target_;
        temporary_ += '.';
        temporary_ += std::to_string(random());
        temporary_ += ".tmp";
        errno = 0;
        stream_ = std::fopen(temporary_.string().c_str(), "wbx");  // x: never one that exists
        if (!stream_ && errno != EEXIST) break;
    }
    if (!stream_) fail("cannot be written");
}

AtomicFile::~AtomicFile() {
    if (stream_) std::fclose(stream_);
    if (temporary_.empty()) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
}

void AtomicFile::fail(const char* what) const {
    const int code = errno;
    std::string text = target_.string() + ": " + what;
    if (code != 0) text += std::string(": ") + std::strerror(code);
    throw InputError(text);
}

void AtomicFile::write(const void* bytes, std::size_t count) {
    if (count == 0) return;
    errno = 0;
    if (std::fwrite(bytes, 1, count, stream_) == count) return;
    failed_ = true;
    fail("cannot be written");
}

void AtomicFile::seek(std::uint64_t offset) {
    errno = 0;
    if (std::fseek(stream_, static_cast<long>(offset), SEEK_SET) == 0) return;
    failed_ = true;
    fail("cannot be written");
}

std::uint64_t AtomicFile::tell() const { return static_cast<std::uint64_t>(std::ftell(stream_)); }

void AtomicFile::commit() {
    errno = 0;
    const bool closed = std::fclose(stream_) == 0;
    stream_ = nullptr;
    if (failed_ || !closed) fail("cannot be written");

    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) throw InputError(target_.string() + ": " + error.message());
    temporary_.clear();
}

}  // namespace clgi::io
