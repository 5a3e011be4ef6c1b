// SPDX-License-Identifier: MIT
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_settings.hpp"

namespace clgi::lab {
namespace {

using Values = std::vector<std::uint32_t>;

class List {
public:
    List(bool quick, const BuildOptions& build) : quick_(quick) {
        gather_.method = atlas_gather;
        // All orders of reflection, so that what is missing is the error of the other knobs.
        gather_.bake.bounces = 0;
        gather_.bake.build = build;
        gather_.vpls.count = quick ? 400 : 1600;
        project_ = gather_;
        project_.method = atlas_project;
        project_.bake.filling = Filling::project;
        project_.vpls.count = quick ? 100 : 400;  // it takes many times as long
    }

    std::vector<AtlasSettings> operator()() {
        const auto vpls = [](AtlasSettings& to, std::uint32_t n) { to.vpls.count = n; };
        const auto size = [](AtlasSettings& to, std::uint32_t n) {
            to.bake.hemicube_size = static_cast<int>(n);
        };
        const auto mesh = [](AtlasSettings& to, std::uint32_t n) {
            to.bake.mesh = static_cast<int>(n);
        };
        const auto kernel = [](AtlasSettings& to, std::uint32_t n) {
            to.bake.kernel = static_cast<int>(n);
        };
        vary(gather_, "vpls", {50, 400}, {100, 400, 1600, 6400}, vpls);
        vary(gather_, "bounces", {1, 2, 0}, {1, 2, 3, 5, 10, 0},
             [](AtlasSettings& to, std::uint32_t n) { to.bake.bounces = n; });
        vary(gather_, "samples-per-vpl", {10, 48}, {6, 12, 24, 48, 96},
             [](AtlasSettings& to, std::uint32_t n) { to.vpls.samples_per_vpl = n; });
        vary(gather_, "exchange-samples", {2, 16}, {1, 2, 4, 8, 16, 48},
             [](AtlasSettings& to, std::uint32_t n) { to.bake.exchange_samples = n; });
        vary(gather_, "hemicube-size", {64, 256}, {32, 64, 128, 256, 512}, size);
        vary(project_, "vpls, project", {50, 100}, {100, 400, 1600}, vpls);
        vary(project_, "hemicube-size, project", {64, 256}, {64, 128, 256, 512}, size);
        vary(project_, "mesh", {128, 512}, {32, 128, 512, 2048, 8192, 32768}, mesh);
        vary(project_, "kernel", {0, 5}, {0, 1, 2, 5, 10}, kernel);
        if (!quick_) {
            grid(gather_, {100, 400, 1600, 6400}, {128, 256}, {24, 48});
            for (const std::uint32_t n : {100u, 400u, 1600u})
                for (const std::uint32_t m : {512u, 2048u, 8192u}) {
                    AtlasSettings one = project_;
                    vpls(one, n);
                    mesh(one, m);
                    kernel(one, 0);
                    add(one, "grid");
                }
        }
        return std::move(out_);
    }

private:
    template <typename Set>
    void vary(const AtlasSettings& base, const std::string& series, const Values& quick,
              const Values& full, const Set& set) {
        lab::vary(base, series, quick_ ? quick : full, set,
                  [this](AtlasSettings one, const std::string& name) { add(one, name); });
    }

    void grid(const AtlasSettings& base, const Values& vpls, const std::vector<int>& sizes,
              const Values& samples) {
        for (const std::uint32_t n : vpls)
            for (const int size : sizes)
                for (const std::uint32_t m : samples) {
                    AtlasSettings one = base;
                    one.vpls.count = n;
                    one.bake.hemicube_size = size;
                    one.vpls.samples_per_vpl = m;
                    add(one, "grid");
                }
    }

    void add(AtlasSettings one, const std::string& series) {
        const LightAtlasOptions& bake = one.bake;
        const bool project = bake.filling == Filling::project;
        one.series = series;
        one.knobs = {{"vpls", std::to_string(one.vpls.count)},
                     {"bounces", bake.bounces == 0 ? "all" : std::to_string(bake.bounces)},
                     {"samples-per-vpl", std::to_string(one.vpls.samples_per_vpl)},
                     {"exchange-samples", std::to_string(bake.exchange_samples)},
                     {"filling", project ? "project" : "gather"},
                     {"hemicube-size", std::to_string(bake.hemicube_size)}};
        if (project) {
            one.knobs["mesh"] = std::to_string(bake.mesh);
            one.knobs["kernel"] = std::to_string(bake.kernel);
        }
        out_.push_back(std::move(one));
    }

    bool quick_;
    AtlasSettings gather_, project_;
    std::vector<AtlasSettings> out_;
};

}  // namespace

std::vector<AtlasSettings> atlas_settings(bool quick, const BuildOptions& build) {
    return List(quick, build)();
}

}  // namespace clgi::lab
