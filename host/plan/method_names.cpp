// SPDX-License-Identifier: MIT
#include <clgi/plan.hpp>

namespace clgi {
namespace {

struct Named {
    Method method;
    const char* name;
};
constexpr Named names[] = {{Method::direct, "direct"},
                           {Method::second_order, "second-order"},
                           {Method::light_atlas, "atlas"},
                           {Method::antiradiance, "antiradiance"},
                           {Method::dynamic_transfer, "transfer"}};

}  // namespace

const char* name_of(Method method) {
    for (const Named& one : names)
        if (one.method == method) return one.name;
    return "";
}

std::optional<Method> method_of(const std::string& name) {
    for (const Named& one : names)
        if (name == one.name) return one.method;
    return std::nullopt;
}

}  // namespace clgi
