// Every pass of every room as one table: what each argument must hold, and the call. Run in order
// it is a frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/clgi.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace clgi::test {

struct PassArgument {
    const char* name;    // as messages have it
    std::string buffer;  // which of the chain's buffers
    std::size_t needed;  // bytes
};

struct PassStep {
    std::string pass;  // "image.gather"
    std::vector<PassArgument> arguments;
    std::function<cl::Event(const cl::CommandQueue&, const WaitList&)> call;
};

class PassChain {
public:
    using Allocate = std::function<cl::Buffer(std::size_t bytes)>;
    static constexpr std::uint32_t width = 37, height = 29, step = 4;

    PassChain(const cl::Context& context, const cl::Device& device, const cl::CommandQueue& queue,
              const Allocate& allocate)
        : scene_(context, device, cornell({.light = LightSource::spot})),
          gbuffer_(context, device),
          lights_(context, device),
          image_(context, device),
          parallel_(context, device),
          view_(make_view(cornell().cameras[0], scene_.frame(), width, height)),
          set_(make_emitters(scene_, {.vpls = 40, .shadow_size = 32})) {
        add_gbuffer("source", set_.views[0]);
        add_lights();
        add_gbuffer("camera", view_);
        add_image();
        for (const PassStep& one : steps)
            for (const PassArgument& argument : one.arguments) {
                std::size_t& bytes = bytes_[argument.buffer];
                bytes = std::max(bytes, argument.needed);
            }
        for (const auto& [name, bytes] : bytes_) buffers[name] = allocate(bytes);
        const auto write = [&](const char* name, const void* data, std::size_t bytes) {
            queue.enqueueWriteBuffer(buffers.at(name), CL_TRUE, 0, bytes, data);
        };
        write("emitters", set_.emitters.data(), set_.emitters.size() * sizeof(Emitter));
        write("views", set_.views.data(), set_.views.size() * sizeof(View));
        write("low_count", &low, sizeof low);
        for (const auto& [name, bytes] : bytes_)
            if (name != "emitters" && name != "views" && name != "low_count")
                queue.enqueueFillBuffer(buffers.at(name), cl_uchar{0}, 0, bytes);
        queue.finish();
    }

    PassChain(const PassChain&) = delete;  // the steps call this one's passes

    // All steps, each after the one before, the first after `wait`.
    WaitList enqueue(const cl::CommandQueue& queue, WaitList wait) const {
        WaitList events;
        for (const PassStep& one : steps) {
            events.push_back(one.call(queue, wait));
            wait = {events.back()};
        }
        return events;
    }

    // The bytes of every buffer, one after the other.
    std::vector<unsigned char> contents(const cl::CommandQueue& queue) const {
        std::vector<unsigned char> out;
        for (const auto& [name, bytes] : bytes_) {
            const std::size_t first = out.size();
            out.resize(first + bytes);
            queue.enqueueReadBuffer(buffers.at(name), CL_TRUE, 0, bytes, &out[first]);
        }
        return out;
    }

    std::vector<PassStep> steps;
    std::map<std::string, cl::Buffer> buffers;

private:
    static constexpr std::uint32_t pixels = width * height, stride = (pixels + 15) / 16 * 16;
    static constexpr std::uint32_t low = ((width + 3) / 4) * ((height + 3) / 4);
    static constexpr std::uint32_t low_stride = (low + 15) / 16 * 16;
    static constexpr std::uint32_t negative = 7;
    static std::size_t planes(std::size_t count, std::size_t of = stride) {
        return count * of * sizeof(float);
    }
    const cl::Buffer& at(const std::string& name) const { return buffers.at(name); }
    RasterBuffers raster(const std::string& who) const {
        RasterBuffers out;
        out.pixels = at(who + "_visibility");
        out.polygons = at("polygons");
        out.runs = at("runs");
        out.late = at("late");
        out.counts = at("counts_of_polygons");
        out.capacity = capacity();
        return out;
    }
    std::uint32_t capacity() const { return raster_capacity(scene_.info().triangle_count); }
    EmitterBuffers sources() const {
        return {at("emitters"), at("views"), at("source_visibility"), set_.views.size(),
                set_.pixels};
    }

