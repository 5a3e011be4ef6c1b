// clgi compare A B: error metrics of picture A against picture B, the truth.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.hpp"
#include "io/image_formats.hpp"
#include "report/difference.hpp"
#include "report/metrics.hpp"

namespace clgi::cli {
namespace {

struct CompareFlags {
    std::string a;
    std::string b;
    bool json = false;
    std::string difference;
    double scale = 0.0;
};

// JSON has no infinity: psnr of equal pictures and quotients by zero become null.
void print_json(const report::Comparison& c) {
    const nlohmann::ordered_json json = {
        {"rmse", c.rmse},
        {"rel_rmse", c.rel_rmse},
        {"rel_mse", c.rel_mse},
        {"psnr", c.psnr},
        {"smape", c.smape},
        {"max_abs", c.max_abs},
        {"max_at", {c.max_x, c.max_y}},
        {"mean_a", c.mean_a},
        {"mean_b", c.mean_b},
        {"energy_ratio", c.energy_ratio},
        {"nonfinite_a", c.nonfinite_a},
        {"nonfinite_b", c.nonfinite_b},
        {"width", c.width},
        {"height", c.height},
    };
    fmt::print("{}\n", json.dump(2));
}

void print_text(const report::Comparison& c) {
    fmt::print("rmse          {:.6g}\n", c.rmse);
    fmt::print("rel_rmse      {:.6g}\n", c.rel_rmse);
    fmt::print("rel_mse       {:.6g}\n", c.rel_mse);
    fmt::print("psnr          {:.4g} dB\n", c.psnr);
    fmt::print("smape         {:.6g}\n", c.smape);
    fmt::print("max_abs       {:.6g} at pixel {},{}\n", c.max_abs, c.max_x, c.max_y);
    fmt::print("mean_a        {:.6g}\n", c.mean_a);
    fmt::print("mean_b        {:.6g}\n", c.mean_b);
    fmt::print("energy_ratio  {:.6g}\n", c.energy_ratio);
    fmt::print("nonfinite     {:.6g} of A, {:.6g} of B\n", c.nonfinite_a, c.nonfinite_b);
}

void run_compare(const CompareFlags& flags) {
    const io::Image a = io::read_image(flags.a);
    const io::Image b = io::read_image(flags.b);
    const report::Comparison comparison = report::compare(a, b);
    if (!flags.difference.empty()) {
        const auto picture = report::difference_picture(a, b, flags.scale);
        io::save_png(picture.width, picture.height, picture.rgba, flags.difference);
        if (!flags.json) fmt::print("full colour   {:.6g}\n", picture.scale);
    }
    if (flags.json) {
        print_json(comparison);
    } else {
        print_text(comparison);
    }
}

}  // namespace

void add_compare(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("compare", "Error metrics of one picture against another");
    const auto flags = std::make_shared<CompareFlags>();
    command->add_option("a", flags->a, "The picture in question, .exr or .hdr")
        ->required()
        ->type_name("A");
    command->add_option("b", flags->b, "The picture that it should be")->required()->type_name("B");
    command->add_flag("--json", flags->json, "Print JSON");
    CLI::Option* difference =
        command->add_option("--difference", flags->difference,
                            "Write the signed difference as PNG: red where A is brighter");
    difference->type_name("FILE");
    command->add_option("--scale", flags->scale, "The difference that has the full colour")
        ->check(CLI::PositiveNumber)
        ->needs(difference);
    command->callback([flags] { run_compare(*flags); });
}

}  // namespace clgi::cli
