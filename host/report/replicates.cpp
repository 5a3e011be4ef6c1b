// SPDX-License-Identifier: MIT
#include "report/replicates.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "report/preview.hpp"
#include "scene/luminance.hpp"

namespace clgi::report {

Replicates replicate(const cl::CommandQueue& queue, SecondOrderSolver& solver, const Camera& camera,
                     int count, const std::function<bool()>& go_on) {
    if (count < 2) throw Error("replicates: at least 2 needed");
    const std::uint32_t before = solver.options().emitters.replicate;
    std::vector<double> sums[3], luminance, square;
    Replicates out;
    out.count = count;
    for (int k = 1; k <= count; ++k) {
        if (go_on && !go_on()) {
            solver.set_replicate(before);
            throw Cancelled();
        }
        solver.set_replicate(static_cast<std::uint32_t>(k));
        solver.render(camera);
        out.mean = radiance_picture(queue, solver);
        const std::size_t pixels = out.mean.channels[0].values.size();
        for (auto* plane : {&sums[0], &sums[1], &sums[2], &luminance, &square})
            plane->resize(pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            double y = 0.0;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto value = double{out.mean.channels[c].values[i]};
                sums[c][i] += value;
                y += luminance_weights[c] * value;
            }
            luminance[i] += y;
            square[i] += y * y;
        }
    }
    solver.set_replicate(before);

    io::Image::Channel error{"error.Y", {}};
    double mean = 0.0, variance = 0.0;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            out.mean.channels[c].values[i] = static_cast<float>(sums[c][i] / count);
        const double y = luminance[i] / count;
        const double spread =
            std::max(square[i] / count - y * y, 0.0) * count / (count - 1);  // of one replicate
        error.values.push_back(static_cast<float>(std::sqrt(spread / count)));
        mean += y;
        variance += spread;
    }
    out.mean.channels.push_back(std::move(error));
    const auto pixels = static_cast<double>(luminance.size());
    if (mean > 0.0) out.single_error = std::sqrt(variance / pixels) / (mean / pixels);
    out.error = out.single_error / std::sqrt(count);
    return out;
}

}  // namespace clgi::report