    void add_gbuffer(const std::string& who, const View& view) {
        const std::size_t seen = std::size_t{view.width} * view.height * 8;
        const PassArgument visibility{"pixels", who + "_visibility", seen};
        const PassArgument views{"views", who + "_views", sizeof(View)};
        const PassArgument polygons{"polygons", "polygons", capacity() * sizeof(RasterPolygon)};
        const PassArgument runs{"runs", "runs", capacity() * sizeof(RasterRun)};
        const PassArgument late{"late", "late",
                                raster_batches(scene_.info().triangle_count) * sizeof(cl_uint)};
        const PassArgument counts{"counts", "counts_of_polygons", sizeof(RasterCount)};
        const ViewSpan span = span_of({view}, 0, 1);
        steps.push_back({"gbuffer.put_view", {views}, [=, this](auto& queue, auto& wait) {
                             return gbuffer_.put_view(queue, view, 0, at(who + "_views"), wait);
                         }});
        steps.push_back(
            {"gbuffer.clear", {views, visibility, counts}, [=, this](auto& queue, auto& wait) {
                 return gbuffer_.clear(queue, span, at(who + "_views"), raster(who), wait);
             }});
        for (const std::uint32_t stage : gbuffer_.stages(Pixels::visibility)) {
            steps.push_back({"gbuffer.raster",
                             {views, visibility, polygons, runs, late, counts},
                             [=, this](auto& queue, auto& wait) {
                                 return gbuffer_.raster(queue, span, at(who + "_views"), scene_,
                                                        stage, raster(who), wait);
                             }});
            steps.push_back({"gbuffer.raster_late",
                             {views, visibility, polygons, runs, late, counts},
                             [=, this](auto& queue, auto& wait) {
                                 return gbuffer_.raster_late(queue, span, at(who + "_views"),
                                                             scene_, stage, raster(who), wait);
                             }});
        }
        steps.push_back({"gbuffer.raster_large",
                         {views, visibility, polygons, runs, late, counts},
                         [=, this](auto& queue, auto& wait) {
                             return gbuffer_.raster_large(queue, span, at(who + "_views"), scene_,
                                                          raster(who), wait);
                         }});
    }

    void add_lights() {
        const auto count = static_cast<std::uint32_t>(set_.vpl_count);
        const AcceptParams accept{0, set_.candidates[0], count, 0};
        const PassArgument emitters{"emitters", "emitters", sizeof(Emitter)};
        const PassArgument mask{"mask", "mask", accept.candidate_count / 8};
        const PassArgument accepted{"accepted", "accepted", count * sizeof(std::uint32_t)};
        steps.push_back(
            {"lights.accept_mask", {emitters, mask}, [=, this](auto& queue, auto& wait) {
                 return lights_.accept_mask(queue, accept, at("emitters"), at("mask"), wait);
             }});
        steps.push_back(
            {"lights.accept_list", {emitters, mask, accepted}, [=, this](auto& queue, auto& wait) {
                 return lights_.accept_list(queue, accept, at("emitters"), at("mask"),
                                            at("accepted"), wait);
             }});
        steps.push_back({"lights.fetch",
                         {{"views", "views", sizeof(View)},
                          {"visibility", "source_visibility", set_.pixels * 8},
                          emitters,
                          accepted,
                          {"lights", "lights", count * sizeof(Vpl)}},
                         [=, this](auto& queue, auto& wait) {
                             return lights_.fetch(queue, {count, 1, 1.0f, 1.0f}, scene_, sources(),
                                                  at("accepted"), at("lights"), wait);
                         }});
    }

