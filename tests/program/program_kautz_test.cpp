// bench kautz1 and kautz2, and the vectors by cast rays that errors are measured against.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/sh.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/transfer_truth.hpp"
#include "program.hpp"

namespace {

using clgi::test::Outcome;
class KautzTables : public clgi::test::Program {};

// A floor of two triangles at y = 0, and a wall beside it that reaches far up: at the middle of the
// floor it covers one side of the sky, x > 0.
clgi::Scene floor_and_wall(bool wall) {
    clgi::Scene scene;
    scene.materials.emplace_back();
    const auto quad = [&](glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        const glm::vec3 up(glm::normalize(glm::cross(b - a, c - a)));
        for (const glm::dvec3& corner : {a, b, c, d}) {
            scene.positions.push_back(corner);
            scene.normals.push_back(up);
        }
        scene.triangles.push_back({{first, first + 1, first + 2}, 0});
        scene.triangles.push_back({{first, first + 2, first + 3}, 0});
    };
    quad({-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1});
    const double far = 20.0;
    if (wall) quad({0.005, 0, -far}, {0.005, far, -far}, {0.005, far, far}, {0.005, 0, far});
    return scene;
}

// Without blockers a vector is the cosine around the normal: k_l Y_i(n). The strata leave noise
// below one in the number of strata a side.
TEST(CastTransfer, IsTheCosineWhereNothingBlocks) {
    const clgi::reference::PathTracer tracer(floor_and_wall(false));
    const auto vectors = tracer.transfer({{{0, 0, 0}, {0, 1, 0}}, {{-1, 0, -1}, {0, 1, 0}}}, 5, 64);
    const auto open = clgi::sh::around({0, 1, 0}, clgi::sh::cosine_kernel(5));
    ASSERT_EQ(vectors.size(), 50u);
    for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(vectors[i], open[i % 25], 1.0 / 64) << i;
}

// Half of the cosine is left. Mirroring the wall turns the sign of the terms that are odd in x.
TEST(CastTransfer, LosesWhatAWallCovers) {
    const clgi::reference::PathTracer tracer(floor_and_wall(true));
    const auto vectors = tracer.transfer({{{0, 0, 0}, {0, 1, 0}}}, 3, 64);
    const auto open = clgi::sh::around({0, 1, 0}, clgi::sh::cosine_kernel(3));
    EXPECT_NEAR(vectors[0], 0.5 * open[0], 1.0 / 64);
    EXPECT_NEAR(vectors[1], 0.5 * open[1], 1.0 / 64);
    // integral of -x cos over half of the hemisphere = 2/3, times sqrt(3 / 4 pi).
    EXPECT_NEAR(vectors[3], -2.0 / 3.0 * std::sqrt(3.0 / (4.0 * 3.14159265358979)), 1.0 / 64);
}

TEST(CastTransfer, RefusesStrataAndBandsOutOfRange) {
    const clgi::reference::PathTracer tracer(floor_and_wall(false));
    EXPECT_THROW(tracer.transfer({}, 5, 0), clgi::Error);
    EXPECT_THROW(tracer.transfer({}, 0), clgi::Error);
    EXPECT_THROW(tracer.transfer({}, 10), clgi::Error);
    EXPECT_TRUE(tracer.transfer({}, 5).empty());
}

TEST(TransferErrors, AreRelativeAndLeaveOutWhatIsDark) {
    const auto open = clgi::sh::around({0, 0, 1}, clgi::sh::cosine_kernel(2));
    std::vector<double> truth, vectors;
    const double sizes[] = {1.0, 0.05, 1e-4}, factors[] = {1.1, 0.8, 3.0};
    for (int k = 0; k < 3; ++k)
        for (const double c : open) {
            truth.push_back(sizes[k] * c);
            vectors.push_back(factors[k] * sizes[k] * c);
        }
    clgi::lab::TransferErrors errors;
    errors.add(vectors, truth, 2);
    const clgi::lab::TransferError error = errors.error();
    EXPECT_EQ(error.counted, 2u);
    EXPECT_EQ(error.counted_lit, 1u);
    EXPECT_EQ(error.left_out, 1u);
    EXPECT_NEAR(error.mean, 0.15, 1e-12);  // (0.1 + 0.2) / 2
    EXPECT_NEAR(error.lit, 0.1, 1e-12);
    EXPECT_NEAR(error.root, std::sqrt((0.01 + 1e-4) / (1 + 0.0025)), 1e-12);
    EXPECT_THROW(errors.add({1.0}, truth, 2), clgi::Error);
}

TEST_F(KautzTables, BenchHasTheRowsOfKautzTable1) {
    const Outcome outcome =
        run("bench kautz1 --only cloth --repeats 2 --vertices 40 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto rows = nlohmann::json::parse(outcome.out).at("rows");
    ASSERT_EQ(rows.size(), 3u);  // the paper has no visible sets of the cloth
    for (const auto& row : rows) {
        EXPECT_EQ(row.at("scene"), "cloth");
        EXPECT_EQ(row.at("vertices"), 1378);
        EXPECT_EQ(row.at("triangles"), 2560);
        EXPECT_EQ(row.at("paper_fps"), 15.5);
        EXPECT_NEAR(row.at("ratio").get<double>() * 15.5, row.at("fps").get<double>(), 1e-6);
        EXPECT_GE(row.at("low_res_triangles"), row.at("settings") == "fine" ? 0 : 150);
        EXPECT_EQ(row.at("vertices_counted").get<int>() + row.at("vertices_left_out").get<int>(),
                  8 * 40);
    }
    EXPECT_EQ(rows[2].at("listed"), 2560.0);
    // All triangles and finer masks: what is left is their pixels and the noise of the rays.
    EXPECT_LT(rows[2].at("error"), 0.02);
    EXPECT_LT(rows[2].at("error"), rows[1].at("error"));
    EXPECT_LT(rows[1].at("error"), rows[0].at("error"));
}

TEST_F(KautzTables, BenchHasTheSharesOfKautzTable2) {
    const Outcome outcome = run("bench kautz2 --only hand --repeats 1 --json --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto table = nlohmann::json::parse(outcome.out);
    ASSERT_EQ(table.at("rows").size(), 1u);
    const auto& row = table.at("rows")[0];
    double sum = 0.0, paper = 0.0;
    for (const std::string part : {"rasterization", "integration", "transform", "other"}) {
        EXPECT_GT(row.at(part), 0.0) << part;
        sum += row.at(part).get<double>();
        paper += row.at("paper_" + part).get<double>();
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_NEAR(paper, 1.0, 1e-9);
    EXPECT_GT(row.at("rasterization"), row.at("integration"));
    EXPECT_GT(table.at("gloss").at("integrate_gloss_ms"), 0.0);
    EXPECT_GT(table.at("gloss").at("besides"), table.at("gloss").at("instead"));
    expect_one_error_line(run("bench kautz1 --only horse --quiet"), 1);
}

}  // namespace
