// Lists of settings that vary one knob alone.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace clgi::lab {

// base with one knob at each of the values, equal ones behind each other once. set(setting, value)
// turns the knob; add(setting, series) takes what comes out.
template <typename Setting, typename Value, typename Set, typename Add>
void vary(const Setting& base, const std::string& series, std::vector<Value> values, const Set& set,
          const Add& add) {
    values.erase(std::unique(values.begin(), values.end()), values.end());
    for (const Value& value : values) {
        Setting one = base;
        set(one, value);
        add(std::move(one), series);
    }
}

}  // namespace clgi::lab
