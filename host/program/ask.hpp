// What is asked for instead of settings. --target-error and --frame-time of second-order
// illumination: tuning finds them.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/advanced/tuning.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clgi::program {

struct AskFlags {
    std::string target_error;  // empty: not asked for
    std::string time_budget;   // of a picture with all before it
    std::string frame_time;
};
void add_ask_flags(CLI::App& command, AskFlags& flags);

// Throws Error for an invalid share or time.
TuningTarget request_of(const std::string& command, const AskFlags& flags);

// The part "ask" of --stats.
struct AskRecord {
    TuningTarget request;
    SecondOrderTuning tuning;
};
nlohmann::ordered_json ask_json(const AskRecord& record, double delivered_ms);

// One line with what was promised and delivered, for standard output.
std::string ask_line(const AskRecord& record, double delivered_ms);

// Why less was promised than asked for; empty if it was not.
std::string ask_warning(const AskRecord& record);

}  // namespace clgi::program
