// SPDX-License-Identifier: MIT
#include "io/gltf_json.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace clgi::io::gltf {

using nlohmann::json;

namespace {

constexpr std::size_t longest_name = 128;
constexpr std::size_t longest_quote = 96;

// Cuts UTF-8 between characters.
std::string shortened(std::string text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    text.resize(length);
    return text;
}

}  // namespace

Value::Value(const json& root) : json_(&root), steps_{} {}

void Value::fail(const std::string& what) const {
    const std::string where = path();
    throw InputError(where.empty() ? what : where + " " + what);
}

std::string Value::path() const {
    std::string path;
    for (std::size_t i = 0; i < std::min(depth_, steps_.size()); ++i) {
        if (!steps_[i].key) {
            path += "[" + std::to_string(steps_[i].item) + "]";
        } else {
            path += (path.empty() ? "" : ".") + printable(steps_[i].key);
        }
    }
    return path;
}

Value Value::step(const json& child, Step step) const {
    Value next = *this;
    next.json_ = &child;
    if (depth_ < steps_.size()) next.steps_[depth_] = step;
    ++next.depth_;
    return next;
}

void Value::expect_object() const {
    if (!json_->is_object()) fail(std::string("is ") + json_->type_name() + ", not an object");
}

std::optional<Value> Value::find(const char* key) const {
    expect_object();
    const auto member = json_->find(key);
    if (member == json_->end()) return std::nullopt;
    return step(*member, {key, 0});
}

Value Value::at(const char* key) const {
    if (auto member = find(key)) return *member;
    fail(std::string("has no ") + key);
}

std::vector<Value::Member> Value::members() const {
    expect_object();
    std::vector<Member> members;
    members.reserve(json_->size());
    for (auto member = json_->begin(); member != json_->end(); ++member) {
        members.push_back({member.key(), step(*member, {member.key().c_str(), 0})});
    }
    return members;
}

std::optional<Value> Value::extension(const char* name) const {
    const auto extensions = find("extensions");
    if (!extensions) return std::nullopt;
    auto extension = extensions->find(name);
    if (extension) extension->expect_object();
    return extension;
}

std::size_t Value::count() const { return count(max_entries); }

std::size_t Value::count(std::size_t most) const {
    if (!json_->is_array()) fail(std::string("is ") + json_->type_name() + ", not an array");
    if (json_->size() > most) {
        fail("has " + std::to_string(json_->size()) + " entries, at most " + std::to_string(most) +
             " are read");
    }
    return json_->size();
}

Value Value::item(std::size_t i) const { return step((*json_)[i], {nullptr, i}); }

double Value::number() const {
    if (!json_->is_number()) fail(std::string("is ") + json_->type_name() + ", not a number");
    const double number = json_->get<double>();
    if (!std::isfinite(number)) fail("is not finite");
    return number;
}

std::uint64_t Value::integer() const {
    if (json_->is_number_unsigned()) return json_->get<std::uint64_t>();
    const double real = number();
    // 2^53: up to here a double that is whole is the number that was written.
    if (real < 0.0 || real > 9007199254740992.0 || real != std::floor(real)) {
        fail("is " + json_->dump() + ", not a whole number");
    }
    return static_cast<std::uint64_t>(real);
}

bool Value::flag() const {
    if (!json_->is_boolean()) fail(std::string("is ") + json_->type_name() + ", not true or false");
    return json_->get<bool>();
}

std::string Value::text() const {
    if (!json_->is_string()) fail(std::string("is ") + json_->type_name() + ", not a string");
    return json_->get<std::string>();
}

std::string Value::name() const { return shortened(text(), longest_name); }

int Value::index(std::size_t entries, const char* noun) const {
    const std::uint64_t index = integer();
    if (index >= entries) {
        fail("is " + std::to_string(index) + ", there are " + std::to_string(entries) + " " + noun);
    }
    return static_cast<int>(index);
}

std::vector<int> Value::indices(std::size_t entries, const char* noun) const {
    std::vector<int> indices(count());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = item(i).index(entries, noun);
    return indices;
}

std::vector<double> Value::numbers() const {
    std::vector<double> numbers(count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = item(i).number();
    return numbers;
}

std::vector<double> Value::numbers(std::size_t expected) const {
    if (count() != expected) {
        fail("has " + std::to_string(count()) + " numbers, not " + std::to_string(expected));
    }
    return numbers();
}

double Value::number_or(const char* key, double fallback) const {
    const auto member = find(key);
    return member ? member->number() : fallback;
}

std::uint64_t Value::integer_or(const char* key, std::uint64_t fallback) const {
    const auto member = find(key);
    return member ? member->integer() : fallback;
}

bool Value::flag_or(const char* key, bool fallback) const {
    const auto member = find(key);
    return member ? member->flag() : fallback;
}

std::string Value::name_or_empty() const {
    const auto member = find("name");
    return member ? member->name() : std::string();
}

int Value::index_or_none(const char* key, std::size_t entries, const char* noun) const {
    const auto member = find(key);
    return member ? member->index(entries, noun) : -1;
}

glm::dvec3 Value::vec3_or(const char* key, glm::dvec3 fallback) const {
    const auto member = find(key);
    if (!member) return fallback;
    const std::vector<double> v = member->numbers(3);
    return {v[0], v[1], v[2]};
}

std::size_t entries(const Value& root, const char* key, std::size_t most) {
    const auto array = root.find(key);
    return array ? array->count(most) : 0;
}

std::string printable(const std::string& text) {
    std::string line = shortened(text, longest_quote);
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return line.size() < text.size() ? line + "..." : line;
}

}  // namespace clgi::io::gltf
