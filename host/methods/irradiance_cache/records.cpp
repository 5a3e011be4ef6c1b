// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/records.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr std::size_t most_in_block = 4;
constexpr float alike = 0.9f;      // cosine between normals that one record stands in for
constexpr float off_plane = 0.3f;  // distance off the plane, of the distance
constexpr int importance_steps = 8;
constexpr float widest = 0.6f, narrowest = 0.01f, narrower = 0.75f;  // spacing by distance

bool exists(const CacheRecord& record) { return glm::dot(record.normal, record.normal) > 0.0f; }

bool stands_in(const CacheRecord& record, const CacheRecord& pixel) {
    const glm::vec3 d = pixel.position - record.position;
    return glm::dot(record.normal, pixel.normal) > alike &&
           std::abs(glm::dot(record.normal, d)) <= off_plane * glm::length(d);
}

}  // namespace

int block_side(int width, int height, int count) {
    const double area = static_cast<double>(width) * height;
    return std::max(1, static_cast<int>(std::sqrt(area / count)));
}

void keep_what_is_reflected(std::vector<float>& doubt, const std::vector<float>& base,
                            std::size_t stride) {
    constexpr double least = 0.04;
    for (std::size_t i = 0; i < doubt.size(); ++i) {
        const double share =
            std::max(least, luminance(glm::dvec3(base[i], base[stride + i], base[2 * stride + i])));
        doubt[i] = static_cast<float>(double{doubt[i]} * share * share);
    }
}

double relative_doubt(const std::vector<float>& doubt, const std::vector<float>& radiance,
                      std::size_t stride, double exposure) {
    double squares = 0.0, sum = 0.0, pixels = 0.0;
    for (std::size_t i = 0; i < doubt.size(); ++i) {
        const double seen =
            luminance(glm::dvec3(radiance[i], radiance[stride + i], radiance[2 * stride + i]));
        if (!std::isfinite(doubt[i]) || !std::isfinite(seen)) continue;
        squares += double{doubt[i]};
        sum += seen;
        pixels += 1.0;
    }
    return sum > 0.0 ? exposure / std::numbers::pi * std::sqrt(squares * pixels) / sum : 0.0;
}

std::vector<CacheRecord> doubtful_records(const std::vector<CacheRecord>& pixels,
                                          const std::vector<float>& doubt, int width, int height,
                                          int side, std::size_t count) {
    struct Block {
        double sum = 0.0;
        std::size_t pixel = 0;  // that is most in doubt
    };
    const int across = (width + side - 1) / side, down = (height + side - 1) / side;
    std::vector<Block> blocks(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x);
            if (!(doubt[at] > 0.0f) || !std::isfinite(doubt[at]) || !exists(pixels[at])) continue;
            Block& block = blocks[static_cast<std::size_t>(y / side * across + x / side)];
            if (!(block.sum > 0.0) || doubt[at] > doubt[block.pixel]) block.pixel = at;
            block.sum += double{doubt[at]};
        }
    std::erase_if(blocks, [](const Block& block) { return !(block.sum > 0.0); });
    count = std::min(count, blocks.size());
    std::partial_sort(blocks.begin(), blocks.begin() + static_cast<std::ptrdiff_t>(count),
                      blocks.end(), [](const Block& a, const Block& b) { return a.sum > b.sum; });
    std::vector<CacheRecord> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back(pixels[blocks[k].pixel]);
    return out;
}

std::vector<CacheRecord> seen_records(const std::vector<CacheRecord>& pixels, int width, int height,
                                      int count) {
    const int side = block_side(width, height, count);
    std::vector<CacheRecord> out;
    for (int top = 0; top < height; top += side)
        for (int left = 0; left < width; left += side) {
            const int across = std::min(side, width - left), down = std::min(side, height - top);
            const std::size_t first = out.size();
            // The middle of the block first.
            for (int k = 0; k < across * down && out.size() - first < most_in_block; ++k) {
                const int at = (k + (down / 2) * across + across / 2) % (across * down);
                const CacheRecord& pixel = pixels[static_cast<std::size_t>(top + at / across) *
                                                      static_cast<std::size_t>(width) +
                                                  static_cast<std::size_t>(left + at % across)];
                if (!exists(pixel)) continue;
                const bool known = std::any_of(
                    out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                    [&](const CacheRecord& record) { return stands_in(record, pixel); });
                if (!known) out.push_back(pixel);
            }
        }
    return out;
}

