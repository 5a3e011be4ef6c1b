// SPDX-License-Identifier: MIT
#include "core/opencl/binary_cache.hpp"

#include <atomic>
#include <fstream>
#include <iterator>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

namespace clgi {
namespace {

constexpr std::string_view magic = "clgi program 1\n";

std::uint64_t fnv(std::string_view text, std::uint64_t hash) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return hash;
}

// Parts with their lengths, so that no two lists are the same text.
std::string key_of(const cl::Device& device, const std::string& source,
                   const std::string& options) {
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    std::string out;
    for (const std::string& part :
         {source, options, device.getInfo<CL_DEVICE_NAME>(), device.getInfo<CL_DEVICE_VENDOR>(),
          device.getInfo<CL_DEVICE_VERSION>(), device.getInfo<CL_DRIVER_VERSION>(),
          device.getInfo<CL_DEVICE_EXTENSIONS>(), platform.getInfo<CL_PLATFORM_NAME>(),
          platform.getInfo<CL_PLATFORM_VERSION>()})
        out += std::to_string(part.size()) + ":" + part;
    return digest(out);
}

std::string header_of(const std::string& key, std::string_view binary) {
    return std::string(magic) + key + "\n" + digest(binary) + "\n";
}

// A name that no other thread or process has.
std::string unique_suffix() {
    static std::atomic<unsigned> count{0};
    static const unsigned process = std::random_device()();
    return "." + std::to_string(process) + "-" + std::to_string(count++);
}

}  // namespace

std::string digest(std::string_view text) {
    const std::uint64_t halves[2] = {fnv(text, 0xcbf29ce484222325ull),
                                     fnv(text, 0x84222325cbf29ce4ull)};
    std::string out;
    for (const std::uint64_t half : halves)
        for (int shift = 60; shift >= 0; shift -= 4)
            out += "0123456789abcdef"[(half >> shift) & 15];
    return out;
}

void BinaryCache::set_folder(const std::filesystem::path& folder) {
    const std::lock_guard lock(mutex_);
    folder_ = folder;
}

std::filesystem::path BinaryCache::folder() const {
    const std::lock_guard lock(mutex_);
    return folder_;
}

std::optional<cl::Program> BinaryCache::find(const cl::Context& context, const cl::Device& device,
                                             const std::string& source,
                                             const std::string& options) const {
    const std::filesystem::path in = folder();
    if (in.empty()) return std::nullopt;
    const std::string key = key_of(device, source, options);
    std::ifstream file(in / key, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const std::size_t begin = header_of(key, "").size();
    if (text.size() <= begin) return std::nullopt;
    const std::string_view binary = std::string_view(text).substr(begin);
    if (text.substr(0, begin) != header_of(key, binary)) return std::nullopt;
    try {
        cl::Program program(context, {device},
                            cl::Program::Binaries{{binary.begin(), binary.end()}});
        program.build(device, options.c_str());
        return program;
    } catch (const cl::Error&) {  // not what this driver takes
        return std::nullopt;
    }
}

void BinaryCache::keep(const cl::Program& program, const cl::Device& device,
                       const std::string& source, const std::string& options) const {
    const std::filesystem::path in = folder();
    if (in.empty()) return;
    try {
        // Of all devices of the context; this one is the only one or none is kept.
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        if (binaries.size() != 1 || binaries[0].empty()) return;
        const std::string binary(binaries[0].begin(), binaries[0].end());
        const std::string key = key_of(device, source, options);
        std::error_code failed;
        std::filesystem::create_directories(in, failed);
        const std::filesystem::path whole = in / key, part = in / (key + unique_suffix());
        std::ofstream file(part, std::ios::binary);
        file << header_of(key, binary) << binary;
        file.close();
        if (file.good()) std::filesystem::rename(part, whole, failed);
        if (!file.good() || failed) std::filesystem::remove(part, failed);
    } catch (const cl::Error&) {  // a driver without binaries
    }
}

}  // namespace clgi