    void add_image() {
        const auto count = static_cast<std::uint32_t>(set_.vpl_count);
        const PassArgument g{"planes", "planes", planes(GBUFFER_PLANES)};
        const PassArgument points{"planes", "planes", planes(POINT_PLANES)};
        const PassArgument lit{"irradiance", "irradiance", planes(IRRADIANCE_PLANES)};
        const PassArgument light{"lights", "lights", count * sizeof(Vpl)};
        const PassArgument taken{"negative", "negative", negative * sizeof(Vpl)};
        const PassArgument flags{"flags", "flags", pixels};
        const PassArgument counts{"counts", "counts", (pixels + 511) / 512 * sizeof(cl_uint)};
        const PassArgument listed{"listed", "listed", planes(1)};
        const PassArgument listed_count{"point_count", "listed_count", 4};
        const RefineParams refine{width, height, stride, low_stride, 0.02f, 10.0f, step, 0};
        steps.push_back({"gbuffer.resolve",
                         {{"visibility", "camera_visibility", pixels * 8},
                          g,
                          {"ids", "ids", planes(GBUFFER_ID_PLANES)}},
                         [=, this](auto& queue, auto& wait) {
                             return gbuffer_.resolve(
                                 queue, view_, scene_, {stride, RESOLVE_ALL, 0, 0},
                                 at("camera_visibility"), at("planes"), at("ids"), wait);
                         }});
        const NegativeParams params{count, negative, stride, 1e-6f, 1.0f, 0, 0, 0};
        steps.push_back({"lights.negative",
                         {{"planes", "planes", planes(GBUFFER_GEOMETRIC + 3)}, light, taken},
                         [=, this](auto& queue, auto& wait) {
                             return lights_.negative(queue, params, view_, at("planes"),
                                                     at("lights"), at("negative"), wait);
                         }});
        steps.push_back({"gbuffer.downsample",
                         {points, {"points", "low_points", planes(POINT_PLANES, low_stride)}},
                         [=, this](auto& queue, auto& wait) {
                             return gbuffer_.downsample(
                                 queue, {width, height, stride, low_stride, step, 0, 0, 0},
                                 at("planes"), at("low_points"), wait);
                         }});
        const auto gather = [&](const char* of, const char* into, const char* number,
                                std::uint32_t points_stride, std::size_t most) {
            steps.push_back({"image.gather",
                             {{"point_count", number, 4},
                              {"points", of, planes(POINT_PLANES, points_stride)},
                              light,
                              taken,
                              {"irradiance", into, planes(IRRADIANCE_PLANES, points_stride)}},
                             [=, this](auto& queue, auto& wait) {
                                 return image_.gather(queue, {points_stride, count, negative, 0},
                                                      most, at(number), at(of), at("lights"),
                                                      at("negative"), at(into), wait);
                             }});
        };
        gather("low_points", "low", "low_count", low_stride, low);
        steps.push_back({"image.upsample",
                         {points,
                          {"points", "low_points", planes(POINT_PLANES, low_stride)},
                          {"low", "low", planes(IRRADIANCE_PLANES, low_stride)},
                          lit,
                          flags},
                         [=, this](auto& queue, auto& wait) {
                             return image_.upsample(queue, refine, at("planes"), at("low_points"),
                                                    at("low"), at("irradiance"), at("flags"), wait);
                         }});
        steps.push_back({"image.count", {flags, counts}, [=, this](auto& queue, auto& wait) {
                             return image_.count(queue, pixels, at("flags"), at("counts"), wait);
                         }});
        steps.push_back({"parallel.offsets",
                         {{"sums", "counts", counts.needed}},
                         [=, this](auto& queue, auto& wait) {
                             return parallel_.offsets(queue, (pixels + 511) / 512, at("counts"),
                                                      cl::Buffer(), wait);
                         }});
        steps.push_back({"image.compact",
                         {flags,
                          {"offsets", "counts", counts.needed},
                          points,
                          listed,
                          {"points", "listed_points", planes(POINT_PLANES)},
                          listed_count},
                         [=, this](auto& queue, auto& wait) {
                             return image_.compact(queue, refine, at("flags"), at("counts"),
                                                   at("planes"), at("listed"), at("listed_points"),
                                                   at("listed_count"), wait);
                         }});
        gather("listed_points", "refined", "listed_count", stride, pixels);
        steps.push_back(
            {"image.place",
             {listed_count, listed, {"refined", "refined", planes(IRRADIANCE_PLANES)}, lit},
             [=, this](auto& queue, auto& wait) {
                 return image_.place(queue, refine, at("listed_count"), at("listed"), at("refined"),
                                     at("irradiance"), wait);
             }});
        CombineParams combine{};
        combine.width = width;
        combine.height = height;
        combine.stride = stride;
        combine.emitter_count = 1;
        combine.exposure = combine.texel_bias = 1.0f;
        combine.depth_words = 2;
        combine.effects = COMBINE_DIRECT | COMBINE_INDIRECT;
        const PassArgument radiance{"radiance", "radiance", planes(RADIANCE_PLANES)};
        steps.push_back({"image.combine",
                         {{"views", "views", sizeof(View)},
                          {"visibility", "source_visibility", set_.pixels * 8},
                          {"emitters", "emitters", sizeof(Emitter)},
                          g,
                          {"ids", "ids", planes(GBUFFER_ID_PLANES)},
                          lit,
                          radiance,
                          {"non_finite", "non_finite", 4}},
                         [=, this](auto& queue, auto& wait) {
                             return image_.combine(queue, combine, view_, scene_,
                                                   {sources(),
                                                    {at("planes"), at("ids"), stride},
                                                    at("irradiance"),
                                                    at("radiance"),
                                                    at("non_finite")},
                                                   wait);
                         }});
        steps.push_back({"image.tonemap",
                         {radiance, {"preview", "preview", pixels * 4}},
                         [=, this](auto& queue, auto& wait) {
                             return image_.tonemap(queue, {width, height, stride, 1.0f},
                                                   at("radiance"), at("preview"), wait);
                         }});
    }

    DeviceScene scene_;
    GBufferPasses gbuffer_;
    LightPasses lights_;
    ImagePasses image_;
    ParallelPasses parallel_;
    View view_;
    EmitterSet set_;
    std::map<std::string, std::size_t> bytes_;
};

}  // namespace clgi::test
