// SPDX-License-Identifier: MIT
#include "lab/bench.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <map>

namespace clgi::lab {
std::string filled(const std::string& text, const Json& item, double factor) {
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const auto& [key, value] : item.items()) {
        if (value.is_boolean())
            values.push_back(fmt::arg(key.c_str(), value.get<bool>() ? "yes" : "no"));
        else if (value.is_number())
            values.push_back(fmt::arg(key.c_str(), factor * value.get<double>()));
        else if (value.is_string())
            values.push_back(fmt::arg(key.c_str(), value.get<std::string>()));
    }
    try {
        return fmt::vformat(text, values);
    } catch (const fmt::format_error&) {
        return "-";
    }
}

void BenchSetup::report(double done) const {
    if (progress && !progress(done)) throw Error("bench: cancelled");
}

BenchTable run_bench(const BenchSetup& setup) {
    static const std::map<std::string, BenchTable (*)(const BenchSetup&)> tables = {
        {"cochran1", bench_cochran},
        {"cochran2", bench_cochran},
        {"schaerfig1", bench_schaerfig},
        {"kautz1", bench_kautz1},
        {"kautz2", bench_kautz2},
        {"dachsbacher1", bench_dachsbacher},
        {"dachsbacher2", bench_dachsbacher},
        {"views", bench_views},
        {"animation", bench_animation},
        {"layer", bench_layer}};
    BenchTable out = tables.at(setup.table)(setup);
    Json head = {{"table", setup.table}, {"device", describe(setup.device())}};
    head.update(out.json);
    out.json = head;
    return out;
}

std::string text_of(const BenchTable& table) {
    std::string out = filled("{table} on {device}\n", table.json) + filled(table.note, table.json);
    const auto line = [&](const auto& cell_of) {
        for (const BenchColumn& column : table.columns)
            if (&column == &table.columns.front())
                out += fmt::format("\n{:<{}}", cell_of(column), column.width);
            else
                out += fmt::format("{:>{}}", cell_of(column), column.width);
    };
    line([](const BenchColumn& column) { return column.title; });
    for (const Json& row : table.json.at("rows"))
        line([&](const BenchColumn& column) { return filled(column.text, row, column.factor); });
    return out + table.after;
}

}  // namespace clgi::lab
