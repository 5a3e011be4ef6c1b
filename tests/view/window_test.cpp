// The window of clgi view on a virtual screen, driven by keys and mouse.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <clgi/io/image.hpp>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <thread>

#include "program.hpp"

namespace {

using clgi::io::Image;
using clgi::test::Outcome;

class Window : public clgi::test::Program {
protected:
    // A screen of its own, as long as the test runs.
    void SetUp() override {
        Program::SetUp();
        const std::string command =
            "echo $$; exec Xvfb -displayfd 1 -screen 0 800x600x24 2>/dev/null";
        screen_ = ::popen(("sh -c '" + command + "'").c_str(), "r");
        char line[64] = {};
        ASSERT_TRUE(std::fgets(line, sizeof line, screen_));
        process_ = std::atoi(line);
        ASSERT_TRUE(std::fgets(line, sizeof line, screen_)) << "Xvfb does not start";
        display_ = "DISPLAY=:" + std::to_string(std::atoi(line));
    }
    void TearDown() override {
        stop_screen();
        if (screen_) ::pclose(screen_);
        Program::TearDown();
    }

    void stop_screen() {
        if (process_ > 0) ::kill(process_, SIGTERM);
        process_ = 0;
    }

    int key(const std::string& commands) const {
        return std::system((display_ + " xdotool " + commands).c_str());
    }

    template <typename Done>
    bool wait(const Done& done) const {
        for (int i = 0; i < 3000; ++i) {  // a bake by groups takes minutes on a CPU
            if (done()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return false;
    }

    std::string display_;

private:
    std::FILE* screen_ = nullptr;
    int process_ = 0;
};

double difference(const Image& a, const Image& b) {
    double error = 0.0, sum = 0.0;
    for (const char* name : {"R", "G", "B"})
        for (std::size_t i = 0; i < a.find(name)->values.size(); ++i) {
            const double x = a.find(name)->values[i], y = b.find(name)->values[i];
            error += (x - y) * (x - y);
            sum += y * y;
        }
    return std::sqrt(error / sum);
}

// Of a saved picture and its line: how far it is from what the line's command makes, and the
// command.
struct Repeated {
    double difference = 1.0;
    std::string command;
};

TEST_F(Window, SavesPicturesOfCommands) {
    const std::string scene = make("cornell --light spot");
    std::thread window([&] {
        const Outcome outcome =
            run("view " + scene + " --size 160x120 --method atlas -o " + file("saved.exr").string(),
                display_);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
    });
    const auto lines = [&] {
        const std::string text = read("out");
        return std::count(text.begin(), text.end(), '\n');
    };
    const auto drag = [&] {
        key("mousemove 80 100 mousedown 1");
        for (const char* to : {"84 98", "90 96", "98 94"}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(150));
            key(std::string("mousemove ") + to);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
        key("mouseup 1");
    };
    bool went = wait(
        [&] { return key("search --onlyvisible --name clgi windowfocus >/dev/null 2>&1") == 0; });
    key("key h");  // the panel covers so small a window
    key("key p");
    went = went && wait([&] { return lines() >= 1; });
    drag();
    key("key p");
    went = went && wait([&] { return lines() >= 2; });
    key("keydown ctrl");
    drag();
    key("keyup ctrl");
    key("key p");
    went = went && wait([&] { return lines() >= 3; });
    key("key Escape");
    if (!went) stop_screen();  // and with it the window
    window.join();
    ASSERT_TRUE(went);

    std::istringstream text(read("out"));
    const auto repeated = [&](const std::string& name) {
        Repeated out;
        std::string line;
        std::getline(text, line);
        const std::string begin = "clgi render ";
        const std::size_t at = line.find(begin), end = line.find(" -o ");
        EXPECT_EQ(line.rfind(file(name).string() + ": ", 0), 0u) << line;
        if (at == std::string::npos || end == std::string::npos) return out;
        out.command = line.substr(at, end - at);
        const std::string again = file("again.exr").string();
        const Outcome outcome =
            run("render " + out.command.substr(begin.size()) + " -o " + again + " --quiet");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Image picture = clgi::io::load_image(file(name));
        EXPECT_EQ(picture.attributes.at("clgi:command"), out.command);
        out.difference = difference(picture, clgi::io::load_image(again));
        return out;
    };
    const Repeated first = repeated("saved.exr"), moved = repeated("saved-1.exr"),
                   lit = repeated("saved-2.exr");
    EXPECT_EQ(first.difference, 0.0);
    EXPECT_NE(first.command.find(" --size 160x120 --method atlas"), std::string::npos);
    EXPECT_EQ(first.command.find(" --eye "), std::string::npos);
    EXPECT_EQ(moved.difference, 0.0);
    EXPECT_NE(moved.command.find(" --eye "), std::string::npos);
    EXPECT_LE(lit.difference, 2e-3);  // its atlas was brought up to date, not baked anew
    EXPECT_NE(lit.command.find(" --light 0:direction="), std::string::npos) << lit.command;
}

TEST_F(Window, TurnsForAWhile) {
    const std::string scene = make("cornell");
    const Outcome outcome = run("view " + scene + " --size 160x120 --turntable 2s", display_);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t at = outcome.out.find(" pictures in ");
    ASSERT_NE(at, std::string::npos) << outcome.out;
    EXPECT_GE(std::atoi(outcome.out.c_str() + outcome.out.rfind('\n', at) + 1), 2);
}

TEST_F(Window, IsRefusedWithoutAScreen) {
    const std::string scene = make("cornell");
    const Outcome outcome = run("view " + scene + " --quiet", "env -u DISPLAY -u WAYLAND_DISPLAY");
    expect_one_error_line(outcome, 3);
    expect_one_error_line(run("view " + scene + " --quiet --turntable soon", display_), 1);
    expect_one_error_line(run("view " + scene + " --quiet -o view.png", display_), 1);
    expect_one_error_line(run("view " + scene + " --quiet --light 5:position=1,2,3", display_), 1);
    expect_one_error_line(run("view " + scene + " --quiet --time 1", display_), 1);
}

}  // namespace
