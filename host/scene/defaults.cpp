// A camera and a light for scenes that come without: inside for a room, outside for an object.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/scene.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scene/local_frame.hpp"
#include "scene/rays.hpp"

namespace clgi {

namespace {

constexpr double field_of_view = 0.7;  // radians, vertical

struct Hit {
    double distance = std::numeric_limits<double>::infinity();
    bool front = false;
};

// What rays from inside a scene meet.
class Obstacles {
public:
    explicit Obstacles(const Scene& scene)
        : frame_(local_frame(bounds(scene))),
          triangles_(local_triangles(scene, frame_)),
          blockers_(triangles_) {}
    Obstacles(const Obstacles&) = delete;
    Obstacles& operator=(const Obstacles&) = delete;

    std::vector<Hit> first_hits(const glm::dvec3& origin,
                                const std::vector<glm::dvec3>& directions) const {
        Rays rays;
        for (const glm::dvec3& direction : directions)
            rays.add(frame_.to_local(origin), glm::normalize(direction),
                     std::numeric_limits<double>::infinity());
        rays.trace(blockers_);
        std::vector<Hit> hits(directions.size());
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (rays.met(i))
                hits[i] = {rays.distance(i) / frame_.scale,
                           glm::dot(directions[i], triangles_[rays.triangle(i)].normal) < 0.0};
        return hits;
    }

private:
    SceneFrame frame_;
    std::vector<LocalTriangle> triangles_;
    Blockers blockers_;
};

// Even on the sphere: a spiral whose turns are the golden angle apart.
std::vector<glm::dvec3> even_directions(int count) {
    std::vector<glm::dvec3> directions;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count;
        const double around = std::sqrt(1.0 - y * y);
        const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
        directions.emplace_back(around * std::cos(angle), y, around * std::sin(angle));
    }
    return directions;
}

double front_share(const std::vector<Hit>& hits) {
    const auto front =
        std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.front; });
    return static_cast<double>(front) / static_cast<double>(hits.size());
}

struct Stand {  // where a camera inside a room could be
    bool found = false;
    glm::dvec3 position = glm::dvec3(0.0);
    glm::dvec3 forward = glm::dvec3(0.0, 0.0, -1.0);
    bool open_above = false;
};

// The mean distance that a picture would show; 0 when much of it looks out of an open side.
double view_length(const Obstacles& obstacles, const Stand& stand) {
    constexpr double seen = 0.8;
    const glm::dvec3 right = glm::cross(stand.forward, glm::dvec3(0.0, 1.0, 0.0));
    std::vector<glm::dvec3> rays;
    for (const double x : {-0.36, -0.18, 0.0, 0.18, 0.36}) {
        for (const double y : {-0.36, -0.18, 0.0, 0.18, 0.36}) {
            rays.push_back(stand.forward + x * right + y * glm::dvec3(0.0, 1.0, 0.0));
        }
    }
    double sum = 0.0;
    double ended = 0.0;
    for (const Hit& hit : obstacles.first_hits(stand.position, rays)) {
        if (!std::isfinite(hit.distance)) continue;
        sum += hit.distance;
        ended += 1.0;
    }
    return ended < seen * static_cast<double>(rays.size()) ? 0.0 : sum / ended;
}

// A place is inside a room when most directions end on the front of something. A centre alone
// would not do: a table may stand there, and walls modelled as solids face both ways.
Stand find_stand(const Scene& scene) {
    constexpr double enclosed = 0.72;      // a floor alone gives one half, a box without a wall 5/6
    constexpr double shortest_view = 0.2;  // of the length; among many objects it is shorter
    const Bounds box = bounds(scene);
    const glm::dvec3 size = box.high - box.low;
    const int axis = size.x > size.z ? 0 : 2;
    if (!(std::min(std::min(size.x, size.y), size.z) > 0.0)) return {};

    const Obstacles obstacles(scene);
    const double work = 4e6 / static_cast<double>(scene.triangles.size() + 1);
    const std::vector<glm::dvec3> around =
        even_directions(static_cast<int>(std::clamp(work, 16.0, 96.0)));
    Stand best;
    double longest_view = shortest_view * size[axis];
    for (const double inset : {0.1, 0.2, 0.3}) {
        for (const double side : {1.0, -1.0}) {  // from the far end first: it looks along -axis
            Stand stand;
            stand.position = box.low + size * glm::dvec3(0.5, 0.4, 0.5);
            stand.position[axis] =
                (side > 0 ? box.high : box.low)[axis] - side * inset * size[axis];
            stand.forward = glm::dvec3(0.0);
            stand.forward[axis] = -side;

            const std::vector<Hit> hits = obstacles.first_hits(stand.position, around);
            if (front_share(hits) < enclosed) continue;
            const double view = view_length(obstacles, stand);
            if (view <= longest_view) continue;
            longest_view = view;
            stand.found = true;
            const Hit above = obstacles.first_hits(stand.position, {glm::dvec3(0.0, 1.0, 0.0)})[0];
            stand.open_above = !std::isfinite(above.distance);
            best = stand;
        }
    }
    return best;
}

Camera looking(const glm::dvec3& position, const glm::dvec3& forward) {
    Camera camera;
    camera.name = "default";
    camera.position = position;
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
    camera.forward = glm::vec3(forward);
    camera.right = glm::vec3(right);
    camera.up = glm::vec3(glm::cross(right, forward));
    camera.vertical_fov = static_cast<float>(field_of_view);
    return camera;
}

}  // namespace

Camera default_camera(const Scene& scene) {
    const Stand stand = find_stand(scene);
    if (stand.found) return looking(stand.position, stand.forward);

    // From the front, right and above, so far that a sphere around everything fits the picture.
    const Bounds box = bounds(scene);
    const double radius = glm::length(box.high - box.low) / 2.0;
    const double distance = (radius > 0.0 ? radius : 1.0) / std::sin(field_of_view / 2.0);
    const glm::dvec3 forward = -glm::normalize(glm::dvec3(0.6, 0.45, 1.0));
    return looking((box.low + box.high) * 0.5 - forward * distance, forward);
}

Light default_light(const Scene& scene) {
    const Stand stand = find_stand(scene);
    // Over the shoulder of the default camera; into a roofless room steeply, so that it reaches
    // the floor.
    const glm::vec3 slant = stand.found && stand.open_above ? glm::vec3(-0.12f, -1.0f, -0.17f)
                                                            : glm::vec3(-0.35f, -1.0f, -0.5f);
    Light light;
    light.name = "default";
    light.kind = Light::Kind::directional;
    light.direction = glm::normalize(slant);
    light.intensity = glm::vec3(std::numbers::pi_v<float>);
    return light;
}

void add_defaults(Scene& scene) {
    if (scene.cameras.empty()) scene.cameras.push_back(default_camera(scene));
    if (scene.lights.empty() && !has_emission(scene) && !scene.environment)
        scene.lights.push_back(default_light(scene));
}

}  // namespace clgi
