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

// A number in the options. at: a reference to it.
template <typename At>
OptionRow number(OptionRow row, At at) {
    using T = std::decay_t<decltype(at(std::declval<RendererOptions&>()))>;
    row.kind = std::is_integral_v<T> ? OptionRow::Kind::integer : OptionRow::Kind::number;
    row.get = [at](const RendererOptions& options) {
        return text_of(at(const_cast<RendererOptions&>(options)));
    };
    row.set = [at, row](RendererOptions& options, const std::string& text) {
        if (!row.choices.empty()) check_choice(row, text);
        const double value = number_of(row.name, text);
        check_range(row, text, value);
        at(options) = static_cast<T>(value);
    };
    return row;
}

// The same value in several places.
template <typename At, typename... More>
OptionRow number(OptionRow row, At at, More... more) {
    OptionRow out = number(std::move(row), at);
    out.set = [first = out.set, at, more...](RendererOptions& options, const std::string& text) {
        first(options, text);
        ((more(options) = static_cast<std::decay_t<decltype(more(options))>>(at(options))), ...);
    };
    return out;
}

// A value of an enumeration or a count, by the words in `choices`, in the order of `values`.
template <typename At, typename T>
OptionRow choice(OptionRow row, At at, std::vector<T> values) {
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
template <typename At>
OptionRow toggle(OptionRow row, At at, bool on = true) {
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
                           std::function<double(const RendererOptions&)> get,
                           std::function<void(RendererOptions&, double)> put) {
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
template <typename At>
OptionRow share(OptionRow row, At at) {
    row.kind = OptionRow::Kind::number;
    row.get = [at](const RendererOptions& options) {
        return text_of(static_cast<float>(100.0 * at(const_cast<RendererOptions&>(options)))) + "%";
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
        at(options) =
            static_cast<std::decay_t<decltype(at(options))>>(percent ? value / 100.0 : value);
    };
    return row;
}

}  // namespace clgi::renderer
