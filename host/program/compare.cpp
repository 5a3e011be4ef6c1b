// clgi compare A B: error metrics of picture A against picture B, the truth.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/image_formats.hpp"
#include "lab/difference.hpp"
#include "lab/flip.hpp"
#include "lab/mask.hpp"
#include "lab/metrics.hpp"
#include "program/commands.hpp"

namespace clgi::program {
namespace {

struct CompareFlags {
    std::string a;
    std::string b;
    bool json = false;
    bool no_flip = false;
    std::string mask;
    std::vector<int> region;  // empty, or x, y, width, height
    std::string difference;
    std::string shown = "difference";
    double scale = 0.0;
};

// As sweeps and --verify state them: the noise that B states of itself is not part of the error.
struct OfLuminance {
    double error = 0.0;
    double energy = 0.0;
};

// JSON has no infinity: psnr of equal pictures and quotients by zero become null.
void print_json(const lab::Comparison& c, const OfLuminance& luminance) {
    const nlohmann::ordered_json json = {
        {"rmse", c.rmse},
        {"rel_rmse", c.rel_rmse},
        {"luminance_error", luminance.error},
        {"luminance_energy", luminance.energy},
        {"rel_mse", c.rel_mse},
        {"psnr", c.psnr},
        {"smape", c.smape},
        {"flip", c.flip ? nlohmann::ordered_json(*c.flip) : nlohmann::ordered_json()},
        {"p999_abs", c.p999_abs},
        {"max_abs", c.max_abs},
        {"max_at", {c.max_x, c.max_y}},
        {"mean_a", c.mean_a},
        {"mean_b", c.mean_b},
        {"energy_ratio", c.energy_ratio},
        {"nonfinite_a", c.nonfinite_a},
        {"nonfinite_b", c.nonfinite_b},
        {"width", c.width},
        {"height", c.height},
        {"pixels", c.pixels},
    };
    fmt::print("{}\n", json.dump(2));
}

void print_text(const lab::Comparison& c, const OfLuminance& luminance) {
    fmt::print("rmse          {:.6g}\n", c.rmse);
    fmt::print("rel_rmse      {:.6g}\n", c.rel_rmse);
    fmt::print("luminance     error {:.6g}, energy {:.6g}\n", luminance.error, luminance.energy);
    fmt::print("rel_mse       {:.6g}\n", c.rel_mse);
    fmt::print("psnr          {:.4g} dB\n", c.psnr);
    fmt::print("smape         {:.6g}\n", c.smape);
    if (c.flip) fmt::print("flip          {:.6g}\n", *c.flip);
    fmt::print("p999_abs      {:.6g}\n", c.p999_abs);
    fmt::print("max_abs       {:.6g} at pixel {},{}\n", c.max_abs, c.max_x, c.max_y);
    fmt::print("mean_a        {:.6g}\n", c.mean_a);
    fmt::print("mean_b        {:.6g}\n", c.mean_b);
    fmt::print("energy_ratio  {:.6g}\n", c.energy_ratio);
    fmt::print("nonfinite     {:.6g} of A, {:.6g} of B\n", c.nonfinite_a, c.nonfinite_b);
    fmt::print("pixels        {} of {}x{}\n", c.pixels, c.width, c.height);
}

const std::map<std::string, lab::Shown>& shown_by_name() {
    static const std::map<std::string, lab::Shown> names = {{"difference", lab::Shown::difference},
                                                            {"size", lab::Shown::size},
                                                            {"flip", lab::Shown::flip}};
    return names;
}

lab::Mask mask_from(const CompareFlags& flags, const io::Image& picture) {
    lab::Mask mask = flags.mask.empty() ? lab::whole_picture(picture.width, picture.height)
                                        : lab::mask_of(io::read_image_or_png(flags.mask));
    lab::check_mask(mask, picture.width, picture.height);
    if (flags.region.empty()) return mask;
    const std::vector<int>& r = flags.region;
    return lab::within(mask, {r[0], r[1], r[2], r[3]});
}

void run_compare(const CompareFlags& flags) {
    const io::Image a = io::read_image(flags.a);
    const io::Image b = io::read_image(flags.b);
    const lab::Mask mask = mask_from(flags, b);

    lab::Comparison comparison = lab::compare(a, b, {&mask, false});
    const OfLuminance luminance = {lab::relative_error(a, b, &mask),
                                   lab::luminance_ratio(a, b, &mask)};
    std::vector<float> flip;
    if (!flags.no_flip) {
        flip = lab::hdr_flip(a, b);
        comparison.flip = lab::mean(flip, mask);
    }
    if (!flags.difference.empty()) {
        const auto picture = lab::difference_picture(
            a, b, {shown_by_name().at(flags.shown), flags.scale, &mask, &flip});
        const lab::Raster drawn = lab::with_scale_bar(picture.raster, picture.scale);
        io::save_png(drawn.width, drawn.height, drawn.rgba, flags.difference);
        if (!flags.json) fmt::print("full colour   {:.6g}\n", picture.scale.to);
    }
    if (flags.json) {
        print_json(comparison, luminance);
    } else {
        print_text(comparison, luminance);
    }
}

}  // namespace

void add_compare(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("compare", "Error metrics of one picture against another");
    const auto flags = std::make_shared<CompareFlags>();
    command->add_option("a", flags->a, "The picture to judge, .exr or .hdr")
        ->required()
        ->type_name("A");
    command->add_option("b", flags->b, "The true picture, .exr or .hdr")
        ->required()
        ->type_name("B");
    command->add_flag("--json", flags->json, "Print JSON");
    command
        ->add_option("--mask", flags->mask,
                     "Count only pixels that are not zero in this .exr, .hdr or .png")
        ->type_name("FILE")
        ->default_str("none");
    command->add_option("--region", flags->region, "Count only pixels in this rectangle")
        ->delimiter(',')
        ->expected(4)
        ->type_name("X,Y,W,H")
        ->default_str("the whole picture");
    CLI::Option* difference =
        command->add_option("--difference,--diff", flags->difference,
                            "Write a PNG of the difference, with a scale bar");
    difference->type_name("FILE")->default_str("none");
    command
        ->add_option("--show", flags->shown,
                     "What --difference shows; difference is red where A is brighter")
        ->check(CLI::IsMember(shown_by_name()))
        ->type_name("WHAT")
        ->needs(difference);
    command->add_option("--scale", flags->scale, "The difference that gets the full colour")
        ->type_name("X")
        ->default_str("from the pictures")
        ->check(CLI::PositiveNumber)
        ->needs(difference);
    command->add_flag("--no-flip", flags->no_flip, "Leave out FLIP, the slowest metric");
    command->callback([flags] {
        if (flags->no_flip && flags->shown == "flip") {
            throw CLI::ValidationError("--no-flip excludes --show flip");
        }
        run_compare(*flags);
    });
}

}  // namespace clgi::program
