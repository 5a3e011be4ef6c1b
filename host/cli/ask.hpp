// --target-error and --time-budget of render: the result is asked for, the settings follow.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/ask.hpp"

namespace clgi::cli {

struct AskFlags {
    std::string target_error;  // empty: not asked for
    std::string time_budget;
};
void add_ask_flags(CLI::App& command, AskFlags& flags);

// Throws Error for what is no share or no time.
report::Wish wish_of(const std::string& command, const AskFlags& flags);

// What --stats says under "ask".
struct AskRecord {
    report::Wish wish;
    report::Answer answer;
};
nlohmann::ordered_json ask_json(const AskRecord& record, double delivered_ms);

// What was promised and delivered, one line on standard output.
std::string ask_line(const AskRecord& record, double delivered_ms);

// Why less was promised than asked for; empty where it was not.
std::string ask_warning(const AskRecord& record);

}  // namespace clgi::cli
