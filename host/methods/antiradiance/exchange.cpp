// SPDX-License-Identifier: MIT
#include "methods/antiradiance/exchange.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "methods/antiradiance/faces.hpp"
#include "methods/antiradiance/parts.hpp"
#include "methods/antiradiance/refine.hpp"
#include "methods/antiradiance/solid_angle.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Form factors are divided by the sender's cosine with the bin, which the device computes in
// floats: a cosine of this size is exact to 1e-5 there. That of the receiver needs its sign alone.
constexpr double least_sent = 1e-2, least_received = 1e-6;

// Parts of a leaf that spans bins: small enough to tell bins apart, and no more than 4^8 of them
// where the receiver's position all but touches the leaf.
constexpr double part_share = 0.25;
constexpr int most_cuts = 8;

// Vertex patches, and groups of them, are points where their squared radius is less than this share
// of their squared distance. Of a flat one that is about the error of its solid angle; of a curved
// one its radius over its distance, times the sine of half the angle that it bends by, adds to
// that.
constexpr double far = 1e-2;

}  // namespace

void check_linking(const ElementTree& tree, const DirectionBins& bins, const LinkOptions& options,
                   const std::vector<ElementTree>& poses) {
    for (const ElementTree& pose : poses)
        if (pose.count() != tree.count())
            throw Error("make_links: a pose has " + std::to_string(pose.count()) +
                        " elements, the tree has " + std::to_string(tree.count()));
    if (!(options.bin_share > 0.0 && std::isfinite(options.bin_share)))
        throw Error("make_links: bin_share is " + std::to_string(options.bin_share) +
                    ", needs a number above 0");
    if (options.threads < 0 || options.threads > 1024)
        throw Error("make_links: threads is " + std::to_string(options.threads) +
                    ", 0 to 1024 needed");
    if (bins.count() < 2 || bins.count() > 65536 ||
        bins.solid_angles.size() != bins.directions.size())
        throw Error("make_links: " + std::to_string(bins.directions.size()) + " directions and " +
                    std::to_string(bins.solid_angles.size()) +
                    " solid angles of bins, needs 2 to 65536 and as many");
    if (tree.normals.size() != tree.count() || tree.corners.size() != tree.count())
        throw Error("make_links: the tree's arrays differ in length");
}

std::vector<double> hemisphere_scales(const ElementTree& tree, const DirectionBins& bins) {
    std::vector<double> out(tree.count(), 1.0);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        const std::uint32_t parent = tree.parents[i];
        if (parent != no_index && tree.normals[parent] == tree.normals[i])
            out[i] = out[parent];
        else if (tree.is_flat(i))
            out[i] = bins.hemisphere_scale(tree.normals[i]);
    }
    return out;
}

Exchange::Exchange(const ElementTree& tree, const DirectionBins& bins, const BinChoice& choose,
                   const std::vector<double>& scales, const LinkOptions& options,
                   std::shared_ptr<const SpreadTable> table, const PatchGroups& groups)
    : tree_(tree),
      bins_(bins),
      scales_(scales),
      choose_(choose),
      bin_(4.0 * pi / bins.count()),
      limit_(options.bin_share * bin_),
      spread_(options.spread),
      table_(std::move(table)),
      groups_(groups),
      sums_(bins.directions.size(), 0.0) {}

void Exchange::add(int bin, double solid_angle) {
    double& sum = sums_[static_cast<std::size_t>(bin)];
    if (sum == 0.0) used_.push_back(bin);
    sum += solid_angle;
}

bool Exchange::is_ahead(std::size_t sender, std::size_t receiver, int bin) const {
    const glm::dvec3 way = tree_.positions[receiver] - tree_.positions[sender];
    if (tree_.is_flat(sender) && glm::dot(tree_.normals[sender], way) > 0.0) return true;
    const double reach = (tree_.is_leaf(sender) ? 0.0 : tree_.radii[sender]) +
                         (tree_.is_leaf(receiver) ? 0.0 : tree_.radii[receiver]);
    return glm::dot(way, bins_.directions[static_cast<std::size_t>(bin)]) > reach;
}

