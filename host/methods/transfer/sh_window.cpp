// Windows, and the weakest one that keeps a function above a bound.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/sh.hpp>
#include <cmath>
#include <numbers>

#include "methods/transfer/sh_check.hpp"

namespace clgi::sh {
namespace {

using std::numbers::pi;

double factor(Window kind, int l, int bands) {
    const double angle = pi * l / bands;
    switch (kind) {
        case Window::none:
            return 1.0;
        case Window::hann:
            return 0.5 * (1.0 + std::cos(angle));
        case Window::lanczos:
            return l == 0 ? 1.0 : std::sin(angle) / angle;
    }
    throw Error("sh: no such window");
}

// What each band of f adds in each direction of a grid.
std::vector<std::vector<double>> bands_on_grid(const std::vector<double>& coefficients) {
    const int bands = bands_of(coefficients.size());
    const int rows = 8 * bands, columns = 16 * bands;
    std::vector<std::vector<double>> out;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double down = pi * row / rows, across = 2.0 * pi * column / columns;
            const std::vector<double> basis =
                evaluate({std::sin(down) * std::cos(across), std::sin(down) * std::sin(across),
                          std::cos(down)},
                         bands);
            std::vector<double> added(static_cast<std::size_t>(bands), 0.0);
            for (std::size_t i = 0; i < basis.size(); ++i)
                added[static_cast<std::size_t>(degree(static_cast<int>(i)))] +=
                    coefficients[i] * basis[i];
            out.push_back(std::move(added));
        }
    return out;
}

double least_value(const std::vector<std::vector<double>>& grid, double smoothing) {
    const std::vector<double> factors =
        smoothing_window(smoothing, static_cast<int>(grid[0].size()));
    double least = HUGE_VAL;
    for (const std::vector<double>& added : grid) {
        double sum = 0.0;
        for (std::size_t l = 0; l < factors.size(); ++l) sum += factors[l] * added[l];
        least = std::min(least, sum);
    }
    return least;
}

}  // namespace

std::vector<double> window(Window kind, int bands) {
    need_bands(bands);
    std::vector<double> out;
    for (int l = 0; l < bands; ++l) out.push_back(factor(kind, l, bands));
    return out;
}

std::vector<double> smoothing_window(double smoothing, int bands) {
    need_bands(bands);
    if (!(smoothing >= 0.0))
        throw Error("sh: smoothing is " + std::to_string(smoothing) + ", at least 0 needed");
    std::vector<double> out;
    for (int l = 0; l < bands; ++l) {
        const double curved = l * (l + 1.0);
        out.push_back(l == 0 ? 1.0 : 1.0 / (1.0 + smoothing * curved * curved));
    }
    return out;
}

double least_smoothing(const std::vector<double>& coefficients, double lowest) {
    const auto grid = bands_on_grid(coefficients);
    for (const double c : coefficients)
        if (!std::isfinite(c)) throw Error("sh: a coefficient is not finite");
    if (least_value(grid, 0.0) >= lowest) return 0.0;
    double enough = 1e-6;
    while (least_value(grid, enough) < lowest) {
        enough *= 4.0;
        if (enough > 1e12)
            throw Error("sh: no smoothing brings the function above " + std::to_string(lowest));
    }
    double little = enough <= 1e-6 ? 0.0 : 0.25 * enough;
    while (enough - little > 1e-3 * enough) {
        const double middle = 0.5 * (little + enough);
        (least_value(grid, middle) < lowest ? little : enough) = middle;
    }
    return enough;
}

}  // namespace clgi::sh
