// Animations made to cost far more than their file: they must end quickly, in bounded memory.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <ctime>

#include "posing.hpp"

namespace clgi::test {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr double slowdown = 4.0;
#else
constexpr double slowdown = 1.0;
#endif

// Processor time: a busy machine is no failure.
class AnimationHostile : public testing::Test {
protected:
    void TearDown() override {
        const double seconds = static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
        EXPECT_LT(seconds, 5.0 * slowdown);
    }

private:
    std::clock_t start_ = std::clock();
};

bool says(const Scene& scene, const std::string& text) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& line) { return line.find(text) == 0; });
}

// Every range has a matrix for each joint of its skin: 80 times 2^17 of them.
TEST_F(AnimationHostile, JointsOfManyRangesAreBounded) {
    GltfDraft draft = strip_draft();
    json& mesh = draft.document["meshes"][0];
    mesh["primitives"] = std::vector<json>(80, mesh["primitives"][0]);
    draft.document["skins"][0] = {{"joints", std::vector<int>(std::size_t{1} << 17, 2)}};
    const Scene scene = draft.load();
    EXPECT_FALSE(scene.animation);
    EXPECT_TRUE(says(scene, "animation is left out: it has more than 134217728 numbers"));
    EXPECT_EQ(scene.triangles.size(), 320u);
}

}  // namespace
}  // namespace clgi::test
