// SPDX-License-Identifier: MIT
#include "program/option_flags.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <clgi/error.hpp>
#include <cmath>

namespace clgi::program {
namespace {

constexpr unsigned pictures = of_direct | of_second_order;

// The one method that has the row, besides bakes; none where several do.
std::optional<Method> only_method(const OptionRow& row) {
    const unsigned methods = row.methods & ~unsigned{of_bakes | of_vectors};
    if (std::popcount(methods) != 1) return std::nullopt;
    return static_cast<Method>(std::countr_zero(methods));
}

// "atlas: ", before what is of no use to the usual methods.
std::string prefix_of(const OptionRow& row, unsigned methods) {
    const auto only = only_method(row);
    if (std::popcount(methods) == 1 || !only || row.of(pictures)) return "";
    return std::string(name_of(*only)) + ": ";
}

std::string default_of(const OptionRow& row, unsigned methods) {
    const std::string usual = row.get({});
    if (row.name != "vpls" || std::popcount(methods) == 1) return usual;
    return usual + "; atlas: " + option("vpls", of_bakes).get({});
}

CLI::Validator check_of(const OptionRow& row) {
    const bool bounded = row.least < row.most;
    if (!row.choices.empty() && (row.kind != OptionRow::Kind::choice || !bounded))
        return CLI::IsMember(row.choices);
    if (std::isinf(row.most)) return CLI::PositiveNumber;
    if (row.kind == OptionRow::Kind::number) return CLI::Range(row.least, row.most);
    return CLI::Range(static_cast<int>(row.least), static_cast<int>(row.most));
}

}  // namespace

void add_option_flags(CLI::App& command, RendererOptions& options, unsigned methods,
                      const std::vector<std::string>& without) {
    for (const OptionRow& row : option_table()) {
        if (!row.of(methods) ||
            std::find(without.begin(), without.end(), row.name) != without.end())
            continue;
        const std::string flag = "--" + row.name, help = prefix_of(row, methods) + row.help;
        const auto set = [&options, &row, &command](const std::string& text) {
            try {
                row.set(options, text);
            } catch (const Error& error) {
                throw Error(command.get_name() + ": --" + error.what());
            }
        };
        if (row.kind == OptionRow::Kind::toggle) {
            command.add_flag_function(
                flag, [set](std::int64_t) { set("true"); }, help);
            continue;
        }
        CLI::Option* added = command.add_option_function<std::string>(flag, set, help)
                                 ->type_name(row.value)
                                 ->default_str(default_of(row, methods));
        if (!row.choices.empty() || row.least < row.most) added->check(check_of(row));
    }
}

std::vector<const OptionRow*> given_options(const CLI::App& command, unsigned methods) {
    std::vector<const OptionRow*> out;
    for (const OptionRow& row : option_table())
        if (row.of(methods) && command.get_option_no_throw("--" + row.name) &&
            command.count("--" + row.name) > 0)
            out.push_back(&row);
    return out;
}

void check_methods(const std::string& command, const std::vector<const OptionRow*>& given,
                   const std::string& method) {
    const auto chosen = method_of(method);  // none: auto
    for (const OptionRow* row : given) {
        if (chosen && row->of(methods_of(*chosen))) continue;
        const auto only = only_method(*row);
        if (only && !row->of(pictures))
            throw Error(command + ": --" + row->name + " goes only with --method " +
                        name_of(*only));
        if (chosen) throw Error(command + ": --" + row->name + " goes not with --method " + method);
    }
}

}  // namespace clgi::program
