// The program run as its users run it: exit code, both outputs, a folder of its own.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace clgi::test {

namespace fs = std::filesystem;

struct Outcome {
    int code = -1;
    std::string out, err;
};

class Program : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("clgi_program_" + std::to_string(::getpid()) + "_" +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path file(const std::string& name) const { return folder_ / name; }

    Outcome run(const std::string& arguments, const std::string& environment = "") const {
        const std::string command = environment + " " + CLGI_PROGRAM + " " + arguments + " >" +
                                    file("out").string() + " 2>" + file("err").string();
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read("out"), read("err")};
    }

    std::string read(const std::string& name) const {
        std::ifstream in(file(name));
        std::stringstream text;
        text << in.rdbuf();
        return text.str();
    }

    std::string make(const std::string& arguments) const {
        const fs::path path = file("scene.glb");
        EXPECT_EQ(run("scene " + arguments + " -o " + path.string()).code, 0) << read("err");
        return path.string();
    }

    void expect_one_error_line(const Outcome& outcome, int code) const {
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_EQ(outcome.err.rfind("clgi: error: ", 0), 0u) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }

    // Of the program itself: drivers and their compilers write to stderr as well.
    static int own_lines(const std::string& text) {
        std::istringstream in(text);
        int count = 0;
        for (std::string line; std::getline(in, line);) count += line.rfind("clgi:", 0) == 0;
        return count;
    }

private:
    fs::path folder_;
};

}  // namespace clgi::test
