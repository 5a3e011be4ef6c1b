// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/atomic_file.hpp"
#include "io/png_encode.hpp"
#include "lab/difference.hpp"
#include "lab/preview.hpp"
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {
namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string image_tag(int width, int height, const std::vector<std::uint8_t>& rgba,
                      const std::string& title) {
    return fmt::format(
        "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">"
        "<figcaption>{}</figcaption></figure>\n",
        width, height, escaped(title), base64(io::encode_png(width, height, rgba.data())),
        escaped(title));
}

std::string front_table(const Sweep& sweep, std::size_t truth) {
    std::vector<const SweepPoint*> front;
    for (const SweepPoint& point : sweep.points)
        if (point.front[truth]) front.push_back(&point);
    std::sort(front.begin(), front.end(), [](const SweepPoint* a, const SweepPoint* b) {
        return a->method != b->method ? a->method > b->method : a->milliseconds < b->milliseconds;
    });
    std::string out =
        "<table><tr><th>method</th><th>settings</th><th>ms</th><th>error %</th>"
        "<th>energy</th></tr>\n";
    for (const SweepPoint* point : front)
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.4f}</td></tr>\n",
            point->method, escaped(knobs_text(*point)), point->milliseconds,
            100.0 * point->error[truth], point->energy);
    return out + "</table>\n";
}

// Points of the front of one of the methods, thinned to the eye, from quick to good.
std::vector<const SweepPoint*> shown_of(const Sweep& sweep, const std::string& method,
                                        std::size_t truth, std::size_t most) {
    std::vector<const SweepPoint*> front, out;
    for (const SweepPoint& point : sweep.points)
        if (point.front[truth] && point.method == method) front.push_back(&point);
    std::sort(front.begin(), front.end(), [](const SweepPoint* a, const SweepPoint* b) {
        return a->milliseconds < b->milliseconds;
    });
    const std::size_t count = std::min(front.size(), most);
    for (std::size_t i = 0; i < count; ++i)
        out.push_back(front[count == 1 ? front.size() - 1 : i * (front.size() - 1) / (count - 1)]);
    return out;
}

// Pictures of the fronts; of bakes those that gather alone.
std::string gallery(const Sweep& sweep, std::size_t truth) {
    std::vector<const SweepPoint*> shown;
    const std::vector<std::string>& methods = sweep.methods;
    const std::size_t of = sweep.of == SweepOf::atlas ? 1 : methods.size();
    for (std::size_t m = 0; m < of; ++m) {
        const auto more = shown_of(sweep, methods[m], truth, of == 1 ? 8 : 3);
        shown.insert(shown.end(), more.begin(), more.end());
    }
    const io::Image& truth_picture = sweep.truths[truth].picture;
    const float exposure = preview_exposure(truth_picture);
    std::string out = image_tag(sweep.width, sweep.height, preview(truth_picture, exposure),
                                fmt::format("{} reference", sweep.truths[truth].name));
    // One scale for all differences, so that they can be compared.
    double scale = 0.0;
    for (const float value : truth_picture.find("G")->values) scale += double{value};
    scale = 0.25 * scale / static_cast<double>(truth_picture.find("G")->values.size());
    const char* unit = sweep.of == SweepOf::atlas ? "lx" : "cd/m\u00b2";
    for (const SweepPoint* one : shown) {
        const SweepPoint& point = *one;
        const std::string title =
            fmt::format("{}, {:.1f} ms, {:.2f} %: {}", point.method, point.milliseconds,
                        100.0 * point.error[truth], knobs_text(point));
        out += "<div class=\"pair\">" +
               image_tag(sweep.width, sweep.height, preview(point.picture, exposure), title);
        const auto difference = difference_picture(point.picture, truth_picture, {.scale = scale});
        out += image_tag(difference.raster.width, difference.raster.height, difference.raster.rgba,
                         fmt::format("difference, full colour at {:.3g} {}", scale, unit)) +
               "</div>\n";
    }
    return out;
}

// Points have one picture: with the light of all truths but these.
bool has_gallery(const Sweep& sweep, std::size_t truth) {
    const std::string& name = sweep.truths[truth].name;
    return sweep.of == SweepOf::atlas ||
           (sweep.of == SweepOf::pictures && name != unshadowed_truth && name != indirect_truth);
}

// What each filling takes for the same error.
std::string fillings_table(const Sweep& sweep) {
    const auto pairs = at_equal_error(sweep, atlas_project, atlas_gather, 0);
    if (pairs.empty()) return "";
    std::string out =
        "<h2>Fillings at equal error</h2>\n<p>The front of projection, and the quickest measured "
        "settings of gathering that are at least as accurate.</p>\n"
        "<table><tr><th>project</th><th>gather</th><th>project, ms</th><th>error %</th>"
        "<th>gather, ms</th><th>error %</th><th>times less</th></tr>\n";
    for (const AtEqualError& pair : pairs)
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{:.2f}</td><td>{:.0f}</td>"
            "<td>{:.2f}</td><td>{:.1f}</td></tr>\n",
            escaped(knobs_text(*pair.slow)), escaped(knobs_text(*pair.quick)),
            pair.slow->milliseconds, 100.0 * pair.slow->error[0], pair.quick->milliseconds,
            100.0 * pair.quick->error[0], pair.factor);
    return out + "</table>\n";
}

