// SPDX-License-Identifier: MIT
#include "io/gltf_guard.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

// One rule on its way through the document.
class Guard {
public:
    Guard(json& root, const Rule& rule) : root_(root), rule_(rule) {}

    void run() {
        if (rule_.kind == Kind::index && !counts_locally()) count_entries(root_, rule_.among);
        visit(root_, rule_.path);
    }

private:
    struct Step {
        std::string_view key;  // empty: an array item
        std::size_t item;
    };

    [[noreturn]] void fail(const std::string& what) const {
        std::string path;
        for (const Step& step : steps_) {
            if (step.key.empty()) {
                path += "[" + std::to_string(step.item) + "]";
            } else {
                path += (path.empty() ? "" : ".") + printable(std::string(step.key));
            }
        }
        refuse(path, what);
    }

    void expect(bool kind, const json& value, const char* name) const {
        if (!kind) fail(std::string("is ") + value.type_name() + ", not " + name);
    }

    void visit(json& value, std::string_view path) {
        if (path.empty() || path == "!") return judge(value);
        if (path[0] == '.') path.remove_prefix(1);
        if (path.starts_with("[]")) return visit_items(value, path.substr(2));

        expect(value.is_object(), value, "an object");
        const std::size_t end = std::min(path.find_first_of(".[!"), path.size());
        const std::string_view key = path.substr(0, end);
        const std::string_view rest = path.substr(end);
        if (key[0] == '*') return visit_members(value, key.substr(1), rest);
        const auto member = value.find(key);
        if (member != value.end()) return step({key, 0}, *member, rest);
        if (rest == "!") fail("has no " + std::string(key));
    }

    void visit_items(json& array, std::string_view rest) {
        expect_list(array, max_entries);
        for (std::size_t i = 0; i < array.size(); ++i) {
            if (steps_.size() == 1 && counts_locally()) {
                count_entries(array[i], rule_.among.substr(1));
            }
            step({{}, i}, array[i], rest);
        }
    }

    void visit_members(json& object, std::string_view ending, std::string_view rest) {
        for (auto member = object.begin(); member != object.end(); ++member) {
            if (member.key().ends_with(ending)) step({member.key(), 0}, *member, rest);
        }
    }

    void step(Step step, json& value, std::string_view rest) {
        steps_.push_back(step);
        visit(value, rest);
        steps_.pop_back();
    }

    void expect_list(const json& value, std::uint64_t most) const {
        expect(value.is_array(), value, "an array");
        if (value.size() > most) {
            fail("has " + std::to_string(value.size()) + " entries, at most " +
                 std::to_string(most) + " are read");
        }
    }

    void expect_numbers(const json& value) const {
        expect_list(value, max_entries);
        if (rule_.limit != 0 && value.size() != rule_.limit) {
            fail("has " + std::to_string(value.size()) + " numbers, not " +
                 std::to_string(rule_.limit));
        }
        for (const json& number : value) expect(number.is_number(), number, "a number");
    }

    std::uint64_t whole(json& value) const {
        expect(value.is_number(), value, "a number");
        if (!value.is_number_unsigned()) {
            const double real = value.get<double>();
            // 2^53: up to here a double that is whole is the number that was written.
            if (real < 0.0 || real > 9007199254740992.0 || real != std::floor(real)) {
                fail("is " + value.dump() + ", not a whole number");
            }
            value = static_cast<std::uint64_t>(real);
        }
        return value.get<std::uint64_t>();
    }

    void expect_whole(json& value, std::uint64_t least) const {
        const std::uint64_t number = whole(value);
        if (number < least) fail("is 0, at least 1 is needed");
        if (rule_.limit != 0 && number > rule_.limit) fail("is " + std::to_string(number));
    }

    bool counts_locally() const { return rule_.among.starts_with('.'); }

    // Of the array that the rule's indices count; the holder is the root or an entry of its arrays.
    void count_entries(const json& holder, std::string_view name) {
        const json::json_pointer array(name == "lights" ? "/extensions/KHR_lights_punctual/lights"
                                                        : "/" + std::string(name));
        entries_ = holder.contains(array) ? holder.at(array).size() : 0;
    }

    void expect_index(json& value) const {
        const std::uint64_t index = whole(value);
        if (index >= entries_) {
            fail("is " + std::to_string(index) + ", there are " + std::to_string(entries_) + " " +
                 std::string(rule_.among.substr(counts_locally() ? 1 : 0)));
        }
    }

    void expect_among(const std::string& word, const std::string& shown) const {
        const std::string all = " " + std::string(rule_.among) + " ";
        const bool known =
            word.find(' ') == std::string::npos && all.find(" " + word + " ") != std::string::npos;
        if (!known) fail("is " + shown + ", none of " + std::string(rule_.among));
    }

    void judge(json& value) const {
        switch (rule_.kind) {
            case Kind::object:
                return expect(value.is_object(), value, "an object");
            case Kind::list:
                return expect_list(value, rule_.limit);
            case Kind::flag:
                return expect(value.is_boolean(), value, "true or false");
            case Kind::text:
            case Kind::word:
                expect(value.is_string(), value, "a string");
                if (rule_.kind == Kind::text) return;
                return expect_among(value.get<std::string>(), printable(value.dump()));
            case Kind::number:
                return expect(value.is_number(), value, "a number");
            case Kind::above_zero:
            case Kind::not_negative:
                expect(value.is_number(), value, "a number");
                if (value.get<double>() < 0.0) fail("is negative");
                if (rule_.kind == Kind::above_zero && value == 0) fail("is not above 0");
                return;
            case Kind::numbers:
                return expect_numbers(value);
            case Kind::whole:
            case Kind::count:
                return expect_whole(value, rule_.kind == Kind::count ? 1 : 0);
            case Kind::code: {
                const std::string code = std::to_string(whole(value));
                return expect_among(code, code);
            }
            case Kind::index:
                return expect_index(value);
        }
    }

    json& root_;
    const Rule& rule_;
    std::size_t entries_ = 0;  // that there are to an index
    std::vector<Step> steps_;
};

bool is_read(std::string_view extension) {
    constexpr std::string_view read[] = {"KHR_lights_punctual",   "KHR_materials_emissive_strength",
                                         "KHR_texture_transform", "EXT_mesh_gpu_instancing",
                                         "KHR_materials_unlit",   "KHR_draco_mesh_compression"};
    return std::find(std::begin(read), std::end(read), extension) != std::end(read);
}

}  // namespace

void guard(json& root, std::span<const Rule> rules) {
    for (const Rule& rule : rules) Guard(root, rule).run();
}

json& list_in(json& root, const char* name) {
    json& list = root[name];
    if (list.is_null()) list = json::array();
    return list;
}

void drop_foreign(json& value) {
    if (!value.is_structured()) return;
    if (value.is_object()) {
        value.erase("extras");
        const auto extensions = value.find("extensions");
        if (extensions != value.end() && extensions->is_object()) {
            for (auto each = extensions->begin(); each != extensions->end();) {
                each = is_read(each.key()) ? std::next(each) : extensions->erase(each);
            }
        }
    }
    for (json& member : value) drop_foreign(member);
}

}  // namespace clgi::io::gltf
