// How far a picture is from the truth, by a few path-traced pixels.
// SPDX-License-Identifier: MIT
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <clgi/reference.hpp>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include "reference/guide.hpp"
#include "reference/interval.hpp"
#include "reference/largest.hpp"
#include "reference/path.hpp"
#include "reference/pixel_draws.hpp"
#include "reference/random.hpp"
#include "reference/traced_pixel.hpp"

namespace clgi::reference {

using Clock = std::chrono::steady_clock;
using LightOf = std::function<glm::vec3(std::size_t pixel, Random& random, std::vector<Met>* met)>;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// How many pixels of each stratum are traced, and with how many samples.
struct Design {
    std::vector<int> counts;   // pixels by stratum
    std::vector<int> samples;  // of each of these pixels in a round
};

// If a and b are independent samples of a pixel and x is its value in the picture, the mean of
// (x - a)(x - b) is the squared error of the pixel. The noise of a and b is not part of it.
class Verifier {
    static constexpr int fewest_pixels = 200;           // whatever the time
    static constexpr std::size_t enough_met = 1 << 20;  // at a time, to learn from
    // No stream of render() or irradiance().
    static constexpr std::uint64_t own_seed = 0x7665726966790000u;

public:
    Verifier(const Brightness& brightness, const VerifyOptions& options, const Progress& progress,
             Paths& paths, LightOf light)
        : brightness_(brightness),
          options_(options),
          progress_(progress),
          paths_(paths),
          light_(std::move(light)),
          draws_(brightness) {}

    Verification run() {
        std::optional<tbb::global_control> limit;
        if (options_.threads > 0)
            limit.emplace(tbb::global_control::max_allowed_parallelism,
                          static_cast<std::size_t>(options_.threads));
        const bool may_end = timed() && options_.decide > 0.0;
        FirstPass first = first_pass(may_end ? soon() : options_.seconds);
        if (may_end && is_hard(first)) first = first_pass(options_.seconds);
        const Design design = design_of(first.pixels, first.seconds);
        std::vector<Traced> pixels = drawn(design.counts, 3);
        if (rounds(design, pixels)) {
            const ErrorAndEnergy found = estimate_of(pixels);
            out_.error = found.error;
            out_.energy = found.energy;
            out_.largest = largest_of(pixels, brightness_.width, 8);
        } else {
            out_.cancelled = true;
        }
        add_counts(pixels);
        out_.seconds = seconds_since(start_);
        return out_;
    }

private:
    bool timed() const { return options_.seconds > 0.0; }

    std::vector<Traced> drawn(const std::vector<int>& counts, std::uint64_t pass) const {
        Random random(options_.seed ^ own_seed, pass, 0);
        std::vector<Traced> out;
        for (const DrawnPixel& pixel : draws_.draw(counts, random)) {
            out.emplace_back();
            out.back().drawn = pixel;
            out.back().picture = double{brightness_.values[pixel.pixel]};
        }
        return out;
    }

