// SPDX-License-Identifier: MIT
#include "lab/baked_atlas.hpp"

#include <clgi/advanced/bake_layout.hpp>

#include "lab/reference_picture.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {

io::Image baked_image(const AtlasLayout& atlas, const std::vector<glm::vec3>& irradiance,
                      const std::string& effects, bool dilate) {
    io::Image out = blank_irradiance(atlas.size, atlas.size * atlas.pages, {"R", "G", "B", "A"});
    out.attributes["clgi:effects"] = effects;
    out.attributes["clgi:uv_set"] = std::to_string(atlas.uv_set);
    const auto put = [&](std::size_t texel, const glm::vec3& value, float alpha) {
        set_rgb(out, texel, value);
        out.channels[3].values[texel] = alpha;
    };
    for (std::size_t i = 0; i < atlas.texels.size(); ++i)
        if (dilate || atlas.texels[i].centre)
            put(atlas.texels[i].texel, irradiance[i], atlas.texels[i].centre ? 1.0f : 0.0f);
    if (dilate)
        for (const AtlasDilated& empty : atlas.dilated)
            put(empty.texel, irradiance[empty.source], 0.0f);
    return out;
}

std::optional<TimedBake> timed_bake(const BakeJob& job, const Progress& progress) {
    TimedBake out;
    const auto start = Clock::now();
    const BakeLayout layout = make_bake_layout(job.scene, job.vpls, job.atlas);
    out.layout_seconds = 1e-3 * milliseconds(Clock::now() - start);
    LightAtlasSolver solver(job.programs, job.queue, job.on_device, layout.vpls, layout.atlas,
                            job.options);
    if (!solver.run(progress)) return std::nullopt;
    out.seconds = 1e-3 * milliseconds(Clock::now() - start);
    out.irradiance = solver.irradiance();
    out.status = solver.status();
    return out;
}

}  // namespace clgi::lab
