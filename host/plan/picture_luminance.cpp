// SPDX-License-Identifier: MIT
#include "plan/picture_luminance.hpp"

#include "scene/luminance.hpp"

namespace clgi {

std::vector<double> picture_luminance(const cl::CommandQueue& queue,
                                      const SecondOrderSolver& solver, const cl::Event& done) {
    const std::size_t stride = solver.stride();
    std::vector<float> planes(RADIANCE_PLANES * stride);
    const WaitList wait{done};
    queue.enqueueReadBuffer(solver.radiance(), CL_TRUE, 0, planes.size() * sizeof(float),
                            planes.data(), &wait);
    const std::size_t pixels =
        static_cast<std::size_t>(solver.options().width) * solver.options().height;
    const float* first = planes.data();
    return luminances({first, first + stride, first + 2 * stride}, pixels);
}

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return a.empty() ? 0.0 : sum / static_cast<double>(a.size());
}

}  // namespace clgi
