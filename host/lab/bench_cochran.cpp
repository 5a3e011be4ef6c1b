// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/renderer.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "lab/bench.hpp"
#include "lab/metrics.hpp"
#include "lab/preview.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr int frame_width = 640, frame_height = 480;
constexpr double low_share_wanted = 0.875;  // the paper's own setting
// A pair of light and point in image.gather: 3 subtractions, 3 dot products of 5, 2 maxima and
// their product, 5 fused multiply-adds (3 for colour, 2 in the kernel), 1 sum, 1 product, 1
// division.
constexpr double flops_per_pair = 3 + 15 + 3 + 10 + 1 + 1 + 1;

struct Pictures {
    std::string name;
    int positive, negative;
    double paper_fps;
    double share;  // of low-resolution pixels wanted
    std::optional<double> paper_error;
};

// With kernels that all share.
struct Bench {
    const BenchSetup& setup;
    const Scene& world = setup.scenes.front().second;
    Programs programs{setup.context(), setup.device()};
    DeviceScene scene{setup.context(), setup.device(), world};

    std::unique_ptr<Renderer> renderer(int positive, int negative, float threshold) {
        RendererOptions options;
        options.picture.width = frame_width;
        options.picture.height = frame_height;
        options.picture.build = setup.build;
        options.second_order.emitters.vpls = positive;
        options.second_order.negative_vpls = negative;
        options.second_order.discontinuity_threshold = threshold;
        auto made = std::make_unique<Renderer>(programs, setup.queue, world, scene, options);
        made->build();
        return made;
    }
};

// The threshold that leaves this share of the pixels at low resolution, by bisection.
float threshold_for(Bench& bench, double share) {
    if (share >= 1.0) return std::numeric_limits<float>::infinity();
    if (share <= 0.0) return 0.0f;
    float low = 1e-9f;
    float high = 4.0f;
    for (int i = 0; i < 24; ++i) {
        const float middle = std::sqrt(low * high);
        const auto renderer = bench.renderer(1, 0, middle);
        renderer->render(bench.world.cameras.front());
        (renderer->second_order()->status().low_resolution_share > share ? high : low) = middle;
    }
    return low;  // the side with no more low-resolution pixels than wanted
}

std::vector<std::uint8_t> tone_mapped(const BenchSetup& setup, const Renderer& renderer,
                                      float exposure) {
    std::vector<std::uint8_t> rgba(std::size_t{4} * frame_width * frame_height);
    cl::Buffer buffer(setup.context(), CL_MEM_READ_WRITE, rgba.size());
    const TonemapParams params{frame_width, frame_height, renderer.stride(), exposure};
    renderer.second_order()->image_passes().tonemap(setup.queue, params, renderer.radiance(),
                                                    buffer);
    setup.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, rgba.size(), rgba.data());
    return rgba;
}

// Brings the mean luminance of the picture to a mid grey of 0.18.
float grey_exposure(const Renderer& renderer) {
    const std::vector<double> luminance = luminance_of(radiance_picture(renderer));
    const double sum = std::accumulate(luminance.begin(), luminance.end(), 0.0);
    return static_cast<float>(0.18 / std::max(sum / static_cast<double>(luminance.size()), 1e-30));
}

// Root mean square difference of 8-bit pictures, per cent of full scale.
double rms_percent(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (i % 4 == 3) continue;
        const double difference = (static_cast<double>(a[i]) - b[i]) / 255.0;
        sum += difference * difference;
    }
    return 100.0 * std::sqrt(sum / (static_cast<double>(a.size()) * 0.75));
}

double gather_rate(const Renderer& renderer, double lights) {
    for (const PassTime& pass : pass_times(renderer.times()))
        if (pass.name == "image.gather_low")
            return flops_per_pair * lights * static_cast<double>(pass.items) /
                   (pass.milliseconds * 1e6);
    return 0.0;
}

Json row_json(const Pictures& wanted, const Renderer& renderer, double fps) {
    Json out = {{"name", wanted.name}, {"paper", wanted.paper_fps},
                {"clgi", fps},         {"ratio", fps / wanted.paper_fps},
                {"error", nullptr},    {"unit", "frames/s"}};
    out["low_res_share"] = renderer.second_order()->status().low_resolution_share;
    const float threshold = renderer.options().second_order.discontinuity_threshold;
    if (std::isfinite(threshold)) out["threshold"] = threshold;
    return out;
}

