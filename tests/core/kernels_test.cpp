// Every kernel is a program of its own: it builds alone, without macros and at every packet width,
// and the compiler has nothing to remark.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>

#include "device.hpp"

namespace clgi {
namespace {

std::vector<std::filesystem::path> kernel_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CLGI_KERNELS_DIR))
        if (entry.path().extension() == ".cl") files.push_back(entry.path());
    return files;
}

// What the compiler said; empty when it was content.
std::string remarks(const std::filesystem::path& file, const std::string& options) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    cl::Program program(test::device().context, text.str());
    try {
        program.build(test::device().device, ("-cl-std=CL1.2 " + options).c_str());
    } catch (const cl::Error& error) {
        return "OpenCL error " + std::to_string(error.err()) + "\n" +
               program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
    }
    const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
    return log.find("warning") == std::string::npos ? "" : log;
}

void expect_content(const std::string& options) {
    test::device();  // before there are threads
    const auto files = kernel_files();
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

TEST(Kernels, BuildWithoutMacros) { expect_content("-Werror"); }

TEST(Kernels, BuildOneLaneWide) { expect_content("-Werror -DCLGI_WIDTH=1"); }

TEST(Kernels, BuildFourLanesWide) { expect_content("-Werror -DCLGI_WIDTH=4"); }

TEST(Kernels, BuildEightLanesWide) { expect_content("-Werror -DCLGI_WIDTH=8"); }

// On a CPU with narrower registers the compiler remarks that built-in functions pass 64-byte
// vectors in another way than AVX-512 would. Nobody is called that was built the other way, and
// nothing but an option of that compiler would silence it: there the width only has to build.
TEST(Kernels, BuildSixteenLanesWide) {
    const cl::Device& device = test::device().device;
    if (device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() >= 16) {
        expect_content("-Werror -DCLGI_WIDTH=16");
        return;
    }
    for (const auto& file : kernel_files()) {
        const std::string said = remarks(file, "-DCLGI_WIDTH=16");
        EXPECT_EQ(said.find("error"), std::string::npos) << file << "\n" << said;
    }
}

TEST(Kernels, BuildWithNearLists) { expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_NEAR"); }

TEST(Kernels, BuildWith64BitAtomics) {
    if (!has_atomics64()) GTEST_SKIP() << "the device has no cl_khr_int64_extended_atomics";
    expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_ATOMIC64");
}

TEST(Kernels, BuildForDepthAlone) { expect_content("-Werror -DCLGI_WIDTH=4 -DCLGI_DEPTH_ONLY"); }

TEST(Kernels, BuildWithFastMath) { expect_content("-Werror -DCLGI_WIDTH=4 -cl-fast-relaxed-math"); }

// The library flattens its kernels itself: byte for byte what is installed.
TEST(KernelSources, AreTheInstalledFiles) {
    const auto files = kernel_files();
    EXPECT_EQ(kernel_names().size(), files.size());
    for (const auto& file : files) {
        std::ostringstream text;
        text << std::ifstream(file).rdbuf();
        const std::string name =
            file.parent_path().filename().string() + "/" + file.stem().string();
        EXPECT_EQ(kernel_source(name), text.str()) << name;
    }
    EXPECT_THROW(kernel_source("image/no-such"), Error);
    EXPECT_THROW(kernel_source("shared/base"), Error);
}

}  // namespace
}  // namespace clgi
