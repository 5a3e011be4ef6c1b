// A scene as the path tracer keeps it.
// SPDX-License-Identifier: MIT
#pragma once

#include "reference/path.hpp"

namespace clgi::reference {

struct PathTracer::World {
    explicit World(const Scene& scene)
        : geometry(scene), tracer(geometry), lights(scene, geometry), sky(scene.environment) {}
    Paths paths(const Options& options) const { return {geometry, tracer, lights, sky, options}; }

    Geometry geometry;
    Tracer tracer;
    Lights lights;
    Sky sky;
};

}  // namespace clgi::reference
