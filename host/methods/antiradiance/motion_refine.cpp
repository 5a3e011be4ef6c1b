// SPDX-License-Identifier: MIT
#include "methods/antiradiance/motion_refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "methods/antiradiance/solid_angle.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
// From the origin to what lies between two points.
double distance_to(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 edge = b - a;
    const double square = glm::dot(edge, edge);
    const double along = square > 0.0 ? std::clamp(-glm::dot(a, edge) / square, 0.0, 1.0) : 0.0;
    return glm::length(a + along * edge);
}

}  // namespace

std::vector<double> largest_radii(const std::vector<ElementTree>& poses) {
    std::vector<double> out = poses.front().radii;
    for (const ElementTree& pose : poses)
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], pose.radii[i]);
    return out;
}

MotionRefine::MotionRefine(const ElementTree& tree, const std::vector<ElementTree>& poses)
    : tree_(tree), poses_(poses), radii_(largest_radii(poses)) {
    for (const ElementTree& pose : poses) at_.emplace_back(pose, no_groups_, 0.0);
}

double MotionRefine::least_distance(std::size_t a, std::size_t b) const {
    double out = std::numeric_limits<double>::infinity();
    glm::dvec3 before = poses_[0].positions[b] - poses_[0].positions[a];
    for (const ElementTree& pose : poses_) {
        const glm::dvec3 way = pose.positions[b] - pose.positions[a];
        out = std::min(out, distance_to(before, way));
        before = way;
    }
    return out;
}

double MotionRefine::seen(std::size_t element, std::size_t from) const {
    const double distance = least_distance(element, from), radius = radii_[element];
    if (distance <= radius + radii_[from]) return std::numeric_limits<double>::infinity();
    double area = 0.0, height = 0.0;
    for (const ElementTree& pose : poses_) {
        const glm::dvec3 way = pose.positions[from] - pose.positions[element];
        area = std::max(area, pose.areas[element]);
        height = std::max(height, std::abs(glm::dot(pose.normals[element], way)));
    }
    const double angle = std::min(area, pi * radius * radius) / (distance * distance);
    if (!tree_.is_flat(element)) return angle;
    return angle * std::min(1.0, (height + radii_[from]) / distance);
}

bool MotionRefine::hidden(std::size_t sender, std::size_t receiver) const {
    if (!tree_.is_flat(receiver)) return false;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
        const ElementTree& pose = poses_[k];
        const bool collapsed =
            !pose.is_flat(receiver) || (pose.is_patch(sender) && !pose.is_flat(sender));
        if (!collapsed && !at_[k].hidden(sender, receiver)) return false;
    }
    return true;
}

bool MotionRefine::passes(std::size_t sender, std::size_t receiver) const {
    return std::any_of(at_.begin(), at_.end(),
                       [&](const Refine& pose) { return pose.passes(sender, receiver); });
}

bool MotionRefine::far_apart(std::size_t a, std::size_t b) const {
    return least_distance(a, b) * least_ahead > radii_[a] + radii_[b];
}

double MotionRefine::solid_angle(std::size_t sender, std::size_t receiver) const {
    double out = 0.0;
    for (const ElementTree& pose : poses_) {
        const glm::dvec3& eye = pose.positions[receiver];
        const glm::dvec3 way = eye - pose.positions[sender];
        const double square = glm::dot(way, way);
        if (!(square > 0.0)) continue;
        const double height = std::abs(glm::dot(pose.normals[sender], way));
        if (!tree_.is_patch(sender))
            out = std::max(out, pose.areas[sender] / square);
        else if (height > height_rounding * pose.radii[sender])
            out = std::max(out, clgi::solid_angle(pose.corners[sender], eye));
    }
    return out;
}

}  // namespace clgi
