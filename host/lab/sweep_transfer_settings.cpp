// What a sweep of dynamic transfer compares: settings, and a smooth environment.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/sweep_run.hpp"
#include "lab/sweep_transfer.hpp"

namespace clgi::lab {
namespace {

void name_setting(TransferSettings& one) {
    const MaskOptions& masks = one.options.masks;
    const CellIntegral cells = one.options.cells;
    one.method = one.looks > 0 ? transfer_sets : one.coarse > 0 ? transfer_levels : transfer_fine;
    one.knobs = {
        {"sh-order", std::to_string(masks.bands - 1)},
        {"mask", std::to_string(masks.size)},
        {"mask-block", std::to_string(masks.block)},
        {"cells", cells == CellIntegral::exact    ? "exact"
                  : cells == CellIntegral::centre ? "centre"
                                                  : "monte-carlo"},
        {"table", masks.planes == EdgePlanes::table ? std::to_string(masks.table_size) : "off"}};
    if (one.coarse > 0) {
        one.knobs["coarse"] = std::to_string(one.coarse);
        one.knobs["rings"] = std::to_string(one.options.rings);
    }
    if (one.looks > 0) one.knobs["looks"] = std::to_string(one.looks);
}

}  // namespace

std::vector<TransferSettings> transfer_settings(bool quick, std::size_t triangles, bool levels,
                                                bool moves, const BuildOptions& build) {
    const auto mask = [](TransferSettings& to, int n) { to.options.masks.size = n; };
    const auto block = [](TransferSettings& to, int n) { to.options.masks.block = n; };
    const auto cells = [](TransferSettings& to, CellIntegral way) { to.options.cells = way; };
    const auto table = [](TransferSettings& to, int n) {
        to.options.masks.planes = n > 0 ? EdgePlanes::table : EdgePlanes::exact;
        if (n > 0) to.options.masks.table_size = n;
    };
    const auto order = [](TransferSettings& to, int n) { to.options.masks.bands = n + 1; };
    const auto coarse = [](TransferSettings& to, int n) {
        to.coarse = static_cast<std::size_t>(n);
    };
    const auto rings = [](TransferSettings& to, int n) { to.options.rings = n; };
    const auto looks = [](TransferSettings& to, int n) { to.looks = n; };
    std::vector<int> counts;  // triangles of far meshes
    // Meshes below a hundred triangles are hardly the scene's any more.
    for (const std::size_t share : {128, 64, 32, 16, 8, 4})
        if (levels && triangles / share >= 100)
            counts.push_back(static_cast<int>(triangles / share));
    const bool two_levels = !counts.empty();
    const int middle = two_levels ? counts[counts.size() / 2] : 0;
    TransferSettings fine;
    fine.options.build = build;
    TransferSettings far = fine, sets = fine;
    coarse(far, middle);
    looks(sets, moves ? 16 : 1);
    SettingList<TransferSettings> list(quick, name_setting);
    list.vary("mask", fine, {8, 32}, {8, 16, 32, 64, 128}, mask);
    list.vary("mask-block", fine, {8, 2}, {8, 4, 2, 1}, block);
    list.vary("cells", fine,
              std::vector<CellIntegral>{CellIntegral::monte_carlo, CellIntegral::centre,
                                        CellIntegral::exact},
              cells);
    list.vary("table", fine, {32, 0}, {32, 64, 128, 256, 0}, table);
    list.vary("sh-order", fine, {2, 4}, {2, 3, 4, 5, 6, 7, 8}, order);
    if (two_levels) {
        list.vary("coarse", far, {counts.front(), counts.back()}, counts, coarse);
        list.vary("rings", far, {0, 1}, {0, 1, 2}, rings);
    }
    if (moves)
        list.vary("looks", sets, {2, 8}, {1, 4, 16, 64}, looks);
    else
        list.add("looks", sets);
    if (quick) return list.settings;
    for (const int size : {8, 16, 32, 64})
        for (const int width : {2, 4}) {
            TransferSettings one = fine;
            mask(one, size);
            block(one, width);
            list.add("grid", one);
            if (!two_levels) continue;
            for (const int count : {counts.front(), middle}) {
                coarse(one, count);
                list.add("grid", one);
            }
        }
    for (const int size : {8, 16, 32, 64}) {
        TransferSettings one = sets;
        mask(one, size);
        list.add("grid", one);
        if (!two_levels) continue;
        // Far away, sets of a coarse mesh are fewer and larger triangles.
        coarse(one, counts.back());
        list.add("grid", one);
    }
    return list.settings;
}

std::vector<glm::dvec3> smoothed_light(std::vector<glm::dvec3> coefficients) {
    double smoothing = 0.0;
    for (int c = 0; c < 3; ++c) {
        std::vector<double> channel;
        for (const glm::dvec3& value : coefficients) channel.push_back(value[c]);
        if (channel.front() > 0.0)
            smoothing = std::max(smoothing, sh::least_smoothing(channel, 0.0));
    }
    const int bands = sh::bands_of(coefficients.size());
    return sh::convolve(sh::smoothing_window(smoothing, bands), std::move(coefficients));
}

// Radiance is constant over a texel, so the picture lacks some of the highest bands: with 256
// texels a turn, 5e-4 of the fifth.
Environment picture_of_light(const std::vector<glm::dvec3>& coefficients, int width) {
    constexpr double pi = std::numbers::pi;
    const int bands = sh::bands_of(coefficients.size());
    Environment out;
    out.width = width;
    out.height = width / 2;
    for (int row = 0; row < out.height; ++row)
        for (int column = 0; column < out.width; ++column) {
            const double down = pi * (row + 0.5) / out.height;
            const double across = 2 * pi * (column + 0.5) / out.width - pi;
            const std::vector<double> y =
                sh::evaluate(glm::dvec3(std::sin(down) * std::sin(across), std::cos(down),
                                        -std::sin(down) * std::cos(across)),
                             bands);
            glm::dvec3 sum(0.0);
            for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * coefficients[i];
            // Between the directions that least_smoothing looks at, rounding may be left.
            out.texels.emplace_back(glm::max(sum, glm::dvec3(0.0)));
        }
    return out;
}

bool sees_sky(const glm::dvec3& irradiance, const std::vector<glm::dvec3>& light,
              const glm::vec3& normal) {
    constexpr double least = 0.01;
    const glm::dvec3 open = sh::irradiance(light, glm::dvec3(normal));
    return irradiance.x + irradiance.y + irradiance.z > least * (open.x + open.y + open.z);
}

}  // namespace clgi::lab