void add_records(std::vector<CacheRecord>& records, const std::vector<CacheRecord>& candidates,
                 const std::vector<std::size_t>& viewers, std::size_t count) {
    const std::size_t before = records.size(), most = before + count;
    std::vector<char> taken(candidates.size(), 0);
    for (float spacing = widest; spacing > narrowest && records.size() < most; spacing *= narrower)
        for (std::size_t i = 0; i < candidates.size() && records.size() < most; ++i) {
            const CacheRecord& candidate = candidates[i];
            if (taken[i] || !exists(candidate)) continue;
            const glm::vec3 away = candidate.position - records[viewers[i]].position;
            const float apart = spacing * spacing * glm::dot(away, away);
            const bool near =
                std::any_of(records.begin(), records.end(), [&](const CacheRecord& record) {
                    const glm::vec3 d = candidate.position - record.position;
                    return glm::dot(d, d) < apart &&
                           glm::dot(record.normal, candidate.normal) > alike;
                });
            if (near) continue;
            records.push_back(candidate);
            taken[i] = 1;
        }
}

std::vector<double> importance_of(std::size_t records, std::size_t seen,
                                  const WeighedPicks& picks) {
    std::vector<double> first(records, 0.0);
    std::fill_n(first.begin(), seen, 1.0 / static_cast<double>(seen));
    std::vector<double> out = first;
    for (int step = 0; step < importance_steps; ++step) {
        std::vector<double> next = first;
        for (std::size_t i = 0; i < picks.nearest.size(); ++i)
            if (picks.nearest[i] < records)
                next[picks.nearest[i]] += out[i / picks.by_each] * double{picks.reflectance[i]} /
                                          static_cast<double>(picks.by_each);
        out.swap(next);
    }
    return out;
}

void split_cells(std::vector<CacheRecord>& records, std::size_t seen, const WeighedPicks& picks,
                 std::size_t count) {
    struct Candidate {
        const CacheRecord* place;
        double worth, apart;  // square of its distance to the cell's records
    };
    struct Cell {
        double worth = 0.0;
        std::vector<Candidate> candidates;
    };
    const auto apart = [](const CacheRecord& a, const CacheRecord& b) {
        const glm::dvec3 d = glm::dvec3(a.position) - glm::dvec3(b.position);
        return glm::dot(d, d);
    };
    const std::vector<double> importance = importance_of(records.size(), seen, picks);
    std::vector<Cell> cells(records.size() + 1);  // the last one: where no record counts
    for (std::size_t i = 0; i < picks.places.size(); ++i) {
        const std::size_t viewer = i / picks.by_each;
        const double worth = double{picks.worth[i]} * importance[viewer];
        if (!(worth > 0.0) || !std::isfinite(worth)) continue;
        const bool counts = picks.nearest[i] < records.size();
        Cell& cell = counts ? cells[picks.nearest[i]] : cells.back();
        cell.worth += worth;
        cell.candidates.push_back(
            {&picks.places[i], worth,
             apart(picks.places[i], records[counts ? picks.nearest[i] : viewer])});
    }
    const auto less = [&](std::size_t a, std::size_t b) { return cells[a].worth < cells[b].worth; };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(less)> next(less);
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (!cells[k].candidates.empty()) next.push(k);
    for (const std::size_t most = records.size() + count; records.size() < most && !next.empty();) {
        const std::size_t at = next.top();
        next.pop();
        Cell& cell = cells[at];
        const auto best = std::max_element(cell.candidates.begin(), cell.candidates.end(),
                                           [](const Candidate& a, const Candidate& b) {
                                               return a.worth * a.apart < b.worth * b.apart;
                                           });
        if (!(best->worth * best->apart > 0.0)) continue;
        records.push_back(*best->place);
        for (Candidate& other : cell.candidates)
            other.apart = std::min(other.apart, apart(*other.place, records.back()));
        cell.worth *= 0.5;
        next.push(at);
    }
}

}  // namespace clgi
