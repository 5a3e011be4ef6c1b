// An atlas of a scene by hand, and its light looked up at points of surfaces by atlas.show.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>

#include "frames.hpp"
#include "scenes.hpp"

namespace clgi::test {

constexpr std::uint32_t no_triangle = 0xffffffffu;

struct AtlasPoint {
    std::uint32_t triangle;  // of the scene
    double b1, b2;
};

inline std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t triangle) {
    std::array<glm::dvec3, 3> out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = scene.positions[scene.triangles[triangle].vertex[k]];
    return out;
}

inline glm::dvec3 place_of(const Scene& scene, const AtlasPoint& point) {
    const auto corner = corners_of(scene, point.triangle);
    return corner[0] + point.b1 * (corner[1] - corner[0]) + point.b2 * (corner[2] - corner[0]);
}

// A scene with its atlas, and what is on the device of both.
struct ShownAtlas {
    ShownAtlas(const Scene& of, int size, AtlasUvs uvs = AtlasUvs::charts, int pages = 1)
        : world(of) {
        AtlasOptions options;
        options.most_pages = pages;
        options.size = size;
        options.uvs = uvs;
        layout = make_atlas(world, make_patches(world).triangle_patch, options);
        const std::vector<std::uint32_t>& order = scene.triangle_order();
        of_device.resize(order.size());
        std::vector<glm::vec2> corners;
        std::vector<std::uint32_t> charts, listed(texel_room(), ATLAS_NONE), chart_of;
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            of_device[order[i]] = i;
            for (std::size_t k = 0; k < 3; ++k) corners.push_back(layout.uvs[3 * order[i] + k]);
            charts.push_back(layout.triangle_page[order[i]]);
            charts.push_back(layout.triangle_chart[order[i]]);
        }
        for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
            listed[layout.texels[i].texel] = i;
            chart_of.push_back(layout.texels[i].chart);
        }
        map = {upload(corners), upload(charts), upload(listed), upload(chart_of)};
        map.size = static_cast<std::uint32_t>(layout.size);
        map.pages = static_cast<std::uint32_t>(layout.pages);
        map.texel_count = static_cast<std::uint32_t>(layout.texels.size());
        index = listed;
    }

    std::size_t texel_room() const {
        return std::size_t(layout.pages) * std::size_t(layout.size) * std::size_t(layout.size);
    }

    // light: by texel of the layout, the same function of its place in all three channels but for
    // factors 1, 2 and -3.
    std::vector<glm::vec3> operator()(const std::vector<AtlasPoint>& points,
                                      const std::vector<float>& light,
                                      Storage storage = usual_build().storage,
                                      const glm::vec3& moved = glm::vec3(0.0f)) const {
        const auto count = static_cast<std::uint32_t>(points.size());
        const std::uint32_t stride = plane_stride(count), texels = plane_stride(light.size());
        std::vector<float> planes(GBUFFER_PLANES * stride), values(3 * texels);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * stride, -1);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (points[i].triangle == no_triangle) continue;
            const glm::vec3 at = scene.frame().to_local(place_of(world, points[i])) + moved;
            for (int c = 0; c < 3; ++c) planes[c * stride + i] = at[c];
            ids[GBUFFER_TRIANGLE * stride + i] =
                static_cast<std::int32_t>(of_device[points[i].triangle]);
        }
        const float factor[3] = {1.0f, 2.0f, -3.0f};
        for (std::size_t i = 0; i < light.size(); ++i)
            for (int c = 0; c < 3; ++c) values[c * texels + i] = factor[c] * light[i];
        GBuffer gbuffer{upload(planes), upload(ids), stride, storage};
        const ShowParams params{count,           stride, scene.info().triangle_count,
                                map.texel_count, texels, map.size,
                                map.pages,       0};
        const cl::Buffer out(device().context, CL_MEM_READ_WRITE,
                             irradiance_bytes(storage, stride));
        BuildOptions build = usual_build();
        build.storage = storage;
        AtlasPasses(programs(), build)
            .show(device().queue, params, scene, gbuffer, map, upload(values), out);
        if (storage == Storage::full) return vectors(device().queue, out, stride, count);
        std::vector<glm::vec3> halves(count);
        const auto raw = download<std::uint16_t>(out, 3 * std::size_t{stride});
        for (std::uint32_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                halves[i][c] = glm::unpackHalf1x16(raw[static_cast<std::size_t>(c) * stride + i]);
        return halves;
    }

    // Where a point lies in its page, texels.
    glm::dvec2 texel_place(const AtlasPoint& point) const {
        const glm::vec2* uv = &layout.uvs[3 * std::size_t{point.triangle}];
        return glm::dvec2(uv[0]) + point.b1 * glm::dvec2(uv[1] - uv[0]) +
               point.b2 * glm::dvec2(uv[2] - uv[0]);
    }

    // The listed texels of the point's chart among the four nearest, with their weights.
    std::vector<std::pair<std::uint32_t, double>> taps(const AtlasPoint& point) const {
        std::vector<std::pair<std::uint32_t, double>> out;
        const glm::dvec2 at = texel_place(point) - 0.5, low = glm::floor(at), part = at - low;
        const std::size_t page = layout.triangle_page[point.triangle];
        const auto side = static_cast<std::size_t>(layout.size);
        for (int tap = 0; tap < 4; ++tap) {
            const int right = tap & 1, below = tap >> 1;
            const auto column =
                static_cast<std::size_t>(std::clamp(int(low.x) + right, 0, layout.size - 1));
            const auto row =
                static_cast<std::size_t>(std::clamp(int(low.y) + below, 0, layout.size - 1));
            const std::uint32_t texel = index[(page * side + row) * side + column];
            if (texel == ATLAS_NONE ||
                layout.texels[texel].chart != layout.triangle_chart[point.triangle])
                continue;
            out.push_back(
                {texel, (right ? part.x : 1.0 - part.x) * (below ? part.y : 1.0 - part.y)});
        }
        return out;
    }

    std::vector<float> light(const std::function<double(const glm::dvec3&)>& of) const {
        std::vector<float> out;
        for (const AtlasTexel& texel : layout.texels)
            out.push_back(static_cast<float>(
                of(place_of(world, AtlasPoint{texel.triangle, texel.b1, texel.b2}))));
        return out;
    }

    Scene world;
    DeviceScene scene = on_device(world);
    AtlasLayout layout;
    AtlasMap map;
    std::vector<std::uint32_t> of_device, index;
};

inline std::vector<AtlasPoint> random_points(const Scene& scene, std::size_t count) {
    Random random(4);
    std::vector<AtlasPoint> out;
    for (std::size_t i = 0; i < count; ++i) {
        const int last = static_cast<int>(scene.triangles.size()) - 1;
        const auto triangle = static_cast<std::uint32_t>(random.integer(0, last));
        const double a = std::sqrt(random(0, 1)), b = random(0, 1);
        out.push_back({triangle, a * (1.0 - b), a * b});
    }
    return out;
}

inline Scene tilted_quad() {
    Scene scene = plain_scene();
    const glm::dvec3 at(3, -2, 5), u(1.9, 0.4, -0.3), v(-0.2, 0.7, 1.1);
    add_quad(scene, {at, at + u, at + u + v, at + v});
    return scene;
}

}  // namespace clgi::test
