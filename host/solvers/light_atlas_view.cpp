// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/kit/draw.hpp>
#include <clgi/kit/emitters.hpp>
#include <clgi/passes/atlas.hpp>
#include <clgi/passes/image.hpp>
#include <clgi/planes.hpp>
#include <clgi/solvers/light_atlas_view.hpp>

#include "opencl/check.hpp"

namespace clgi {
namespace {

LightAtlasViewOptions checked(LightAtlasViewOptions options, const DeviceScene& scene) {
    need_range<double>("light-atlas-view", "width", options.width, 1, 16384);
    need_range<double>("light-atlas-view", "height", options.height, 1, 16384);
    options.build.textures = options.build.textures && scene.needs_textures();
    return options;
}

void check(const AtlasLayout& atlas, const DeviceScene& scene) {
    const std::size_t triangles = scene.triangle_order().size();
    if (atlas.triangle_page.size() != triangles || atlas.triangle_chart.size() != triangles ||
        atlas.uvs.size() != 3 * triangles)
        throw Error("light-atlas-view: the layout is of " +
                    std::to_string(atlas.triangle_page.size()) + " triangles, the scene has " +
                    std::to_string(triangles));
    const std::size_t all =
        std::size_t(atlas.pages) * std::size_t(atlas.size) * std::size_t(atlas.size);
    for (const AtlasTexel& texel : atlas.texels)
        if (texel.texel >= all)
            throw Error("light-atlas-view: the layout lists texel " + std::to_string(texel.texel) +
                        ", its pages have " + std::to_string(all));
}

}  // namespace

struct LightAtlasView::State {
    State(const Programs& programs, const cl::CommandQueue& on, const DeviceScene& of,
          const AtlasLayout& layout, const LightAtlasViewOptions& wanted)
        : queue(on),
          scene(of),
          options(checked(wanted, of)),
          gbuffer(programs, options.build),
          atlas(programs, options.build),
          image(programs, options.build),
          emitters(scene, options.emitters, Pixels::depth),
          record(queue, "light-atlas-view") {
        check(layout, scene);
        const BufferTable all = table(layout);
        all.check(queue.getInfo<CL_QUEUE_DEVICE>(), options.memory_budget, scene.bytes());
        all.allocate(record);
        bytes = all.bytes();
        build_draw(gbuffer, scene, emitters.set().views.size());
        gbuffer.build({"clear", "raster", "raster_large", "raster_views"}, Pixels::depth);
        atlas.build({"show"});
        image.build({"combine"});
        if (options.direct && scene.environment()) image.build({"environment"});
        emitters.write(record);
        record.fill(seen.planes, 0);  // emission is written where there is some
        upload(layout);
    }

    std::size_t pixels() const {
        return static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    }

    BufferTable table(const AtlasLayout& layout) {
        const char* picture = "width and height";
        const char* size = "the size of the atlas";
        const std::size_t word = sizeof(std::uint32_t), triangles = layout.triangle_page.size();
        const Storage storage = options.build.storage;
        seen.stride = plane_stride(pixels());
        seen.storage = storage;
        map.size = static_cast<std::uint32_t>(layout.size);
        map.pages = static_cast<std::uint32_t>(layout.pages);
        map.texel_count = static_cast<std::uint32_t>(layout.texels.size());
        BufferTable t("light-atlas-view");
        emitters.add_to(t);
        add_raster_lists(t, raster, scene);
        t.add(raster.pixels, "the camera's visibility", picture, pixels() * sizeof(std::uint64_t));
        t.add(view_buffer, "the camera's view", picture, sizeof(View));
        t.add(seen.planes, "planes", picture, gbuffer_bytes(storage, seen.stride));
        t.add(seen.ids, "ids", picture, GBUFFER_ID_PLANES * seen.stride * word);
        t.add(irradiance, "irradiance", picture, irradiance_bytes(storage, seen.stride));
        t.add(radiance, "radiance", picture, RADIANCE_PLANES * seen.stride * sizeof(float));
        t.add(map.corners, "corners in the atlas", "the scene's triangles",
              3 * triangles * sizeof(glm::vec2));
        t.add(map.charts, "charts of triangles", "the scene's triangles", 2 * triangles * word);
        t.add(map.map, "the atlas's map", size,
              std::size_t{map.pages} * map.size * map.size * word);
        t.add(map.chart_of, "charts of texels", size, map.texel_count * word);
        t.add_word(bad, "counters", 0);
        return t;
    }

