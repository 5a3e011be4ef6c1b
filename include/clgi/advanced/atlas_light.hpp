// The light of a baked atlas, on the host: across the borders of charts, at finer texels, and as a
// scene that shows it in any viewer.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// How much the light jumps where the atlas is cut and the surface is smooth: along edges that two
// triangles share in space and not in the atlas, whose planes differ by 30 degrees at most and
// whose normals by 1 degree. There the light should be the same on both sides.
struct AtlasSeams {
    double length = 0.0;      // m of such edges
    double difference = 0.0;  // root mean square along them, over the mean of the atlas
    double worst = 0.0;       // exceeded on a hundredth of the length, over the same mean
};

// Of luminance, as atlas.show reads it: bilinear among the texels of the own chart, at points a
// texel apart or closer. irradiance: by AtlasLayout::texels, here and below. These functions throw
// Error for a layout of another scene and for light of another length.
CLGI_API AtlasSeams atlas_seams(const Scene& scene, const AtlasLayout& atlas,
                                const std::vector<glm::vec3>& irradiance);

// The same light, but where charts cut a smooth surface, texels at the cut are changed as little as
// makes both sides agree. Where one side has less than half of the other's luminance, a shadow ends
// there or a wall stands there, and nothing is changed.
CLGI_API std::vector<glm::vec3> stitched_seams(const Scene& scene, const AtlasLayout& atlas,
                                               const std::vector<glm::vec3>& irradiance);

// The same charts with `times` as many texels across. Throws Error beyond 16384 texels a side.
CLGI_API AtlasLayout finer_atlas(const Scene& scene, const AtlasLayout& atlas, int times);

// Irradiance at the texels of a finer atlas, bilinear as atlas.show reads it.
CLGI_API std::vector<glm::vec3> finer_light(const AtlasLayout& atlas,
                                            const std::vector<glm::vec3>& irradiance,
                                            const AtlasLayout& finer);

// Radiance that leaves each texel, cd/m^2: diffuse reflectance / pi times irradiance, and emission.
// Colours of textures are means over the texel. Gloss is left out: it depends on the viewer.
CLGI_API std::vector<glm::vec3> atlas_radiance(const Scene& scene, const AtlasLayout& atlas,
                                               const std::vector<glm::vec3>& irradiance);

struct LitSceneOptions {
    float exposure = 1.0f;  // above 0; radiance times it is what the textures hold, up to 1
    // Keeps base colours and lights, these times the exposure too: a viewer adds direct light.
    bool lights = false;
};

// A scene whose materials emit what leaves the texels and, without `lights`, reflect nothing. So
// every viewer of glTF shows the baked light. Each page is an emission texture on UV set 1, and the
// materials are divided by pages. Texels around charts repeat the nearest ones, and the rest of a
// page has its mean. Radiance that is not finite becomes magenta. radiance: by AtlasLayout::texels.
CLGI_API Scene with_atlas_light(const Scene& scene, const AtlasLayout& atlas,
                                const std::vector<glm::vec3>& radiance,
                                const LitSceneOptions& options = {});

}  // namespace clgi
