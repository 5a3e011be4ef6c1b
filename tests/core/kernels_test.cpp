// Every kernel is a program of its own: it builds alone, without macros and at every packet width,
// and the compiler has nothing to remark.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <sstream>

#include "core/opencl/embedded.hpp"
#include "device.hpp"

namespace clgi {
namespace {

std::vector<std::filesystem::path> kernel_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CLGI_KERNELS_DIR))
        if (entry.path().extension() == ".cl") files.push_back(entry.path());
    return files;
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

// On a CPU with narrower registers than AVX-512 has the compiler remarks that 64-byte vectors are
// passed in another way. Nobody is called that was built the other way, and no option of OpenCL
// silences it.
bool is_about_registers(const std::string& log) {
    std::istringstream lines(log);
    bool found = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("error:") == std::string::npos) continue;
        const bool registers = line.find("changes the ABI") != std::string::npos;
        if (!registers && line.find("too many errors") == std::string::npos) return false;
        found = found || registers;
    }
    return found;
}

// What the compiler said; empty when it was content.
std::string remarks(const std::filesystem::path& file, const std::string& options) {
    static const std::string strict = "-Werror ";
    cl::Program program(test::device().context, text_of(file));
    try {
        program.build(test::device().device, ("-cl-std=CL1.2 " + options).c_str());
    } catch (const cl::Error& error) {
        const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
        if (options.rfind(strict, 0) == 0 && is_about_registers(log))
            return remarks(file, options.substr(strict.size()));
        return "OpenCL error " + std::to_string(error.err()) + "\n" + log;
    }
    const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
    return options.rfind(strict, 0) != 0 || log.find("warning") == std::string::npos ? "" : log;
}

// macro: of kernels that have it; without it the others are the same in another form.
void expect_content(const std::string& options, const char* macro = "") {
    test::device();  // before there are threads
    std::vector<std::filesystem::path> files;
    for (const auto& file : kernel_files())
        if (text_of(file).find(macro) != std::string::npos) files.push_back(file);
    EXPECT_FALSE(files.empty()) << macro;
    std::vector<std::future<std::string>> builds;
    for (const auto& file : files)
        builds.push_back(std::async(std::launch::async, remarks, file, options));
    for (std::size_t i = 0; i < files.size(); ++i)
        EXPECT_EQ(builds[i].get(), "") << files[i] << " with " << options;
}

bool has_atomics64() {
    return test::device().device.getInfo<CL_DEVICE_EXTENSIONS>().find(
               "cl_khr_int64_extended_atomics") != std::string::npos;
}

// The list in the library is the list of files that are installed.
TEST(Kernels, AreAllThere) {
    std::vector<std::string> files;
    for (const auto& file : kernel_files())
        files.push_back(file.parent_path().filename().string() + "/" + file.stem().string());
    std::sort(files.begin(), files.end());
    std::vector<std::string> names = kernel_names();
    std::sort(names.begin(), names.end());
    EXPECT_EQ(files, names);
}

// One lane wide.
TEST(Kernels, BuildWithoutMacros) { expect_content("-Werror "); }

TEST(Kernels, BuildSixteenLanesWide) { expect_content("-Werror -DCLGI_WIDTH=16", "CLGI_WIDTH"); }

TEST(Kernels, BuildWithNearLists) {
    expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_NEAR", "CLGI_NEAR");
}

TEST(Kernels, BuildForGroups) { expect_content("-Werror -DCLGI_GROUPS", "CLGI_GROUPS"); }

TEST(Kernels, BuildWith64BitAtomics) {
    if (!has_atomics64()) GTEST_SKIP() << "the device has no cl_khr_int64_extended_atomics";
    expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_ATOMIC64", "CLGI_ATOMIC64");
}

TEST(Kernels, BuildForDepthAlone) {
    expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_DEPTH_ONLY", "CLGI_DEPTH_ONLY");
}

// A pass is built with the others of its folder: names of one do not meet those of another. The
// folder "transfer" holds two families that draw into targets of their own.
TEST(Kernels, OfAFolderBuildAsOneProgram) {
    std::map<std::string, std::vector<std::string>> folders;
    for (const std::string& name : kernel_names()) {
        const std::string folder = name.substr(0, name.find('/'));
        const bool nearest = kernel_source(name).find("nearest.clh") != std::string::npos;
        folders[folder + (nearest ? ", nearest" : "")].push_back(name);
    }
    EXPECT_GT(folders.size(), 8u);
    const auto folder_file = std::filesystem::temp_directory_path() /
                             ("clgi_folder_" + std::to_string(::getpid()) + ".cl");
    for (const auto& [folder, names] : folders) {
        std::ofstream(folder_file) << kernels_source(names);
        EXPECT_EQ(remarks(folder_file, "-Werror -DCLGI_WIDTH=4"), "") << folder;
    }
    std::filesystem::remove(folder_file);
}

// Four lanes wide. Eight differ from four and sixteen in the types of kernels/packet.clh alone.
TEST(Kernels, BuildWithFastMath) { expect_content("-Werror -DCLGI_WIDTH=4 -cl-fast-relaxed-math"); }

// The library flattens its kernels itself: byte for byte what is installed.
TEST(KernelSources, AreTheInstalledFiles) {
    const auto files = kernel_files();
    EXPECT_EQ(kernel_names().size(), files.size());
    for (const auto& file : files) {
        const std::string name =
            file.parent_path().filename().string() + "/" + file.stem().string();
        EXPECT_EQ(kernel_source(name), text_of(file)) << name;
    }
    EXPECT_THROW(kernel_source("image/no-such"), Error);
    EXPECT_THROW(kernel_source("shared/base"), Error);
}

}  // namespace
}  // namespace clgi
