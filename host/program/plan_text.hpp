// A plan for readers: lines, and JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clgi::program {

// A line for each effect, then the method with its cost and error.
std::string plan_text(const Plan& plan);
// The method with its settings: "atlas (400 VPLs, ...)".
std::string plan_settings(const Plan& plan);

// The method and its cost, one line.
std::string plan_line(const Plan& plan);
nlohmann::ordered_json plan_json(const Plan& plan);

}  // namespace clgi::program
