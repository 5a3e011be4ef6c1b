// --tolerance, --with, --without and what else asks for a plan.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/plan.hpp>
#include <string>
#include <vector>

namespace clgi::program {

struct PlanFlags {
    std::string tolerance = "1%";
    std::vector<std::string> with, without;
};
void add_plan_flags(CLI::App& command, PlanFlags& flags);

// Effects and tolerance of a request. Throws Error that begins with the command's name for an
// unknown effect or an invalid share.
PlanRequest request_of(const std::string& command, const PlanFlags& flags);

}  // namespace clgi::program