BenchTable run(const BenchSetup& setup, const std::vector<Pictures>& rows) {
    Bench bench{setup};
    const Camera& camera = bench.world.cameras.front();
    std::vector<std::unique_ptr<Renderer>> renderers;
    for (const Pictures& row : rows)
        renderers.push_back(
            bench.renderer(row.positive, row.negative, threshold_for(bench, row.share)));
    PeakMeter meter(setup.queue);
    std::vector<std::vector<double>> times(rows.size());
    std::vector<double> peaks;
    std::vector<double> gathers;
    const std::size_t most =
        std::max_element(rows.begin(), rows.end(),
                         [](const Pictures& a, const Pictures& b) {
                             return a.positive + a.negative < b.positive + b.negative;
                         }) -
        rows.begin();
    constexpr int warm_up = 3;
    for (int repeat = -warm_up; repeat < setup.repeats; ++repeat) {
        setup.report(double(repeat + warm_up) / (setup.repeats + warm_up));
        for (std::size_t i = 0; i < rows.size(); ++i) {
            // Every round starts with another row, so none always follows the same one.
            const std::size_t row = (i + repeat + warm_up) % rows.size();
            // The frame before left another row's data in the caches.
            const auto frame = [&] { renderers[row]->render(camera); };
            time_frame(setup.queue, frame);
            const double ms = time_frame(setup.queue, frame);
            if (repeat >= 0) times[row].push_back(ms);
            if (repeat >= 0 && row == most) {
                gathers.push_back(
                    gather_rate(*renderers[row], rows[row].positive + rows[row].negative));
                peaks.push_back(meter.gflops());
            }
        }
    }

    // The picture without the optimisation, in full at every pixel.
    const auto plain = bench.renderer(rows[0].positive, rows[0].negative, 0.0f);
    plain->render(camera);
    const float exposure = grey_exposure(*plain);
    const std::vector<std::uint8_t> truth = tone_mapped(setup, *plain, exposure);
    BenchTable out;
    const double peak = spread(peaks).median, gather = spread(gathers).median;
    out.json = {{"scene", bench.world.name},
                {"peak_gflops", peak},
                {"gather_gflops", gather},
                {"gather_fraction", gather / peak}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Json row = row_json(rows[i], *renderers[i], 1e3 / spread(times[i]).median);
        if (rows[i].paper_error) {
            row["paper_error"] = *rows[i].paper_error;
            row["error"] = rms_percent(tone_mapped(setup, *renderers[i], exposure), truth);
        }
        out.json["rows"].push_back(row);
    }
    out.note =
        "{scene}, peak {peak_gflops:.0f} GFLOP/s; gather {gather_gflops:.0f} GFLOP/s, "
        "{gather_fraction:.2f} of it\n";
    out.columns = {{"row", 12, "{name}"},
                   {"paper fps", 12, "{paper:.1f}"},
                   {"clgi fps", 12, "{clgi:.1f}"},
                   {"ratio", 9, "{ratio:.2f}"},
                   {"low-res", 10, "{low_res_share:.1f}%", 100.0},
                   {"RMS %", 12, "{error:.4f}"},
                   {"paper RMS %", 13, "{paper_error:.4f}"}};
    return out;
}

}  // namespace

BenchTable bench_cochran(const BenchSetup& setup) {
    if (setup.table ==
        "cochran2")  // with the threshold of each share; the second row is of table 1
        return run(setup, {{"100 %", 100, 50, 42.5, 1.0, 1.5082},
                           {"87.5 %", 100, 50, 26.5, low_share_wanted, 0.1688},
                           {"50 %", 100, 50, 15.4, 0.5, 0.0885},
                           {"0 %", 100, 50, 12.6, 0.0, 0.0}});
    return run(setup, {{"100 + 50", 100, 50, 26.5, low_share_wanted, {}},
                       {"150 + 0", 150, 0, 32.6, low_share_wanted, {}},
                       {"200 + 100", 200, 100, 15.6, low_share_wanted, {}},
                       {"300 + 0", 300, 0, 19.2, low_share_wanted, {}},
                       {"300 + 150", 300, 150, 11.0, low_share_wanted, {}},
                       {"450 + 0", 450, 0, 13.6, low_share_wanted, {}}});
}

}  // namespace clgi::lab
