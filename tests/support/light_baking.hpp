// Light atlases baked from small scenes, and what came out of them. Irradiance in lux.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/light_atlas.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "device.hpp"
#include "walls.hpp"

namespace clgi::test {

struct BakeSize {
    std::uint32_t vpls = 400;
    int atlas = 64;  // texels, side
    std::uint32_t samples_per_vpl = 10;
};

// A scene on the device with its layouts.
struct Bakery {
    explicit Bakery(Scene of, const BakeSize& size = {})
        : scene(std::move(of)),
          on_device(test::on_device(scene)),
          patches(make_patches(scene)),
          vpls(place_vpls(scene, patches,
                          VplOptions{.count = size.vpls, .samples_per_vpl = size.samples_per_vpl})),
          atlas(make_atlas(scene, patches.triangle_patch, AtlasOptions{.size = size.atlas})) {}

    LightAtlasSolver solver(const LightAtlasOptions& options) const {
        return {programs(), device().queue, on_device, vpls, atlas, options};
    }

    Scene scene;
    DeviceScene on_device;
    Patches patches;
    VplLayout vpls;
    AtlasLayout atlas;
};

struct Baked {
    std::vector<glm::vec3> texels;  // [AtlasLayout::texels]
    std::vector<glm::vec3> vpls;    // [VplLayout::vpls], direct light included
    LightAtlasStatus status;

    explicit Baked(const LightAtlasSolver& solver)
        : texels(solver.irradiance()), vpls(solver.vpl_irradiance()), status(solver.status()) {}
};

inline Baked bake(const Bakery& bakery, const LightAtlasOptions& options) {
    LightAtlasSolver solver = bakery.solver(options);
    EXPECT_TRUE(solver.run());
    return Baked(solver);
}

// Asked in a report: whether direct light was the last thing to be computed.
inline bool direct_is_known(const LightAtlasSolver& solver) {
    const std::vector<PassEvent>& events = solver.events();
    return !events.empty() && std::string(events.back().name) == "vpl.receive";
}

// Bakes with this direct irradiance at the VPLs, [VplLayout::vpls], instead of that of lights. It
// is put in its place as soon as that is known, which needs transport that is kept.
inline Baked bake_from(const Bakery& bakery, const LightAtlasOptions& options,
                       const std::vector<glm::vec3>& direct) {
    LightAtlasSolver solver = bakery.solver(options);
    const SiteBuffers& sites = solver.sites();
    const auto exposure = static_cast<float>(bakery.on_device.frame().exposure);
    std::vector<float> planes(std::size_t{SITE_LIGHT_PLANES} * sites.stride, 0.0f);
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < direct.size(); ++i)
            planes[(SITE_UNSHOT + c) * sites.stride + i] =
                planes[(SITE_RECEIVED + c) * sites.stride + i] = direct[i][c] / exposure;
    bool written = false;
    EXPECT_TRUE(solver.run([&](double) {
        if (!direct_is_known(solver)) return true;
        device().queue.enqueueWriteBuffer(sites.light, CL_TRUE, 0, planes.size() * sizeof(float),
                                          planes.data());
        written = true;
        return true;
    }));
    EXPECT_TRUE(written);
    const Baked out(solver);
    EXPECT_TRUE(out.status.transport_kept);
    return out;
}

inline LightAtlasOptions bake_options(const Build& build = usual_build()) {
    LightAtlasOptions out;
    out.build = build;
    return out;
}

// All orders of reflection: what is left unshot is less than `left` of all light, for `vpls` VPLs
// that are about alike.
inline LightAtlasOptions converged(const Build& build = usual_build()) {
    LightAtlasOptions out = bake_options(build);
    out.bounces = 0;
    out.threshold = 1e-7f;
    return out;
}

// Mean weighted by area, smallest and largest of what passes the filter.
struct Spread {
    glm::dvec3 mean = glm::dvec3(0.0);
    glm::vec3 least = glm::vec3(std::numeric_limits<float>::infinity());
    glm::vec3 most = glm::vec3(-std::numeric_limits<float>::infinity());
    double area = 0.0;
    std::size_t count = 0;

    void add(const glm::vec3& value, double weight) {
        mean += weight * glm::dvec3(value);
        area += weight;
        least = glm::min(least, value);
        most = glm::max(most, value);
        ++count;
    }
};

template <typename Point>
Spread spread_over(const std::vector<Point>& points, const std::vector<glm::vec3>& values,
                   const std::function<bool(const Point&)>& wanted) {
    Spread out;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!wanted || wanted(points[i])) out.add(values[i], points[i].area);
    if (out.area > 0.0) out.mean /= out.area;
    return out;
}

inline Spread over_vpls(const Bakery& bakery, const std::vector<glm::vec3>& values,
                        const std::function<bool(const VplSite&)>& wanted = nullptr) {
    return spread_over<VplSite>(bakery.vpls.vpls, values, wanted);
}

inline Spread over_texels(const Bakery& bakery, const std::vector<glm::vec3>& values,
                          const std::function<bool(const AtlasTexel&)>& wanted = nullptr) {
    return spread_over<AtlasTexel>(bakery.atlas.texels, values, wanted);
}

// Root of the mean square of the difference, over the mean of b.
inline double relative_difference(const std::vector<glm::vec3>& a,
                                  const std::vector<glm::vec3>& b) {
    double square = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const glm::dvec3 d = glm::dvec3(a[i]) - glm::dvec3(b[i]);
        square += glm::dot(d, d);
        sum += double{b[i].x} + double{b[i].y} + double{b[i].z};
    }
    const double count = 3.0 * static_cast<double>(a.size());
    return std::sqrt(square / count) / (sum / count);
}

// The axis, 0 to 2, along which a triangle of a box faces, plus 3 where it faces against it.
inline int face_of(const Scene& scene, std::uint32_t triangle) {
    const glm::dvec3 n = glm::normalize(normal_of(scene, triangle));
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(n[axis]) > 0.9) return axis + (n[axis] < 0.0 ? 3 : 0);
    return -1;
}

}  // namespace clgi::test
