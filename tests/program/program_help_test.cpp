// What --help says of every option: its default, the one that docs/cli.md states.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

namespace {

using Program = clgi::test::Program;

// One option of a help text: "--vpls", with what it takes and the rest of its entry.
struct Option {
    std::string name;   // the last of its names
    std::string value;  // "N"; empty: a flag
    std::string entry;  // all of its lines
    std::string fallback() const {
        const std::size_t at = entry.rfind("default: ");
        return at == std::string::npos ? "" : entry.substr(at + 9, entry.rfind(']') - at - 9);
    }
};

// The entries of a help text between a heading and the next empty line.
std::vector<std::string> entries(const std::string& help, const std::string& heading) {
    std::istringstream lines(help);
    std::vector<std::string> out;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line == heading) {
            inside = true;
        } else if (line.empty()) {
            inside = false;
        } else if (inside) {
            if (line[2] != ' ') out.emplace_back();
            out.back() += line;
        }
    }
    return out;
}

std::vector<Option> options_of(const std::string& help) {
    std::vector<Option> out;
    for (const std::string& entry : entries(help, "Options:")) {
        Option option;
        option.entry = entry;
        const std::size_t gap = entry.find_first_of(' ', 2);
        const std::string names = entry.substr(2, gap - 2);
        option.name = names.substr(names.find_last_of(',') + 1);
        if (entry[gap + 1] != ' ')
            option.value = entry.substr(gap + 1, entry.find(' ', gap + 1) - gap - 1);
        out.push_back(option);
    }
    return out;
}

// The column "default" of docs/cli.md: by heading, then by option.
using Defaults = std::map<std::string, std::map<std::string, std::string>>;

Defaults documented() {
    std::ifstream in(std::string(CLGI_SOURCE) + "/docs/cli.md");
    Defaults out;
    std::string heading;
    for (std::string line; std::getline(in, line);) {
        if (line.rfind("##", 0) == 0) heading = line.substr(line.find(' ') + 1);
        if (line.rfind("| `-", 0) != 0) continue;
        // Cells end at a bar without a backslash.
        std::vector<std::string> cells(1);
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (line[i] == '|' && line[i - 1] != '\\')
                cells.emplace_back();
            else if (line[i] != '`')
                cells.back() += line[i];
        }
        std::istringstream words(cells[0]);
        for (std::string word; words >> word;)
            if (word.rfind("--", 0) == 0)
                out[heading][word.substr(0, word.find(','))] =
                    cells[1].size() > 2 ? cells[1].substr(1, cells[1].size() - 2) : "";
    }
    return out;
}

// Of a command's own section, of those for several commands, or of render's, to which others refer.
const std::string* find_default(const Defaults& defaults, const std::string& command,
                                const std::string& option) {
    for (const std::string& wanted :
         {"clgi " + command, std::string("Flags of"), std::string("clgi render")})
        for (const auto& [heading, rows] : defaults) {
            if (heading.rfind(wanted, 0) != 0) continue;
            const auto row = rows.find(option);
            if (row != rows.end() && row->second != "as render") return &row->second;
        }
    return nullptr;
}

TEST_F(Program, HelpShowsTheDefaultOfEveryOption) {
    const Defaults defaults = documented();
    int commands = 0, values = 0;
    for (const std::string& entry : entries(run("--help").out, "Subcommands:")) {
        const std::string command = entry.substr(2, entry.find(' ', 2) - 2);
        SCOPED_TRACE(command);
        ++commands;
        for (const Option& option : options_of(run(command + " --help").out)) {
            if (option.name == "--help") continue;
            SCOPED_TRACE(option.name);
            const std::string* documented_default = find_default(defaults, command, option.name);
            ASSERT_NE(documented_default, nullptr) << "docs/cli.md does not have it";
            if (option.value.empty()) {
                EXPECT_EQ(*documented_default, "") << "a flag has no default";
                continue;
            }
            ++values;
            const bool required = option.entry.find(" REQUIRED") != std::string::npos;
            EXPECT_NE(required, !option.fallback().empty()) << option.entry;
            EXPECT_EQ(*documented_default, required ? "required" : option.fallback());
        }
    }
    EXPECT_GE(commands, 11);  // and view, where it is built
    EXPECT_GT(values, 60);
}

TEST_F(Program, EveryPositionalIsRequired) {
    for (const char* command :
         {"scene", "plan", "render", "bake", "reference", "compare", "sweep", "bench"}) {
        const auto positionals = entries(run(std::string(command) + " --help").out, "Positionals:");
        EXPECT_FALSE(positionals.empty()) << command;
        for (const std::string& entry : positionals)
            EXPECT_NE(entry.find(" REQUIRED"), std::string::npos) << entry;
    }
}

TEST_F(Program, QuietScenesSayNothing) {
    const std::string scene = "scene cornell -o " + file("a.glb").string();
    EXPECT_NE(run(scene).out, "");
    const auto quiet = run(scene + " --quiet");
    EXPECT_EQ(quiet.code, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    EXPECT_TRUE(std::filesystem::exists(file("a.glb")));
}

}  // namespace
