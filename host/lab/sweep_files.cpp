// SPDX-License-Identifier: MIT
#include "lab/sweep_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/difference.hpp"
#include "lab/drawing.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_pictures.hpp"

namespace clgi::lab {
namespace {

// Indices of points of the front of one of the methods, thinned to the eye, from quick to good.
std::vector<std::size_t> shown_of(const Sweep& sweep, const std::string& method, std::size_t truth,
                                  std::size_t most) {
    std::vector<std::size_t> front, out;
    for (std::size_t i = 0; i < sweep.points.size(); ++i)
        if (sweep.points[i].front[truth] && sweep.points[i].method == method) front.push_back(i);
    std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return sweep.points[a].milliseconds < sweep.points[b].milliseconds;
    });
    const std::size_t count = std::min(front.size(), most);
    for (std::size_t i = 0; i < count; ++i)
        out.push_back(front[count == 1 ? front.size() - 1 : i * (front.size() - 1) / (count - 1)]);
    return out;
}

// Points have one picture: with the light of all truths but these.
bool has_gallery(const Sweep& sweep, std::size_t truth) {
    const std::string& name = sweep.truths[truth].name;
    return sweep.of == SweepOf::atlas ||
           (sweep.of == SweepOf::pictures && name != unshadowed_truth && name != indirect_truth);
}

// Pictures of the fronts, of bakes those that gather alone; which points they are of, and the one
// scale of all differences, so that they can be compared.
nlohmann::ordered_json add_gallery(const Sweep& sweep, std::size_t truth, const Drawing& drawing) {
    if (!has_gallery(sweep, truth)) return nullptr;
    std::vector<std::size_t> shown;
    const std::size_t of = sweep.of == SweepOf::atlas ? 1 : sweep.methods.size();
    for (std::size_t m = 0; m < of; ++m) {
        const auto more = shown_of(sweep, sweep.methods[m], truth, of == 1 ? 8 : 3);
        shown.insert(shown.end(), more.begin(), more.end());
    }
    const auto& [name, effects, picture, noise] = sweep.truths[truth];
    const float exposure = preview_exposure(picture);
    const auto add = [&](const std::string& file, const io::Image& image) {
        drawing.add(file, {sweep.width, sweep.height, preview(image, exposure)});
    };
    add(fmt::format("truth-{}.png", name), picture);
    const std::vector<float>& green = picture.find("G")->values;
    double scale = 0.0;
    for (const float value : green) scale += double{value};
    scale = 0.25 * scale / static_cast<double>(green.size());
    for (const std::size_t i : shown) {
        const io::Image& found = sweep.points[i].picture;
        add(fmt::format("point-{}-{}.png", name, i), found);
        drawing.add(fmt::format("difference-{}-{}.png", name, i),
                    difference_picture(found, picture, {.scale = scale}).raster);
    }
    return {{"points", shown}, {"scale", scale}};
}

}  // namespace

std::string save_sweep(const Sweep& sweep, const SweepNote& note,
                       const std::filesystem::path& folder) {
    const std::string json = sweep_json(sweep, note);
    save_text(folder / "sweep.csv", sweep_csv(sweep));
    save_text(folder / "sweep.json", json);
    const Drawing drawing;
    nlohmann::ordered_json data = {{"sweep", nlohmann::ordered_json::parse(json)},
                                   {"methods", sweep.methods},
                                   {"of", sweep.of == SweepOf::atlas      ? "atlas"
                                          : sweep.of == SweepOf::vertices ? "vertices"
                                                                          : "pictures"}};
    for (std::size_t t = 0; t < sweep.truths.size(); ++t)
        data["galleries"].push_back(add_gallery(sweep, t, drawing));
    const std::string why = drawing.draw("sweep", data);
    if (why.empty())
        for (const SweepTruth& truth : sweep.truths) {
            const std::string name = fmt::format("error-{}.svg", truth.name);
            save_text(folder / name, drawing.text(name));
        }
    save_text(folder / "index.html",
              why.empty() ? drawing.text("index.html")
                          : fmt::format("<!DOCTYPE html>\n<p>No plots: {}. The results are in "
                                        "sweep.csv and sweep.json.</p>\n",
                                        why));
    return why;
}

}  // namespace clgi::lab
