// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>

#include "lab/bench.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr std::uint32_t face_size = 256;  // pixels, side of a whole face
constexpr std::uint32_t view_cubes = 32;  // drawn together, around centroids of triangles

// A view a work-item ("views"), or triangles in parallel with lists of large ones ("lists"); depth
// alone, or depth with triangle ("visibility").
struct Form {
    const char* name;
    bool whole;
    Pixels kind;
};

constexpr Form forms[] = {{"views, depth", true, Pixels::depth},
                          {"views, visibility", true, Pixels::visibility},
                          {"lists, depth", false, Pixels::depth},
                          {"lists, visibility", false, Pixels::visibility}};

// Centroids and normals of `count` triangles spread over the scene, as planes of points.
std::vector<float> centroids(const DeviceScene& scene, const Scene& world, int count) {
    std::vector<float> planes(POINT_PLANES * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        const std::size_t t = (2 * i + 1) * world.triangles.size() / (2 * count);
        const auto& v = world.triangles[scene.triangle_order()[t]].vertex;
        const glm::dvec3 a = world.positions[v[0]], b = world.positions[v[1]],
                         c = world.positions[v[2]];
        const glm::vec3 at = scene.frame().to_local((a + b + c) / 3.0);
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const glm::vec3 normal = glm::length(n) > 0.0 ? glm::normalize(n) : glm::dvec3(0, 1, 0);
        for (int d = 0; d < 3; ++d) {
            planes[static_cast<std::size_t>(d * count + i)] = at[d];
            planes[static_cast<std::size_t>((GBUFFER_NORMAL + d) * count + i)] = normal[d];
        }
    }
    return planes;
}

// Gigabytes a second, read and written.
double copy_bandwidth(const cl::CommandQueue& queue, const cl::Context& context, int repeats) {
    const std::size_t bytes = std::size_t{64} << 20;
    const cl::Buffer from(context, CL_MEM_READ_WRITE, bytes), to(context, CL_MEM_READ_WRITE, bytes);
    queue.enqueueFillBuffer(from, cl_uint{1}, 0, bytes);
    std::vector<double> times;
    for (int k = 0; k < repeats + 2; ++k) {
        cl::Event event;
        queue.enqueueCopyBuffer(from, to, 0, 0, bytes, nullptr, &event);
        event.wait();
        if (k >= 2) times.push_back(interval({event}).milliseconds());
    }
    return 2e-6 * static_cast<double>(bytes) / spread(times).median;
}

}  // namespace

BenchTable bench_views(const BenchSetup& setup) {
    const cl::CommandQueue& queue = setup.queue;
    const cl::Context context = setup.context();
    const cl::Device device = setup.device();
    const auto room = [&](std::size_t bytes) {
        return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    };
    const GBufferPasses gbuffer(context, device, setup.build);
    const double copy = copy_bandwidth(queue, context, setup.repeats);
    BenchTable table;
    table.json = {{"copy_gigabytes_per_second", copy}};
    double done = 0.0;
    for (const auto& [name, world] : setup.scenes) {
        const DeviceScene scene(context, device, world);
        std::vector<float> planes = centroids(scene, world, view_cubes);
        std::vector<cl_uint> chosen(view_cubes);
        for (cl_uint i = 0; i < view_cubes; ++i) chosen[i] = i;
        const cl::Buffer points(context, planes.begin(), planes.end(), true);
        const cl::Buffer which(context, chosen.begin(), chosen.end(), true);
        const cl::Buffer views = room(5 * view_cubes * sizeof(View));
        const float lift = 1e-4f * scene.frame().radius;
        const CubeParams params{view_cubes, 5,           face_size, 0, 0, view_cubes,
                                lift,       0.5f * lift, 0,         0, 0, 0};
        gbuffer.cubes(queue, params, points, which, views).wait();
        const ViewSpan span{0, 5 * view_cubes, face_size, face_size,
                            std::size_t{3} * view_cubes * face_size * face_size};
        for (const Form& form : forms) {
            RasterBuffers buffers;
            buffers.kind = form.kind;
            buffers.pixels = room(span.pixels * pixel_bytes(form.kind));
            Recorder record(queue, "bench");
            if (!form.whole) {
                BufferTable lists("bench");
                add_raster_lists(lists, buffers, scene, 5);
                lists.allocate(record);
            }
            std::vector<double> times;
            for (int k = -2; k < setup.repeats; ++k) {
                setup.report(done / (4.0 * setup.scenes.size()));
                record.begin({});
                if (form.whole)
                    record("gbuffer.raster_views", span.count, [&](const WaitList& wait) {
                        return gbuffer.raster_views(queue, span, views, scene, buffers.pixels,
                                                    form.kind, wait);
                    });
                else
                    draw_by_lists(record, gbuffer, scene, span, views, buffers);
                record.wait();
                if (k >= 0) times.push_back(record.interval().milliseconds() / view_cubes);
            }
            const SceneInfo& info = scene.info();
            // The least that must move: each face written once, each triangle and vertex read once
            // a hemicube.
            const double bytes =
                static_cast<double>(span.pixels / view_cubes * pixel_bytes(form.kind)) +
                16.0 * (info.triangle_count + info.vertex_count);
            const double ms = spread(times).median, rate = 1e-6 * bytes / ms;
            table.json["rows"].push_back(
                {{"scene", name},
                 {"form", form.name},
                 {"triangles", info.triangle_count},
                 {"hemicube_ms", ms},
                 {"triangles_per_second", 1e3 * info.triangle_count / ms},
                 {"gigabytes_per_second", rate},
                 {"roof_share", rate / copy},
                 {"taken", form.whole == gbuffer.prefers_raster_views(span, scene)}});
            done += 1.0;
        }
    }
    table.note = "hemicubes of 256x256, copy {copy_gigabytes_per_second:.1f} GB/s\n";
    table.columns = {{"scene", 20, "{scene}"},
                     {"triangles", 10, "{triangles:.0f}"},
                     {"form", 19, "{form}"},
                     {"taken", 7, "{taken}"},
                     {"ms", 8, "{hemicube_ms:.3f}"},
                     {"Mtri/s", 12, "{triangles_per_second:.1f}", 1e-6},
                     {"GB/s", 9, "{gigabytes_per_second:.2f}"},
                     {"share", 9, "{roof_share:.1f}%", 100.0}};
    return table;
}

}  // namespace clgi::lab
