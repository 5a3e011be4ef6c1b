// A batch of VPLs over a scene with an atlas, put together by hand, and both ways to fill it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "atlas_checks.hpp"
#include "drawing.hpp"
#include "vpl_tools.hpp"

namespace clgi::test {

struct HandVpl {
    glm::dvec3 position, normal;  // metres
    double area = 0.01;           // m^2
    glm::dvec3 albedo = {0.5, 0.7, 0.3};
    glm::dvec3 received = {3.0, 2.0, 5.0};  // lux
};

// One sample point a VPL, where it stands.
struct OneBatch {
    Scene scene;
    DeviceScene device_scene;
    AtlasLayout atlas;
    std::vector<HandVpl> vpls;
    std::uint32_t size, count, texels, stride, site_stride = 16;
    SiteBuffers sites;
    cl::Buffer views, depth, visibility, planes;
    MeshBuffers mesh;
    std::vector<std::uint32_t> places;  // as mesh.places

    OneBatch(const Scene& of, const AtlasLayout& layout, const std::vector<HandVpl>& lights,
             int face_size = 128)
        : scene(of),
          device_scene(on_device(of)),
          atlas(layout),
          vpls(lights),
          size(static_cast<std::uint32_t>(face_size)),
          count(static_cast<std::uint32_t>(lights.size())),
          texels(static_cast<std::uint32_t>(layout.texels.size())),
          stride(padded(layout.texels.size())) {
        upload_sites();
        upload_atlas();
        draw_hemicubes();
    }

    std::vector<std::uint32_t> device_triangles() const {
        const auto& order = device_scene.triangle_order();
        std::vector<std::uint32_t> out(order.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) out[order[i]] = i;
        return out;
    }

    void upload_sites() {
        const SceneFrame& frame = device_scene.frame();
        std::vector<Site> list(count);
        std::vector<float> place(SITE_PLANES * site_stride), power(3 * site_stride),
            samples(GBUFFER_PLANES * site_stride);
        std::vector<std::uint32_t> chosen(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            const HandVpl& vpl = vpls[i];
            const glm::vec3 at = frame.to_local(vpl.position);
            list[i] = {i, 1, static_cast<float>(vpl.area * frame.scale * frame.scale), 0};
            chosen[i] = i;
            for (int c = 0; c < 3; ++c) {
                const auto row = [&](int plane) { return (plane + c) * site_stride + i; };
                place[row(SITE_POSITION)] = samples[row(GBUFFER_POSITION)] = at[c];
                place[row(SITE_NORMAL)] = static_cast<float>(vpl.normal[c]);
                place[row(SITE_ALBEDO)] = 77.0f;  // has no part in filling
                power[row(0)] =
                    static_cast<float>(double{list[i].area} * vpl.albedo[c] * vpl.received[c]);
            }
        }
        sites.sites = upload(list);
        sites.planes = upload(place);
        sites.samples = upload(samples);
        sites.site_power = sites.sample_power = upload(power);
        sites.chosen = sites.list = upload(chosen);
        sites.listed = upload(std::vector<cl_uint>{count});
        sites.site_count = sites.sample_count = count;
        sites.stride = sites.sample_stride = site_stride;
    }

    void upload_atlas() {
        const auto device_of = device_triangles();
        std::vector<SurfaceSample> list;
        places.assign(PLACE_PLANES * stride, 0);
        for (std::uint32_t i = 0; i < texels; ++i) {
            const AtlasTexel& texel = atlas.texels[i];
            list.push_back({device_of[texel.triangle], texel.b1, texel.b2, 0.0f});
            const auto side = static_cast<std::uint32_t>(atlas.size);
            places[PLACE_CHART * stride + i] = texel.chart;
            places[PLACE_COLUMN * stride + i] = texel.texel % side;
            places[PLACE_ROW * stride + i] = texel.texel / side;
        }
        std::vector<glm::vec2> uvs(atlas.uvs.size());
        std::vector<std::uint32_t> charts(device_of.size());
        for (std::size_t t = 0; t < device_of.size(); ++t) {
            charts[device_of[t]] = atlas.triangle_chart[t];
            for (std::size_t k = 0; k < 3; ++k) uvs[3 * device_of[t] + k] = atlas.uvs[3 * t + k];
        }
        std::vector<float4> boxes;
        for (const AtlasChart& c : atlas.charts)
            boxes.emplace_back(c.column, c.row, c.column + c.width, c.row + c.height);
        mesh.uvs = upload(uvs);
        mesh.charts = upload(charts);
        mesh.boxes = upload(boxes);
        mesh.places = upload(places);
        mesh.chart_count = static_cast<std::uint32_t>(boxes.size());
        planes = empty<float>(GBUFFER_PLANES * stride);
        const cl::Buffer ids = empty<cl_int>(GBUFFER_ID_PLANES * stride);
        gbuffer_passes().surface(device().queue, device_scene, {texels, stride, 0, 0}, upload(list),
                                 {planes, ids, stride, Storage::full}, {});
    }