    // pass: 1, 2, 5 or 6; 0, 3 and 4 are those of drawn(). met: [pixels], what their paths meet.
    void trace(std::vector<Traced>& pixels, std::uint64_t pass,
               const std::function<int(std::size_t stratum)>& samples,
               std::vector<std::vector<Met>>* met = nullptr) const {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, pixels.size(), 4),
            [&](const tbb::blocked_range<std::size_t>& range) {
                for (std::size_t k = range.begin(); k < range.end(); ++k) {
                    Traced& pixel = pixels[k];
                    for (int s = samples(pixel.drawn.stratum); s > 0; --s)
                        pixel.add([&](std::size_t group, std::uint32_t index) {
                            Random random =
                                Random::even(options_.seed ^ own_seed,
                                             ((k << 3) + pass) * Traced::groups + group, index);
                            const glm::vec3 light =
                                light_(pixel.drawn.pixel, random, met ? &(*met)[k] : nullptr);
                            return luminance(glm::dvec3(light));
                        });
                }
            });
    }

    // Two pixels of each of a few strata.
    std::vector<Traced> few(std::uint64_t pass) const {
        const auto strata = static_cast<std::size_t>(std::clamp(options_.pixels / 8, 2, 64));
        return drawn(std::vector<int>(strata, 2), pass);
    }

    // The horizon of what may end long before the time limit.
    double soon() const {
        constexpr double least = 1.5, share = 0.25;  // seconds, of the limit
        return std::max(share * options_.seconds, std::min(least, options_.seconds));
    }

    // Calls add(samples) for `fewest`, and with a time limit until `end` of the horizon, at most
    // eight times more. Returns the samples of a pixel.
    int take(int fewest, double end, const std::function<void(int samples)>& add) const {
        const double begin = seconds_since(start_), limit = learning_ + end * horizon_;
        int taken = fewest;
        add(fewest);
        for (int k = 0; k < 8 && seconds_since(start_) < limit; ++k) {
            const double spent = seconds_since(start_) - begin;
            const double more = taken * (limit - seconds_since(start_)) / std::max(spent, 1e-9);
            const int next = std::clamp(static_cast<int>(more), 1, 3 * taken);
            add(next);
            taken += next;
        }
        return taken;
    }

    struct FirstPass {
        std::vector<Traced> pixels;
        double seconds;
    };

    // With all that it is guided by. horizon: seconds, of which it takes a part.
    FirstPass first_pass(double horizon) {
        horizon_ = horizon;
        learning_ = seconds_since(start_);
        learn();
        const double learnt = seconds_since(start_);
        std::vector<Traced> pixels = look();
        add_counts(pixels);
        return {std::move(pixels), seconds_since(start_) - learnt};
    }

    // Whether the noise of paths takes longer than that to fall to the square of half of the error
    // to decide about: the mean of n squared differences has a deviation of about S sqrt(n) / N.
    bool is_hard(const FirstPass& first) const {
        double variance = 0.0;
        for (const Traced& pixel : first.pixels) variance += pixel.drawn.weight * pixel.variance();
        const auto count = static_cast<double>(first.pixels.size());
        const double half = 0.5 * options_.decide * draws_.mean();
        const double paths = variance / count * std::sqrt(double(options_.pixels)) / (half * half);
        return paths * first.seconds > horizon_ * count * first_samples_;
    }

    // What paths of a few pixels meet guides others, and what those meet all that follow, if there
    // is less noise with a guide. It is not part of the result.
    void learn() {
        paths_.follow(nullptr);
        std::vector<std::vector<Met>> met;
        const auto traced = [&](std::uint64_t pass, double end) {
            std::vector<Traced> pixels = few(4);
            met.resize(pixels.size());
            const auto count = [&] {
                return std::accumulate(
                    met.begin(), met.end(), std::size_t{0},
                    [](std::size_t sum, const auto& one) { return sum + one.size(); });
            };
            const std::size_t enough = count() + enough_met;
            take(8, end, [&](int samples) {
                if (count() >= enough) return;
                trace(
                    pixels, pass, [&](std::size_t) { return samples; }, &met);
            });
            std::vector<Met> all;
            for (const std::vector<Met>& one : met) all.insert(all.end(), one.begin(), one.end());
            guide_ = Guide(std::move(all));
            paths_.follow(&guide_);
            add_counts(pixels);
            double noise = 0.0;
            for (const Traced& pixel : pixels) noise += pixel.drawn.weight * pixel.variance();
            return noise;
        };
        const double alone = traced(5, 0.04), guided = traced(6, 0.12);
        if (guided > alone) paths_.follow(nullptr);
    }

    // The first pass decides where pixels and samples go. It is not part of the result, so that the
    // result is unbiased.
    std::vector<Traced> look() {
        std::vector<Traced> out = few(0);
        first_samples_ =
            take(8, 0.2, [&](int samples) { trace(out, 1, [&](std::size_t) { return samples; }); });
        return out;
    }

    // With a time limit, more pixels leave fewer paths for each. Differences between n pixels have
    // a variance of about D^2 / n, D the mean squared error; the noise of N paths with a variance S
    // each has one of about S^2 n / N^2. Their sum is least at n = N D / S. Of an error that is
    // much smaller than the one to decide about, the first pass knows little more than that.
    int pixel_count(const std::vector<Traced>& first, double first_seconds) const {
        if (!timed()) return options_.pixels;
        double square = 0.0, variance = 0.0;
        for (const Traced& pixel : first) {
            square += pixel.drawn.weight * pixel.squared_error();
            variance += pixel.drawn.weight * pixel.variance();
        }
        const auto count = static_cast<double>(first.size());
        square -= variance * std::sqrt(2.0 / count) / first_samples_;  // which noise may have made
        const double half = 0.5 * options_.decide * draws_.mean();
        square = std::max(square, count * half * half);
        const double paths =
            (options_.seconds - seconds_since(start_)) * count * first_samples_ / first_seconds;
        const double best =
            variance > 0.0 ? std::max(square, 0.0) / variance * paths : double(options_.pixels);
        const double most = std::min(paths / 16.0, double(options_.pixels));
        return std::max(std::min(fewest_pixels, options_.pixels),
                        static_cast<int>(std::min(best, most)));
    }

    Design design_of(const std::vector<Traced>& first, double first_seconds) const {
        const int pixels = pixel_count(first, first_seconds);
        // Two pixels with few samples may have missed everything, so what a stratum says of itself
        // is mixed with the mean of all.
        std::vector<double> spread(first.size() / 2), noise(first.size() / 2);
        double mean_spread = 0.0, mean_noise = 0.0;
        for (std::size_t s = 0; s < spread.size(); ++s) {
            for (const Traced* pixel : {&first[2 * s], &first[2 * s + 1]}) {
                const double weight = 0.5 * pixel->drawn.weight;
                spread[s] += weight * (std::max(pixel->squared_error(), 0.0) +
                                       pixel->variance() / first_samples_);
                noise[s] += weight * pixel->variance();
            }
            mean_spread += spread[s] / static_cast<double>(spread.size());
            mean_noise += noise[s] / static_cast<double>(spread.size());
        }
        const auto strata = static_cast<std::size_t>(std::max(pixels / 8, 2));
        const auto of = [&](std::size_t s) { return s * spread.size() / strata; };
        double sum = 0.0;
        for (std::size_t s = 0; s < strata; ++s) sum += spread[of(s)] + 0.5 * mean_spread;
        Design out;
        const int floor = pixels / static_cast<int>(strata) / 2;  // the other half by spread
        const double free = pixels - floor * static_cast<double>(strata);
        double before = 0.0;
        for (std::size_t s = 0; s < strata; ++s) {
            const double share = sum > 0.0 ? (spread[of(s)] + 0.5 * mean_spread) / sum
                                           : 1.0 / static_cast<double>(strata);
            const double after = before + free * share;
            out.counts.push_back(floor + static_cast<int>(std::floor(after + 1e-6)) -
                                 static_cast<int>(std::floor(before + 1e-6)));
            before = after;
            const double louder = mean_noise > 0.0 ? noise[of(s)] / mean_noise : 1.0;
            out.samples.push_back(
                std::clamp(static_cast<int>(std::lround(2.0 * std::cbrt(louder * louder))), 1, 8));
        }
        return out;
    }

    ErrorAndEnergy estimate_of(const std::vector<Traced>& pixels) const {
        std::vector<Draw> weighted;
        for (const Traced& pixel : pixels) weighted.push_back(pixel.weighted());
        return estimate(weighted, draws_.mean());
    }

    // 1: below, -1: above, 0: neither
    int side(const std::vector<Traced>& pixels) const {
        if (!(options_.decide > 0.0)) return 0;
        const Estimate error = estimate_of(pixels).error;
        if (error.high <= options_.decide) return 1;
        return error.low > options_.decide ? -1 : 0;
    }

    // False if cancelled.
    bool rounds(Design design, std::vector<Traced>& pixels) {
        double round = 0.0;  // samples
        for (std::size_t s = 0; s < design.counts.size(); ++s)
            round += double(design.counts[s]) * design.samples[s];
        const double most = double(options_.samples) * static_cast<double>(pixels.size());
        if (round * 2.0 > most) {  // too few for differences between strata
            std::fill(design.samples.begin(), design.samples.end(), 1);
            round = static_cast<double>(pixels.size());
        }
        const int all = static_cast<int>(std::min(most / round, 1e9));
        int done = 0, before = 0;
        int next = std::min(timed() ? 4 : std::max(all / 8, 2), all);
        while (next > 0) {
            const Clock::time_point begin = Clock::now();
            trace(pixels, 2, [&](std::size_t s) { return next * design.samples[s]; });
            done += next;
            const double spent = seconds_since(start_), one = seconds_since(begin) / next;
            double share = double(done) / all;
            next = std::min(next, all - done);
            if (timed()) {
                share = std::max(share, std::min(spent / options_.seconds, 1.0));
                const double left = options_.seconds - spent;
                next = std::min(
                    static_cast<int>(std::min(std::max(left, 0.0) / std::max(one, 1e-9), 1e9)),
                    all - done);
                // In parts, so that it can be cancelled and times may change; where it may end
                // early, each is no more than all before it.
                const int part = options_.decide > 0.0 ? done : std::max(done, next / 3);
                next = std::min(next, std::max(4, part));
            }
            // Each look may be wrong by chance: two in a row seldom are.
            const int now = next > 0 ? side(pixels) : 0;
            if (now != 0 && now == before) next = 0;
            before = now;
            if (progress_ && !progress_(next > 0 ? share : 1.0)) return false;
        }
        return true;
    }

    void add_counts(const std::vector<Traced>& pixels) {
        out_.pixels += static_cast<int>(pixels.size());
        for (const Traced& pixel : pixels) {
            out_.samples += pixel.taken;
            out_.non_finite += pixel.non_finite;
        }
    }

    const Brightness& brightness_;
    const VerifyOptions& options_;
    const Progress& progress_;
    Paths& paths_;
    const LightOf light_;
    Guide guide_{{}};
    const PixelDraws draws_;
    const Clock::time_point start_ = Clock::now();
    int first_samples_ = 0;                  // of a pixel of the first pass
    double horizon_ = 0.0, learning_ = 0.0;  // of it; when it began
    Verification out_;
};

}  // namespace clgi::reference
