// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/atomic_file.hpp"
#include "io/png_encode.hpp"
#include "report/difference.hpp"
#include "report/preview.hpp"
#include "report/sweep_files.hpp"
#include "report/sweep_summary.hpp"

namespace clgi::report {
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

std::string knobs_text(const SweepPoint& point) {
    std::string out;
    for (const auto& [name, value] : point.knobs)
        out += (out.empty() ? "" : ", ") + name + " " + value;
    return out;
}

std::string front_table(const Sweep& sweep, int truth) {
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

// Pictures of the front, thinned to the eye: at most eight, from quick to good.
std::string gallery(const Sweep& sweep, int truth) {
    std::vector<const SweepPoint*> front;
    for (const SweepPoint& point : sweep.points)
        if (point.front[truth] && point.method == "second-order") front.push_back(&point);
    std::sort(front.begin(), front.end(), [](const SweepPoint* a, const SweepPoint* b) {
        return a->milliseconds < b->milliseconds;
    });
    const io::Image& truth_picture = sweep.truth[truth];
    const float exposure = preview_exposure(truth_picture);
    std::string out = image_tag(sweep.width, sweep.height, preview(truth_picture, exposure),
                                fmt::format("{} reference", truth_names[truth]));
    // One scale for all differences, so that they can be compared.
    double scale = 0.0;
    for (const float value : truth_picture.find("G")->values) scale += double{value};
    scale = 0.25 * scale / static_cast<double>(truth_picture.find("G")->values.size());
    constexpr std::size_t most = 8;
    const std::size_t count = std::min(front.size(), most);
    for (std::size_t i = 0; i < count; ++i) {
        const SweepPoint& point = *front[count == 1 ? 0 : i * (front.size() - 1) / (count - 1)];
        const std::string title = fmt::format("{:.1f} ms, {:.2f} %: {}", point.milliseconds,
                                              100.0 * point.error[truth], knobs_text(point));
        out += "<div class=\"pair\">" +
               image_tag(sweep.width, sweep.height, preview(point.picture, exposure), title);
        const auto difference = difference_picture(point.picture, truth_picture, {.scale = scale});
        out += image_tag(difference.raster.width, difference.raster.height, difference.raster.rgba,
                         fmt::format("difference, full colour at {:.3g} cd/m\u00b2", scale)) +
               "</div>\n";
    }
    return out;
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
                       const std::string (&plots)[truths]) {
    std::string out = head;
    out += fmt::format(
        "<h1>What accuracy costs in time: {}</h1>\n<p>{} triangles, {}\u00d7{} pixels, on {}.<br>"
        "clgi {}, made by <code>{}</code></p>\n<ul>\n",
        escaped(sweep.scene), sweep.triangles, sweep.width, sweep.height, escaped(sweep.device),
        note.version, escaped(note.command));
    for (const std::string& line : summary(sweep)) out += "<li>" + escaped(line) + "</li>\n";
    out += "</ul>\n";
    for (int t = 0; t < truths; ++t) {
        out += fmt::format("<h2>Against the {} reference <small>({})</small></h2>\n",
                           truth_names[t], truth_effects[t]);
        // Without the XML prologue the picture can stand inside the page.
        const std::size_t start = plots[t].find("<svg");
        if (start != std::string::npos) out += plots[t].substr(start);
        out += front_table(sweep, t);
        if (t != unshadowed_bounce) out += gallery(sweep, t);
    }
    return out + math_table(sweep) + "</body></html>\n";
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
    std::string plots[truths];
    for (int t = 0; t < truths; ++t) {
        plots[t] = error_plot(sweep, t, folder, why);
        if (!plots[t].empty()) save(fmt::format("error-{}.svg", truth_names[t]), plots[t]);
    }
    save("index.html", sweep_page(sweep, note, plots));
    return why;
}

}  // namespace clgi::report
