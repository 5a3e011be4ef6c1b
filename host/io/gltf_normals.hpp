// Normals that a file leaves out or gives without a direction.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_pose.hpp"
#include "io/gltf_topology.hpp"

namespace clgi::io::gltf {

// For a mesh without normals: gives every triangle three vertices of its own, which carry the
// normal of its front, as the specification asks.
void make_flat(Topology& topology, Pose& pose);

// Replaces normals of no direction by the mean of the triangles around the vertex. Returns
// whether there were any.
bool mend_normals(const Topology& topology, Pose& pose);

}  // namespace clgi::io::gltf
