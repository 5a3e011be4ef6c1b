// SPDX-License-Identifier: MIT
#include "io/gltf_guard.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

constexpr std::size_t most_entries = std::size_t{1} << 20;

// Where in the document something is.
struct Place {
    const Place* holder;
    std::string_view member;  // empty: an entry
    std::size_t entry;

    std::string path() const {
        if (!holder) return "";
        const std::string before = holder->path();
        if (member.empty()) return before + "[" + std::to_string(entry) + "]";
        return before + (before.empty() ? "" : ".") + printable(std::string(member));
    }
};

class Guard {
public:
    Guard(const json& root, const json& rules) : rules_(rules) {
        for (const auto& [name, list] : root.items()) sizes_[name] = list.size();
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        sizes_["lights"] = root.contains(lights) ? root.at(lights).size() : 0;
    }

    void check(json& value, const json& rule, const Place& place) const {
        if (rule.is_object()) return check_members(value, rule, place);
        if (rule.is_array()) return check_entries(value, rule, place);
        const std::string_view text = rule.get_ref<const std::string&>();
        if (text[0] == '$') return check(value, rules_.at(text), place);
        const std::size_t space = std::min(text.find(' '), text.size() - 1);
        check_value(value, text.substr(0, text.find(' ')), text.substr(space + 1), place);
    }

private:
    template <typename... Parts>
    [[noreturn]] static void fail_at(const Place& place, const Parts&... what) {
        const std::string path = place.path();
        fail(path, path.empty() ? "" : " ", what...);
    }

    static void expect(bool right, const json& value, const char* kind, const Place& place) {
        if (!right) fail_at(place, "is ", value.type_name(), ", not ", kind);
    }

    static const json* rule_for(const std::string& name, const json& rules) {
        if (const auto rule = rules.find(name); rule != rules.end()) return &*rule;
        if (const auto rule = rules.find(name + "!"); rule != rules.end()) return &*rule;
        for (const auto& [key, rule] : rules.items()) {
            if (key[0] == '*' && name.ends_with(key.substr(1))) return &rule;
        }
        return nullptr;
    }

    void check_members(json& value, const json& rules, const Place& place) const {
        expect(value.is_object(), value, "an object", place);
        for (const auto& [key, rule] : rules.items()) {
            const std::string_view name(key.data(), key.size() - 1);
            if (key.back() == '!' && !value.contains(name)) fail_at(place, "has no ", name);
        }
        for (auto member = value.begin(); member != value.end();) {
            const json* rule = rule_for(member.key(), rules);
            if (rule) check(*member, *rule, {&place, member.key(), 0});
            member = rule ? std::next(member) : value.erase(member);
        }
    }

    void check_entries(json& value, const json& rule, const Place& place) const {
        check_size(value, rule.size() > 1 ? rule[1].get<std::size_t>() : most_entries, place);
        for (std::size_t i = 0; i < value.size(); ++i) check(value[i], rule[0], {&place, "", i});
    }

    static void check_size(const json& value, std::size_t most, const Place& place) {
        expect(value.is_array(), value, "an array", place);
        if (value.size() <= most) return;
        fail_at(place, "has ", value.size(), " entries, at most ", most, " are read");
    }

    static std::uint64_t whole(json& value, const Place& place) {
        if (!value.is_number_unsigned()) {
            const double real = value.get<double>();
            // 2^53: up to here a double that is whole is the number that was written.
            if (real < 0.0 || real > 9007199254740992.0 || real != std::floor(real)) {
                fail_at(place, "is ", value.dump(), ", not a whole number");
            }
            value = static_cast<std::uint64_t>(real);
        }
        return value.get<std::uint64_t>();
    }

    static void check_numbers(const json& value, std::string_view length, const Place& place) {
        check_size(value, most_entries, place);
        if (!length.empty() && std::to_string(value.size()) != length) {
            fail_at(place, "has ", value.size(), " numbers, not ", length);
        }
        for (const json& number : value) expect(number.is_number(), number, "a number", place);
    }

    static void check_among(const std::string& word, std::string_view all, const Place& place) {
        std::istringstream words{std::string(all)};
        using Words = std::istream_iterator<std::string>;
        if (std::find(Words(words), Words(), word) != Words()) return;
        fail_at(place, "is ", printable(word), ", none of ", all);
    }

    void check_value(json& value, std::string_view kind, std::string_view arguments,
                     const Place& place) const {
        if (kind == "flag") return expect(value.is_boolean(), value, "true or false", place);
        if (kind == "numbers") return check_numbers(value, arguments, place);
        if (kind == "text" || kind == "word") {
            expect(value.is_string(), value, "a string", place);
            if (kind == "word") check_among(value.get<std::string>(), arguments, place);
            return;
        }
        expect(value.is_number(), value, "a number", place);
        if (kind == "number") return;
        if (kind == "above_zero" || kind == "not_negative") {
            if (value.get<double>() < 0.0) fail_at(place, "is negative");
            if (kind == "above_zero" && value == 0) fail_at(place, "is not above 0");
            return;
        }
        const std::uint64_t number = whole(value, place);
        if (kind == "code") check_among(std::to_string(number), arguments, place);
        if (kind == "count" && number == 0) fail_at(place, "is 0, at least 1 is needed");
        if (kind == "int" && number > INT_MAX) fail_at(place, "is ", number);
        if (kind != "index") return;
        const auto size = sizes_.find(arguments);
        const std::size_t there = size == sizes_.end() ? 0 : size->second;
        if (number < there) return;
        fail_at(place, "is ", number, ", there are ", there, " ", arguments);
    }

    const json& rules_;
    std::map<std::string, std::size_t, std::less<>> sizes_;  // of the arrays of the root
};

}  // namespace

void guard(json& root) {
    static const json rules = json::parse(schema);
    Guard(root, rules).check(root, rules, {nullptr, "", 0});
}

}  // namespace clgi::io::gltf
