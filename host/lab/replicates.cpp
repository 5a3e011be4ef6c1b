// SPDX-License-Identifier: MIT
#include "lab/replicates.hpp"

#include <clgi/error.hpp>
#include <cmath>

#include "lab/metrics.hpp"
#include "lab/preview.hpp"
#include "plan/picture_luminance.hpp"
#include "plan/replicate_mean.hpp"

namespace clgi::lab {

std::optional<Replicates> replicate(Renderer& renderer, const Camera& camera, int count,
                                    const Progress& progress) {
    if (count < 2) throw Error("replicates: at least 2 needed");
    SecondOrderSolver& solver = *renderer.second_order();
    const std::uint32_t before = solver.options().emitters.replicate;
    std::vector<double> sums[3];
    ReplicateMean luminance;
    Replicates out;
    out.count = count;
    for (int k = 1; k <= count; ++k) {
        if (progress && !progress(double(k - 1) / count)) {
            solver.set_replicate(before);
            return std::nullopt;
        }
        solver.set_replicate(static_cast<std::uint32_t>(k));
        renderer.render(camera);
        out.mean = radiance_picture(renderer);
        luminance.add(luminance_of(out.mean));
        for (std::size_t c = 0; c < 3; ++c) {
            const std::vector<float>& values = out.mean.channels[c].values;
            sums[c].resize(values.size());
            for (std::size_t i = 0; i < values.size(); ++i) sums[c][i] += double{values[i]};
        }
    }
    solver.set_replicate(before);

    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < sums[c].size(); ++i)
            out.mean.channels[c].values[i] = static_cast<float>(sums[c][i] / count);
    const std::vector<double> variance = luminance.variance();
    io::Image::Channel error{"error.Y", {}};
    for (const double each : variance) error.values.push_back(static_cast<float>(std::sqrt(each)));
    out.mean.channels.push_back(std::move(error));
    const double level = clgi::mean(luminance.mean());
    if (level > 0.0) out.error = std::sqrt(clgi::mean(variance)) / level;
    out.single_error = out.error * std::sqrt(count);
    return out;
}

}  // namespace clgi::lab
