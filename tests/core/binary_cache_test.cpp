// Binaries of programs in a folder: taken where they are whole and of the same program, else built
// anew.
// SPDX-License-Identifier: MIT
#include "core/opencl/binary_cache.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <clgi/passes/parallel.hpp>
#include <clgi/programs.hpp>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "device.hpp"

namespace clgi {
namespace {

namespace fs = std::filesystem;

const std::string options = "-cl-std=CL1.2";

// A kernel that writes a number.
std::string source(int number) {
    return "kernel void write(global int* to) { *to = " + std::to_string(number) + "; }";
}

cl::Program built(const std::string& text) {
    cl::Program out(test::device().context, text);
    out.build(test::device().device, options.c_str());
    return out;
}

int written(const cl::Program& program) {
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer to = test::empty<int>(1);
    cl::Kernel kernel(program, "write");
    kernel.setArg(0, to);
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
    int out = 0;
    queue.enqueueReadBuffer(to, CL_TRUE, 0, sizeof out, &out);
    return out;
}

class BinaryCaches : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("clgi_binaries_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        cache_.set_folder(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::optional<cl::Program> find(const std::string& text,
                                    const std::string& with = options) const {
        return cache_.find(test::device().context, test::device().device, text, with);
    }
    void keep(const cl::Program& program, const std::string& text) const {
        cache_.keep(program, test::device().device, text, options);
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> out;
        for (const auto& entry : fs::directory_iterator(folder_)) out.push_back(entry.path());
        return out;
    }

    fs::path folder_;
    BinaryCache cache_;
};

TEST(Digest, IsFnv1a) {
    EXPECT_EQ(digest("").substr(0, 16), "cbf29ce484222325");
    EXPECT_EQ(digest("a").substr(0, 16), "af63dc4c8601ec8c");
    EXPECT_EQ(digest("").size(), 32u);
    EXPECT_NE(digest("a").substr(16), digest("b").substr(16));
}

// What is kept for a source is another program, so that which of them runs is seen.
TEST_F(BinaryCaches, TakeWhatTheyKept) {
    EXPECT_FALSE(find(source(1)));
    keep(built(source(2)), source(1));
    const auto found = find(source(1));
    ASSERT_TRUE(found);
    EXPECT_EQ(written(*found), 2);
    EXPECT_FALSE(find(source(3)));
    EXPECT_FALSE(find(source(1), options + " -DX"));
    ASSERT_EQ(files().size(), 1u);  // and nothing half written
    EXPECT_EQ(files()[0].filename().string().size(), 32u);
}

TEST_F(BinaryCaches, RefuseWhatIsBroken) {
    keep(built(source(2)), source(1));
    ASSERT_EQ(files().size(), 1u);
    const fs::path file = files()[0];
    std::ifstream in(file, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), {});
    const auto finds = [&](const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
        return find(source(1)).has_value();
    };
    const auto changed = [&](std::size_t at) {
        std::string out = whole;
        out[at] = static_cast<char>(out[at] ^ 1);
        return out;
    };
    EXPECT_TRUE(finds(whole));
    EXPECT_FALSE(finds(""));
    EXPECT_FALSE(finds(whole.substr(0, 40)));
    EXPECT_FALSE(finds(whole.substr(0, whole.size() - 1)));
    EXPECT_FALSE(finds(whole + "x"));
    EXPECT_FALSE(finds(changed(0)));
    EXPECT_FALSE(finds(changed(20)));  // the name
    EXPECT_FALSE(finds(changed(whole.size() / 2)));
    // Whole, but no binary of this driver.
    const std::string none = "no program";
    const std::size_t name = whole.find('\n') + 1;
    EXPECT_FALSE(finds(whole.substr(0, name + 33) + digest(none) + "\n" + none));
    EXPECT_TRUE(finds(whole));
}

TEST_F(BinaryCaches, KeepNothingWithoutAFolder) {
    std::ofstream(folder_) << "a file";
    keep(built(source(1)), source(1));
    EXPECT_FALSE(find(source(1)));
    fs::remove(folder_);
    cache_.set_folder("");
    keep(built(source(1)), source(1));
    EXPECT_FALSE(find(source(1)));
    EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(BinaryCaches, AreSharedByThreads) {
    const cl::Program program = built(source(7));
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int k = 0; k < 2; ++k) {
                keep(program, source(7));
                const auto found = find(source(7));
                EXPECT_TRUE(found);
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(files().size(), 1u);
    EXPECT_EQ(written(*find(source(7))), 7);
}

// Passes of Programs that keep binaries, then of others that find them.
TEST_F(BinaryCaches, ServePrograms) {
    const std::vector<std::uint32_t> counts = {3, 0, 4, 1, 5};
    for (int process = 0; process < 2; ++process) {
        Programs programs(test::device().context, test::device().device);
        programs.keep_binaries(folder_);
        const ParallelPasses passes(programs);
        const cl::Buffer counted = test::upload(counts), total = test::empty<std::uint32_t>(1);
        passes.offsets(test::device().queue, 5, counted, total);
        std::vector<std::uint32_t> sums(5);
        test::device().queue.enqueueReadBuffer(counted, CL_TRUE, 0, 20, sums.data());
        EXPECT_EQ(sums, (std::vector<std::uint32_t>{0, 3, 3, 7, 8}));
        EXPECT_EQ(programs.built(), 1u);
        EXPECT_EQ(files().size(), 1u);
    }
}

}  // namespace
}  // namespace clgi
