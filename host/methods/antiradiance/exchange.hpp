// The links of one pair of elements: bins and form factors. [Dachsbacher07, section 3.1]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/links.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "methods/antiradiance/bin_choice.hpp"
#include "methods/antiradiance/patch_groups.hpp"
#include "methods/antiradiance/spread_table.hpp"

namespace clgi {

constexpr std::uint16_t static_part = 0xffff;

struct Link {
    std::uint32_t receiver, sender;
    std::uint16_t bin;
    std::uint16_t part;  // of the sender, see part_of(); static_part: no end of the link moves
    float form_factor;
};

// Throws Error for what cannot be linked.
void check_linking(const ElementTree& tree, const DirectionBins& bins, const LinkOptions& options,
                   const std::vector<ElementTree>& poses);

// [elements] DirectionBins::hemisphere_scale of flat ones' normals.
std::vector<double> hemisphere_scales(const ElementTree& tree, const DirectionBins& bins);

// Not for several threads: it has sums of its own.
class Exchange {
public:
    // scales: of hemisphere_scales()
    // table: for Spread::gaussian
    Exchange(const ElementTree& tree, const DirectionBins& bins, const BinChoice& choose,
             const std::vector<double>& scales, const LinkOptions& options,
             std::shared_ptr<const SpreadTable> table, const PatchGroups& groups);

    // Appends the links from sender to receiver.
    void operator()(std::uint32_t sender, std::uint32_t receiver, std::vector<Link>& out);

    // The same for a pair of which an end moves: a link for each of the parts that the sender is
    // cut to, whether it brings light as the tree is or not. solid_angle: the largest that the
    // sender has from the receiver, sr.
    void slots(std::uint32_t sender, std::uint32_t receiver, double solid_angle,
               std::vector<Link>& out);

    // One of these links. Form factor and bin are 0 where no light arrives from that part.
    Link slot(std::uint32_t sender, std::uint32_t receiver, std::uint32_t part);

    std::size_t unrefined() const { return unrefined_; }

private:
    using Corners = std::array<glm::dvec3, 3>;

    // Makes a pair the present one: sr of the sender from the receiver's position, and what both
    // demand of bins; 0 where neither light nor antiradiance arrives.
    double aim(std::uint32_t sender, std::uint32_t receiver);
    // Throws InputError if it is too large for floats.
    float form_factor(std::uint32_t sender, std::uint32_t receiver, int bin,
                      double solid_angle) const;
    // Light on `way` meets the front of the receiver, or the receiver has no front.
    bool arrives(const glm::dvec3& way) const { return glm::dot(receives_.normal, way) >= 0.0; }
    void add(int bin, double solid_angle);
    // Light that was let through comes from behind to what lies further along the bin, or it could
    // go round in a bin for ever [derived: then antiradiance is exact after as many steps as
    // elements lie behind each other, because no path along a bin returns].
    bool is_ahead(std::size_t sender, std::size_t receiver, int bin) const;
    void spread(const Corners& corners, double solid_angle, int depth);
    void spread_around(int bin, double solid_angle);
    // To the bin of a direction towards the receiver.
    void send(const glm::dvec3& way, double solid_angle);
    // Of a leaf at a vertex: cuts its vertex patches into points and halves and adds up their solid
    // angles, those that face away from the side (1: front, -1: back) as negative. So the sum
    // depends on the outline of the leaf alone, and a closed surface of leaves covers what it hides
    // once.
    double cut_vertex_patches(std::uint32_t sender, double side);
    // Those that face that side, together as large as the sum.
    void spread_vertex_patches(double solid_angle);

    const ElementTree& tree_;
    const DirectionBins& bins_;
    const std::vector<double>& scales_;
    const BinChoice& choose_;
    const double bin_;  // sr, mean
    const double limit_;
    const Spread spread_;
    const std::shared_ptr<const SpreadTable> table_;  // of Spread::gaussian alone
    const PatchGroups& groups_;
    std::size_t unrefined_ = 0;

    // Of the present pair.
    glm::dvec3 eye_{0.0};  // the receiver's position
    BinDemand sends_, receives_;
    bool near_ = false;  // the sender is a leaf at a vertex, and its vertex patches count
    std::vector<std::pair<Corners, double>> halves_;  // of vertex patches, with their solid angles
    std::vector<std::pair<glm::dvec3, double>>
        points_;                // way and solid angle of far vertex patches
    std::vector<double> sums_;  // [bins] sr; zero between calls
    std::vector<int> used_;     // bins that are not zero
};

}  // namespace clgi
