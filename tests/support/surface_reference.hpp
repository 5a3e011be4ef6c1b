// What a pixel shows of a known triangle, in double precision: docs/materials.md and the comments
// of clgi/shared/gbuffer.h, written a second time. The triangle is taken from the picture; which
// one is seen is other tests' business.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "drawing.hpp"
#include "texture_reference.hpp"

namespace clgi::test {

struct PixelRay {
    glm::dvec3 origin, direction;  // direction with component 1 along the view's axis
};

// Through a place of the image in pixels, the upper left corner at 0.
inline PixelRay pixel_ray(const View& view, double column, double row) {
    const double x = column * 2.0 / view.width - 1.0, y = 1.0 - row * 2.0 / view.height;
    const glm::dvec3 aside =
        glm::dvec3(view.right) * (x * double{view.right.w} + double{view.window.x}) +
        glm::dvec3(view.up) * (y * double{view.up.w} + double{view.window.y});
    const glm::dvec3 eye(view.eye), forward(view.forward);
    return view.eye.w == 0.0f ? PixelRay{eye, forward + aside} : PixelRay{eye + aside, forward};
}

struct SurfaceTruth {
    glm::dvec3 weights;  // barycentric, of the triangle's plane: not cut off at its edges
    glm::dvec3 position, geometric, normal, albedo, emission;
    double alpha = 1.0;
    double depth = 0.0;
    double slant = 0.0;          // cosine between ray and geometric normal
    double shading_slant = 0.0;  // and the shading normal, before one that faces away gives way
    bool front = false;
    bool near_border = false;  // of a nearest texel
};

// What normal and finish textures make of a pixel.
struct DetailTruth {
    bool mapped = false, finished = false;
    glm::dvec3 normal{0};  // towards the viewer
    glm::dvec2 finish{0};  // metalness, roughness
    double certain = 1.0;  // the least length that was brought to 1, of a length around 1
    bool bent = false, mirrored = false;
};

// value(vertex) of the three corners, weighed.
template <typename Value>
auto between(const SceneTriangle& t, const glm::dvec3& weights, const Value& value) {
    return weights[0] * value(t.vertex[0]) + weights[1] * value(t.vertex[1]) +
           weights[2] * value(t.vertex[2]);
}

class SurfaceReference {
public:
    SurfaceReference(const Scene& scene, const DeviceScene& placed)
        : scene_(scene), frame_(placed.frame()), textures_(read_textures(placed)) {}

    SurfaceTruth at(const View& view, int triangle, double column, double row) const {
        const SceneTriangle& corners = scene_.triangles[static_cast<std::size_t>(triangle)];
        const Material& material = scene_.materials[corners.material];
        const PixelRay ray = pixel_ray(view, column, row);
        SurfaceTruth out;
        const glm::dvec3 wound = normal_of(corners);
        out.weights = weights(corners, ray);
        out.position = between(corners, out.weights, [&](std::uint32_t v) { return local(v); });
        out.depth = glm::dot(out.position - glm::dvec3(view.eye), glm::dvec3(view.forward));
        const glm::dvec3 along = glm::normalize(ray.direction);
        out.front = glm::dot(wound, along) < 0.0;
        const double side = out.front ? 1.0 : -1.0;
        out.geometric = side * wound;
        out.slant = -glm::dot(out.geometric, along);
        const glm::dvec3 shading = side * between(corners, out.weights, [&](std::uint32_t v) {
                                       return glm::dvec3(scene_.normals[v]);
                                   });
        const double length = glm::length(shading);
        out.shading_slant = length > 0.0 ? -glm::dot(shading, along) / length : 0.0;
        out.normal = out.shading_slant > 0.0 ? shading / length : out.geometric;

        glm::dvec4 base(material.base_color);
        if (!scene_.colors.empty())
            base *= between(corners, out.weights,
                            [&](std::uint32_t v) { return glm::dvec4(scene_.colors[v]); });
        // Masks are those of the finest level.
        out.alpha =
            base.w * textured(material.base_texture, view, corners, column, row, out, false).w;
        base *= textured(material.base_texture, view, corners, column, row, out);
        out.albedo = glm::dvec3(base);  // base colour: a G-buffer keeps no shares
        out.emission = glm::dvec3(material.emission) / frame_.exposure;
        if (out.emission != glm::dvec3(0.0))
            out.emission *=
                glm::dvec3(textured(material.emission_texture, view, corners, column, row, out));
        return out;
    }

