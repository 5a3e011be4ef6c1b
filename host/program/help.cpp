// SPDX-License-Identifier: MIT
#include "program/help.hpp"

#include <CLI/CLI.hpp>
#include <memory>
#include <set>
#include <string>

namespace clgi::program {
namespace {

// What is in square or curly brackets behind `opening`; empty where that is not found.
std::string inside(const std::string& text, const std::string& opening) {
    const std::size_t at = text.find(opening);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + opening.size();
    return text.substr(begin, text.size() - begin - 1);
}

// CLI11 names a type as "INT:INT in [0 - 9]", "TEXT:{on,off}" or "FLOAT:POSITIVE".
std::string range_text(const std::string& type) {
    if (type.find(":POSITIVE") != std::string::npos) return "above 0";
    if (type.find(":NONNEGATIVE") != std::string::npos) return "at least 0";
    std::string values = inside(type, ":{");
    for (std::size_t at = 0; (at = values.find(',', at)) != std::string::npos; at += 2)
        values.insert(at + 1, " ");
    if (!values.empty()) return values;
    std::string range = inside(type, " in [");
    if (const std::size_t dash = range.find(" - "); dash != std::string::npos)
        range.replace(dash, 3, " to ");
    return range;
}

// In one order, whatever the options' addresses.
std::string names_of(const std::set<CLI::Option*>& options) {
    std::set<std::string> names;
    for (const CLI::Option* option : options) names.insert(option->get_name());
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

class Help : public CLI::Formatter {
public:
    std::string make_option_opts(const CLI::Option* option) const override {
        if (option->get_type_size() == 0) return "";
        const std::string type = option->get_type_name();
        return " " + type.substr(0, type.find(':')) + (option->get_required() ? " REQUIRED" : "");
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        std::string analysis;
        const auto add = [&](const std::string& before, const std::string& fact) {
            if (!fact.empty()) analysis += (analysis.empty() ? "" : "; ") + before + fact;
        };
        add("", range_text(option->get_type_name()));
        add("needs ", names_of(option->get_needs()));
        add("not with ", names_of(option->get_excludes()));
        if (option->get_type_size() != 0) add("default: ", option->get_default_str());
        return option->get_description() + (analysis.empty() ? "" : " [" + analysis + "]");
    }
};

}  // namespace

void set_help(CLI::App& app) {
    app.formatter(std::make_shared<Help>());
    app.option_defaults()->always_capture_default();
}

}  // namespace clgi::program
