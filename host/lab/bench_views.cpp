// SPDX-License-Identifier: MIT
#include "lab/bench_views.hpp"

#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/error.hpp>

#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

struct Form {
    const char* name;
    bool whole;  // a view a work-item
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

double copy_bandwidth(const cl::CommandQueue& queue, int repeats) {
    const std::size_t bytes = std::size_t{64} << 20;
    const cl::Context context = queue.getInfo<CL_QUEUE_CONTEXT>();
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

ViewsTable bench_views(const ViewsSetup& setup,
                       const std::vector<std::pair<std::string, Scene>>& scenes) {
    const cl::CommandQueue& queue = setup.queue;
    const cl::Context context = queue.getInfo<CL_QUEUE_CONTEXT>();
    const cl::Device device = queue.getInfo<CL_QUEUE_DEVICE>();
    const auto room = [&](std::size_t bytes) {
        return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
    };
    const GBufferPasses gbuffer(context, device, setup.build);
    const auto count = static_cast<std::uint32_t>(setup.hemicubes);
    const auto size = static_cast<std::uint32_t>(setup.size);
    ViewsTable table;
    table.copy_gigabytes_per_second = copy_bandwidth(queue, setup.repeats);
    double done = 0.0;
    for (const auto& [name, world] : scenes) {
        const DeviceScene scene(context, device, world);
        std::vector<float> planes = centroids(scene, world, setup.hemicubes);
        std::vector<cl_uint> chosen(count);
        for (cl_uint i = 0; i < count; ++i) chosen[i] = i;
        const cl::Buffer points(context, planes.begin(), planes.end(), true);
        const cl::Buffer which(context, chosen.begin(), chosen.end(), true);
        const cl::Buffer views = room(5 * count * sizeof(View));
        const float lift = 1e-4f * scene.frame().radius;
        const CubeParams params{count, 5, size, 0, 0, count, lift, 0.5f * lift, 0, 0, 0, 0};
        gbuffer.cubes(queue, params, points, which, views).wait();
        const ViewSpan span{0, 5 * count, size, size, std::size_t{3} * count * size * size};
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
                if (setup.progress && !setup.progress(done / (4.0 * scenes.size())))
                    throw Error("bench: cancelled");
                record.begin({});
                if (form.whole)
                    record("gbuffer.raster_views", span.count, [&](const WaitList& wait) {
                        return gbuffer.raster_views(queue, span, views, scene, buffers.pixels,
                                                    form.kind, wait);
                    });
                else
                    draw_by_lists(record, gbuffer, scene, span, views, buffers);
                record.wait();
                if (k >= 0) times.push_back(record.interval().milliseconds() / count);
            }
            const SceneInfo& info = scene.info();
            const double bytes = static_cast<double>(span.pixels / count * pixel_bytes(form.kind)) +
                                 16.0 * (info.triangle_count + info.vertex_count);
            ViewsRow row;
            row.scene = name;
            row.form = form.name;
            row.triangles = info.triangle_count;
            row.hemicube_ms = spread(times).median;
            row.triangles_per_second = 1e3 * info.triangle_count / row.hemicube_ms;
            row.gigabytes_per_second = 1e-6 * bytes / row.hemicube_ms;
            row.roof_share = row.gigabytes_per_second / table.copy_gigabytes_per_second;
            row.taken = form.whole == gbuffer.prefers_raster_views(span, scene);
            table.rows.push_back(row);
            done += 1.0;
        }
    }
    return table;
}

}  // namespace clgi::lab
