// VPLs put together by hand, their hemicubes and the passes that exchange light between them; and
// the same light in double precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi::test {

constexpr double pi = 3.14159265358979323846;

// A point of the surface, local frame.
struct SurfacePlace {
    glm::vec3 position, normal, geometric;
    glm::vec3 base = glm::vec3(1.0f);
};

struct SitePlace {
    glm::vec3 position, normal;
    float area = 0.0f;
    glm::vec3 albedo = glm::vec3(1.0f);
    std::vector<SurfacePlace> samples;
    glm::vec3 power =
        glm::vec3(std::numeric_limits<float>::quiet_NaN());  // that it sends to texels
    std::vector<glm::vec3> powers = {};  // of its samples; need not add up to that
    cl_uint row_exponent = 0;            // its row is divided by 2^row_exponent
};

// Planes of floats, NaN where nothing is put: what no kernel may take for a value.
class Planes {
public:
    Planes(std::size_t count, std::size_t stride)
        : values(count * stride, std::numeric_limits<float>::quiet_NaN()), stride_(stride) {}
    void put(std::size_t plane, std::size_t at, float value) {
        values[plane * stride_ + at] = value;
    }
    void put(std::size_t plane, std::size_t at, const glm::vec3& value) {
        for (int c = 0; c < 3; ++c) values[(plane + c) * stride_ + at] = value[c];
    }
    std::vector<float> values;

private:
    std::size_t stride_;
};

// Points as planes of a G-buffer, `planes` of them.
inline cl::Buffer upload_points(const std::vector<SurfacePlace>& points, std::uint32_t stride,
                                std::size_t planes = GBUFFER_PLANES) {
    Planes out(planes, stride);
    for (std::size_t i = 0; i < points.size(); ++i) {
        out.put(GBUFFER_POSITION, i, points[i].position);
        out.put(GBUFFER_NORMAL, i, points[i].normal);
        if (planes >= GBUFFER_GEOMETRIC + 3) out.put(GBUFFER_GEOMETRIC, i, points[i].geometric);
        if (planes >= GBUFFER_BASE + 3) out.put(GBUFFER_BASE, i, points[i].base);
    }
    return upload(out.values);
}

// Sites on the device. They shoot, and send to texels, in their order unless `order` says
// otherwise; they hold no light; balance factors are 1, the reach is 1.
struct Sites {
    explicit Sites(std::vector<SitePlace> list, std::vector<cl_uint> order = {})
        : places(std::move(list)) {
        SiteBuffers& b = buffers;
        b.site_count = static_cast<std::uint32_t>(places.size());
        b.stride = padded(places.size());
        std::vector<Site> sites;
        std::vector<SurfacePlace> points;
        for (const SitePlace& place : places) {
            sites.push_back({static_cast<cl_uint>(points.size()),
                             static_cast<cl_uint>(place.samples.size()), place.area,
                             place.row_exponent << SITE_ROW_SHIFT});
            points.insert(points.end(), place.samples.begin(), place.samples.end());
            if (order.size() < places.size()) order.push_back(static_cast<cl_uint>(order.size()));
        }
        b.sample_count = static_cast<std::uint32_t>(points.size());
        b.sample_stride = padded(points.size() + places.size());
        Planes planes(SITE_PLANES, b.stride), light(SITE_LIGHT_PLANES, b.stride);
        Planes power(3, b.stride), powers(3, b.sample_stride);
        for (std::size_t i = 0; i < places.size(); ++i) {
            planes.put(SITE_POSITION, i, places[i].position);
            planes.put(SITE_NORMAL, i, places[i].normal);
            planes.put(SITE_ALBEDO, i, places[i].albedo);
            light.put(SITE_UNSHOT, i, glm::vec3(0.0f));
            light.put(SITE_RECEIVED, i, glm::vec3(0.0f));
            power.put(0, i, places[i].power);
            for (std::size_t k = 0; k < places[i].powers.size(); ++k)
                powers.put(0, sites[i].first_sample + k, places[i].powers[k]);
        }
        b.sites = upload(sites);
        b.planes = upload(planes.values);
        b.light = upload(light.values);
        b.balance = upload(std::vector<float>(BALANCE_PLANES * b.stride, 1.0f));
        b.power = upload(std::vector<float>(b.stride));
        b.shot = upload(std::vector<float>(3 * b.stride));
        b.samples = upload_points(points, b.sample_stride);
        b.site_power = upload(power.values);
        b.sample_power = upload(powers.values);
        b.chosen = b.list = upload(order);
        b.listed = upload(std::vector<cl_uint>{b.site_count});
    }
    // The factors of a plane of the balance.
    void balance(int plane, const std::vector<float>& values) const {
        device().queue.enqueueWriteBuffer(buffers.balance, CL_TRUE,
                                          plane * buffers.stride * sizeof(float),
                                          values.size() * sizeof(float), values.data());
    }
    std::vector<SitePlace> places;
    SiteBuffers buffers;
};

