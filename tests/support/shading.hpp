// Pixels written by hand, the picture that combine makes of them, and the same in double precision
// from the formulas of docs/materials.md and KHR_lights_punctual.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/image.hpp>
#include <numbers>

#include "lighting.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"
#include "shadow_reference.hpp"

namespace clgi::test {

struct ShadedPixel {
    glm::vec3 position{0}, normal{0}, geometric{0};  // local frame; no normal: nothing is there
    glm::vec3 base{0};                               // colour, before the share that is diffuse
    glm::vec3 emission{0};
    glm::vec3 irradiance{0};       // indirect
    int material = -1;             // -1: unknown, all of the colour is diffuse
    int detail = -1, finish = -1;  // of textures; -1: normal and material hold
};

// A normal of GBUFFER_MAPPED_NORMAL, from the faces of the octahedron |x| + |y| + |z| = 1.
inline glm::dvec3 detail_normal(int code) {
    const auto step = [&](int shift) {
        return 2.0 * (static_cast<std::uint32_t>(code) >> shift & 0xffffu) / double{DETAIL_STEPS} -
               1.0;
    };
    glm::dvec3 out(step(0), step(16), 0.0);
    out.z = 1.0 - std::abs(out.x) - std::abs(out.y);
    if (out.z < 0.0) {
        const glm::dvec2 mirrored(1.0 - std::abs(out.y), 1.0 - std::abs(out.x));
        out.x = std::copysign(mirrored.x, out.x);
        out.y = std::copysign(mirrored.y, out.y);
    }
    return glm::normalize(out);
}

// What a pixel shows: its material with its finish, or a Lambertian one.
inline Material shown_material(const ShadedPixel& pixel, const std::vector<Material>& materials) {
    if (pixel.material < 0) return {};
    Material out = materials[pixel.material];
    if (pixel.finish < 0) return out;
    out.metallic = static_cast<float>(pixel.finish >> METALLIC_ROUGHNESS_BITS) /
                   float{METALLIC_ROUGHNESS_STEPS};
    out.roughness = static_cast<float>(pixel.finish & METALLIC_ROUGHNESS_STEPS) /
                    float{METALLIC_ROUGHNESS_STEPS};
    return out;
}

// What is left of a pixel that is stored.
inline ShadedPixel stored(ShadedPixel pixel) {
    for (glm::vec3 ShadedPixel::*member :
         {&ShadedPixel::normal, &ShadedPixel::geometric, &ShadedPixel::base, &ShadedPixel::emission,
          &ShadedPixel::irradiance})
        pixel.*member = stored(pixel.*member);
    return pixel;
}

struct Shading {
    CombineParams params{};  // width, height and stride follow from the pixels
    View view{};
    std::vector<Emitter> emitters;
    std::vector<View> views;
    std::vector<std::uint64_t> visibility;
    std::vector<Material> materials;
    std::vector<ShadedPixel> pixels;
};

struct Combined {
    std::vector<glm::vec3> radiance;
    std::uint32_t non_finite = 0;
};

// A scene that is nothing but its materials.
inline Scene scene_of(const std::vector<Material>& materials) {
    Scene scene;
    scene.materials = materials;
    for (std::uint32_t m = 0; m < materials.size(); ++m)
        add_triangle(scene, {m, 0, 0}, {m + 1, 0, 0}, {m, 1, 0}, m);
    return scene;
}

inline Combined combine(const Shading& in, const ImagePasses& passes = image_passes()) {
    const std::uint32_t count = static_cast<std::uint32_t>(in.pixels.size());
    const std::uint32_t stride = padded(count);
    std::vector<float> planes(GBUFFER_PLANES * stride), irradiance(IRRADIANCE_PLANES * stride);
    // Past the last pixel another renderer may have left anything.
    std::vector<cl_int> ids(GBUFFER_ID_PLANES * stride, 0x3fffffff);
    for (std::uint32_t i = 0; i < count; ++i) {
        const ShadedPixel& pixel = in.pixels[i];
        const auto put = [&](int plane, const glm::vec3& value) {
            for (int c = 0; c < 3; ++c) planes[(plane + c) * stride + i] = value[c];
        };
        put(GBUFFER_POSITION, pixel.position);
        put(GBUFFER_NORMAL, pixel.normal);
        put(GBUFFER_GEOMETRIC, pixel.geometric);
        put(GBUFFER_BASE, pixel.base);
        put(GBUFFER_EMISSION, pixel.emission);
        ids[GBUFFER_MATERIAL * stride + i] = pixel.material;
        ids[GBUFFER_MAPPED_NORMAL * stride + i] = pixel.detail;
        ids[GBUFFER_METALLIC_ROUGHNESS * stride + i] = pixel.finish;
        for (int c = 0; c < 3; ++c) irradiance[c * stride + i] = pixel.irradiance[c];
    }
    CombineParams params = in.params;
    View view = in.view;
    params.width = view.width = count / 3;  // the number of pixels is a multiple of 3
    params.height = view.height = 3;
    params.stride = stride;
    params.emitter_count = static_cast<cl_uint>(in.emitters.size());
    const DeviceScene scene = on_device(scene_of(in.materials));
    const EmitterBuffers sources{upload(in.emitters), upload(in.views), upload(in.visibility)};
    const cl::Buffer radiance = upload(std::vector<float>(RADIANCE_PLANES * stride));
    const cl::Buffer non_finite = upload(std::vector<cl_uint>(1));
    params.depth_words = 2;
    if (scene.info().flags & SCENE_HAS_SHARES) params.effects |= COMBINE_MATERIALS;
    passes.combine(device().queue, params, view, scene,
                   {sources,
                    {upload_planes(planes, stride), upload(ids), stride, usual_build().storage},
                    upload_irradiance(irradiance),
                    radiance,
                    non_finite});
    const auto found = download<float>(radiance, RADIANCE_PLANES * stride);
    Combined out;
    out.non_finite = download<cl_uint>(non_finite, 1)[0];
    for (std::uint32_t i = 0; i < count; ++i)
        out.radiance.emplace_back(found[i], found[stride + i], found[2 * stride + i]);
    return out;
}

// Cosine that is left of a spot, clamped linear between two cosines, squared.
inline double spot_share(double along, double cos_outer, double cos_inner) {
    if (along >= cos_inner) return 1.0;
    if (along <= cos_outer) return 0.0;
    const double t = (along - cos_outer) / (cos_inner - cos_outer);
    return t * t;
}

inline double range_share(double distance, double range) {
    return range > 0.0 ? std::max(1.0 - std::pow(distance / range, 4), 0.0) : 1.0;
}

struct ShadedTruth {
    glm::dvec3 radiance{0};
    glm::dvec3 bound{0};    // what rounding may make of it
    bool doubtful = false;  // a comparison within rounding: no value can be asked for
};

inline ShadedTruth shaded_truth(const Shading& in, const ShadedPixel& pixel) {
    constexpr double pi = std::numbers::pi, u = 0x1p-24;
    ShadedTruth out;
    glm::dvec3 n(pixel.normal);
    const glm::dvec3 g(pixel.geometric), p(pixel.position);
    if (pixel.normal == glm::vec3(0)) return out;
    if (pixel.detail != -1 && (in.params.effects & COMBINE_MAPPED_NORMALS))
        n = detail_normal(pixel.detail);
    const Material material = shown_material(pixel, in.materials);
    const Reflectance r = reflectance(material);
    const glm::dvec3 base(pixel.base), rho = base * double{r.diffuse};
    const glm::dvec3 toward_eye = in.view.eye.w == 0.0f
                                      ? glm::normalize(glm::dvec3(in.view.eye) - p)
                                      : -glm::dvec3(in.view.forward);
    for (const Emitter& e : in.emitters) {
        if (!(in.params.effects & COMBINE_DIRECT)) break;
        const uint kind = e.kind & EMITTER_KIND;
        const glm::dvec3 axis(e.axis);
        glm::dvec3 t = -axis;
        double strength = 1.0, steep = 1.0;  // steep: by how much the cone enlarges an error
        if (kind != EMITTER_DIRECTIONAL) {
            t = glm::dvec3(e.position) - p;
            const double d = glm::length(t);
            t /= d;
            const double along = -glm::dot(t, axis);
            if (kind == EMITTER_AREA) {
                // A disc of the sample's area: (d^2 + r^2) / (d^2 (d^2 + r^2) + r^4) / pi.
                const double s = pi * d * d, area = double{e.area};
                strength = std::max(along, 0.0) * (s + area) / (s * (s + area) + area * area);
                if (std::abs(along) < 1e-5) out.doubtful = true;
            } else {
                strength = range_share(d, double{e.range}) / (d * d);
                if (kind == EMITTER_SPOT) {
                    const double outer = double{e.axis.w}, inner = double{e.right.w};
                    const double share = spot_share(along, outer, inner);
                    strength *= share;
                    if (inner > outer && share > 0.0)
                        steep += 1.0 / ((inner - outer) * std::sqrt(share));
                    if (std::abs(along - outer) < 1e-6) out.doubtful = true;
                }
            }
        }
        const double cosine = glm::dot(n, t), facing = glm::dot(g, t);
        if (std::abs(cosine) < 1e-6 || std::abs(facing) < 1e-6) out.doubtful = true;
        if (cosine <= 0.0 || facing <= 0.0 || strength <= 0.0) continue;
        const Shadowed at = shadowed(e, in.views, p, g, double{in.params.texel_bias});
        out.doubtful |= at.doubtful;
        const double lit = lit_share(at, in.visibility, &out.doubtful);
        const double width = at.view ? std::max(at.view->width, at.view->height) : 1.0;
        const double arriving = strength * cosine * lit;
        GltfReflected to = gltf_reflected(material, base, glm::normalize(n), toward_eye, t);
        if (!(in.params.effects & COMBINE_SPECULAR)) to = {rho / pi, glm::dvec3(0.0), 1.0};
        for (int c = 0; c < 3; ++c) {
            const double light = double{e.intensity[c]};
            out.radiance[c] += light * arriving * (to.diffuse[c] + to.gloss[c]);
            // A cosine is 8 spacings off, a place on the shadow map 8 of the map's width, and the
            // lobe enlarges what its cosine is off.
            const double off = 16 * u * (steep + width + 4 / cosine);
            out.bound[c] += light * strength * cosine *
                            (to.diffuse[c] * off + to.gloss[c] * (off + 16 * u * to.steep));
        }
    }
    for (int c = 0; c < 3; ++c) {
        if (in.params.effects & COMBINE_INDIRECT)
            out.radiance[c] += rho[c] / pi * std::max(double{pixel.irradiance[c]}, 0.0);
        if (in.params.effects & COMBINE_EMISSION) out.radiance[c] += double{pixel.emission[c]};
        out.radiance[c] *= double{in.params.exposure};
        out.bound[c] = out.bound[c] * double{in.params.exposure} + 16 * u * out.radiance[c];
    }
    return out;
}

}  // namespace clgi::test
