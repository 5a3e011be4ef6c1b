// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/light_atlas_view.hpp>
#include <clgi/passes/atlas.hpp>
#include <cmath>

namespace clgi {
namespace {

void check_volume(const IrradianceVolume& volume) {
    const glm::dvec3& at = volume.first;
    if (!std::isfinite(at.x + at.y + at.z) || !std::isfinite(volume.spacing) ||
        !(volume.spacing > 0.0) || glm::any(glm::lessThan(volume.count, glm::ivec3(1))))
        throw Error("light-atlas-view: the volume is not finite, or has no points");
    const glm::dvec3 count(volume.count);
    const auto open = static_cast<float>(volume.open_count);
    if (double(volume.places.size()) != count.x * count.y * count.z ||
        volume.distances.size() != std::size_t{volume.open_count} * VOLUME_TEXELS ||
        !std::all_of(volume.places.begin(), volume.places.end(),
                     [&](const glm::vec4& place) {
                         return place.w < open && std::isfinite(place.x + place.y + place.z);
                     }) ||
        !std::all_of(volume.distances.begin(), volume.distances.end(),
                     [](const glm::vec2& of) { return std::isfinite(of.x + of.y); }))
        throw Error("light-atlas-view: the volume has " + std::to_string(volume.places.size()) +
                    " places and " + std::to_string(volume.distances.size()) +
                    " distances, or numbers of points, that are not those of its points");
}

void check_layout(const AtlasLayout& atlas, const DeviceScene& scene) {
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
    State(const Programs& programs, const cl::CommandQueue& queue, const DeviceScene& of,
          const AtlasLayout& layout, const LightAtlasViewOptions& options,
          const std::optional<IrradianceVolume>& within)
        : scene(of),
          picture(programs, queue, of, options, "light-atlas-view"),
          atlas(programs, picture.options().build),
          volume(within) {
        check_layout(layout, scene);
        if (volume) check_volume(*volume);
        BufferTable all = picture.table();
        add_to(all, layout);
        if (volume) add_to(all, *volume);
        picture.allocate(all);
        atlas.build({"show"});
        if (volume) atlas.build({"volume"});
        upload(layout);
    }

    void add_to(BufferTable& table, const AtlasLayout& layout) {
        const char* size = "the size of the atlas";
        const std::size_t word = sizeof(std::uint32_t), triangles = layout.triangle_page.size();
        map.size = static_cast<std::uint32_t>(layout.size);
        map.pages = static_cast<std::uint32_t>(layout.pages);
        map.texel_count = static_cast<std::uint32_t>(layout.texels.size());
        table.add(map.corners, "corners in the atlas", "the scene's triangles",
                  3 * triangles * sizeof(glm::vec2));
        table.add(map.charts, "charts of triangles", "the scene's triangles", 2 * triangles * word);
        table.add(map.map, "the atlas's map", size,
                  std::size_t{map.pages} * map.size * map.size * word);
        table.add(map.chart_of, "charts of texels", size, map.texel_count * word);
    }

    void add_to(BufferTable& table, const IrradianceVolume& grid) {
        const char* points = "the number of points";
        table.add(grid_buffers.places, "places of the volume", points,
                  grid.places.size() * sizeof(glm::vec4));
        table.add(grid_buffers.distances, "distances around its points", points,
                  grid.distances.size() * sizeof(glm::vec2));
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
                picture.record().write(buffer, values.data(), values.size() * sizeof(values[0]));
        };
        write(map.corners, corners);
        write(map.charts, charts);
        write(map.map, listed);
        write(map.chart_of, chart_of);
        if (!volume) return;
        write(grid_buffers.places, volume->places);
        write(grid_buffers.distances, volume->distances);
    }

    void show(const cl::Buffer& light, std::uint32_t light_stride) {
        const ShowParams params{static_cast<std::uint32_t>(picture.pixels()),
                                picture.stride(),
                                scene.info().triangle_count,
                                map.texel_count,
                                light_stride,
                                map.size,
                                map.pages,
                                0};
        picture.record()("atlas.show", picture.pixels(), [&](const WaitList& wait) {
            return atlas.show(picture.record().queue(), params, scene, picture.gbuffer(), map,
                              light, picture.irradiance(), wait);
        });
    }

    // Where show() found no chart.
    void show_volume(const cl::Buffer& light, std::uint32_t light_stride) {
        if (!volume) return;
        const SceneFrame& frame = scene.frame();
        const VolumeParams params{float4(frame.to_local(volume->first),
                                         static_cast<float>(1.0 / (volume->spacing * frame.scale))),
                                  static_cast<std::uint32_t>(picture.pixels()),
                                  picture.stride(),
                                  scene.info().triangle_count,
                                  static_cast<std::uint32_t>(volume->count.x),
                                  static_cast<std::uint32_t>(volume->count.y),
                                  static_cast<std::uint32_t>(volume->count.z),
                                  first_bake_point(map.texel_count),
                                  light_stride,
                                  volume->open_count,
                                  {}};
        picture.record()("atlas.volume", picture.pixels(), [&](const WaitList& wait) {
            return atlas.volume(picture.record().queue(), params, picture.gbuffer(), map.charts,
                                grid_buffers, light, picture.irradiance(), wait);
        });
    }

    const DeviceScene& scene;
    Picture picture;
    AtlasPasses atlas;
    AtlasMap map;
    VolumeBuffers grid_buffers;
    std::optional<IrradianceVolume> volume;
};

LightAtlasView::LightAtlasView(const Programs& programs, const cl::CommandQueue& queue,
                               const DeviceScene& scene, const AtlasLayout& atlas,
                               const LightAtlasViewOptions& options,
                               const std::optional<IrradianceVolume>& volume)
    : state_(std::make_unique<State>(programs, queue, scene, atlas, options, volume)) {}

LightAtlasView::~LightAtlasView() = default;

void LightAtlasView::lights_changed() { state_->picture.lights_changed(); }
void LightAtlasView::sample(std::uint32_t index) { state_->picture.sample(index); }

cl::Event LightAtlasView::render(const Camera& camera, const cl::Buffer& light,
                                 std::uint32_t light_stride, const WaitList& wait) {
    State& s = *state_;
    const View view = s.picture.begin(camera, wait);
    s.show(light, light_stride);
    s.show_volume(light, light_stride);
    s.picture.combine(view);
    return s.picture.end(view);
}

const Picture& LightAtlasView::picture() const { return state_->picture; }

}  // namespace clgi
