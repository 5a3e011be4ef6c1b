// SPDX-License-Identifier: MIT
#include "lab/sweep_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "lab/difference.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_summary.hpp"

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

std::string knob(const SweepPoint& point, const std::string& name) {
    const auto found = point.knobs.find(name);
    return found == point.knobs.end() ? "" : found->second;
}

template <typename Is>
bool any(const Sweep& sweep, const Is& is) {
    return std::any_of(sweep.points.begin(), sweep.points.end(), is);
}

}  // namespace

std::string sweep_csv(const Sweep& sweep) {
    std::string out = "method,series";
    for (const std::string& name : sweep.knobs) out += fmt::format(",{}", name);
    const bool once =
        any(sweep, [](const SweepPoint& p) { return p.once_milliseconds.has_value(); });
    std::vector<bool> estimated;  // [truths]
    for (const SweepTruth& truth : sweep.truths)
        estimated.push_back(any(sweep, [&](const SweepPoint& p) {
            return p.estimated_error.find(truth.name) != p.estimated_error.end();
        }));
    out += once ? ",ms,once ms" : ",ms";
    for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
        out += fmt::format(",error {0},front {0}", sweep.truths[t].name);
        if (estimated[t]) out += fmt::format(",estimated_error {}", sweep.truths[t].name);
    }
    const bool given_up = any(sweep, [](const SweepPoint& p) { return p.given_up; });
    out += given_up ? ",energy ratio,given_up\n" : ",energy ratio\n";
    for (const SweepPoint& point : sweep.points) {
        out += fmt::format("{},\"{}\"", point.method, point.series);
        for (const std::string& name : sweep.knobs) out += "," + knob(point, name);
        out += fmt::format(",{:.4g}", point.milliseconds);
        if (once)
            out += "," +
                   (point.once_milliseconds ? fmt::format("{:.4g}", *point.once_milliseconds) : "");
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            out += fmt::format(",{:.6g},{}", point.error[t], point.front[t] ? 1 : 0);
            const auto found = point.estimated_error.find(sweep.truths[t].name);
            if (estimated[t])
                out += found == point.estimated_error.end() ? ","
                                                            : fmt::format(",{:.6g}", found->second);
        }
        out += fmt::format(",{:.6g}", point.energy);
        out += given_up ? point.given_up ? ",1\n" : ",0\n" : "\n";
    }
    return out;
}

std::string sweep_json(const Sweep& sweep, const SweepNote& note) {
    nlohmann::ordered_json out = {
        {"clgi", note.version},
        {"command", note.command},
        {"device", sweep.device},
        {"scene", {{"name", sweep.scene}, {"triangles", sweep.triangles}}},
        {"size", {sweep.width, sweep.height}},
        {"summary", summary(sweep)}};
    for (const SweepTruth& truth : sweep.truths)
        out["references"].push_back(
            {{"name", truth.name}, {"effects", truth.effects}, {"standard_error", truth.noise}});
    for (const std::string& method : sweep.methods)
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            const Speedup factor = speedup(sweep, method, t);
            out["speedups"].push_back({{"method", factor.method},
                                       {"reference", sweep.truths[t].name},
                                       {"at_least_error", factor.at_least_error},
                                       {"least_error", factor.least_error},
                                       {"best", factor.best},
                                       {"best_error", factor.best_error}});
        }
    if (sweep.of == SweepOf::atlas)
        for (const AtEqualError& pair : at_equal_error(sweep, atlas_project, atlas_gather, 0))
            out["fillings"].push_back({{"project", pair.slow->knobs},
                                       {"project_ms", pair.slow->milliseconds},
                                       {"project_error", pair.slow->error[0]},
                                       {"gather", pair.quick->knobs},
                                       {"gather_ms", pair.quick->milliseconds},
                                       {"gather_error", pair.quick->error[0]},
                                       {"factor", pair.factor}});
    for (const MathMode& mode : math_modes(sweep))
        out["math_modes"].push_back({{"math", mode.math},
                                     {"storage", mode.storage},
                                     {"ms", mode.milliseconds},
                                     {"speed", mode.speed},
                                     {"error", mode.error},
                                     {"difference", mode.difference}});
    out["points"] = nlohmann::ordered_json::array();
    for (const SweepPoint& point : sweep.points) {
        nlohmann::ordered_json row = {{"method", point.method},
                                      {"series", point.series},
                                      {"knobs", point.knobs},
                                      {"ms", point.milliseconds},
                                      {"energy_ratio", point.energy}};
        if (point.given_up) row["given_up"] = true;
        if (point.once_milliseconds) row["once_ms"] = *point.once_milliseconds;
        if (!point.estimated_error.empty()) row["estimated_error"] = point.estimated_error;
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            row["error"][sweep.truths[t].name] = point.error[t];
            row["front"][sweep.truths[t].name] = bool{point.front[t]};
        }
        out["points"].push_back(row);
    }
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

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

