// What is drawn where Python lacks a package, and which files it may read.
// SPDX-License-Identifier: MIT
#include "lab/drawing.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "gltf_draft.hpp"
#include "lab/difference.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_files.hpp"
#include "rgb_pictures.hpp"

namespace clgi::lab {
namespace {

// A folder that Python looks for modules in, with one module of this text.
class DrawingTest : public testing::Test {
protected:
    void SetUp() override {
        if (Drawing().draw("sheet", {}) == "python3 is not there") GTEST_SKIP() << "needs python3";
    }
    void add_module(const std::string& name, const std::string& text) {
        save_text(folder_.path() / (name + ".py"), text);
        ::setenv("PYTHONPATH", folder_.path().c_str(), 1);
    }
    void TearDown() override { ::unsetenv("PYTHONPATH"); }

    test::TempFolder folder_;
};

TEST_F(DrawingTest, NamesThePackageThatIsMissingAndLeavesThePictures) {
    add_module("matplotlib", "raise ImportError(\"No module named 'matplotlib'\")\n");
    const std::string why = Drawing().draw("sheet", {});
    EXPECT_NE(why.find("No module named 'matplotlib'"), std::string::npos) << why;
    EXPECT_NE(why.find("python3-matplotlib"), std::string::npos) << why;
    EXPECT_EQ(why.find('\n'), std::string::npos);

    const io::Image dark = rgb_pictures::grey(4, 3, 0.5f), bright = rgb_pictures::grey(4, 3, 1.0f);
    const DifferencePicture difference = difference_picture(dark, bright);
    testing::internal::CaptureStderr();
    EXPECT_EQ(with_scale_bar(difference.raster, difference.scale).rgba, difference.raster.rgba);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "clgi: no scale bar: " + why + "\n");
    const Raster sheet = draw_sheet({{&dark, {"one", ""}}, {&bright, {"two", ""}}});
    EXPECT_EQ(sheet.width, 4);
    EXPECT_EQ(sheet.height, 6);
    const std::vector<std::uint8_t> last = preview(bright, preview_exposure(dark));
    EXPECT_TRUE(std::equal(last.begin(), last.end(), sheet.rgba.end() - 4 * 4 * 3));
}

TEST_F(DrawingTest, SaysInOneLineWhatWentWrong) {
    add_module("matplotlib", "raise ValueError('two\\nlines')\n");
    EXPECT_EQ(Drawing().draw("sheet", {}), "plots/sheet.py: ValueError: two lines");
}

TEST_F(DrawingTest, TakesNoModuleFromTheFolderItRunsIn) {
    const std::filesystem::path before = std::filesystem::current_path();
    save_text(folder_.path() / "json.py", "raise ValueError('not the one of Python')\n");
    std::filesystem::current_path(folder_.path());
    const std::string why = Drawing().draw("sheet", {});
    std::filesystem::current_path(before);
    EXPECT_EQ(why.find("not the one of Python"), std::string::npos) << why;
}

}  // namespace
}  // namespace clgi::lab
