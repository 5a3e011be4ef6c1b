// Every kernel is a program of its own: it builds alone, without macros and at every packet width,
// and the compiler has nothing to remark.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
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
// passed in another way. Nobody is called that was built the other way.
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
std::string remarks(const std::string& source, const std::string& options) {
    static const std::string strict = "-Werror ";
    cl::Program program(test::device().context, source);
    try {
        program.build(test::device().device, ("-cl-std=CL1.2 " + options).c_str());
    } catch (const cl::Error& error) {
        const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
        if (options.rfind(strict, 0) == 0 && is_about_registers(log))
            return remarks(source, options.substr(strict.size()));
        return "OpenCL error " + std::to_string(error.err()) + "\n" + log;
    }
    const auto log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(test::device().device);
    return options.rfind(strict, 0) != 0 || log.find("warning") == std::string::npos ? "" : log;
}

void expect_content(const std::map<std::string, std::string>& sources, const std::string& options) {
    test::device();  // before there are threads
    std::map<std::string, std::future<std::string>> builds;
    for (const auto& [name, source] : sources)
        builds[name] = std::async(std::launch::async, remarks, source, options);
    for (auto& [name, build] : builds) EXPECT_EQ(build.get(), "") << name << " with " << options;
}

// Kernels that name a macro, as one program: names of one do not meet those of another. The folder
// "transfer" holds two families that draw into targets of their own. Forms for groups are one lane
// wide (BuildWithoutMacros).
std::map<std::string, std::string> all_with(const std::string& macro, const std::string& options) {
    const bool wide = options.find("CLGI_WIDTH=") != std::string::npos;
    std::map<std::string, std::vector<std::string>> names;
    for (const std::string& name : kernel_names()) {
        const std::string source = kernel_source(name);
        if (source.find(macro) == std::string::npos) continue;
        if (wide && name.ends_with("_group")) continue;
        const bool nearest = source.find("nearest.clh") != std::string::npos;
        names[nearest ? "nearest" : "others"].push_back(name);
    }
    EXPECT_FALSE(names.empty()) << macro;
    std::map<std::string, std::string> out;
    for (const auto& [family, of] : names) out[family] = kernels_source(of);
    return out;
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

// One lane wide, each kernel alone.
TEST(Kernels, BuildWithoutMacros) {
    std::map<std::string, std::string> sources;
    for (const std::string& name : kernel_names()) sources[name] = kernel_source(name);
    expect_content(sources, "-Werror ");
}

// A macro, of the kernels that name it, and the options it is tried with. Eight lanes differ from
// four and sixteen in the types of kernels/packet.clh alone.
struct Form {
    const char *name, *macro, *options;
};

class KernelForms : public testing::TestWithParam<Form> {};

TEST_P(KernelForms, Build) {
    if (std::string(GetParam().macro) == "CLGI_ATOMIC64" && !has_atomics64())
        GTEST_SKIP() << "the device has no cl_khr_int64_extended_atomics";
    const std::string options = std::string("-Werror ") + GetParam().options;
    expect_content(all_with(GetParam().macro, options), options);
}

INSTANTIATE_TEST_SUITE_P(
    Kernels, KernelForms,
    testing::Values(Form{"sixteen_lanes", "CLGI_WIDTH", "-DCLGI_WIDTH=16"},
                    Form{"near_lists", "CLGI_NEAR", "-DCLGI_WIDTH=4 -DCLGI_NEAR"},
                    Form{"groups", "CLGI_GROUPS", "-DCLGI_GROUPS"},
                    Form{"atomics64", "CLGI_ATOMIC64", "-DCLGI_WIDTH=4 -DCLGI_ATOMIC64"},
                    Form{"depth_alone", "CLGI_DEPTH_ONLY", "-DCLGI_WIDTH=4 -DCLGI_DEPTH_ONLY"},
                    Form{"half", "CLGI_HALF", "-DCLGI_WIDTH=8 -DCLGI_HALF"},
                    Form{"no_textures", "CLGI_NO_TEXTURES", "-DCLGI_WIDTH=4 -DCLGI_NO_TEXTURES"},
                    Form{"fast_math", "", "-DCLGI_WIDTH=4 -cl-fast-relaxed-math"}),
    [](const auto& form) { return std::string(form.param.name); });

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
