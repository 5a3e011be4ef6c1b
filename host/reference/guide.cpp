// SPDX-License-Identifier: MIT
#include "reference/guide.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clgi::reference {
namespace {

constexpr std::size_t enough = 400;  // of a cell: what paths met
constexpr float whole_turn = 2.0f * std::numbers::pi_v<float>;

}  // namespace

std::size_t Guide::Cell::bin_of(const glm::vec3& direction) {
    const float turn = std::atan2(direction.x, -direction.z) / whole_turn + 0.5f;
    const auto at = [](float share, std::size_t count) {
        const auto below = static_cast<std::ptrdiff_t>(share * static_cast<float>(count));
        return static_cast<std::size_t>(
            std::clamp(below, std::ptrdiff_t{0}, static_cast<std::ptrdiff_t>(count) - 1));
    };
    return at(0.5f * (direction.y + 1.0f), rings) * sectors + at(turn, sectors);
}

float Guide::Cell::density(const glm::vec3& direction) const {
    const std::size_t bin = bin_of(direction);
    const float share = sums[bin] - (bin > 0 ? sums[bin - 1] : 0.0f);
    return share * static_cast<float>(bins) / (2.0f * whole_turn);
}

glm::vec3 Guide::Cell::sample(Random& random) const {
    const auto found = std::upper_bound(sums.begin(), sums.end(), random() * sums.back());
    const auto bin = std::min(static_cast<std::size_t>(found - sums.begin()), bins - 1);
    const auto ring = static_cast<float>(bin / sectors), sector = static_cast<float>(bin % sectors);
    const float y = 2.0f * (ring + random()) / static_cast<float>(rings) - 1.0f;
    const float angle = whole_turn * ((sector + random()) / static_cast<float>(sectors) - 0.5f);
    const float across = std::sqrt(std::max(1.0f - y * y, 0.0f));
    return {across * std::sin(angle), y, -across * std::cos(angle)};
}

Guide::Guide(std::vector<Met> met) {
    met.erase(std::remove_if(
                  met.begin(), met.end(),
                  [](const Met& one) { return !(one.light > 0.0f && std::isfinite(one.light)); }),
              met.end());
    if (met.size() >= enough) divide(met.begin(), met.end());
}

// The longest side of what lies here is cut in the middle of its places.
void Guide::divide(Part first, Part last) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    const auto count = static_cast<std::size_t>(last - first);
    glm::vec3 low = first->place, high = first->place;
    for (Part one = first; one != last; ++one) {
        low = glm::min(low, one->place);
        high = glm::max(high, one->place);
    }
    const glm::vec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const Part middle = first + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(first, middle, last,
                     [&](const Met& a, const Met& b) { return a.place[axis] < b.place[axis]; });
    if (count >= 2 * enough && low[axis] < middle->place[axis]) {
        nodes_[node].axis = axis;
        nodes_[node].middle = middle->place[axis];
        divide(first, middle);
        nodes_[node].above = nodes_.size();
        divide(middle, last);
        return;
    }
    nodes_[node].above = cells_.size();
    Cell& cell = cells_.emplace_back();
    std::array<double, Cell::bins> light{};
    for (Part one = first; one != last; ++one) light[Cell::bin_of(one->direction)] += one->light;
    double sum = 0.0, all = 0.0;
    for (const double bin : light) all += bin;
    for (std::size_t bin = 0; bin < Cell::bins; ++bin)
        cell.sums[bin] = static_cast<float>((sum += light[bin]) / all);
}

const Guide::Cell* Guide::at(const glm::vec3& place) const {
    if (nodes_.empty()) return nullptr;
    std::size_t node = 0;
    while (nodes_[node].axis >= 0) {
        const Node& one = nodes_[node];
        node = place[one.axis] < one.middle ? node + 1 : one.above;
    }
    return &cells_[nodes_[node].above];
}

}  // namespace clgi::reference
