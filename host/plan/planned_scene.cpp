// What a plan renders, as a scene: the light, gloss, textures, holes and motion whose effects are
// off are not in it, so no kernel, buffer or pass for them is made.
// SPDX-License-Identifier: MIT
#include <clgi/shared/microfacet.h>
#include <algorithm>
#include <clgi/plan.hpp>

#include "plan/local_scene.hpp"
#include "plan/one_colour.hpp"
#include "plan/reach.hpp"
#include "scene/texture_mean.hpp"

namespace clgi {
namespace {

bool kept(const Light& light, const Plan& plan) {
    if (light.intensity == glm::vec3(0.0f) && !plan.request.lights_change) return false;
    switch (light.kind) {
        case Light::Kind::point:
            return plan.on(Effect::point_light);
        case Light::Kind::spot:
            return plan.on(Effect::spot_light);
        case Light::Kind::directional:
            return plan.on(Effect::directional_light);
    }
    return true;
}

// Lights keep their order; what the animation carries follows them.
void drop_lights(Scene& scene, const Plan& plan) {
    std::vector<std::uint32_t> place(scene.lights.size());
    std::vector<Light> out;
    std::vector<bool> stays(scene.lights.size());
    for (std::size_t k = 0; k < scene.lights.size(); ++k) {
        place[k] = static_cast<std::uint32_t>(out.size());
        stays[k] = kept(scene.lights[k], plan);
        if (stays[k]) out.push_back(scene.lights[k]);
    }
    scene.lights = std::move(out);
    if (!scene.animation) return;
    std::vector<Carried> carried;
    for (Carried one : scene.animation->lights) {
        if (!stays[one.index]) continue;
        one.index = place[one.index];
        carried.push_back(one);
    }
    scene.animation->lights = std::move(carried);
}

// Of a texture that a plan has no use for: its linear colour, of all texels.
class MeanColours {
public:
    explicit MeanColours(const Scene& scene) : scene_(scene), plain_(scene.textures.size()) {
        for (std::size_t k = 0; k < plain_.size(); ++k) plain_[k] = one_colour(scene.textures[k]);
    }

    bool plain(int texture) const { return plain_[static_cast<std::size_t>(texture)]; }

    glm::vec3 of(int texture) const {
        const Texture& from = scene_.textures[static_cast<std::size_t>(texture)];
        const TextureMean mean(from);
        if (plain(texture)) return glm::vec3(mean.at(glm::dvec2(0.5)));
        const UvTriangle halves[2] = {{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1)},
                                      {glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}};
        return glm::vec3(0.5 * (mean.over(halves[0]) + mean.over(halves[1])));
    }

private:
    const Scene& scene_;
    std::vector<bool> plain_;
};

void drop_textures(Material& material, const Plan& plan, const MeanColours& colours) {
    const bool all = !plan.on(Effect::textures);
    if (all) material.metallic_roughness_texture = material.normal_texture = TextureSlot();
    const auto dropped = [&](const TextureSlot& slot) {
        return slot.texture >= 0 && (all || colours.plain(slot.texture));
    };
    if (material.emission == glm::vec3(0.0f)) material.emission_texture = TextureSlot();
    if (dropped(material.emission_texture)) {
        material.emission *= colours.of(material.emission_texture.texture);
        material.emission_texture = TextureSlot();
    }
    if (!dropped(material.base_texture)) return;
    const int texture = material.base_texture.texture;
    if (material.alpha_mode != AlphaMode::opaque) return;  // its alpha cuts the holes
    const glm::vec3 colour = colours.of(texture);
    for (int c = 0; c < 3; ++c) material.base_color[c] *= colour[c];
    material.base_texture = TextureSlot();
}

// Textures that no material in use reads are not uploaded.
void drop_unread(Scene& scene) {
    std::vector<bool> used(scene.materials.size());
    for (const SceneTriangle& triangle : scene.triangles) used[triangle.material] = true;
    std::vector<int> place(scene.textures.size(), -1);
    std::vector<Texture> kept;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        for (TextureSlot* slot : texture_slots(material)) {
            if (!used[m]) *slot = TextureSlot();
            if (slot->texture < 0) continue;
            const auto texture = static_cast<std::size_t>(slot->texture);
            if (place[texture] < 0) {
                place[texture] = static_cast<int>(kept.size());
                kept.push_back(std::move(scene.textures[texture]));
            }
            slot->texture = place[texture];
        }
    }
    scene.textures = std::move(kept);
}

// Cameras go on moving, and a clip that is asked for stays one.
void drop_motion(Scene& scene, const Plan& plan) {
    if (!scene.animation) return;
    Animation& animation = *scene.animation;
    if (!plan.on(Effect::moving_geometry)) animation.ranges.clear();
    if (!plan.on(Effect::moving_lights)) animation.lights.clear();
    const bool moves = !animation.ranges.empty() || !animation.lights.empty() ||
                       !animation.cameras.empty() || plan.request.animated;
    if (!moves) scene.animation.reset();
}

}  // namespace

bool sees_little(const Plan& plan) { return plan.reach && focus_of(*plan.reach).has_value(); }

std::optional<Focus> focus_of(const Scene& scene, const Camera& camera, int width, int height) {
    return focus_of(reach_of(scene, LocalScene(scene), camera, width, height));
}

Scene planned_scene(const Scene& scene, const Plan& plan) {
    Scene out = scene;
    drop_lights(out, plan);
    if (!plan.on(Effect::environment_light)) out.environment.reset();
    const MeanColours colours(scene);
    for (Material& material : out.materials) {
        if (!plan.on(Effect::area_light)) {
            material.emission = glm::vec3(0.0f);
            material.emission_texture = TextureSlot();
        }
        if (!plan.on(Effect::gloss)) {  // Lambertian, without the white coat
            const float albedo = microfacet_albedo(microfacet_alpha(material.roughness));
            const float share = 1.0f - material.metallic * (1.0f - albedo);
            material.base_color *= glm::vec4(glm::vec3(share), 1.0f);
            material.metallic = material.specular = 0.0f;
            material.metallic_roughness_texture = TextureSlot();
        }
        if (!plan.on(Effect::cutouts)) material.alpha_mode = AlphaMode::opaque;
        drop_textures(material, plan, colours);
    }
    drop_unread(out);
    drop_motion(out, plan);
    if (sees_little(plan)) out.focus = focus_of(*plan.reach);
    return out;
}

}  // namespace clgi
