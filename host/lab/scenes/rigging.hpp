// What the deforming scenes are put together from: nodes, moving parts, curves, floors, a sky.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

namespace clgi::generated {

// Adds an animation of one clip to a scene. Vertices are first those of a mesh's own space;
// finish() puts them where the rest pose has them.
class Rig {
public:
    Rig(Scene& scene, const std::string& clip, double duration);

    std::uint32_t add_node(const std::string& name, int parent, const glm::dvec3& translation);

    // Makes a part of all triangles that belong to none yet; a node moves it. The triangles name
    // all vertices that were added since the last part. Normals are to be finished before.
    PosedRange& end_moving_part(const std::string& name, std::uint32_t node);

    // A skin whose joints are all nodes so far, none turned at rest.
    int add_skin();
    // weights: [vertices of the range][joints]. The four largest of each vertex are kept.
    void follow_joints(PosedRange& range, int skin,
                       const std::vector<std::vector<double>>& weights);

    // A value at equal steps from 0 to the clip's end, both included.
    void drive(std::uint32_t node, ChannelTarget target, Interpolation interpolation,
               std::uint32_t components, std::vector<float> values, std::size_t keys);
    void turn(std::uint32_t node, const std::vector<glm::dquat>& keys);
    void shift(std::uint32_t node, const std::vector<glm::dvec3>& keys);

    Animation& animation() { return *scene_.animation; }
    AnimationClip& clip() { return scene_.animation->clips[0]; }

    // Checks everything. Call it once, last.
    void finish();

private:
    Scene& scene_;
    std::vector<glm::dvec3> joints_;  // nodes in the world at rest
};

// An upright grid of count[0] by count[1] tiles at y = 0, each of cells by cells squares with
// vertices of its own, those of even and odd places as two parts. The middle lies at the origin.
void add_tiles(Scene& scene, const std::array<int, 2>& count, int cells, double tile,
               const std::array<std::uint32_t, 2>& materials);

// A horizontal grid of cells by cells squares that share their vertices, at y = 0.
void add_floor(Scene& scene, int cells, double side, std::uint32_t material);

// Light from above: an environment, brighter above than below, and a directional light.
void add_daylight(Scene& scene, const glm::vec3& direction, float lux);

// Triangles between rings of equally many vertices, from `first` on in the order of the rings; the
// last two vertices close the first and the last ring. With the last ring above the first, rings
// run from +X to +Z.
void close_rings(Scene& scene, std::uint32_t first, int rings, int sides, std::uint32_t material);

// A smooth closed curve through points that are equally far apart in time, at times in [0,1].
glm::dvec3 through(const std::vector<glm::dvec3>& points, double share);

}  // namespace clgi::generated