    void upload(const AtlasLayout& layout) {
        std::vector<glm::vec2> corners;
        std::vector<std::uint32_t> charts, chart_of;
        for (const std::uint32_t t : scene.triangle_order()) {
            for (std::size_t k = 0; k < 3; ++k)
                corners.push_back(layout.uvs[3 * std::size_t{t} + k]);
            charts.push_back(layout.triangle_page[t]);
            charts.push_back(layout.triangle_chart[t]);
        }
        std::vector<std::uint32_t> listed(std::size_t{map.pages} * map.size * map.size, ATLAS_NONE);
        for (std::size_t i = 0; i < layout.texels.size(); ++i) {
            listed[layout.texels[i].texel] = static_cast<std::uint32_t>(i);
            chart_of.push_back(layout.texels[i].chart);
        }
        const auto write = [&](const cl::Buffer& buffer, const auto& values) {
            if (!values.empty())
                record.write(buffer, values.data(), values.size() * sizeof(values[0]));
        };
        write(map.corners, corners);
        write(map.charts, charts);
        write(map.map, listed);
        write(map.chart_of, chart_of);
    }

    void show(const cl::Buffer& light, std::uint32_t light_stride) {
        const ShowParams params{static_cast<std::uint32_t>(pixels()),
                                seen.stride,
                                scene.info().triangle_count,
                                map.texel_count,
                                light_stride,
                                map.size,
                                map.pages,
                                0};
        record("atlas.show", pixels(), [&](const WaitList& wait) {
            return atlas.show(queue, params, scene, seen, map, light, irradiance, wait);
        });
    }

    void combine(const View& view) {
        CombineParams params =
            combine_params(scene, view, seen.stride, emitters.set().emitters.size(), Pixels::depth);
        params.effects |= COMBINE_INDIRECT;
        if (options.direct) {
            params.effects |= COMBINE_DIRECT | COMBINE_EMISSION;
            if (scene.has_lobes()) params.effects |= COMBINE_SPECULAR;
        }
        record("image.combine", pixels(), [&](const WaitList& wait) {
            return image.combine(queue, params, view, scene,
                                 {emitters.buffers(), seen, irradiance, radiance, bad}, wait);
        });
    }

    cl::Event render(const Camera& camera, const cl::Buffer& light, std::uint32_t light_stride,
                     const WaitList& wait) {
        const View view = make_view(camera, scene.frame(), options.width, options.height);
        record.begin(wait);
        if (options.direct) emitters.draw(record, gbuffer, raster);
        draw_gbuffer(record, gbuffer, scene, view, view_buffer, raster, seen, RESOLVE_TRIANGLE);
        show(light, light_stride);
        combine(view);
        if (options.direct && scene.environment())
            record("image.environment", pixels(), [&](const WaitList& before) {
                return image.environment(queue, environment_params(scene, seen.stride), view,
                                         scene.environment_texels(), seen.planes, radiance, before);
            });
        return record.last();
    }

    cl::CommandQueue queue;
    const DeviceScene& scene;
    LightAtlasViewOptions options;
    GBufferPasses gbuffer;
    AtlasPasses atlas;
    ImagePasses image;
    Emitters emitters;
    mutable Recorder record;
    RasterBuffers raster;
    GBuffer seen;
    AtlasMap map;
    cl::Buffer view_buffer, irradiance, radiance, bad;
    std::size_t bytes = 0;
};

LightAtlasView::LightAtlasView(const Programs& programs, const cl::CommandQueue& queue,
                               const DeviceScene& scene, const AtlasLayout& atlas,
                               const LightAtlasViewOptions& options)
    : state_(std::make_unique<State>(programs, queue, scene, atlas, options)) {}

LightAtlasView::~LightAtlasView() = default;

void LightAtlasView::lights_changed() {
    State& s = *state_;
    if (!s.emitters.update(s.options.emitters))
        throw Error("light-atlas-view: a light needs more views than before; make another view");
    s.record.forget_failed();
    s.emitters.write(s.record);
}

cl::Event LightAtlasView::render(const Camera& camera, const cl::Buffer& light,
                                 std::uint32_t light_stride, const WaitList& wait) {
    return state_->render(camera, light, light_stride, wait);
}

std::uint32_t LightAtlasView::non_finite() const { return state_->record.read_word(state_->bad); }

const std::vector<PassEvent>& LightAtlasView::events() const { return state_->record.events(); }
Interval LightAtlasView::interval() const { return state_->record.interval(); }
const LightAtlasViewOptions& LightAtlasView::options() const { return state_->options; }
const EmitterSet& LightAtlasView::emitters() const { return state_->emitters.set(); }
std::size_t LightAtlasView::bytes() const { return state_->bytes; }
std::uint32_t LightAtlasView::stride() const { return state_->seen.stride; }
const cl::Buffer& LightAtlasView::radiance() const { return state_->radiance; }
const cl::Buffer& LightAtlasView::irradiance() const { return state_->irradiance; }
const GBuffer& LightAtlasView::gbuffer() const { return state_->seen; }

}  // namespace clgi
