// What a sweep of second-order illumination says.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "lab/relative_error.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {

std::vector<MathMode> math_modes(const Sweep& sweep) {
    std::vector<MathMode> out;
    const std::vector<const SweepPoint*> points = points_of(sweep, "math");
    for (const SweepPoint* point : points)
        out.push_back({point->knobs.at("math"), point->knobs.at("storage"), point->milliseconds,
                       points.front()->milliseconds / point->milliseconds, point->error[one_bounce],
                       relative_error(point->picture, points.front()->picture)});
    return out;
}

std::vector<std::string> pictures_summary(const Sweep& sweep) {
    std::vector<std::string> out;
    const auto floor_line = [&](const char* series, const char* what, std::size_t truth) {
        const Floor floor = floor_of(sweep, series, "vpls", truth);
        if (!floor.setting.empty())
            out.push_back(fmt::format(
                "{}: from {} VPLs on, error against the {} reference stays at {:.2f} %.", what,
                floor.setting, sweep.truths[truth].name, 100.0 * floor.error));
    };
    floor_line("vpls, unshadowed", "Without negative VPLs", unshadowed_bounce);
    floor_line("vpls, unshadowed", "Without negative VPLs", all_light);
    floor_line("vpls", "With 150 negative VPLs", one_bounce);
    floor_line("vpls", "With 150 negative VPLs", all_light);

    const SweepPoint *none = nullptr, *best = nullptr;
    for (const SweepPoint* point : points_of(sweep, "negative-vpls")) {
        if (point->knobs.at("negative-vpls") == "0")
            none = point;
        else if (!best || point->error[all_light] < best->error[all_light])
            best = point;
    }
    if (none && best)
        out.push_back(fmt::format(
            "Negative VPLs: at {} VPLs the error against the full reference is "
            "{:.2f} % without and {:.2f} % with {} of them; against one bounce {:.2f} % and "
            "{:.2f} %.",
            none->knobs.at("vpls"), 100.0 * none->error[all_light], 100.0 * best->error[all_light],
            best->knobs.at("negative-vpls"), 100.0 * none->error[one_bounce],
            100.0 * best->error[one_bounce]));

    add_speedups(sweep, second_order_method, out);
    for (const MathMode& mode : math_modes(sweep))
        if (mode.difference > 0.0)
            out.push_back(fmt::format(
                "{} math, {} storage: {:.2f} times as fast as strict math on floats, pictures "
                "differ by {:.4f} %.",
                mode.math == "fast" ? "Fast" : "Strict", mode.storage, mode.speed,
                100.0 * mode.difference));

    const std::vector<std::string> antiradiance = antiradiance_summary(sweep);
    out.insert(out.end(), antiradiance.begin(), antiradiance.end());
    for (const char* series : {"vpls, atlas", "atlas-size, atlas"})
        add_series(sweep, series, {all_light}, "Laying out and baking, once before all frames,",
                   out);
    for (const char* series : {"mask, transfer", "interreflections, transfer"})
        add_series(sweep, series, {all_light}, "Transfer vectors, once before all frames,", out);
    for (const char* method : {light_atlas_method, dynamic_transfer_method})
        add_speedups(sweep, method, {all_light}, out);
    return out;
}

}  // namespace clgi::lab
