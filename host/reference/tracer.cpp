// SPDX-License-Identifier: MIT
#include "reference/tracer.hpp"

#if CLGI_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <clgi/error.hpp>
#include <string>

#include "reference/material.hpp"

namespace clgi::reference {
namespace {

#if RTC_VERSION_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

// What the filter is to do with the hits of one ray; Embree hands it through.
struct Query : Context {
    explicit Query(const Geometry& scene) : geometry(scene) {
#if RTC_VERSION_MAJOR >= 4
        rtcInitRayQueryContext(this);
#else
        rtcInitIntersectContext(this);
#endif
    }
    const Geometry& geometry;
    std::uint64_t chance = 0;
    bool for_camera = false;
    std::vector<Hit>* all = nullptr;
};

// Refuses hits that are not there: holes of alpha masks, blended surfaces by chance, and for the
// camera backs of one-sided surfaces. A query for all hits notes each and refuses it, so that the
// ray goes on.
void filter(const RTCFilterFunctionNArguments* arguments) {
    const auto* query = static_cast<const Query*>(arguments->context);
    RTCRayN* ray = arguments->ray;
    RTCHitN* rtc = arguments->hit;
    const Hit hit{RTCHitN_primID(rtc, 1, 0), RTCHitN_u(rtc, 1, 0), RTCHitN_v(rtc, 1, 0)};
    const Material& material =
        query->geometry.materials[query->geometry.triangles[hit.triangle].material];
    bool there = opaque(query->geometry, hit, query->chance);
    if (query->for_camera && !material.double_sided) {
        const glm::vec3 direction(RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0),
                                  RTCRayN_dir_z(ray, 1, 0));
        there = there && glm::dot(geometric_normal(query->geometry, hit.triangle), direction) < 0;
    }
    if (there && query->all) {
        query->all->push_back(hit);
        there = false;
    }
    if (!there) arguments->valid[0] = 0;
}

RTCRay rtc_ray(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x;
    out.org_y = ray.origin.y;
    out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x;
    out.dir_y = ray.direction.y;
    out.dir_z = ray.direction.z;
    out.tnear = ray.nearest;
    out.tfar = ray.farthest;
    out.mask = 0xffffffffu;
    return out;
}

void intersect(RTCScene scene, Query& query, RTCRayHit& ray) {
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &query;
    rtcIntersect1(scene, &ray, &arguments);
#else
    rtcIntersect1(scene, &query, &ray);
#endif
}

void occlude(RTCScene scene, Query& query, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &query;
    rtcOccluded1(scene, &ray, &arguments);
#else
    rtcOccluded1(scene, &query, &ray);
#endif
}

}  // namespace

struct Tracer::Scene {
    explicit Scene(const Geometry& held) : geometry(held) {}
    ~Scene() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    const Geometry& geometry;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

Tracer::Tracer(const Geometry& geometry) : scene_(std::make_unique<Scene>(geometry)) {
    const auto check = [&] {
        const RTCError code = rtcGetDeviceError(scene_->device);
        if (code != RTC_ERROR_NONE)
            throw DeviceError("reference: Embree reports error " + std::to_string(code));
    };
    scene_->device = rtcNewDevice(nullptr);
    check();
    scene_->scene = rtcNewScene(scene_->device);
    rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!geometry.triangles.empty()) {
        RTCGeometry mesh = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), geometry.positions.size()));
        auto* corners = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), geometry.triangles.size()));
        check();
        for (const glm::vec3& position : geometry.positions)
            for (int axis = 0; axis < 3; ++axis) *vertices++ = position[axis];
        bool masked = false;
        for (const SceneTriangle& triangle : geometry.triangles) {
            for (const std::uint32_t vertex : triangle.vertex) *corners++ = vertex;
            masked |= geometry.materials[triangle.material].alpha_mode != AlphaMode::opaque;
        }
        rtcSetGeometryIntersectFilterFunction(mesh, filter);
        if (masked) rtcSetGeometryOccludedFilterFunction(mesh, filter);
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(scene_->scene, mesh);
        rtcReleaseGeometry(mesh);
    }
    rtcCommitScene(scene_->scene);
    check();
}

Tracer::~Tracer() = default;

std::optional<Hit> Tracer::first(const Ray& ray, bool for_camera) const {
    Query query(scene_->geometry);
    query.chance = ray.chance;
    query.for_camera = for_camera;
    RTCRayHit found{};
    found.ray = rtc_ray(ray);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene_->scene, query, found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{found.hit.primID, found.hit.u, found.hit.v};
}

void Tracer::all(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    Query query(scene_->geometry);
    query.chance = ray.chance;
    query.all = &hits;
    RTCRayHit found{};
    found.ray = rtc_ray(ray);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(scene_->scene, query, found);
}

bool Tracer::blocked(const glm::vec3& from, const glm::vec3& to, std::uint64_t chance) const {
    return blocked({from, to - from, 0.0f, 1.0f, chance});
}

bool Tracer::blocked(const Ray& ray) const {
    Query query(scene_->geometry);
    query.chance = ray.chance;
    RTCRay cast = rtc_ray(ray);
    occlude(scene_->scene, query, cast);
    return cast.tfar < 0.0f;
}

}  // namespace clgi::reference