// ---- the sheet of pictures ----------------------------------------------------------------------

namespace {

std::string time_text(double milliseconds) {
    return milliseconds < 999.5 ? fmt::format("{:.3g} ms", milliseconds)
                                : fmt::format("{:.3g} s", 1e-3 * milliseconds);
}

std::array<std::string, 2> caption_of(const SweepPoint& point) {
    std::string cost = time_text(point.milliseconds) + " a frame";
    if (point.once_milliseconds) cost += ", " + time_text(*point.once_milliseconds) + " once";
    const auto samples = point.knobs.find("spp");
    if (samples != point.knobs.end()) cost += ", " + samples->second + " samples a pixel";
    return {fmt::format("{}: error {:.1f} %", point.method, 100.0 * point.error.front()), cost};
}

}  // namespace

const SweepPoint* shown_point(const Sweep& sweep, const std::string& method, double milliseconds) {
    const auto error = [](const SweepPoint& point) {
        const double value = point.error.front();
        return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    };
    const SweepPoint *best = nullptr, *fastest = nullptr;
    for (const SweepPoint& point : sweep.points) {
        if (point.method != method || point.given_up) continue;
        if (method == path_tracer_name && point.series != sweep.truths.front().name) continue;
        if (!fastest || point.milliseconds < fastest->milliseconds) fastest = &point;
        if (point.milliseconds <= milliseconds && (!best || error(point) < error(*best)))
            best = &point;
    }
    return best ? best : fastest;
}

Sheet contact_sheet(const Sweep& sweep, double milliseconds) {
    if (sweep.of != SweepOf::pictures)
        throw Error("contact_sheet: the sweep is of texels or vertices, one of pictures needed");
    const SweepTruth& truth = sweep.truths.front();
    Sheet out = {{&truth.picture,
                  {"ground truth, by path tracing",
                   fmt::format("standard error {:.1f} %", 100.0 * truth.noise)}}};
    std::vector<std::string> methods = sweep.methods;
    methods.emplace_back(path_tracer_name);
    for (const std::string& method : methods)
        if (const SweepPoint* point = shown_point(sweep, method, milliseconds))
            out.push_back({&point->picture, caption_of(*point)});
    return out;
}

Raster draw_sheet(const Sheet& sheet) {
    const Drawing drawing;
    const float exposure = preview_exposure(*sheet.front().picture);
    nlohmann::ordered_json panels;
    Raster out;
    for (const auto& [picture, caption] : sheet) {
        const Raster panel{picture->width, picture->height, preview(*picture, exposure)};
        const std::string name = fmt::format("{}.png", panels.size());
        drawing.add(name, panel);
        panels.push_back({{"picture", name}, {"lines", caption}});
        out.width = panel.width;
        out.height += panel.height;
        out.rgba.insert(out.rgba.end(), panel.rgba.begin(), panel.rgba.end());
    }
    return drawing.draw("sheet", panels).empty() ? drawing.picture("sheet.png") : out;
}

}  // namespace clgi::lab
