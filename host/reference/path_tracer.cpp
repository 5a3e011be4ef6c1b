// SPDX-License-Identifier: MIT
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <clgi/error.hpp>
#include <cmath>
#include <optional>

#include "reference/sampled_light.hpp"
#include "reference/world.hpp"

namespace clgi::reference {

namespace {

// Sums of the samples of one pixel.
struct Tally {
    glm::dvec3 sum = glm::dvec3(0.0);
    double luminance = 0.0;
    double square = 0.0;
    std::uint32_t non_finite = 0;

    void add(const glm::vec3& sample) {
        // Each channel: the sum of three bright ones may be infinite.
        if (!std::isfinite(sample.x) || !std::isfinite(sample.y) || !std::isfinite(sample.z)) {
            ++non_finite;
            return;
        }
        sum += glm::dvec3(sample);
        const auto light = double{reference::luminance(sample)};
        luminance += light;
        square += light * light;
    }
    glm::dvec3 mean(int taken) const { return sum / std::max(taken - double(non_finite), 1.0); }
    double mean_luminance(int taken) const {
        return luminance / std::max(taken - double(non_finite), 1.0);
    }
    double standard_error(int taken) const {
        const double samples = taken - double(non_finite);
        if (samples < 2) return 0.0;
        const double mean = luminance / samples;
        return std::sqrt(std::max(square / samples - mean * mean, 0.0) / (samples - 1));
    }
};

double relative_error(const std::vector<Tally>& tallies, int samples) {
    double mean = 0.0, square = 0.0;
    for (const Tally& tally : tallies) {
        mean += tally.mean_luminance(samples);
        const double error = tally.standard_error(samples);
        square += error * error;
    }
    const auto count = static_cast<double>(tallies.size());
    return mean > 0.0 ? std::sqrt(square / count) / (mean / count) : 0.0;
}

// Passes over all items, each item with randomness of its own: sums do not depend on threads.
// sample(item, random) -> radiance. Returns the samples taken of each.
template <typename Sample>
int accumulate(const Options& options, std::vector<Tally>& tallies, const Progress& progress,
               bool& cancelled, Sample&& sample) {
    std::optional<tbb::global_control> limit;
    if (options.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism,
                      static_cast<std::size_t>(options.threads));
    int taken = 0;
    while (taken < options.samples) {
        const int pass = std::min({std::max(taken, 1), 4, options.samples - taken});
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tallies.size(), 64),
                          [&](const tbb::blocked_range<std::size_t>& range) {
                              for (std::size_t item = range.begin(); item < range.end(); ++item)
                                  for (int k = taken; k < taken + pass; ++k) {
                                      Random random(options.seed, item,
                                                    static_cast<std::uint64_t>(k));
                                      tallies[item].add(sample(item, random));
                                  }
                          });
        taken += pass;
        if (progress && !progress(static_cast<double>(taken) / options.samples)) {
            cancelled = true;
            break;
        }
        if (options.target > 0.0 && taken >= Options::least_samples &&
            relative_error(tallies, taken) <= options.target)
            break;
    }
    return taken;
}

}  // namespace

void check_options(const Options& options) {
    const auto in = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(std::string("reference: ") + name + " is " + std::to_string(value) + ", " +
                        std::to_string(low) + " to " + std::to_string(high) + " needed");
    };
    in("samples", options.samples, 1, 1 << 24);
    in("target", options.target, 0, 1e9);
    in("threads", options.threads, 0, 4096);
    in("roulette_depth", options.roulette_depth, 0, 1e6);
    const Effects& effects = options.effects;
    if (!effects.shadowed && (effects.first_bounce != 1 || effects.last_bounce != 1))
        throw Error("reference: unshadowed indirect light has one bounce");
}

PathTracer::PathTracer(const Scene& scene) {
    validate(scene);
    world_ = std::make_unique<World>(scene);
}

PathTracer::~PathTracer() = default;

Picture PathTracer::render(const Camera& camera, const Options& options,
                           const Progress& progress) const {
    check_options(options);
    if (options.width < 1 || options.width > 16384 || options.height < 1 || options.height > 16384)
        throw Error("reference: the picture is " + std::to_string(options.width) + "x" +
                    std::to_string(options.height) + ", 1x1 to 16384x16384 needed");
    const auto start = std::chrono::steady_clock::now();
    const Paths paths = world_->paths(options);
    const PixelLight light(world_->geometry, world_->tracer, paths, camera, options.width,
                           options.height, options.filter);
    std::vector<Tally> tallies(static_cast<std::size_t>(options.width) *
                               static_cast<std::size_t>(options.height));

    Picture out;
    out.width = options.width;
    out.height = options.height;
    out.samples =
        accumulate(options, tallies, progress, out.cancelled,
                   [&](std::size_t pixel, Random& random) { return light(pixel, random); });
    for (const Tally& tally : tallies) {
        out.radiance.emplace_back(tally.mean(out.samples));
        out.error.push_back(static_cast<float>(tally.standard_error(out.samples)));
        out.non_finite += tally.non_finite;
    }
    out.relative_error = relative_error(tallies, out.samples);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

Irradiance PathTracer::irradiance(const std::vector<Place>& places, const Options& options,
                                  const Progress& progress) const {
    check_options(options);
    const auto start = std::chrono::steady_clock::now();
    const Paths paths = world_->paths(options);
    std::vector<Tally> tallies(places.size());
    Irradiance out;
    out.samples = accumulate(options, tallies, progress, out.cancelled,
                             [&](std::size_t item, Random& random) {
                                 return light_at(places[item], world_->geometry, paths, random);
                             });
    for (const Tally& tally : tallies) {
        out.values.emplace_back(tally.mean(out.samples));
        out.error.push_back(static_cast<float>(tally.standard_error(out.samples)));
        out.non_finite += tally.non_finite;
    }
    out.relative_error = relative_error(tallies, out.samples);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace clgi::reference