// Gives each part that is in front of the receiver to the bin of its own direction.
void Exchange::spread(const Corners& p, double angle, int depth) {
    if (angle > part_share * bin_ && depth < most_cuts) {
        const glm::dvec3 m[3] = {0.5 * (p[0] + p[1]), 0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0])};
        for (const Corners& part : {Corners{p[0], m[0], m[2]}, Corners{m[0], p[1], m[1]},
                                    Corners{m[2], m[1], p[2]}, Corners{m[0], m[1], m[2]}})
            spread(part, solid_angle(part, eye_), depth + 1);
        return;
    }
    if (angle > 0.0) send(eye_ - centroid(p), angle);
}

void Exchange::send(const glm::dvec3& way, double angle) {
    const double distance = glm::length(way);
    if (!(distance > 0.0) || !arrives(way)) return;
    if (const std::optional<int> bin = choose_(way / distance, sends_, receives_)) add(*bin, angle);
}

// Bins of the wrong side take no part; the others, among them the middle one, share all of it.
void Exchange::spread_around(int bin, double angle) {
    const auto meets = [&](const SpreadShare& share) {
        const glm::dvec3& w = bins_.directions[static_cast<std::size_t>(share.bin)];
        return sends_.met(w) && receives_.met(w);
    };
    const std::vector<SpreadShare>& shares = table_->row(bin, angle);
    double all = 0.0;
    for (const SpreadShare& share : shares) all += meets(share) ? share.weight : 0.0;
    for (const SpreadShare& share : shares)
        if (meets(share)) add(share.bin, angle * share.weight / all);
}

double Exchange::cut_vertex_patches(std::uint32_t sender, double side) {
    halves_.clear();
    points_.clear();
    double sum = 0.0;
    // True: it is far away and no larger than a part that bins tell apart, so it is a point.
    const auto put_point = [&](const glm::dvec3& middle, const glm::dvec3& turned,
                               double square_radius) {
        const glm::dvec3 way = eye_ - middle;
        const double square = glm::dot(way, way);
        if (!(square_radius < far * square)) return false;
        const double angle = side * glm::dot(turned, way) / (square * std::sqrt(square));
        if (std::abs(angle) > part_share * bin_) return false;
        sum += angle;
        if (angle > 0.0) points_.emplace_back(way, angle);
        return true;
    };
    const std::span<const PatchGroup> groups = groups_.of(sender);
    for (std::size_t g = 0; g < groups.size();) {
        const PatchGroup& group = groups[g++];
        if (put_point(group.middle, group.vector_area, group.square_radius)) {
            g = group.next;
            continue;
        }
        for (std::uint32_t k = group.first; k < group.end; ++k) {
            const VertexPatch& vertex_patch = tree_.vertex_patches[groups_.vertex_patches()[k]];
            const glm::dvec3 middle = centroid(vertex_patch);
            if (put_point(middle, vector_area(vertex_patch), square_reach(vertex_patch, middle)))
                continue;
            const std::array<glm::dvec3, 4> p = outline(vertex_patch);
            for (const Corners& half : {Corners{p[0], p[1], p[2]}, Corners{p[0], p[2], p[3]}}) {
                const double angle = side * signed_solid_angle(half, eye_);
                sum += angle;
                if (angle > 0.0) halves_.emplace_back(half, angle);
            }
        }
    }
    return sum;
}

void Exchange::spread_vertex_patches(double angle) {
    double seen = 0.0;
    for (const auto& [way, part] : points_) {
        seen += part;
        send(way, part);
    }
    for (const auto& [half, part] : halves_) {
        seen += part;
        spread(half, part, 0);
    }
    for (const int bin : used_) sums_[static_cast<std::size_t>(bin)] *= angle / seen;
}

double Exchange::aim(std::uint32_t sender, std::uint32_t receiver) {
    eye_ = tree_.positions[receiver];
    const glm::dvec3 way = eye_ - tree_.positions[sender];
    const double distance = glm::length(way);
    receives_ = {-tree_.normals[receiver], least_received};
    sends_ = {};
    near_ = false;
    if (!(distance > 0.0)) return 0.0;
    double angle = tree_.areas[sender] / (distance * distance);
    near_ = tree_.is_vertex(sender) && angle > limit_;
    if (!tree_.is_flat(sender)) return angle;
    const double height = glm::dot(tree_.normals[sender], way);
    sends_ = {height > 0.0 ? tree_.normals[sender] : -tree_.normals[sender], least_sent};
    angle = tree_.is_patch(sender) ? solid_angle(tree_.corners[sender], eye_)
            : near_                ? cut_vertex_patches(sender, height > 0.0 ? 1.0 : -1.0)
            : tree_.is_vertex(sender)
                ? groups_.flatness(sender) * angle * std::abs(height) / distance
                : std::min(angle * std::abs(height) / distance, 2.0 * pi);
    // In the sender's plane rounding would choose a side, within the sender for 2 pi.
    return std::abs(height) > height_rounding * tree_.radii[sender] ? angle : 0.0;
}

