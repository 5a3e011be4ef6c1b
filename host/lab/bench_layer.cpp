// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kernel_source.hpp>
#include <clgi/device.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>

#include "lab/bench.hpp"
#include "lab/scenes/rooms.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr std::uint32_t layer_width = 640, layer_height = 480,
                        layer_pixels = layer_width * layer_height, layer_stride = layer_pixels;
constexpr std::uint32_t low_stride = layer_width / 4 * layer_height / 4;
constexpr std::uint32_t vpl_count = 64;
constexpr std::size_t group = 64;  // what passes take when nothing else is asked for

using Work = std::function<void()>;

struct Way {
    std::string name;
    Work by_hand, library;
};

// The kernel of a pass with its arguments, set anew each time as a caller would.
class Hand {
public:
    Hand(const cl::CommandQueue& queue, const std::string& room, const std::string& pass)
        : queue_(queue()) {
        const cl::Device device = queue.getInfo<CL_QUEUE_DEVICE>();
        cl::Program program(queue.getInfo<CL_QUEUE_CONTEXT>(), kernel_source(room + "/" + pass));
        program.build(device, compiler_options(device).c_str());
        kernel_ = cl::Kernel(program, (room + "_" + pass).c_str());
    }

    template <typename... Arguments>
    void operator()(std::size_t items, const Arguments&... arguments) const {
        cl_uint index = 0;
        (set(index++, arguments), ...);
        const std::size_t global = (items + group - 1) / group * group;
        cl_event event = nullptr;
        clEnqueueNDRangeKernel(queue_, kernel_(), 1, nullptr, &global, &group, 0, nullptr, &event);
        clReleaseEvent(event);
    }

private:
    void set(cl_uint index, const cl::Buffer& buffer) const {
        const cl_mem memory = buffer();
        clSetKernelArg(kernel_(), index, sizeof memory, &memory);
    }
    template <typename T>
    void set(cl_uint index, const T& value) const {
        clSetKernelArg(kernel_(), index, sizeof value, &value);
    }

    cl_command_queue queue_;
    cl::Kernel kernel_;
};

}  // namespace

// A 640x480 view and 64 VPLs. In every round each row is measured both ways, one straight after
// the other and in turns first, from the first call to the end on the device.
BenchTable bench_layer(const BenchSetup& setup) {
    const cl::CommandQueue& queue = setup.queue;
    const cl::Context context = setup.context();
    const cl::Device device = setup.device();
    const Scene world = box();
    const DeviceScene scene(context, device, world);
    const View view = make_view(world.cameras[0], scene.frame(), layer_width, layer_height);
    const auto upload = [&](auto values) {
        return cl::Buffer(context, values.begin(), values.end(), false);
    };
    const auto room = [&](std::size_t bytes) {
        return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    };
    std::vector<float> planes(POINT_PLANES * std::size_t{layer_stride});
    for (std::size_t i = 0; i < planes.size(); ++i) planes[i] = float(i % 977) / 977.0f - 0.5f;
    const Vpl light{{0.1f, 0.9f, 0.2f, 0.01f}, {0, -1, 0, 1e-4f}, {1, 1, 1, 1}};
    const cl::Buffer points = upload(planes);
    const cl::Buffer lights = upload(std::vector<Vpl>(vpl_count, light));
    const cl::Buffer count = upload(std::vector<cl_uint>{layer_pixels});
    const cl::Buffer irradiance = room(IRRADIANCE_PLANES * sizeof(float) * layer_stride);
    const cl::Buffer preview = room(layer_pixels * sizeof(cl_uint));
    const cl::Buffer views = upload(std::vector<View>{view});
    const ViewSpan span = span_of({view}, 0, 1);
    const RasterBuffers raster{room(layer_pixels * sizeof(cl_ulong)), {}, {}, {}, room(16)};
    const cl::Buffer low = room(POINT_PLANES * sizeof(float) * low_stride);
    const DownsampleParams down{layer_width, layer_height, layer_stride, low_stride, 4, 0, 0, 0};
    const RasterParams none{};
    const GatherParams gather{layer_stride, vpl_count, 0, 0};
    const TonemapParams tonemap{layer_width, layer_height, layer_stride, 1.0f};

    const GBufferPasses gbuffer(context, device);
    const ImagePasses image(context, device);
    const Hand clear(queue, "gbuffer", "clear"), downsample(queue, "gbuffer", "downsample");
    const Hand lit(queue, "image", "gather"), toned(queue, "image", "tonemap");
    const std::size_t packet = static_cast<std::size_t>(packet_width(device));
    std::vector<Way> ways = {
        {"gbuffer.clear",
         [&] { clear(layer_pixels / 16, none, views, raster.pixels, raster.counts); },
         [&] { gbuffer.clear(queue, span, views, raster); }},
        {"gbuffer.downsample",
         [&] { downsample(layer_width / 4 / packet * layer_height / 4, down, points, low); },
         [&] { gbuffer.downsample(queue, down, points, low); }},
        {"image.gather",
         [&] { lit(layer_pixels / packet, gather, count, points, lights, lights, irradiance); },
         [&] {
             image.gather(queue, gather, layer_pixels, count, points, lights, lights, irradiance);
         }},
        {"image.tonemap", [&] { toned(layer_pixels, tonemap, irradiance, preview); },
         [&] { image.tonemap(queue, tonemap, irradiance, preview); }}};
    Way all{"all in a row",
            [&] {
                for (std::size_t i = 0; i < 4; ++i) ways[i].by_hand();
            },
            [&] {
                for (std::size_t i = 0; i < 4; ++i) ways[i].library();
            }};
    ways.push_back(std::move(all));

    constexpr int warm_up = 5;
    struct Times {
        std::vector<double> by_hand, library, ratio;
    };
    std::vector<Times> times(ways.size());
    for (int round = -warm_up; round < setup.repeats; ++round) {
        setup.report(double(round + warm_up) / (setup.repeats + warm_up));
        for (std::size_t i = 0; i < ways.size(); ++i) {
            const bool hand_first = round % 2 == 0;
            const double first = time_frame(queue, hand_first ? ways[i].by_hand : ways[i].library);
            const double second = time_frame(queue, hand_first ? ways[i].library : ways[i].by_hand);
            if (round < 0) continue;
            times[i].by_hand.push_back(hand_first ? first : second);
            times[i].library.push_back(hand_first ? second : first);
            times[i].ratio.push_back(times[i].library.back() / times[i].by_hand.back());
        }
    }
    Json rows;
    for (std::size_t i = 0; i < ways.size(); ++i)
        rows.push_back({{"name", ways[i].name},
                        {"by_hand_ms", spread(times[i].by_hand).median},
                        {"library_ms", spread(times[i].library).median},
                        {"ratio", spread(times[i].ratio).median}});  // of the two ways, by rounds
    return {{{"rows", rows}},
            {{"pass", 20, "{name}"},
             {"by hand ms", 14, "{by_hand_ms:.4f}"},
             {"library ms", 14, "{library_ms:.4f}"},
             {"ratio", 9, "{ratio:.3f}"}},
            ""};
}

}  // namespace clgi::lab