// The pictures of a batch of shooters.
struct Hemicubes {
    std::uint32_t first, count, size;
    cl::Buffer views, depth;
};

struct HemicubeOptions {
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // 0: all sites from the first on
    std::uint32_t size = 64;
    float lift = 0.0f;
    float near = 1e-5f;
};

// scene: none draws nothing, so that everything is seen.
inline Hemicubes hemicubes(const Sites& sites, const DeviceScene* scene,
                           const HemicubeOptions& options = {}) {
    const cl::CommandQueue& queue = device().queue;
    const SiteBuffers& b = sites.buffers;
    const std::uint32_t size = options.size;
    const std::uint32_t count = options.count > 0 ? options.count : b.site_count - options.first;
    const std::size_t pixels = std::size_t{3} * count * size * size;
    Hemicubes out{options.first, count, size, empty<View>(5 * count), empty<cl_uint>(pixels)};
    gbuffer_passes().cubes(
        queue, {count, 5, size, 0, 0, b.stride, options.lift, options.near, options.first, 0, 0, 0},
        b.planes, b.chosen, out.views);
    if (scene)
        gbuffer_passes().raster_views(queue, {0, 5 * count, size, size, pixels}, out.views, *scene,
                                      out.depth, Pixels::depth);
    else
        queue.enqueueFillBuffer(out.depth, ~cl_uint{0}, 0, pixels * sizeof(cl_uint));
    return out;
}

inline const VplPasses& vpl_passes(const Build& build = usual_build()) {
    return shared_passes<VplPasses>(build);
}

inline const AtlasPasses& atlas_passes(const Build& build = usual_build()) {
    return shared_passes<AtlasPasses>(build);
}

// The buffers with the points at which sites are looked at, most_samples of each at most.
inline SiteBuffers with_points(const Sites& sites, std::uint32_t most_samples,
                               const VplPasses& passes = vpl_passes()) {
    SiteBuffers b = sites.buffers;
    std::size_t largest = 1;
    for (const SitePlace& place : sites.places) largest = std::max(largest, place.samples.size());
    b.most_samples = std::min(most_samples, static_cast<std::uint32_t>(largest));
    b.per_site = points_per_site(b.most_samples);
    b.point_stride = padded(std::size_t{b.site_count} * b.per_site);
    b.points = upload(Planes(SITE_POINT_PLANES, b.point_stride).values);
    passes.points(device().queue, b);
    return b;
}

// Halves as they lie in the rows: [shooters or sites][stride].
inline std::vector<std::uint16_t> transport_rows(const Sites& sites, const Hemicubes& cubes,
                                                 bool kept = false, float row_scale = 1.0f,
                                                 const VplPasses& passes = vpl_passes(),
                                                 std::uint32_t most_samples = 1u << 20) {
    const SiteBuffers b = with_points(sites, most_samples, passes);
    const std::size_t halves = std::size_t{kept ? b.site_count : cubes.count} * b.stride;
    const cl::Buffer rows = upload(std::vector<std::uint16_t>(halves, 0x7e00));  // NaN
    passes.transport(device().queue,
                     {cubes.first, cubes.count, kept ? 1u : 0u, b.site_count, b.stride,
                      b.sample_stride, cubes.size, row_scale, 0, 0, 0, 0},
                     b, cubes.views, cubes.depth, rows);
    return download<std::uint16_t>(rows, halves);
}