// What is done once before all frames, and what a frame takes then.
std::string once_table(const Sweep& sweep) {
    std::string rows;
    for (const SweepPoint& point : sweep.points) {
        if (!point.once_milliseconds) continue;
        rows +=
            fmt::format("<tr><td>{}</td><td>{}</td><td>{:.0f}</td><td>{:.2f}</td>", point.method,
                        escaped(knobs_text(point)), *point.once_milliseconds, point.milliseconds);
        for (const double error : point.error)
            rows += point.given_up ? "<td>diverged</td>"
                                   : fmt::format("<td>{:.2f}</td>", 100.0 * error);
        rows += "</tr>\n";
    }
    if (rows.empty()) return "";
    std::string out =
        sweep.of == SweepOf::vertices
            ? "<h2>Visible sets</h2>\n<p>Looking is done once, before all frames, and is no part "
              "of their time.</p>\n"
            : "<h2>Done once</h2>\n<p>What stays good while geometry stands still is no part of a "
              "frame's time: elements and links of antiradiance, layout and first bake of an "
              "atlas, transfer vectors.</p>\n";
    out +=
        "<table><tr><th>method</th><th>settings</th><th>once, ms</th>"
        "<th>ms</th>";
    for (const SweepTruth& truth : sweep.truths)
        out += fmt::format("<th>error %, {}</th>", truth.name);
    return out + "</tr>\n" + rows + "</table>\n";
}

// Errors that antiradiance tells of itself, beside the true ones.
std::string estimates_table(const Sweep& sweep) {
    std::string rows;
    for (const SweepPoint& point : sweep.points)
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            const auto found = point.estimated_error.find(sweep.truths[t].name);
            if (found == point.estimated_error.end()) continue;
            rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n",
                                sweep.truths[t].name, escaped(knobs_text(point)),
                                100.0 * found->second, 100.0 * point.error[t]);
        }
    if (rows.empty()) return "";
    return "<h2>Estimated errors</h2>\n<p>The difference from the picture with twice as many bins. "
           "It sees what bins cost, not what elements, shadow maps and steps do.</p>\n"
           "<table><tr><th>reference</th><th>settings</th><th>estimated %</th><th>true "
           "%</th></tr>\n" +
           rows + "</table>\n";
}

std::string math_table(const Sweep& sweep) {
    const std::vector<MathMode> modes = math_modes(sweep);
    if (modes.empty()) return "";
    std::string out =
        "<h2>Math and storage</h2>\n<p>300 VPLs and 150 negative VPLs; the error is against "
        "one bounce, the difference against strict math on floats.</p>\n"
        "<table><tr><th>math</th><th>storage</th><th>ms</th><th>times as fast</th>"
        "<th>error %</th><th>difference %</th></tr>\n";
    for (const MathMode& mode : modes)
        out += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.3f}</td>"
            "<td>{:.3f}</td></tr>\n",
            mode.math, mode.storage, mode.milliseconds, mode.speed, 100.0 * mode.error,
            100.0 * mode.difference);
    return out + "</table>\n";
}

constexpr const char* head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>clgi sweep</title><style>
body{font:15px/1.5 sans-serif;max-width:1000px;margin:2em auto;padding:0 1em;color:#222}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #ddd}
table{border-collapse:collapse;font-size:13px}td,th{padding:2px 10px;border-bottom:1px solid #eee;
text-align:left}td:nth-child(n+3){text-align:right;font-variant-numeric:tabular-nums}
figure{display:inline-block;margin:4px;vertical-align:top;max-width:340px}
figcaption{font-size:12px;color:#555}code{background:#f4f4f4;padding:2px 5px}
</style></head><body>
)";

}  // namespace

std::string sweep_page(const Sweep& sweep, const SweepNote& note,
                       const std::vector<std::string>& plots) {
    std::string out = head;
    out += fmt::format(
        "<h1>What accuracy costs in time: {}</h1>\n<p>{} triangles, {}\u00d7{} {}, on {}.<br>"
        "clgi {}, made by <code>{}</code></p>\n<ul>\n",
        escaped(sweep.scene), sweep.triangles, sweep.width, sweep.height,
        sweep.of == SweepOf::atlas      ? "texels"
        : sweep.of == SweepOf::vertices ? "places of vertices"
                                        : "pixels",
        escaped(sweep.device), note.version, escaped(note.command));
    for (const std::string& line : summary(sweep)) out += "<li>" + escaped(line) + "</li>\n";
    out += "</ul>\n";
    for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
        out += fmt::format("<h2>Against the {} reference <small>({})</small></h2>\n",
                           sweep.truths[t].name, sweep.truths[t].effects);
        // Without the XML prologue the picture can stand inside the page.
        const std::size_t start = plots[t].find("<svg");
        if (start != std::string::npos) out += plots[t].substr(start);
        out += front_table(sweep, t);
        if (has_gallery(sweep, t)) out += gallery(sweep, t);
    }
    return out + (sweep.of == SweepOf::atlas ? fillings_table(sweep) : "") + once_table(sweep) +
           estimates_table(sweep) + math_table(sweep) + "</body></html>\n";
}

std::string save_sweep(const Sweep& sweep, const SweepNote& note,
                       const std::filesystem::path& folder) {
    const auto save = [&](const std::string& name, const std::string& text) {
        io::AtomicFile file(folder / name);
        file.write(text.data(), text.size());
        file.commit();
    };
    save("sweep.csv", sweep_csv(sweep));
    save("sweep.json", sweep_json(sweep, note));
    std::string why;
    std::vector<std::string> plots(sweep.truths.size());
    for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
        plots[t] = error_plot(sweep, t, folder, why);
        if (!plots[t].empty()) save(fmt::format("error-{}.svg", sweep.truths[t].name), plots[t]);
    }
    save("index.html", sweep_page(sweep, note, plots));
    return why;
}

}  // namespace clgi::lab
