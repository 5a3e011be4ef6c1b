// From a field of the options to a row of the table: reading and writing it as text.
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <clgi/error.hpp>
#include <clgi/options.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace clgi::renderer {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The shortest text that reads as the same value.
template <typename T>
std::string text_of(T value) {
    if constexpr (std::is_floating_point_v<T>) {
        if (std::isinf(value)) return "inf";
    }
    char text[400];
    std::to_chars_result end{};
    if constexpr (std::is_floating_point_v<T>)
        end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed);
    else
        end = std::to_chars(text, text + sizeof text, value);
    return {text, end.ptr};
}

inline double number_of(const std::string& name, const std::string& text) {
    if (text == "inf") return infinity;
    double value = 0.0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error != std::errc() || end != last)
        throw Error(name + " is '" + text + "', a number needed");
    return value;
}

inline void check_range(const OptionRow& row, const std::string& text, double value) {
    if (row.kind == OptionRow::Kind::integer && value != std::floor(value))
        throw Error(row.name + " is '" + text + "', a whole number needed");
    if (row.least < row.most && !(value >= row.least && value <= row.most))
        throw Error(row.name + " is " + text + ", " + text_of(row.least) + " to " +
                    text_of(row.most) + " needed");
}

inline void check_choice(const OptionRow& row, const std::string& text) {
    std::string all;
    for (const std::string& choice : row.choices) {
        if (choice == text) return;
        all += (all.empty() ? "" : ", ") + choice;
    }
    throw Error(row.name + " is '" + text + "', one of " + all + " needed");
}

// Where a number stands in the options. Rows hold functions that find it and nothing else that
// depends on its type, so that the table of all rows compiles fast.
using Number = std::variant<int*, unsigned*, unsigned long*, unsigned long long*, float*, double*>;
using NumberAt = Number (*)(RendererOptions&);

inline Number place(NumberAt at, const RendererOptions& options) {
    return at(const_cast<RendererOptions&>(options));
}

inline void write(const Number& number, double value) {
    std::visit([&](auto* to) { *to = static_cast<std::decay_t<decltype(*to)>>(value); }, number);
}

// more: places that have the same value.
inline OptionRow number(OptionRow row, NumberAt at, const std::vector<NumberAt>& more = {}) {
    RendererOptions any;
    const bool whole = std::visit(
        [](auto* of) { return std::is_integral_v<std::decay_t<decltype(*of)>>; }, at(any));
    row.kind = whole ? OptionRow::Kind::integer : OptionRow::Kind::number;
    row.get = [at](const RendererOptions& options) {
        return std::visit([](const auto* of) { return text_of(*of); }, place(at, options));
    };
    row.set = [at, more, row](RendererOptions& options, const std::string& text) {
        if (!row.choices.empty()) check_choice(row, text);
        const double value = number_of(row.name, text);
        check_range(row, text, value);
        write(at(options), value);
        for (const NumberAt other : more) write(other(options), value);
    };
    return row;
}

// A value of an enumeration or a count, by the words in `choices`, in the order of `values`.
template <typename T>
OptionRow choice(OptionRow row, std::type_identity_t<T>& (*at)(RendererOptions&),
                 std::vector<T> values) {
    row.kind = OptionRow::Kind::choice;
    row.get = [at, values, row](const RendererOptions& options) -> std::string {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (at(const_cast<RendererOptions&>(options)) == values[i]) return row.choices[i];
        return "";
    };
    row.set = [at, values, row](RendererOptions& options, const std::string& text) {
        check_choice(row, text);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (row.choices[i] == text) at(options) = values[i];
    };
    return row;
}

// on: what the switch sets the flag of the options to.
inline OptionRow toggle(OptionRow row, bool& (*at)(RendererOptions&), bool on = true) {
    row.kind = OptionRow::Kind::toggle;
    row.get = [at, on](const RendererOptions& options) -> std::string {
        return at(const_cast<RendererOptions&>(options)) == on ? "true" : "false";
    };
    row.set = [at, on, name = row.name](RendererOptions& options, const std::string& text) {
        if (text != "true" && text != "false")
            throw Error(name + " is '" + text + "', true or false needed");
        at(options) = (text == "true") == on;
    };
    return row;
}

// Words for some values of a number that is 0 or more, such as off.
inline OptionRow threshold(OptionRow row, const std::vector<std::pair<std::string, double>>& words,
                           double (*get)(const RendererOptions&),
                           void (*put)(RendererOptions&, double)) {
    row.kind = OptionRow::Kind::number;
    row.get = [words, get](const RendererOptions& options) {
        for (const auto& [word, value] : words)
            if (get(options) == value) return word;
        return text_of(static_cast<float>(get(options)));
    };
    row.set = [words, put, name = row.name](RendererOptions& options, const std::string& text) {
        std::string known;
        for (const auto& [word, value] : words) {
            if (text == word) return put(options, value);
            known += word + ", ";
        }
        if (!known.empty()) known.replace(known.size() - 2, 2, " or ");
        double value = -1.0;
        try {
            value = number_of(name, text);
        } catch (const Error&) {
        }
        if (!(value >= 0.0))
            throw Error(name + " is '" + text + "', " + known + "a threshold of at least 0 needed");
        put(options, value);
    };
    return row;
}

// "0.1%" or "0.001".
inline OptionRow share(OptionRow row, NumberAt at) {
    row.kind = OptionRow::Kind::number;
    row.get = [at](const RendererOptions& options) {
        const double value =
            std::visit([](const auto* of) { return double(*of); }, place(at, options));
        return text_of(static_cast<float>(100.0 * value)) + "%";
    };
    row.set = [at, name = row.name](RendererOptions& options, const std::string& text) {
        const bool percent = !text.empty() && text.back() == '%';
        double value = 0.0;
        try {
            value = number_of(name, percent ? text.substr(0, text.size() - 1) : text);
        } catch (const Error&) {
        }
        if (!(value > 0.0 && value < 1e9))
            throw Error(name + " is '" + text + "', a share such as 2% or 0.02 needed");
        write(at(options), percent ? value / 100.0 : value);
    };
    return row;
}

}  // namespace clgi::renderer