float Exchange::form_factor(std::uint32_t sender, std::uint32_t receiver, int bin,
                            double angle) const {
    const auto j = static_cast<std::size_t>(bin);
    // What the sender's intensity in this bin is for radiance 1, per area.
    const double cosine = tree_.is_flat(sender)
                              ? scales_[sender] * glm::dot(sends_.normal, bins_.directions[j])
                              : 1.0;
    const double factor = angle / (tree_.areas[sender] * cosine * bins_.solid_angles[j]);
    const auto rounded = static_cast<float>(factor);
    if (!std::isfinite(rounded))
        throw InputError("make_links: the form factor of element " + std::to_string(sender) +
                         " to " + std::to_string(receiver) + " is " + std::to_string(factor) +
                         ", too large for floats");
    return rounded;
}

void Exchange::operator()(std::uint32_t sender, std::uint32_t receiver, std::vector<Link>& out) {
    const double angle = aim(sender, receiver);
    const glm::dvec3 way = eye_ - tree_.positions[sender];
    const double distance = glm::length(way);
    // A leaf that spans bins may have parts in front of the receiver where its middle is behind.
    const bool parts = (tree_.is_patch(sender) || near_) && spread_ == Spread::precise;
    if (!(angle > 0.0) || (!parts && !arrives(way))) return;

    if (parts && angle > limit_) {
        if (near_)
            spread_vertex_patches(angle);
        else
            spread(tree_.corners[sender], angle, 0);
    } else if (arrives(way)) {
        if (const std::optional<int> bin = choose_(way / distance, sends_, receives_)) {
            if (table_)
                spread_around(*bin, angle);
            else
                add(*bin, angle);
        }
    }
    if (angle > limit_ && !used_.empty()) ++unrefined_;

    for (const int bin : used_) {
        const double sum = std::exchange(sums_[static_cast<std::size_t>(bin)], 0.0);
        if (!is_ahead(sender, receiver, bin)) continue;
        out.push_back({receiver, sender, static_cast<std::uint16_t>(bin), static_part,
                       form_factor(sender, receiver, bin, sum)});
    }
    used_.clear();
}

void Exchange::slots(std::uint32_t sender, std::uint32_t receiver, double angle,
                     std::vector<Link>& out) {
    if (!(angle > 0.0)) return;
    int cuts = 0;
    if (tree_.is_patch(sender) && spread_ != Spread::none)
        while (cuts < most_part_cuts && angle > std::ldexp(limit_, 2 * cuts)) ++cuts;
    for (std::uint32_t part = first_part(cuts); part < first_part(cuts + 1); ++part)
        out.push_back(slot(sender, receiver, part));
    if (angle > limit_) ++unrefined_;
}

Link Exchange::slot(std::uint32_t sender, std::uint32_t receiver, std::uint32_t part) {
    Link out{receiver, sender, 0, static_cast<std::uint16_t>(part), 0.0f};
    double angle = aim(sender, receiver);
    glm::dvec3 from = tree_.positions[sender];
    if (tree_.is_patch(sender)) {
        const Corners corners = part_of(tree_.corners[sender], part);
        from = centroid(corners);
        if (angle > 0.0) angle = solid_angle(corners, eye_);
        if (!tree_.is_flat(sender)) return out;
    }
    const glm::dvec3 way = eye_ - from;
    const double distance = glm::length(way);
    if (!(angle > 0.0 && distance > 0.0)) return out;
    // Among pairs that some pose shows to each other are such as lie in one plane in another pose.
    const double rise = glm::dot(receives_.normal, way);
    if (tree_.is_flat(receiver) && !(rise > least_rise * distance)) return out;
    const std::optional<int> bin = choose_(way / distance, sends_, receives_);
    if (!bin || !is_ahead(sender, receiver, *bin)) return out;
    out.bin = static_cast<std::uint16_t>(*bin);
    out.form_factor = form_factor(sender, receiver, *bin, angle);
    return out;
}

}  // namespace clgi