    // truth: of the same pixel.
    DetailTruth detail(const View& view, int triangle, double column, double row,
                       SurfaceTruth& truth) const {
        const SceneTriangle& t = scene_.triangles[static_cast<std::size_t>(triangle)];
        const Material& material = scene_.materials[t.material];
        DetailTruth out;
        const TextureSlot &normal = material.normal_texture,
                          &finish = material.metallic_roughness_texture;
        out.finished = finish.texture >= 0;
        if (out.finished) {
            const glm::dvec4 texel = textured(finish, view, t, column, row, truth);
            out.finish =
                glm::dvec2(material.metallic_roughness_factor) * glm::dvec2(texel.z, texel.y);
        }
        if (normal.texture < 0) return out;
        out.mapped = true;
        // Along the surface u grows in the direction that keeps v, which is across v's gradient.
        const glm::dvec3 wound = normal_of(t), a = local(t.vertex[0]);
        const glm::dvec3 e1 = local(t.vertex[1]) - a, e2 = local(t.vertex[2]) - a;
        const glm::dvec2 at[3] = {uv(normal, t, {1, 0, 0}), uv(normal, t, {0, 1, 0}),
                                  uv(normal, t, {0, 0, 1})};
        const auto gradient = [&](int c) {
            const glm::dvec3 of_e1 = glm::cross(e2, wound), of_e2 = glm::cross(wound, e1);
            return of_e1 * (at[1][c] - at[0][c]) / glm::dot(of_e1, e1) +
                   of_e2 * (at[2][c] - at[0][c]) / glm::dot(of_e2, e2);
        };
        const glm::dvec3 up_u = gradient(0), up_v = gradient(1);
        out.mirrored = glm::dot(glm::cross(up_u, up_v), wound) > 0.0;
        const glm::dvec3 along =
            glm::normalize(glm::cross(up_v, wound)) * (out.mirrored ? 1.0 : -1.0);
        const glm::dvec3 n = truth.normal * (truth.front ? 1.0 : -1.0);
        const glm::dvec3 flat = along - n * glm::dot(along, n);
        const glm::dvec3 tangent = glm::normalize(flat);
        const glm::dvec3 bitangent = glm::cross(n, tangent) * (out.mirrored ? -1.0 : 1.0);
        const glm::dvec3 read =
            2.0 * glm::dvec3(textured(normal, view, t, column, row, truth)) - 1.0;
        glm::dvec3 found =
            double{material.normal_scale} * (read.x * tangent + read.y * bitangent) + read.z * n;
        out.certain = std::min(glm::length(flat), glm::length(found));
        found = glm::normalize(found) * (truth.front ? 1.0 : -1.0);
        const glm::dvec3 sight = glm::normalize(pixel_ray(view, column, row).direction);
        const double cosine = -glm::dot(found, sight);
        out.bent = cosine < 0.01;
        if (out.bent) found -= sight * (0.01 - cosine);
        out.normal = glm::normalize(found);
        out.certain = std::min(out.certain, glm::length(found));
        return out;
    }

private:
    // As the device has them: positions are rounded once.
    glm::dvec3 local(std::uint32_t vertex) const {
        return glm::dvec3(frame_.to_local(scene_.positions[vertex]));
    }

    glm::dvec3 normal_of(const SceneTriangle& t) const {
        const glm::dvec3 a = local(t.vertex[0]);
        return glm::normalize(glm::cross(local(t.vertex[1]) - a, local(t.vertex[2]) - a));
    }

    glm::dvec3 weights(const SceneTriangle& t, const PixelRay& ray) const {
        const glm::dvec3 a = local(t.vertex[0]);
        const glm::dvec3 u = local(t.vertex[1]) - a, v = local(t.vertex[2]) - a;
        const glm::dvec3 n = glm::cross(u, v);
        const double depth = glm::dot(a - ray.origin, n) / glm::dot(ray.direction, n);
        const glm::dvec3 at = ray.origin + depth * ray.direction - a;
        const double b = glm::dot(glm::cross(at, v), n) / glm::dot(n, n);
        const double c = glm::dot(glm::cross(u, at), n) / glm::dot(n, n);
        return {1.0 - b - c, b, c};
    }

    glm::dvec2 uv(const TextureSlot& slot, const SceneTriangle& t, const glm::dvec3& w) const {
        const glm::dvec4 both =
            between(t, w, [&](std::uint32_t v) { return glm::dvec4(scene_.uvs[v]); });
        const glm::dvec2 own =
            slot.uv_set == 0 ? glm::dvec2(both.x, both.y) : glm::dvec2(both.z, both.w);
        return glm::dvec2(glm::dmat3(slot.transform) * glm::dvec3(own, 1.0));
    }

    // The area of UV space under the pixel from differences over a hundredth of one.
    glm::dvec4 textured(const TextureSlot& slot, const View& view, const SceneTriangle& t,
                        double column, double row, SurfaceTruth& truth,
                        bool filtered = true) const {
        if (slot.texture < 0 || scene_.uvs.empty()) return glm::dvec4(1.0);
        const auto place = [&](double right, double down) {
            return uv(slot, t, weights(t, pixel_ray(view, column + right, row + down)));
        };
        const double step = 0.005;
        const glm::dvec2 across = (place(step, 0) - place(-step, 0)) / (2 * step);
        const glm::dvec2 along = (place(0, step) - place(0, -step)) / (2 * step);
        const double area = filtered ? std::abs(across.x * along.y - across.y * along.x) : 0.0;
        const TextureTexel texel = sampled_texture(textures_, slot.texture, place(0, 0), area);
        truth.near_border = truth.near_border || texel.near_border;
        return texel.color;
    }

    const Scene& scene_;
    SceneFrame frame_;
    Textures textures_;
};

// The same view at every packet width. visit(drawing, first, width)
template <typename Visit>
void draw_at_every_width(const DeviceScene& placed, const View& view, const Visit& visit) {
    std::optional<Drawing> first;
    for (const int width : test::widths()) {
        const Drawing other =
            draw(placed, view,
                 GBufferPasses(device().context, device().device, {.packet_width = width}));
        if (!first) first = other;
        visit(other, *first, width);
    }
}

}  // namespace clgi::test
