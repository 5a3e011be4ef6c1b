// The table of options: each row reads what it writes, and refuses what is no value of its own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <clgi/options.hpp>
#include <cmath>
#include <set>

namespace clgi {
namespace {

// A value of the row that is not its default.
std::string another(const OptionRow& row) {
    const std::string usual = row.get({});
    if (row.kind == OptionRow::Kind::toggle) return usual == "true" ? "false" : "true";
    for (const std::string& choice : row.choices)
        if (choice != usual) return choice;
    if (row.least == row.most) return row.value == "X" ? "12.5%" : "0.125";
    const double most = std::isinf(row.most) ? 7.5 : row.most;
    return row.kind == OptionRow::Kind::integer ? std::to_string(static_cast<long>(most)) : "1";
}

TEST(Options, AreReadAsTheyAreWritten) {
    for (const OptionRow& row : option_table()) {
        SCOPED_TRACE(row.name);
        RendererOptions options;
        const std::string usual = row.get(options), other = another(row);
        ASSERT_NE(other, usual);
        row.set(options, other);
        EXPECT_EQ(row.get(options), other);
        row.set(options, usual);
        EXPECT_EQ(row.get(options), usual);
    }
}

// A row changes what it says and no other row, but those of the same name and the two of --low-res.
TEST(Options, ChangeNothingElse) {
    for (const OptionRow& row : option_table()) {
        SCOPED_TRACE(row.name);
        RendererOptions options;
        row.set(options, another(row));
        for (const OptionRow& other : option_table()) {
            const bool pair =
                row.name.rfind("low-res", 0) == 0 && other.name.rfind("low-res", 0) == 0;
            if (other.name == row.name || pair) continue;
            EXPECT_EQ(other.get(options), other.get({})) << other.name;
        }
    }
}

TEST(Options, RefuseWhatIsNoValue) {
    for (const OptionRow& row : option_table()) {
        SCOPED_TRACE(row.name);
        RendererOptions options;
        for (const char* text : {"", "wrong", "1e", "nan", "-1x"}) {
            EXPECT_THROW(row.set(options, text), Error) << text;
            EXPECT_EQ(row.get(options), row.get({}));
        }
        if (row.least < row.most && row.choices.empty()) {
            EXPECT_THROW(row.set(options, std::to_string(row.least - 1.0)), Error);
            if (!std::isinf(row.most)) {
                EXPECT_THROW(row.set(options, std::to_string(2.0 * row.most + 1.0)), Error);
            }
        }
        if (row.kind == OptionRow::Kind::integer) {
            EXPECT_THROW(row.set(options, "8.5"), Error);
        }
    }
}

TEST(Options, HaveOneRowForAMethodAndAName) {
    std::set<std::pair<std::string, unsigned>> seen;
    for (const OptionRow& row : option_table()) {
        EXPECT_FALSE(row.help.empty());
        for (unsigned bit = 1; bit <= of_vectors; bit <<= 1)
            if (row.of(bit)) {
                EXPECT_TRUE(seen.insert({row.name, bit}).second) << row.name;
            }
    }
    EXPECT_THROW(option("no-such"), Error);
    EXPECT_EQ(option("vpls").get({}), "300");
    EXPECT_EQ(option("vpls", of_bakes).get({}), "1600");
}

// VPLs of a picture and of an atlas are asked for by one name.
TEST(Options, SetBothKindsOfVpls) {
    RendererOptions options;
    set_option(options, "vpls", "77");
    EXPECT_EQ(options.second_order.emitters.vpls, 77);
    EXPECT_EQ(options.vpls.count, 77u);
    set_option(options, "shadow-size", "333");
    EXPECT_EQ(options.picture.emitters.shadow_size, 333);
    EXPECT_EQ(options.light_atlas.emitters.shadow_size, 333);
}

TEST(Options, AreTheKeyOfABake) {
    RendererOptions a, b;
    EXPECT_EQ(option_text(a, of_bakes), option_text(b, of_bakes));
    for (const OptionRow& row : option_table()) {
        b = RendererOptions();
        row.set(b, another(row));
        const bool same = option_text(a, of_bakes) == option_text(b, of_bakes);
        // Those of pictures that a bake shares reach it too.
        if (row.of(of_bakes)) {
            EXPECT_FALSE(same) << row.name;
        }
    }
}

}  // namespace
}  // namespace clgi
