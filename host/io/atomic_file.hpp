// A file that appears whole or not at all: written beside its place, then renamed into it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace clgi::io {

// Until commit() the file at path stays as it was; without commit() the destructor leaves no
// trace. A symbolic link at path is followed. Everything that fails throws InputError
// "path: what is wrong".
class CLGI_API AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t count);
    void seek(std::uint64_t offset);  // from the start
    std::uint64_t tell() const;
    void commit();  // also throws when an earlier write or seek failed and nobody noticed

private:
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path target_;
    std::filesystem::path temporary_;
    std::FILE* stream_ = nullptr;
    bool failed_ = false;
};

}  // namespace clgi::io
