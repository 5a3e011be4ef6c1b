// Which methods have the effects of a plan.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <string>
#include <vector>

namespace clgi {

struct Choice {
    std::vector<Method> methods;  // at least one
    std::string why;
};
Choice methods_for(const Plan& plan);

}  // namespace clgi