    void draw_hemicubes() {
        const float lift = 2e-5f * device_scene.frame().radius;
        const std::size_t pixels = std::size_t{3} * count * size * size;
        const cl::CommandQueue& queue = device().queue;
        views = empty<View>(5 * count);
        depth = empty<cl_uint>(pixels);
        visibility = empty<cl_ulong>(pixels);
        gbuffer_passes().cubes(queue,
                               {count, 5, size, 0, 0, site_stride, lift, 0.5f * lift, 0, 0, 0, 0},
                               sites.planes, sites.chosen, views);
        const ViewSpan span{0, 5 * count, size, size, pixels};
        gbuffer_passes().raster_views(queue, span, views, device_scene, depth, Pixels::depth);
        gbuffer_passes().raster_views(queue, span, views, device_scene, visibility,
                                      Pixels::visibility);
        queue.finish();
    }

    FillParams fill_params(std::uint32_t first, std::uint32_t shooters) const {
        return {first, shooters, site_stride, site_stride, texels, stride, 0, FILL_FORM_FACTORS};
    }

    // Light of each texel by channel, and its form factors: [4][stride].
    std::vector<float> gather() const {
        const cl::Buffer light = upload(std::vector<float>(3 * stride));
        const cl::Buffer filled = upload(std::vector<float>(stride));
        const cl::Buffer seen = upload(std::vector<cl_uchar>(seen_rows(count) * stride));
        atlas_passes().see(device().queue, {count, size, texels, stride, 0, 0, 0, 0}, views, depth,
                           planes, seen);
        atlas_passes().gather(device().queue, fill_params(0, count), sites, planes, seen, light,
                              filled);
        return joined(light, filled);
    }

    std::vector<float> project(std::uint32_t squares, int reach) {
        make_copies(squares);
        const cl::Buffer light = upload(std::vector<float>(3 * stride));
        const cl::Buffer filled = upload(std::vector<float>(stride));
        atlas_passes().project(device().queue, fill_params(0, count), {count, size, squares, reach},
                               sites, views, visibility, mesh, planes, light, filled);
        return joined(light, filled);
    }

    void make_copies(std::uint32_t squares) {
        const MeshParams params{count, size, squares, 0};
        mesh.corners = empty<MeshCorner>(count * MESH_CORNERS(squares));
        mesh.copies = empty<MeshCopy>(count * MESH_TRIANGLES(squares) * MESH_COPIES);
        atlas_passes().geometry(device().queue, params, device_scene, views, visibility, mesh);
        atlas_passes().replicate(device().queue, params, mesh);
        device().queue.finish();
    }

    std::vector<float> joined(const cl::Buffer& light, const cl::Buffer& filled) const {
        auto out = download<float>(light, 3 * stride);
        const auto last = download<float>(filled, stride);
        out.insert(out.end(), last.begin(), last.end());
        return out;
    }

    // Where a texel lies, metres.
    glm::dvec3 place(std::uint32_t texel) const { return place_of(scene, atlas.texels[texel]); }

    // Its shading normal.
    glm::dvec3 normal(std::uint32_t texel) const {
        const AtlasTexel& at = atlas.texels[texel];
        const auto& vertex = scene.triangles[at.triangle].vertex;
        const double weight[] = {1.0 - at.b1 - at.b2, at.b1, at.b2};
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < 3; ++k) sum += weight[k] * glm::dvec3(scene.normals[vertex[k]]);
        return glm::normalize(sum);
    }

    // What a VPL sends to a texel that it sees: three channels and the form factor.
    glm::dvec4 sent(std::uint32_t texel, const HandVpl& vpl) const {
        const glm::dvec3 d = place(texel) - vpl.position;
        const double square = glm::dot(d, d), radius2 = vpl.area / std::numbers::pi;
        const double cosines =
            std::max(0.0, glm::dot(d, vpl.normal)) * std::max(0.0, -glm::dot(d, normal(texel)));
        const double kernel = cosines * (square + radius2) /
                              (square * (square * (square + radius2) + radius2 * radius2));
        const double factor = kernel * vpl.area / std::numbers::pi;
        return glm::dvec4(factor * vpl.albedo * vpl.received, factor);
    }

    // A texel in the hemicube of VPL `i`: face, and place on its image plane.
    struct Seen {
        int face;
        glm::dvec2 at;
    };
    Seen seen(std::uint32_t texel, std::uint32_t i) const {
        const auto all = download<View>(views, 5, 5 * i);
        const SceneFrame& frame = device_scene.frame();
        const glm::dvec3 d =
            (place(texel) - frame.origin) * frame.scale - glm::dvec3(glm::vec3(all[0].eye));
        Seen out{-1, {}};
        double best = 0.0;
        for (int face = 0; face < 5; ++face) {
            const double along = glm::dot(d, glm::dvec3(glm::vec3(all[face].forward)));
            if (along <= best) continue;
            best = along;
            out = {face,
                   {glm::dot(d, glm::dvec3(glm::vec3(all[face].right))) / along,
                    glm::dot(d, glm::dvec3(glm::vec3(all[face].up))) / along}};
        }
        return out;
    }
};

// A closed cube of side 1 about the origin, seen from inside, each face in a chart of its own.
inline Scene inside_of_cube() {
    Scene out = plain_scene();
    add_box(out, glm::dvec3(-0.5), glm::dvec3(0.5), -1);
    return out;
}

}  // namespace clgi::test
