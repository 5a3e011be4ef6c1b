// Binaries of built programs in a folder, for runtimes that keep none themselves.
//
// A file is named by what its program depends on: source, options, device, driver and platform with
// their versions. It begins with this name and a check of the binary, so that what is cut short,
// changed or of somebody else is not taken. Files appear whole or not at all.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace clgi {

class CLGI_API BinaryCache {
public:
    // Empty: nothing is kept.
    void set_folder(const std::filesystem::path& folder);

    // A program that is built, or none.
    std::optional<cl::Program> find(const cl::Context& context, const cl::Device& device,
                                    const std::string& source, const std::string& options) const;

    // Keeps the binary of a program that is built. Nothing is said where that is not possible: the
    // next process builds it again.
    void keep(const cl::Program& program, const cl::Device& device, const std::string& source,
              const std::string& options) const;

private:
    std::filesystem::path folder() const;

    mutable std::mutex mutex_;
    std::filesystem::path folder_;
};

// 128 bits of a text as 32 hexadecimal digits (FNV-1a from two offsets).
CLGI_API std::string digest(std::string_view text);

}  // namespace clgi