// The same where nothing lies between sites, without hemicubes: of `count` shooters from `first`
// on.
inline std::vector<std::uint16_t> open_rows(const Sites& sites, std::uint32_t first,
                                            std::uint32_t count, bool kept = false,
                                            float row_scale = 1.0f,
                                            const VplPasses& passes = vpl_passes(),
                                            std::uint32_t most_samples = 1u << 20,
                                            float lift = 0.0f) {
    const SiteBuffers b = with_points(sites, most_samples, passes);
    const std::size_t halves = std::size_t{kept ? b.site_count : count} * b.stride;
    const cl::Buffer rows = upload(std::vector<std::uint16_t>(halves, 0x7e00));  // NaN
    passes.transport_open(device().queue,
                          {first, count, kept ? 1u : 0u, b.site_count, b.stride, b.sample_stride, 0,
                           row_scale, 0, 0, 0, lift},
                          b, rows);
    return download<std::uint16_t>(rows, halves);
}

// What texels see of a batch -> seen, rows of params.stride bytes from first_row on.
inline void see(const Hemicubes& cubes, std::uint32_t texels, const cl::Buffer& planes,
                const cl::Buffer& seen, std::uint32_t first_row = 0,
                const AtlasPasses& passes = atlas_passes(), std::uint32_t first_texel = 0) {
    passes.see(device().queue,
               {cubes.count, cubes.size, texels, padded(texels), first_texel, first_row, 0, 0},
               cubes.views, cubes.depth, planes, seen);
}

// ---- in double precision -------------------------------------------------------------------

// pi cos cos' k of lights/disc.clh. cosines: of the unnormalised vector, cos cos' d^2.
inline double disc_kernel(double cosines, double square, double radius2) {
    if (square == 0.0) return 0.0;
    return cosines / square * (square + radius2) /
           (square * (square + radius2) + radius2 * radius2);
}

struct Exchanged {
    double factor = 0.0;     // pi F / A
    double condition = 0.0;  // the same if all cosines were 1: what rounding is relative to
    bool near_by = false;
    bool doubtful = false;  // at the border of near by
};

// kernels/vpl/exchange.clh for a point p with a normal n.
inline Exchanged exchange(const SitePlace& shooter, const glm::dvec3& p, const glm::dvec3& n) {
    Exchanged out;
    const glm::dvec3 normal(shooter.normal), d = p - glm::dvec3(shooter.position);
    const double square = glm::dot(d, d), radius2 = double{shooter.area} / pi;
    const auto cosines = [&](const glm::dvec3& v) {
        return std::max(-glm::dot(v, n), 0.0) * std::max(glm::dot(v, normal), 0.0);
    };
    out.near_by = square < 25.0 * radius2;
    out.doubtful = std::abs(square / (25.0 * radius2) - 1.0) < 1e-5;
    if (!out.near_by) {
        out.factor = disc_kernel(cosines(d), square, radius2);
        out.condition = disc_kernel(square, square, radius2);
        return out;
    }
    const double count = static_cast<double>(shooter.samples.size());
    for (std::size_t k = 0; k < shooter.samples.size(); ++k) {
        const glm::dvec3 v = p - glm::dvec3(shooter.samples[k].position);
        out.factor += disc_kernel(cosines(v), glm::dot(v, v), radius2 / count) / count;
        out.condition += disc_kernel(glm::dot(v, v), glm::dot(v, v), radius2 / count) / count;
    }
    return out;
}

inline glm::vec3 direction(Random& random) {
    for (;;) {
        const glm::vec3 out(random(-1, 1), random(-1, 1), random(-1, 1));
        const float length = glm::length(out);
        if (length > 0.1f && length < 1.0f) return out / length;
    }
}

}  // namespace clgi::test
