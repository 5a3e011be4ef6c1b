// Ground truth as pictures with their own standard error, kept in files between runs: radiance that
// a camera sees, and irradiance where a scene's lightmap has texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/io/image.hpp>
#include <clgi/reference.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clgi::lab {

// Goes up whenever the path tracer's results change: part of the keys of files that are kept.
inline constexpr int tracer_version = 2;

// R, G, B and error.Y, with quantity, unit, effects, samples and relative error as attributes.
io::Image reference_image(const reference::Picture& picture, const std::string& effects);

// Planes of irradiance in lux, all 0: "R", "G", "B" first.
io::Image blank_irradiance(int width, int height, const std::vector<const char*>& planes);
void set_rgb(io::Image& picture, std::size_t pixel, const glm::vec3& color);

// The same with what was found at some pixels, and its error in the plane error.Y, the last one.
io::Image irradiance_image(io::Image blank, const std::vector<std::uint32_t>& pixels,
                           const reference::Irradiance& found, const std::string& effects);

// The relative error that such a picture states of itself; 0 when it states none.
double stated_error(const io::Image& picture);

// Tells scenes apart: a hash of everything that a path tracer looks at.
std::string scene_key(const Scene& scene);

// The image in `file` if it has this key, else what make() returns, which is saved there unless it
// is without channels.
io::Image kept_image(const std::filesystem::path& file, const std::string& key,
                     const std::function<io::Image()>& make);

// The picture in `file` if it was made with the same scene, camera, size, effects, samples and
// seed, else a new one, which is saved there. Without channels when progress cancelled.
io::Image cached_reference(const reference::PathTracer& tracer, const Camera& camera,
                           const reference::Options& options, const std::string& effects,
                           const std::filesystem::path& file, const std::string& scene_key,
                           const Progress& progress);

// ---- atlases ------------------------------------------------------------------------------------

struct AtlasPlaces {
    int size = 0;                          // texels, side of a page
    int pages = 1;                         // below each other
    int uv_set = 0;                        // that was taken; -1: none, charts were made
    std::vector<std::uint32_t> texels;     // (page * size + row) * size + column, rising
    std::vector<reference::Place> places;  // of each texel's centre
    std::vector<std::string> warnings;     // one line each
};

// Where texels of the atlas lie. uv_set: 0, 1, or -1 for the first of 1 and 0 that serves. A set
// serves when its triangles lie in the unit square and cover texels, at most one in a hundred of
// them twice; fewer are a warning. Throws InputError when none serves.
AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set);

// The texels of a layout whose centre is covered.
AtlasPlaces atlas_places(const Scene& scene, const AtlasLayout& layout);

// R, G, B in lux, A (1 where a texel was lit, else 0) and error.Y, with quantity, unit, effects,
// samples, relative error and UV set as attributes.
io::Image atlas_image(const AtlasPlaces& atlas, const reference::Irradiance& irradiance,
                      const std::string& effects);

// The atlas in `file` if it was made with the same scene, places, effects, samples and seed, else a
// new one, which is saved there. Without channels when progress cancelled.
io::Image cached_atlas(const reference::PathTracer& tracer, const AtlasPlaces& atlas,
                       const reference::Options& options, const std::string& effects,
                       const std::filesystem::path& file, const std::string& scene_key,
                       const Progress& progress);

}  // namespace clgi::lab
