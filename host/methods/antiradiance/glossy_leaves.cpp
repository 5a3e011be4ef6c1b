// SPDX-License-Identifier: MIT
#include "methods/antiradiance/glossy_leaves.hpp"

#include <clgi/passes/antiradiance_gloss.hpp>
#include <cstring>
#include <map>

namespace clgi {
namespace {

// Vertices have the mean of their glossy leaves alone: where they are shown no other light counts.
void share_vertices(const ElementSurface& surface, const std::vector<std::uint32_t>& of_row,
                    GlossyLeaves& out) {
    out.rows.assign(surface.vertices(), ELEMENT_NONE);
    out.first.push_back(0);
    for (std::uint32_t vertex = 0; vertex < surface.vertices(); ++vertex) {
        std::vector<std::pair<std::uint32_t, float>> around;
        float sum = 0.0f;
        for (std::uint32_t i = surface.first_leaves[vertex]; i < surface.first_leaves[vertex + 1];
             ++i) {
            const std::uint32_t leaf = of_row[surface.vertex_leaves[i].x];
            if (leaf == ELEMENT_NONE) continue;
            float share = 0.0f;
            std::memcpy(&share, &surface.vertex_leaves[i].y, sizeof(share));
            around.emplace_back(leaf, share);
            sum += share;
        }
        if (around.empty()) continue;
        out.rows[vertex] = out.vertices();
        for (const auto& [leaf, share] : around) {
            const float of_it = share / sum;
            std::uint32_t bits = 0;
            std::memcpy(&bits, &of_it, sizeof(bits));
            out.vertex_leaves.emplace_back(leaf, bits);
        }
        out.first.push_back(static_cast<std::uint32_t>(out.vertex_leaves.size()));
    }
}

}  // namespace

GlossyLeaves find_glossy_leaves(const ElementTree& tree, const ElementSurface& surface,
                                const Scene& scene, double least) {
    GlossyLeaves out;
    std::vector<std::uint32_t> of_row(surface.leaves.size(), ELEMENT_NONE);
    for (std::uint32_t row = 0; row < surface.leaves.size(); ++row) {
        const std::uint32_t i = surface.leaves[row];
        const std::uint32_t material = scene.triangles[tree.triangles[i]].material;
        const Material& of = scene.materials[material];
        const Reflectance shares = reflectance(of);
        if (!(double{shares.coat} + shares.lobe > least) || (tree.backs[i] && !of.double_sided)) {
            out.others.push_back(i);
            continue;
        }
        of_row[row] = out.count();
        out.leaves.push_back({i, row, material, shares.exponent});
    }
    if (out.leaves.empty()) return out;
    std::map<float, std::vector<float>> curves;  // by alpha
    for (const Material& material : scene.materials) {
        const float alpha = surface_of(material).y;
        const auto [known, fresh] = curves.try_emplace(alpha);
        if (fresh) known->second = lobe_albedos(double{alpha});
        const std::vector<float>& of = known->second;
        out.albedos.insert(out.albedos.end(), of.begin(), of.end());
    }
    share_vertices(surface, of_row, out);
    return out;
}

}  // namespace clgi
