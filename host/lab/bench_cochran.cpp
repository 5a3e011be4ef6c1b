// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/renderer.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "lab/bench.hpp"
#include "lab/peak.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr double low_share_wanted = 0.875;  // the paper's own setting
// A pair of light and point in image.gather: 3 subtractions, 3 dot products of 5, 2 maxima and
// their product, 5 fused multiply-adds (3 for colour, 2 in the kernel), 1 sum, 1 product, 1
// division.
constexpr double flops_per_pair = 3 + 15 + 3 + 10 + 1 + 1 + 1;

struct Row {
    std::string name;
    int positive, negative;
    double paper_fps;
    double share;  // of low-resolution pixels wanted
    std::optional<double> paper_error;
};

// With kernels that all share.
struct Bench {
    const BenchSetup& setup;
    Programs programs;
    DeviceScene scene;

    explicit Bench(const BenchSetup& all)
        : setup(all),
          programs(all.queue.getInfo<CL_QUEUE_CONTEXT>(), all.queue.getInfo<CL_QUEUE_DEVICE>()),
          scene(programs.context(), programs.device(), all.scene) {}

    std::unique_ptr<Renderer> renderer(int positive, int negative, float threshold) {
        RendererOptions options;
        options.picture.width = setup.width;
        options.picture.height = setup.height;
        options.picture.build = setup.build;
        options.second_order.emitters.vpls = positive;
        options.second_order.negative_vpls = negative;
        options.second_order.discontinuity_threshold = threshold;
        auto made = std::make_unique<Renderer>(programs, setup.queue, setup.scene, scene, options);
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
        renderer->render(bench.setup.scene.cameras.front());
        (renderer->second_order()->status().low_resolution_share > share ? high : low) = middle;
    }
    return low;  // the side with no more low-resolution pixels than wanted
}

std::vector<std::uint8_t> preview(const BenchSetup& setup, const Renderer& renderer,
                                  float exposure) {
    const cl::Context context = setup.queue.getInfo<CL_QUEUE_CONTEXT>();
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(setup.width) * setup.height * 4);
    cl::Buffer buffer(context, CL_MEM_READ_WRITE, rgba.size());
    const TonemapParams params{static_cast<std::uint32_t>(setup.width),
                               static_cast<std::uint32_t>(setup.height), renderer.stride(),
                               exposure};
    renderer.second_order()->image_passes().tonemap(setup.queue, params, renderer.radiance(),
                                                    buffer);
    setup.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, rgba.size(), rgba.data());
    return rgba;
}

// Brings the mean luminance of the picture to a mid grey of 0.18.
float grey_exposure(const Renderer& renderer) {
    const auto radiance = renderer.read_radiance();
    double sum = 0.0;
    const std::size_t pixels = radiance[0].size();
    for (std::size_t i = 0; i < pixels; ++i)
        sum += 0.2126 * radiance[0][i] + 0.7152 * radiance[1][i] + 0.0722 * radiance[2][i];
    return static_cast<float>(0.18 / std::max(sum / static_cast<double>(pixels), 1e-30));
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

BenchTable run(const BenchSetup& setup, const std::string& table, const std::vector<Row>& rows) {
    Bench bench(setup);
    const Camera& camera = setup.scene.cameras.front();
    BenchTable out;
    out.table = table;
    out.device = describe(bench.programs.device());
    out.scene = setup.scene.name;

    std::vector<std::unique_ptr<Renderer>> renderers;
    for (const Row& row : rows)
        renderers.push_back(
            bench.renderer(row.positive, row.negative, threshold_for(bench, row.share)));
    PeakMeter meter(setup.queue);
    std::vector<std::vector<double>> times(rows.size());
    std::vector<double> peaks;
    std::vector<double> gathers;
    const std::size_t most =
        std::max_element(rows.begin(), rows.end(),
                         [](const Row& a, const Row& b) {
                             return a.positive + a.negative < b.positive + b.negative;
                         }) -
        rows.begin();
    constexpr int warm_up = 3;
    for (int repeat = -warm_up; repeat < setup.repeats; ++repeat) {
        if (setup.progress && !setup.progress(double(repeat + warm_up) / (setup.repeats + warm_up)))
            throw Error("bench: cancelled");
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
    const std::vector<std::uint8_t> truth = preview(setup, *plain, exposure);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        BenchRow row;
        row.name = rows[i].name;
        row.paper = rows[i].paper_fps;
        row.clgi = 1000.0 / spread(times[i]).median;
        row.ratio = row.clgi / row.paper;
        row.unit = "frames/s";
        row.low_res_share = renderers[i]->second_order()->status().low_resolution_share;
        row.threshold = renderers[i]->options().second_order.discontinuity_threshold;
        if (rows[i].paper_error) {
            row.paper_error = rows[i].paper_error;
            row.error = rms_percent(preview(setup, *renderers[i], exposure), truth);
        }
        out.rows.push_back(row);
    }
    out.peak_gflops = spread(peaks).median;
    out.gather_gflops = spread(gathers).median;
    out.gather_fraction = out.gather_gflops / out.peak_gflops;
    return out;
}

}  // namespace

BenchTable bench_cochran1(const BenchSetup& setup) {
    std::vector<Row> rows;
    const struct {
        int positive, negative;
        double fps;
    } table[] = {{100, 50, 26.5}, {150, 0, 32.6},   {200, 100, 15.6},
                 {300, 0, 19.2},  {300, 150, 11.0}, {450, 0, 13.6}};
    for (const auto& row : table)
        rows.push_back({std::to_string(row.positive) + " + " + std::to_string(row.negative),
                        row.positive,
                        row.negative,
                        row.fps,
                        low_share_wanted,
                        {}});
    return run(setup, "cochran1", rows);
}

BenchTable bench_cochran2(const BenchSetup& setup) {
    const std::vector<Row> rows = {{"100 %", 100, 50, 42.5, 1.0, 1.5082},
                                   {"87.5 %", 100, 50, 26.5, 0.875, 0.1688},
                                   {"50 %", 100, 50, 15.4, 0.5, 0.0885},
                                   {"0 %", 100, 50, 12.6, 0.0, 0.0}};
    return run(setup, "cochran2", rows);
}

}  // namespace clgi::lab
