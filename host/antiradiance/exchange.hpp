// The links of one pair of elements: bins and form factors. [Dachsbacher07, section 3.1]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/links.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "antiradiance/bin_choice.hpp"
#include "antiradiance/spread_table.hpp"

namespace clgi {

struct Link {
    std::uint32_t receiver, sender, bin;
    float form_factor;
};

// Not for several threads: it has sums of its own.
class Exchange {
public:
    // scales: [elements] DirectionBins::hemisphere_scale of flat ones' normals
    // table: for Spread::gaussian
    Exchange(const ElementTree& tree, const DirectionBins& bins, const std::vector<double>& scales,
             const LinkOptions& options, std::shared_ptr<const SpreadTable> table);

    // Appends the links from sender to receiver.
    void operator()(std::uint32_t sender, std::uint32_t receiver, std::vector<Link>& out);

    std::size_t unrefined() const { return unrefined_; }

private:
    using Corners = std::array<glm::dvec3, 3>;

    // Light on `way` meets the front of the receiver, or the receiver has no front.
    bool arrives(const glm::dvec3& way) const { return glm::dot(receives_.normal, way) >= 0.0; }
    void add(int bin, double solid_angle);
    // Light that was let through comes from behind to what lies further along the bin, or it could
    // go round in a bin for ever [derived: then antiradiance is exact after as many steps as
    // elements lie behind each other, because no path along a bin returns].
    bool is_ahead(std::size_t sender, std::size_t receiver, int bin) const;
    void spread(const Corners& corners, double solid_angle, int depth);
    void spread_around(int bin, double solid_angle);
    // Of a leaf at a vertex: cuts its thirds into halves and adds up their solid angles, those that
    // face away from the side (1: front, -1: back) as negative. So the sum depends on the outline
    // of the leaf alone, and a closed surface of leaves covers what it hides once.
    double cut_thirds(std::uint32_t sender, double side);
    // The halves that face that side, together as large as the sum.
    void spread_thirds(double solid_angle);

    const ElementTree& tree_;
    const DirectionBins& bins_;
    const std::vector<double>& scales_;
    const BinChoice choose_;
    const double bin_;  // sr, mean
    const double limit_;
    const Spread spread_;
    const std::shared_ptr<const SpreadTable> table_;  // of Spread::gaussian alone
    std::size_t unrefined_ = 0;

    // Of the present pair.
    glm::dvec3 eye_{0.0};  // the receiver's position
    BinDemand sends_, receives_;
    std::vector<std::pair<Corners, double>> halves_;  // of thirds, with their solid angles
    std::vector<double> sums_;                        // [bins] sr; zero between calls
    std::vector<int> used_;                           // bins that are not zero
};

}  // namespace clgi
