// Animation of a scene as plain data: nodes, curves of keys, skins and morph targets; and their
// state at a time, computed on the host in double precision.
//
// All formulas are those of glTF 2.0, appendix C, and section 3.7.3 for skins. A scene's arrays
// hold its rest pose; SceneAnimator (clgi/scene_animator.hpp) moves its vertices on the device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi {

struct Scene;
struct Bounds;

// What a node's matrix to its parent is made of: translation * rotation * scale, or the matrix
// where there is one, which no channel changes.
struct AnimatedNode {
    std::string name;
    int parent = -1;  // below the node's own index; -1: the world
    glm::dvec3 translation = glm::dvec3(0.0);
    glm::dquat rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 scale = glm::dvec3(1.0);
    std::optional<glm::dmat4> matrix;
    std::uint32_t first_weight = 0;  // of its mesh's morph targets, in Animation::weights
    std::uint32_t weight_count = 0;
};

enum class Interpolation { step, linear, cubic };

// Values over time. Before the first key it has the first value, after the last key the last.
struct Curve {
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t components = 3;  // of a value
    std::vector<float> times;      // [keys] seconds, rising
    std::vector<float> values;  // [keys][components]; cubic: [keys][tangent in, value, tangent out]
                                // [components], tangents a second
};

enum class ChannelTarget { translation, rotation, scale, weights };

// A curve drives a property of a node. Rotations are quaternions x, y, z, w, interpolated on the
// sphere the short way.
struct Channel {
    ChannelTarget target = ChannelTarget::translation;
    std::uint32_t node = 0;
    std::uint32_t curve = 0;
};

struct AnimationClip {
    std::string name;
    double duration = 0.0;  // seconds, the last key of its channels
    std::vector<Curve> curves;
    std::vector<Channel> channels;
};

struct Skin {
    std::vector<std::uint32_t> joints;      // nodes
    std::vector<glm::dmat4> inverse_binds;  // [joints] from the mesh to the joint at rest
};

// How much of a vertex follows a joint.
struct Influence {
    std::uint32_t joint = 0;  // of the skin; the number of its joints: the range's own node
    float weight = 0.0f;      // those of a vertex sum to 1; 0: no influence
};

// Vertices that move: a glTF primitive as one node shows it. Their rest pose in the mesh's own
// space lies in Animation's arrays.
struct PosedRange {
    std::uint32_t first_vertex = 0;  // of the scene
    std::uint32_t vertex_count = 0;
    std::uint32_t part = 0;                  // of the scene: the triangles of these vertices
    std::uint32_t node = 0;                  // places vertices that no joint does
    int skin = -1;                           // -1: none
    bool flat = false;                       // normals are those of the triangles, which share no
                                             // vertex then
    bool morphs_normals = false;             // there are differences of normals
    glm::dmat4 placement = glm::dmat4(1.0);  // from the mesh to the node: a copy's transform
    glm::dvec3 centre = glm::dvec3(0.0);     // mesh space; rest positions are relative to it
    std::uint32_t first_rest = 0;            // in rest_positions and rest_normals
    std::uint32_t influence_count = 0;       // of each vertex; 0: the node places all
    std::uint64_t first_influence = 0;       // [influence_count][vertex_count]
    std::uint32_t target_count = 0;          // weights are those of the node
    std::uint64_t first_difference = 0;      // [target_count][vertex_count] positions, then as
                                             // many normals if there are any
};

// A light or a camera of the scene and the node that carries it.
struct Carried {
    std::uint32_t index = 0;
    std::uint32_t node = 0;
};

struct Animation {
    std::vector<AnimatedNode> nodes;  // parents before children
    std::vector<double> weights;      // of morph targets, at rest
    std::vector<AnimationClip> clips;
    std::vector<Skin> skins;
    std::vector<PosedRange> ranges;  // in the order of their vertices, which are apart
    std::vector<glm::vec3> rest_positions;
    std::vector<glm::vec3> rest_normals;  // unit; of flat ranges not read
    std::vector<Influence> influences;
    std::vector<glm::vec3> differences;  // of morph targets
    std::vector<Carried> lights, cameras;
};

// Where all nodes are at one time.
struct Pose {
    std::vector<glm::dmat4> matrices;  // [nodes] to the world
    std::vector<double> weights;       // as Animation::weights
};

// The pose that the file stores, and that of a clip `seconds` after its start. Outside the clip its
// first or last keys hold; a caller that repeats it takes the time modulo its duration. Properties
// that no channel drives stay at rest. Throws Error if there is no such clip or the time is not
// finite.
CLGI_API Pose rest_pose(const Animation& animation);
CLGI_API Pose pose_at(const Animation& animation, std::size_t clip, double seconds);

// The value of a curve, [components]; rotation: of unit length. Key times are as validate() wants
// them.
CLGI_API std::vector<double> value_at(const Curve& curve, double seconds, bool rotation = false);

// The clip of that name, else the one of that index; empty: the first. Throws Error that lists the
// clips if there is none.
CLGI_API std::size_t find_clip(const Animation& animation, const std::string& name_or_index);

// The scene in another pose, on the host, without animation: vertices, lights and cameras. Normals
// without a direction point up; the corners of triangles keep their order. Throws Error for a scene
// without animation, InputError if a vertex is not finite or beyond 1e18 m.
CLGI_API Scene posed(const Scene& scene, const Pose& pose);

// A box around all that moves, over the whole of a clip: boxes around the vertices of every joint,
// at all keys and at up to three times between any two (1000 times together), with a margin of a
// sixteenth for what lies between. Of more than 10,000 keys an even choice counts, the first and
// the last among them; of fewer where nodes, components of channels, morph targets and joints of
// all ranges are more than 400. Nothing if no vertex moves.
CLGI_API std::optional<Bounds> motion_bounds(const Scene& scene, std::size_t clip);

}  // namespace clgi
