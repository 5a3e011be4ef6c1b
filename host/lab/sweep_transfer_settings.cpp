// SPDX-License-Identifier: MIT
#include "lab/sweep_settings.hpp"
#include "lab/sweep_transfer.hpp"

namespace clgi::lab {
namespace {

using Values = std::vector<int>;

constexpr CellIntegral integrals[] = {CellIntegral::monte_carlo, CellIntegral::centre,
                                      CellIntegral::exact};

const char* name_of(CellIntegral cells) {
    return cells == CellIntegral::exact    ? "exact"
           : cells == CellIntegral::centre ? "centre"
                                           : "monte-carlo";
}

class List {
public:
    List(bool quick, std::size_t triangles, bool levels, bool moves, const BuildOptions& build)
        : quick_(quick), levels_(levels), moves_(moves) {
        fine_.method = transfer_fine;
        fine_.options.build = build;
        levels_base_ = fine_;
        levels_base_.method = transfer_levels;
        // Meshes below a hundred triangles are hardly the scene's any more.
        for (const std::size_t share : {128, 64, 32, 16, 8, 4})
            if (triangles / share >= 100) counts_.push_back(static_cast<int>(triangles / share));
        if (counts_.empty()) levels_ = false;
        sets_base_ = fine_;
        sets_base_.method = transfer_sets;
        sets_base_.looks = moves_ ? 16 : 1;
        if (levels_) levels_base_.coarse = static_cast<std::size_t>(counts_[counts_.size() / 2]);
    }

    std::vector<TransferSettings> operator()() {
        const auto mask = [](TransferSettings& to, int n) { to.options.masks.size = n; };
        const auto block = [](TransferSettings& to, int n) { to.options.masks.block = n; };
        const auto cells = [](TransferSettings& to, int n) { to.options.cells = integrals[n]; };
        const auto table = [](TransferSettings& to, int n) {
            to.options.masks.planes = n > 0 ? EdgePlanes::table : EdgePlanes::exact;
            if (n > 0) to.options.masks.table_size = n;
        };
        const auto order = [](TransferSettings& to, int n) { to.options.masks.bands = n + 1; };
        const auto coarse = [](TransferSettings& to, int n) {
            to.coarse = static_cast<std::size_t>(n);
        };
        const auto rings = [](TransferSettings& to, int n) { to.options.rings = n; };
        const auto looks = [](TransferSettings& to, int n) { to.looks = n; };
        vary(fine_, "mask", {8, 32}, {8, 16, 32, 64, 128}, mask);
        vary(fine_, "mask-block", {8, 2}, {8, 4, 2, 1}, block);
        vary(fine_, "cells", {0, 1, 2}, {0, 1, 2}, cells);
        vary(fine_, "table", {32, 0}, {32, 64, 128, 256, 0}, table);
        vary(fine_, "sh-order", {2, 4}, {2, 3, 4, 5, 6, 7, 8}, order);
        if (levels_) {
            vary(levels_base_, "coarse", {counts_.front(), counts_.back()}, counts_, coarse);
            vary(levels_base_, "rings", {0, 1}, {0, 1, 2}, rings);
        }
        if (moves_)
            vary(sets_base_, "looks", {2, 8}, {1, 4, 16, 64}, looks);
        else
            vary(sets_base_, "looks", {1}, {1}, looks);
        if (quick_) return std::move(out_);
        for (const int size : {8, 16, 32, 64})
            for (const int width : {2, 4}) {
                TransferSettings one = fine_;
                mask(one, size);
                block(one, width);
                add(one, "grid");
                if (!levels_) continue;
                for (const int count : {counts_.front(), counts_[counts_.size() / 2]}) {
                    TransferSettings two = levels_base_;
                    mask(two, size);
                    block(two, width);
                    coarse(two, count);
                    add(two, "grid");
                }
            }
        for (const int size : {8, 16, 32, 64}) {
            TransferSettings one = sets_base_;
            mask(one, size);
            add(one, "grid");
            if (!levels_) continue;
            // Far away, sets of a coarse mesh are fewer and larger triangles.
            coarse(one, counts_.back());
            add(one, "grid");
        }
        return std::move(out_);
    }

private:
    template <typename Set>
    void vary(const TransferSettings& base, const std::string& series, const Values& quick,
              const Values& full, const Set& set) {
        lab::vary(base, series, quick_ ? quick : full, set,
                  [this](TransferSettings one, const std::string& name) { add(one, name); });
    }

    void add(TransferSettings one, const std::string& series) {
        const MaskOptions& masks = one.options.masks;
        one.series = series;
        one.knobs = {{"sh-order", std::to_string(masks.bands - 1)},
                     {"mask", std::to_string(masks.size)},
                     {"mask-block", std::to_string(masks.block)},
                     {"cells", name_of(one.options.cells)},
                     {"table", masks.planes == EdgePlanes::table ? std::to_string(masks.table_size)
                                                                 : "off"}};
        if (one.coarse > 0) {
            one.knobs["coarse"] = std::to_string(one.coarse);
            one.knobs["rings"] = std::to_string(one.options.rings);
        }
        if (one.looks > 0) one.knobs["looks"] = std::to_string(one.looks);
        out_.push_back(std::move(one));
    }

    bool quick_, levels_, moves_;
    Values counts_;  // triangles of far meshes
    TransferSettings fine_, levels_base_, sets_base_;
    std::vector<TransferSettings> out_;
};

}  // namespace

std::vector<TransferSettings> transfer_settings(bool quick, std::size_t triangles, bool levels,
                                                bool moves, const BuildOptions& build) {
    return List(quick, triangles, levels, moves, build)();
}

}  // namespace clgi::lab
