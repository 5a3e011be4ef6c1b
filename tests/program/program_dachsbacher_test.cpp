// bench dachsbacher1 and dachsbacher2.
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using clgi::test::Outcome;
class DachsbacherTables : public clgi::test::Program {};

TEST_F(DachsbacherTables, BenchHasTheRowsOfDachsbacherTable1) {
    const Outcome outcome =
        run("bench dachsbacher1 --only glossy-box --repeats 2 --spp 16 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    ASSERT_EQ(rows.size(), 1u);
    const auto& row = rows[0];
    EXPECT_EQ(row.at("scene"), "glossy-box");
    EXPECT_EQ(row.at("bins"), 128);
    EXPECT_EQ(row.at("steps"), 3);
    // The settings give the counts of the paper.
    for (const char* count : {"triangles", "elements"}) {
        const double paper = row.at(std::string("paper_") + count);
        EXPECT_NEAR(row.at(count).get<double>(), paper, 0.1 * paper) << count;
    }
    EXPECT_NEAR(row.at("pairs").get<double>(), 177e3, 17.7e3);
    EXPECT_GT(row.at("links"), row.at("pairs"));
    EXPECT_LT(row.at("leaves"), row.at("elements"));
    EXPECT_EQ(row.at("paper_fps"), 14.9);
    EXPECT_NEAR(row.at("ratio").get<double>() * 14.9, row.at("fps").get<double>(), 1e-6);
    // A picture takes time besides.
    EXPECT_GT(row.at("light_fps"), row.at("fps"));
    EXPECT_GT(row.at("error"), 0.0);
    // Direct light is the same on both sides, but for shadow maps and gloss.
    EXPECT_LT(row.at("error"), 0.5);
    EXPECT_GT(row.at("indirect_error"), 0.0);
    EXPECT_LT(row.at("indirect_error"), 1.0);
}

TEST_F(DachsbacherTables, BenchHasTheTimesAndMemoryOfDachsbacherTable2) {
    const Outcome outcome = run("bench dachsbacher2 --only glossy-box --repeats 1 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    ASSERT_EQ(rows.size(), 1u);
    const auto& row = rows[0];
    for (const char* part : {"linking_s", "local_ms", "global_ms", "push_pull_ms", "other_ms"})
        EXPECT_GT(row.at(part), 0.0) << part;
    EXPECT_EQ(row.at("paper_linking_s"), 2.4);
    EXPECT_EQ(row.at("paper_links_mb"), 3.8);
    // At least an intensity of 128 bins for each of more than 4,000 elements, 8 bytes each, and
    // 10 bytes for each of more than 177,000 links.
    EXPECT_GT(row.at("tables_mb").get<double>() * (1 << 20), 4000.0 * 128 * 8);
    EXPECT_GT(row.at("links_mb").get<double>() * (1 << 20), 177e3 * 10);
}

TEST_F(DachsbacherTables, BenchRefusesScenesOfOtherTables) {
    const Outcome outcome = run("bench dachsbacher1 --only cloth --quiet");
    expect_one_error_line(outcome, 1);
    EXPECT_NE(outcome.err.find("office, character, oriental"), std::string::npos) << outcome.err;
    expect_one_error_line(run("bench dachsbacher1 --only horse --quiet"), 1);
}

}  // namespace
